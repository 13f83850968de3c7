//! Fields by candidate lists: blocks of the grid get lists of the primitives that can be nearest in them.
//!
//! The grid is halved until blocks have a few dozen points. The candidates of a half are found among the candidates of
//! the whole block ([`CandidateLists`]). No index is needed, and most of the work is shared by all points of a block.
//!
//! **Bands.** A block is not halved any further if all of it is beyond the band.
//!
//! **Signs.** The sign of a surface without a boundary changes only at the surface. So a block that the surface does
//! not cross has the sign of its centre, and two neighbouring points have the same sign if one of them is farther from
//! the surface than from the other. Points that are connected in this way have one sign. With respect to an open
//! surface, the winding numbers of all points of a block are computed together.

use crate::grid::{Grid, GridError};
use crate::grid_candidates::{CandidateLists, Candidates, Detail, MAX_COORDINATE};
use crate::layers::Layers;
use crate::options::{FieldOptions, signed_value};
use crate::sign::{PointBlock, SharedSoup, Sign, SignedDistance};
use nalgebra::Point3;
use p2m_core::engine::parallel;
use p2m_core::{Aabb, ClosestPoint, PrimitiveSet};

/// Returns the distances at the points of a grid, computed from candidate lists instead of an index.
///
/// The values equal the values of [`distances`](crate::distances), bit for bit. Lists are the fastest way to a field
/// whose blocks of 64 points are not much larger than the primitives, or are farther from the primitives than they are
/// wide.
///
/// # Errors
/// [`GridError::Memory`] if the values do not fit into memory, and [`GridError::Range`] for coordinates above 2^250.
///
/// # Complexity
/// O(k) per point, with k candidates in its block. Memory is 4 bytes per point, and 4 bytes for each
/// candidate of a block and of the larger blocks that contain it.
pub fn distances_by_lists<S: PrimitiveSet<f64> + Sync + ?Sized>(
    lists: &CandidateLists<'_, S>,
    grid: &Grid,
    options: &FieldOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<f32>, GridError> {
    Sampler::new(lists, None, grid, options, progress)?.field()
}

/// Returns the signed distances at the points of a grid, computed from candidate lists.
///
/// The values equal the values of [`signed_distances`](crate::signed_distances), bit for bit. `lists` and `signed` have
/// to be of the same scene.
///
/// # Errors
/// [`GridError::Memory`] if the values do not fit into memory, and [`GridError::Range`] for coordinates above 2^250.
pub fn signed_distances_by_lists<S: PrimitiveSet<f64> + Sync + ?Sized, I: ClosestPoint<f64> + Sync, R: SharedSoup>(
    lists: &CandidateLists<'_, S>,
    signed: &SignedDistance<I, R>,
    grid: &Grid,
    options: &FieldOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<f32>, GridError> {
    // The error of the distance of a point on the surface is far below this.
    let bounds = lists.set().aabb().union(&Aabb { min: grid.origin(), max: grid.point(grid.counts().map(|n| n - 1)) });
    let on_surface = 1e-9 * bounds.min.coords.amax().max(bounds.max.coords.amax());
    let sign = |point: &Point3<f64>, distance: f32| {
        // A ray is faster than a query, but does not tell that the point is on the surface.
        if f64::from(distance) > on_surface {
            return signed.sign_without_closest_point(point);
        }
        signed.closest_point(point).map_or(Sign::Outside, |answer| answer.sign)
    };
    let in_ball = |radius: f64, centre: &Point3<f64>| signed.sign_in_ball(radius, centre);
    let in_block = |block: &PointBlock<'_>, candidates: &Candidates, signs: &mut [Option<Sign>]| {
        signed.signs_of_block(block, lists.primitives(candidates), signs);
    };
    let signs =
        Signs { at: &sign, in_ball: &in_ball, in_block: (!signed.is_closed()).then_some(&in_block), on_surface };
    Sampler::new(lists, Some(signs), grid, options, progress)?.field()
}

/// Returns the common sign of all points of a ball that the surface does not cross, or `None` if they may differ.
type SignInBall<'a> = dyn Fn(f64, &Point3<f64>) -> Option<Sign> + Sync + 'a;

/// Computes the signs of the points of a block with these candidates, except for points that single queries have to
/// decide.
type SignsInBlock<'a> = dyn Fn(&PointBlock<'_>, &Candidates, &mut [Option<Sign>]) + Sync + 'a;

/// The functions that compute signs.
struct Signs<'a> {
    /// Returns the sign of a point, given its distance from the surface.
    at: &'a (dyn Fn(&Point3<f64>, f32) -> Sign + Sync),
    in_ball: &'a SignInBall<'a>,
    /// Computes the signs of the points of a block, for an open surface.
    in_block: Option<&'a SignsInBlock<'a>>,
    /// Points at a smaller distance than this may be on the surface.
    on_surface: f64,
}

/// Computes the values of a field by candidate lists.
struct Sampler<'a, S: ?Sized> {
    lists: &'a CandidateLists<'a, S>,
    signs: Option<Signs<'a>>,
    grid: &'a Grid,
    /// The coordinates of the points along each axis.
    axes: [Vec<f64>; 3],
    #[cfg_attr(not(feature = "rayon"), allow(dead_code, reason = "there is one thread"))]
    parallel: bool,
    band: f64,
    /// An upper bound on the distance of neighbouring points, including the rounding of points and values. A point
    /// whose value exceeds it is farther from the surface than from its neighbours.
    max_neighbour_distance: f64,
    progress: &'a (dyn Fn(usize) + Sync),
}

/// A block of points of the grid.
#[derive(Clone, Copy)]
struct Block {
    first: [usize; 3],
    counts: [usize; 3],
}

/// The largest number of layers of a slab. One thread computes a slab, and reports progress after it.
const MAX_SLAB_LAYERS: usize = 8;
/// The largest number of points of a block that is evaluated. Larger blocks are divided.
const MAX_EVALUATED_POINTS: usize = 64;

impl Block {
    fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Returns the two halves of the block along an axis.
    fn halves(&self, axis: usize) -> [Self; 2] {
        let mut halves = [*self; 2];
        halves[0].counts[axis] = self.counts[axis] / 2;
        halves[1].counts[axis] -= halves[0].counts[axis];
        halves[1].first[axis] += halves[0].counts[axis];
        halves
    }

    /// Halves the block along its longest axes into two, four or eight, but no further than to blocks of
    /// [`MAX_EVALUATED_POINTS`].
    fn divided(&self) -> Vec<Self> {
        let wanted = self.len().div_ceil(MAX_EVALUATED_POINTS).min(8);
        let mut blocks = vec![*self];
        while blocks.len() < wanted {
            let counts = blocks[0].counts;
            let axis = (0..3).max_by_key(|k| counts[*k]).unwrap_or(0);
            blocks = blocks.iter().flat_map(|block| block.halves(axis)).collect();
        }
        blocks
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
        if largest > MAX_COORDINATE {
            return Err(GridError::Range);
        }
        // The distance of neighbours differs from the spacing where the rounding of coordinates is not small beside it.
        // Values are rounded to f32 and have the error of a distance.
        let bounds = lists.set().aabb();
        let largest = largest.max(bounds.min.coords.amax()).max(bounds.max.coords.amax());
        let max_neighbour_distance =
            grid.spacing() * 1.001 + 64.0 * f64::EPSILON * largest + f64::from(f32::from_bits(1));
        let (parallel, band) = (options.parallel, options.checked_band());
        Ok(Self { lists, signs, grid, axes, parallel, band, max_neighbour_distance, progress })
    }

    fn field(&self) -> Result<Vec<f32>, GridError> {
        let mut values = Vec::new();
        values.try_reserve_exact(self.grid.len()).map_err(|_| GridError::Memory(self.grid.len()))?;
        let (root, all) = (Block { first: [0; 3], counts: self.grid.counts() }, self.lists.all());
        // An empty scene is infinitely far away, whatever the band. Otherwise every block is filled.
        values.resize(self.grid.len(), f32::INFINITY);
        if all.is_empty() {
            (self.progress)(values.len());
        } else {
            self.layers(root, &all, &mut values);
        }
        Ok(values)
    }

    fn bounds(&self, block: &Block) -> Aabb<f64> {
        let end = |last: usize| -> Point3<f64> {
            std::array::from_fn::<f64, 3, _>(|k| self.axes[k][block.first[k] + (block.counts[k] - 1) * last]).into()
        };
        Aabb { min: end(0), max: end(1) }
    }

    /// Computes the values of complete layers. `candidates` are the candidates of a block that contains the layers.
    fn layers(&self, block: Block, candidates: &Candidates, values: &mut [f32]) {
        let detail = if block.len() <= MAX_EVALUATED_POINTS { Detail::Primitives } else { Detail::Groups };
        let candidates = self.lists.narrowed(candidates, &self.bounds(&block), detail);
        if block.counts[2] <= MAX_SLAB_LAYERS {
            self.block(block, &candidates, None, &mut Layers { grid: self.grid, first: block.first[2], values });
            return (self.progress)(block.len());
        }
        let halves = block.halves(2);
        let (low, high) = values.split_at_mut(halves[0].len());
        let (low, high) = (|| self.layers(halves[0], &candidates, low), || self.layers(halves[1], &candidates, high));
        parallel::join(self.parallel, low, high);
    }

    /// Computes the points of a block with its candidates, and their common sign if that is known.
    fn block(&self, block: Block, candidates: &Candidates, sign: Option<Sign>, layers: &mut Layers<'_>) {
        if candidates.nearest() > self.band {
            return self.fill_beyond_band(block, layers);
        }
        let sign = sign.or_else(|| if candidates.nearest() > 0.0 { self.sign_of_block(&block) } else { None });
        if block.len() <= MAX_EVALUATED_POINTS {
            return self.evaluate(block, candidates, sign, layers);
        }
        for part in block.divided() {
            let detail = if part.len() <= MAX_EVALUATED_POINTS { Detail::Primitives } else { Detail::Groups };
            let candidates = self.lists.narrowed(candidates, &self.bounds(&part), detail);
            self.block(part, &candidates, sign, layers);
        }
    }

    /// Returns the common sign of all points of a block that the surface does not cross, or `None` if they may differ.
    fn sign_of_block(&self, block: &Block) -> Option<Sign> {
        let Some(signs) = &self.signs else { return Some(Sign::Outside) };
        let Aabb { min, max } = self.bounds(block);
        let centre = nalgebra::center(&min, &max);
        let radius = (max - centre).norm().max((centre - min).norm()) * (1.0 + 1e-9);
        (signs.in_ball)(radius, &centre)
    }

    /// Sets the values of a block that is beyond the band.
    fn fill_beyond_band(&self, block: Block, layers: &mut Layers<'_>) {
        let shared = self.sign_of_block(&block);
        if shared.is_none() && block.len() > MAX_EVALUATED_POINTS {
            return block.divided().into_iter().for_each(|part| self.fill_beyond_band(part, layers));
        }
        layers.fill(block.first, block.counts, |number| {
            let sign = shared.unwrap_or_else(|| self.sign_at(&self.grid.point(number), f32::INFINITY));
            signed_value(self.band, self.band, sign)
        });
    }

    fn sign_at(&self, point: &Point3<f64>, distance: f32) -> Sign {
        self.signs.as_ref().map_or(Sign::Outside, |signs| (signs.at)(point, distance))
    }

    /// Evaluates the candidates of a block at all of its points, which may have a common sign that is known.
    fn evaluate(&self, block: Block, candidates: &Candidates, shared: Option<Sign>, layers: &mut Layers<'_>) {
        let mut distances = [0.0f32; MAX_EVALUATED_POINTS];
        let distances = &mut distances[..block.len()];
        self.lists.distances(candidates, self.axes_of(&block), distances);
        let mut signs = [Sign::Outside; MAX_EVALUATED_POINTS];
        match shared {
            Some(sign) => signs.fill(sign),
            None => self.signs_of(&block, candidates, distances, &mut signs),
        }
        let mut values = distances.iter().zip(&signs).map(|(d, sign)| signed_value(f64::from(*d), self.band, *sign));
        layers.fill(block.first, block.counts, |_| values.next().unwrap_or(f32::NAN));
    }

    /// Computes the signs of the points of a block that the surface may cross.
    fn signs_of(&self, block: &Block, candidates: &Candidates, distances: &[f32], out: &mut [Sign]) {
        let Some(signs) = &self.signs else { return };
        let [x, y, z] = block.counts;
        let at = |n: usize| {
            let offset = [n % x, n / x % y, n / (x * y)];
            self.grid.point([0, 1, 2].map(|k: usize| block.first[k] + offset[k]))
        };
        let points = PointBlock {
            axes: self.axes_of(block),
            distances,
            max_neighbour_distance: self.max_neighbour_distance,
            on_surface: signs.on_surface,
        };
        if let Some(in_block) = signs.in_block {
            let mut known = [None; MAX_EVALUATED_POINTS];
            in_block(&points, candidates, &mut known[..distances.len()]);
            for (n, out) in out[..distances.len()].iter_mut().enumerate() {
                *out = known[n].unwrap_or_else(|| (signs.at)(&at(n), distances[n]));
            }
            return;
        }
        // A point has the sign of the neighbour before it if the surface cannot be between them.
        for n in 0..distances.len() {
            let before = [(1, x), (x, y), (x * y, z)];
            let is_beside =
                |(step, count): &(usize, usize)| n / step % count > 0 && !points.may_be_crossed(n - step, n);
            let neighbour = before.into_iter().find(is_beside);
            out[n] = neighbour.map_or_else(|| (signs.at)(&at(n), distances[n]), |(step, _)| out[n - step]);
        }
    }

    /// Returns the coordinates of the points of a block along each axis.
    fn axes_of(&self, block: &Block) -> [&[f64]; 3] {
        [0, 1, 2].map(|k: usize| &self.axes[k][block.first[k]..block.first[k] + block.counts[k]])
    }
}
