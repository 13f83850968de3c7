//! Deviations of a scan on the vertices of the part.

use p2m_core::engine::weld::{UNUSED, VertexWelder};
use p2m_core::{PrimitiveId, Soup};

/// Returns a deviation for each position of a scene: the mean deviation of the points of the scan around it.
///
/// The closest point of a point of the scan divides its deviation among the vertices of its primitive, by its weights:
/// `primitives` and `barycentric` are the fields of [`Closest`](p2m_core::Closest) for each deviation. A position
/// without a share has NaN: the scan does not cover it. Positions with the same coordinates have the same mean. NaN has
/// no share.
///
/// # Panics
/// If the slices have different lengths, or a primitive that the scene does not have belongs to a finite deviation.
///
/// # Complexity
/// Linear time, and 24 bytes per position.
#[must_use]
pub fn on_vertices(scene: &Soup<f64>, primitives: &[u32], barycentric: &[[f64; 3]], deviations: &[f64]) -> Vec<f64> {
    assert_eq!([primitives.len(), barycentric.len()], [deviations.len(); 2], "a primitive for each deviation");
    let welder = VertexWelder::new(scene);
    let mut sums = vec![[0.0; 2]; welder.vertex_count];
    for ((primitive, weights), deviation) in primitives.iter().zip(barycentric).zip(deviations) {
        if deviation.is_finite() {
            let element = scene.element(PrimitiveId::new(*primitive as usize));
            for (position, weight) in element.indices().iter().zip(weights) {
                let [sum, share] = &mut sums[welder.vertex_ids[*position as usize] as usize];
                (*sum, *share) = (*sum + weight * deviation, *share + weight);
            }
        }
    }
    let mean = |vertex: &u32| match *vertex {
        UNUSED => f64::NAN,
        // Without a share the quotient is 0 / 0.
        vertex => sums[vertex as usize][0] / sums[vertex as usize][1],
    };
    welder.vertex_ids.iter().map(mean).collect()
}

/// Returns for each position the lowest primitive that has it, or `u32::MAX`.
#[must_use]
pub fn primitives_of_positions(scene: &Soup<f64>) -> Vec<u32> {
    let mut primitives = vec![u32::MAX; scene.positions().len()];
    for (number, element) in (0u32..).zip(scene.elements()) {
        for position in element.indices() {
            let primitive = &mut primitives[*position as usize];
            *primitive = number.min(*primitive);
        }
    }
    primitives
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use p2m_core::{BruteForce, ClosestPoint, Element};

    #[test]
    fn points_share_their_deviation_among_the_vertices_around_them() {
        // Two triangles of a square. The corners 1 and 4 are one vertex; the position 6 belongs to a segment.
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [9.0, 9.0], [5.0, 5.0], [6.0, 5.0]];
        let positions = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
        let elements = [Element::Segment([6, 7]), Element::Triangle([0, 1, 2]), Element::Triangle([4, 3, 2])];
        let scene = Soup::new(positions, elements).unwrap();
        let index = BruteForce::new(&scene).unwrap();
        let found = |scan: &[[f64; 3]], values: &[f64]| {
            let answers: Vec<_> = scan.iter().map(|x| index.closest_point(&Point3::from(*x)).unwrap()).collect();
            let primitives: Vec<u32> = answers.iter().map(|answer| answer.primitive.number()).collect();
            let weights: Vec<[f64; 3]> = answers.iter().map(|answer| answer.barycentric).collect();
            on_vertices(&scene, &primitives, &weights, values)
        };
        let values =
            found(&[[0.25, 0.25, 1.0], [0.0, 0.0, 2.0], [1.0, 0.0, 4.0], [0.0, 0.0, 9.0]], &[1.0, 2.0, 4.0, f64::NAN]);
        let near = |i: usize, x: f64| assert!((values[i] - x).abs() < 1e-15, "{i}: {values:?}");
        near(0, (0.5 + 2.0) / 1.5);
        near(1, (0.25 + 4.0) / 1.25);
        near(4, (0.25 + 4.0) / 1.25);
        near(2, 1.0);
        assert!([3, 5, 6, 7].iter().all(|i: &usize| values[*i].is_nan()), "{values:?}");
        assert_eq!(found(&[[5.0, 5.0, 1.0]], &[3.0])[6], 3.0);
        assert_eq!(primitives_of_positions(&scene), [1, 1, 1, 2, 2, u32::MAX, 0, 0]);
    }
}
