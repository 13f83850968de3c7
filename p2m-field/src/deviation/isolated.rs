//! Isolated points of a scan, such as dust and reflections.

use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::{self, BatchOptions};
use p2m_core::{NearQuery, Point};

/// The number of neighbours by which [`isolated_points`] judges.
const NEIGHBOURS: usize = 8;
/// The ratio above which a point is isolated: its mean distance from its neighbours over the median of their mean
/// distances.
const ISOLATED: f64 = 4.0;

/// Returns for each point of a scan whether it is isolated: its mean distance from the eight nearest other points
/// exceeds four times the median of the mean distances of these eight points. So the density of a scan may change from
/// place to place, but a group of nine stray points is not isolated. Points that are not finite are not isolated, and a
/// scan of fewer than ten points has no isolated ones.
///
/// # Complexity
/// Expected O(n log n) time: a few microseconds per point, and 200 bytes.
#[must_use]
pub fn isolated_points(points: &[Point3<f64>]) -> Vec<bool> {
    let mut isolated = vec![false; points.len()];
    let finite: Vec<usize> = (0..points.len()).filter(|i| points[*i].iter().all(|x| x.is_finite())).collect();
    if finite.len() < NEIGHBOURS + 2 {
        return isolated;
    }
    let set: Vec<Point<f64>> = finite.iter().map(|i| Point::new(points[*i])).collect();
    // Building fails only for more than 2^30 points, of which none can be judged.
    let Ok(index) = AabbTree::new(&set) else { return isolated };
    let neighbours = |i: &usize| {
        let found = index.k_nearest(&points[finite[*i]], NEIGHBOURS + 1, f64::INFINITY);
        // The point itself is among the nearest, or as many at the same place.
        let sum: f64 = found.iter().map(|other| other.distance).sum();
        let ids = found.iter().map(|other| other.primitive.number());
        (sum / NEIGHBOURS as f64, ids.collect::<Vec<u32>>())
    };
    let numbers: Vec<usize> = (0..finite.len()).collect();
    let found = batch::map(&numbers, &BatchOptions::default(), |i| points[finite[*i]], neighbours);
    for (i, (mean, ids)) in found.iter().enumerate() {
        let mut others: Vec<f64> = ids.iter().filter(|id| **id as usize != i).map(|id| found[*id as usize].0).collect();
        others.sort_unstable_by(f64::total_cmp);
        isolated[finite[i]] = *mean > ISOLATED * others[others.len() / 2];
    }
    isolated
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_testkit::{normal_number, rng};
    use rand::RngExt;

    #[test]
    fn stray_points_are_isolated_and_edges_and_sparse_parts_are_not() {
        let mut rng = rng("isolated", 0);
        // The density of this sheet falls by a factor of a hundred from one side to the other.
        let mut scan: Vec<Point3<f64>> = (0..4000)
            .map(|_| {
                let x = 10f64.powf(rng.random_range(0.0..1.0));
                Point3::new(x, rng.random_range(0.0..x), 1e-3 * normal_number(&mut rng))
            })
            .collect();
        assert_eq!(isolated_points(&scan).iter().filter(|is| **is).count(), 0);
        let stray = [[2.0, 1.0, 1.0], [5.0, 2.0, 4.0], [-3.0, 0.0, 0.0], [40.0, 0.0, 0.0]];
        scan.splice(0..0, stray.map(Point3::from));
        scan.push(Point3::new(f64::NAN, 0.0, 0.0));
        let found = isolated_points(&scan);
        assert!(found[..4].iter().all(|is| *is) && !found[4..].iter().any(|is| *is));
        // A grid has equal distances, and equal points have none.
        let grid: Vec<Point3<f64>> = (0..400).map(|i| Point3::new((i % 20).into(), (i / 20).into(), 0.0)).collect();
        assert!(!isolated_points(&grid).contains(&true));
        assert!(!isolated_points(&vec![Point3::origin(); 50]).contains(&true));
        assert_eq!(isolated_points(&scan[..9]), [false; 9]);
    }
}
