//! The nearest points of two scenes.

use crate::arrays::{check_pointer, length, reference, write};
use crate::index::Index;
use crate::queries::P2M_NO_PRIMITIVE;
use crate::status::{Call, Status, invalid, run};
use p2m_core::pair::{ClosestPair, PairOptions, PairQuery, is_rotation_and_translation, isometry_of_matrix};

/// The nearest points of two scenes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// The distance. It is 0 if the scenes intersect, and infinity if there is no answer.
    pub distance: f64,
    /// A lower bound on the true distance; infinity if there is no answer.
    pub lower_bound: f64,
    /// The nearest point of each scene. The point of the second scene is given after its motion.
    pub points: [[f64; 3]; 2],
    /// The weights of the vertices of each primitive.
    pub weights: [[f64; 3]; 2],
    /// The id of the primitive of each scene, or `P2M_NO_PRIMITIVE`.
    pub primitives: [u32; 2],
    /// The feature that each point lies on, as in `p2m_closest`.
    pub features: [u8; 2],
    /// Whether the scenes intersect. It is exact.
    pub is_intersecting: bool,
}

impl Pair {
    const NONE: Self = Self {
        distance: f64::INFINITY,
        lower_bound: f64::INFINITY,
        points: [[f64::NAN; 3]; 2],
        weights: [[f64::NAN; 3]; 2],
        primitives: [P2M_NO_PRIMITIVE; 2],
        features: [u8::MAX; 2],
        is_intersecting: false,
    };
}

impl From<&ClosestPair<f64>> for Pair {
    fn from(pair: &ClosestPair<f64>) -> Self {
        Self {
            distance: pair.distance,
            lower_bound: pair.lower_bound,
            points: pair.points.map(Into::into),
            weights: pair.barycentric,
            primitives: pair.primitives.map(|id| id.number()),
            features: pair.features.map(|feature| feature.code()),
            is_intersecting: pair.is_intersecting,
        }
    }
}

impl Index {
    fn pairs(&self) -> Call<&(dyn PairQuery<f64> + Sync)> {
        let unsupported = || self.unsupported("answers no queries for pairs", |backend| backend.answers_pairs);
        self.built.index.as_pair_query().ok_or_else(unsupported)
    }
}

/// Finds the nearest points of two scenes within a distance, which may be infinite. `motion` moves the second scene:
/// the 16 numbers of a 4 x 4 matrix, row by row, of a rotation and a translation; null for none. If there is no answer,
/// `pair` has `P2M_NO_PRIMITIVE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_closest_pair(
    first: *const Index,
    second: *const Index,
    motion: *const f64,
    max_distance: f64,
    pair: *mut Pair,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (first, second) = (reference(first, "first")?.pairs()?, reference(second, "second")?.pairs()?);
        let mut options = PairOptions::default().with_max_distance(length(max_distance, "max_distance")?);
        if !motion.is_null() {
            let matrix = reference(motion.cast::<[f64; 16]>(), "motion")?;
            options = options.with_motion(isometry_of(matrix)?);
        }
        check_pointer(pair, "pair")?;
        let found = (&first).closest_pair(second, &options);
        write(pair, "pair", found.as_ref().map_or(Pair::NONE, Pair::from))
    })
}

/// Returns the motion given by a matrix, which has to be a rotation and a translation.
fn isometry_of(matrix: &[f64; 16]) -> Call<nalgebra::Isometry3<f64>> {
    let is_affine = matrix[12..].iter().zip([0.0, 0.0, 0.0, 1.0]).all(|(x, expected)| x - expected == 0.0);
    if !is_affine || !is_rotation_and_translation(matrix) {
        return Err(invalid("motion: the matrix is not a rotation and a translation"));
    }
    Ok(isometry_of_matrix(matrix))
}
