//! Pictures of slices through fields.

use crate::grid::Grid;

/// Draws a layer of a field perpendicular to an axis (0 to 2).
///
/// Returns width and height, and the rows of pixels from top to bottom as bytes of red, green and blue. Perpendicular
/// to z, x runs to the right and y upwards; the other axes follow cyclically. Each point is a square of pixels, and the
/// longer side of the picture has at least 512.
///
/// Points outside are coloured from white to blue, points inside from white to orange, and points without a number are
/// grey. Lines connect points of equal distance, and the surface is a dark line.
///
/// # Panics
/// If the axis is not below 3, the grid has no such layer, or the values are not one for each point.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
pub fn slice(grid: &Grid, values: &[f32], axis: usize, layer: usize) -> ([usize; 2], Vec<u8>) {
    let counts = grid.counts();
    assert!(axis < 3 && layer < counts[axis], "layer {layer} across axis {axis} of {counts:?}");
    assert_eq!(values.len(), grid.len(), "one value for each point");
    let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
    let at = |i: usize, j: usize| {
        let mut number = [layer; 3];
        (number[right], number[up]) = (i, j);
        f64::from(values[grid.number(number)])
    };
    let all = (0..counts[right] * counts[up]).map(|n| at(n % counts[right], n / counts[right]));
    let farthest = all.filter(|x| x.is_finite()).fold(0.0f64, |most, x| most.max(x.abs()));
    // There are about ten lines, at least three points apart.
    let step = (farthest / 10.0).max(3.0 * grid.spacing());
    let colour = |value: f64| -> [f64; 3] {
        if value.is_nan() {
            return [0.6; 3];
        }
        let saturation = if farthest > 0.0 { (value.abs() / farthest).min(1.0).sqrt() } else { 0.0 };
        let [full, line] =
            if value < 0.0 { [[0.85, 0.40, 0.05], [0.55, 0.25, 0.0]] } else { [[0.10, 0.35, 0.70], [0.05, 0.2, 0.45]] };
        let (past_line, width) = ((value.abs() / step).fract(), 0.5 * grid.spacing() / step);
        if value.abs() < 0.75 * grid.spacing() && value.abs() < farthest {
            [0.08; 3]
        } else if past_line < width || past_line > 1.0 - width {
            [0, 1, 2].map(|k| line[k] * saturation + (1.0 - saturation) * 0.6)
        } else {
            full.map(|x| x * saturation + 1.0 - saturation)
        }
    };
    let size = 512usize.div_ceil(counts[right].max(counts[up]));
    let [width, height] = [counts[right] * size, counts[up] * size];
    let mut pixels = Vec::with_capacity(3 * width * height);
    for j in (0..counts[up]).rev() {
        let start = pixels.len();
        for i in 0..counts[right] {
            let pixel = colour(at(i, j)).map(|x| (x * 255.0).round() as u8);
            (0..size).for_each(|_| pixels.extend(pixel));
        }
        let end = pixels.len();
        (1..size).for_each(|_| pixels.extend_from_within(start..end));
    }
    ([width, height], pixels)
}
