//! Candidates: what can hold the answer in a cell.

use crate::list::corner_test::BoxTest;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::node::NodeRef;
use p2m_core::Aabb;

/// The number of candidates up to which nodes are opened. On dragon_871k, other numbers changed the time of the build
/// by less than its noise, and 256 made 9 % more cells (docs/decisions/058-passes-of-rising-resolution.md).
const MAX_OPENED: usize = 512;

/// A node or a packet of the tree that can hold the answer in a cell.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    /// The box around it.
    pub(crate) bounds: Aabb<f64>,
    /// The node or the packet.
    pub(crate) child: NodeRef,
    /// The node of which it is a child, or [`NodeRef::NONE`] for the root of the tree.
    pub(crate) parent: NodeRef,
    /// The index of the packet among the candidates of the parent.
    pub(crate) index: u32,
    /// The lanes of the packet that can hold the answer, as bits.
    pub(crate) lanes: u16,
}

impl Candidate {
    /// Returns the root of a tree.
    pub(crate) fn root(tree: &PacketTree) -> Self {
        Self { bounds: *tree.bounds(), child: tree.root, parent: NodeRef::NONE, index: 0, lanes: u16::MAX }
    }
}

/// Opens the candidates of a cell until all are packets, or until there are too many. Returns whether all are packets.
pub(crate) fn open_candidates(tree: &PacketTree, test: &BoxTest, candidates: &mut Vec<Candidate>) -> bool {
    candidates.retain(|c| test.keeps(&c.bounds));
    while candidates.len() <= MAX_OPENED {
        if candidates.iter().all(|candidate| candidate.child.is_packet()) {
            return true;
        }
        let mut opened = Vec::with_capacity(2 * candidates.len());
        for candidate in &*candidates {
            if candidate.child.is_packet() {
                opened.push(*candidate);
            } else {
                for (bounds, child) in tree.child_boxes(candidate.child) {
                    if test.keeps(&bounds) {
                        opened.push(Candidate { bounds, child, parent: candidate.child, ..*candidate });
                    }
                }
            }
        }
        *candidates = opened;
    }
    false
}

/// A candidate of an open cell. It has no box, because open cells may have most of the candidates in memory.
pub(crate) struct OpenCandidate {
    child: NodeRef,
    parent: NodeRef,
    lanes: u16,
}

impl From<&Candidate> for OpenCandidate {
    fn from(&Candidate { child, parent, lanes, .. }: &Candidate) -> Self {
        Self { child, parent, lanes }
    }
}

impl OpenCandidate {
    /// Returns the candidate with its box.
    pub(crate) fn with_box(&self, tree: &PacketTree) -> Candidate {
        let &Self { child, parent, lanes } = self;
        let found = (parent != NodeRef::NONE).then(|| tree.child_boxes(parent).find(|(_, c)| *c == child));
        let bounds = found.flatten().map_or(*tree.bounds(), |(bounds, _)| bounds);
        Candidate { bounds, child, parent, index: 0, lanes }
    }
}
