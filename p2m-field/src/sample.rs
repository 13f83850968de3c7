//! Random points on and around scenes, the same bits on every platform and for every number of threads.
//!
//! Sample i depends on the scene, the seed and i alone, so a longer list begins with the shorter one, and any part of a
//! list can be computed by itself. The numbers are hashes of the seed and a counter \[Steele2014\]. Logarithms are
//! computed by the crate libm.
//!
//! ```
//! use p2m_field::sample::{SurfaceSampler, in_box};
//! use p2m_mixed::generate::{IcoSphere, ico_sphere};
//!
//! let ball = ico_sphere(&IcoSphere { frequency: 20 }).unwrap();
//! let sampler = SurfaceSampler::new(&ball).expect("the ball has an area");
//! let on_it = sampler.surface(7, 1000);
//! assert!(on_it.points.iter().all(|point| (point.coords.norm() - 1.0).abs() < 0.01));
//! let near = sampler.near(7, 1000, &[0.1]);
//! let mean = near.points.iter().map(|point| point.coords.norm()).sum::<f64>() / 1000.0;
//! assert!((mean - 1.0).abs() < 0.05);
//! let bounds = p2m_core::PrimitiveSet::aabb(&ball);
//! assert_eq!(in_box(&bounds, 7, 1000)[..10], in_box(&bounds, 7, 10));
//! ```

use nalgebra::{Point3, Vector3};
use p2m_core::engine::parallel;
use p2m_core::{Aabb, PrimitiveId, PrimitiveSet, shape_of};

/// The number of samples that one thread computes at a time.
const CHUNK: usize = 1 << 12;
/// The constant by which a counter advances: 2^64 divided by the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
/// The number of random numbers that one sample may use. Rejections beyond them are so rare that they reuse the numbers
/// of other samples.
const NUMBERS_PER_SAMPLE: u64 = 64;
/// The number of random numbers of a surface sample that choose its primitive.
const NUMBERS_OF_CHOICE: u64 = 2;

/// Streams of random numbers, which are independent of each other.
#[derive(Clone, Copy)]
enum Stream {
    Surface = 1,
    Noise = 2,
    Box = 3,
}

/// The random numbers of one sample.
struct Numbers {
    state: u64,
}

impl Numbers {
    /// Returns the numbers of sample `i`.
    fn new(seed: u64, stream: Stream, i: usize) -> Self {
        let key = mix(mix(seed.wrapping_add(GOLDEN)) ^ (stream as u64).wrapping_mul(GOLDEN));
        Self { state: key.wrapping_add((i as u64).wrapping_mul(NUMBERS_PER_SAMPLE).wrapping_mul(GOLDEN)) }
    }

    /// Leaves out some numbers.
    fn skip(&mut self, count: u64) {
        self.state = self.state.wrapping_add(count.wrapping_mul(GOLDEN));
    }

    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(GOLDEN);
        mix(self.state)
    }

    /// Returns a number from 0 to below 1, a multiple of 2^-53.
    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Returns two numbers of the normal distribution, by the polar method \[Marsaglia1964\].
    fn normal_pair(&mut self) -> [f64; 2] {
        loop {
            let [u, v] = [self.unit(), self.unit()].map(|x| 2.0 * x - 1.0);
            let square = u * u + v * v;
            if square > 0.0 && square < 1.0 {
                let scale = (-2.0 * libm::log(square) / square).sqrt();
                return [u * scale, v * scale];
            }
        }
    }
}

/// The finalizer (the last mixing step) of SplitMix64.
fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Points of a scene, with the primitives that they are from.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Samples {
    /// The points.
    pub points: Vec<Point3<f64>>,
    /// The primitive of each point, from which noise may have moved it.
    pub primitives: Vec<PrimitiveId>,
}

impl Samples {
    /// Computes so many samples in chunks, each from the number of its first sample, on all threads of the current pool
    /// if there are some.
    fn compute(count: usize, chunk: impl Fn(usize, &mut [Point3<f64>], &mut [PrimitiveId]) + Sync) -> Self {
        let mut samples = Self { points: vec![Point3::origin(); count], primitives: vec![PrimitiveId::new(0); count] };
        let parts = samples.points.chunks_mut(CHUNK).zip(samples.primitives.chunks_mut(CHUNK)).enumerate().collect();
        parallel::map_owned(parts, true, |(k, (points, ids))| chunk(k * CHUNK, points, ids));
        samples
    }
}

/// Chooses points of a scene, evenly distributed by area; by length if it has no triangles with an area, and among its
/// points if it has no segments either.
///
/// The choice of a primitive takes two random accesses, by the alias method \[Walker1977\].
#[derive(Clone, Debug)]
pub struct SurfaceSampler<S> {
    scene: S,
    /// The primitives that can be chosen.
    ids: Vec<u32>,
    /// The alias table: for each primitive, the fraction of its share that is its own, and the primitive that has the
    /// rest.
    shares: Vec<(f64, u32)>,
    measure: f64,
}

impl<S: PrimitiveSet<f64> + Sync> SurfaceSampler<S> {
    /// Prepares the choice; `None` if the scene is empty.
    ///
    /// # Complexity
    /// O(n) time and 20 bytes per primitive.
    #[must_use]
    pub fn new(scene: S) -> Option<Self> {
        let mut measures = [const { Vec::new() }; 3];
        for id in 0..scene.len() {
            let Some(shape) = shape_of(&scene, PrimitiveId::new(id)) else { continue };
            let (kind, measure) = (3 - shape.vertices().len(), measure(shape.vertices()));
            if measure > 0.0 && measure.is_finite() {
                measures[kind].push((u32::try_from(id).ok()?, measure));
            }
        }
        let chosen = measures.into_iter().find(|list| !list.is_empty())?;
        let measure: f64 = chosen.iter().map(|(_, measure)| measure).sum();
        let mean = measure / chosen.len() as f64;
        let mut shares: Vec<(f64, u32)> = (0..).zip(&chosen).map(|(i, (_, measure))| (measure / mean, i)).collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..shares.len()).partition(|i| shares[*i].0 < 1.0);
        while let (Some(poor), Some(rich)) = (small.pop(), large.pop()) {
            shares[poor].1 = u32::try_from(rich).ok()?;
            shares[rich].0 -= 1.0 - shares[poor].0;
            if shares[rich].0 < 1.0 { &mut small } else { &mut large }.push(rich);
        }
        // The shares that are left differ from 1 only by rounding, and have no alias.
        small.into_iter().chain(large).for_each(|i| shares[i].0 = 1.0);
        measure.is_finite().then(|| Self {
            scene,
            ids: chosen.into_iter().map(|(id, _)| id).collect(),
            shares,
            measure,
        })
    }

    /// Returns the area, the length or the number of the primitives that are chosen from.
    #[must_use]
    pub fn measure(&self) -> f64 {
        self.measure
    }

    /// Returns points of the scene.
    ///
    /// # Accuracy
    /// A point is within 4 u M of its primitive, where M is the largest coordinate.
    ///
    /// # Complexity
    /// O(1) for each point, on all threads of the current pool.
    #[must_use]
    pub fn surface(&self, seed: u64, count: usize) -> Samples {
        Samples::compute(count, |first, points, ids| self.chunk(seed, first, points, ids))
    }

    /// Returns points of the scene, moved by normally distributed noise in each coordinate. Its standard deviation for
    /// sample i is `sigmas[i % sigmas.len()]`.
    ///
    /// # Panics
    /// It panics if `sigmas` is empty and `count` is not 0.
    #[must_use]
    pub fn near(&self, seed: u64, count: usize, sigmas: &[f64]) -> Samples {
        Samples::compute(count, |first, points, ids| {
            self.chunk(seed, first, points, ids);
            for (i, point) in (first..).zip(points) {
                let mut numbers = Numbers::new(seed, Stream::Noise, i);
                let ([x, y], [z, _]) = (numbers.normal_pair(), numbers.normal_pair());
                *point += Vector3::new(x, y, z) * sigmas[i % sigmas.len()];
            }
        })
    }

    /// Computes samples of the surface from number `first` on. All primitives are chosen before the first point is
    /// computed, so that the processor waits for many of their random accesses at a time.
    fn chunk(&self, seed: u64, first: usize, points: &mut [Point3<f64>], ids: &mut [PrimitiveId]) {
        for (i, id) in (first..).zip(&mut *ids) {
            let mut numbers = Numbers::new(seed, Stream::Surface, i);
            #[allow(clippy::cast_possible_truncation, reason = "the number of a primitive")]
            let slot = ((u128::from(numbers.bits()) * self.shares.len() as u128) >> 64) as usize;
            let (share, other) = self.shares[slot];
            let slot = if numbers.unit() < share { slot } else { other as usize };
            *id = PrimitiveId::new(self.ids[slot] as usize);
        }
        for ((i, id), point) in (first..).zip(ids).zip(points) {
            let mut numbers = Numbers::new(seed, Stream::Surface, i);
            numbers.skip(NUMBERS_OF_CHOICE);
            *point = shape_of(&self.scene, *id).map_or(Point3::origin(), |shape| match *shape.vertices() {
                [a, b, c] => {
                    let (u, v) = (numbers.unit(), numbers.unit());
                    // The second half of the parallelogram is folded onto the triangle.
                    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                    a + (b - a) * u + (c - a) * v
                }
                [a, b] => a + (b - a) * numbers.unit(),
                [a] => a,
                _ => Point3::origin(),
            });
        }
    }
}

/// Returns the area of a triangle, the length of a segment, or 1 for a point.
pub(crate) fn measure(vertices: &[Point3<f64>]) -> f64 {
    match *vertices {
        [a, b, c] => (b - a).cross(&(c - a)).norm() / 2.0,
        [a, b] => (b - a).norm(),
        _ => 1.0,
    }
}

/// Returns points that are evenly distributed in a box.
#[must_use]
pub fn in_box(bounds: &Aabb<f64>, seed: u64, count: usize) -> Vec<Point3<f64>> {
    let mut points = vec![Point3::origin(); count];
    let size = bounds.max - bounds.min;
    parallel::for_each_chunk(&mut points, CHUNK, true, |k, points| {
        for (i, point) in (k * CHUNK..).zip(points) {
            let mut numbers = Numbers::new(seed, Stream::Box, i);
            let unit = Vector3::new(numbers.unit(), numbers.unit(), numbers.unit());
            *point = bounds.min + size.component_mul(&unit);
        }
    });
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::{BruteForce, ClosestPoint, Element, Soup};
    use twox_hash::XxHash3_64;

    /// Two triangles with areas in the ratio 1 : 3, a degenerate one, and a segment.
    fn scene() -> Soup<f64> {
        let at = |x, y, z| Point3::new(x, y, z);
        let positions =
            vec![at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 2.0, 0.0), at(0.0, 0.0, 6.0), at(9.0, 9.0, 9.0)];
        let triangles = [[0, 1, 2], [0, 1, 3], [0, 1, 1]].map(Element::Triangle);
        Soup::new(positions, triangles.into_iter().chain([Element::Segment([3, 4])])).unwrap()
    }

    #[test]
    fn points_are_on_the_scene_in_proportion_to_the_areas() {
        let scene = scene();
        let sampler = SurfaceSampler::new(&scene).unwrap();
        assert_eq!(sampler.measure(), 4.0);
        let samples = sampler.surface(3, 40_000);
        let of_first = samples.primitives.iter().filter(|id| id.index() == 0).count();
        assert!((9_700..10_300).contains(&of_first), "{of_first}");
        assert!(samples.primitives.iter().all(|id| id.index() < 2));
        let brute = BruteForce::new(&scene).unwrap();
        assert!(samples.points.iter().step_by(50).all(|p| brute.closest_point(p).unwrap().distance < 1e-14));
        // Within a triangle they are even: a quarter of them is beyond half of the way along a side.
        let second = samples.points.iter().zip(&samples.primitives).filter(|(_, id)| id.index() == 1);
        let (all, high) = second.fold((0, 0), |(all, high), (p, _)| (all + 1, high + i32::from(p.z > 3.0)));
        assert!((all * 23 / 100..all * 27 / 100).contains(&high), "{high} of {all}");
    }

    #[test]
    fn a_list_begins_with_the_shorter_one_on_any_number_of_threads() {
        let scene = scene();
        let sampler = SurfaceSampler::new(&scene).unwrap();
        let long = sampler.near(5, 20_000, &[0.1, 0.2]);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        let short = pool.install(|| sampler.near(5, 9_000, &[0.1, 0.2]));
        assert_eq!((&long.points[..9_000], &long.primitives[..9_000]), (&short.points[..], &short.primitives[..]));
        assert_ne!(sampler.near(6, 9_000, &[0.1, 0.2]).points, short.points);
        let bounds = PrimitiveSet::aabb(&scene);
        assert_eq!(in_box(&bounds, 5, 9_000), in_box(&bounds, 5, 20_000)[..9_000]);
    }

    #[test]
    fn bits_are_those_of_every_platform() {
        let scene = scene();
        let sampler = SurfaceSampler::new(&scene).unwrap();
        let hash = |points: &[Point3<f64>]| {
            let bytes: Vec<u8> = points.iter().flat_map(|p| p.iter().flat_map(|x| x.to_le_bytes())).collect();
            XxHash3_64::oneshot(&bytes)
        };
        let lists = [
            sampler.surface(1, 10_000).points,
            sampler.near(1, 10_000, &[0.01]).points,
            in_box(&PrimitiveSet::aabb(&scene), 1, 10_000),
        ];
        assert_eq!(
            lists.map(|points| hash(&points)),
            [6_717_586_957_774_533_633, 17_859_455_409_998_318_457, 15_165_466_002_587_282_890]
        );
    }

    #[test]
    fn noise_is_normal_and_boxes_are_even() {
        let point = Soup::new(vec![Point3::new(1.0, 2.0, 3.0)], [Element::Point(0)]).unwrap();
        let sampler = SurfaceSampler::new(&point).unwrap();
        let near = sampler.near(9, 60_000, &[0.5, 2.0]);
        for (first, sigma) in [(0, 0.5), (1, 2.0)] {
            let offsets: Vec<f64> = near
                .points
                .iter()
                .skip(first)
                .step_by(2)
                .flat_map(|p| (p - Point3::new(1.0, 2.0, 3.0)).iter().copied().collect::<Vec<_>>())
                .collect();
            let moment =
                |power: i32| offsets.iter().map(|x| (x / sigma).powi(power)).sum::<f64>() / offsets.len() as f64;
            let moments = [1, 2, 3, 4].map(moment);
            let expected = [0.0, 1.0, 0.0, 3.0];
            assert!(moments.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.08), "{moments:?}");
        }
        let bounds = Aabb::from_points(&[Point3::new(-1.0, 0.0, 5.0), Point3::new(1.0, 4.0, 5.0)]);
        let points = in_box(&bounds, 2, 40_000);
        let part = points.iter().filter(|p| p.x > 0.0 && p.y < 1.0).count();
        assert!((4_800..5_200).contains(&part) && points.iter().all(|p| p.z == 5.0), "{part}");
    }

    #[test]
    fn scenes_without_area_have_samples_by_length_and_empty_ones_have_none() {
        let at = |x| Point3::new(x, 0.0, 0.0);
        let path = Soup::new(vec![at(0.0), at(1.0), at(4.0)], [[0, 1], [1, 2]].map(Element::Segment)).unwrap();
        let samples = SurfaceSampler::new(&path).unwrap().surface(0, 8_000);
        let low = samples.points.iter().filter(|p| p.x < 1.0).count();
        assert!((1_850..2_150).contains(&low), "{low}");
        assert!(SurfaceSampler::new(&Soup::<f64>::default()).is_none());
    }
}
