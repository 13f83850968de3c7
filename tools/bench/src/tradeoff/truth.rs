//! Computes true distances by rational arithmetic.

use crate::scene::Scene;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::{BuildIndex, CertifiedQuery, PrimitiveSet};
use p2m_testkit::oracle::Distance;
use p2m_tradeoff::Truth;
use rayon::prelude::*;

/// The remark of the page about true distances.
pub(super) const ABOUT: &str =
    "The truth is computed in rational arithmetic, without rounding, for the primitive that is nearest for certain.";

/// Returns the true distances of queries, computed on all cores.
#[allow(clippy::cast_possible_truncation, reason = "ids are below 2^30")]
pub(super) fn truths(scene: &Scene, queries: &[Point3<f64>]) -> Vec<Truth> {
    let tree = AabbTree::build(&*scene.double, &Default::default()).expect("a scene is finite");
    let truth = |query: &Point3<f64>| {
        let closest = tree.certified_closest_point(query, &Default::default()).expect("primitives have vertices");
        let id = closest.expect("a scene is not empty, and queries are finite").primitive;
        let shape = scene.double.get(id);
        let vertices: Vec<[f64; 3]> = shape.vertices().iter().map(|vertex| vertex.coords.into()).collect();
        let exact = Distance::new(query.coords.into(), &vertices);
        let [distance, residual] = exact.length();
        Truth { distance, residual, max_vertex_distance: exact.max_vertex_distance(), id: id.index() as u32 }
    };
    queries.par_iter().map(truth).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::{Element, Soup};

    #[test]
    fn a_truth_has_more_digits_than_an_answer() {
        let positions = [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0]].map(Point3::from).to_vec();
        let soup = Soup::new(positions, [Element::Point(1), Element::Segment([0, 0])]).unwrap();
        let scene = Scene::new("two".to_owned(), soup).unwrap();
        let truth = truths(&scene, &[Point3::new(1.0, 1.0, 0.0)])[0];
        assert_eq!((truth.id, truth.distance), (1, std::f64::consts::SQRT_2));
        assert!(
            truth.residual < -9e-17
                && truth.residual > -1e-16
                && (truth.max_vertex_distance - 2f64.sqrt()).abs() < 1e-15
        );
    }
}
