//! The distance example of the k-DOP tree's manual: the closest point of a mesh to a point.
//!
//! `cargo run --release --example kdop_distance -- mesh.obj`

use nalgebra::Point3;
use p2m::{ClosestPoint, KdopTree};

/// The number of faces of the k-DOPs, where both signs of each direction count.
const FACES: usize = 14;

fn main() -> anyhow::Result<()> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "scenes/knot_and_cables.obj".to_owned());
    let scene = p2m::scene::read_scene(name.as_ref())?.soup;
    let tree = KdopTree::<f64, _, FACES>::new(&scene)?;
    let query = Point3::new(1.0 / 3.0, 2.0 / 3.0, 1.0 / 6.0);
    match tree.closest_point(&query) {
        Some(answer) => {
            println!("the point of {name} closest to {query} is {}", answer.point);
            println!("at a distance of {}, on primitive {}", answer.distance, answer.primitive);
        }
        None => println!("{name} is empty"),
    }
    Ok(())
}
