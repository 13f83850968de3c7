//! Rays that are hard for kernels: through vertices and edges, along edges, in planes, from the surface, from afar.

use crate::vector;
use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, PrimitiveId, PrimitiveSet, Ray, Soup};
use rand::{Rng, RngExt};

type P = Point3<f64>;

/// The way in which a ray is aimed at a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// The ray leads from one point in ten times the box to another.
    Random,
    /// The ray leads from a point to a vertex.
    ToVertex,
    /// The ray leads from a vertex in any direction.
    FromVertex,
    /// The ray leads from a vertex, or from behind it, to another vertex.
    Vertices,
    /// The ray leads from a point to a point of an edge.
    ToEdge,
    /// The ray begins at a point of an edge, most often at its middle.
    FromEdge,
    /// The ray begins at a point of a face.
    FromFace,
    /// The ray leads to a point of a face.
    ToFace,
    /// The ray leads along an edge, from anywhere on its line.
    AlongEdge,
    /// The ray lies in the plane of a facet.
    InPlane,
    /// The ray leads along an axis or a diagonal through a vertex, exactly if the coordinates have enough bits.
    Axis,
    /// The ray leads from small integers to small integers.
    Lattice,
    /// The ray leads from next to a vertex to a point of an edge or a face there, almost in its plane.
    Graze,
    /// The ray begins 1e6, 1e12 or 1e300 sizes away.
    Far,
}

/// All ways of aiming.
pub const AIMS: [Aim; 14] = [
    Aim::Random,
    Aim::ToVertex,
    Aim::FromVertex,
    Aim::Vertices,
    Aim::ToEdge,
    Aim::FromEdge,
    Aim::FromFace,
    Aim::ToFace,
    Aim::AlongEdge,
    Aim::InPlane,
    Aim::Axis,
    Aim::Lattice,
    Aim::Graze,
    Aim::Far,
];

/// Returns three vertices of a random primitive. If it has fewer, the last one is repeated.
fn corners(rng: &mut impl Rng, soup: &Soup<f64>) -> [P; 3] {
    let primitive = soup.get(PrimitiveId::new(rng.random_range(0..soup.len())));
    let vertices = primitive.vertices();
    let turn = rng.random_range(0..3);
    std::array::from_fn(|k| vertices[(k + turn) % vertices.len()])
}

fn small(rng: &mut impl Rng) -> f64 {
    f64::from(rng.random_range(-3..=3))
}

/// Returns the origin and direction of a ray that is aimed at a scene, which is not empty. The direction may be zero.
fn aimed(rng: &mut impl Rng, soup: &Soup<f64>, bounds: &Aabb<f64>, aim: Aim) -> (P, Vector3<f64>) {
    let size = (bounds.max - bounds.min).amax().max(f64::MIN_POSITIVE);
    let [a, b, c] = corners(rng, soup);
    let start = bounds.min + (bounds.max - bounds.min) * 0.5 + vector(rng) * (5.0 * size);
    let weights: [f64; 2] = if rng.random() { [0.5, 0.25] } else { [rng.random(), 0.5 * rng.random::<f64>()] };
    let on_edge = a + (b - a) * weights[0];
    let on_face = a + (b - a) * (weights[0] * 0.5) + (c - a) * weights[1];
    match aim {
        Aim::Random => (start, vector(rng) * (5.0 * size)),
        Aim::ToVertex => (start, a - start),
        Aim::FromVertex => (a, vector(rng)),
        Aim::Vertices => {
            let [d, ..] = corners(rng, soup);
            (a - (d - a) * small(rng), d - a)
        }
        Aim::ToEdge => (start, on_edge - start),
        Aim::FromEdge => (on_edge, vector(rng)),
        Aim::FromFace => (on_face, vector(rng)),
        Aim::ToFace => (start, on_face - start),
        Aim::AlongEdge => (a + (b - a) * small(rng), (b - a) * if rng.random() { -1.0 } else { 2.0 }),
        Aim::InPlane => {
            let mut inside = || (b - a) * small(rng) + (c - a) * small(rng);
            (a + inside() * 0.5, inside())
        }
        Aim::Axis => {
            let direction = Vector3::from_fn(|_, _| f64::from(rng.random_range(-1..=1)));
            // Half of these rays lead along an axis.
            let axis = Vector3::ith(rng.random_range(0..3), if rng.random() { 1.0 } else { -1.0 });
            let direction = if rng.random() { direction } else { axis };
            let through = if rng.random() { a } else { on_edge };
            (through - direction * (size * small(rng)), direction)
        }
        Aim::Lattice => {
            let direction = Vector3::from_fn(|_, _| small(rng));
            (a.map(f64::round) + Vector3::from_fn(|_, _| small(rng)), direction)
        }
        Aim::Graze => {
            let origin = a + vector(rng) * (size * 2f64.powi(-rng.random_range(1..60)));
            (origin, if rng.random() { b + (c - b) * weights[0] } else { on_face } - origin)
        }
        Aim::Far => {
            let origin = a + vector(rng) * (size * [1e6, 1e12, 1e300][rng.random_range(0..3)]);
            (origin, a - origin)
        }
    }
}

/// Returns a finite number a few units in the last place beside another one.
fn beside(rng: &mut impl Rng, x: f64) -> f64 {
    match rng.random_range(0..3) {
        0 => x.next_up(),
        1 => x.next_down(),
        _ => x,
    }
}

/// Generates a ray, half line, line or segment that is aimed at a scene with these bounds, which is not empty. In a
/// third of the cases its coordinates are off by a unit in the last place.
pub fn ray(rng: &mut impl Rng, soup: &Soup<f64>, bounds: &Aabb<f64>, aim: Aim) -> Ray {
    let (mut origin, mut direction) = aimed(rng, soup, bounds, aim);
    if rng.random_range(0..3) == 0 {
        origin = origin.map(|x| beside(rng, x));
        if rng.random() {
            direction = direction.map(|x| beside(rng, x));
        }
    }
    // A direction of length zero, or a point too far away, is replaced by a random one.
    let anywhere = vector(rng);
    let ray = Ray::new(&origin, &direction).or_else(|_| Ray::new(&corners(rng, soup)[0], &anywhere)).expect("finite");
    match rng.random_range(0..4) {
        0 => ray,
        1 => ray.with_range(0.0, 1.0).expect("in order"),
        _ => ray.line(),
    }
}
