//! Computes the Hausdorff distance between the surfaces of two scenes: the largest distance of a point of one from the
//! other, in both directions, to a tolerance.
//!
//! `cargo run --release --example hausdorff -- [A] [B]`. Only triangles count. Without files the scenes are two spheres
//! of triangles, one of which is moved by (0.3, 0, 0.4): the distance of a convex surface from its translated copy is
//! the length of the translation, 0.5.
//!
//! A distance changes by at most as much as its query point moves. So on a triangle it is at most the distance of a
//! vertex plus the longest side from there. The triangle with the largest bound is cut until the bound is within the
//! tolerance.

use anyhow::Context;
use nalgebra::{Point3, Vector3};
use p2m::scene::generate::{IcoSphere, ico_sphere};
use p2m::{AabbTree, BuildIndex, ClosestPoint, Element, PrimitiveSet, Soup};
use std::collections::BinaryHeap;

const TOLERANCE: f64 = 1e-3;

/// A point of one scene with its distance from the other.
type Corner = (Point3<f64>, f64);

/// Returns an upper bound on the distances of all points of the triangle.
fn bound(corners: &[Corner; 3]) -> f64 {
    let longest = |from: &Corner| corners.iter().map(|to| (to.0 - from.0).norm()).fold(0.0, f64::max);
    corners.iter().map(|corner| corner.1 + longest(corner)).fold(f64::INFINITY, f64::min)
}

/// Returns the largest distance of a point of the surface from the indexed scene. The true value is larger by at
/// most the tolerance.
fn directed<I: ClosestPoint<f64>>(surface: &Soup<f64>, index: &I, tolerance: f64) -> Option<f64> {
    let at = |p: Point3<f64>| index.closest_point(&p).map(|answer| (p, answer.distance));
    let mut parts: Vec<[Corner; 3]> = Vec::new();
    for triangle in surface.triangles() {
        let [a, b, c] = triangle.map(|i| at(surface.positions()[i as usize]));
        parts.push([a?, b?, c?]);
    }
    // The queue has numbers of parts, with the largest bound on top. Bits of numbers that are not negative have their
    // order.
    let mut next: BinaryHeap<(u64, usize)> = (0..).zip(&parts).map(|(i, part)| (bound(part).to_bits(), i)).collect();
    let mut greatest = parts.iter().flatten().map(|corner| corner.1).fold(0.0, f64::max);
    while let Some((bits, number)) = next.pop() {
        if f64::from_bits(bits) <= greatest + tolerance {
            break;
        }
        let [a, b, c] = parts[number];
        let middle = |p: Corner, q: Corner| at(nalgebra::center(&p.0, &q.0));
        let (ab, bc, ca) = (middle(a, b)?, middle(b, c)?, middle(c, a)?);
        greatest = [ab, bc, ca].iter().map(|m| m.1).fold(greatest, f64::max);
        for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            next.push((bound(&part).to_bits(), parts.len()));
            parts.push(part);
        }
    }
    Some(greatest)
}

fn main() -> anyhow::Result<()> {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let surface = |name: &String| -> anyhow::Result<Soup<f64>> {
        let scene = p2m::scene::read_scene(name.as_ref())?.soup;
        anyhow::ensure!(!scene.triangles().is_empty(), "{name} has no triangles");
        Ok(Soup::new(scene.positions().to_vec(), scene.triangles().iter().map(|t| Element::Triangle(*t)))?)
    };
    let [a, b] = if let [a, b] = &names[..] {
        [surface(a)?, surface(b)?]
    } else {
        anyhow::ensure!(names.is_empty(), "two scenes, or none");
        let sphere = ico_sphere(&IcoSphere { frequency: 20 })?;
        let moved = sphere.positions().iter().map(|p| p + Vector3::new(0.3, 0.0, 0.4)).collect();
        let other = Soup::new(moved, sphere.elements())?;
        [sphere, other]
    };
    let indexes = [AabbTree::build(&a, &Default::default())?, AabbTree::build(&b, &Default::default())?];
    let bounds = a.aabb().union(&b.aabb());
    // The tolerance is at least the resolution of the coordinates.
    let largest = bounds.min.coords.amax().max(bounds.max.coords.amax());
    let tolerance = TOLERANCE * (bounds.max - bounds.min).norm() + 1e-12 * largest;
    let there = directed(&a, &indexes[1], tolerance).context("the second is empty")?;
    let back = directed(&b, &indexes[0], tolerance).context("the first is empty")?;
    println!("from the first to the second {there:.4}, back {back:.4}");
    println!("the Hausdorff distance is {:.4}, and at most {tolerance:.4} more", there.max(back));
    Ok(())
}
