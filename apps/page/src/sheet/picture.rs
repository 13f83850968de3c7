//! Pictures of a scan and a part, drawn with a depth buffer in parallel perspective.

use nalgebra::{Point3, Vector3};
use p2m_core::Soup;

/// The number of samples of a pixel along each side.
const SAMPLES: usize = 2;
/// The part of a picture that what it shows fills.
const FILLED: f64 = 0.92;
/// The direction towards the light: left, up and towards the viewer.
const LIGHT: [f64; 3] = [-0.4, 0.6, 0.7];
/// How far in front of its place a point is drawn, as a part of the size of the picture, so that the surface does not hide it.
const IN_FRONT: f64 = 0.01;

/// A picture: red, green and blue of each pixel, row by row.
pub(super) struct Picture {
    pub(super) size: [usize; 2],
    pub(super) bytes: Vec<u8>,
}

/// The samples of a picture that is being drawn.
pub(super) struct Drawing {
    size: [usize; 2],
    colours: Vec<[u8; 3]>,
    /// How near each sample is: the coordinate towards the viewer.
    depths: Vec<f32>,
    /// The directions to the right, upwards and towards the viewer.
    axes: [Vector3<f64>; 3],
    centre: Point3<f64>,
    /// Samples per unit of the scene.
    scale: f64,
}

impl Drawing {
    /// Starts a picture of some points, of which those that are not finite do not count. `axes` are the directions to the
    /// right, upwards and towards the viewer.
    pub(super) fn new<'a>(
        size: [usize; 2],
        background: [u8; 3],
        points: impl Iterator<Item = &'a Point3<f64>>,
        axes: [Vector3<f64>; 3],
    ) -> Self {
        let size = size.map(|x| x * SAMPLES);
        let (mut origin, mut ends) = (None, [[0.0f64; 2]; 3]);
        for point in points.filter(|point| point.iter().all(|x| x.is_finite())) {
            let offset = point - *origin.get_or_insert(*point);
            for (end, axis) in ends.iter_mut().zip(&axes) {
                let x = axis.dot(&offset);
                *end = [end[0].min(x), end[1].max(x)];
            }
        }
        let scale = (0..2).map(|k| FILLED * size[k] as f64 / (ends[k][1] - ends[k][0])).fold(f64::INFINITY, f64::min);
        let centre = (0..3).map(|k| axes[k] * (0.5 * (ends[k][0] + ends[k][1]))).sum::<Vector3<f64>>();
        let count = size[0] * size[1];
        Self {
            size,
            colours: vec![background; count],
            depths: vec![f32::NEG_INFINITY; count],
            axes,
            centre: origin.unwrap_or_default() + centre,
            scale: if scale.is_finite() { scale } else { 1.0 },
        }
    }

    /// Returns the position of a point: to the right, downwards, and towards the viewer, in samples.
    fn project(&self, point: &Point3<f64>) -> [f64; 3] {
        let offset = point - self.centre;
        let [x, y, z] = self.axes.map(|axis| axis.dot(&offset) * self.scale);
        [self.size[0] as f64 / 2.0 + x, self.size[1] as f64 / 2.0 - y, z]
    }

    /// Draws triangles. `colour` returns the colour of a triangle at the given weights of its vertices; shading
    /// darkens it.
    pub(super) fn triangles(&mut self, soup: &Soup<f64>, colour: impl Fn([u32; 3], [f64; 3]) -> [u8; 3]) {
        let light = Vector3::from(LIGHT).normalize();
        for triangle in soup.triangles() {
            let corners = triangle.map(|i| self.project(&soup.positions()[i as usize]));
            let [a, b, c] = corners;
            // In the picture y points down, so a triangle that faces the viewer turns clockwise.
            let normal = Vector3::from([
                (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]),
                (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]),
                (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]),
            ]);
            let area = normal.z;
            if !(area.abs() > 0.0 && area.is_finite()) {
                continue;
            }
            let facing = Vector3::new(normal.x, -normal.y, normal.z).normalize() * normal.z.signum();
            let shade = 0.55 + 0.45 * facing.dot(&light).max(0.0);
            let [columns, rows] = [0, 1].map(|k| {
                let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
                samples(low, high, self.size[k])
            });
            for row in rows {
                for column in columns.clone() {
                    let at = [column as f64 + 0.5, row as f64 + 0.5];
                    let weight = |p: [f64; 3], q: [f64; 3]| {
                        ((p[0] - at[0]) * (q[1] - at[1]) - (p[1] - at[1]) * (q[0] - at[0])) / area
                    };
                    let weights = [weight(b, c), weight(c, a), weight(a, b)];
                    if weights.iter().all(|w| *w >= 0.0) {
                        let depth = (0..3).map(|k| weights[k] * corners[k][2]).sum();
                        let paint = || colour(*triangle, weights).map(|x| shaded(x, shade));
                        self.put(row * self.size[0] + column, depth, paint);
                    }
                }
            }
        }
    }

    /// Draws points as squares of some pixels, which may be a fraction. Points that are not finite are left out.
    pub(super) fn points(&mut self, points: &[Point3<f64>], pixels: f64, colour: impl Fn(usize) -> [u8; 3]) {
        let (half, near) = (0.5 * pixels * SAMPLES as f64, IN_FRONT * self.size[0] as f64);
        for (i, point) in points.iter().enumerate() {
            let [x, y, depth] = self.project(point);
            if !(x.is_finite() && y.is_finite()) {
                continue;
            }
            for row in samples(y - half, y + half, self.size[1]) {
                for column in samples(x - half, x + half, self.size[0]) {
                    self.put(row * self.size[0] + column, depth + near, || colour(i));
                }
            }
        }
    }

    /// Colours a sample if nothing is nearer.
    #[allow(clippy::cast_possible_truncation, reason = "depths are compared to six digits")]
    fn put(&mut self, sample: usize, depth: f64, colour: impl FnOnce() -> [u8; 3]) {
        if depth as f32 > self.depths[sample] {
            self.depths[sample] = depth as f32;
            self.colours[sample] = colour();
        }
    }

    /// Returns the picture: each pixel is the mean of its samples.
    pub(super) fn finish(self) -> Picture {
        let [width, height] = self.size.map(|x| x / SAMPLES);
        let mut bytes = Vec::with_capacity(3 * width * height);
        for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
            for k in 0..3 {
                let samples = (0..SAMPLES * SAMPLES).map(|s| {
                    let at = (SAMPLES * row + s / SAMPLES) * self.size[0] + SAMPLES * column + s % SAMPLES;
                    usize::from(self.colours[at][k])
                });
                bytes.push(u8::try_from(samples.sum::<usize>() / (SAMPLES * SAMPLES)).unwrap_or(u8::MAX));
            }
        }
        Picture { size: [width, height], bytes }
    }
}

/// Returns the samples, of `count`, whose middles are between two positions.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the numbers are clamped first")]
fn samples(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
    let clamped = |x: f64| x.clamp(0.0, count as f64) as usize;
    clamped((low - 0.5).ceil())..clamped((high - 0.5).floor() + 1.0)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
fn shaded(x: u8, shade: f64) -> u8 {
    (f64::from(x) * shade) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: [Vector3<f64>; 3] =
        [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)];

    fn pixel(picture: &Picture, [x, y]: [usize; 2]) -> [u8; 3] {
        picture.bytes[3 * (y * picture.size[0] + x)..][..3].try_into().unwrap()
    }

    #[test]
    fn what_is_nearer_hides_what_is_farther() {
        // The right half of the square is covered by a triangle in front of it, which is drawn first.
        let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
        let front = [[2.0, -4.0, 1.0], [8.0, 2.0, 1.0], [2.0, 8.0, 1.0]];
        let positions: Vec<Point3<f64>> = front.iter().chain(&corners).map(|x| Point3::from(*x)).collect();
        let soup = Soup::from_triangles(positions, vec![[0, 1, 2], [3, 4, 5], [3, 5, 6]]).unwrap();
        let mut drawing = Drawing::new([40, 40], [9, 9, 9], soup.positions()[3..].iter(), AXES);
        drawing.triangles(&soup, |triangle, _| if triangle[0] == 0 { [200, 0, 0] } else { [0, 200, 0] });
        drawing.points(&[[1.0, 1.0, 0.0].into(), [3.0, 1.0, 0.5].into(), [f64::NAN; 3].into()], 3.0, |_| [0, 0, 200]);
        let picture = drawing.finish();
        let shade = shaded(200, 0.55 + 0.45 * Vector3::from(LIGHT).normalize().z);
        assert_eq!([pixel(&picture, [0, 0]), pixel(&picture, [10, 10])], [[9, 9, 9], [0, shade, 0]]);
        assert_eq!([pixel(&picture, [30, 10]), pixel(&picture, [30, 29])], [[shade, 0, 0]; 2]);
        // A point on the surface is in front of it, and one behind it is hidden.
        assert_eq!(pixel(&picture, [10, 29]), [0, 0, 200]);
    }

    #[test]
    fn shading_does_not_depend_on_the_orientation() {
        let positions: Vec<Point3<f64>> =
            [[0.0, 0.0, 0.0], [4.0, 0.0, 1.0], [0.0, 4.0, -2.0]].map(Point3::from).to_vec();
        let picture = |triangle| {
            let soup = Soup::from_triangles(positions.clone(), vec![triangle]).unwrap();
            let mut drawing = Drawing::new([20, 20], [0; 3], positions.iter(), AXES);
            drawing.triangles(&soup, |_, weights| weights.map(|w| shaded(200, w)));
            drawing.finish().bytes
        };
        let bytes = picture([0, 1, 2]);
        assert!(bytes.iter().any(|x| *x > 100));
        // The weights belong to the vertices in another order.
        let sum = |bytes: &[u8]| bytes.iter().map(|x| usize::from(*x)).sum::<usize>();
        assert!(sum(&bytes).abs_diff(sum(&picture([0, 2, 1]))) * 100 < sum(&bytes));
    }

    #[test]
    fn points_without_an_extent_have_a_picture() {
        for points in [&[][..], &[Point3::origin()], &[Point3::from([f64::NAN; 3]), Point3::origin()]] {
            let mut drawing = Drawing::new([4, 4], [7; 3], points.iter(), AXES);
            drawing.points(&[Point3::origin()], 2.0, |_| [0; 3]);
            assert_eq!(drawing.finish().bytes.len(), 48);
        }
    }
}
