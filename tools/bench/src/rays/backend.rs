//! The interface between the harness and a backend that casts rays.

use crate::backend::{Prepared, Unavailable};
use crate::scene::{Scene, single_point};
use nalgebra::{Point3, Vector3};
use p2m_bvh::{TreeIndex, Volume};
use p2m_core::{BruteForce, Hit, PrimitiveSet, Ray, RayQuery};
use std::hint::black_box;

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
    /// Whether a hit was found.
    pub(crate) is_hit: bool,
    /// The parameter of the first hit; NaN if there is none.
    pub(crate) parameter: f64,
    /// The id of the primitive that was hit.
    pub(crate) id: usize,
}

impl Outcome {
    /// The outcome of a ray without a hit.
    pub(crate) const NONE: Self = Self { is_hit: false, parameter: f64::NAN, id: usize::MAX };

    fn of(first: Option<&Hit>) -> Self {
        // `black_box` keeps the compiler from leaving out a part of the hit; weights and point are computed on request.
        black_box(first).map_or(Self::NONE, |hit| Self::hit(hit.parameter, hit.primitive.index()))
    }

    /// The outcome of a ray with a hit.
    pub(crate) fn hit(parameter: f64, id: usize) -> Self {
        Self { is_hit: true, parameter, id }
    }

    /// Returns whether both outcomes have the same bits.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.is_hit == other.is_hit && self.parameter.to_bits() == other.parameter.to_bits() && self.id == other.id
    }
}

/// An external library that returns the first hit of each ray, one by one, in their order.
pub(crate) trait ExternalCaster {
    /// Answers all rays; the loop is compiled for each backend.
    fn first(&self, rays: &Rays, outcomes: &mut [Outcome]);
}

/// An index of ours.
pub(crate) trait OurCaster {
    /// Answers all rays.
    fn first(&self, rays: &Rays, outcomes: &mut [Outcome]);
    /// Returns the first hit and all hits with all their bits.
    fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>);
}

/// Answers all rays with any index in f64.
fn first<I: RayQuery<f64>>(index: &I, rays: &Rays, outcomes: &mut [Outcome]) {
    for (ray, outcome) in rays.ours.iter().zip(outcomes) {
        *outcome = Outcome::of(index.first_intersection(ray).as_ref());
    }
}

impl<S: PrimitiveSet<f64>, V: Volume> OurCaster for TreeIndex<f64, S, V> {
    fn first(&self, rays: &Rays, outcomes: &mut [Outcome]) {
        first(self, rays, outcomes);
    }
    fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>) {
        (self.first_intersection(ray), self.all_intersections(ray))
    }
}

impl<S: PrimitiveSet<f64>> OurCaster for BruteForce<S> {
    fn first(&self, rays: &Rays, outcomes: &mut [Outcome]) {
        first(self, rays, outcomes);
    }
    fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>) {
        (self.first_intersection(ray), self.all_intersections(ray))
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
