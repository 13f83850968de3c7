//! Shrink-wraps a cloud of points onto a scene: each point moves to the closest point of the scene.
//!
//! `cargo run --release --example shrink_wrap -- [SCENE] [WRAP.ply]`. The default is a scene of the repository and no
//! file. The cloud is a sphere of points around the scene, and brute force checks that the results are on the scene.

use anyhow::Context;
use nalgebra::Point3;
use p2m::scene::generate::{IcoSphere, ico_sphere};
use p2m::{BruteForce, Closest, ClosestPoint, OctreeIndex, QueryOptions, Soup};

/// Wraps with any index; the function is compiled for the index that it is called with.
fn wrap<I: ClosestPoint<f64>>(index: &I, cloud: &[Point3<f64>]) -> Option<Vec<Closest<f64>>> {
    let mut answers = vec![None; cloud.len()];
    index.closest_points_into(cloud, &QueryOptions::default(), &mut answers);
    answers.into_iter().collect()
}

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "scenes/knot_and_cables.obj".to_owned());
    let scene = p2m::scene::read_scene(name.as_ref())?.soup;
    let index = OctreeIndex::new(&scene)?;

    let bounds = p2m::PrimitiveSet::aabb(&scene);
    let (centre, radius) = (nalgebra::center(&bounds.min, &bounds.max), (bounds.max - bounds.min).norm() * 0.6);
    let sphere = ico_sphere(&IcoSphere { frequency: 10 })?;
    let cloud: Vec<Point3<f64>> = sphere.positions().iter().map(|p| centre + p.coords * radius).collect();
    let answers = wrap(&index, &cloud).context("the scene is empty")?;

    let moves = || answers.iter().map(|answer| answer.distance);
    println!(
        "{} points moved by {:.6} to {:.6}",
        cloud.len(),
        moves().fold(f64::MAX, f64::min),
        moves().fold(0.0, f64::max)
    );
    println!("{:.6} on average", moves().sum::<f64>() / cloud.len() as f64);
    let brute = BruteForce::new(&scene)?;
    let wrapped: Vec<Point3<f64>> = answers.iter().map(|answer| answer.point).collect();
    let left = wrapped.iter().filter_map(|p| brute.closest_point(p)).map(|c| c.distance).fold(0.0, f64::max);
    let size = radius + centre.coords.amax();
    println!("on the scene up to rounding: {}", left <= 1e-12 * size);
    if let Some(out) = arguments.next() {
        let wrap = Soup::new(wrapped, sphere.elements())?;
        p2m::scene::write_ply(&wrap.into(), std::io::BufWriter::new(std::fs::File::create(&out)?))?;
        println!("{out}");
    }
    Ok(())
}
