//! Computes the clearance between cables or pipes and a mesh: for each segment the minimum distance of its axis from
//! the triangles, to a tolerance, minus the radius of the pipe.
//!
//! `cargo run --release --example clearance -- [SCENE] [RADIUS]`. The triangles of the scene are the mesh and its
//! segments are the pipes. The defaults are a scene of the repository and pipes of radius 0.02.
//!
//! A distance changes by at most as much as its query point moves. So between two points of a pipe that are h apart it
//! is at least (a + b - h) / 2, where a and b are the distances of the two points. The part with the smallest bound is
//! halved until the bound is within the tolerance.

use nalgebra::Point3;
use p2m::{AabbTree, BuildIndex, ClosestPoint, NearQuery};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The largest difference between lower bound and result, relative to the diagonal of the scene.
const TOLERANCE: f64 = 1e-4;

/// Two points of an axis with their distances.
type AxisPart = [(Point3<f64>, f64); 2];

/// Returns a lower bound on the distances of all points between the two ends.
fn bound([(a, at_a), (b, at_b)]: &AxisPart) -> f64 {
    ((at_a + at_b - (b - a).norm()) / 2.0).max(0.0)
}

/// Returns the minimum distance of an axis from the primitives, to a tolerance, and the number of queries.
fn clearance<I: ClosestPoint<f64>>(index: &I, axis: [Point3<f64>; 2], tolerance: f64) -> Option<(f64, usize)> {
    let at = |p: Point3<f64>| index.closest_point(&p).map(|answer| (p, answer.distance));
    let ends = [at(axis[0])?, at(axis[1])?];
    let (mut least, mut asked) = (ends[0].1.min(ends[1].1), 2);
    // The queue has numbers of parts, with the smallest bound on top. Bits of numbers that are not negative have their
    // order.
    let mut parts: Vec<AxisPart> = vec![ends];
    let mut next = BinaryHeap::from([(Reverse(bound(&ends).to_bits()), 0)]);
    while let Some((Reverse(bits), number)) = next.pop() {
        if f64::from_bits(bits) >= least - tolerance {
            break;
        }
        let [a, b] = parts[number];
        let middle = at(nalgebra::center(&a.0, &b.0))?;
        asked += 1;
        least = least.min(middle.1);
        for part in [[a, middle], [middle, b]] {
            next.push((Reverse(bound(&part).to_bits()), parts.len()));
            parts.push(part);
        }
    }
    Some((least, asked))
}

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "scenes/knot_and_cables.obj".to_owned());
    let radius: f64 = arguments.next().map_or(Ok(0.02), |text| text.parse())?;
    let scene = p2m::scene::read_scene(name.as_ref())?.soup;
    let places = scene.positions();
    // The index has the mesh alone, borrowed from the scene of mesh and pipes.
    let index = AabbTree::build(scene.triangle_set(), &Default::default())?;

    let bounds = p2m::PrimitiveSet::aabb(&scene);
    // The tolerance is at least the resolution of the coordinates.
    let tolerance =
        TOLERANCE * (bounds.max - bounds.min).norm() + 1e-12 * bounds.min.coords.amax().max(bounds.max.coords.amax());
    let pipes: Vec<[Point3<f64>; 2]> = scene.segments().iter().map(|s| s.map(|i| places[i as usize])).collect();
    let found: Option<Vec<(f64, usize)>> = pipes.iter().map(|axis| clearance(&index, *axis, tolerance)).collect();
    let Some(found) = found.filter(|found| !found.is_empty()) else {
        println!("{name} has no mesh or no pipes");
        return Ok(());
    };
    let (tightest, least) =
        found.iter().map(|f| f.0).enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
    let touching = found.iter().filter(|(distance, _)| *distance <= radius).count();
    println!("{} pipes beside {} triangles", pipes.len(), scene.triangles().len());
    println!("the least clearance is {:.6}, of pipe {tightest}", least - radius);
    println!("{touching} pipes touch the mesh");
    println!("{:.2} queries a pipe", found.iter().map(|f| f.1).sum::<usize>() as f64 / pipes.len() as f64);
    // `is_any_within` is cheaper than a distance, and is tested at the ends of the pipes.
    let near = pipes.iter().filter(|axis| axis.iter().any(|end| index.is_any_within(end, radius))).count();
    println!("{near} of these already at an end: {}", near <= touching);
    Ok(())
}
