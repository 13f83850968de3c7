//! Checks of box queries on scenes from bytes.

use super::backends::Tree;
use super::scene::vertices;
use nalgebra::Point3;
use p2m::{Aabb, PrimitiveId, PrimitiveSet, Real, Soup};
use p2m_testkit::oracle::intersects_box;

/// Checks the boxes that pairs of queries span.
pub fn check<T: Real>(soup: &Soup<T>, tree: &dyn Tree<T>, name: &str, queries: &[Point3<T>]) {
    for (a, b) in queries.iter().zip(queries.iter().cycle().skip(1)) {
        let bounds = Aabb { min: a.inf(b), max: a.sup(b) };
        let corners = [bounds.min, bounds.max].map(|p| -> [f64; 3] { p.map(T::to_f64).coords.into() });
        let mut found = Vec::new();
        tree.primitives_in_box_into(&bounds, &mut found);
        if corners.as_flattened().iter().all(|x| x.is_finite()) {
            let is_hit = |id: &usize| intersects_box(&vertices(soup, *id), &corners);
            let expected: Vec<_> = (0..soup.len()).filter(is_hit).map(PrimitiveId::new).collect();
            assert_eq!(found, expected, "{name}: {bounds:?}");
        }
        assert_eq!(tree.intersects_box(&bounds), !found.is_empty(), "{name}: {bounds:?}");
    }
}
