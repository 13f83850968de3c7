//! Computes the Hausdorff distance between two scenes, between certified bounds.
//!
//! `cargo run --release --example hausdorff -- [A] [B] [TOLERANCE]`. The tolerance is a part of the diagonal of both
//! scenes, by default 0.0001. Without files the scenes are two spheres of triangles, one of which is moved by (0.3, 0,
//! 0.4): the distance of a convex surface from its translated copy is the length of the translation, 0.5.

use anyhow::Context;
use nalgebra::Vector3;
use p2m::field::{HausdorffOptions, hausdorff_distance};
use p2m::scene::generate::{IcoSphere, ico_sphere};
use p2m::{AabbTree, PrimitiveSet, Soup};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let scene = |name: &String| anyhow::Ok(p2m::scene::read_scene(name.as_ref())?.soup);
    let [a, b]: [Arc<Soup<f64>>; 2] = match &arguments[..] {
        [a, b, ..] => [scene(a)?, scene(b)?],
        _ => {
            let sphere = ico_sphere(&IcoSphere { frequency: 20 })?;
            let mut moved = sphere.clone();
            moved.map_positions(|p| p + Vector3::new(0.3, 0.0, 0.4))?;
            [sphere.into(), moved.into()]
        }
    };
    let part: f64 = arguments.get(2).map_or(Ok(1e-4), |text| text.parse())?;
    let start = Instant::now();
    let indexes = [AabbTree::new(&*a)?, AabbTree::new(&*b)?];
    let build = start.elapsed();
    let bounds = a.aabb().union(&b.aabb());
    let options = HausdorffOptions::new(part * (bounds.max - bounds.min).norm());
    let mut go_on = |_: &_| ControlFlow::Continue(());
    let found = hausdorff_distance((&*a, &indexes[0]), (&*b, &indexes[1]), &options, &mut go_on)?;
    let found = found.context("a scene is empty")?;
    println!("at least {} and at most {}, {:?}", found.lower_bound, found.upper_bound, found.direction);
    println!("from {} to {}", found.points[0], found.points[1]);
    println!("{} queries; {build:.2?} for the indexes, {:.2?} in all", found.queries, start.elapsed());
    Ok(())
}
