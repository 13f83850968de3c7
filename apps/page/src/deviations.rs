//! The deviations of a scan on a page.

use crate::decimate::MAX_PRIMITIVES;
use crate::packed::Packed;
use nalgebra::Point3;
use p2m_core::{Aabb, PrimitiveId, Soup};
use p2m_field::deviation::{DeviationStatistics, OutsideTolerance, outside};
use p2m_mixed::Scene;
use p2m_mixed::statistics::figure::{Count, Figure};
use serde_json::{Value, json};

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

    /// Returns the part of the points that is within the tolerance, and whether that is the required percentage, if
    /// there is a tolerance.
    #[must_use]
    pub fn verdict(&self, required: Option<f64>, unit: &str) -> Option<Verdict> {
        let tolerance = self.tolerance?;
        let count = self.statistics.count;
        let within = outside(self.values, tolerance).percent_within(count);
        let passes = required.map(|required| within >= required);
        // Rounding must not reach what the share itself does not.
        let rounded = (within * 100.0).round() / 100.0;
        let is_reached = |limit: f64| within < limit && rounded >= limit;
        let is_misleading = is_reached(100.0) || required.is_some_and(is_reached);
        let shown = if is_misleading { (within * 1e4).floor() / 1e4 } else { rounded };
        let required = required.map(|required| format!(", {required} % required")).unwrap_or_default();
        let sign = if self.is_signed { "+-" } else { "" };
        let sentence = match count {
            0 => format!("no point has a deviation{required}"),
            _ => format!("{shown} % within {sign}{tolerance} {unit}{required}"),
        };
        Some(Verdict { passes, sentence })
    }

    /// Returns a sentence with the main numbers.
    #[must_use]
    pub fn summary(&self, unit: &str) -> String {
        let DeviationStatistics { count, mean, rms, min, max, .. } = *self.statistics;
        let what = if self.is_signed { "deviations, positive outside" } else { "distances" };
        let [mean, rms, min, max] = [mean, rms, min, max].map(Figure);
        let count = Count(count as u64);
        format!("{count} {what}: mean {mean} {unit}, root mean square {rms} {unit}, from {min} to {max} {unit}")
    }

    /// Returns the box of the points of a scan that are finite, which the picture of a page has to contain.
    #[must_use]
    pub fn bounds(scan: &Soup<f64>) -> Aabb<f64> {
        let is_finite = |point: &&Point3<f64>| point.iter().all(|x| x.is_finite());
        let add = |bounds: Aabb<f64>, point: &Point3<f64>| bounds.union(&Aabb { min: *point, max: *point });
        scan.positions().iter().filter(is_finite).fold(Aabb::empty(), add)
    }
}

/// Whether deviations are within a tolerance as often as required.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The answer, if a percentage is required. Without any deviation it is `false`.
    pub passes: Option<bool>,
    /// The sentence that says which part of the points is within the tolerance.
    pub sentence: String,
}

impl Verdict {
    /// Returns the verdict as a word: `PASS` or `FAIL`.
    #[must_use]
    pub fn word(&self) -> Option<&'static str> {
        self.passes.map(|passes| if passes { "PASS" } else { "FAIL" })
    }
}

/// The deviations from one named object.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectDeviations {
    /// The name of the object; empty for the primitives in none.
    pub name: String,
    /// The statistics of the deviations whose closest primitive is one of the object.
    pub statistics: DeviationStatistics,
    /// The numbers of them outside of the tolerance, if there is one.
    pub outside: Option<OutsideTolerance>,
}

impl ObjectDeviations {
    /// Returns the deviations from each object of a scene that has a name, and from the rest if there are some. A scene
    /// without objects has none.
    #[must_use]
    pub fn of_scene(scene: &Scene, deviations: &Deviations<'_>) -> Vec<Self> {
        if scene.objects.is_empty() {
            return Vec::new();
        }
        let mut values = vec![Vec::new(); scene.objects.len() + 1];
        for (primitive, value) in deviations.primitives.iter().zip(deviations.values) {
            if value.is_finite() {
                let number = scene.object_number(PrimitiveId::new(*primitive as usize));
                values[number.unwrap_or(scene.objects.len())].push(*value);
            }
        }
        let names = scene.objects.iter().map(|object| object.name.clone()).chain([String::new()]);
        let found = names.zip(values).map(|(name, values)| Self {
            name,
            statistics: DeviationStatistics::of(&values),
            outside: deviations.tolerance.map(|tolerance| outside(&values, tolerance)),
        });
        found.filter(|object| !object.name.is_empty() || object.statistics.count > 0).collect()
    }
}

/// The number of equal parts by which the values of a scan are described that has too many points to draw.
const QUANTILES: usize = 10_000;

impl Deviations<'_> {
    /// Packs the deviations for the script of a page, and returns a note if not all points are drawn.
    pub(crate) fn data(&self) -> (Value, Option<String>) {
        let Deviations { scan, values, primitives, statistics, .. } = *self;
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
        let named = statistics.named();
        let mut data = json!({
            "total": total,
            "missing": statistics.missing,
            // Every point with this stride is drawn.
            "stride": stride,
            "positions": Packed::new(&positions),
            "values": Packed::new(&values.iter().copied().step_by(stride).collect::<Vec<f64>>()),
            "primitives": Packed::new(&primitives.iter().copied().step_by(stride).collect::<Vec<u32>>()),
            // The vertices of the triangles that are drawn.
            "triangles": Packed::new(triangles),
            // All values in order, or as many of them at equal distances.
            "quantiles": quantiles,
            // A number is null if there are no deviations.
            "statistics": named.iter().map(|s| json!({ "label": s.label, "value": s.value })).collect::<Value>(),
            "is_signed": self.is_signed,
            "limit": self.limit,
            "tolerance": self.tolerance,
            // The numbers of values above the tolerance and below its negative.
            "outside_tolerance": self.tolerance.map(|tolerance| {
                let outside = outside(values, tolerance);
                [outside.above, outside.below]
            }),
        });
        if let (Value::Object(data), 1) = (&mut data, stride) {
            data.shift_remove("quantiles");
        }
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
    fn verdicts_are_not_rounded_up() {
        let scan = Soup::default();
        let verdict = |outside: usize, required| {
            let mut values = vec![0.0; 300_000 - outside];
            values.resize(300_000, -2.0);
            let statistics = &DeviationStatistics::of(&values);
            let (values, tolerance) = (&values[..], Some(1.0));
            let deviations =
                Deviations { scan: &scan, values, primitives: &[], statistics, is_signed: true, limit: 1.0, tolerance };
            let Verdict { passes, sentence } = deviations.verdict(required, "mm").unwrap();
            (passes, sentence)
        };
        assert_eq!(verdict(1, None), (None, "99.9996 % within +-1 mm".to_owned()));
        assert_eq!(verdict(0, Some(100.0)), (Some(true), "100 % within +-1 mm, 100 % required".to_owned()));
        assert_eq!(verdict(100_000, Some(60.0)), (Some(true), "66.67 % within +-1 mm, 60 % required".to_owned()));
        assert_eq!(
            verdict(100_000, Some(66.67)),
            (Some(false), "66.6666 % within +-1 mm, 66.67 % required".to_owned())
        );
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
        let (data, note) = deviations.data();
        assert_eq!((&data["stride"], &data["total"]), (&3.into(), &count.into()));
        // These are counted among all points.
        assert_eq!(data["outside_tolerance"], json!([count - 1_000_011, 999_990]));
        assert_eq!(
            note.unwrap(),
            "The scan has 2000001 points, of which 666667 are drawn. The statistics are those of all."
        );
        assert!(data["quantiles"].is_object());
        let few = Deviations { values: &values[..2], primitives: &[0; 2], ..deviations };
        let (data, note) = Deviations { scan: &Soup::new(vec![Point3::origin(); 2], []).unwrap(), ..few }.data();
        assert!(data.get("quantiles").is_none() && note.is_none());
    }
}
