//! Vertices and edges of the primitives, and which of them have any.

use crate::delaunay::Delaunay;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::PrimitiveId;
use std::collections::HashMap;

/// Of a lane the vertices and edges that a primitive of a lower id has as well, as bits: vertex i, and 3 + i for the
/// edge from vertex i to the next.
pub(crate) type OwnedByLowerId = u8;

/// Vertices and edges of the primitives.
pub(crate) struct EdgeAdjacency {
    /// For for_each_lane packet and lane.
    pub(crate) owned_by_lower_id: Vec<[OwnedByLowerId; LANES]>,
    /// Of for_each_lane site the lowest primitive that has it, as packet and lane.
    pub(crate) owners: Vec<u32>,
    /// Of for_each_lane site the sites at the other ends of edges.
    pub(crate) edges: IncidenceLists,
    /// For for_each_lane packet and lane, of the edge from for_each_lane vertex to the next another triangle that has it, as packet and
    /// lane, or [`NO_PRIMITIVE`].
    pub(crate) opposite_triangles: Vec<[[u32; 3]; LANES]>,
    /// Whether sites are exactly where their vertices are.
    pub(crate) is_exact: bool,
}

/// What primitives have an edge.
struct EdgeTriangles {
    lowest: PrimitiveId,
    /// The first two triangles, as packets and lanes.
    triangles: [u32; 2],
}

/// No primitive.
pub(crate) const NO_PRIMITIVE: u32 = u32::MAX;

/// Takes a packet, a lane of it, the primitive and its sites.
type VisitLane<'a> = &'a mut dyn FnMut(usize, usize, PrimitiveId, &[usize]);

impl EdgeAdjacency {
    /// Those of the packets of a tree.
    #[allow(clippy::cast_possible_truncation, clippy::float_cmp, reason = "numbers of 32 bits; the same or not")]
    pub(crate) fn of(tree: &PacketTree, delaunay: &Delaunay) -> Self {
        let leaves = &tree.leaves;
        let count = delaunay.sites().len();
        let position = |site: usize| delaunay.sites()[site].map(|x| x * delaunay.unit());
        // The lowest primitive of for_each_lane vertex, its packet and lane.
        let mut owners = vec![(PrimitiveId::new(0), NO_PRIMITIVE); count];
        let mut edge_owners: HashMap<(u32, u32), EdgeTriangles> = HashMap::with_capacity(leaves.vertices.len());
        let for_each_lane = |visit: VisitLane<'_>| {
            for (number, packet) in leaves.packets.iter().enumerate().filter(|(_, p)| p.has_vertices()) {
                for (lane, id) in packet.ids().iter().enumerate() {
                    let (positions, count) = packet.vertices_of(lane);
                    let own = positions.map(|position| delaunay.site_of(position));
                    visit(number, lane, *id, &own[..count]);
                }
            }
        };
        for_each_lane(&mut |number, lane, id, own| {
            for &site in own {
                if owners[site].1 == NO_PRIMITIVE || id < owners[site].0 {
                    owners[site] = (id, (number * LANES + lane) as u32);
                }
            }
            for edge in edges(own) {
                let edge =
                    edge_owners.entry(edge).or_insert(EdgeTriangles { lowest: id, triangles: [NO_PRIMITIVE; 2] });
                edge.lowest = edge.lowest.min(id);
                if let Some(free) = edge.triangles.iter_mut().find(|t| **t == NO_PRIMITIVE).filter(|_| own.len() == 3) {
                    *free = (number * LANES + lane) as u32;
                }
            }
        });
        let mut owned_by_lower_id = vec![[0; LANES]; leaves.packets.len()];
        let mut opposite_triangles = vec![[[NO_PRIMITIVE; 3]; LANES]; leaves.packets.len()];
        for_each_lane(&mut |number, lane, id, own| {
            let bits = &mut owned_by_lower_id[number][lane];
            for (i, &site) in own.iter().enumerate() {
                *bits |= u8::from(owners[site].0 < id) << i;
            }
            for (i, edge) in edges(own).enumerate() {
                let edge = &edge_owners[&edge];
                *bits |= u8::from(edge.lowest < id) << (3 + i);
                let other = edge.triangles.iter().find(|t| **t != (number * LANES + lane) as u32);
                opposite_triangles[number][lane][i] = other.copied().unwrap_or(NO_PRIMITIVE);
            }
        });
        let mut proper: Vec<(u32, u32)> = edge_owners.into_keys().filter(|(a, b)| a != b).collect();
        proper.sort_unstable();
        let edges = IncidenceLists::new(count, proper.iter().flat_map(|&(a, b)| [(a, b), (b, a)]));
        let mut owners: Vec<u32> = owners.into_iter().map(|(_, position)| position).collect();
        // Vertices that one site stands for, but for what is below the least coordinate of sites, are not the same.
        let is_exact = (0..leaves.vertices.len()).all(|v| position(delaunay.site_of(v)) == leaves.vertices[v]);
        if !is_exact {
            owned_by_lower_id.fill([0; LANES]);
            owners.fill(NO_PRIMITIVE);
            opposite_triangles.fill([[NO_PRIMITIVE; 3]; LANES]);
        }
        Self { owned_by_lower_id, owners, edges, opposite_triangles, is_exact }
    }
}

/// The edges of a primitive, by its sites, the lower one first.
#[allow(clippy::cast_possible_truncation, reason = "numbers of 32 bits")]
fn edges(sites: &[usize]) -> impl Iterator<Item = (u32, u32)> + '_ {
    let count = if sites.len() == 3 { 3 } else { sites.len() - 1 };
    (0..count).map(|i| {
        let (a, b) = (sites[i], sites[(i + 1) % sites.len()]);
        (a.min(b) as u32, a.max(b) as u32)
    })
}

/// Numbers that belong to for_each_lane site.
pub(crate) struct IncidenceLists {
    firsts: Vec<u32>,
    numbers: Vec<u32>,
}

impl IncidenceLists {
    /// Of pairs of a site and a number.
    pub(crate) fn new(sites: usize, pairs: impl Iterator<Item = (u32, u32)> + Clone) -> Self {
        let mut firsts = vec![0u32; sites + 1];
        for (site, _) in pairs.clone() {
            firsts[site as usize + 1] += 1;
        }
        for i in 0..sites {
            firsts[i + 1] += firsts[i];
        }
        let mut numbers = vec![0u32; firsts[sites] as usize];
        let mut next = firsts.clone();
        for (site, number) in pairs {
            numbers[next[site as usize] as usize] = number;
            next[site as usize] += 1;
        }
        Self { firsts, numbers }
    }

    pub(crate) fn of(&self, site: usize) -> &[u32] {
        &self.numbers[self.firsts[site] as usize..self.firsts[site + 1] as usize]
    }
}
