//! k-DOPs as the bounding volumes of a tree.
//!
//! A generic function is compiled in each crate that calls it, unless a crate upstream has compiled it for the same
//! parameters and it is never inlined. The searches of trees with 6, 14, 18 and 26 faces are such functions:
//! [`COMPILED_SEARCHES`] names them, so this crate compiles them and its users need not.

use crate::direction_table::DirectionTable;
use crate::node::KdopNode;
use crate::{Directions, Kdop, KdopOptions};
use nalgebra::Vector3;
use p2m_bvh::engine::interleaved::{InterleavedSearch, InterleavedTraversal};
use p2m_bvh::engine::nearest::{EvaluateFn, finish, finish_nearest};
use p2m_bvh::engine::pairs::TreeSide;
use p2m_bvh::engine::ray::IntersectFn;
use p2m_bvh::engine::volume::{TreeOptions, VolumeNodes};
use p2m_bvh::{PacketTree, SplitOptions, Volume};
use p2m_core::engine::pairs::PairSide;
use p2m_core::engine::query::{BestF64, CountedMinimum};
use p2m_core::engine::ray::RayCandidates;
use p2m_core::engine::vector::V3;
use p2m_core::pair::Motion;
use p2m_core::storage::{LoadError, Reader, Writer, require};
use p2m_core::{Hits, Near, Ray};

impl<const K: usize> Volume for Kdop<K> {
    type Options = KdopOptions<K>;
    type Directions = Directions<K>;

    fn directions(table: &DirectionTable<K>) -> &Directions<K> {
        &table.directions
    }

    #[inline(never)]
    fn nearest(tree: &PacketTree<Self>, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>) {
        tree.run(query, minimum, evaluate, finish_nearest);
    }

    #[inline(never)]
    fn nearest_of_several(
        tree: &PacketTree<Self>,
        walkers: &mut InterleavedTraversal<Self>,
        several: &mut InterleavedSearch<'_, Self>,
        count: usize,
    ) {
        walkers.search(tree, several, count);
    }

    #[inline(never)]
    fn counted<'c>(
        tree: &PacketTree<Self>,
        query: V3,
        counted: &mut CountedMinimum<'c>,
        evaluate: EvaluateFn<'_, CountedMinimum<'c>>,
    ) {
        tree.run(query, counted, evaluate, finish);
    }

    #[inline(never)]
    fn near<'n>(tree: &PacketTree<Self>, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        tree.run(query, near, evaluate, finish);
    }

    #[inline(never)]
    fn rays<'r>(
        tree: &PacketTree<Self>,
        ray: &'r Ray,
        radius: f64,
        hits: &mut Hits<'r>,
        intersect: IntersectFn<'_, 'r>,
    ) {
        tree.run_ray(ray, radius, hits, intersect);
    }

    #[inline(never)]
    fn ray_candidates(tree: &PacketTree<Self>, ray: &Ray, radius: f64, candidates: &mut RayCandidates<'_>) {
        tree.run_ray(ray, radius, candidates, &|_, _| None);
    }

    #[inline(never)]
    fn as_pair_side(tree: &PacketTree<Self>, motions: &[Motion], search: &mut dyn FnMut(&dyn PairSide)) {
        search(&TreeSide::new(tree, motions));
    }
}

/// The section of a file that has the normals, as three numbers each.
const DIRECTIONS_SECTION: &str = "tree/directions";
/// The section of a file that has 1 if the first three directions are orthogonal, and 0 otherwise.
const ORTHOGONAL_SECTION: &str = "tree/orthogonal";

impl<const K: usize> VolumeNodes for Kdop<K> {
    type Shared = DirectionTable<K>;
    type Node = KdopNode<K>;

    fn name() -> String {
        format!("kdop-{K}")
    }
    fn save_shared(table: &DirectionTable<K>, writer: &mut Writer<'_>) {
        let normals = table.directions.normals().map(<[f64; 3]>::from);
        writer.put_copy(DIRECTIONS_SECTION, normals.as_flattened());
        writer.put_copy(ORTHOGONAL_SECTION, &[u8::from(table.directions.starts_orthogonal())]);
    }
    fn load_shared(reader: &Reader) -> Result<DirectionTable<K>, LoadError> {
        let numbers = reader.array::<f64>(DIRECTIONS_SECTION)?;
        let is_orthogonal = reader.one::<u8>(ORTHOGONAL_SECTION)?;
        require(is_orthogonal <= 1, ORTHOGONAL_SECTION, "the number is neither 0 nor 1")?;
        let (normals, rest) = numbers.as_chunks::<3>();
        let normals: Vec<Vector3<f64>> = normals.iter().copied().map(Vector3::from).collect();
        let directions = Directions::from_normals(&normals, is_orthogonal == 1).filter(|_| rest.is_empty());
        let directions =
            directions.ok_or_else(|| LoadError::inconsistent(DIRECTIONS_SECTION, "they bound no polytope"))?;
        Ok(DirectionTable::new(&directions))
    }
}

/// The searches of a tree of k-DOPs with K faces.
type Searches<const K: usize> = (
    fn(&PacketTree<Kdop<K>>, V3, &mut BestF64, EvaluateFn<'_, BestF64>),
    fn(&PacketTree<Kdop<K>>, &mut InterleavedTraversal<Kdop<K>>, &mut InterleavedSearch<'_, Kdop<K>>, usize),
    for<'c> fn(&PacketTree<Kdop<K>>, V3, &mut CountedMinimum<'c>, EvaluateFn<'_, CountedMinimum<'c>>),
    for<'n> fn(&PacketTree<Kdop<K>>, V3, &mut Near<'n>, EvaluateFn<'_, Near<'n>>),
    for<'r> fn(&PacketTree<Kdop<K>>, &'r Ray, f64, &mut Hits<'r>, IntersectFn<'_, 'r>),
    fn(&PacketTree<Kdop<K>>, &Ray, f64, &mut RayCandidates<'_>),
    fn(&PacketTree<Kdop<K>>, &[Motion], &mut dyn FnMut(&dyn PairSide)),
);

const fn searches<const K: usize>() -> Searches<K> {
    (
        Kdop::<K>::nearest,
        Kdop::<K>::nearest_of_several,
        Kdop::<K>::counted,
        Kdop::<K>::near,
        Kdop::<K>::rays,
        Kdop::<K>::ray_candidates,
        Kdop::<K>::as_pair_side,
    )
}

/// The searches that this crate compiles: those for 6, 14, 18 and 26 faces, which have default directions.
#[doc(hidden)]
pub static COMPILED_SEARCHES: (Searches<6>, Searches<14>, Searches<18>, Searches<26>) =
    (searches(), searches(), searches(), searches());

impl<const K: usize> TreeOptions<DirectionTable<K>> for KdopOptions<K> {
    fn splits(&self) -> &SplitOptions {
        &self.splits
    }
    fn shared(&self) -> DirectionTable<K> {
        DirectionTable::new(&self.directions)
    }
}
