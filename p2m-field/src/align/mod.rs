//! Alignment: the rotation and translation that bring the points of a scan onto a scene.
//!
//! # Method
//!
//! This is the iterative closest point method \[Besl1992\]. Each round asks for the closest point c of every point x of
//! the scan, and then moves the scan so that the residuals decrease.
//!
//! - **Point to plane** \[Chen1992, Low2004\]: the residual is n . (x - c), where n is the direction from c to x, or
//!   the normal of the triangle where x is so near that rounding decides the direction. n is the gradient of the
//!   distance at x, so a round is a step of the Gauss-Newton method for the sum of squared distances: the error is
//!   squared near the solution. A rotation by the vector w about the pivot o and a translation t change the residual by
//!   the sum of w . ((x - o) x n) and t . n, up to second order. The normal equations have six unknowns, or seven with
//!   the scale, whose coefficient is n . (x - o).
//! - **Point to point** \[Umeyama1991\]: the rotation that minimises the sum of |x - c|^2 comes from the singular value
//!   decomposition of the covariance of x and c. It needs more rounds on surfaces, because points cannot slide along
//!   them, but suits scenes of points.
//!
//! **Outliers.** Distances d have weights by Tukey's function, (1 - (d / k)^2)^2 up to k and 0 beyond. In the end, k is
//! 4.685 s, where s is 1.4826 times the median of the distances: this keeps 95 % of the efficiency for Gaussian noise.
//! If only a part of the scan overlaps with the scene, the median is taken over the nearest such part, and the rest has
//! no weight, as in trimmed ICP \[Chetverikov2005\]. k begins at the largest distance within the radius of the scan and
//! at most halves in a round: otherwise the faces of a plate would soon fit, its narrow sides would count as outliers,
//! and the plate could slide.
//!
//! Weights that are fixed during a round make its step too short, because the weighted distance grows more slowly than
//! with a fixed weight. So steps are lengthened by the sum of weights over the sum of the derivatives of weighted
//! distances, which is 1.21 for Gaussian noise.
//!
//! **Levels.** A sample of the points converges first, then a larger one, and all points last. A level ends if its step
//! is below the standard error of the result, rms / sqrt(points e), where e is the relative eigenvalue (see Ambiguity).
//! It also ends if the ratio of the last two steps predicts that the next step will be below half of this error. So all
//! points take one round, as a rule.
//!
//! **Far starts.** ICP finds the nearest minimum. If neither the scan as it is nor the scan with its centre moved onto
//! the centre of the scene comes to lie within a hundredth of its radius, 122 starts are tried with 256 points each,
//! all in one batch per round: these two, and 60 rotations about the centre of the scene, both in the axes of the
//! coordinates and in the axes of inertia. Any rotation is within 45 degrees of one of the 60. The best twelve starts
//! continue with 1,024 points. The scan as it is wins unless another start is clearly better.
//!
//! **Ambiguity.** The smallest eigenvalue of the normal matrix, relative to the largest, is near 0 if the scan can
//! slide or turn without a change of its distances, as on a sphere, a cylinder or a plane. A second minimum elsewhere
//! with nearly the same residual is the other kind of ambiguity. The search finds it, or else turns of the scan about
//! its axes of inertia do: a box fits in at least four ways.

mod fit;
mod pose;
mod search;
#[cfg(test)]
mod tests;

use fit::Fit;
use nalgebra::{Matrix4, Point3};
use p2m_core::{ClosestPoint, PrimitiveSet};
use pose::Pose;
use std::ops::ControlFlow;

/// Options of [`align`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AlignOptions {
    /// Whether residuals are distances from points, and not from planes. The default is `false`; a scene without
    /// triangles always has distances from points.
    pub point_to_point: bool,
    /// Whether the scan is scaled as well. The scale stays within a factor of two of the ratio of the sizes if there is
    /// a search, or of 1 if there is none. The default is `false`.
    pub scale: bool,
    /// The part of the points that lie on the scene, above 0 and at most 1. The default is 1, which tolerates outliers
    /// of up to a third.
    pub overlap: f64,
    /// Whether other starts are tried if the scan as it is does not come to lie on the scene. The default is `true`.
    pub search: bool,
}

impl Default for AlignOptions {
    fn default() -> Self {
        Self { point_to_point: false, scale: false, overlap: 1.0, search: true }
    }
}

impl AlignOptions {
    /// Sets whether residuals are distances from points.
    #[must_use]
    pub fn with_point_to_point(self, point_to_point: bool) -> Self {
        Self { point_to_point, ..self }
    }
    /// Sets whether the scan is scaled.
    #[must_use]
    pub fn with_scale(self, scale: bool) -> Self {
        Self { scale, ..self }
    }
    /// Sets the part of the points that lie on the scene.
    #[must_use]
    pub fn with_overlap(self, overlap: f64) -> Self {
        Self { overlap, ..self }
    }
    /// Sets whether other starts are tried.
    #[must_use]
    pub fn with_search(self, search: bool) -> Self {
        Self { search, ..self }
    }
}

/// A round of an alignment, after the search.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AlignRound {
    /// The number of points that were asked.
    pub points: usize,
    /// The root mean square of the distances of the points with a weight, before the step.
    pub rms: f64,
    /// The largest distance by which the step would move a point at the radius of the scan.
    pub step: f64,
}

/// A reason why another pose fits about as well.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Ambiguity {
    /// The scan can slide or turn on the scene, as on a plane, a cylinder or a sphere: the smallest eigenvalue of the
    /// normal matrix, relative to the largest, is below 0.003.
    Sliding {
        /// The relative eigenvalue.
        eigenvalue: f64,
    },
    /// Another pose has a root mean square that is at most a tenth larger.
    OtherPose {
        /// The matrix of that pose, which a sample of the points found.
        matrix: Matrix4<f64>,
    },
}

impl std::fmt::Display for Ambiguity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Sliding { eigenvalue } => {
                write!(f, "the scan can slide or turn on the scene with little change (eigenvalue {eigenvalue:.2e})")
            }
            Self::OtherPose { .. } => f.write_str("another pose fits about as well, as on a symmetric part"),
        }
    }
}

/// The result of [`align`]. Lengths are in the unit of the scene.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Alignment {
    /// The matrix that moves the scan onto the scene, for column vectors (x, y, z, 1).
    pub matrix: Matrix4<f64>,
    /// The factor by which the matrix scales, which is 1 unless [`AlignOptions::scale`] is set.
    pub scale: f64,
    /// The root mean square of the distances of the points with a weight, before the last step.
    pub rms: f64,
    /// The part of the points that have a weight: those that are no outliers.
    pub coverage: f64,
    /// Whether the last level ended because its step was small enough.
    pub is_converged: bool,
    /// The rounds after the search.
    pub rounds: Vec<AlignRound>,
    /// A reason to doubt the pose, if there is one.
    pub ambiguity: Option<Ambiguity>,
    pose: Pose,
}

impl Alignment {
    /// Moves a point of the scan onto the scene.
    ///
    /// # Accuracy
    /// About 10 u (|x - m| + |m'|), where m is the centre of the scan and m' its image. The matrix has an error of 10 u
    /// |m| besides, which matters for scans far from the origin.
    #[must_use]
    pub fn apply(&self, point: &Point3<f64>) -> Point3<f64> {
        self.pose.apply(point)
    }
}

/// Reasons why a scan cannot be aligned.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlignError {
    /// The scene is empty.
    #[error("the scene is empty")]
    EmptyScene,
    /// The scan has fewer than six points that are finite.
    #[error("an alignment needs at least 6 finite points, but the scan has {count}")]
    TooFewPoints {
        /// The number of finite points.
        count: usize,
    },
    /// All points of the scan are the same, or squares of their distances are beyond the range of f64.
    #[error("all points of the scan are the same, or their distances are out of range")]
    OnePoint,
    /// The scan would be scaled, but the whole scene is at one point, or its size is beyond the range of f64.
    #[error("the scene has no size that a scan can be scaled to")]
    NoSize,
    /// The overlap is not above 0 and at most 1.
    #[error("an overlap of {overlap} is not above 0 and at most 1")]
    Overlap {
        /// The overlap that was asked for.
        overlap: f64,
    },
}

/// Receives each round, and ends the alignment by [`ControlFlow::Break`]. During the search it is called with the best
/// start so far.
pub type ReportRound<'a> = dyn FnMut(&AlignRound) -> ControlFlow<()> + 'a;

/// Finds the rotation and translation that bring the points of a scan onto a scene, given an index of the scene.
///
/// The result is the same for every exact index of the scene and every number of threads, bit for bit. Points that are
/// not finite are left out.
///
/// ```
/// use nalgebra::{Isometry3, Vector3};
/// use p2m_bvh::AabbTree;
/// use p2m_field::align::{AlignOptions, align};
/// use p2m_mixed::generate::{TorusKnot, torus_knot};
/// use std::ops::ControlFlow;
///
/// let part = torus_knot(&TorusKnot::default())?;
/// let motion = Isometry3::new(Vector3::new(0.3, -0.2, 0.1), Vector3::new(0.1, 0.3, -0.2));
/// let scan: Vec<_> = part.positions().iter().map(|point| motion * point).collect();
/// let index = AabbTree::new(&part)?;
/// let found = align(&part, &index, &scan, &AlignOptions::default(), &mut |_| ControlFlow::Continue(()))?;
/// assert!(found.is_converged && found.rms < 1e-9);
/// assert!(scan.iter().zip(part.positions()).all(|(x, y)| (found.apply(x) - y).norm() < 1e-6));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// An [`AlignError`] for an empty scene, a scan of too few points, a wrong overlap, or a scene without a size for the
/// scale.
///
/// # Complexity
/// About 500,000 queries for a search, and two per point after it; 60 bytes per point.
pub fn align<S, I>(
    scene: &S,
    index: &I,
    scan: &[Point3<f64>],
    options: &AlignOptions,
    report: &mut ReportRound<'_>,
) -> Result<Alignment, AlignError>
where
    S: PrimitiveSet<f64> + Sync + ?Sized,
    I: ClosestPoint<f64> + Sync + ?Sized,
{
    let overlap = options.overlap;
    if !(overlap > 0.0 && overlap <= 1.0) {
        return Err(AlignError::Overlap { overlap });
    }
    if scene.is_empty() {
        return Err(AlignError::EmptyScene);
    }
    let is_finite = |point: &&Point3<f64>| point.iter().all(|x| x.is_finite());
    let points: Vec<Point3<f64>> = scan.iter().filter(is_finite).copied().collect();
    if points.len() < 6 {
        return Err(AlignError::TooFewPoints { count: points.len() });
    }
    let mut fit = Fit::new(scene, index, &points, options).ok_or(AlignError::OnePoint)?;
    if options.scale && options.search {
        let ratio = search::Inertia::of_scene(scene).radius / fit.radius;
        if !(ratio > 0.0 && ratio.is_finite()) {
            return Err(AlignError::NoSize);
        }
        fit.scales = fit.scales.map(|scale| scale * ratio);
    }
    let (start, other) = fit.start(report);
    let mut pose = start;
    let mut rounds = Vec::new();
    let mut level = 0;
    // The ratio of a step to the one before it, once the limit of distances is settled.
    let mut ratio = 1.0;
    let (last, is_converged) = 'levels: loop {
        let sample = fit.sample(LEVELS[level]);
        let mut before = None;
        let is_last = LEVELS[level] >= points.len();
        for number in 1.. {
            let round = fit.round(&sample, std::slice::from_ref(&pose)).remove(0);
            let record = AlignRound { points: sample.len(), rms: round.rms, step: round.step };
            rounds.push(record);
            if let Some(before) = before.replace(round.step).filter(|_| round.is_settled) {
                ratio = round.step / before;
            }
            let small = fit.small_step(&round);
            let is_small = round.is_settled && (round.step <= small || ratio * round.step <= 0.5 * small);
            let ended = report(&record).is_break();
            pose = round.next;
            let is_over = is_small || number == MAX_ROUNDS;
            if ended || (is_over && is_last) {
                break 'levels (round, is_small && is_last);
            }
            if is_over {
                break;
            }
        }
        level += 1;
    };
    let sliding = (last.eigenvalue < LEAST_EIGENVALUE).then_some(Ambiguity::Sliding { eigenvalue: last.eigenvalue });
    Ok(Alignment {
        matrix: pose.matrix(),
        scale: pose.scale,
        rms: last.rms,
        coverage: last.used as f64 / last.asked as f64,
        is_converged,
        rounds,
        ambiguity: sliding.or(other.map(|other| Ambiguity::OtherPose { matrix: other.matrix() })),
        pose,
    })
}

/// The numbers of points of the levels after the search.
const LEVELS: [usize; 3] = [1 << 10, 1 << 14, usize::MAX];
/// The largest number of rounds of a level.
const MAX_ROUNDS: usize = 60;
/// The relative eigenvalue below which a scan slides.
const LEAST_EIGENVALUE: f64 = 0.003;
