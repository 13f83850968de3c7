//! The adjacency of primitives: which vertices and edges they share, and with whom.

use crate::delaunay::{Delaunay, ScaledSites};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::PrimitiveId;
use rustc_hash::{FxBuildHasher, FxHashMap};

/// A bit mask of the vertices and edges of a lane that a primitive with a lower id shares: bit i is vertex i, and bit 3
/// + i is the edge from vertex i to the next one.
pub(crate) type OwnedByLowerId = u8;

/// The vertices and edges of all primitives.
pub(crate) struct EdgeAdjacency {
    /// For each packet and lane, the vertices and edges that a primitive with a lower id shares.
    pub(crate) owned_by_lower_id: Vec<[OwnedByLowerId; LANES]>,
    /// For each site, the primitive with the lowest id that has it, as packet times [`LANES`] plus lane, or
    /// [`NO_PRIMITIVE`].
    pub(crate) owners: Vec<u32>,
    /// For each site the sites at the other ends of edges.
    pub(crate) edges: IncidenceLists,
    /// For each packet and lane, and for the edge from each vertex to the next one, another triangle with this edge, as
    /// packet times [`LANES`] plus lane, or [`NO_PRIMITIVE`].
    pub(crate) opposite_triangles: Vec<[[u32; 3]; LANES]>,
    /// Whether all sites are exactly at their vertices.
    pub(crate) is_exact: bool,
}

/// The topology of a triangulation and of the primitives on its sites, which lists are built from.
pub(crate) struct SiteTopology {
    /// The vertices and edges of all primitives.
    pub(crate) adjacency: EdgeAdjacency,
    /// For each site the tetrahedra at it, in ascending order.
    pub(crate) incident_tetrahedra: IncidenceLists,
}

impl SiteTopology {
    /// Combines the edges of primitives with the tetrahedra of a triangulation of their sites.
    pub(crate) fn new(adjacency: EdgeAdjacency, delaunay: &Delaunay) -> Self {
        let tetrahedra = (0..).zip(delaunay.tetrahedra());
        let incident = tetrahedra.flat_map(|(number, tetrahedron)| tetrahedron.iter().map(move |v| (*v, number)));
        Self { adjacency, incident_tetrahedra: IncidenceLists::new(delaunay.sites().len(), incident) }
    }
}

/// The primitives that have an edge.
struct EdgeTriangles {
    /// The lowest id of all primitives with the edge.
    lowest: PrimitiveId,
    /// The first two triangles, as packet times [`LANES`] plus lane, or [`NO_PRIMITIVE`].
    triangles: [u32; 2],
}

/// Marks that there is no primitive.
pub(crate) const NO_PRIMITIVE: u32 = u32::MAX;

/// A visitor of lanes. It receives a packet, a lane of it, the id of the primitive and its sites.
type VisitLane<'a> = &'a mut dyn FnMut(usize, usize, PrimitiveId, &[usize]);

impl EdgeAdjacency {
    /// Collects the vertices and edges of the packets of a tree, whose vertices have these sites.
    #[allow(clippy::cast_possible_truncation, clippy::float_cmp, reason = "numbers of 32 bits; the same or not")]
    pub(crate) fn from_tree(tree: &PacketTree, sites: &ScaledSites) -> Self {
        let leaves = &tree.leaves;
        let count = sites.positions.len();
        let site_of = |vertex: usize| sites.site_of[vertex] as usize;
        let position = |site: usize| sites.positions[site].map(|x| x * sites.unit);
        // For each site the primitive with the lowest id, and its packet and lane.
        let mut owners = vec![(PrimitiveId::new(0), NO_PRIMITIVE); count];
        let mut edge_owners: FxHashMap<(u32, u32), EdgeTriangles> =
            FxHashMap::with_capacity_and_hasher(leaves.vertices.len(), FxBuildHasher);
        let for_each_lane = |visit: VisitLane<'_>| {
            for (number, packet) in leaves.packets.iter().enumerate().filter(|(_, p)| p.has_vertices()) {
                for (lane, id) in packet.ids().iter().enumerate() {
                    let (positions, count) = packet.vertices_of(lane);
                    let sites = positions.map(site_of);
                    visit(number, lane, *id, &sites[..count]);
                }
            }
        };
        for_each_lane(&mut |number, lane, id, sites| {
            for &site in sites {
                if owners[site].1 == NO_PRIMITIVE || id < owners[site].0 {
                    owners[site] = (id, (number * LANES + lane) as u32);
                }
            }
            for edge in edges_of(sites) {
                let edge =
                    edge_owners.entry(edge).or_insert(EdgeTriangles { lowest: id, triangles: [NO_PRIMITIVE; 2] });
                edge.lowest = edge.lowest.min(id);
                if let Some(free) = edge.triangles.iter_mut().find(|t| **t == NO_PRIMITIVE).filter(|_| sites.len() == 3)
                {
                    *free = (number * LANES + lane) as u32;
                }
            }
        });
        let mut owned_by_lower_id = vec![[0; LANES]; leaves.packets.len()];
        let mut opposite_triangles = vec![[[NO_PRIMITIVE; 3]; LANES]; leaves.packets.len()];
        for_each_lane(&mut |number, lane, id, sites| {
            let bits = &mut owned_by_lower_id[number][lane];
            for (i, &site) in sites.iter().enumerate() {
                *bits |= u8::from(owners[site].0 < id) << i;
            }
            for (i, edge) in edges_of(sites).enumerate() {
                let edge = &edge_owners[&edge];
                *bits |= u8::from(edge.lowest < id) << (3 + i);
                let other = edge.triangles.iter().find(|t| **t != (number * LANES + lane) as u32);
                opposite_triangles[number][lane][i] = other.copied().unwrap_or(NO_PRIMITIVE);
            }
        });
        let mut proper_edges: Vec<(u32, u32)> = edge_owners.into_keys().filter(|(a, b)| a != b).collect();
        proper_edges.sort_unstable();
        let edges = IncidenceLists::new(count, proper_edges.iter().flat_map(|&(a, b)| [(a, b), (b, a)]));
        let mut owners: Vec<u32> = owners.into_iter().map(|(_, primitive)| primitive).collect();
        // Vertices that one site represents may differ where coordinates are too small for sites. Then nothing is
        // known to be shared.
        let is_exact = (0..leaves.vertices.len()).all(|v| position(site_of(v)) == leaves.vertices[v]);
        if !is_exact {
            owned_by_lower_id.fill([0; LANES]);
            owners.fill(NO_PRIMITIVE);
            opposite_triangles.fill([[NO_PRIMITIVE; 3]; LANES]);
        }
        Self { owned_by_lower_id, owners, edges, opposite_triangles, is_exact }
    }
}

/// Returns the edges of a primitive with some sites, the lower site of each edge first.
#[allow(clippy::cast_possible_truncation, reason = "numbers of 32 bits")]
fn edges_of(sites: &[usize]) -> impl Iterator<Item = (u32, u32)> + '_ {
    let count = if sites.len() == 3 { 3 } else { sites.len() - 1 };
    (0..count).map(|i| {
        let (a, b) = (sites[i], sites[(i + 1) % sites.len()]);
        (a.min(b) as u32, a.max(b) as u32)
    })
}

/// Lists of items, such as numbers, one list for each site, in compressed form.
pub(crate) struct IncidenceLists<V = u32> {
    /// The index of the first item of each site, and the end.
    firsts: Vec<u32>,
    /// The items of all sites, one site after the other.
    items: Vec<V>,
}

impl<V: Copy + Default> IncidenceLists<V> {
    /// Makes the lists from the items of all lists, one list after the other, and the index of the first item of each
    /// list and the end.
    pub(crate) fn from_parts(firsts: Vec<u32>, items: Vec<V>) -> Self {
        Self { firsts, items }
    }

    /// Collects the lists from pairs of a site and an item.
    pub(crate) fn new(sites: usize, pairs: impl Iterator<Item = (u32, V)> + Clone) -> Self {
        let mut firsts = vec![0u32; sites + 1];
        for (site, _) in pairs.clone() {
            firsts[site as usize + 1] += 1;
        }
        for i in 0..sites {
            firsts[i + 1] += firsts[i];
        }
        let mut items = vec![V::default(); firsts[sites] as usize];
        let mut next = firsts.clone();
        for (site, item) in pairs {
            items[next[site as usize] as usize] = item;
            next[site as usize] += 1;
        }
        Self { firsts, items }
    }

    /// Returns the items of a site.
    pub(crate) fn get(&self, site: usize) -> &[V] {
        &self.items[self.range(site)]
    }

    /// Returns the items of a site, to be changed.
    pub(crate) fn get_mut(&mut self, site: usize) -> &mut [V] {
        let range = self.range(site);
        &mut self.items[range]
    }

    fn range(&self, site: usize) -> std::ops::Range<usize> {
        self.firsts[site] as usize..self.firsts[site + 1] as usize
    }
}
