//! Hints that a scan and a scene are in other units or other places.

use nalgebra::{Point3, Rotation3};
use p2m_backends::AnyIndex;
use p2m_core::{Aabb, PrimitiveSet, Soup};
use p2m_field::align::{AlignOptions, align};
use p2m_mixed::statistics::figure::Figure;
use std::ops::ControlFlow;

/// The factors between units of length that are often mixed up, with what they are.
const UNIT_FACTORS: [(f64, &str); 4] = [
    (1000.0, "millimetres and metres"),
    (100.0, "centimetres and metres"),
    (25.4, "millimetres and inches"),
    (39.37, "inches and metres"),
];

/// The least and the largest number of points with which [`note_on_place`] aligns.
const SAMPLE: [usize; 2] = [50, 1000];

fn finite(points: &[Point3<f64>]) -> Vec<Point3<f64>> {
    points.iter().filter(|point| point.iter().all(|x| x.is_finite())).copied().collect()
}

/// Returns a sentence if a scan and a scene seem to be in other units or other places.
pub(super) fn note_on_sizes(scan: &Soup<f64>, scene: &Soup<f64>) -> Option<String> {
    let (scan, scene) = (Aabb::from_points(&finite(scan.positions())), scene.aabb());
    if scan.is_empty() || scene.is_empty() {
        return None;
    }
    let [of_scan, of_scene] = [&scan, &scene].map(|bounds| (bounds.max - bounds.min).norm());
    let ratio = of_scan.max(of_scene) / of_scan.min(of_scene);
    if let Some((factor, units)) = UNIT_FACTORS.iter().find(|(factor, _)| (ratio / factor - 1.0).abs() < 0.1) {
        return Some(format!("one of the scan and the scene is about {factor} times as large: {units}?"));
    }
    let gap = |axis: usize| (scan.min[axis] - scene.max[axis]).max(scene.min[axis] - scan.max[axis]);
    (0..3)
        .any(|axis| gap(axis) > of_scene)
        .then(|| "the scan and the scene lie apart: is one of them moved, or in another unit?".to_owned())
}

/// Returns a sentence if a small motion of a scan would halve its distances from the scene, by the median of a sample.
pub(super) fn note_on_place(
    points: &[Point3<f64>],
    scene: &Soup<f64>,
    index: &dyn AnyIndex,
    unit: &str,
) -> Option<String> {
    let points = finite(points);
    let sample: Vec<Point3<f64>> = points.iter().step_by(points.len().div_ceil(SAMPLE[1]).max(1)).copied().collect();
    if sample.len() < SAMPLE[0] {
        return None;
    }
    let median = |points: &mut dyn Iterator<Item = Point3<f64>>| {
        let mut distances: Vec<f64> =
            points.filter_map(|point| index.closest_point(&point)).map(|answer| answer.distance).collect();
        distances.sort_unstable_by(f64::total_cmp);
        distances.get(distances.len() / 2).copied()
    };
    let before = median(&mut sample.iter().copied())?;
    let options = AlignOptions::default().with_search(false);
    let found = align(scene, index, &sample, &options, &mut |_| ControlFlow::Continue(())).ok()?;
    let after = median(&mut sample.iter().map(|point| found.apply(point)))?;
    let bounds = Aabb::from_points(&points);
    let diagonal = (bounds.max - bounds.min).norm();
    if !(before > 1e-6 * diagonal && after < 0.5 * before) {
        return None;
    }
    let centre = nalgebra::center(&bounds.min, &bounds.max);
    let degrees = Rotation3::from_matrix_unchecked(found.matrix.fixed_view::<3, 3>(0, 0).into()).angle().to_degrees();
    let [shift, degrees, before, after] = [(found.apply(&centre) - centre).norm(), degrees, before, after].map(Figure);
    Some(format!(
        "the scan seems not to be aligned: a motion by {shift} {unit} and {degrees} degrees changes the median distance \
         from {before} to {after} {unit}; --align moves it"
    ))
}
