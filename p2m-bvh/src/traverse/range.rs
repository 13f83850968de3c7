//! Range search: all primitives that may intersect a ball, by the filters of their packets.

use crate::packet::{LANES, ROUND_UP, at_most};
use crate::traverse::{Visitor, traverse};
use crate::tree::PacketTree;
use crate::tree::wide_node::{VolumeNodes, WideNode, lower_bounds};
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use std::ops::ControlFlow;

/// Selected lanes of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Selection {
    /// The number of the packet.
    pub packet: u32,
    /// One bit per lane: whether it is selected.
    pub lanes: u16,
}

impl<V: VolumeNodes> PacketTree<V> {
    /// Appends to `found` the lanes whose primitives may be at most `radius` away from a point. No primitive within the
    /// radius is missing, unless the primitives are in more than `most` packets.
    ///
    /// Returns `false` if there are more packets than that, or if f32 cannot represent the point with enough accuracy.
    /// `tests` is increased by the number of tested nodes and packets.
    pub fn ball(
        &self,
        centre: [f64; 3],
        radius: f64,
        most: usize,
        found: &mut Vec<Selection>,
        tests: &mut usize,
    ) -> bool {
        let Some(local) = V::Node::query(&self.shared, &self.frame, &centre) else { return false };
        let limit = self.frame.square_above(radius * radius * (1.0 + 4.0 * f64::EPSILON));
        let search = BallSearch {
            tree: self,
            local,
            centre,
            radius,
            limit,
            remaining_packets: most,
            is_incomplete: false,
            found,
            tests,
        };
        self.isa.run(search)
    }
}

/// A range search as a kernel that is compiled for each instruction set.
struct BallSearch<'a, V: VolumeNodes> {
    tree: &'a PacketTree<V>,
    local: <V::Node as WideNode>::Query,
    centre: [f64; 3],
    radius: f64,
    /// The square of the radius in the frame of the tree, rounded up.
    limit: f32,
    /// The number of packets that may still be added.
    remaining_packets: usize,
    /// Whether the search stopped because there are more packets.
    is_incomplete: bool,
    found: &'a mut Vec<Selection>,
    /// The number of tested nodes and packets.
    tests: &'a mut usize,
}

impl<V: VolumeNodes> SimdKernel for BallSearch<'_, V> {
    type Output = bool;

    #[inline(always)]
    fn run<I: InstructionSet>(mut self) -> bool {
        traverse::<I, V, _>(self.tree, &mut self);
        !self.is_incomplete
    }
}

impl<V: VolumeNodes> Visitor<V> for BallSearch<'_, V> {
    #[inline(always)]
    fn bounds<L: Lanes>(&self, node: &V::Node) -> L {
        lower_bounds(node, &self.tree.shared, &self.local)
    }
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.limit
    }
    #[inline(always)]
    fn visit_node(&mut self) {
        *self.tests += 1;
    }
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up; sixteen lanes")]
    fn visit_packet<I: InstructionSet>(&mut self, number: usize) -> ControlFlow<()> {
        *self.tests += 1;
        let packet = &self.tree.leaves.packets[number];
        let lanes = match packet.local(&self.centre) {
            None => packet.lanes(),
            Some(local) => {
                let limit = ((self.radius * packet.per_unit()) as f32 + local.excess) * ROUND_UP;
                let mut squares = [0.0; LANES];
                packet.squares::<I>(&local, limit, &mut squares);
                at_most::<I::Wide>(&squares, limit * limit * ROUND_UP) & packet.lanes()
            }
        };
        if lanes != 0 {
            let Some(remaining) = self.remaining_packets.checked_sub(1) else {
                self.is_incomplete = true;
                return ControlFlow::Break(());
            };
            self.remaining_packets = remaining;
            self.found.push(Selection { packet: number as u32, lanes: lanes as u16 });
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::construct::SplitOptions;
    use nalgebra::{Point3, Vector3};
    use p2m_core::{Aabb, Isa, Primitive, Segment, Triangle};
    use p2m_testkit::vector;
    use rand::RngExt;

    /// Balls find everything within their radius and little else, and a search with too small a limit on packets
    /// returns `false`.
    #[test]
    fn balls_find_the_primitives_that_they_intersect() {
        let (mut expected_total, mut others) = (0, 0);
        let cases = p2m_testkit::cases(60, 15);
        for round in cases.clone() {
            let mut rng = p2m_testkit::rng("balls", round);
            let scale = 2f64.powi([0, 40, -200][(round % 3) as usize]);
            let mut point = |around: &Vector3<f64>, size: f64| Point3::from((around + vector(&mut rng) * size) * scale);
            let set: Vec<p2m_core::Shape<f64>> = (0..400)
                .map(|i| {
                    let around = Vector3::from_fn(|k, _| (f64::from(i) * (1.0 + k as f64)).sin());
                    let [a, b, c] = [(); 3].map(|()| point(&around, 0.1));
                    if i % 3 == 0 { Segment::new(a, b).into() } else { Triangle::new(a, b, c).into() }
                })
                .collect();
            let tree = PacketTree::<Aabb<f64>>::build(&set[..], &SplitOptions::default());
            for _ in 0..20 {
                let centre = Point3::from(vector(&mut rng) * scale * 2f64.powi(rng.random_range(-2..6)));
                let distances: Vec<f64> = set.iter().map(|s| s.project(&centre).key.distance()).collect();
                let radius = distances[rng.random_range(0..distances.len())];
                let expected = distances.iter().filter(|d| **d <= radius).count();
                for isa in Isa::available() {
                    let tree = tree.clone().with_isa(isa);
                    let (mut found, mut tests) = (Vec::new(), 0);
                    assert!(tree.ball(centre.coords.into(), radius, usize::MAX, &mut found, &mut tests));
                    let mut ids = vec![false; set.len()];
                    for Selection { packet, lanes } in &found {
                        let packet_ids = tree.leaves.packets[*packet as usize].ids();
                        packet_ids
                            .iter()
                            .enumerate()
                            .filter(|(l, _)| lanes >> l & 1 == 1)
                            .for_each(|(_, id)| ids[id.index()] = true);
                    }
                    assert!(distances.iter().zip(&ids).all(|(d, found)| *found || *d > radius), "{isa} {round}");
                    expected_total += expected;
                    others += ids.iter().filter(|found| **found).count() - expected;
                    let packets = found.len();
                    assert!(tests >= packets, "{tests}");
                    found.clear();
                    assert!(!tree.ball(centre.coords.into(), radius, packets - 1, &mut found, &mut tests), "{packets}");
                    found.clear();
                    assert!(tree.ball(centre.coords.into(), radius, packets, &mut found, &mut tests));
                }
            }
        }
        let least = 35_000 * Isa::available().len();
        assert!(
            cases.have_more_than(least, expected_total) && (cases.is_replay() || others * 50 < expected_total),
            "{expected_total} {others}"
        );
    }
}
