//! Draws a slice through the cells of an octree, coloured by the length of their lists.
//!
//! The picture is a PNG file. Cells are dark if one packet remains and bright if lists are long (logarithmically, white
//! from 64 packets on), blue if the tree answers, and red where the scene itself is within half a pixel. The slice is a
//! square about the middle of the scene's box, perpendicular to z. The last argument is its side in sizes of the scene.
//!
//! `cargo run --release --example octree_slice -- mesh.obj slice.png 1.5`

mod common;

use nalgebra::Point3;
use p2m::{ClosestPoint, OctreeIndex, PrimitiveSet};

/// The number of pixels on each side.
const PIXELS: u32 = 600;

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "scenes/knot_and_cables.obj".to_owned());
    let out = arguments.next().unwrap_or_else(|| "octree_slice.png".to_owned());
    let side: f64 = arguments.next().map_or(Ok(1.5), |side| side.parse())?;
    let scene = p2m::scene::read_scene(name.as_ref())?.soup;
    let index = OctreeIndex::new(&scene)?;
    println!("{}", index.report());
    let bounds = scene.aabb();
    let centre = nalgebra::center(&bounds.min, &bounds.max);
    let pixel = (bounds.max - bounds.min).max() * side / f64::from(PIXELS);
    let middle = f64::from(PIXELS) * 0.5;
    let mut colours = Vec::new();
    for row in 0..PIXELS {
        for column in 0..PIXELS {
            let x = centre.x + (f64::from(column) + 0.5 - middle) * pixel;
            let y = centre.y + (middle - f64::from(row) - 0.5) * pixel;
            let place = Point3::new(x, y, centre.z);
            let distance = index.closest_point(&place).map_or(f64::INFINITY, |closest| closest.distance);
            colours.extend(colour(index.partition().list_length(&place), distance < pixel * 0.5));
        }
    }
    common::write_png(&out, [PIXELS; 2], &colours)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "short lists")]
fn colour(length: Option<usize>, on_scene: bool) -> [u8; 3] {
    let Some(length) = length.filter(|_| !on_scene) else {
        return if on_scene { [200, 30, 30] } else { [60, 90, 200] };
    };
    let t = ((length as f64).log2() / 6.0).min(1.0);
    // Colours range from dark green over yellow to white.
    let mix = |dark: f64, middle: f64| {
        let x = if t < 0.5 { dark + (middle - dark) * 2.0 * t } else { middle + (255.0 - middle) * (2.0 * t - 1.0) };
        x as u8
    };
    [mix(10.0, 230.0), mix(60.0, 190.0), mix(50.0, 60.0)]
}
