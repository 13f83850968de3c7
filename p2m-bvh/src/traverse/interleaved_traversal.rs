//! The traversal of a tree by interleaved searches.
//!
//! In each round every search takes the nearest of its pending children and prefetches its memory. Then all nodes are
//! bounded, and then all packets are filtered. So the memory has arrived by then, and the loops have no branch that
//! depends on the kind of a child.
//!
//! Groups follow each other along a curve, so the last answer of a group limits the searches of the next one. The
//! limits show which part of the tree the group needs at all, and its searches begin at the node that contains this
//! part.

use crate::traverse::interleaved_search::{InterleavedSearch, PacketVisit, ROUND_UP_F64, SEARCHES};
use crate::traverse::{SHORT_STACK_DEPTH, SHORT_STACK_LEN};
use crate::tree::PacketTree;
use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::wide_node::{VolumeNodes, WideNode, lower_bounds};
use p2m_core::engine::simd::{EightLanes, InstructionSet, SimdKernel, lane_of_key, value_of_key};
use p2m_core::engine::vector::{V3, norm_squared, power_of_two, sub};

/// The pending children of a search.
#[derive(Clone, Copy)]
struct Stack {
    /// The key of each pending child, which combines its bound and its slot.
    keys: [u32; SHORT_STACK_LEN],
    /// The node to which each pending child belongs.
    parents: [u32; SHORT_STACK_LEN],
    len: usize,
    /// The child that is visited next.
    next: NodeRef,
}

/// An answered query.
#[derive(Clone, Copy)]
struct Answered {
    query: V3,
    distance: f64,
}

impl Answered {
    /// Returns an upper bound on the distance at another query, by the triangle inequality and with a margin for the
    /// errors of both distances.
    ///
    /// A computed distance d errs by at most 8 u M, where M is the largest distance of a vertex of its primitive
    /// (docs/proofs/accuracy.md, N1). The scene is in a cube with sides of at most 8 units, so M <= d + 14 units, and
    /// both errors and the roundings here are below 2^-48 (d + 14 units).
    #[inline(always)]
    fn upper_bound_at(&self, query: &V3, unit: f64) -> f64 {
        let distance = self.distance + norm_squared(sub(*query, self.query)).sqrt();
        distance + (distance + 16.0 * unit) * power_of_two(-47)
    }
}

/// The traversals of interleaved searches. They are large, so a batch creates them once for all of its queries.
pub struct InterleavedTraversal<V: VolumeNodes> {
    stacks: [Stack; SEARCHES],
    /// The last query of the previous group with its distance, if it has an answer.
    last: Option<Answered>,
    /// The query point of each search in the frame of the tree.
    queries: Vec<Option<<V::Node as WideNode>::Query>>,
}

impl<V: VolumeNodes> InterleavedTraversal<V> {
    /// Creates traversals that have not begun, or returns `None` if the tree is too deep for their stacks, or empty.
    pub fn new(tree: &PacketTree<V>) -> Option<Self> {
        let stack = Stack { keys: [0; SHORT_STACK_LEN], parents: [0; SHORT_STACK_LEN], len: 0, next: NodeRef::NONE };
        let walkers = || Self { stacks: [stack; SEARCHES], last: None, queries: Vec::with_capacity(SEARCHES) };
        (tree.depth <= SHORT_STACK_DEPTH && tree.root != NodeRef::NONE).then(walkers)
    }

    /// Runs the first `count` searches of `several` in turns.
    #[inline(always)]
    pub fn search(&mut self, tree: &PacketTree<V>, several: &mut InterleavedSearch<'_>, count: usize) {
        tree.isa.run(SearchInTurns { walkers: self, tree, several, count });
    }

    /// Limits the first `count` searches by the last answer, and returns a node from which they may begin: everything
    /// within their limits is below it.
    #[inline(always)]
    fn limit<I: InstructionSet>(
        &self,
        tree: &PacketTree<V>,
        several: &mut InterleavedSearch<'_>,
        count: usize,
    ) -> NodeRef {
        let mut node = tree.root;
        let Some(last) = self.last else { return node };
        let centre = *several.query(count / 2);
        let mut reach = 0.0;
        for search in 0..count {
            let query = *several.query(search);
            let upper_bound = last.upper_bound_at(&query, tree.frame.unit);
            several.limit_to(search, upper_bound);
            // The distance between the query and the centre plus the reach of this search: everything within its limit
            // is within this distance of the centre.
            let from_centre = Answered { query, distance: upper_bound }.upper_bound_at(&centre, tree.frame.unit);
            reach = if from_centre > reach { from_centre } else { reach };
        }
        let Some(query) = V::Node::query(&tree.shared, &tree.frame, &centre) else { return node };
        let limit = tree.frame.square_above(reach * reach * ROUND_UP_F64);
        let mut keys = [0; WIDTH];
        while !node.is_packet() {
            let bounds: I::F32x8 = lower_bounds(&tree.nodes[node.number()], &tree.shared, &query);
            if bounds.sorted_keys(limit, &mut keys) != 1 {
                break;
            }
            node = tree.nodes[node.number()].children()[lane_of_key(keys[0])];
        }
        node
    }
}

/// The traversals of interleaved searches as a kernel that is compiled for each instruction set.
struct SearchInTurns<'a, 'b, V: VolumeNodes> {
    walkers: &'a mut InterleavedTraversal<V>,
    tree: &'a PacketTree<V>,
    several: &'a mut InterleavedSearch<'b>,
    count: usize,
}

impl<V: VolumeNodes> SimdKernel for SearchInTurns<'_, '_, V> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "at most sixteen searches")]
    fn run<I: InstructionSet>(self) {
        let Self { walkers, tree, several, count } = self;
        let start = walkers.limit::<I>(tree, several, count);
        let InterleavedTraversal { stacks, last, queries } = walkers;
        queries.clear();
        // The first `active_count` entries are the searches that go on.
        let mut active = [0u8; SEARCHES];
        let mut active_count = 0;
        for (i, stack) in stacks[..count].iter_mut().enumerate() {
            let query = V::Node::query(&tree.shared, &tree.frame, several.query(i));
            active[active_count] = i as u8;
            active_count += usize::from(query.is_some());
            (stack.len, stack.next) = (0, start);
            if query.is_none() {
                several.search_tree(i);
            }
            queries.push(query);
        }
        let (mut visits, mut nodes) = ([PacketVisit::default(); SEARCHES], [0u8; SEARCHES]);
        while active_count > 0 {
            let (mut visit_count, mut node_count) = (0, 0);
            for &search in &active[..active_count] {
                let child = stacks[usize::from(search) % SEARCHES].next;
                nodes[node_count % SEARCHES] = search;
                node_count += usize::from(!child.is_packet());
                visits[visit_count % SEARCHES] =
                    PacketVisit { search: u32::from(search), packet: child.number() as u32, lanes: u32::MAX };
                visit_count += usize::from(child.is_packet());
            }
            for &search in &nodes[..node_count] {
                let stack = &mut stacks[usize::from(search) % SEARCHES];
                let Some(query) = &queries[usize::from(search)] else { continue };
                let node = &tree.nodes[stack.next.number()];
                let bounds: I::F32x8 = lower_bounds(node, &tree.shared, query);
                let top = stack.len;
                let keys: &mut [u32; WIDTH] = (&mut stack.keys[top..top + WIDTH]).try_into().expect("eight keys");
                stack.len += bounds.sorted_keys(several.limit(usize::from(search)), keys);
                stack.parents[top..top + WIDTH].fill(stack.next.0);
            }
            several.filter::<I, true>(&visits[..visit_count]);
            let mut still_active = 0;
            for at in 0..active_count {
                let search = active[at];
                let stack = &mut stacks[usize::from(search) % SEARCHES];
                let limit = several.limit(usize::from(search));
                let mut is_within = false;
                while stack.len > 0 && !is_within {
                    stack.len -= 1;
                    is_within = value_of_key(stack.keys[stack.len % SHORT_STACK_LEN]) <= limit;
                }
                if is_within {
                    let top = stack.len % SHORT_STACK_LEN;
                    let parent = &tree.nodes[NodeRef(stack.parents[top]).number()];
                    stack.next = parent.children()[lane_of_key(stack.keys[top])];
                    tree.prefetch(stack.next);
                    active[still_active] = search;
                    still_active += 1;
                }
            }
            active_count = still_active;
        }
        several.evaluate_candidates();
        *last = count.checked_sub(1).and_then(|search| {
            let (distance, _) = several.minimums()[search].distance_and_primitive()?;
            Some(Answered { query: *several.query(search), distance })
        });
    }
}
