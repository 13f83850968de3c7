//! Distances of many places side by side from the few primitives that can be the nearest ones of a box.
//!
//! An index answers one place after the other. Places that fill a box, those of a grid above all, have the same few primitives to
//! choose from: [`Candidates`] are those of a box, found from those of a larger one, and [`CandidateLists::distances`] evaluates
//! them for all places of the box at once, places as lanes of a vector.
//!
//! # Which primitives can be nearest in a box
//!
//! Let s be any point of the scene. |q - s|^2 - d(q, p)^2 is convex in q for any primitive p, being the maximum over x in p of
//! 2 q (x - s) + |s|^2 - |x|^2, which are linear. So where s is nearer than p at the eight corners of a box, it is so in all of
//! it, and p is nowhere the nearest there (**proved**). The feet of the eight corners serve as s: of a flat surface with
//! primitives of the size of the box they leave what is below the box, and its rim. A group of primitives is left out where its
//! box is.
//!
//! # What is certain
//!
//! Places, their ways to a primitive and distances are computed in f64, in a frame of each primitive that is orthonormal to some
//! u for slivers as well. With R, the largest distance of a place of the box from a vertex of any candidate, and E = 2^-44 R +
//! 2^-400,
//!
//! > |computed - true| <= E, and |computed - that of the contract's kernel| <= E.
//!
//! **Proof** (constants rounded up; u = 2^-53). A way is rounded by u R; its three components in the frame by 3 u R for the sums
//! and 4 u R for the axes each, and axes that are not quite orthonormal change lengths by 10 u R: 23 u R for the way as a whole,
//! and as much for the vertices of the primitive, whose ways are at most 2 R long, twice: 46 u R. From there on it is about a
//! triangle of the plane with corners that are numbers of f64: directions of edges are right to 4 u, so sums of two products to
//! 10 u R, and what is across and beyond an edge to 20 u R together. A place counts as above the inside if it is so by 2^-46 R =
//! 128 u R for all edges, which it then is without rounding, too. One that is inside and does not count is within 128 u R +
//! 79 u R of the line of an edge, and so of the boundary, since the way to that line leaves the triangle before it ends; that is
//! its error at most. Squares and the root add 6 u R. All together less than 400 u R; the contract's own 8 u R is added, and
//! 512 u R is 2^-44 R. Edges below 2^-450 count as points, and squares lose less than 2^-1000 near zero: 2^-400 is more than
//! either. Coordinates up to 2^250 have squares. The foot of a place errs as its distance does.
//!
//! A value that is rounded to f32 is that of the kernel if all of d - E to d + E is rounded to it. Other places, one of 10^5 where
//! the scene is not much farther away than it is large, ask the kernel for all candidates.
//!
//! Dominators have room for these errors. With m, the largest distance of a corner from s, p is left out if it is farther than s
//! at all corners by 16 E m + 64 E^2 in the computed squares; in the true ones by 12 E m + 47 E^2 at least, since those of p err by
//! 2 E (m + 8 E) + E^2. By convexity that holds in all of the box, where |q - s| <= m, so d(q, p)^2 >= (|q - s| + 4 E)^2: p is
//! farther by 4 E than s, whose primitive is within E of it, and the kernel's distances say so, too. That primitive may be left out
//! for another that is nearer still, but the nearest one of all by the kernel cannot be: values of the candidates are
//! bit for bit those of all primitives.

mod evaluate;
mod flat;
mod groups;
mod lanes;
mod narrow;

use evaluate::Evaluate;
use groups::{Groups, Item};
use nalgebra::Point3;
use narrow::Narrow;
use p2m_core::engine::simd::Isa;
use p2m_core::{Aabb, Best, Collector, Primitive, PrimitiveSet, QueryOptions, check_set};

/// 2^-44, of the proof.
const ERROR: f64 = 1.0 / (1u64 << 44) as f64;
/// 2^-46.
const MARGIN: f64 = 1.0 / (1u64 << 46) as f64;
/// What is lost near zero.
const TINY: f64 = p2m_core::engine::vector::power_of_two(-400);
/// Larger coordinates, of the scene or of a box, have no lists: 2^250.
pub const LARGEST: f64 = p2m_core::engine::vector::power_of_two(250);

/// All primitives of a set, each in a frame of its own, and groups of them.
#[derive(Debug)]
pub struct CandidateLists<'a, S: ?Sized> {
    set: &'a S,
    groups: Groups,
    isa: Isa,
}

/// The primitives that can be nearest to a place of a box, some of them by groups.
#[derive(Clone, Debug)]
pub struct Candidates {
    items: Vec<Item>,
    nearest: f64,
    /// No vertex is farther from any place of the box.
    reach: f64,
    /// The box; `None` for any.
    part: Option<Aabb<f64>>,
}

/// How far groups are told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Groups that are small beside the box stay together: for boxes that are narrowed further.
    Groups,
    /// Down to primitives.
    Primitives,
}

impl Candidates {
    /// How many primitives and groups there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there are none, which is so for an empty set alone.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// No place of the box is nearer to the scene than this; 0 where that is not known.
    #[must_use]
    pub fn nearest(&self) -> f64 {
        self.nearest
    }

    /// Whether a box is a part of theirs, and in the range of lists.
    fn has(&self, part: &Aabb<f64>) -> bool {
        let is_in_range = part.min.iter().chain(part.max.iter()).all(|x| x.abs() <= LARGEST);
        !part.is_empty() && is_in_range && self.part.is_none_or(|whole| whole.contains(part))
    }
}

impl<'a, S: PrimitiveSet<f64> + ?Sized> CandidateLists<'a, S> {
    /// Those of a set. `None` if one of the primitives is not told by its [`vertices`](Primitive::vertices), has a coordinate that
    /// is not finite or larger than [`LARGEST`], or if there is no memory.
    ///
    /// # Complexity
    /// O(n log n) time; 238 bytes a primitive.
    #[must_use]
    pub fn new(set: &'a S) -> Option<Self> {
        let Aabb { min, max } = set.aabb();
        let is_plain = set.is_empty() || min.iter().chain(max.iter()).all(|x| x.abs() <= LARGEST);
        // NaN, which boxes may leave out, is refused as by indexes.
        if !is_plain || check_set(set).is_err() {
            return None;
        }
        Some(Self { set, groups: Groups::new(set)?, isa: Isa::best() })
    }

    /// The same with an instruction set.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { isa, ..self }
    }

    /// The set.
    #[must_use]
    pub fn set(&self) -> &'a S {
        self.set
    }

    /// Bytes of memory.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.groups.memory()
    }

    /// All primitives, of any box.
    #[must_use]
    pub fn all(&self) -> Candidates {
        Candidates { items: self.groups.all().into_iter().collect(), nearest: 0.0, reach: f64::INFINITY, part: None }
    }

    /// Those of a part of the box that `of` are the candidates of.
    ///
    /// # Panics
    /// If the part is empty, not in that box, or has coordinates above [`LARGEST`]. Candidates of other lists may panic, or give
    /// anything.
    ///
    /// # Complexity
    /// O(k) for k candidates.
    #[must_use]
    pub fn narrowed(&self, of: &Candidates, part: &Aabb<f64>, detail: Detail) -> Candidates {
        assert!(of.has(part), "{part:?} is not in the box of these candidates");
        self.isa.run(Narrow { groups: &self.groups, of, part, detail })
    }

    /// The distances from all places (x, y, z) of a grid in the box of `candidates`, x fastest, rounded to f32: bit for bit those
    /// of [`ClosestPoint::closest_point`](p2m_core::ClosestPoint::closest_point) in f64, rounded. Returns how many of them were left to the kernel of the contract.
    ///
    /// # Panics
    /// If there is not one value for each place, if one is not in the box, or if the candidates are not down to primitives.
    ///
    /// # Complexity
    /// O(k) for each place and k candidates.
    pub fn distances(&self, candidates: &Candidates, axes: [&[f64]; 3], values: &mut [f32]) -> usize {
        assert_eq!(axes.iter().map(|axis| axis.len()).product::<usize>(), values.len(), "a value for each place");
        if candidates.is_empty() || values.is_empty() {
            values.fill(f32::INFINITY);
            return 0;
        }
        let end = |pick: fn(f64, f64) -> f64| Point3::from(axes.map(|axis| axis.iter().copied().fold(axis[0], pick)));
        assert!(candidates.has(&Aabb { min: end(f64::min), max: end(f64::max) }), "places beside the box");
        let evaluate = Evaluate { groups: &self.groups, candidates, axes, values: &mut *values };
        let doubts = self.isa.run(evaluate);
        let [xs, ys, _] = axes;
        for &n in &doubts {
            let [i, j, k] = [n % xs.len(), n / xs.len() % ys.len(), n / (xs.len() * ys.len())];
            values[n] = self.kernel(candidates, Point3::new(xs[i], ys[j], axes[2][k]));
        }
        doubts.len()
    }

    #[allow(clippy::cast_possible_truncation, reason = "values are rounded to f32")]
    fn kernel(&self, candidates: &Candidates, place: Point3<f64>) -> f32 {
        let mut best = Best::new(&QueryOptions::<f64>::default());
        for id in candidates.items.iter().filter_map(|item| item.one()).map(|i| self.groups.ids[i]) {
            if let Some(projection) = self.set.get(id).project_within(&place, best.prune_above()) {
                best.offer(id, projection);
            }
        }
        best.finish().map_or(f32::INFINITY, |closest| closest.distance as f32)
    }
}

#[cfg(test)]
mod tests;
