//! Surfaces at other resolutions and in other triangulations.

use nalgebra::Point3;
use p2m_core::{Aabb, Element, Soup};
use std::collections::{HashMap, HashSet};

/// Merges the vertices of a scene in the cells of a grid, where each cell becomes the mean of its vertices
/// \[Rossignac1993\], and returns the triangles that remain: about `wanted`, and never more than the scene has.
pub(super) fn coarsened(soup: &Soup<f64>, wanted: usize) -> Soup<f64> {
    // A finer grid has more triangles, apart from rare exceptions, so the resolution is found by bisection.
    let (mut few, mut many) = (1u32, 1u32 << 14);
    while few + 1 < many {
        let middle = u32::midpoint(few, many);
        if clustered(soup, middle).1.len() < wanted { few = middle } else { many = middle }
    }
    let near = |grid: u32| clustered(soup, grid).1.len().abs_diff(wanted);
    let (positions, triangles) = clustered(soup, if near(few) < near(many) { few } else { many });
    Soup::new(positions, triangles.into_iter().map(Element::Triangle)).expect("means of finite positions")
}

/// Merges vertices on a grid with the given number of cells along the longest side of the box.
#[allow(clippy::cast_possible_truncation, reason = "cells of a grid, and vertices below 2^32")]
fn clustered(soup: &Soup<f64>, grid: u32) -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let positions = soup.positions();
    let bounds = positions.iter().fold(Aabb::empty(), |all, v| all.union(&Aabb { min: *v, max: *v }));
    let per_length = f64::from(grid) / (bounds.max - bounds.min).max();
    let mut numbers: HashMap<[i64; 3], u32> = HashMap::new();
    let mut sums: Vec<(Point3<f64>, f64)> = Vec::new();
    let cell_of: Vec<u32> = positions
        .iter()
        .map(|position| {
            let cell: [i64; 3] = ((position - bounds.min) * per_length).map(|x| x.floor() as i64).into();
            let number = *numbers.entry(cell).or_insert(sums.len() as u32);
            if number as usize == sums.len() {
                sums.push((Point3::origin(), 0.0));
            }
            let (sum, count) = &mut sums[number as usize];
            (*sum, *count) = (*sum + position.coords, *count + 1.0);
            number
        })
        .collect();
    let mut seen = HashSet::new();
    let triangles = soup.triangles().iter().map(|t| t.map(|v| cell_of[v as usize])).filter(|t| {
        let mut sorted = *t;
        sorted.sort_unstable();
        sorted[0] != sorted[1] && sorted[1] != sorted[2] && seen.insert(sorted)
    });
    let triangles = triangles.collect();
    (sums.into_iter().map(|(sum, count)| sum / count).collect(), triangles)
}

/// Cuts each triangle into a fan of `parts` triangles from the corner opposite to its shortest side, which gives the
/// same surface in long thin triangles.
#[allow(clippy::cast_possible_truncation, reason = "vertices below 2^32")]
pub(super) fn fanned(soup: &Soup<f64>, parts: u32) -> Soup<f64> {
    let mut positions = soup.positions().to_vec();
    let mut elements = Vec::new();
    for triangle in soup.triangles() {
        let length = |i: usize| {
            let [a, b] = [triangle[(i + 1) % 3], triangle[(i + 2) % 3]];
            (positions[a as usize] - positions[b as usize]).norm_squared()
        };
        let tip = (0..3).min_by(|i, j| length(*i).total_cmp(&length(*j))).unwrap_or(0);
        let [tip, from, to] = [0, 1, 2].map(|i| triangle[(tip + i) % 3]);
        let [start, end] = [from, to].map(|v| positions[v as usize]);
        let mut last = from;
        for part in 1..=parts {
            let next = if part == parts { to } else { positions.len() as u32 };
            if part < parts {
                positions.push(start + (end - start) * (f64::from(part) / f64::from(parts)));
            }
            elements.push(Element::Triangle([tip, last, next]));
            last = next;
        }
    }
    Soup::new(positions, elements).expect("finite positions")
}

/// Returns the mean of the paper's measure of triangles, and the fraction of triangles with an angle below 10 degrees.
/// The measure is 6 / sqrt 3 times the area over half the perimeter and the longest side, which is 1 for equal sides.
pub(super) fn quality(soup: &Soup<f64>) -> (f64, f64) {
    let (mut sum, mut bad) = (0.0, 0usize);
    for triangle in soup.triangles() {
        let [a, b, c] = triangle.map(|v| soup.positions()[v as usize]);
        let area = 0.5 * (b - a).cross(&(c - a)).norm();
        let mut sides = [(b - a).norm(), (c - b).norm(), (a - c).norm()];
        sides.sort_by(f64::total_cmp);
        let half = 0.5 * sides.iter().sum::<f64>();
        let measure = 6.0 / 3f64.sqrt() * area / (half * sides[2]);
        sum += if measure.is_finite() { measure } else { 0.0 };
        // The smallest angle is between the two longer sides.
        let sine = 2.0 * area / (sides[1] * sides[2]);
        bad += usize::from(sine.is_nan() || sine < 10f64.to_radians().sin());
    }
    let count = soup.triangles().len().max(1) as f64;
    (sum / count, bad as f64 / count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::PrimitiveSet;
    use p2m_mixed::generate::{IcoSphere, ico_sphere};
    use p2m_testkit::amount;

    fn area(soup: &Soup<f64>) -> f64 {
        let positions = soup.positions();
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            0.5 * (b - a).cross(&(c - a)).norm()
        };
        soup.triangles().iter().map(of).sum()
    }

    #[test]
    fn coarse_surfaces_have_about_as_many_triangles_and_lie_where_they_did() {
        let sphere = ico_sphere(&IcoSphere { frequency: amount(40, 12) }).unwrap();
        assert_eq!(sphere.len(), amount(32_000, 2_880));
        for wanted in amount(vec![500, 4_000, 16_000], vec![300, 1_000]) {
            let coarse = coarsened(&sphere, wanted);
            assert!(coarse.len().abs_diff(wanted) * 20 < wanted * 3, "{wanted}: {}", coarse.len());
            assert!((area(&coarse) / area(&sphere) - 1.0).abs() < 0.1, "{}", area(&coarse));
            let far = coarse.positions().iter().map(|p| (p.coords.norm() - 1.0).abs()).fold(0.0, f64::max);
            assert!(far < 0.1, "{far}");
        }
    }

    #[test]
    fn fans_are_the_same_surface_in_bad_triangles() {
        let sphere = ico_sphere(&IcoSphere { frequency: 4 }).unwrap();
        let fans = fanned(&sphere, 16);
        assert_eq!(fans.len(), 16 * sphere.len());
        assert!((area(&fans) / area(&sphere) - 1.0).abs() < 1e-12);
        let ([good, few], [bad, many]) = (<[f64; 2]>::from(quality(&sphere)), <[f64; 2]>::from(quality(&fans)));
        assert!(good > 0.9 && few == 0.0 && bad < 0.2 && many == 1.0, "{good} {few} {bad} {many}");
        // The first triangle has equal sides, the second is a sliver.
        let of = |c: [f64; 3]| {
            let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], c].map(Point3::from).to_vec();
            quality(&Soup::new(positions, [Element::Triangle([0, 1, 2])]).unwrap())
        };
        assert!((of([0.5, 0.75f64.sqrt(), 0.0]).0 - 1.0).abs() < 1e-12);
        assert_eq!(of([0.5, 0.0, 0.0]), (0.0, 1.0));
    }
}
