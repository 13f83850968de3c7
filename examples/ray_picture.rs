//! Draws a picture of a scene with rays: a pixel is the mean of the first hits of four rays from the eye.
//!
//! Triangles are shaded by their normals and by whether another ray from them reaches the light; back sides are blue.
//! Segments and points are a pixel or two thick. Surfaces far from the eye are paler.
//!
//! `cargo run --release --example ray_picture -- mesh.obj picture.png 800 1 0.5 0.3`, where the first number is the
//! width in pixels, and the others are the direction towards the eye.

mod common;

use anyhow::{Context, ensure};
use nalgebra::{Point3, Vector3};
use p2m::core::Side;
use p2m::{AabbTree, PrimitiveSet, Ray, RayQuery, Soup};
use rayon::prelude::*;

/// The default direction from the middle of the scene towards the eye; y is up.
const EYE: [f64; 3] = [0.45, 0.4, 1.0];
/// The direction towards the light: to the left in the picture, up, and towards the eye.
const LIGHT: [f64; 3] = [-0.4, 0.6, 0.9];
/// The number of rays of a pixel along each side.
const RAYS: u32 = 2;
/// The amount by which the far end of the scene is paler than the near one.
const FADING: f64 = 0.45;

const PAPER: [f64; 3] = [250.0, 250.0, 247.0];
const FRONT: [f64; 3] = [226.0, 205.0, 175.0];
const BACK: [f64; 3] = [130.0, 155.0, 205.0];
const WIRE: [f64; 3] = [45.0, 55.0, 80.0];

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "scenes/knot_and_cables.obj".to_owned());
    let out = arguments.next().unwrap_or_else(|| "ray_picture.png".to_owned());
    let width = arguments.next().unwrap_or_else(|| "800".to_owned());
    let width = width.parse().ok().filter(|width| (1..=10_000).contains(width));
    let width = width.context("the width is a whole number from 1 to 10000")?;
    let eye = arguments.map(|x| x.parse::<f64>().with_context(|| format!("'{x}' is not a number")));
    let eye: Vec<f64> = eye.collect::<anyhow::Result<_>>()?;
    let eye = if eye.is_empty() { EYE.to_vec() } else { eye };
    let scene = p2m::scene::read_scene(name.as_ref())?.soup;
    ensure!(!scene.is_empty(), "{name} is empty");
    let index = AabbTree::new(&scene)?;
    let towards = <[f64; 3]>::try_from(eye).ok().map(Vector3::from);
    let camera = towards.and_then(|towards| Camera::before(&scene, &towards, width));
    let camera =
        camera.context("the direction to the eye is three numbers, and not along y; the scene has an extent")?;
    let step = 1.0 / f64::from(RAYS);
    let pixel = |(row, column): (u32, u32)| {
        let mut sum = Vector3::zeros();
        for (i, j) in (0..RAYS).flat_map(|i| (0..RAYS).map(move |j| (i, j))) {
            let position =
                [f64::from(column) + (f64::from(i) + 0.5) * step, f64::from(row) + (f64::from(j) + 0.5) * step];
            sum += colour(&camera, &scene, &index, &camera.ray(position));
        }
        <[f64; 3]>::from(sum * step * step).map(byte)
    };
    let rows = (0..width).into_par_iter();
    let bytes: Vec<u8> = rows.flat_map_iter(|row| (0..width).flat_map(move |column| pixel((row, column)))).collect();
    common::write_png(&out, [width; 2], &bytes)
}

/// An eye, and a square picture of the whole scene in a plane through its centre, in which y is up.
struct Camera {
    eye: Point3<f64>,
    /// The upper left corner of the picture.
    corner: Point3<f64>,
    /// The directions to the right, upwards and towards the eye.
    axes: [Vector3<f64>; 3],
    /// The diagonal of the box of the scene, and the side of a pixel.
    diagonal: f64,
    pixel: f64,
}

impl Camera {
    fn before(scene: &Soup<f64>, towards: &Vector3<f64>, width: u32) -> Option<Self> {
        let bounds = scene.aabb();
        let diagonal = Some((bounds.max - bounds.min).norm()).filter(|diagonal| *diagonal > 0.0)?;
        let back = towards.try_normalize(0.0)?;
        let right = Vector3::y().cross(&back).try_normalize(0.0)?;
        let up = back.cross(&right);
        let centre = nalgebra::center(&bounds.min, &bounds.max);
        // Seen from the eye, the ball around the box is larger than its diagonal by a thirtieth.
        let side = 1.04 * diagonal;
        let corner = centre + (up - right) * (0.5 * side);
        let (eye, pixel) = (centre + back * (2.0 * diagonal), side / f64::from(width));
        Some(Self { eye, corner, axes: [right, up, back], diagonal, pixel })
    }

    /// Returns the ray through a point of the picture, in pixels from the upper left corner.
    fn ray(&self, [x, y]: [f64; 2]) -> Ray {
        let point = self.corner + (self.axes[0] * x - self.axes[1] * y) * self.pixel;
        let ray = Ray::through(&self.eye, &point).and_then(|ray| ray.with_radius(self.pixel * 0.75));
        ray.expect("the eye is not in the picture")
    }

    /// Returns the depth of a point behind the centre of the scene, in diagonals: from -0.5 to 0.5.
    fn depth(&self, point: &Point3<f64>) -> f64 {
        (self.eye - point).dot(&self.axes[2]) / self.diagonal - 2.0
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
fn byte(x: f64) -> u8 {
    x.round() as u8
}

/// Returns the colour that a ray sees.
fn colour(camera: &Camera, scene: &Soup<f64>, index: &impl RayQuery<f64>, ray: &Ray) -> Vector3<f64> {
    let paper = Vector3::from(PAPER);
    let Some(hit) = index.first_intersection(ray) else { return paper };
    let point = hit.point();
    let normal = match scene.get(hit.primitive).vertices() {
        [a, b, c] => (b - a).cross(&(c - a)).try_normalize(0.0),
        _ => None,
    };
    let seen = match (normal, hit.side) {
        (Some(normal), Side::Front) => Vector3::from(FRONT) * light(camera, index, &point, &normal),
        (Some(normal), Side::Back) => Vector3::from(BACK) * light(camera, index, &point, &-normal),
        _ => Vector3::from(WIRE),
    };
    seen.lerp(&paper, FADING * (camera.depth(&point) + 0.5).clamp(0.0, 1.0))
}

/// Returns the brightness of a surface.
fn light(camera: &Camera, index: &impl RayQuery<f64>, point: &Point3<f64>, normal: &Vector3<f64>) -> f64 {
    let to_light: Vector3<f64> = camera.axes.iter().zip(LIGHT).map(|(axis, x)| axis * x).sum();
    let cosine = normal.dot(&to_light.normalize());
    // The ray starts beside the surface, so that the surface does not shade itself.
    let start = point + normal * camera.pixel;
    let is_lit = cosine > 0.0 && Ray::new(&start, &to_light).is_ok_and(|ray| !index.do_intersect(&ray));
    0.22 + 0.3 * (0.5 + 0.5 * cosine) + if is_lit { 0.5 * cosine } else { 0.0 }
}
