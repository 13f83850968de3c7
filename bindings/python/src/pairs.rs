//! Queries for pairs: shapes near a scene, and two scenes, of which the second one may move.

use crate::arrays::{borrowed, motions, slice, triples};
use crate::index::{Index, SolidParts};
use crate::memory::reserve;
use crate::pair_columns::{PairArrays, PairColumns, PairList};
use crate::parts::{Split, answer_in_parts, batch_options, check_finite};
use crate::work::{Monitor, Run, Threads, run_owned};
use nalgebra::{Isometry3, Point3};
use numpy::{PyReadonlyArray1, ToPyArray};
use p2m_core::batch::{self, Interruptible};
use p2m_core::pair::{ClosestPair, PairOptions, PairQuery};
use p2m_core::{AnyIndex, Primitive, Shape};
use p2m_field::solid::Solid;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::ControlFlow;
use std::sync::Arc;

/// An index that answers queries for pairs.
type AnyPairQuery<'a> = &'a (dyn PairQuery<f64> + Sync);

/// Two indexes, of which the second one may move.
struct ScenePair {
    first: Arc<dyn AnyIndex>,
    second: Arc<dyn AnyIndex>,
    /// The motions. Without motions the scenes stay in place, and there is one answer.
    motions: Option<Vec<Isometry3<f64>>>,
    options: PairOptions<f64>,
}

impl ScenePair {
    /// Calls `answer` for each motion, in parts, and returns the answers in order.
    fn answer<R: Send>(
        &self,
        threads: &Threads,
        monitor: &Monitor,
        answer: impl Fn(AnyPairQuery<'_>, AnyPairQuery<'_>, &PairOptions<f64>) -> R + Sync,
    ) -> Vec<R> {
        let (Some(first), Some(second)) = (self.first.as_pair_query(), self.second.as_pair_query()) else {
            return Vec::new();
        };
        let first = Interruptible::pairs(first, || !monitor.is_cancelled());
        let first: AnyPairQuery<'_> = &first;
        let Some(motions) = &self.motions else { return vec![answer(first, second, &self.options)] };
        let position = |motion: &Isometry3<f64>| Point3::from(motion.translation.vector);
        // The answer for one motion may take long.
        monitor.set_step(1);
        let parts = answer_in_parts(motions.len(), (), threads, monitor, &|range, ()| {
            batch::map(&motions[range.clone()], &batch_options(range.len(), false), position, |motion| {
                answer(first, second, &self.options.with_motion(*motion))
            })
        });
        parts.into_iter().flatten().collect()
    }

    /// Runs [`answer`](Self::answer) so that an interrupt returns at once. The abandoned searches then end on their
    /// own.
    fn run<R: Send + 'static>(
        self,
        py: Python<'_>,
        run: Run,
        answer: impl Fn(AnyPairQuery<'_>, AnyPairQuery<'_>, &PairOptions<f64>) -> R + Send + Sync + 'static,
    ) -> PyResult<Vec<R>> {
        let total = self.motions.as_ref().map_or(1, Vec::len);
        let pool = Threads::Pool(crate::threads::pool(py, run.0)?);
        run_owned(py, run, total, move |monitor| self.answer(&pool, monitor, answer))
    }
}

/// Shapes with one to three vertices each, stored consecutively.
struct Shapes<'a> {
    vertices: &'a [[f64; 3]],
    width: usize,
}

impl Shapes<'_> {
    /// Answers a query for each shape, in parts.
    fn answer<O: Split, A: Send>(
        &self,
        out: O,
        threads: &Threads,
        monitor: &Monitor,
        answer: impl Fn(&Shape<f64>) -> A + Sync,
        store: impl Fn(&[A], O) + Sync,
    ) -> PyResult<()> {
        check_finite("shapes", self.vertices, self.width)?;
        let shape = |vertices: &[[f64; 3]]| Shape::from_vertices(vertices).expect("a shape has one to three vertices");
        let centre = |shape: &Shape<f64>| nalgebra::center(&shape.aabb().min, &shape.aabb().max);
        answer_in_parts(self.len(), out, threads, monitor, &|range, out| {
            let vertices = &self.vertices[range.start * self.width..range.end * self.width];
            let shapes: Vec<_> = vertices.chunks(self.width).map(shape).collect();
            store(&batch::map(&shapes, &batch_options(shapes.len(), false), centre, &answer), out);
        });
        Ok(())
    }

    fn len(&self) -> usize {
        self.vertices.len() / self.width
    }
}

/// Calls a function with an index as a solid.
fn with_solid<R>(
    index: &AnyPairQuery<'_>,
    (parts, signed): &SolidParts,
    answer: impl FnOnce(&Solid<'_, AnyPairQuery<'_>>) -> R,
) -> R {
    let inside = |point: &Point3<f64>| signed.as_ref().is_some_and(|signed| signed.contains(point));
    answer(&Solid::new(index, parts, Some(&inside)))
}

impl Index {
    /// Returns this index paired with another one and its motions, if both answer queries for pairs.
    fn with_other(
        &self,
        other: &Self,
        transforms: Option<PyReadonlyArray1<'_, f64>>,
        max_distance: f64,
    ) -> PyResult<ScenePair> {
        self.pair_query()?;
        other.pair_query()?;
        Ok(ScenePair {
            first: Arc::clone(&self.built.index),
            second: Arc::clone(&other.built.index),
            motions: transforms.as_ref().map(motions).transpose()?,
            options: PairOptions::default().with_max_distance(max_distance),
        })
    }
}

#[pymethods]
impl Index {
    /// Finds the nearest points of the scene and of shapes with `width` vertices each, and writes them into the arrays
    /// of `out`. If `out` has `is_near`, only this array is written: whether any primitive is within the largest
    /// distance of a shape.
    fn closest_to(
        &self,
        py: Python<'_>,
        shapes: PyReadonlyArray1<'_, f64>,
        width: usize,
        out: &Bound<'_, PyDict>,
        radius: f64,
        max_distance: f64,
        certified: bool,
        solid: bool,
        run: Run,
    ) -> PyResult<()> {
        let index = self.pair_query()?;
        let parts = if solid { Some(self.solid(py, run.0)?) } else { None };
        let shapes = Shapes { vertices: triples(shapes.as_slice())?, width };
        let options = PairOptions::default().with_radius(radius).with_max_distance(max_distance);
        let (mut arrays, mut decisions) = (PairArrays::borrow(out)?, borrowed::<bool>(out, "is_near")?);
        let (columns, is_near) = (arrays.columns(shapes.len())?, slice(&mut decisions)?);
        self.run(py, shapes.len(), run, |threads, monitor| match is_near {
            Some(out) => {
                let answer = |shape: &Shape<f64>| PairQuery::is_any_near(&index, shape, &options);
                shapes.answer(out, threads, monitor, answer, |answers, out: &mut [bool]| out.copy_from_slice(answers))
            }
            None => {
                let answer = |shape: &Shape<f64>| match (&parts, certified) {
                    (Some(parts), _) => with_solid(&index, parts, |solid| solid.closest_to(shape, &options)),
                    (None, true) => PairQuery::certified_closest_to(&index, shape, &options),
                    (None, false) => PairQuery::closest_to(&index, shape, &options),
                };
                shapes.answer(columns, threads, monitor, answer, |pairs, mut columns: PairColumns<'_>| {
                    columns.set_all(pairs.iter().map(Option::as_ref));
                })
            }
        })
    }

    /// Returns a warning if it is uncertain what is inside of the scene, or if nothing is because of its segments or
    /// points.
    fn solid_note(&self, py: Python<'_>, threads: usize) -> PyResult<Option<&'static str>> {
        Ok(match self.solid(py, threads)?.1 {
            Some(signed) => signed.note(),
            None if self.scene.soup.triangles().is_empty() => None,
            None => Some("the scene has segments or points beside triangles: nothing of it counts as filled"),
        })
    }

    /// Returns the nearest pair of this scene and another one, for each motion of the other scene or without motion.
    fn closest_pairs(
        &self,
        py: Python<'_>,
        other: &Self,
        transforms: Option<PyReadonlyArray1<'_, f64>>,
        max_distance: f64,
        certified: bool,
        solid: bool,
        run: Run,
    ) -> PyResult<PairList> {
        let scenes = self.with_other(other, transforms, max_distance)?;
        let parts = if solid { Some([self.solid(py, run.0)?, other.solid(py, run.0)?]) } else { None };
        let list = scenes.run(py, run, move |first, second, options| {
            if let Some([of_first, of_second]) = &parts {
                with_solid(&first, of_first, |first| {
                    with_solid(&second, of_second, |second| first.closest_pair(second, options))
                })
            } else if certified {
                PairQuery::certified_closest_pair(&first, second, options)
            } else {
                PairQuery::closest_pair(&first, second, options)
            }
        })?;
        Ok(PairList(list))
    }

    /// Returns whether this scene and another one intersect, for each motion of the other scene or without motion.
    fn do_intersect<'py>(
        &self,
        py: Python<'py>,
        other: &Self,
        transforms: Option<PyReadonlyArray1<'_, f64>>,
        run: Run,
    ) -> PyResult<Bound<'py, PyAny>> {
        let scenes = self.with_other(other, transforms, 0.0)?;
        let answers =
            scenes.run(py, run, |first, second, options| PairQuery::is_any_pair_near(&first, second, options))?;
        Ok(answers.to_pyarray(py).into_any())
    }

    /// Returns all pairs of primitives within a distance, nearest first, and of equally near pairs those with the
    /// lowest ids first. The other scene has at most one motion.
    fn pairs_within(
        &self,
        py: Python<'_>,
        other: &Self,
        transforms: Option<PyReadonlyArray1<'_, f64>>,
        max_distance: f64,
        threads: usize,
    ) -> PyResult<PairList> {
        let scenes = self.with_other(other, transforms, max_distance)?;
        let lists = scenes.run(py, (threads, None), |first, second, options| {
            let mut list: Vec<ClosestPair<f64>> = Vec::new();
            let _ = PairQuery::visit_pairs_within(&first, second, options, &mut |pair| {
                reserve(&mut list, 1);
                list.push(*pair);
                ControlFlow::Continue(())
            });
            list.sort_unstable_by(|a, b| a.distance.total_cmp(&b.distance).then(a.primitives.cmp(&b.primitives)));
            list
        })?;
        // There is a single list, which is reused without copying.
        Ok(PairList(lists.into_iter().next().unwrap_or_default().into_iter().map(Some).collect()))
    }
}
