//! The exact evaluation of candidates: eight triangles in lanes against one triangle at a time.

use crate::measure::{Effort, MedianRange};
use crate::scene::Scene;
use anyhow::{Context, Result};
use cpu_time::ThreadTime;
use p2m_bvh::AabbTree;
use p2m_core::engine::side_by_side::{Eight, EightNearest, SIDE_BY_SIDE, triangles};
use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel};
use p2m_core::engine::vector::V3;
use p2m_core::{BuildIndex, ClosestPoint, PrimitiveSet, Projection, Shape};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;
use std::hint::black_box;

/// A query point and the triangle that is nearest to it.
type Candidate = (V3, [V3; 3]);

/// The evaluation of eight triangles, compiled for each instruction set.
struct Evaluate<'a>(&'a Eight<3>);

impl SimdKernel for Evaluate<'_> {
    type Output = EightNearest;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> EightNearest {
        triangles::<I::Doubles>(self.0, false)
    }
}

/// Prints CPU times for one candidate, each of which is the nearest triangle of a query. Returns whether the lanes have
/// the bits of the evaluation one at a time; it says nothing for a scene without triangles.
pub(crate) fn print(scene: &Scene, sets: &[QuerySet], effort: &Effort) -> Result<bool> {
    let tree =
        AabbTree::build(&*scene.double, &Default::default()).context("the scene was checked when it was read")?;
    let isas = Isa::available();
    let mut table =
        Table::new(["set".to_owned(), "one at a time".to_owned()].into_iter().chain(isas.iter().map(Isa::to_string)));
    let mut equal = true;
    let mut has_triangles = false;
    for set in sets {
        let candidates: Vec<Candidate> = set
            .generate(&scene.double, effort.queries.min(100_000), effort.seed)
            .iter()
            .filter_map(|query| match scene.double.get(tree.closest_point(query)?.primitive) {
                Shape::Triangle(t) => Some((query.coords.into(), t.vertices.map(|p| p.coords.into()))),
                _ => None,
            })
            .collect();
        has_triangles |= !candidates.is_empty();
        let mut times = vec![Vec::new(); 1 + isas.len()];
        for _ in 0..effort.rounds {
            let start = ThreadTime::now();
            for (query, vertices) in &candidates {
                black_box(Projection::onto_near_triangle(*query, vertices, f64::INFINITY));
            }
            times[0].push(start.elapsed().as_secs_f64());
            for (isa, times) in isas.iter().zip(&mut times[1..]) {
                let start = ThreadTime::now();
                for eight in candidates.chunks_exact(SIDE_BY_SIDE) {
                    let found = isa.run(Evaluate(&gather(eight)));
                    for (lane, (query, vertices)) in eight.iter().enumerate() {
                        if black_box(found.square_and_lower_bound(lane)).is_none() {
                            black_box(Projection::onto_near_triangle(*query, vertices, f64::INFINITY));
                        }
                    }
                }
                times.push(start.elapsed().as_secs_f64());
            }
        }
        for isa in &isas {
            equal &= candidates.chunks_exact(SIDE_BY_SIDE).all(|eight| {
                let found = isa.run(Evaluate(&gather(eight)));
                eight.iter().enumerate().all(|(lane, (query, vertices))| {
                    let one = Projection::onto_near_triangle(*query, vertices, f64::INFINITY);
                    let bits = |projection: Projection| projection.point.map(f64::to_bits);
                    found.projection(lane).is_none_or(|found| one.map(bits) == Some(bits(found)))
                })
            });
        }
        let median = |times: &Vec<f64>| MedianRange::of(times).map_or(f64::NAN, |spread| spread.median);
        let mut row = vec![set.name().to_owned()];
        row.extend(times.iter().map(|times| format!("{:.1}", median(times) * 1e9 / candidates.len() as f64)));
        table.push(row);
    }
    if has_triangles {
        println!("\nExact evaluation: nanoseconds of CPU time a candidate, medians.\n\n{table}");
    }
    Ok(equal)
}

/// Puts eight candidates side by side.
fn gather(candidates: &[Candidate]) -> Eight<3> {
    let mut eight = Eight::default();
    for (lane, (query, [a, b, c])) in candidates.iter().enumerate() {
        eight.set(lane, query, [a, b, c]);
    }
    eight
}
