//! k-DOPs as the volumes of a tree.
//!
//! Searches of trees with the usual numbers of faces, those of CGAL's package, are compiled once, in this crate: the
//! compiler reuses the code of a generic function that is never inlined and that an upstream crate has already
//! instantiated ([`USUAL`]).

use crate::heights::Slabs;
use crate::node::SlabNode;
use crate::{Directions, Kdop, KdopOptions};
use nalgebra::Vector3;
use p2m_bvh::engine::nearest::{EvaluateFn, finish, finish_nearest};
use p2m_bvh::engine::ray::Intersect;
use p2m_bvh::engine::volume::{Nodes, TreeOptions};
use p2m_bvh::{PacketTree, SplitOptions, Volume};
use p2m_core::engine::query::BestF64;
use p2m_core::engine::vector::V3;
use p2m_core::storage::{LoadError, Reader, Writer};
use p2m_core::{Aabb, Hits, Near, Ray};

impl<const K: usize> Volume for Kdop<K> {
    type Options = KdopOptions<K>;
    type Directions = Directions<K>;

    fn directions(shape: &Slabs<K>) -> &Directions<K> {
        &shape.directions
    }

    fn may_meet_box(&self, directions: &Directions<K>, bounds: &Aabb<f64>) -> bool {
        Kdop::may_meet_box(self, directions, bounds)
    }
}

const DIRECTIONS: &str = "tree/directions";
const ORTHOGONAL: &str = "tree/orthogonal";

impl<const K: usize> Nodes for Kdop<K> {
    type Shape = Slabs<K>;
    type Node = SlabNode<K>;

    fn name() -> String {
        format!("kdop-{K}")
    }
    fn save_shape(shape: &Slabs<K>, writer: &mut Writer<'_>) {
        let normals = shape.directions.normals().map(<[f64; 3]>::from);
        writer.put_copy(DIRECTIONS, normals.as_flattened());
        writer.put_copy(ORTHOGONAL, &[u8::from(shape.directions.starts_orthogonal())]);
    }
    fn load_shape(reader: &Reader) -> Result<Slabs<K>, LoadError> {
        let numbers = reader.array::<f64>(DIRECTIONS)?;
        let normals: Vec<Vector3<f64>> = numbers.chunks_exact(3).map(Vector3::from_column_slice).collect();
        let directions = Directions::of_normals(&normals, reader.one::<u8>(ORTHOGONAL)? != 0);
        let directions = directions.ok_or_else(|| LoadError::Inconsistent { section: DIRECTIONS.to_owned() })?;
        Ok(Slabs::new(&directions))
    }

    #[inline(never)]
    fn nearest(tree: &PacketTree<Self>, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>) {
        tree.run(query, minimum, evaluate, finish_nearest);
    }

    #[inline(never)]
    fn near<'n>(tree: &PacketTree<Self>, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        tree.run(query, near, evaluate, finish);
    }

    #[inline(never)]
    fn rays<'r>(tree: &PacketTree<Self>, ray: &'r Ray, radius: f64, hits: &mut Hits<'r>, intersect: Intersect<'_, 'r>) {
        tree.run_ray(ray, radius, hits, intersect);
    }
}

/// The searches of a tree of k-DOPs, which this crate has to have code for if they are named.
type Searches<const K: usize> = (
    fn(&PacketTree<Kdop<K>>, V3, &mut BestF64, EvaluateFn<'_, BestF64>),
    for<'n> fn(&PacketTree<Kdop<K>>, V3, &mut Near<'n>, EvaluateFn<'_, Near<'n>>),
    for<'r> fn(&PacketTree<Kdop<K>>, &'r Ray, f64, &mut Hits<'r>, Intersect<'_, 'r>),
);

const fn searches<const K: usize>() -> Searches<K> {
    (Kdop::<K>::nearest, Kdop::<K>::near, Kdop::<K>::rays)
}

/// The searches for the usual numbers of faces.
#[doc(hidden)]
pub static USUAL: (Searches<6>, Searches<14>, Searches<18>, Searches<26>) =
    (searches(), searches(), searches(), searches());

impl<const K: usize> TreeOptions<Slabs<K>> for KdopOptions<K> {
    fn splits(&self) -> &SplitOptions {
        &self.splits
    }
    fn shape(&self) -> Slabs<K> {
        Slabs::new(&self.directions)
    }
}
