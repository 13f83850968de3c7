//! Computes the clearance between cables or pipes and a mesh: for each segment the distance of its axis from the
//! triangles, minus the radius of the pipe.
//!
//! `cargo run --release --example clearance -- [SCENE] [RADIUS]`. The triangles of the scene are the mesh and its
//! segments are the pipes. The defaults are a scene of the repository and pipes of radius 0.02.

use nalgebra::Point3;
use p2m::pair::{PairOptions, PairQuery};
use p2m::{AabbTree, Segment};

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "scenes/knot_and_cables.obj".to_owned());
    let radius: f64 = arguments.next().map_or(Ok(0.02), |text| text.parse())?;
    let scene = p2m::scene::read_scene(name.as_ref())?.soup;
    // The index has the mesh alone, borrowed from the scene of mesh and pipes.
    let index = AabbTree::new(scene.triangle_set())?;

    let pipes = scene.segments().iter().map(|ends| ends.map(|i| scene.positions()[i as usize]));
    let nearest = |[a, b]: [Point3<f64>; 2]| index.closest_to(&Segment::new(a, b), &PairOptions::default());
    let found: Vec<_> = pipes.filter_map(nearest).enumerate().collect();
    let Some((tightest, least)) = found.iter().min_by(|a, b| a.1.distance.total_cmp(&b.1.distance)) else {
        println!("{name} has no mesh or no pipes");
        return Ok(());
    };
    println!("{} pipes beside {} triangles", found.len(), scene.triangles().len());
    println!("the least clearance is {:.6}, of pipe {tightest}, at {}", least.distance - radius, least.points[0]);
    let touching = found.iter().filter(|(_, pair)| pair.distance <= radius).count();
    println!("{touching} pipes touch the mesh");
    Ok(())
}
