//! Signs of closed surfaces by pseudonormals, and by rays where the pseudonormal is ambiguous.
//!
//! The pseudonormal at a point of the surface is the normal of its face, the sum of the unit normals of the two faces
//! at its edge, or the sum of the unit normals of the faces around its vertex, each multiplied by its angle there. The
//! offset of a query from its closest point has a positive dot product with the pseudonormal at that point if and only
//! if the query is outside \[Baerentzen2005, Theorem 1\].
//!
//! A sign is ambiguous if the dot product is near zero, a face is a sliver, an edge has more than two triangles, or the
//! triangles around a vertex form several fans. Then the exact number of crossings of a ray decides.
//!
//! Rays also decide, once for each component of the surface, which side of it is inside. So pseudonormals and rays
//! agree on surfaces that are inside out, and on components inside of others.

use super::topology::{NO_TRIANGLE, RayTree, Topology};
use super::types::{ClosestFeature, Counter, SharedSoup, Sign, SignError};
use nalgebra::{Point3, Vector3};
use p2m_bvh::TreeIndex;
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::vector::{V3, add, dot, largest, length, scaled, sub};
use p2m_core::{Aabb, ClosestPoint, Feature, Ray, RayQuery, Real, Soup};

/// The smallest sine that is not ambiguous: 2^-20. The limit applies to the angle between the offset and the tangent
/// plane, and to the angle of a triangle at its first vertex.
const MIN_SINE: f64 = 1.0 / (1 << 20) as f64;
/// The smallest dot product that is not ambiguous, as a fraction of the offset from the vertex: 2^-26. The normal of a
/// triangle with a sine of 2^-20 has an error of 12 * 2^-53 / 2^-20 < 2^-29, and the sum of two one of 2^-28.
const MIN_PRODUCT_PER_OFFSET: f64 = 1.0 / (1 << 26) as f64;
/// The direction of rays, which is parallel to no edge or face that scenes usually have.
const RAY_DIRECTION: [f64; 3] = [0.539_217, 0.283_165, 0.793_121];

/// The pseudonormals of a closed surface, and the tree in which rays are cast.
#[derive(Clone)]
pub(crate) struct Pseudonormals<S> {
    soup: S,
    /// The triangle beyond each edge, or [`NO_TRIANGLE`].
    neighbours: Vec<[u32; 3]>,
    /// The vertex id of each position.
    vertex_ids: Vec<u32>,
    /// The pseudonormal of each vertex, or zero if it is ambiguous.
    vertex_normals: Vec<V3>,
    /// The side of the surface that the front of each triangle is on.
    fronts: Vec<Front>,
    rays: RayTree<S>,
    bounds: Aabb<f64>,
    ambiguous_count: Counter,
}

/// The side of the surface that the front of a triangle is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Front {
    Outside,
    Inside,
    Unknown,
}

impl<S: SharedSoup> Pseudonormals<S> {
    pub(super) fn new<T: Real>(soup: S, index: &impl ClosestPoint<T>) -> Result<Self, SignError> {
        let Topology { welder, neighbours, components, is_fan } = Topology::new(&soup)?;
        let rays = TreeIndex::new(soup.clone())?;
        let mut vertex_normals = vec![[0.0; 3]; welder.vertex_count];
        let mut is_unambiguous = is_fan;
        for triangle in soup.triangles() {
            let corners = corners(&soup, *triangle);
            let normal = unit_normal(corners);
            for (i, vertex) in welder.weld(*triangle).into_iter().enumerate() {
                match normal {
                    Some(normal) => {
                        let sum = &mut vertex_normals[vertex as usize];
                        *sum = add(*sum, scaled(normal, angle(corners, i)));
                    }
                    None => is_unambiguous[vertex as usize] = false,
                }
            }
        }
        for (normal, _) in vertex_normals.iter_mut().zip(is_unambiguous).filter(|(_, is_unambiguous)| !is_unambiguous) {
            *normal = [0.0; 3];
        }
        let fronts = vec![Front::Unknown; soup.triangles().len()];
        let ambiguous_count = Counter::default();
        let bounds = soup.aabb();
        let vertex_ids = welder.vertex_ids;
        let mut normals = Self { soup, neighbours, vertex_ids, vertex_normals, fronts, rays, bounds, ambiguous_count };
        normals.find_fronts(&components, index);
        Ok(normals)
    }

    /// Determines the front of each component by its largest triangle. `components` has the component of each triangle.
    fn find_fronts<T: Real>(&mut self, components: &[u32], index: &impl ClosestPoint<T>) {
        let mut largest_triangles = vec![(0.0, NO_TRIANGLE); components.len()];
        for (t, (triangle, component)) in self.soup.triangles().iter().zip(components).enumerate() {
            let corners = corners(&self.soup, *triangle);
            let edges = [sub(corners[1], corners[0]), sub(corners[2], corners[0])];
            let unit = 1.0 / largest(&edges);
            let size = length(cross(scaled(edges[0], unit), scaled(edges[1], unit))).sqrt() / unit;
            let best = &mut largest_triangles[*component as usize];
            if unit_normal(corners).is_some() && size.is_finite() && size > best.0 {
                *best = (size, u32::try_from(t).unwrap_or(NO_TRIANGLE));
            }
        }
        let fronts: Vec<Front> =
            largest_triangles.iter().map(|(size, t)| self.front(*size, *t, components, index)).collect();
        self.fronts = components.iter().map(|component| fronts[*component as usize]).collect();
    }

    /// Determines the front of a triangle by points on both sides of it, whose heights decrease until the component of
    /// the triangle is closest to them.
    fn front<T: Real>(&self, size: f64, triangle: u32, components: &[u32], index: &impl ClosestPoint<T>) -> Front {
        let Some(corner_numbers) = self.soup.triangles().get(triangle as usize) else { return Front::Unknown };
        let corners = corners(&self.soup, *corner_numbers);
        let Some(normal) = unit_normal(corners) else { return Front::Unknown };
        let centre = corners.iter().fold([0.0; 3], |sum, corner| add(sum, scaled(*corner, 1.0 / 3.0)));
        // Returns whether a ray finds the point at some height above the triangle inside, or `None` unless the closest
        // point confirms on which side of the component the point is.
        let is_inside = |height: f64| {
            let query = Point3::from(add(centre, scaled(normal, height))).map(T::round_from_f64);
            let (point, closest) = (query.map(Real::to_f64), index.closest_point(&query)?);
            let is_same_component = components.get(closest.primitive.index()) == components.get(triangle as usize);
            (is_same_component && self.is_in_front(&point, &ClosestFeature::from(&closest))? == (height > 0.0))
                .then(|| self.is_inside(&point))
        };
        let mut height = size / 16.0;
        for _ in 0..20 {
            match (is_inside(height), is_inside(-height)) {
                (Some(false), Some(true)) => return Front::Outside,
                (Some(true), Some(false)) => return Front::Inside,
                // The triangle is duplicated, or another sheet is in between.
                _ => height /= 4.0,
            }
        }
        Front::Unknown
    }

    /// Returns the sign of a query by its closest point, whose distance is not 0.
    pub(super) fn sign(&self, query: &Point3<f64>, closest: &ClosestFeature) -> Sign {
        if (0..3).any(|k| query[k] < self.bounds.min[k] || query[k] > self.bounds.max[k]) {
            return Sign::Outside;
        }
        let is_outside = match (self.fronts[closest.primitive.index()], self.is_in_front(query, closest)) {
            (Front::Outside, Some(is_in_front)) => is_in_front,
            (Front::Inside, Some(is_in_front)) => !is_in_front,
            _ => {
                self.ambiguous_count.increment();
                if closest.lower_bound <= 0.0 && self.is_on_surface(query) {
                    return Sign::Boundary;
                }
                !self.is_inside(query)
            }
        };
        if is_outside { Sign::Outside } else { Sign::Inside }
    }

    pub(super) fn ambiguous_count(&self) -> u64 {
        self.ambiguous_count.get()
    }

    /// Returns whether the query is in front of the surface at its closest point, or `None` if that is ambiguous.
    fn is_in_front(&self, query: &Point3<f64>, closest: &ClosestFeature) -> Option<bool> {
        let triangle = closest.primitive.index();
        let numbers = self.soup.triangles()[triangle];
        let corners = corners(&self.soup, numbers);
        let normal = match closest.feature {
            Feature::Face => unit_normal(corners)?,
            Feature::Edge(i) => {
                let neighbour = self.neighbours[triangle][usize::from(i)];
                let neighbour = self.soup.triangles().get(neighbour as usize)?;
                add(unit_normal(corners)?, unit_normal(self::corners(&self.soup, *neighbour))?)
            }
            Feature::Vertex(i) => self.vertex_normals[self.vertex_ids[numbers[usize::from(i)] as usize] as usize],
        };
        // The pseudonormal is orthogonal to the feature, so the offset from any vertex of the feature has the same dot
        // product as the offset from the closest point.
        let vertex = match closest.feature {
            Feature::Face => 0,
            Feature::Edge(i) | Feature::Vertex(i) => usize::from(i),
        };
        let query = (*query).into();
        let offset = sub(query, corners[vertex]);
        let product = dot(offset, normal);
        let least = (MIN_SINE * closest.distance).max(MIN_PRODUCT_PER_OFFSET * length(offset)).max(f64::MIN_POSITIVE);
        (product.abs() >= least && product.is_finite()).then_some(product > 0.0)
    }

    /// Returns whether the query is exactly on a triangle.
    fn is_on_surface(&self, query: &Point3<f64>) -> bool {
        let query_only = ray(query).with_range(0.0, 0.0).expect("0 is a valid parameter");
        self.rays.do_intersect(&query_only)
    }

    /// Returns whether a ray from the query crosses the surface an odd number of times.
    fn is_inside(&self, query: &Point3<f64>) -> bool {
        self.rays.crossings(&ray(query)) % 2 == 1
    }
}

/// Returns the ray from a query whose crossings are counted.
fn ray(query: &Point3<f64>) -> Ray {
    Ray::new(query, &Vector3::from(RAY_DIRECTION)).expect("the query is finite, since it has a closest point")
}

fn corners(soup: &Soup<f64>, triangle: [u32; 3]) -> [V3; 3] {
    triangle.map(|i| soup.positions()[i as usize].into())
}

/// Returns the unit normal of a triangle, or `None` if the triangle is a sliver or its edges are infinite.
fn unit_normal(corners: [V3; 3]) -> Option<V3> {
    let edges = [sub(corners[1], corners[0]), sub(corners[2], corners[0])];
    let size = largest(&edges);
    let [e, f] = edges.map(|edge| edge.map(|x| x / size));
    let normal = cross(e, f);
    let length = length(normal);
    // A length of NaN is not at least `MIN_SINE`, so it gives `None`.
    (size > 0.0 && size.is_finite() && length >= MIN_SINE).then(|| normal.map(|x| x / length))
}

/// Returns the angle at corner `i` of a triangle that is not a sliver.
fn angle(corners: [V3; 3], i: usize) -> f64 {
    let scaled_edge_to = |k: usize| {
        let edge = sub(corners[(i + k) % 3], corners[i]);
        let size = largest(&[edge]);
        edge.map(|x| x / size)
    };
    let (e, f) = (scaled_edge_to(1), scaled_edge_to(2));
    length(cross(e, f)).atan2(dot(e, f))
}
