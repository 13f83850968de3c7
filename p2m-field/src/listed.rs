//! A value for each point of a grid, from lists of the primitives that can be nearest in its blocks.
//!
//! The grid is halved until blocks have a few dozen points; each half keeps what can be nearest in it of what its whole had
//! ([`CandidateLists`]). No index is needed, and nothing is searched for: most of the work is shared by all points of a block.
//!
//! **Bands.** A block that is beyond the band as a whole is not halved further.
//!
//! **Signs** of closed surfaces change at the surface alone, by winding numbers as well: a block without surface has that of its
//! middle, and a point that of its neighbour if either is farther from the surface than from the other. Others are asked for. (Of a
//! surface that meets itself the sign by pseudonormals is that of the nearest part at the place that is asked.) Winding numbers of
//! open surfaces change by little far from the boundary, so blocks there have one sign, too.

use super::dense::{FieldOptions, band, signed_value};
use super::layers::Layers;
use super::{Grid, GridError};
use crate::grid_candidates::{CandidateLists, Candidates, Detail, LARGEST};
use crate::sign::{Sign, SignedDistance};
use nalgebra::Point3;
use p2m_core::{Aabb, ClosestPoint, PrimitiveSet};

/// The distances at the points of a grid as [`distances`](super::distances) has them, bit for bit, from lists instead of an
/// index: the fastest way to a field whose blocks of 64 points are not much larger than primitives, or farther from them than
/// they are wide. Of `options`, hints have no meaning here.
///
/// # Errors
/// [`GridError::Memory`], and [`GridError::Range`] for coordinates above 2^250.
///
/// # Complexity
/// O(k) for each point, with k candidates in its block. 4 bytes a point, and 4 bytes for each candidate of the blocks around one.
pub fn distances_by_lists<S: PrimitiveSet<f64> + Sync + ?Sized>(
    lists: &CandidateLists<'_, S>,
    grid: &Grid,
    options: &FieldOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<f32>, GridError> {
    Sampler::new(lists, None, grid, options, progress)?.field()
}

/// The same with signs, as [`signed_distances`](super::signed_distances) has them. `lists` and `signed` are of the same scene.
///
/// # Errors
/// As [`distances_by_lists`].
pub fn signed_distances_by_lists<S: PrimitiveSet<f64> + Sync + ?Sized, I: ClosestPoint<f64> + Sync>(
    lists: &CandidateLists<'_, S>,
    signed: &SignedDistance<'_, I>,
    grid: &Grid,
    options: &FieldOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<f32>, GridError> {
    let sign = |place: &Point3<f64>, distance: f32| {
        // Winding numbers need no closest point, unless it is where the place is.
        let without = if distance > 0.0 { signed.sign_far_away(place) } else { None };
        without.or_else(|| Some(signed.closest_point(place)?.sign)).unwrap_or(Sign::Outside)
    };
    let within = |radius: f64, place: &Point3<f64>| signed.sign_within(radius, place);
    let signs = Signs { at: &sign, within: &within, changes_at_surface: signed.changes_at_surface() };
    Sampler::new(lists, Some(signs), grid, options, progress)?.field()
}

/// What tells signs.
struct Signs<'a> {
    /// Of a place at some distance.
    at: &'a (dyn Fn(&Point3<f64>, f32) -> Sign + Sync),
    /// Of all places within a radius of one, if no surface is between them and the sign is the same.
    within: &'a (dyn Fn(f64, &Point3<f64>) -> Option<Sign> + Sync),
    /// Whether places that no surface is between have the same sign.
    changes_at_surface: bool,
}

struct Sampler<'a, S: ?Sized> {
    lists: &'a CandidateLists<'a, S>,
    signs: Option<Signs<'a>>,
    grid: &'a Grid,
    axes: [Vec<f64>; 3],
    #[cfg_attr(not(feature = "rayon"), allow(dead_code, reason = "there is one thread"))]
    parallel: bool,
    band: f64,
    /// What is farther than this from the surface is farther from it than from a neighbour.
    apart: f64,
    progress: &'a (dyn Fn(usize) + Sync),
}

/// Some points of the grid.
#[derive(Clone, Copy)]
struct Block {
    first: [usize; 3],
    counts: [usize; 3],
}

/// Layers that are not divided among threads, and of which progress is told.
const SLAB: usize = 8;
/// Blocks of at most so many points are evaluated.
const POINTS: usize = 64;

impl Block {
    fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Its halves along an axis.
    fn halves(&self, axis: usize) -> [Self; 2] {
        let mut halves = [*self; 2];
        halves[0].counts[axis] = self.counts[axis] / 2;
        halves[1].counts[axis] -= halves[0].counts[axis];
        halves[1].first[axis] += halves[0].counts[axis];
        halves
    }

    /// Up to eight parts, halved along the longest axes, and no more than it takes for parts of [`POINTS`].
    fn parts(&self) -> Vec<Self> {
        let wanted = self.len().div_ceil(POINTS).min(8);
        let mut parts = vec![*self];
        while parts.len() < wanted {
            let counts = parts[0].counts;
            let axis = (0..3).max_by_key(|k| counts[*k]).unwrap_or(0);
            parts = parts.iter().flat_map(|part| part.halves(axis)).collect();
        }
        parts
    }
}

impl<'a, S: PrimitiveSet<f64> + Sync + ?Sized> Sampler<'a, S> {
    fn new(
        lists: &'a CandidateLists<'a, S>,
        signs: Option<Signs<'a>>,
        grid: &'a Grid,
        options: &FieldOptions,
        progress: &'a (dyn Fn(usize) + Sync),
    ) -> Result<Self, GridError> {
        let axis = |k: usize| -> Vec<f64> { (0..grid.counts()[k]).map(|i| grid.point([i; 3])[k]).collect() };
        let axes = [axis(0), axis(1), axis(2)];
        let largest = axes.iter().flatten().fold(0.0f64, |a, x| a.max(x.abs()));
        if largest > LARGEST {
            return Err(GridError::Range);
        }
        // Neighbours are not quite at the spacing from each other where that is not much above the rounding of points.
        // Values have the rounding of f32, and the error of a distance.
        let bounds = lists.set().aabb();
        let reach = largest.max(bounds.min.coords.amax()).max(bounds.max.coords.amax());
        let apart = grid.spacing() * 1.001 + 64.0 * f64::EPSILON * reach + f64::from(f32::from_bits(1));
        Ok(Self { lists, signs, grid, axes, parallel: options.parallel, band: band(options), apart, progress })
    }

    fn field(&self) -> Result<Vec<f32>, GridError> {
        let mut values = Vec::new();
        values.try_reserve_exact(self.grid.len()).map_err(|_| GridError::Memory(self.grid.len()))?;
        let (whole, all) = (Block { first: [0; 3], counts: self.grid.counts() }, self.lists.all());
        // Nothing is infinitely far, whatever the band; otherwise all blocks are filled.
        values.resize(self.grid.len(), f32::INFINITY);
        if all.is_empty() {
            (self.progress)(values.len());
        } else {
            self.layers(whole, &all, &mut values);
        }
        Ok(values)
    }

    fn bounds(&self, block: &Block) -> Aabb<f64> {
        let end = |last: usize| -> Point3<f64> {
            std::array::from_fn::<f64, 3, _>(|k| self.axes[k][block.first[k] + (block.counts[k] - 1) * last]).into()
        };
        Aabb { min: end(0), max: end(1) }
    }

    /// All points of some layers, whose values these are.
    fn layers(&self, block: Block, of: &Candidates, values: &mut [f32]) {
        let detail = if block.len() <= POINTS { Detail::Primitives } else { Detail::Groups };
        let candidates = self.lists.narrowed(of, &self.bounds(&block), detail);
        if block.counts[2] <= SLAB {
            self.block(block, &candidates, &mut Layers { grid: self.grid, first: block.first[2], values });
            return (self.progress)(block.len());
        }
        let halves = block.halves(2);
        let (low, high) = values.split_at_mut(halves[0].len());
        #[cfg(feature = "rayon")]
        if self.parallel {
            rayon::join(|| self.layers(halves[0], &candidates, low), || self.layers(halves[1], &candidates, high));
            return;
        }
        self.layers(halves[0], &candidates, low);
        self.layers(halves[1], &candidates, high);
    }

    fn block(&self, block: Block, candidates: &Candidates, layers: &mut Layers<'_>) {
        if candidates.nearest() > self.band {
            return self.beyond(block, layers);
        }
        if block.len() <= POINTS {
            return self.evaluate(block, candidates, layers);
        }
        for part in block.parts() {
            let detail = if part.len() <= POINTS { Detail::Primitives } else { Detail::Groups };
            let candidates = self.lists.narrowed(candidates, &self.bounds(&part), detail);
            self.block(part, &candidates, layers);
        }
    }

    /// The sign of all points of a block that has no surface in it; `None` where they may differ.
    fn sign_of_block(&self, block: &Block) -> Option<Sign> {
        let Some(signs) = &self.signs else { return Some(Sign::Outside) };
        let Aabb { min, max } = self.bounds(block);
        let middle = nalgebra::center(&min, &max);
        let radius = (max - middle).norm().max((middle - min).norm()) * (1.0 + 1e-9);
        (signs.within)(radius, &middle)
    }

    /// A block that is beyond the band.
    fn beyond(&self, block: Block, layers: &mut Layers<'_>) {
        let shared = self.sign_of_block(&block);
        if shared.is_none() && block.len() > POINTS {
            return block.parts().into_iter().for_each(|part| self.beyond(part, layers));
        }
        layers.fill(block.first, block.counts, |number| {
            let sign = shared.unwrap_or_else(|| self.sign_at(&self.grid.point(number), f32::INFINITY));
            signed_value(self.band, self.band, sign)
        });
    }

    fn sign_at(&self, place: &Point3<f64>, distance: f32) -> Sign {
        self.signs.as_ref().map_or(Sign::Outside, |signs| (signs.at)(place, distance))
    }

    fn evaluate(&self, block: Block, candidates: &Candidates, layers: &mut Layers<'_>) {
        let mut distances = [0.0f32; POINTS];
        let distances = &mut distances[..block.len()];
        let axes = [0, 1, 2].map(|k: usize| &self.axes[k][block.first[k]..block.first[k] + block.counts[k]]);
        self.lists.distances(candidates, axes, distances);
        let mut signs = [Sign::Outside; POINTS];
        if self.signs.is_some() {
            let shared = if candidates.nearest() > 0.0 { self.sign_of_block(&block) } else { None };
            match shared {
                Some(sign) => signs.fill(sign),
                None => self.signs_of(&block, distances, &mut signs),
            }
        }
        let mut values = distances.iter().zip(&signs).map(|(d, sign)| signed_value(f64::from(*d), self.band, *sign));
        layers.fill(block.first, block.counts, |_| values.next().unwrap_or(f32::NAN));
    }

    /// The signs of the points of a block with these distances.
    fn signs_of(&self, block: &Block, distances: &[f32], signs: &mut [Sign]) {
        let [x, y, _] = block.counts;
        let at = |n: usize| {
            let number = [n % x, n / x % y, n / (x * y)];
            self.grid.point([0, 1, 2].map(|k: usize| block.first[k] + number[k]))
        };
        let is_shared = self.signs.as_ref().is_some_and(|signs| signs.changes_at_surface);
        for n in 0..distances.len() {
            let before = [(1, x), (x, y), (x * y, block.counts[2])];
            let neighbour = before.into_iter().find(|(step, count)| {
                is_shared
                    && n / step % count > 0
                    && f64::from(distances[n - step].max(distances[n]).min(f32::MAX)) > self.apart
            });
            signs[n] = match neighbour {
                Some((step, _)) => signs[n - step],
                None => self.sign_at(&at(n), distances[n]),
            };
        }
    }
}
