//! The deviations of a scan on a page.

use crate::decimate::MAX_PRIMITIVES;
use crate::packed::Packed;
use nalgebra::Point3;
use p2m_core::{Aabb, Soup};
use p2m_field::deviation::{DeviationStatistics, outside};
use serde::Serialize;

/// The deviations of a scan from the scene of a page.
#[derive(Clone, Copy, Debug)]
pub struct Deviations<'a> {
    /// The scan: its positions are the points, and its triangles are drawn if it has some.
    pub scan: &'a Soup<f64>,
    /// The deviation of each position, or NaN where there is none.
    pub values: &'a [f64],
    /// The number of the closest primitive of each position; any number where there is no deviation.
    pub primitives: &'a [u32],
    /// The statistics of all values.
    pub statistics: &'a DeviationStatistics,
    /// Whether the values have signs.
    pub is_signed: bool,
    /// The absolute value from which on colours do not change: [`usual_limit`](Self::usual_limit) by default.
    pub limit: f64,
    /// The largest absolute value that counts as within the tolerance at first, if there is a tolerance.
    pub tolerance: Option<f64>,
}

impl Deviations<'_> {
    /// Returns the limit of colours that shows a tolerance, if there is one, and all deviations but the largest: three
    /// tolerances, or else the 95th percentile. It is 1 where all deviations are 0.
    #[must_use]
    pub fn usual_limit(statistics: &DeviationStatistics, tolerance: Option<f64>) -> f64 {
        let limit = tolerance.filter(|tolerance| *tolerance > 0.0).map_or(statistics.usual_limit(), |t| 3.0 * t);
        if limit > 0.0 { limit } else { 1.0 }
    }

    /// Returns the box of the points of a scan that are finite, which the picture of a page has to contain.
    #[must_use]
    pub fn bounds(scan: &Soup<f64>) -> Aabb<f64> {
        let is_finite = |point: &&Point3<f64>| point.iter().all(|x| x.is_finite());
        let add = |bounds: Aabb<f64>, point: &Point3<f64>| bounds.union(&Aabb { min: *point, max: *point });
        scan.positions().iter().filter(is_finite).fold(Aabb::empty(), add)
    }
}

/// The number of equal parts by which the values of a scan are described that has too many points to draw.
const QUANTILES: usize = 10_000;

#[derive(Debug, Serialize)]
pub(crate) struct DeviationData {
    /// The number of points of the scan.
    total: usize,
    missing: usize,
    /// The points that are drawn: every one with this stride.
    stride: usize,
    positions: Packed,
    values: Packed,
    primitives: Packed,
    /// The vertices of the triangles that are drawn.
    triangles: Packed,
    /// All values in order, or as many of them at equal distances, if not all points are drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    quantiles: Option<Packed>,
    statistics: Vec<StatisticData>,
    is_signed: bool,
    limit: f64,
    tolerance: Option<f64>,
    /// The numbers of values above the tolerance and below its negative.
    outside_tolerance: Option<[usize; 2]>,
}

#[derive(Debug, Serialize)]
struct StatisticData {
    label: String,
    /// The number; null if there are no deviations.
    value: f64,
}

impl DeviationData {
    /// Packs deviations, and returns a note if not all points are drawn.
    pub(crate) fn new(deviations: &Deviations<'_>) -> (Self, Option<String>) {
        let Deviations { scan, values, primitives, statistics, .. } = *deviations;
        let total = scan.positions().len();
        assert_eq!([values.len(), primitives.len()], [total; 2], "a value and a primitive for each position");
        let stride = total.div_ceil(MAX_PRIMITIVES).max(1);
        let positions: Vec<f64> = scan.positions().iter().step_by(stride).flat_map(|p| [p.x, p.y, p.z]).collect();
        let has_triangles = stride == 1 && scan.triangles().len() <= MAX_PRIMITIVES;
        let triangles = if has_triangles { scan.triangles().as_flattened() } else { &[] };
        let quantiles = (stride > 1).then(|| {
            let mut sorted: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
            sorted.sort_unstable_by(f64::total_cmp);
            // The middles of equal parts stand for these.
            let parts = QUANTILES.min(sorted.len());
            let at = |i: usize| sorted[(2 * i + 1) * sorted.len() / (2 * parts)];
            Packed::new(&(0..parts).map(at).collect::<Vec<f64>>())
        });
        let note = (stride > 1).then(|| {
            let drawn = positions.len() / 3;
            format!("The scan has {total} points, of which {drawn} are drawn. The statistics are those of all.")
        });
        let statistics_data =
            statistics.named().into_iter().map(|s| StatisticData { label: s.label, value: s.value }).collect();
        let data = Self {
            total,
            missing: statistics.missing,
            stride,
            positions: Packed::new(&positions),
            values: Packed::new(&values.iter().copied().step_by(stride).collect::<Vec<f64>>()),
            primitives: Packed::new(&primitives.iter().copied().step_by(stride).collect::<Vec<u32>>()),
            triangles: Packed::new(triangles),
            quantiles,
            statistics: statistics_data,
            is_signed: deviations.is_signed,
            limit: deviations.limit,
            tolerance: deviations.tolerance,
            outside_tolerance: deviations.tolerance.map(|tolerance| {
                let outside = outside(values, tolerance);
                [outside.above, outside.below]
            }),
        };
        (data, note)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_are_not_finite_are_outside_of_the_picture() {
        let points = [[1.0, 2.0, 3.0], [f64::NAN, 0.0, 0.0], [0.0, 4.0, 1.0], [0.0, f64::INFINITY, 0.0]];
        let bounds = Deviations::bounds(&Soup::new(points.map(Point3::from).to_vec(), []).unwrap());
        assert_eq!((bounds.min, bounds.max), ([0.0, 2.0, 1.0].into(), [1.0, 4.0, 3.0].into()));
        assert!(Deviations::bounds(&Soup::default()).is_empty());
    }

    #[test]
    fn colours_reach_to_three_tolerances_or_to_most_deviations() {
        let limit = |values: &[f64], tolerance| Deviations::usual_limit(&DeviationStatistics::of(values), tolerance);
        assert_eq!(
            [limit(&[1.0, -9.0], Some(0.5)), limit(&[2.0, -2.0], None), limit(&[2.0], Some(0.0))],
            [1.5, 2.0, 2.0]
        );
        assert_eq!([limit(&[0.0], None), limit(&[0.0], Some(0.0))], [1.0, 1.0]);
    }

    #[test]
    fn a_scan_of_too_many_points_is_thinned_and_described_by_quantiles() {
        let count = 2 * MAX_PRIMITIVES + 1;
        let scan = Soup::new(vec![Point3::origin(); count], []).unwrap();
        let values: Vec<f64> = (0..count).map(|i| i as f64 - 1e6).collect();
        let statistics = DeviationStatistics::of(&values);
        let deviations = Deviations {
            scan: &scan,
            values: &values,
            primitives: &vec![0; count],
            statistics: &statistics,
            is_signed: true,
            limit: 1.0,
            tolerance: Some(10.0),
        };
        let (data, note) = DeviationData::new(&deviations);
        assert_eq!((data.stride, data.total), (3, count));
        // These are counted among all points.
        assert_eq!(data.outside_tolerance, Some([count - 1_000_011, 999_990]));
        assert_eq!(
            note.unwrap(),
            "The scan has 2000001 points, of which 666667 are drawn. The statistics are those of all."
        );
        assert!(data.quantiles.is_some());
        let few = Deviations { values: &values[..2], primitives: &[0; 2], ..deviations };
        let (data, note) =
            DeviationData::new(&Deviations { scan: &Soup::new(vec![Point3::origin(); 2], []).unwrap(), ..few });
        assert!(data.quantiles.is_none() && note.is_none());
    }
}
