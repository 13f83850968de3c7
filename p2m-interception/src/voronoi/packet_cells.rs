//! One packet in all cells whose lists may need it: the primitives that can be the answer in each cell, and the regions
//! where they can be.
//!
//! A packet matters only near the corners whose balls it intersects, its *near* corners. The value of the corner test
//! at an exact corner is the same for all cells around it, because the corner is equally far from their sites, and the
//! computed value is a lower bound of it. So the packet is evaluated once at each near corner of cells with lists, and
//! at each corner that an edge of such a cell joins to one. These values determine the regions of its primitives in all
//! of these cells, because both ends of every edge that begins where a value is at most zero have been evaluated.

use crate::delaunay::Delaunay;
use crate::voronoi::cell::CellContext;
use crate::voronoi::cell_polytope::CornerPoints;
use crate::voronoi::corner_values::CornerValues;
use crate::voronoi::excluded_features::{ExcludedFeatures, RegionPoints};
use crate::voronoi::feature_relevance::{CellInfo, LanesOver, PrimitiveFeatures, RelevanceContext};
use crate::voronoi::local_numbers::LocalNumbers;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::simd::{Doubles, InstructionSet, Portable, SimdKernel};
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
    /// The numbers of the corners in this structure, by their tetrahedra.
    corner_numbers: LocalNumbers,
    /// The near corners, then those that an edge joins to one.
    corners: CornerPoints,
    /// For each near corner the four corners that an edge joins to it, opposite to the vertices of its tetrahedron, or
    /// [`Delaunay::NONE`].
    neighbours: Vec<[u32; 4]>,
    /// The vertices of the tetrahedra of near corners.
    tetrahedra: Vec<[u32; 4]>,
    /// The values of the corner test.
    pub(crate) values: CornerValues,
    /// The numbers of the sites of near tetrahedra.
    site_numbers: LocalNumbers,
    /// For each site of a near tetrahedron, whether it has a list, and the number of its near corners.
    near_counts: Vec<(bool, usize)>,
    /// For each vertex of the tetrahedra of near corners, the number of its site.
    sites_of_corners: Vec<[u32; 4]>,
    /// The near corners of all cells, one cell after the other, ascending within each cell.
    corners_of_cells: Vec<u32>,
    /// The sites of the cells that have near corners, each with its range in `corners_of_cells`.
    cells: Vec<(u32, Range<usize>)>,
    /// For each near corner, and for each of the four edges there, the lanes whose value is not above zero at exactly
    /// one end. An edge between two near corners has lanes at the first of them only.
    crossings: Vec<[u16; 4]>,
    /// For each lane the region of its primitive in the current cell.
    regions: [RegionPoints; LANES],
    /// The planes around the largest features of the primitives of the packet.
    over: LanesOver,
    /// For each near corner, the lanes whose largest feature lies below it and whose value is not above zero there.
    lanes_over: Vec<u16>,
    /// The features of the primitives of the packet.
    features: [PrimitiveFeatures; LANES],
    /// The lanes whose features are prepared, as bits.
    prepared: u16,
    /// The test of features, with its memory.
    excluded: ExcludedFeatures,
}

impl PacketCells {
    /// Begins a packet, which intersects the balls of these tetrahedra. Cells without a size get no list and
    /// are left out.
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
        self.corner_numbers.clear();
        self.site_numbers.clear();
        self.corners.clear();
        self.neighbours.clear();
        self.tetrahedra.clear();
        self.near_counts.clear();
        self.sites_of_corners.clear();
        let push = |points: &mut CornerPoints, tetrahedron: u32| {
            let corner = &corners.all[tetrahedron as usize];
            points.push(corner.position, corner.radius + corner.error + slack, corner.error);
        };
        for &tetrahedron in near_tetrahedra {
            let vertices = delaunay.tetrahedra()[tetrahedron as usize];
            let numbers = vertices.map(|site| {
                let (number, is_new) = self.site_numbers.number(site);
                if is_new {
                    self.near_counts.push((sizes[site as usize].is_some(), 0));
                }
                number
            });
            if numbers.iter().any(|number| self.near_counts[*number as usize].0) {
                self.corner_numbers.number(tetrahedron);
                push(&mut self.corners, tetrahedron);
                self.tetrahedra.push(vertices);
                self.sites_of_corners.push(numbers);
                numbers.iter().for_each(|number| self.near_counts[*number as usize].1 += 1);
            }
        }
        self.collect_corners_of_cells();
        let near = self.tetrahedra.len();
        for corner in 0..near {
            let neighbours = delaunay.neighbours()[self.corner_numbers.keys()[corner] as usize];
            let has_list = self.sites_of_corners[corner].map(|number| self.near_counts[number as usize].0);
            self.neighbours.push(std::array::from_fn(|face| {
                // The edge belongs to the cells of the three vertices of the face. No cell with an unknown corner
                // has a list.
                let is_needed = (0..4).any(|v| v != face && has_list[v]);
                if !is_needed || neighbours[face] == Delaunay::NONE {
                    return Delaunay::NONE;
                }
                let (number, is_new) = self.corner_numbers.number(neighbours[face]);
                if is_new {
                    push(&mut self.corners, neighbours[face]);
                }
                number
            }));
        }
        let tree = cells.tree;
        self.values.compute(&self.corners, &tree.leaves.packets[packet as usize], u16::MAX, tree);
        // The packet does not intersect the balls of the other corners.
        for corner in near..self.corners.positions.len() {
            self.values.raise_above_zero(corner);
        }
        self.find_crossings();
    }

    /// Collects the near corners of each cell that gets a list.
    fn collect_corners_of_cells(&mut self) {
        self.cells.clear();
        let mut first = 0;
        for (&site, (has_list, count)) in self.site_numbers.keys().iter().zip(&mut self.near_counts) {
            if *has_list {
                self.cells.push((site, first..first + *count));
            }
            // The count is the place of the next corner from here on.
            let end = first + if *has_list { *count } else { 0 };
            (*count, first) = (first, end);
        }
        self.corners_of_cells.clear();
        self.corners_of_cells.resize(first, 0);
        for (corner, numbers) in (0..).zip(&self.sites_of_corners) {
            for number in numbers {
                let (has_list, next) = &mut self.near_counts[*number as usize];
                if *has_list {
                    self.corners_of_cells[*next] = corner;
                    *next += 1;
                }
            }
        }
    }

    /// Finds the lanes that each edge from a near corner crosses.
    fn find_crossings(&mut self) {
        let lanes_below = &self.values.lanes_below;
        let near = self.tetrahedra.len();
        self.crossings.clear();
        self.crossings.extend(self.neighbours.iter().zip(lanes_below).enumerate().map(
            |(corner, (neighbours, lanes))| {
                neighbours.map(|other| {
                    let other = other as usize;
                    // [`Delaunay::NONE`] is the number of no corner, so `lanes_below` has no entry for it.
                    let is_first = other >= near || corner < other;
                    lanes_below.get(other).filter(|_| is_first).map_or(0, |others| lanes ^ others)
                })
            },
        ));
    }

    /// Returns the near corners of a cell.
    #[inline(always)]
    fn near_corners(&self, range: Range<usize>) -> impl Iterator<Item = usize> {
        self.corners_of_cells[range].iter().map(|corner| *corner as usize)
    }

    /// Returns the lanes whose value is not above zero at some corner of a cell.
    #[inline(always)]
    fn near_lanes(&self, range: Range<usize>) -> u16 {
        let lanes = self.near_corners(range).fold(0, |lanes, corner| lanes | self.values.lanes_below[corner]);
        lanes & self.values.near_lanes
    }

    /// Computes the points that span the regions of some lanes in a cell.
    #[inline(always)]
    fn find_regions<D: Doubles>(&mut self, site: u32, range: Range<usize>, lanes: u16) {
        for lane in Bits(lanes) {
            self.regions[lane].clear();
        }
        for &corner in &self.corners_of_cells[range] {
            let corner = corner as usize;
            let position = self.corners.positions[corner];
            for lane in Bits(lanes & self.values.lanes_below[corner]) {
                self.regions[lane].push(position);
            }
            for face in 0..4 {
                let crossing = self.crossings[corner][face];
                if crossing & lanes == 0 || self.tetrahedra[corner][face] == site {
                    continue;
                }
                let other = self.neighbours[corner][face] as usize;
                let to = self.corners.positions[other];
                let (from_values, to_values) = (&self.values.values[corner], &self.values.values[other]);
                let mut parts = [0.0; LANES];
                for first in [0, LANES / 2] {
                    let (a, b) = (D::load_f32(&from_values[first..]), D::load_f32(&to_values[first..]));
                    // The part of the edge from the first corner reaches a little beyond the zero of the chord.
                    let beyond = D::select(a.is_at_most(D::splat(0.0)), D::splat(1e-6), D::splat(-1e-6));
                    (a / (a - b) + beyond).store(&mut parts[first..]);
                }
                for lane in Bits(crossing & lanes) {
                    let along = |k: usize| position[k] + parts[lane] * (to[k] - position[k]);
                    self.regions[lane].push([along(0), along(1), along(2)]);
                }
            }
        }
    }

    /// Passes the region of each of some primitives of the packet to `visit`, with the site and the lane. `lanes_of`
    /// returns the lanes to be visited in the cell of a site.
    pub(crate) fn visit_regions(
        &mut self,
        lanes_of: impl Fn(u32) -> u16,
        mut visit: impl FnMut(u32, usize, &RegionPoints),
    ) {
        for number in 0..self.cells.len() {
            let (site, range) = self.cells[number].clone();
            let lanes = lanes_of(site) & self.near_lanes(range.clone());
            self.find_regions::<<Portable as InstructionSet>::Doubles>(site, range, lanes);
            for lane in Bits(lanes) {
                visit(site, lane, &self.regions[lane]);
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
        for (corner, lanes) in
            packet.corners.positions.iter().zip(&packet.values.lanes_below).take(packet.tetrahedra.len())
        {
            packet.lanes_over.push(lanes & packet.over.lanes_below_point::<I::Doubles>(corner));
        }
        for number in 0..packet.cells.len() {
            let (site, range) = packet.cells[number].clone();
            let Some(CellSize { max_distance, max_error }) = sizes[site as usize] else { continue };
            let position = scene.position(site as usize);
            let cell = CellInfo { site: site as usize, position, max_distance, max_error };
            let mut lanes = packet.near_lanes(range.clone());
            let over = packet.near_corners(range.clone()).fold(0, |over, corner| over | packet.lanes_over[corner]);
            packet.find_regions::<I::Doubles>(site, range, lanes & !over);
            for lane in Bits(lanes & !over) {
                if packet.prepared >> lane & 1 == 0 {
                    packet.prepared |= 1 << lane;
                    packet.features[lane].prepare(scene, packet.packet as usize, lane);
                }
                let PacketCells { features, regions, excluded, .. } = &mut *packet;
                if !features[lane].is_relevant::<I::Doubles>(&cell, scene.slack, &regions[lane], excluded) {
                    lanes &= !(1 << lane);
                }
            }
            found.push(PacketInCell { site, packet: packet.packet, lanes });
        }
    }
}

/// The indices of the bits that are set, in ascending order.
struct Bits(u16);

impl Iterator for Bits {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let index = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        (index < LANES).then_some(index)
    }
}

#[cfg(test)]
mod tests {
    use crate::delaunay::Delaunay;
    use crate::voronoi::circumsphere::circumcentre;
    use crate::{P2mIndex, Partition};
    use nalgebra::Point3;
    use p2m_core::engine::vector::V3;
    use p2m_core::{BruteForce, ClosestPoint, Segment, Shape, Triangle};
    use p2m_testkit::{amount, cases, rng, vector};
    use rand::RngExt;

    /// A list has every answer in its cell. Queries are where a wrong region would lack one: at the corners of cells,
    /// on edges between corners, and near both.
    #[test]
    fn lists_have_the_answers_at_corners_and_on_edges_of_cells() {
        let (mut seen, mut others) = (0, 0);
        let cases = cases(60, 12);
        for case in cases.clone() {
            let mut rng = rng("packets in cells", case);
            let step = 2f64.powi(-(case as i32 % 4));
            // Triangles of a rough surface share vertices and edges. Others, and segments, are anywhere.
            let size = 6u32;
            let height: Vec<f64> = (0..(size + 1).pow(2)).map(|_| rng.random_range(0.0..step)).collect();
            let at = |i: u32, j: u32| Point3::new(f64::from(i), f64::from(j), height[(i * (size + 1) + j) as usize]);
            let mut shapes: Vec<Shape<f64>> = Vec::new();
            for (i, j) in (0..size).flat_map(|i| (0..size).map(move |j| (i, j))) {
                shapes.push(Triangle::new(at(i, j), at(i + 1, j), at(i + 1, j + 1)).into());
                shapes.push(Triangle::new(at(i, j), at(i + 1, j + 1), at(i, j + 1)).into());
            }
            for _ in 0..case % 3 * 20 {
                let a = Point3::from(vector(&mut rng) * 4.0);
                let [b, c] = [(); 2].map(|()| a + vector(&mut rng));
                shapes.push(if rng.random() { Triangle::new(a, b, c).into() } else { Segment::new(a, b).into() });
            }
            let index = P2mIndex::<f64, &[Shape<f64>]>::new(&shapes[..]).expect("valid");
            let brute = BruteForce::new(&shapes[..]).expect("valid");
            let vertices: Vec<V3> = shapes
                .iter()
                .flat_map(|shape| shape.vertices().iter().map(|v| v.coords.into()).collect::<Vec<V3>>())
                .collect();
            let delaunay = Delaunay::new(&vertices, 300.0).expect("finite");
            let position = |site: u32| delaunay.sites()[site as usize].map(|x| x * delaunay.unit());
            let centres: Vec<Option<V3>> = delaunay
                .tetrahedra()
                .iter()
                .map(|tetrahedron| circumcentre(&tetrahedron.map(position)).map(|centre| centre.position))
                .collect();
            for (tetrahedron, neighbours) in delaunay.neighbours().iter().enumerate() {
                for other in neighbours.iter().filter(|other| **other != Delaunay::NONE) {
                    let (Some(a), Some(b)) = (centres[tetrahedron], centres[*other as usize]) else { continue };
                    for _ in 0..amount(16, 4) {
                        let t = rng.random_range(0.0..1.0);
                        let aside = vector(&mut rng) * 2f64.powi(-rng.random_range(4..40));
                        let query = Point3::from(std::array::from_fn(|k| a[k] + t * (b[k] - a[k]))) + aside;
                        let (Some(list), Some(answer)) = (index.partition().list(&query), brute.closest_point(&query))
                        else {
                            continue;
                        };
                        assert!(list.contains(&answer.primitive), "case {case}: {query} {answer:?} {list:?}");
                        seen += 1;
                        others += shapes.len() - list.len();
                    }
                }
            }
        }
        assert!(cases.have_more_than(300_000, seen) && others > 10 * seen, "{seen} {others}");
    }
}
