//! The topology of a closed surface: how its triangles are connected along edges.

use super::types::{SignError, check_kinds};
use nalgebra::Point3;
use p2m_bvh::TreeIndex;
use p2m_core::engine::weld::{UNUSED, UnionFind, VertexWelder, group_by_vertex};
use p2m_core::{Aabb, Crossing, PrimitiveId, Ray, RayCollector, Soup};
use std::ops::ControlFlow;

/// The tree in which rays are cast.
pub(super) type RayTree<S> = TreeIndex<f64, S, Aabb<f64>>;

/// The neighbour of an edge that has none, because more than two triangles have the edge or the triangle
/// has equal corners.
pub(super) const NO_TRIANGLE: u32 = u32::MAX;

/// The connections between the triangles of a closed surface.
pub(super) struct Topology {
    /// The vertices of the surface.
    pub(super) welder: VertexWelder,
    /// The triangle beyond each edge, or [`NO_TRIANGLE`].
    pub(super) neighbours: Vec<[u32; 3]>,
    /// The component of each triangle. Components are connected along edges, and have the number of one
    /// of their triangles.
    pub(super) components: Vec<u32>,
    /// Whether the triangles around each vertex form a single fan.
    pub(super) is_fan: Vec<bool>,
}

/// A half-edge, stored at its lower vertex: the higher vertex, whether it runs upwards, and 3 * triangle + edge.
type HalfEdge = (u32, bool, u32);

impl Topology {
    /// # Errors
    /// [`SignError::OtherKinds`], [`SignError::Open`] and [`SignError::NotOriented`].
    #[allow(clippy::cast_possible_truncation, reason = "ids are below 2^30")]
    pub(super) fn new(soup: &Soup<f64>) -> Result<Self, SignError> {
        check_kinds(soup)?;
        let welder = VertexWelder::new(soup);
        let triangles = soup.triangles();
        let half_edges = triangles.iter().enumerate().flat_map(|(t, corners)| {
            let [a, b, c] = welder.weld(*corners);
            let has_edges = a != b && b != c && c != a;
            let edges = [(a, b), (b, c), (c, a)].into_iter().enumerate().filter(move |_| has_edges);
            edges.map(move |(i, (a, b))| (a.min(b), (a.max(b), a < b, (3 * t + i) as u32)))
        });
        let mut neighbours = vec![[NO_TRIANGLE; 3]; triangles.len()];
        let (mut components, mut fans) = (UnionFind::new(triangles.len()), UnionFind::new(3 * triangles.len()));
        let mut error: Option<(u32, bool)> = None;
        group_by_vertex(welder.vertex_count, half_edges, |half_edges: &[HalfEdge]| {
            for half_edges in half_edges.chunk_by(|x, y| x.0 == y.0) {
                let upwards = half_edges.iter().filter(|half_edge| half_edge.1).count();
                if 2 * upwards != half_edges.len() {
                    let lowest = half_edges.iter().map(|half_edge| half_edge.2).min().unwrap_or(0);
                    let is_open = half_edges.len() % 2 == 1;
                    error = Some(error.map_or((lowest, is_open), |error| error.min((lowest, is_open))));
                } else if let [(_, _, one), (_, _, other)] = *half_edges {
                    let next = |corner: u32| corner - corner % 3 + (corner + 1) % 3;
                    neighbours[one as usize / 3][one as usize % 3] = other / 3;
                    neighbours[other as usize / 3][other as usize % 3] = one / 3;
                    components.union(one / 3, other / 3);
                    fans.union(one, next(other));
                    fans.union(next(one), other);
                }
            }
        });
        if let Some((half_edge, is_open)) = error {
            let (triangle, edge) = (half_edge as usize / 3, half_edge as usize % 3);
            return Err(if is_open {
                SignError::Open { triangle, edge }
            } else {
                SignError::NotOriented { triangle, edge }
            });
        }
        let (mut is_fan, mut fan_of) = (vec![true; welder.vertex_count], vec![UNUSED; welder.vertex_count]);
        for (corner, position) in triangles.iter().flatten().enumerate() {
            let (vertex, fan) = (welder.vertex_ids[*position as usize] as usize, fans.find(corner as u32));
            if fan_of[vertex] == UNUSED {
                fan_of[vertex] = fan;
            }
            is_fan[vertex] &= fan_of[vertex] == fan;
        }
        let components = (0..triangles.len() as u32).map(|t| components.find(t)).collect();
        Ok(Self { welder, neighbours, components, is_fan })
    }

    /// Returns the lowest triangle with an edge that intersects a triangle which does not touch the ends of the edge,
    /// and the lowest such triangle.
    pub(super) fn find_self_intersection(&self, soup: &Soup<f64>, rays: &RayTree<&Soup<f64>>) -> Option<[usize; 2]> {
        let at = |position: u32| -> Point3<f64> { soup.positions()[position as usize] };
        for (t, corners) in soup.triangles().iter().enumerate() {
            for (i, neighbour) in self.neighbours[t].iter().enumerate() {
                // Each edge is cast once, for its lower triangle.
                if (*neighbour as usize) < t {
                    continue;
                }
                let ends = [corners[i], corners[(i + 1) % 3]];
                // There is no ray if the ends are equal, or so far apart that their difference is infinite.
                let Ok(ray) = Ray::new(&at(ends[0]), &(at(ends[1]) - at(ends[0]))) else { continue };
                let ray = ray.with_range(0.0, 1.0).expect("one is above zero");
                let ends = self.welder.weld(ends);
                let mut hit = LowestNonAdjacentHit { welder: &self.welder, soup, ends, lowest: None };
                rays.visit_ray(&ray, &mut hit);
                if let Some(other) = hit.lowest {
                    return Some([t, other.index()]);
                }
            }
        }
        None
    }
}

/// Collects the lowest triangle that an edge intersects. Triangles with a corner at an end of the edge are ignored,
/// because they all intersect it there.
struct LowestNonAdjacentHit<'a> {
    welder: &'a VertexWelder,
    soup: &'a Soup<f64>,
    /// The vertices at the ends of the edge.
    ends: [u32; 2],
    lowest: Option<PrimitiveId>,
}

impl<'r> RayCollector<'r> for LowestNonAdjacentHit<'_> {
    fn wants(&self, triangle: PrimitiveId) -> bool {
        let corners = self.welder.weld(self.soup.triangles()[triangle.index()]);
        self.lowest.is_none_or(|lowest| triangle < lowest) && corners.iter().all(|vertex| !self.ends.contains(vertex))
    }

    fn offer(&mut self, triangle: PrimitiveId, _: &Crossing<'r>) -> ControlFlow<()> {
        self.lowest = Some(triangle);
        ControlFlow::Continue(())
    }
}
