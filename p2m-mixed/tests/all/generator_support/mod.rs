//! Functions that the tests of generators share: topology, volume, exact predicates, checksums.

use nalgebra::Point3;
use p2m_core::{Element, Soup};
use std::collections::HashMap;

/// Returns the FNV-1a hash of the bits of the positions and of the kinds and indices of the primitives.
pub(crate) fn checksum(soup: &Soup<f64>) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut eat = |bytes: &[u8]| {
        for &byte in bytes {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    for x in soup.positions().iter().flat_map(|p| [p.x, p.y, p.z]) {
        eat(&x.to_bits().to_le_bytes());
    }
    for element in soup.elements() {
        eat(&[u8::try_from(element.indices().len()).unwrap()]);
        element.indices().iter().for_each(|i| eat(&i.to_le_bytes()));
    }
    hash
}

pub(crate) fn corners(soup: &Soup<f64>, triangle: [u32; 3]) -> [Point3<f64>; 3] {
    triangle.map(|i| soup.positions()[i as usize])
}

/// Checks that every edge has two triangles that run along it in opposite directions, and returns
/// the Euler characteristic.
pub(crate) fn assert_watertight(soup: &Soup<f64>) -> i64 {
    let mut edges = HashMap::new();
    let mut used = vec![false; soup.positions().len()];
    for &[a, b, c] in soup.triangles() {
        for edge in [[a, b], [b, c], [c, a]] {
            assert!(edges.insert(edge, ()).is_none(), "{edge:?} is used twice in the same direction");
            used[edge[0] as usize] = true;
        }
    }
    assert!(edges.keys().all(|[a, b]| edges.contains_key(&[*b, *a])), "every edge has its other side");
    assert!(used.iter().all(|&used| used), "every position is used");
    soup.positions().len() as i64 - edges.len() as i64 / 2 + soup.triangles().len() as i64
}

pub(crate) fn volume(soup: &Soup<f64>) -> f64 {
    let six_fold = |&t: &[u32; 3]| {
        let [a, b, c] = corners(soup, t).map(|p| p.coords);
        a.dot(&b.cross(&c))
    };
    soup.triangles().iter().map(six_fold).sum::<f64>() / 6.0
}

/// Returns the longest edge divided by the height over it.
pub(crate) fn aspect([a, b, c]: [Point3<f64>; 3]) -> f64 {
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    longest * longest / (b - a).cross(&(c - a)).norm()
}

/// Returns the sign of the area of a triangle in the plane, if rounding cannot change it.
///
/// The bound is that of Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates"
/// (1997), A of orient2d: (3 + 16 u) u times the sum of the absolute products.
pub(crate) fn orient2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Option<bool> {
    let left = (a[0] - c[0]) * (b[1] - c[1]);
    let right = (a[1] - c[1]) * (b[0] - c[0]);
    let u = f64::EPSILON / 2.0;
    certain(left - right, (3.0 + 16.0 * u) * u * (left.abs() + right.abs()))
}

/// Returns whether `d` is below the plane of a, b, c, which are counter-clockwise seen from above, if rounding cannot
/// change the answer.
///
/// The bound is that of the same paper, A of orient3d: (7 + 56 u) u times the sum of the absolute products.
pub(crate) fn below(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>, d: &Point3<f64>) -> Option<bool> {
    let [a, b, c] = [a - d, b - d, c - d];
    let terms = [(a, b, c), (b, c, a), (c, a, b)];
    let sum: f64 = terms.iter().map(|(a, b, c)| a.z * (b.x * c.y - b.y * c.x)).sum();
    let absolute: f64 = terms.iter().map(|(a, b, c)| a.z.abs() * ((b.x * c.y).abs() + (b.y * c.x).abs())).sum();
    let u = f64::EPSILON / 2.0;
    certain(sum, (7.0 + 56.0 * u) * u * absolute)
}

fn certain(value: f64, bound: f64) -> Option<bool> {
    (value.abs() > bound).then_some(value > 0.0)
}

/// Returns whether the triangle certainly has an area, because one of its projections has one.
pub(crate) fn has_area([a, b, c]: [Point3<f64>; 3]) -> bool {
    [(0, 1), (1, 2), (2, 0)].iter().any(|&(i, j)| orient2d([a[i], a[j]], [b[i], b[j]], [c[i], c[j]]).is_some())
}

pub(crate) fn assert_not_degenerate(soup: &Soup<f64>) {
    for element in soup.elements() {
        let corners: Vec<_> = element.indices().iter().map(|&i| soup.positions()[i as usize]).collect();
        match element {
            Element::Point(_) => {}
            Element::Segment(_) => assert_ne!(corners[0], corners[1], "{element:?}"),
            Element::Triangle(t) => assert!(has_area(self::corners(soup, t)), "{element:?} {corners:?}"),
        }
    }
}
