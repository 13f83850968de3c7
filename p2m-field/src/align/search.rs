//! The search for a start: many rotations with few points.

use super::fit::Fit;
use super::pose::Pose;
use super::{AlignRound, ReportRound};
use crate::sample::measure;
use nalgebra::{Matrix3, Point3, Quaternion, Rotation3, SymmetricEigen, UnitQuaternion, Vector3};
use p2m_core::{ClosestPoint, PrimitiveId, PrimitiveSet, shape_of};
use std::f64::consts::FRAC_1_SQRT_2;

/// The stages of the search: the number of points, of rounds, and of poses that continue.
///
/// docs/decisions/073-alignment-shrinks-its-reach.md has the method. No record exists of the scans on which these
/// constants, and those in [`Fit::start`], were tuned.
const STAGES: [(usize, usize, usize); 3] = [(1 << 8, 6, 12), (1 << 10, 10, 6), (1 << 13, 10, usize::MAX)];
/// The number of rounds that show whether the scan is near the scene, with the points of the second stage.
const ROUNDS_FROM_NEAR: usize = 14;
/// The largest score of a pose that lies on the scene, in units of the radius of the scan.
const NEAR: f64 = 0.01;
/// The largest score of a pose that continues, in units of the best score.
const CONTENDERS: f64 = 1.5;
/// The largest ratio of the scores of two poses that fit equally well.
const EQUAL: f64 = 1.05;

/// A pose of the search.
#[derive(Clone, Copy)]
struct Candidate {
    pose: Pose,
    score: f64,
    rms: f64,
    /// Whether it began as the first start: the scan as it is, or the near pose that was found.
    is_first: bool,
}

impl<S, I> Fit<'_, S, I>
where
    S: PrimitiveSet<f64> + Sync + ?Sized,
    I: ClosestPoint<f64> + Sync + ?Sized,
{
    /// Returns the pose to start from, and another one that fits about as well, if there is one.
    ///
    /// The basic idea is a tournament, in which fewer and fewer poses compete with more and more points:
    ///
    /// 1. The scan as it is, and the scan at the centre of the scene, run some rounds by themselves. If one of them
    ///    comes to lie on the scene, only its turns about the axes of inertia compete with it. They find out whether
    ///    the pose is ambiguous.
    /// 2. Otherwise 122 poses compete: these two, and 60 rotations in each of two frames.
    /// 3. In each of the [`STAGES`], all poses run some rounds with a sample of the points and are sorted by their
    ///    scores. Of poses that move the points to about the same places one is kept, and of the rest the best ones.
    /// 4. The first pose that is left is the start. The next one is the other pose, if its score is at most a tenth
    ///    larger.
    pub(super) fn start(&self, report: &mut ReportRound<'_>) -> (Pose, Option<Pose>) {
        let as_it_is = Pose::identity(self.centre);
        if !self.options.search {
            return (as_it_is, None);
        }
        let mut near = self.starts(as_it_is, false);
        let mut found = None;
        let sample = self.sample(STAGES[1].0);
        for _ in 0..ROUNDS_FROM_NEAR {
            let rounds = self.round(&sample, &near);
            near = rounds.iter().map(|round| round.next).collect();
            let best = rounds.iter().min_by(|a, b| a.score.total_cmp(&b.score)).expect("there are two");
            if report(&AlignRound { points: sample.len(), rms: best.rms, step: best.step }).is_break() {
                return (best.next, None);
            }
            if best.is_settled && best.score <= NEAR * self.radius && best.step <= self.small_step(best) {
                found = Some(self.turned(best.next));
                break;
            }
        }
        let few = self.sample(STAGES[0].0);
        let is_apart = |a: &Candidate, b: &Candidate| {
            let squares: f64 = few.iter().map(|point| (a.pose.apply(point) - b.pose.apply(point)).norm_squared()).sum();
            (squares / few.len() as f64).sqrt() > (0.05 * self.radius * a.pose.scale).max(3.0 * a.rms.min(b.rms))
        };
        let is_near = found.is_some();
        let poses = found.unwrap_or_else(|| self.starts(as_it_is, true)).into_iter().enumerate();
        let mut candidates: Vec<Candidate> =
            poses.map(|(k, pose)| Candidate { pose, score: 0.0, rms: 0.0, is_first: k == 0 }).collect();
        // Scores below this length are rounding.
        let floor = 1e-6 * self.radius;
        for (points, rounds, kept) in STAGES {
            let sample = self.sample(points);
            for _ in 0..rounds {
                let poses: Vec<Pose> = candidates.iter().map(|candidate| candidate.pose).collect();
                let rounds = self.round(&sample, &poses);
                for (candidate, round) in candidates.iter_mut().zip(&rounds) {
                    (candidate.pose, candidate.score, candidate.rms) = (round.next, round.score, round.rms);
                }
                let best = rounds.iter().min_by(|a, b| a.score.total_cmp(&b.score)).expect("there are starts");
                if report(&AlignRound { points: sample.len(), rms: best.rms, step: best.step }).is_break() {
                    return (best.next, None);
                }
            }
            // The scan as it is comes before others that are about as good.
            let place = |c: &Candidate| if c.is_first { c.score / EQUAL - floor } else { c.score };
            candidates.sort_by(|a, b| place(a).total_cmp(&place(b)));
            let limit = CONTENDERS * candidates[0].score + floor;
            let mut kept_ones: Vec<Candidate> = Vec::new();
            for candidate in candidates {
                let len = kept_ones.len();
                let same = kept_ones.iter_mut().find(|other| !is_apart(&candidate, other));
                // The scan as it is may need more rounds than starts that were nearer to a minimum.
                let is_spared = candidate.is_first && points == few.len();
                let is_kept = candidate.score <= limit && len < kept;
                match same {
                    Some(same) => same.is_first |= candidate.is_first,
                    None if len == 0 || is_kept || is_spared => kept_ones.push(candidate),
                    None => {}
                }
            }
            candidates = kept_ones;
            if candidates.len() == 1 && (is_near || points > STAGES[0].0) {
                break;
            }
        }
        let best = candidates[0];
        let other = candidates[1..].iter().find(|other| other.score <= 1.1 * best.score + floor);
        (best.pose, other.map(|other| other.pose))
    }

    /// Returns the poses to start from: the scan as it is, the scan at the centre of the scene, and all others if there
    /// is a search.
    fn starts(&self, as_it_is: Pose, is_search: bool) -> Vec<Pose> {
        let of_scan = self.inertia();
        let of_scene = Inertia::of_scene(self.scene);
        let scale = if self.options.scale { of_scene.radius / self.radius } else { 1.0 };
        let axes = of_scan.axes.inverse();
        let rotations = rotations();
        let mut poses = vec![as_it_is, Pose { to: of_scene.centre, scale, ..as_it_is }];
        if !is_search {
            return poses;
        }
        for frame in [[UnitQuaternion::identity(); 2], [of_scene.axes, axes]] {
            let pose = |rotation: &UnitQuaternion<f64>| Pose {
                rotation: UnitQuaternion::new_normalize((frame[0] * rotation * frame[1]).into_inner()),
                scale,
                to: of_scene.centre,
                ..as_it_is
            };
            poses.extend(rotations.iter().map(pose));
        }
        poses
    }

    /// Returns a pose, and the poses in which the scan is turned about its axes of inertia by halves, thirds and
    /// quarters, which fit as well if the scan is symmetric.
    fn turned(&self, pose: Pose) -> Vec<Pose> {
        let axes = self.inertia().axes;
        let mut poses = vec![pose];
        // The cosines of half of the angles.
        for cosine in [0.0, 0.5, -0.5, FRAC_1_SQRT_2, -FRAC_1_SQRT_2] {
            for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                let turn = Quaternion::from_parts(cosine, axis * (1.0 - cosine * cosine).sqrt());
                let turn = axes * UnitQuaternion::new_normalize(turn) * axes.inverse();
                poses.push(Pose {
                    rotation: UnitQuaternion::new_normalize((pose.rotation * turn).into_inner()),
                    ..pose
                });
            }
        }
        poses
    }

    /// Returns the inertia of a sample of the scan.
    fn inertia(&self) -> Inertia {
        let points = self.sample(1 << 14).into_iter().map(|point| (1.0, point));
        Inertia::of(points, self.centre, std::slice::from_ref)
    }
}

/// The centre, the radius and the principal axes of points with weights.
pub(super) struct Inertia {
    centre: Point3<f64>,
    /// The root mean square of the distances from the centre.
    pub(super) radius: f64,
    axes: UnitQuaternion<f64>,
}

impl Inertia {
    /// Returns the inertia of the triangles of a scene, or of its segments or points if there are none.
    pub(super) fn of_scene<S: PrimitiveSet<f64> + ?Sized>(scene: &S) -> Self {
        let shapes = || (0..scene.len()).filter_map(|id| shape_of(scene, PrimitiveId::new(id)));
        let most = shapes().map(|shape| shape.vertices().len()).max().unwrap_or(0);
        let origin = shapes().next().map_or(Point3::origin(), |shape| shape.vertices()[0]);
        let largest = shapes().filter(|shape| shape.vertices().len() == most);
        Self::of(largest.map(|shape| (measure(shape.vertices()), shape)), origin, |shape| shape.vertices())
    }

    /// Returns the inertia of simplices with weights, about an origin that is near.
    ///
    /// The second moment of a simplex with k vertices v and the sum s is (sum of v v' + s s') / (k (k + 1)).
    fn of<S>(
        simplices: impl Iterator<Item = (f64, S)>,
        origin: Point3<f64>,
        vertices: impl Fn(&S) -> &[Point3<f64>],
    ) -> Self {
        let (mut weight, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for (w, simplex) in simplices {
            let vertices = vertices(&simplex);
            let k = vertices.len() as f64;
            let vertices = vertices.iter().map(|v| v - origin);
            let sum: Vector3<f64> = vertices.clone().sum();
            let products: Matrix3<f64> = vertices.map(|v| v * v.transpose()).sum();
            weight += w;
            first += sum * (w / k);
            second += (products + sum * sum.transpose()) * (w / (k * (k + 1.0)));
        }
        let weight = if weight > 0.0 { weight } else { 1.0 };
        let mean = first / weight;
        let covariance = second / weight - mean * mean.transpose();
        let mut axes = SymmetricEigen::new(covariance).eigenvectors;
        if axes.determinant() < 0.0 {
            axes = -axes;
        }
        Self {
            centre: origin + mean,
            radius: covariance.trace().max(0.0).sqrt(),
            axes: UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes)),
        }
    }
}

/// Returns the 60 rotations of an icosahedron. Every rotation is within 45 degrees of one of them.
///
/// They are the vertices of the 600-cell, where opposite vertices are the same rotation: the even permutations of (phi,
/// 1, 1 / phi, 0) / 2 with any signs, (1, 1, 1, 1) / 2 with any signs, and (1, 0, 0, 0).
pub(super) fn rotations() -> Vec<UnitQuaternion<f64>> {
    let phi = f64::midpoint(1.0, 5f64.sqrt());
    let mut all: Vec<[f64; 4]> = Vec::new();
    for i in 0..4 {
        all.push(std::array::from_fn(|k| f64::from(u8::from(k == i))));
    }
    let signed = |values: [f64; 4], bits: u32| -> [f64; 4] {
        std::array::from_fn(|k| if bits >> k & 1 == 1 { -values[k] / 2.0 } else { values[k] / 2.0 })
    };
    all.extend((0..8).map(|bits| signed([1.0; 4], bits)));
    for bits in 0..8 {
        // The last value is 0 and needs no sign, and one more sign is redundant, because q and -q are the same
        // rotation.
        let values = signed([phi, 1.0, 1.0 / phi, 0.0], bits);
        if bits & 1 == 0 {
            all.extend(EVEN_PERMUTATIONS.map(|order| order.map(|i| values[i])));
        }
    }
    all.into_iter().map(|[w, i, j, k]| UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k))).collect()
}

/// The even permutations of four elements.
const EVEN_PERMUTATIONS: [[usize; 4]; 12] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 0, 3, 2],
    [1, 2, 0, 3],
    [1, 3, 2, 0],
    [2, 0, 1, 3],
    [2, 1, 3, 0],
    [2, 3, 0, 1],
    [3, 0, 2, 1],
    [3, 1, 0, 2],
    [3, 2, 1, 0],
];
