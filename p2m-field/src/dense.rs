//! A value for each point of a grid.
//!
//! **Coherence.** Points are answered row by row in slabs, each with the primitive of its neighbour as a hint, or many side by
//! side where the index does that better; answers are those of single queries, bit for bit, rounded to f32.
//!
//! **Bands.** A block of points whose middle is farther from the surface than the band and half of its diagonal has no
//! point in the band; blocks are cut in eight until that is so or they are single points. Signs beyond the band are those of single
//! answers, too: by winding numbers for each point, of closed surfaces that of the middle of the block, since there is no surface in it (of one that meets
//! itself that is the sign of the part nearest to the middle).

use super::layers::Layers;
use super::{Grid, GridError};
use crate::sign::{Sign, SignedDistance};
use nalgebra::Point3;
use p2m_core::{Closest, ClosestPoint, QueryOptions};

/// What of a field is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FieldOptions {
    /// Distances above this are not computed: the field has this value there, with the sign that is right. Infinite by
    /// default.
    pub band: f64,
    /// Whether each point is answered with the primitive of its neighbour as a hint, which pays for trees, or without, which
    /// does for the interception indexes. Answers are the same. With hints by default.
    pub hints: bool,
    /// Whether to use all threads of the current pool; needs the feature `rayon`, without which one thread does it all. By
    /// default, yes. The field is the same.
    pub parallel: bool,
}

impl Default for FieldOptions {
    fn default() -> Self {
        Self { band: f64::INFINITY, hints: true, parallel: true }
    }
}

impl FieldOptions {
    /// With distances up to this alone; one that is negative or NaN counts as 0.
    #[must_use]
    pub fn with_band(self, band: f64) -> Self {
        Self { band, ..self }
    }
    /// With hints, or without.
    #[must_use]
    pub fn with_hints(self, hints: bool) -> Self {
        Self { hints, ..self }
    }
    /// On all threads, or on one.
    #[must_use]
    pub fn with_parallel(self, parallel: bool) -> Self {
        Self { parallel, ..self }
    }
}

/// The distances at the points of a grid, in the order of [`Grid::number`]: those of [`ClosestPoint::closest_point`], rounded to
/// f32; infinite for an empty scene, and above the range of f32. `progress` hears how many points are done, from any thread.
///
/// # Errors
/// [`GridError::Memory`].
///
/// # Complexity
/// A query for each point, or for each point in the band and O(1) for each block beside it. 4 bytes a point.
pub fn distances<I: ClosestPoint<f64> + Sync + ?Sized>(
    index: &I,
    grid: &Grid,
    options: &FieldOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<f32>, GridError> {
    let sample = Sampler { index, signs: None, grid, options, band: band(options) };
    sample.field(progress)
}

/// The same with signs, negative inside; NaN where the sign is not defined.
///
/// # Errors
/// As [`distances`].
pub fn signed_distances<I: ClosestPoint<f64> + Sync>(
    signed: &SignedDistance<'_, I>,
    grid: &Grid,
    options: &FieldOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<f32>, GridError> {
    let near = |query: &Point3<f64>, closest: &Closest<f64>| signed.sign(query, closest);
    let far = |place: &Point3<f64>| signed.sign_far_away(place);
    let signs = Some(Signs { near: &near, far: &far });
    let sample = Sampler { index: signed.index(), signs, grid, options, band: band(options) };
    sample.field(progress)
}

pub(super) fn band(options: &FieldOptions) -> f64 {
    options.band.max(0.0)
}

/// What a field has for a distance and a sign.
#[allow(clippy::cast_possible_truncation, reason = "values are rounded to f32")]
pub(super) fn signed_value(distance: f64, band: f64, sign: Sign) -> f32 {
    let distance = distance.min(band) as f32;
    match sign {
        Sign::Outside => distance,
        Sign::Inside => -distance,
        Sign::Boundary => 0.0,
        Sign::Undefined => f32::NAN,
    }
}

/// What tells signs.
struct Signs<'a> {
    /// Of an answer.
    near: &'a (dyn Fn(&Point3<f64>, &Closest<f64>) -> Sign + Sync),
    /// Of a place beyond the band, if that is not the sign of its block.
    far: &'a (dyn Fn(&Point3<f64>) -> Option<Sign> + Sync),
}

struct Sampler<'a, I: ?Sized> {
    index: &'a I,
    signs: Option<Signs<'a>>,
    grid: &'a Grid,
    options: &'a FieldOptions,
    band: f64,
}

/// Layers of a slab, which one thread fills: the sides of the largest blocks of a band.
const SLAB: usize = 16;
/// Points asked side by side.
const BATCH: usize = 64;

impl<I: ClosestPoint<f64> + Sync + ?Sized> Sampler<'_, I> {
    fn field(&self, progress: &(dyn Fn(usize) + Sync)) -> Result<Vec<f32>, GridError> {
        let [x, y, z] = self.grid.counts();
        let (layer, len) = (x * y, x * y * z);
        let mut values = Vec::new();
        values.try_reserve_exact(len).map_err(|_| GridError::Memory(len))?;
        // All slabs are filled.
        values.resize(len, 0.0);
        let fill = |(slab, values): (usize, &mut [f32])| {
            if self.band < f64::INFINITY {
                let counts = [x, y, values.len() / layer];
                self.blocks([0, 0, slab * SLAB], counts, &mut Layers { grid: self.grid, first: slab * SLAB, values });
            } else {
                self.rows(slab * SLAB, values);
            }
            progress(values.len());
        };
        #[cfg(feature = "rayon")]
        if self.options.parallel {
            use rayon::prelude::*;
            values.par_chunks_mut(layer * SLAB).enumerate().for_each(fill);
            return Ok(values);
        }
        values.chunks_mut(layer * SLAB).enumerate().for_each(fill);
        Ok(values)
    }

    /// All points of some layers. Sixteen rows of sixteen layers at a time, so that what they need stays in the cache.
    fn rows(&self, first: usize, values: &mut [f32]) {
        let [x, y, _] = self.grid.counts();
        let layers = values.len() / (x * y);
        let mut options = QueryOptions::default();
        for strip in (0..y).step_by(SLAB) {
            for i in (0..x).step_by(BATCH) {
                for k in 0..layers {
                    for j in strip..(strip + SLAB).min(y) {
                        let count = BATCH.min(x - i);
                        let start = (k * y + j) * x + i;
                        let out = &mut values[start..start + count];
                        self.piece([i, j, first + k], out, &mut options);
                    }
                }
            }
        }
    }

    /// Some points of a row.
    fn piece(&self, [i, j, k]: [usize; 3], out: &mut [f32], options: &mut QueryOptions<f64>) {
        let mut queries = [Point3::origin(); BATCH];
        let mut answers = [None; BATCH];
        let count = out.len();
        for (n, query) in queries[..count].iter_mut().enumerate() {
            *query = self.grid.point([i + n, j, k]);
        }
        if self.options.hints {
            for (query, answer) in queries[..count].iter().zip(&mut answers) {
                *answer = self.index.closest_point_with(query, options);
                options.hint = answer.map(|answer: Closest<f64>| answer.primitive);
            }
        } else {
            self.index.closest_points_into(&queries[..count], options, &mut answers[..count]);
        }
        for ((query, answer), value) in queries.iter().zip(&answers).zip(out) {
            *value = self.value(query, answer.as_ref());
        }
    }

    /// The value of a point by its answer.
    fn value(&self, query: &Point3<f64>, answer: Option<&Closest<f64>>) -> f32 {
        let Some(answer) = answer else { return f32::INFINITY };
        let sign = self.signs.as_ref().map_or(Sign::Outside, |signs| (signs.near)(query, answer));
        signed_value(answer.distance, self.band, sign)
    }

    /// All points of a block that are in the band.
    fn blocks(&self, first: [usize; 3], counts: [usize; 3], layers: &mut Layers<'_>) {
        // Blocks of the slab about as wide as it is deep.
        for j in (0..counts[1]).step_by(SLAB) {
            for i in (0..counts[0]).step_by(SLAB) {
                let first = [first[0] + i, first[1] + j, first[2]];
                let counts = [SLAB.min(counts[0] - i), SLAB.min(counts[1] - j), counts[2]];
                self.block(first, counts, None, layers);
            }
        }
    }

    fn block(&self, first: [usize; 3], counts: [usize; 3], hint: Option<Closest<f64>>, layers: &mut Layers<'_>) {
        let last: [usize; 3] = std::array::from_fn(|k| first[k] + counts[k] - 1);
        let [low, high] = [self.grid.point(first), self.grid.point(last)];
        let middle = Point3::from(std::array::from_fn::<f64, 3, _>(|k| low[k] * 0.5 + high[k] * 0.5));
        // What is farther than this from the middle is outside of the band everywhere in the block.
        let reach = {
            let half: [f64; 3] = std::array::from_fn(|k| (high[k] - middle[k]).max(middle[k] - low[k]));
            let ulp = high.coords.amax().max(low.coords.amax()) * f64::EPSILON;
            self.band + (half[0].hypot(half[1]).hypot(half[2]) + 4.0 * ulp) * (1.0 + 1e-9)
        };
        let mut options = QueryOptions::default();
        options.hint = hint.map(|hint| hint.primitive);
        let answer = self.index.closest_point_with(&middle, &options);
        let is_single = counts == [1; 3];
        if is_single || answer.is_none_or(|answer| answer.lower_bound > reach) {
            let value = self.value(&middle, answer.as_ref());
            let far = self.signs.as_ref().filter(|_| !is_single && answer.is_some());
            layers.fill(first, counts, |number| {
                let sign = far.and_then(|signs| (signs.far)(&self.grid.point(number)));
                sign.map_or(value, |sign| signed_value(self.band, self.band, sign))
            });
            return;
        }
        let halves = counts.map(|n| [n.div_ceil(2), n / 2]);
        for part in 0..8 {
            let side = |k: usize| part >> k & 1;
            let counts: [usize; 3] = std::array::from_fn(|k| halves[k][side(k)]);
            if counts.iter().all(|n| *n > 0) {
                let first = std::array::from_fn(|k| first[k] + side(k) * halves[k][0]);
                self.block(first, counts, answer, layers);
            }
        }
    }
}
