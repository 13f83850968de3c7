//! One packet in all cells whose lists may need it: the primitives that can be the answer in each cell, and the regions
//! where they can be.
//!
//! A packet matters only near the corners whose balls it intersects, its *near* corners. The value of the corner test
//! at a corner is the same for all cells around it, for the corner is equally far from their sites. So the packet is
//! evaluated once at each near corner and at each corner that an edge joins to one. The regions of its primitives in
//! all cells follow from these values: each edge from a corner where a value is not above zero leads to another one of
//! these corners.

use crate::delaunay::Delaunay;
use crate::voronoi::cell::CellContext;
use crate::voronoi::cell_polytope::CornerPoints;
use crate::voronoi::corner_values::CornerValues;
use crate::voronoi::excluded_features::{ExcludedFeatures, RegionPoints};
use crate::voronoi::feature_relevance::{CellInfo, LanesOver, PrimitiveFeatures, RelevanceContext};
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::simd::{InstructionSet, SimdKernel};
use rustc_hash::FxHashMap;
use std::ops::Range;

/// The lengths of a cell that gets a list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellSize {
    /// An upper bound of the distance from the site to a corner.
    pub(crate) max_distance: f64,
    /// An upper bound of the error of a corner.
    pub(crate) max_error: f64,
}

/// A packet in a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PacketInCell {
    /// The number of the site of the cell.
    pub(crate) site: u32,
    /// The number of the packet.
    pub(crate) packet: u32,
    /// The lanes that can hold the answer in the cell, as bits. There may be none.
    pub(crate) lanes: u16,
}

/// The packet that is being examined, with the corners and cells around it. Its vectors are reused.
#[derive(Default)]
pub(crate) struct PacketCells {
    /// The number of the packet.
    packet: u32,
    /// The number of each corner in this structure, by its tetrahedron.
    numbers: FxHashMap<u32, u32>,
    /// The near corners, then those that an edge joins to one.
    corners: CornerPoints,
    /// For each near corner the four corners that an edge joins to it, opposite to the vertices of its tetrahedron, or
    /// [`Delaunay::NONE`].
    neighbours: Vec<[u32; 4]>,
    /// The vertices of the tetrahedra of near corners.
    tetrahedra: Vec<[u32; 4]>,
    /// The values of the corner test.
    pub(crate) values: CornerValues,
    /// The sites of cells with their near corners, sorted.
    corners_of_cells: Vec<(u32, u32)>,
    /// The sites of the cells that have near corners, each with its range in `corners_of_cells`.
    cells: Vec<(u32, Range<usize>)>,
    /// The edges of the current cell from a near corner, with the lanes whose value is not above zero at exactly one
    /// end.
    crossed_edges: Vec<([u32; 2], u16)>,
    /// The region of a primitive in the current cell.
    pub(crate) region: RegionPoints,
    /// The planes around the largest features of the primitives of the packet.
    over: LanesOver,
    /// For each near corner the lanes over whose largest feature it is and whose value is not above zero there.
    lanes_over: Vec<u16>,
    /// The features of the primitives of the packet.
    features: [PrimitiveFeatures; LANES],
    /// The lanes whose features are prepared, as bits.
    prepared: u16,
    /// The test of features, with its memory.
    excluded: ExcludedFeatures,
}

impl PacketCells {
    /// Begins a packet, which intersects the balls of these tetrahedra. Cells without a size get no list and are left
    /// out.
    pub(crate) fn begin(
        &mut self,
        cells: &CellContext<'_>,
        sizes: &[Option<CellSize>],
        packet: u32,
        near_tetrahedra: &[u32],
    ) {
        let (delaunay, corners, slack) = (&cells.sites.delaunay, &cells.sites.corners, cells.limits.slack);
        self.packet = packet;
        self.prepared = 0;
        self.numbers.clear();
        self.corners.clear();
        self.neighbours.clear();
        self.tetrahedra.clear();
        self.corners_of_cells.clear();
        self.cells.clear();
        let has_list = |site: &u32| sizes[*site as usize].is_some();
        let push = |points: &mut CornerPoints, tetrahedron: u32| {
            let corner = &corners.all[tetrahedron as usize];
            points.push(corner.position, corner.radius + corner.error + slack, corner.error);
        };
        for &tetrahedron in near_tetrahedra {
            let vertices = delaunay.tetrahedra()[tetrahedron as usize];
            if vertices.iter().any(has_list) {
                let number = to_u32(self.tetrahedra.len());
                self.numbers.insert(tetrahedron, number);
                push(&mut self.corners, tetrahedron);
                self.tetrahedra.push(vertices);
                self.corners_of_cells.extend(vertices.into_iter().filter(has_list).map(|site| (site, number)));
            }
        }
        self.corners_of_cells.sort_unstable();
        let mut first = 0;
        for of_one in self.corners_of_cells.chunk_by(|a, b| a.0 == b.0) {
            self.cells.push((of_one[0].0, first..first + of_one.len()));
            first += of_one.len();
        }
        let near = self.tetrahedra.len();
        for &tetrahedron in near_tetrahedra {
            if !self.numbers.contains_key(&tetrahedron) {
                continue;
            }
            let (vertices, neighbours) =
                (delaunay.tetrahedra()[tetrahedron as usize], delaunay.neighbours()[tetrahedron as usize]);
            self.neighbours.push(std::array::from_fn(|face| {
                // The edge belongs to the cells of the three vertices of the face. No cell with an unknown corner
                // has a list.
                let is_needed = (0..4).any(|v| v != face && has_list(&vertices[v]));
                if !is_needed || neighbours[face] == Delaunay::NONE {
                    return Delaunay::NONE;
                }
                *self.numbers.entry(neighbours[face]).or_insert_with(|| {
                    push(&mut self.corners, neighbours[face]);
                    to_u32(self.corners.positions.len() - 1)
                })
            }));
        }
        let tree = cells.tree;
        self.values.compute(&self.corners, &tree.leaves.packets[packet as usize], tree);
        // The packet does not intersect the balls of the other corners.
        for corner in near..self.corners.positions.len() {
            self.values.raise_above_zero(corner);
        }
    }

    /// Begins a cell and returns the lanes whose value is not above zero at some of its corners.
    #[inline(always)]
    fn begin_cell(&mut self, site: u32, range: Range<usize>) -> u16 {
        self.crossed_edges.clear();
        let mut near_lanes = 0;
        for &(_, corner) in &self.corners_of_cells[range] {
            let lanes = self.values.lanes_below[corner as usize];
            near_lanes |= lanes;
            let (vertices, neighbours) = (self.tetrahedra[corner as usize], self.neighbours[corner as usize]);
            for (vertex, other) in vertices.into_iter().zip(neighbours) {
                // An edge between two near corners is seen from both.
                let is_first = other as usize >= self.tetrahedra.len() || corner < other;
                if vertex != site && other != Delaunay::NONE && is_first {
                    let crossing = lanes ^ self.values.lanes_below[other as usize];
                    if crossing != 0 {
                        self.crossed_edges.push(([corner, other], crossing));
                    }
                }
            }
        }
        near_lanes & self.values.near_lanes
    }

    /// Computes the points that span the region of a lane in the current cell.
    #[inline(always)]
    fn find_region(&mut self, range: Range<usize>, lane: usize) {
        self.region.clear();
        for &(_, corner) in &self.corners_of_cells[range] {
            if self.values.lanes_below[corner as usize] >> lane & 1 == 1 {
                self.region.push(self.corners.positions[corner as usize]);
            }
        }
        for &(edge, lanes) in &self.crossed_edges {
            if lanes >> lane & 1 == 1 {
                let [i, j] = edge.map(|i| i as usize);
                let [a, b] = [i, j].map(|i| f64::from(self.values.values[i][lane]));
                // The part of the edge from i reaches a little beyond the zero of the chord.
                let t = a / (a - b) + if a <= 0.0 { 1e-6 } else { -1e-6 };
                let (from, to) = (self.corners.positions[i], self.corners.positions[j]);
                self.region.push(std::array::from_fn(|k| from[k] + t * (to[k] - from[k])));
            }
        }
    }

    /// Passes the region of each of some primitives of the packet to `visit`, with the site and the lane. `lanes_of`
    /// returns the lanes in question in the cell of a site.
    pub(crate) fn visit_regions(
        &mut self,
        lanes_of: impl Fn(u32) -> u16,
        mut visit: impl FnMut(u32, usize, &RegionPoints),
    ) {
        for number in 0..self.cells.len() {
            let (site, range) = self.cells[number].clone();
            let lanes = lanes_of(site) & self.begin_cell(site, range.clone());
            for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
                self.find_region(range.clone(), lane);
                visit(site, lane, &self.region);
            }
        }
    }
}

/// A SIMD kernel that finds, for each cell with near corners, the lanes that can hold the answer there.
pub(crate) struct FindRelevantLanes<'a, 'b> {
    /// The data that all tests share.
    pub(crate) scene: RelevanceContext<'a>,
    /// The lengths of all cells.
    pub(crate) sizes: &'a [Option<CellSize>],
    /// The packet that is examined.
    pub(crate) packet: &'b mut PacketCells,
    /// Receives the packet in each cell, in the order of the sites.
    pub(crate) found: &'b mut Vec<PacketInCell>,
}

impl SimdKernel for FindRelevantLanes<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { scene, sizes, packet, found } = self;
        packet.over.prepare(scene, packet.packet as usize);
        packet.lanes_over.clear();
        for (corner, lanes) in packet.corners.positions.iter().zip(&packet.values.lanes_below).take(packet.tetrahedra.len()) {
            packet.lanes_over.push(lanes & packet.over.lanes_below_point::<I::Doubles>(corner));
        }
        for number in 0..packet.cells.len() {
            let (site, range) = packet.cells[number].clone();
            let Some(CellSize { max_distance, max_error }) = sizes[site as usize] else { continue };
            let position = scene.position(site as usize);
            let cell = CellInfo { site: site as usize, position, max_distance, max_error };
            let near_lanes = packet.begin_cell(site, range.clone());
            let mut lanes = near_lanes;
            let corners = &packet.corners_of_cells[range.clone()];
            let open = corners.iter().fold(near_lanes, |open, (_, corner)| open & !packet.lanes_over[*corner as usize]);
            for lane in (0..LANES).filter(|lane| open >> lane & 1 == 1) {
                if packet.prepared >> lane & 1 == 0 {
                    packet.prepared |= 1 << lane;
                    packet.features[lane].prepare(scene, packet.packet as usize, lane);
                }
                packet.find_region(range.clone(), lane);
                let PacketCells { features, region, excluded, .. } = &mut *packet;
                if !features[lane].is_relevant::<I::Doubles>(&cell, scene.slack, region, excluded) {
                    lanes &= !(1 << lane);
                }
            }
            found.push(PacketInCell { site, packet: packet.packet, lanes });
        }
    }
}

/// Converts a number of few corners to 32 bits.
fn to_u32(n: usize) -> u32 {
    u32::try_from(n).expect("few corners")
}
