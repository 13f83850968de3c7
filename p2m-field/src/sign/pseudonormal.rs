//! Signs of closed surfaces: by pseudonormals, and by rays where these are in doubt.
//!
//! The normal of a face, the sum of the unit normals of two faces at their edge, and that of the faces around a vertex, each
//! times its angle there, have a positive product with the way from the closest point to a query if and only if that is
//! outside \[Baerentzen2005, Theorem 1\]. In doubt are products near zero, normals of slivers, edges of more than two
//! triangles and vertices between several fans; then the crossings of a ray are counted, without rounding.
//!
//! Each part of the surface, which hangs together along edges, is asked once on which side of it rays say that inside is. So the
//! two ways say the same for surfaces that are inside out, and for parts inside of others.

use super::topology::{NONE, Topology};
use super::{Sign, SignError};
use nalgebra::{Point3, Vector3};
use p2m_bvh::TreeIndex;
use p2m_core::{Aabb, BuildIndex, Closest, ClosestPoint, Feature, PrimitiveSet, Ray, RayQuery, Soup};
use p2m_mixed::engine::vector::{V3, add, cross, dot, largest, length, scaled, sub};
use std::sync::atomic::{AtomicU64, Ordering};

/// A product of unit vectors below this is in doubt, and so is a normal whose triangle has a sine below it: 2^-20.
const DOUBT: f64 = 1.0 / (1 << 20) as f64;
/// A product is in doubt below this part of the offset: 2^-26. A normal of a sine of 2^-20 is wrong by 12 * 2^-53 / 2^-20 < 2^-29, the
/// sum of two by 2^-28.
const ROUNDING: f64 = 1.0 / (1 << 26) as f64;
/// Where rays go: along nothing that scenes have edges or faces along.
const DIRECTION: [f64; 3] = [0.539_217, 0.283_165, 0.793_121];

/// What is asked for rays.
pub(super) type Rays<'a> = TreeIndex<f64, &'a Soup<f64>, Aabb<f64>>;

/// What pseudonormals are computed from.
pub(crate) struct Pseudonormals<'a> {
    soup: &'a Soup<f64>,
    neighbours: Vec<[u32; 3]>,
    /// The place of each position, and for each place the sum of the normals around it; zero where that is in doubt.
    places: Vec<u32>,
    normals: Vec<V3>,
    /// For each triangle whether the front is outside.
    fronts: Vec<Front>,
    rays: Rays<'a>,
    bounds: Aabb<f64>,
    doubts: AtomicU64,
}

/// Where the front of a triangle is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Front {
    Outside,
    Inside,
    Unknown,
}

impl<'a> Pseudonormals<'a> {
    pub(super) fn new(soup: &'a Soup<f64>, index: &impl ClosestPoint<f64>) -> Result<Self, SignError> {
        let Topology { places, neighbours, parts, is_fan } = Topology::new(soup)?;
        let rays = TreeIndex::build(soup, &Default::default())?;
        let mut normals = vec![[0.0; 3]; places.len];
        let mut is_certain = is_fan;
        for triangle in soup.triangles() {
            let corners = corners(soup, *triangle);
            let normal = unit_normal(corners);
            for (i, place) in places.of(*triangle).into_iter().enumerate() {
                match normal {
                    Some(normal) => {
                        let sum = &mut normals[place as usize];
                        *sum = add(*sum, scaled(normal, angle(corners, i)));
                    }
                    None => is_certain[place as usize] = false,
                }
            }
        }
        for (normal, _) in normals.iter_mut().zip(is_certain).filter(|(_, is_certain)| !is_certain) {
            *normal = [0.0; 3];
        }
        let fronts = vec![Front::Unknown; soup.triangles().len()];
        let doubts = AtomicU64::new(0);
        let bounds = soup.aabb();
        let mut normals = Self { soup, neighbours, places: places.of, normals, fronts, rays, bounds, doubts };
        normals.find_fronts(&parts, index);
        Ok(normals)
    }

    /// Asks on both sides of the largest triangle of each part, nearer and nearer until that is the closest one.
    fn find_fronts(&mut self, parts: &[u32], index: &impl ClosestPoint<f64>) {
        let mut of_parts = vec![(0.0, NONE); parts.len()];
        for (t, (triangle, part)) in self.soup.triangles().iter().zip(parts).enumerate() {
            let corners = corners(self.soup, *triangle);
            let edges = [sub(corners[1], corners[0]), sub(corners[2], corners[0])];
            let unit = 1.0 / largest(&edges);
            let size = length(cross(scaled(edges[0], unit), scaled(edges[1], unit))).sqrt() / unit;
            let best = &mut of_parts[*part as usize];
            if unit_normal(corners).is_some() && size.is_finite() && size > best.0 {
                *best = (size, u32::try_from(t).unwrap_or(NONE));
            }
        }
        let fronts: Vec<Front> = of_parts.iter().map(|(size, t)| self.front(*size, *t, parts, index)).collect();
        self.fronts = parts.iter().map(|part| fronts[*part as usize]).collect();
    }

    fn front(&self, size: f64, triangle: u32, parts: &[u32], index: &impl ClosestPoint<f64>) -> Front {
        let Some(corner_numbers) = self.soup.triangles().get(triangle as usize) else { return Front::Unknown };
        let corners = corners(self.soup, *corner_numbers);
        let Some(normal) = unit_normal(corners) else { return Front::Unknown };
        let centre = corners.iter().fold([0.0; 3], |sum, corner| add(sum, scaled(*corner, 1.0 / 3.0)));
        // Whether rays say that a place at some height is inside, if its closest point tells that it is on this side.
        let is_inside = |height: f64| {
            let beside = Point3::from(add(centre, scaled(normal, height)));
            let closest = index.closest_point(&beside)?;
            let is_this_part = parts[closest.primitive.index()] == parts[triangle as usize];
            (is_this_part && self.is_in_front(&beside, &closest)? == (height > 0.0)).then(|| self.is_inside(&beside))
        };
        let mut height = size / 16.0;
        for _ in 0..20 {
            match (is_inside(height), is_inside(-height)) {
                (Some(false), Some(true)) => return Front::Outside,
                (Some(true), Some(false)) => return Front::Inside,
                // A sheet that is there twice, or another one in between.
                _ => height /= 4.0,
            }
        }
        Front::Unknown
    }

    /// The sign of a query that is not on the surface, by its closest point.
    pub(super) fn sign(&self, query: &Point3<f64>, closest: &Closest<f64>) -> Sign {
        if (0..3).any(|k| query[k] < self.bounds.min[k] || query[k] > self.bounds.max[k]) {
            return Sign::Outside;
        }
        let is_outside = match (self.fronts[closest.primitive.index()], self.is_in_front(query, closest)) {
            (Front::Outside, Some(is_in_front)) => is_in_front,
            (Front::Inside, Some(is_in_front)) => !is_in_front,
            _ => {
                self.doubts.fetch_add(1, Ordering::Relaxed);
                if closest.lower_bound <= 0.0 && self.is_on_surface(query) {
                    return Sign::Boundary;
                }
                !self.is_inside(query)
            }
        };
        if is_outside { Sign::Outside } else { Sign::Inside }
    }

    pub(super) fn doubts(&self) -> u64 {
        self.doubts.load(Ordering::Relaxed)
    }

    /// Whether the query is on the front side of where its closest point is; `None` in doubt.
    fn is_in_front(&self, query: &Point3<f64>, closest: &Closest<f64>) -> Option<bool> {
        let triangle = closest.primitive.index();
        let numbers = self.soup.triangles()[triangle];
        let corners = corners(self.soup, numbers);
        let normal = match closest.feature {
            Feature::Face => unit_normal(corners)?,
            Feature::Edge(i) => {
                let neighbour = self.neighbours[triangle][usize::from(i)];
                let neighbour = self.soup.triangles().get(neighbour as usize)?;
                add(unit_normal(corners)?, unit_normal(self::corners(self.soup, *neighbour))?)
            }
            Feature::Vertex(i) => self.normals[self.places[numbers[usize::from(i)] as usize] as usize],
        };
        // All three are orthogonal to what the closest point may slide along, so any vertex of that will do.
        let vertex = match closest.feature {
            Feature::Face => 0,
            Feature::Edge(i) | Feature::Vertex(i) => usize::from(i),
        };
        let query = (*query).into();
        let offset = sub(query, corners[vertex]);
        let product = dot(offset, normal);
        let least = (DOUBT * closest.distance).max(ROUNDING * length(offset)).max(f64::MIN_POSITIVE);
        (product.abs() >= least && product.is_finite()).then_some(product > 0.0)
    }

    /// Whether the query is on a triangle, without rounding.
    fn is_on_surface(&self, query: &Point3<f64>) -> bool {
        let here = ray(query).with_range(0.0, 0.0).expect("it has one parameter");
        self.rays.do_intersect(&here)
    }

    /// Whether a ray crosses the surface an odd number of times.
    fn is_inside(&self, query: &Point3<f64>) -> bool {
        self.rays.crossings(&ray(query)) % 2 == 1
    }
}

/// From a query to where nothing is in particular.
fn ray(query: &Point3<f64>) -> Ray {
    Ray::new(query, &Vector3::from(DIRECTION)).expect("the query is finite, since it has a closest point")
}

fn corners(soup: &Soup<f64>, triangle: [u32; 3]) -> [V3; 3] {
    triangle.map(|i| soup.positions()[i as usize].into())
}

/// The normal of a triangle; `None` of one that is a sliver, or out of range.
fn unit_normal(corners: [V3; 3]) -> Option<V3> {
    let edges = [sub(corners[1], corners[0]), sub(corners[2], corners[0])];
    let size = largest(&edges);
    let [e, f] = edges.map(|edge| edge.map(|x| x / size));
    let normal = cross(e, f);
    let length = length(normal);
    // Not for NaN either.
    (size > 0.0 && size.is_finite() && length >= DOUBT).then(|| normal.map(|x| x / length))
}

/// The angle of a triangle that is no sliver at one of its corners.
fn angle(corners: [V3; 3], i: usize) -> f64 {
    let to = |k: usize| {
        let edge = sub(corners[(i + k) % 3], corners[i]);
        let size = largest(&[edge]);
        edge.map(|x| x / size)
    };
    let (e, f) = (to(1), to(2));
    length(cross(e, f)).atan2(dot(e, f))
}
