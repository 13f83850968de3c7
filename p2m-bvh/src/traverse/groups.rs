//! The division of a batch into groups of interleaved searches.

use crate::traverse::interleaved_search::{InterleavedSearch, SEARCHES};
use crate::traverse::primitive_fn::EvaluateFn;
use crate::tree::PacketTree;
use crate::volume::Volume;
use nalgebra::Point3;
use p2m_core::engine::query::BestF64;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;
use p2m_core::{BatchAnswer, Best, Collector, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, Real};
use std::cell::Cell;

/// Answers queries in groups, and calls `answered` once per query with its position and its answer. `search` runs the
/// first `count` searches of the state; `count` is its first argument. The options have to be exact.
///
/// Queries that are not finite have no answer. The others are gathered into full groups without them.
pub fn answer_in_groups<T: Real, S: PrimitiveSet<T>, V: Volume>(
    tree: &PacketTree<V>,
    set: &S,
    queries: &[Point3<T>],
    options: &QueryOptions<T>,
    answered: &mut dyn FnMut(usize, BatchAnswer<'_, T>),
    mut search: impl FnMut(usize, &mut InterleavedSearch<'_>),
) {
    let template = Best::new(options);
    let mut group = [0; SEARCHES];
    let points = [(); SEARCHES].map(|()| Cell::new(Point3::origin()));
    let evaluate = |search: usize, best: &mut BestF64, id: PrimitiveId, square: f64| {
        if let Some(projection) = set.get(id).project_within(&points[search].get(), square) {
            best.offer(id, projection);
        }
    };
    let search_tree = |query: V3, best: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>| {
        V::nearest(tree, query, best, evaluate);
    };
    let mut several =
        InterleavedSearch::new(&tree.leaves, &tree.frame, tree.isa, &search_tree, template.minimum_ref(), &evaluate);
    let mut numbers = 0..queries.len();
    loop {
        let mut count = 0;
        for number in &mut numbers {
            let query = &queries[number];
            if !query.iter().all(|x| x.is_finite()) {
                answered(number, template.found());
                continue;
            }
            several.minimums()[count].clone_from(template.minimum_ref());
            if options.hint.is_some() {
                let mut best = template.clone();
                best.offer_hint(set, query);
                several.minimums()[count].clone_from(best.minimum_ref());
            }
            group[count] = number;
            points[count].set(*query);
            several.begin(count, to_f64_array(query));
            count += 1;
            if count == SEARCHES {
                break;
            }
        }
        search(count, &mut several);
        for (number, minimum) in group[..count].iter().zip(several.minimums()) {
            answered(*number, BatchAnswer::new(minimum));
        }
        if count < SEARCHES {
            return;
        }
    }
}
