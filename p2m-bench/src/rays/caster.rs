//! What is asked of a ray, and who answers.

use crate::contender::{Absent, Prepared};
use crate::scene::{Scene, single_point};
use nalgebra::{Point3, Vector3};
use p2m_bvh::{TreeIndex, Volume};
use p2m_core::{BruteForce, Hit, Hits, PrimitiveSet, Ray, RayQuery, RayStatsCollector};
use std::hint::black_box;

/// What is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    /// Whether there is a hit.
    DoIntersect,
    /// Some hit.
    Any,
    /// The first one.
    First,
    /// All of them.
    All,
}

impl Function {
    /// In the order of the manual.
    pub(crate) const ALL: [Self; 4] = [Self::DoIntersect, Self::Any, Self::First, Self::All];

    /// Its name there.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::DoIntersect => "do_intersect",
            Self::Any => "any_intersection",
            Self::First => "first_intersection",
            Self::All => "all_intersections",
        }
    }
}

/// Rays as every contender wants them.
pub(crate) struct Rays {
    /// Ours.
    pub(crate) ours: Vec<Ray>,
    /// Origins and directions in f64,
    pub(crate) double: Vec<(Point3<f64>, Vector3<f64>)>,
    /// and rounded to f32.
    pub(crate) single: Vec<(Point3<f32>, Vector3<f32>)>,
}

impl Rays {
    /// Rounds once for all.
    pub(crate) fn new(ours: Vec<Ray>) -> Self {
        let double: Vec<_> = ours.iter().map(|ray| (ray.origin(), ray.direction())).collect();
        let single = double.iter().map(|(o, d)| (single_point(o), single_point(&Point3::from(*d)).coords)).collect();
        Self { ours, double, single }
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.ours.len()
    }
}

/// The answer to a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outcome {
    /// How many hits were found.
    pub(crate) hits: usize,
    /// The parameter of the one that was asked for, or of the first one; NaN if none is told.
    pub(crate) parameter: f64,
    /// Its primitive.
    pub(crate) id: usize,
}

impl Outcome {
    /// No hit.
    pub(crate) const NONE: Self = Self { hits: 0, parameter: f64::NAN, id: usize::MAX };

    fn of(hits: usize, first: Option<&Hit>) -> Self {
        // Nothing that a hit holds is to be left out of the work; weights and point are computed when asked for.
        let first = black_box(first);
        first.map_or(Self { hits, ..Self::NONE }, |hit| Self {
            hits,
            parameter: hit.parameter,
            id: hit.primitive.index(),
        })
    }

    /// Whether both are the same bits.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.hits == other.hits && self.parameter.to_bits() == other.parameter.to_bits() && self.id == other.id
    }
}

/// Answers rays one by one, in their order, with the first hit of each.
pub(crate) trait Caster {
    /// The loop over all rays, compiled for each contender.
    fn first(&self, rays: &Rays, outcomes: &mut [Outcome]);
}

/// An index of ours.
pub(crate) trait Ours {
    /// The loop over all rays.
    fn answer(&self, function: Function, rays: &Rays, outcomes: &mut [Outcome]);
    /// The first hit and all of them, to the last bit.
    fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>);
    /// Nodes and packets visited and primitives tested in searches for all hits.
    fn work(&self, rays: &[Ray]) -> [usize; 3];
}

/// Any index over f64.
fn answer<I: RayQuery<f64>>(index: &I, function: Function, rays: &Rays, outcomes: &mut [Outcome]) {
    let pairs = rays.ours.iter().zip(outcomes);
    match function {
        Function::DoIntersect => pairs.for_each(|(ray, outcome)| {
            *outcome = Outcome::of(usize::from(index.do_intersect(ray)), None);
        }),
        Function::Any => pairs.for_each(|(ray, outcome)| {
            let hit = index.any_intersection(ray);
            // Which one is up to the backend.
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

impl<S: PrimitiveSet<f64>, V: Volume> Ours for TreeIndex<f64, S, V> {
    fn answer(&self, function: Function, rays: &Rays, outcomes: &mut [Outcome]) {
        answer(self, function, rays, outcomes);
    }
    fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>) {
        (self.first_intersection(ray), self.all_intersections(ray))
    }
    fn work(&self, rays: &[Ray]) -> [usize; 3] {
        RayStatsCollector::of_rays(rays, &Hits::all(), |ray, counting| self.visit_ray(ray, counting))
    }
}

impl<S: PrimitiveSet<f64>> Ours for BruteForce<S> {
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
pub(crate) enum Index<'a> {
    /// It keeps the contract of `RayQuery`.
    Ours(Box<dyn Ours + 'a>),
    /// It does not.
    Rival(Box<dyn Caster + 'a>),
}

/// An entry of the list of contenders.
pub(crate) struct Backend {
    /// Its name in tables and on the command line.
    pub(crate) name: &'static str,
    /// Its scalar.
    pub(crate) scalar: &'static str,
    /// Makes it ready to be built over a scene.
    pub(crate) prepare: for<'a> fn(&'a Scene) -> Result<Prepared<'a, Index<'a>>, Absent>,
}
