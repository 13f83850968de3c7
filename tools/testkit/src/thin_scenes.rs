//! Pairs of small scenes of thin triangles that touch, cross or nearly touch.
//!
//! A filter that trusts the direction of a triangle's normal fails on these scenes, because rounding may turn the
//! normal of a thin triangle by any angle.

use crate::families::{triangle, unit};
use rand::{Rng, RngExt};

type V = [f64; 3];

/// Returns the vertices of the primitives of two scenes with one to three primitives each.
///
/// The first primitive of the first scene is a thin triangle. Its sine is between 1e-9 and 0.1, or its vertices are
/// collinear up to rounding. In most cases the other scene touches or crosses it: at a corner, on an edge, in its face,
/// or through its face; exactly, or up to rounding. Half of all scenes have coordinates of few decimals, as files of
/// CAD programs do.
pub fn thin_scenes(rng: &mut impl Rng) -> [Vec<Vec<V>>; 2] {
    let size = 10f64.powf(rng.random_range(-1.0..2.0));
    let decimals = rng.random_bool(0.5).then(|| 10f64.powi(rng.random_range(1..6)));
    let offset = if rng.random_range(0..4) == 0 { unit(rng).map(|x| x * 1e3) } else { [0.0; 3] };
    let rounded = |v: V| decimals.map_or(v, |per_unit| v.map(|x| (x * per_unit).round() / per_unit));
    let place = |v: V| rounded(std::array::from_fn(|k| v[k] * size + offset[k]));
    let thin = thin_triangle(rng).map(place);
    let touching = touching(rng, &thin, size, &rounded);
    let mut scenes = [vec![thin.to_vec()], vec![touching]];
    for scene in &mut scenes {
        for _ in 0..[0, 0, 1, 2][rng.random_range(0..4)] {
            let any = if rng.random_bool(0.5) { thin_triangle(rng) } else { triangle(rng, 1.0) };
            let count = rng.random_range(1..=3);
            scene.push(any[..count].iter().map(|v| place(*v)).collect());
        }
    }
    if rng.random_bool(0.5) {
        scenes.swap(0, 1);
    }
    scenes
}

/// Returns a triangle of size about one with a small sine.
fn thin_triangle(rng: &mut impl Rng) -> [V; 3] {
    let sine = if rng.random_range(0..4) == 0 { 0.0 } else { 10f64.powf(rng.random_range(-9.0..-1.0)) };
    let mut corners = triangle(rng, sine);
    if sine == 0.0 {
        // The corners are on a line through a random point, and each coordinate is rounded.
        let (start, along) = (unit(rng).map(|x| x * f64::from(rng.random_range(0..2))), unit(rng));
        let step = |rng: &mut dyn Rng| f64::from(rng.random_range(-10..=10)) * 0.1;
        corners = [(); 3].map(|()| {
            let t = step(rng);
            std::array::from_fn(|k| start[k] + t * along[k])
        });
    }
    corners.rotate_left(rng.random_range(0..3));
    corners
}

/// Returns a hull of one to three vertices that touches a triangle or comes close to it.
fn touching(rng: &mut impl Rng, thin: &[V; 3], size: f64, rounded: &dyn Fn(V) -> V) -> Vec<V> {
    let (i, t) = (rng.random_range(0..3), f64::from(rng.random_range(1..8)) * 0.125);
    let mix = |p: V, q: V, t: f64| -> V { std::array::from_fn(|k| p[k] * (1.0 - t) + q[k] * t) };
    let on_edge = mix(thin[i], thin[(i + 1) % 3], t);
    let contact = match rng.random_range(0..4) {
        0 | 1 => thin[i],
        2 => on_edge,
        _ => mix(on_edge, thin[(i + 2) % 3], 0.25),
    };
    let gap = if rng.random_range(0..3) == 0 { size * 10f64.powf(rng.random_range(-17.0..0.0)) } else { 0.0 };
    let aside = unit(rng);
    let contact = std::array::from_fn(|k| contact[k] + gap * aside[k]);
    let mut hull: Vec<V> = (0..rng.random_range(1..=3)).map(|_| unit(rng)).collect();
    hull.iter_mut().for_each(|v| *v = rounded(std::array::from_fn(|k| contact[k] + size * v[k])));
    match (rng.random_range(0..3), hull.len()) {
        // The contact is inside of an edge or of the face.
        (0, 2..) => hull[1] = mix(hull[0], contact, 2.0),
        (1, 3) => hull[2] = mix(mix(hull[0], hull[1], 0.5), contact, 2.0),
        _ => hull[0] = contact,
    }
    hull
}
