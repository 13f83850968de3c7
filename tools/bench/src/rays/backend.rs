//! The interface between the harness and a backend that casts rays.

use crate::backend::{Prepared, Unavailable};
use crate::scene::{Scene, single_point};
use nalgebra::{Point3, Vector3};
use p2m_bvh::{TreeIndex, Volume};
use p2m_core::{BruteForce, Hit, Hits, PrimitiveSet, Ray, RayQuery, RayStatsCollector};
use std::hint::black_box;

/// A function of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    /// Returns whether there is a hit.
    DoIntersect,
    /// Returns some hit.
    Any,
    /// Returns the first hit.
    First,
    /// Returns all hits.
    All,
}

impl Function {
    /// All functions, in the order of the manual.
    pub(crate) const ALL: [Self; 4] = [Self::DoIntersect, Self::Any, Self::First, Self::All];

    /// Returns the name of the function in the manual.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::DoIntersect => "do_intersect",
            Self::Any => "any_intersection",
            Self::First => "first_intersection",
            Self::All => "all_intersections",
        }
    }
}

/// Rays in the representation of each backend.
pub(crate) struct Rays {
    /// The rays of our indexes.
    pub(crate) ours: Vec<Ray>,
    /// Origins and directions in f64.
    pub(crate) double: Vec<(Point3<f64>, Vector3<f64>)>,
    /// Origins and directions rounded to f32.
    pub(crate) single: Vec<(Point3<f32>, Vector3<f32>)>,
}

impl Rays {
    /// Converts the rays, which is not timed.
    pub(crate) fn new(ours: Vec<Ray>) -> Self {
        let double: Vec<_> = ours.iter().map(|ray| (ray.origin(), ray.direction())).collect();
        let single = double.iter().map(|(o, d)| (single_point(o), single_point(&Point3::from(*d)).coords)).collect();
        Self { ours, double, single }
    }

    /// Returns the number of rays.
    pub(crate) fn len(&self) -> usize {
        self.ours.len()
    }
}

/// The answer to a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outcome {
    /// The number of hits that were found.
    pub(crate) hits: usize,
    /// The parameter of the requested hit or of the first one; NaN if the function returns none.
    pub(crate) parameter: f64,
    /// The id of the primitive that was hit.
    pub(crate) id: usize,
}

impl Outcome {
    /// The outcome of a ray without a hit.
    pub(crate) const NONE: Self = Self { hits: 0, parameter: f64::NAN, id: usize::MAX };

    fn of(hits: usize, first: Option<&Hit>) -> Self {
        // `black_box` keeps the compiler from leaving out a part of the hit; weights and point are computed on request.
        let first = black_box(first);
        first.map_or(Self { hits, ..Self::NONE }, |hit| Self {
            hits,
            parameter: hit.parameter,
            id: hit.primitive.index(),
        })
    }

    /// Returns whether both outcomes have the same bits.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.hits == other.hits && self.parameter.to_bits() == other.parameter.to_bits() && self.id == other.id
    }
}

/// An external library that returns the first hit of each ray, one by one, in their order.
pub(crate) trait ExternalCaster {
    /// Answers all rays; the loop is compiled for each backend.
    fn first(&self, rays: &Rays, outcomes: &mut [Outcome]);
}

/// An index of ours.
pub(crate) trait OurCaster {
    /// Answers all rays with one function.
    fn answer(&self, function: Function, rays: &Rays, outcomes: &mut [Outcome]);
    /// Returns the first hit and all hits with all their bits.
    fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>);
    /// Returns the nodes visited, packets visited and primitives tested in searches for all hits.
    fn work(&self, rays: &[Ray]) -> [usize; 3];
}

/// Answers all rays with any index in f64.
fn answer<I: RayQuery<f64>>(index: &I, function: Function, rays: &Rays, outcomes: &mut [Outcome]) {
    let pairs = rays.ours.iter().zip(outcomes);
    match function {
        Function::DoIntersect => pairs.for_each(|(ray, outcome)| {
            *outcome = Outcome::of(usize::from(index.do_intersect(ray)), None);
        }),
        Function::Any => pairs.for_each(|(ray, outcome)| {
            let hit = index.any_intersection(ray);
            // Backends may return different hits here, so only the number is recorded.
            *outcome = Outcome { hits: Outcome::of(usize::from(hit.is_some()), hit.as_ref()).hits, ..Outcome::NONE };
        }),
        Function::First => pairs.for_each(|(ray, outcome)| {
            let hit = index.first_intersection(ray);
            *outcome = Outcome::of(usize::from(hit.is_some()), hit.as_ref());
        }),
        Function::All => pairs.for_each(|(ray, outcome)| {
            let hits = index.all_intersections(ray);
            *outcome = Outcome::of(hits.len(), hits.first());
        }),
    }
}

impl<S: PrimitiveSet<f64>, V: Volume> OurCaster for TreeIndex<f64, S, V> {
    fn answer(&self, function: Function, rays: &Rays, outcomes: &mut [Outcome]) {
        answer(self, function, rays, outcomes);
    }
    fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>) {
        (self.first_intersection(ray), self.all_intersections(ray))
    }
    fn work(&self, rays: &[Ray]) -> [usize; 3] {
        RayStatsCollector::count_rays(rays, &Hits::all(), |ray, counting| self.visit_ray(ray, counting))
    }
}

impl<S: PrimitiveSet<f64>> OurCaster for BruteForce<S> {
    fn answer(&self, function: Function, rays: &Rays, outcomes: &mut [Outcome]) {
        answer(self, function, rays, outcomes);
    }
    fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>) {
        (self.first_intersection(ray), self.all_intersections(ray))
    }
    fn work(&self, rays: &[Ray]) -> [usize; 3] {
        [0, 0, rays.len() * self.set().len()]
    }
}

/// An index that is ready for rays.
pub(crate) enum RayIndex<'a> {
    /// An index that keeps the contract of `RayQuery`.
    Ours(Box<dyn OurCaster + 'a>),
    /// An external library, which promises no more than its documentation.
    External(Box<dyn ExternalCaster + 'a>),
}

/// A backend in the list of backends that cast rays.
pub(crate) struct RayBackend {
    /// The name in tables and on the command line.
    pub(crate) name: &'static str,
    /// The name of the scalar.
    pub(crate) scalar: &'static str,
    /// Prepares a scene for the build.
    pub(crate) prepare: for<'a> fn(&'a Scene) -> Result<Prepared<'a, RayIndex<'a>>, Unavailable>,
}
