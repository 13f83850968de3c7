//! The topology of a set of triangles: which of them are neighbours, and where their surface has a boundary.

use p2m_core::Soup;
use p2m_core::engine::weld::{VertexWelder, group_by_vertex};

/// Marks an edge without a neighbour: the edge does not have exactly two triangles, both triangles run through it in
/// the same direction, or the triangle has equal corners.
pub(super) const NO_TRIANGLE: u32 = u32::MAX;

/// The connections between triangles. Vertices are welded where they have the same coordinates.
pub(super) struct Surface {
    pub(super) welder: VertexWelder,
    /// The triangle beyond each edge, or [`NO_TRIANGLE`].
    pub(super) neighbours: Vec<[u32; 3]>,
    /// The directed edges through which triangles run more often in this direction than in the other, once for each
    /// time in excess. They are the boundary of the surface.
    pub(super) boundary: Vec<[u32; 2]>,
    /// The lowest triangle that has an edge with an odd number of triangles, and the number of that edge.
    pub(super) open: Option<(usize, usize)>,
}

/// A half-edge, stored at its lower vertex: the higher vertex, whether it runs upwards, and 3 * triangle + edge.
type HalfEdge = (u32, bool, u32);

impl Surface {
    pub(super) fn new(soup: &Soup<f64>) -> Self {
        let welder = VertexWelder::new(soup);
        let mut neighbours = vec![[NO_TRIANGLE; 3]; soup.triangles().len()];
        let (mut boundary, mut open): (_, Option<u32>) = (Vec::new(), None);
        let mut low = 0u32;
        group_by_vertex(welder.vertex_count, half_edges(soup, &welder), |half_edges: &[HalfEdge]| {
            for half_edges in half_edges.chunk_by(|x, y| x.0 == y.0) {
                let upwards = half_edges.iter().filter(|half_edge| half_edge.1).count();
                let downwards = half_edges.len() - upwards;
                if upwards != downwards {
                    let [from, to] = if upwards > downwards { [low, half_edges[0].0] } else { [half_edges[0].0, low] };
                    boundary.extend(std::iter::repeat_n([from, to], upwards.abs_diff(downwards)));
                    if half_edges.len() % 2 == 1 {
                        open = half_edges.iter().map(|half_edge| half_edge.2).chain(open).min();
                    }
                } else if let [(_, _, one), (_, _, other)] = *half_edges {
                    neighbours[one as usize / 3][one as usize % 3] = other / 3;
                    neighbours[other as usize / 3][other as usize % 3] = one / 3;
                }
            }
            low += 1;
        });
        let place = |half_edge: u32| (half_edge as usize / 3, half_edge as usize % 3);
        Self { welder, neighbours, boundary, open: open.map(place) }
    }

    /// Calls a function for each edge of the triangles, with 3 * triangle + edge for all triangles that have it.
    pub(super) fn for_each_edge(&self, soup: &Soup<f64>, mut visit: impl FnMut(&[u32])) {
        let mut ids = Vec::new();
        group_by_vertex(self.welder.vertex_count, half_edges(soup, &self.welder), |half_edges: &[HalfEdge]| {
            for half_edges in half_edges.chunk_by(|x, y| x.0 == y.0) {
                ids.clear();
                ids.extend(half_edges.iter().map(|half_edge| half_edge.2));
                visit(&ids);
            }
        });
    }
}

/// Returns the half-edges of triangles with their lower vertices.
#[allow(clippy::cast_possible_truncation, reason = "ids are below 2^30")]
fn half_edges(soup: &Soup<f64>, welder: &VertexWelder) -> impl Iterator<Item = (u32, HalfEdge)> + Clone {
    soup.triangles().iter().enumerate().flat_map(|(t, corners)| {
        let [a, b, c] = welder.weld(*corners);
        // The edges of a triangle with equal corners cancel each other.
        let has_edges = a != b && b != c && c != a;
        let edges = [(a, b), (b, c), (c, a)].into_iter().enumerate().filter(move |_| has_edges);
        edges.map(move |(i, (a, b))| (a.min(b), (a.max(b), a < b, (3 * t + i) as u32)))
    })
}
