//! One round of an alignment: the closest points of moved samples, their weights, and a step.

use super::AlignOptions;
use super::pose::Pose;
use nalgebra::{DMatrix, DVector, Matrix3, Point3, Rotation3, SymmetricEigen, UnitQuaternion, Vector3};
use p2m_core::batch::{BatchOptions, ClosestColumns, closest_columns_into};
use p2m_core::engine::parallel;
use p2m_core::{ClosestPoint, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, shape_of};
use std::ops::Range;

/// The number of points whose sums one thread computes. It decides the rounding of sums, so it is the same for every
/// number of threads.
const CHUNK: usize = 1 << 10;
/// The factor of the median of the distances at which Tukey's weight becomes 0.
const TUKEY: f64 = 4.685 * 1.4826;
/// The largest factor by which a step is lengthened for weights that change with it.
const MAX_LENGTHENING: f64 = 1.5;
/// The smallest factor by which the limit of distances shrinks in a round with distances from planes.
/// docs/decisions/073-alignment-shrinks-its-reach.md has the reason for one half.
const SHRINKING_TO_PLANES: f64 = 0.5;
/// The smallest factor by which the limit shrinks in a round with distances from points, along which scans slide
/// slowly. No record exists of how it was chosen.
const SHRINKING_TO_POINTS: f64 = 0.8;

/// A scan, and the scene that it is fitted to.
pub(super) struct Fit<'a, S: ?Sized, I: ?Sized> {
    pub(super) scene: &'a S,
    index: &'a I,
    points: &'a [Point3<f64>],
    pub(super) options: AlignOptions,
    /// Whether residuals are distances from planes, and not from points.
    to_planes: bool,
    /// The centre of the scan.
    pub(super) centre: Point3<f64>,
    /// The root mean square of the distances of points from the centre.
    pub(super) radius: f64,
    /// The length below which rounding may decide the direction of a residual.
    tiny: f64,
    /// The scales that are allowed.
    pub(super) scales: [f64; 2],
}

/// The result of a round for one pose.
#[derive(Clone, Copy)]
pub(super) struct Round {
    /// The root mean square of the distances of points with a weight.
    pub(super) rms: f64,
    /// The root mean square of the nearest four fifths of the overlap, by which poses are compared. It is divided by
    /// the scale, so that a scan that shrinks does not become better.
    pub(super) score: f64,
    /// The number of points with a weight.
    pub(super) used: usize,
    /// The number of points.
    pub(super) asked: usize,
    /// The smallest eigenvalue of the normal matrix, relative to the largest.
    pub(super) eigenvalue: f64,
    /// The largest motion of a point at the radius.
    pub(super) step: f64,
    /// Whether the limit of distances follows from the noise, or is too small to matter.
    pub(super) is_settled: bool,
    /// The pose after the step.
    pub(super) next: Pose,
}

/// The answers to moved points.
struct Answers {
    moved: Vec<Point3<f64>>,
    closest: Vec<Point3<f64>>,
    distance: Vec<f64>,
    primitive: Vec<u32>,
}

impl<'a, S, I> Fit<'a, S, I>
where
    S: PrimitiveSet<f64> + Sync + ?Sized,
    I: ClosestPoint<f64> + Sync + ?Sized,
{
    /// Takes a scan and a scene; `None` if all points are the same, or squares of their distances overflow.
    pub(super) fn new(scene: &'a S, index: &'a I, points: &'a [Point3<f64>], options: &AlignOptions) -> Option<Self> {
        // Halves do not overflow, and differences from a point of the scan are accurate far from the origin.
        let first = points[0];
        let count = points.len() as f64;
        let sum = sums(points.len(), |range| points[range].iter().map(|p| p - first).sum::<Vector3<f64>>());
        let centre = first + sum.into_iter().sum::<Vector3<f64>>() / count;
        let squares =
            sums(points.len(), |range| points[range].iter().map(|p| (p - centre).norm_squared()).sum::<f64>());
        let radius = (squares.into_iter().sum::<f64>() / count).sqrt();
        let bounds = scene.aabb();
        let largest = bounds.min.coords.abs().max().max(bounds.max.coords.abs().max());
        let tiny = f64::EPSILON * (f64::from(1 << 20) * largest).max(f64::from(1 << 22) * radius);
        let has_triangles = (0..scene.len()).any(|id| scene.get(PrimitiveId::new(id)).vertices().len() == 3);
        let to_planes = has_triangles && !options.point_to_point;
        (radius > 0.0 && radius.is_finite()).then_some(Self {
            scene,
            index,
            points,
            options: *options,
            to_planes,
            centre,
            radius,
            tiny,
            scales: [0.5, 2.0],
        })
    }

    /// Returns about `count` points of the scan that are spread over it, or all of them.
    ///
    /// Their numbers are multiples of the golden ratio, so they do not fall into step with the lines of a scanner.
    pub(super) fn sample(&self, count: usize) -> Vec<Point3<f64>> {
        const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
        let len = self.points.len();
        if count >= len {
            return self.points.to_vec();
        }
        #[allow(clippy::cast_possible_truncation, reason = "the number of a point")]
        let at = |i: u64| ((u128::from(i.wrapping_mul(GOLDEN)) * len as u128) >> 64) as usize;
        (0..count as u64).map(|i| self.points[at(i)]).collect()
    }

    /// Returns the standard error of the motion that a round determines worst. A smaller step is noise.
    pub(super) fn small_step(&self, round: &Round) -> f64 {
        let certainty = round.used.max(1) as f64 * round.eigenvalue.max(0.01);
        round.rms / certainty.sqrt() + 1e-11 * self.radius + 1e-3 * self.tiny
    }

    /// Queries the closest points of a sample in several poses, all in one batch, and returns the round of each pose.
    pub(super) fn round(&self, sample: &[Point3<f64>], poses: &[Pose]) -> Vec<Round> {
        let len = sample.len();
        let moved: Vec<Point3<f64>> =
            poses.iter().flat_map(|pose| sample.iter().map(move |point| pose.apply(point))).collect();
        let mut answers = Answers {
            closest: vec![Point3::origin(); moved.len()],
            distance: vec![f64::INFINITY; moved.len()],
            primitive: vec![0; moved.len()],
            moved,
        };
        let columns = ClosestColumns::default()
            .with_point(&mut answers.closest)
            .with_distance(&mut answers.distance)
            .with_primitive(&mut answers.primitive);
        let (options, batch) = (QueryOptions::default(), BatchOptions::default());
        closest_columns_into(self.index, &answers.moved, &options, &batch, columns);
        poses.iter().enumerate().map(|(k, pose)| self.step(&answers, k * len..(k + 1) * len, pose)).collect()
    }

    /// Returns the step of one pose, whose answers are in a range.
    fn step(&self, answers: &Answers, range: Range<usize>, pose: &Pose) -> Round {
        let distance = &answers.distance[range.clone()];
        let overlap = self.options.overlap;
        let radius = self.radius * pose.scale;
        #[allow(clippy::cast_possible_truncation, reason = "the number of a point")]
        let rank = |part: f64| (((distance.len() - 1) as f64 * part) as usize).min(distance.len() - 1);
        let mut sorted = distance.to_vec();
        let mut quantile = |part: f64| *sorted.select_nth_unstable_by(rank(part), f64::total_cmp).1;
        let [kept, most, median] = [overlap, 0.95 * overlap, 0.5 * overlap].map(&mut quantile);
        let settled = (TUKEY * median).max(self.tiny);
        let shrinking = if self.to_planes { SHRINKING_TO_PLANES } else { SHRINKING_TO_POINTS };
        let allowed =
            if pose.limit < f64::INFINITY { shrinking * pose.limit } else { (3.0 * most).max(kept.min(radius)) };
        let limit = settled.max(allowed);
        let last = rank(0.8 * overlap);
        let nearest = sorted.select_nth_unstable_by(last, f64::total_cmp).0;
        let score = (nearest.iter().map(|d| d * d).sum::<f64>() / last.max(1) as f64).sqrt() / pose.scale;
        // Tukey's weight, and the derivative of the weighted distance.
        let weight = |d: f64| {
            let rest = if d <= limit.min(kept) { 1.0 - (d / limit).powi(2) } else { 0.0 };
            (rest * rest, rest * (5.0 * rest - 4.0))
        };

        let pivot = pose.to;
        let start = range.start;
        let moments = sums(range.len(), |part| {
            let mut sum = Moments::default();
            for i in part {
                let (d, i) = (distance[i], start + i);
                let (w, slope) = weight(d);
                if w > 0.0 {
                    let normal = self.normal(answers, i);
                    sum.slope += slope;
                    sum.add(w, d, (answers.moved[i] - pivot) / radius, (answers.closest[i] - pivot) / radius, normal);
                }
            }
            sum
        });
        let mut sum = moments.into_iter().fold(Moments::default(), Moments::plus);
        let is_settled = limit <= settled.max(1e-4 * radius);
        let lengthening = if self.to_planes && is_settled { sum.lengthening() } else { 1.0 };
        sum.finish();
        let rms = (sum.squares / sum.used.max(1) as f64).sqrt();
        let (eigenvalue, solution) = sum.solve(self.options.scale, radius);
        // Between points no motion slides.
        let (eigenvalue, solution) =
            if self.to_planes { (eigenvalue, solution) } else { (1.0, sum.rigid(self.options.scale, radius)) };
        let Solution { rotation, translation, growth } = solution;
        let (rotation, translation, growth) = (rotation * lengthening, translation * lengthening, growth * lengthening);
        let turned = rotation.norm();
        // A step of more than a radian is no linear one.
        let rotation = if turned > 1.0 { rotation / turned } else { rotation };
        let mut next = pose.then(rotation, translation, growth);
        next.scale = next.scale.clamp(self.scales[0], self.scales[1]);
        next.limit = limit;
        let step = radius * (turned + growth.abs()) + translation.norm();
        Round { rms, score, used: sum.used, asked: range.len(), eigenvalue, step, is_settled, next }
    }

    /// Returns the direction in which the distance of a point grows, or zero where there is none.
    fn normal(&self, answers: &Answers, i: usize) -> Vector3<f64> {
        let distance = answers.distance[i];
        if distance > self.tiny {
            return (answers.moved[i] - answers.closest[i]) / distance;
        }
        let shape = shape_of(self.scene, PrimitiveId::new(answers.primitive[i] as usize));
        match shape.as_ref().map(|shape| shape.vertices()) {
            Some([a, b, c]) => (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default(),
            _ => Vector3::zeros(),
        }
    }
}

/// A small motion.
struct Solution {
    rotation: Vector3<f64>,
    translation: Vector3<f64>,
    growth: f64,
}

/// Weighted sums over points. Lengths are relative to the radius and to the pivot.
#[derive(Clone, Default)]
struct Moments {
    /// The upper triangle of the normal matrix, row by row.
    normal: [f64; 28],
    /// The right-hand side.
    right: [f64; 7],
    weight: f64,
    /// The sum of the derivatives of weighted distances.
    slope: f64,
    /// The sum of squared distances, without weights and in the unit of the scene.
    squares: f64,
    used: usize,
    moved: Vector3<f64>,
    closest: Vector3<f64>,
    /// The sum of closest points times moved points transposed.
    products: Matrix3<f64>,
    moved_squares: f64,
}

impl Moments {
    /// Adds a point with its weight, distance, closest point and normal.
    fn add(&mut self, w: f64, distance: f64, x: Vector3<f64>, c: Vector3<f64>, n: Vector3<f64>) {
        let turn = x.cross(&n);
        let column = [turn.x, turn.y, turn.z, n.x, n.y, n.z, n.dot(&x)];
        let residual = n.dot(&(x - c));
        let mut at = 0;
        for (i, a) in column.into_iter().enumerate() {
            let weighted = w * a;
            for b in &column[i..] {
                self.normal[at] += weighted * b;
                at += 1;
            }
            self.right[i] -= weighted * residual;
        }
        self.weight += w;
        self.squares += distance * distance;
        self.used += 1;
        self.moved += x * w;
        self.closest += c * w;
        self.products += c * x.transpose() * w;
        self.moved_squares += w * x.norm_squared();
    }

    /// Adds the sums of other points.
    fn plus(mut self, other: Self) -> Self {
        self.normal.iter_mut().zip(other.normal).for_each(|(a, b)| *a += b);
        self.right.iter_mut().zip(other.right).for_each(|(a, b)| *a += b);
        self.weight += other.weight;
        self.slope += other.slope;
        self.squares += other.squares;
        self.used += other.used;
        self.moved += other.moved;
        self.closest += other.closest;
        self.products += other.products;
        self.moved_squares += other.moved_squares;
        self
    }

    /// Returns the factor that makes a step with fixed weights a step of Newton's method.
    ///
    /// A step uses the weights from before the step. The sum of weighted distances changes by the derivative, which is
    /// smaller than the weight: 0.758 instead of 0.915 for normally distributed noise. So each step would leave a sixth
    /// of the way.
    fn lengthening(&self) -> f64 {
        let factor = self.weight / self.slope;
        if factor > 1.0 { factor.min(MAX_LENGTHENING) } else { 1.0 }
    }

    /// Divides the weighted sums by the weight.
    fn finish(&mut self) {
        if self.weight > 0.0 {
            let weight = self.weight;
            self.normal.iter_mut().chain(&mut self.right).for_each(|x| *x /= weight);
            self.moved /= weight;
            self.closest /= weight;
            self.products /= weight;
            self.moved_squares /= weight;
        }
    }

    /// Returns the smallest eigenvalue of the normal matrix relative to the largest, and the shortest motion that
    /// solves the normal equations.
    fn solve(&self, with_scale: bool, radius: f64) -> (f64, Solution) {
        let size = if with_scale { 7 } else { 6 };
        let matrix = DMatrix::from_fn(size, size, |i, j| {
            let (i, j) = (i.min(j), i.max(j));
            self.normal[i * (15 - i) / 2 + j - i]
        });
        let right = DVector::from_fn(size, |i, _| self.right[i]);
        let eigen = SymmetricEigen::new(matrix);
        let largest = eigen.eigenvalues.max();
        let mut solution = DVector::zeros(size);
        // Motions that change nothing but rounding are left out.
        for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > 1e-10 * largest {
                solution += vector * (vector.dot(&right) / value);
            }
        }
        let relative = if largest > 0.0 { (eigen.eigenvalues.min() / largest).max(0.0) } else { 0.0 };
        let solution = Solution {
            rotation: Vector3::new(solution[0], solution[1], solution[2]),
            translation: Vector3::new(solution[3], solution[4], solution[5]) * radius,
            growth: if with_scale { solution[6].clamp(-0.5, 0.5) } else { 0.0 },
        };
        (relative, solution)
    }

    /// Returns the motion that brings the moved points closest to their closest points.
    fn rigid(&self, with_scale: bool, radius: f64) -> Solution {
        let covariance = self.products - self.closest * self.moved.transpose();
        let svd = covariance.svd(true, true);
        let (Some(u), Some(v)) = (svd.u, svd.v_t) else {
            return Solution { rotation: Vector3::zeros(), translation: Vector3::zeros(), growth: 0.0 };
        };
        let mut signs = Vector3::new(1.0, 1.0, 1.0);
        if (u * v).determinant() < 0.0 {
            // Singular values are in descending order.
            signs.z = -1.0;
        }
        let rotation = u * Matrix3::from_diagonal(&signs) * v;
        let variance = self.moved_squares - self.moved.norm_squared();
        let scale = if with_scale && variance > 0.0 { svd.singular_values.dot(&signs) / variance } else { 1.0 };
        let translation = (self.closest - rotation * self.moved * scale) * radius;
        // `Pose::then` takes twice the vector of the quaternion over its scalar.
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
        let rotation = turn.imag() * (2.0 / turn.w);
        Solution { rotation, translation, growth: scale - 1.0 }
    }
}

/// Computes sums over ranges of `len` items, on all threads of the current pool if there are some.
pub(super) fn sums<R: Send>(len: usize, sum: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    let part = |k: usize| sum(k * CHUNK..((k + 1) * CHUNK).min(len));
    let parts = len.div_ceil(CHUNK);
    parallel::map(parts, parts > 1, part)
}
