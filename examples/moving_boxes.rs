//! Moves boxes on circles around a post, and reports which one comes nearest to a sensor and which one a beam hits.
//!
//! `cargo run --release --example moving_boxes -- [BOXES] [STEPS]`. The defaults are 200 boxes and 90 steps.

use p2m::instances::{InstanceId, Instances};
use p2m::nalgebra::{Isometry3, Point3, Vector3};
use p2m::{AabbTree, ClosestPoint, Ray, RayQuery, Soup};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Returns an index over a box about the origin with these half edges.
fn cuboid(half: [f64; 3]) -> anyhow::Result<Arc<AabbTree<f64, Soup<f64>>>> {
    let corner = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 1 { half[k] } else { -half[k] });
    let positions: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let quads = [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Ok(Arc::new(AabbTree::new(Soup::from_arrays(&positions, &triangles)?)?))
}

/// Returns the place of box `i` of `count` at a time in turns of the innermost circle.
fn place(i: usize, count: usize, time: f64) -> Isometry3<f64> {
    let radius = 2.0 + 8.0 * i as f64 / count as f64;
    let angle = TAU * (time / radius + 0.618 * i as f64);
    let at = Vector3::new(radius * angle.cos(), radius * angle.sin(), (0.7 * i as f64).sin());
    Isometry3::new(at, Vector3::z() * angle)
}

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let count: usize = arguments.next().map_or(Ok(200), |text| text.parse())?;
    let steps: usize = arguments.next().map_or(Ok(90), |text| text.parse())?;
    let (small, post) = (cuboid([0.1, 0.15, 0.2])?, cuboid([0.3, 0.3, 3.0])?);

    // All boxes share one index.
    let mut scene = Instances::new();
    let mut edit = scene.edit();
    let post = edit.add("post", &post, Isometry3::identity())?;
    let names = (0..count).map(|i| format!("box {i}"));
    let boxes = names.enumerate().map(|(i, name)| edit.add(&name, &small, place(i, count, 0.0)));
    let boxes: Vec<InstanceId> = boxes.collect::<Result<_, _>>()?;
    drop(edit);

    let sensor = Point3::new(1.5, 0.0, 0.0);
    let beam = Ray::new(&Point3::new(12.0, 0.2, 0.1), &-Vector3::x())?;
    let (mut nearest, mut interruptions): (Option<(f64, String, usize)>, usize) = (None, 0);
    for step in 0..steps {
        let time = step as f64 / 30.0;
        let mut edit = scene.edit();
        for (i, id) in boxes.iter().enumerate() {
            edit.set_motion(*id, place(i, count, time))?;
        }
        // The tree of the scene follows all motions at once.
        drop(edit);
        let name = |primitive| {
            let instance = scene.instance_of(primitive).and_then(|(id, _)| scene.instance(id));
            instance.map_or_else(String::new, |instance| instance.name().to_owned())
        };
        if let Some(found) = scene.closest_point(&sensor)
            && nearest.as_ref().is_none_or(|(distance, ..)| found.distance < *distance)
        {
            nearest = Some((found.distance, name(found.primitive), step));
        }
        let hit = scene.first_intersection(&beam).and_then(|hit| scene.instance_of(hit.primitive));
        interruptions += usize::from(hit.is_some_and(|(id, _)| id != post));
    }
    if let Some((distance, name, step)) = nearest {
        println!("{name} comes nearest to the sensor: {distance:.6} in step {step}");
    }
    println!("boxes interrupt the beam to the post in {interruptions} of {steps} steps");
    Ok(())
}
