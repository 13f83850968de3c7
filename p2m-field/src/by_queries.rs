//! Fields by queries: an index answers each point of a grid.
//!
//! **Coherence.** Each slab of layers is answered row by row. The closest primitive of a point is the hint for the next
//! one, or a batch of points is passed to the index at once. The values are the answers to single queries, bit for bit,
//! rounded to f32.
//!
//! **Bands.** A block of points has no point in the band if the distance of its centre exceeds the band plus half of
//! the diagonal of the block. Other blocks are divided into eight until they are empty or single points. Signs beyond
//! the band equal the signs of single queries as well: no surface crosses an empty block, so the sign of its centre
//! holds for all of it, or winding numbers are computed for each point where they may differ.

use crate::grid::{Grid, GridError};
use crate::layers::Layers;
use crate::options::{FieldOptions, signed_value};
use crate::sign::{SharedSoup, Sign, SignedDistance};
use nalgebra::Point3;
use p2m_core::engine::parallel;
use p2m_core::{Closest, ClosestPoint, QueryOptions};

/// Returns the distances at the points of a grid, in the order of [`Grid::number`].
///
/// A value is the distance of [`ClosestPoint::closest_point`], rounded to f32. It is infinite if the scene is empty or
/// the distance exceeds the range of f32. `progress` is called with the number of points that were finished since its
/// last call, from any thread.
///
/// # Errors
/// [`GridError::Memory`] if the values do not fit into memory.
///
/// # Complexity
/// One query for each point; with a band, one for each point in the band and for each block outside of it. Memory is
/// 4 bytes per point.
pub fn distances<I: ClosestPoint<f64> + Sync + ?Sized>(
    index: &I,
    grid: &Grid,
    options: &FieldOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<f32>, GridError> {
    let sampler = Sampler { index, signs: None, grid, options, band: options.checked_band() };
    sampler.field(progress)
}

/// Returns the signed distances at the points of a grid, in the order of [`Grid::number`].
///
/// The values are the distances of [`distances`], negative inside, and NaN where the sign is not defined.
///
/// # Errors
/// [`GridError::Memory`] if the values do not fit into memory.
pub fn signed_distances<I: ClosestPoint<f64> + Sync, R: SharedSoup>(
    signed: &SignedDistance<I, R>,
    grid: &Grid,
    options: &FieldOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<f32>, GridError> {
    let near = |query: &Point3<f64>, closest: &Closest<f64>| signed.sign(query, closest);
    let around = |radius: f64, point: &Point3<f64>, closest: &Closest<f64>| {
        let is_closed = signed.is_closed();
        if is_closed { Some(signed.sign(point, closest)) } else { signed.sign_in_ball(radius, point) }
    };
    let far = |point: &Point3<f64>| signed.sign_without_closest_point(point);
    let signs = Some(Signs { near: &near, around: &around, far: &far });
    let sampler = Sampler { index: signed.index(), signs, grid, options, band: options.checked_band() };
    sampler.field(progress)
}

/// Returns the common sign of the points around a point, given a radius and the closest point.
type SignAround<'a> = dyn Fn(f64, &Point3<f64>, &Closest<f64>) -> Option<Sign> + Sync + 'a;

/// The functions that compute signs.
struct Signs<'a> {
    /// Returns the sign of a query by its closest point.
    near: &'a (dyn Fn(&Point3<f64>, &Closest<f64>) -> Sign + Sync),
    /// Returns the common sign of all points within a radius of a point, by its closest point, which is farther. It is
    /// `None` if their signs may differ.
    around: &'a SignAround<'a>,
    /// Returns the sign of a point beyond the band, where signs differ within a block.
    far: &'a (dyn Fn(&Point3<f64>) -> Sign + Sync),
}

/// Computes the values of a field by queries to an index.
struct Sampler<'a, I: ?Sized> {
    index: &'a I,
    signs: Option<Signs<'a>>,
    grid: &'a Grid,
    options: &'a FieldOptions,
    band: f64,
}

/// The number of layers of a slab, which one thread fills. The largest blocks of a band have as many points along each
/// axis.
const SLAB_LAYERS: usize = 16;
/// The number of points that are passed to the index at once.
const BATCH_POINTS: usize = 64;

impl<I: ClosestPoint<f64> + Sync + ?Sized> Sampler<'_, I> {
    fn field(&self, progress: &(dyn Fn(usize) + Sync)) -> Result<Vec<f32>, GridError> {
        let [x, y, z] = self.grid.counts();
        let (layer, len) = (x * y, x * y * z);
        let mut values = Vec::new();
        values.try_reserve_exact(len).map_err(|_| GridError::Memory(len))?;
        // The zeros do not stay, because every slab is filled.
        values.resize(len, 0.0);
        let fill = |slab: usize, values: &mut [f32]| {
            if self.band < f64::INFINITY {
                let counts = [x, y, values.len() / layer];
                self.blocks(
                    [0, 0, slab * SLAB_LAYERS],
                    counts,
                    &mut Layers { grid: self.grid, first: slab * SLAB_LAYERS, values },
                );
            } else {
                self.rows(slab * SLAB_LAYERS, values);
            }
            progress(values.len());
        };
        parallel::for_each_chunk(&mut values, layer * SLAB_LAYERS, self.options.parallel, fill);
        Ok(values)
    }

    /// Computes all points of a slab. Sixteen rows of sixteen layers are computed at a time, so that the nodes and
    /// primitives that they need stay in the cache.
    fn rows(&self, first: usize, values: &mut [f32]) {
        let [x, y, _] = self.grid.counts();
        let layers = values.len() / (x * y);
        for strip in (0..y).step_by(SLAB_LAYERS) {
            for i in (0..x).step_by(BATCH_POINTS) {
                for k in 0..layers {
                    for j in strip..(strip + SLAB_LAYERS).min(y) {
                        let count = BATCH_POINTS.min(x - i);
                        let start = (k * y + j) * x + i;
                        let out = &mut values[start..start + count];
                        self.batch([i, j, first + k], out);
                    }
                }
            }
        }
    }

    /// Computes at most [`BATCH_POINTS`] consecutive points of a row.
    fn batch(&self, [i, j, k]: [usize; 3], out: &mut [f32]) {
        let mut queries = [Point3::origin(); BATCH_POINTS];
        let mut answers = [None; BATCH_POINTS];
        let count = out.len();
        for (n, query) in queries[..count].iter_mut().enumerate() {
            *query = self.grid.point([i + n, j, k]);
        }
        self.index.closest_points_into(&queries[..count], &QueryOptions::default(), &mut answers[..count]);
        for ((query, answer), value) in queries.iter().zip(&answers).zip(out) {
            *value = self.value(query, answer.as_ref());
        }
    }

    /// Returns the value of a point, given the answer to its query.
    fn value(&self, query: &Point3<f64>, answer: Option<&Closest<f64>>) -> f32 {
        let Some(answer) = answer else { return f32::INFINITY };
        let sign = self.signs.as_ref().map_or(Sign::Outside, |signs| (signs.near)(query, answer));
        signed_value(answer.distance, self.band, sign)
    }

    /// Computes the points of a slab with a band. The slab is divided into blocks that are about as wide as it is deep.
    fn blocks(&self, first: [usize; 3], counts: [usize; 3], layers: &mut Layers<'_>) {
        for j in (0..counts[1]).step_by(SLAB_LAYERS) {
            for i in (0..counts[0]).step_by(SLAB_LAYERS) {
                let first = [first[0] + i, first[1] + j, first[2]];
                let counts = [SLAB_LAYERS.min(counts[0] - i), SLAB_LAYERS.min(counts[1] - j), counts[2]];
                self.block(first, counts, None, layers);
            }
        }
    }

    /// Computes the points of a block with a band. The answer to a query near the block is its hint.
    fn block(&self, first: [usize; 3], counts: [usize; 3], hint: Option<Closest<f64>>, layers: &mut Layers<'_>) {
        let last: [usize; 3] = std::array::from_fn(|k| first[k] + counts[k] - 1);
        let [low, high] = [self.grid.point(first), self.grid.point(last)];
        let centre = Point3::from(std::array::from_fn::<f64, 3, _>(|k| low[k] * 0.5 + high[k] * 0.5));
        let radius = {
            let half: [f64; 3] = std::array::from_fn(|k| (high[k] - centre[k]).max(centre[k] - low[k]));
            let ulp = high.coords.amax().max(low.coords.amax()) * f64::EPSILON;
            (half[0].hypot(half[1]).hypot(half[2]) + 4.0 * ulp) * (1.0 + 1e-9)
        };
        // If the surface is farther than this from the centre, no point of the block is in the band.
        let band_from_centre = self.band + radius;
        let mut options = QueryOptions::default();
        options.hint = hint.map(|hint| hint.primitive);
        let answer = self.index.closest_point_with(&centre, &options);
        let is_single = counts == [1; 3];
        if is_single || answer.is_none_or(|answer| answer.lower_bound > band_from_centre) {
            let value = match (&self.signs, &answer) {
                (Some(signs), Some(closest)) if !is_single => match (signs.around)(radius, &centre, closest) {
                    Some(sign) => signed_value(self.band, self.band, sign),
                    None => {
                        layers.fill(first, counts, |number| {
                            signed_value(self.band, self.band, (signs.far)(&self.grid.point(number)))
                        });
                        return;
                    }
                },
                _ => self.value(&centre, answer.as_ref()),
            };
            layers.fill(first, counts, |_| value);
            return;
        }
        let halves = counts.map(|n| [n.div_ceil(2), n / 2]);
        for octant in 0..8 {
            let side = |k: usize| octant >> k & 1;
            let counts: [usize; 3] = std::array::from_fn(|k| halves[k][side(k)]);
            if counts.iter().all(|n| *n > 0) {
                let first = std::array::from_fn(|k| first[k] + side(k) * halves[k][0]);
                self.block(first, counts, answer, layers);
            }
        }
    }
}
