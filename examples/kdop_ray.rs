//! The ray example of the k-DOP tree's manual: the first hit of a ray with a mesh.
//!
//! `cargo run --release --example kdop_ray -- mesh.obj`

use nalgebra::Point3;
use p2m::{KdopTree, Ray, RayQuery};

/// The number of faces of the k-DOPs, where both signs of each direction count.
const FACES: usize = 14;

fn main() -> anyhow::Result<()> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "scenes/knot_and_cables.obj".to_owned());
    let scene = p2m::scene::read_scene(name.as_ref())?.soup;
    let tree = KdopTree::<f64, _, FACES>::new(&scene)?;
    let ray = Ray::through(&Point3::new(1.0, 1.0, 1.0), &Point3::new(1.0 / 3.0, 1.0 / 6.0, 2.0 / 3.0))?;
    match tree.first_intersection(&ray) {
        Some(hit) => println!("{}", hit.point()),
        None => println!("No intersection"),
    }
    Ok(())
}
