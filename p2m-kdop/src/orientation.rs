//! The orientation of a scene: the directions of its facets and segments.
//!
//! The basic idea is a histogram of directions. Normals and edges are counted in cells on the faces of a cube, weighted
//! by area and length. The heaviest cells are the peaks, and any two peaks that are nearly orthogonal span a
//! candidate for the frame of the scene.

use nalgebra::Vector3;
use p2m_core::{Aabb, Primitive, PrimitiveId, PrimitiveSet, Real};

/// The most primitives that are sampled. There is no record of how the number was tuned.
const MAX_SAMPLED_PRIMITIVES: usize = 40_000;
/// The number of cells along an edge of the cube on whose faces directions are counted. There is no record of how it
/// was tuned.
const CELLS_PER_EDGE: usize = 32;
/// The number of the heaviest cells whose directions are candidates for axes. There is no record of how it was tuned.
const MAX_PEAKS: usize = 24;
/// The sine of 10 degrees, the least angle to an axis at which a facet counts as not aligned at all.
const ALIGNED_SINE: f64 = 0.174;

/// A unit vector with its weight in the scene.
pub(crate) type WeightedDirection = (Vector3<f64>, f64);

/// Returns the normals of facets, and the directions of segments and long facets, with weights that add up to 1. Large
/// scenes are sampled, deterministically.
pub(crate) fn sample_directions<T: Real, S: PrimitiveSet<T> + ?Sized>(set: &S) -> Vec<WeightedDirection> {
    let len = set.len();
    let count = len.min(MAX_SAMPLED_PRIMITIVES);
    let mut directions = Vec::with_capacity(count);
    let boxes = (0..count).map(|i| set.get(PrimitiveId::new(i * len / count)).aabb().to_f64());
    // Coordinates are divided by half of the size of the scene, so that no product overflows.
    let bounds = boxes.fold(Aabb::empty(), |a, b| a.union(&b));
    let scale = (bounds.max.coords * 0.5 - bounds.min.coords * 0.5).max();
    for i in 0..count {
        let primitive = set.get(PrimitiveId::new(i * len / count));
        let corners: Vec<Vector3<f64>> =
            primitive.vertices().iter().map(|p| p.coords.map(|x| x.to_f64() / scale)).collect();
        // A segment counts as a facet whose area is the square of its length, because areas and lengths are not
        // comparable. A long facet counts as a segment as well, with a weight that grows with the ratio of its length
        // to its height.
        let weighted = match corners[..] {
            [a, b] => [(b - a) * (b - a).norm(), Vector3::zeros()],
            [a, b, c] => {
                let normal = (b - a).cross(&(c - a));
                let longest = [b - a, c - b, a - c].into_iter().max_by(|x, y| x.norm().total_cmp(&y.norm()));
                let edge = longest.unwrap_or_default();
                let slender = (1.0 - normal.norm() / edge.norm_squared()).max(0.0).powi(4);
                [normal, edge.normalize() * (normal.norm() * slender)]
            }
            _ => continue,
        };
        for vector in weighted {
            let weight = vector.norm();
            if weight > 0.0 && weight.is_finite() {
                directions.push((vector / weight, weight));
            }
        }
    }
    let total: f64 = directions.iter().map(|(_, weight)| weight).sum();
    directions.iter_mut().for_each(|(_, weight)| *weight /= total);
    directions
}

/// Returns the mean misalignment of directions with a frame. A direction along an axis counts 0. A direction counts 1
/// if the sines of its angles to all axes are at least [`ALIGNED_SINE`].
pub(crate) fn misalignment(directions: &[WeightedDirection], frame: &[Vector3<f64>; 3]) -> f64 {
    let misalignment_of = |n: &Vector3<f64>| {
        let cosine = frame.iter().map(|axis| axis.dot(n).abs()).fold(0.0, f64::max);
        ((1.0 - cosine * cosine).max(0.0) / (ALIGNED_SINE * ALIGNED_SINE)).min(1.0)
    };
    directions.iter().map(|(n, weight)| misalignment_of(n) * weight).sum()
}

/// Returns the frames that pairs of the heaviest directions span, if the two are nearly orthogonal.
pub(crate) fn candidate_frames(directions: &[WeightedDirection]) -> impl Iterator<Item = [Vector3<f64>; 3]> {
    let peaks = peaks(directions);
    (0..peaks.len()).flat_map(move |i| {
        let u = peaks[i];
        let others = peaks[i + 1..].to_vec();
        // The second direction is made orthogonal to the first.
        others.into_iter().filter(move |v| u.dot(v).abs() < ALIGNED_SINE).map(move |v| {
            let v = (v - u * u.dot(&v)).normalize();
            [u, v, u.cross(&v)]
        })
    })
}

/// Returns the mean directions of the cells with the largest weights, the heaviest first.
fn peaks(directions: &[WeightedDirection]) -> Vec<Vector3<f64>> {
    let mut cells = vec![(Vector3::zeros(), 0.0); 3 * CELLS_PER_EDGE * CELLS_PER_EDGE];
    for (n, weight) in directions {
        // The cell is found where the line with this direction intersects the surface of a cube.
        let axis = n.iamax();
        let n = n * n[axis].signum();
        let cell = |k: usize| {
            let x = (n[(axis + k) % 3] / n[axis] * 0.5 + 0.5) * CELLS_PER_EDGE as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to CELLS_PER_EDGE")]
            let x = x.round() as usize;
            x.min(CELLS_PER_EDGE - 1)
        };
        let (sum, total) = &mut cells[(axis * CELLS_PER_EDGE + cell(1)) * CELLS_PER_EDGE + cell(2)];
        *sum += n * *weight;
        *total += weight;
    }
    cells.retain(|(_, total)| *total > 0.0);
    cells.sort_by(|a, b| b.1.total_cmp(&a.1));
    cells.truncate(MAX_PEAKS);
    cells.into_iter().map(|(sum, _)| sum.normalize()).collect()
}
