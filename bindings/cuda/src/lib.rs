//! Closest points of scenes on an NVIDIA card, with the bits of [`AabbTree`].
//!
//! [`CudaIndex`] copies a scene with its tree to the card, and makes *interception lists* there: for each cell of an
//! octree the primitives that can be nearest somewhere in it. A query reads the list of its cell; outside the lists it
//! searches the tree. Distances in f32 with a proved error find the candidates, and the kernel of the contract, in f64
//! and in the same order of operations, decides between them. What that kernel leaves to slower code, such as slivers
//! and extreme scales, is answered by the processor. So distance, primitive, point, feature and weights are those of
//! [`AabbTree`], bit for bit. The proofs are in docs/proofs/cuda.md.
//!
//! ```no_run
//! use p2m_bvh::AabbTree;
//! use p2m_core::Soup;
//! use p2m_core::batch::ClosestColumns;
//! use p2m_cuda::{CudaIndex, CudaOptions};
//!
//! let scene: Soup = Soup::from_arrays(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]])?;
//! let index = CudaIndex::new(AabbTree::new(scene)?, &CudaOptions::default())?;
//! let queries = vec![nalgebra::Point3::new(0.25, 0.25, 2.0); 1_000_000];
//! let mut distance = vec![0.0; queries.len()];
//! let columns = ClosestColumns::default().with_distance(&mut distance);
//! index.closest_columns_into(&queries, f64::INFINITY, columns)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The driver is loaded when an index is made, so programs start without one.

mod card;
mod engine;
mod error;
#[cfg(test)]
mod host;
mod lists;
mod raw;
mod scene;
#[cfg(test)]
mod tests;

pub use error::CudaError;

use bytemuck::{Pod, cast_slice_mut};
use card::{Card, CudaCard};
use engine::Engine;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::{self, BatchOptions, ClosestColumns};
use p2m_core::{Feature, PrimitiveSet, QueryOptions, Real};
use scene::Scene;
use std::time::Duration;

/// Options of an index on a card.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CudaOptions {
    /// The number of the card, from 0. The default is 0.
    pub ordinal: usize,
    /// The size of the space with lists, in boxes of the scene around its centre: 10.5 by default. Queries farther away
    /// search the tree. Below 1 and above 10^6 there are lists for the box alone.
    pub reach: f64,
    /// The most bytes that lists may take, up to 4 GB. The default is about 280 for each primitive, and more in scenes of
    /// more than 100,000. While lists are made, the card needs twice as many, and up to 400 for each cell of a level.
    pub memory: Option<usize>,
    /// Whether queries are sorted on the card. Sorting is wasted on queries whose order is spatially coherent.
    pub reorder: bool,
}

impl Default for CudaOptions {
    fn default() -> Self {
        Self { ordinal: 0, reach: 10.5, memory: None, reorder: true }
    }
}

/// How the queries of a batch were answered.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct BatchReport {
    /// The number of queries that have no list and were answered by the tree on the card.
    pub by_tree: usize,
    /// The number of queries that the processor has answered.
    pub by_processor: usize,
    /// The time of the kernels on the card, sorting included, without transfers.
    pub kernels: Duration,
}

/// An index on a card: a tree with its scene, and interception lists.
pub struct CudaIndex<T: Real, S> {
    index: OnCard<T, S, CudaCard>,
    reorder: bool,
}

impl<T: Real + Pod, S: PrimitiveSet<T> + Sync> CudaIndex<T, S> {
    /// Copies a tree with its scene to a card, and makes the lists there.
    ///
    /// # Errors
    /// Returns a [`CudaError`] if there is no driver or no such card, if the memory of the card does not suffice, for an
    /// empty scene, for primitives without vertices, and for scenes whose size is not within 2^-320..2^300.
    pub fn new(tree: AabbTree<T, S>, options: &CudaOptions) -> Result<Self, CudaError> {
        let card = CudaCard::open(options.ordinal)?;
        Ok(Self { index: OnCard::new(card, tree, options)?, reorder: options.reorder })
    }

    /// The tree, which answers single queries and those of other kinds.
    pub fn tree(&self) -> &AabbTree<T, S> {
        &self.index.tree
    }

    /// The bytes of the scene and of its lists on the card.
    pub fn memory(&self) -> [usize; 2] {
        self.index.engine.memory()
    }

    /// The number of cells without a list, whose queries search the tree.
    pub fn cells_without_list(&self) -> u64 {
        self.index.engine.cells_without_list()
    }

    /// Answers queries into columns, in their order, with the values of [`batch::closest_columns_into`] apart from lower
    /// bounds, which are valid but may differ.
    ///
    /// The card holds four million queries at a time, for which it needs up to 500 MB besides the index.
    ///
    /// # Errors
    /// Returns a [`CudaError`] if the card fails, or if its memory does not suffice. Columns then have any content.
    ///
    /// # Panics
    /// Panics if a column has another length than `queries`, and for more than 2^32 - 1 queries.
    pub fn closest_columns_into(
        &self,
        queries: &[Point3<T>],
        max_distance: T,
        columns: ClosestColumns<'_, T>,
    ) -> Result<BatchReport, CudaError> {
        self.index.closest_columns_into(queries, max_distance, self.reorder, columns)
    }
}

/// A tree, and its scene on a card.
struct OnCard<T: Real, S, C: Card> {
    tree: AabbTree<T, S>,
    engine: Engine<C>,
}

impl<T: Real + Pod, S: PrimitiveSet<T> + Sync, C: Card> OnCard<T, S, C> {
    fn new(card: C, tree: AabbTree<T, S>, options: &CudaOptions) -> Result<Self, CudaError> {
        let engine = Engine::new(card, &Scene::new(&tree)?, options.reach, options.memory)?;
        Ok(Self { tree, engine })
    }

    fn closest_columns_into(
        &self,
        queries: &[Point3<T>],
        max_distance: T,
        reorder: bool,
        mut columns: ClosestColumns<'_, T>,
    ) -> Result<BatchReport, CudaError> {
        let Some(len) = columns.len() else { return Ok(BatchReport::default()) };
        assert!(queries.len() == len && u32::try_from(len).is_ok(), "one value for each of fewer than 2^32 queries");
        let mut features = vec![0; columns.feature.as_ref().map_or(0, |column| column.len())];
        let answers = [
            cast_slice_mut(columns.distance.as_deref_mut().unwrap_or_default()),
            cast_slice_mut(columns.lower_bound.as_deref_mut().unwrap_or_default()),
            cast_slice_mut(columns.point.as_deref_mut().unwrap_or_default()),
            cast_slice_mut(columns.barycentric.as_deref_mut().unwrap_or_default()),
            cast_slice_mut(columns.primitive.as_deref_mut().unwrap_or_default()),
            features.as_mut_slice(),
        ];
        let mut report = BatchReport::default();
        let radius = max_distance.to_f64_above();
        let undecided = self.engine.answer(queries, radius, reorder, answers, &mut report)?;
        if let Some(column) = &mut columns.feature {
            let feature = |code| Feature::from_code(code).unwrap_or(Feature::Vertex(0));
            column.iter_mut().zip(&features).for_each(|(to, code)| *to = feature(*code));
        }
        self.decide(queries, max_distance, &undecided, &mut columns);
        Ok(report)
    }

    /// Answers queries that the card has left by the tree of the processor.
    fn decide(&self, queries: &[Point3<T>], max_distance: T, numbers: &[u32], columns: &mut ClosestColumns<'_, T>) {
        let left: Vec<Point3<T>> = numbers.iter().map(|&i| queries[i as usize]).collect();
        let options = QueryOptions::default().with_max_distance(max_distance);
        macro_rules! columns {
            ($($column:ident: $method:ident, $default:expr;)*) => {
                // A column that is not wanted is not computed.
                $(let mut $column = columns.$column.as_ref().map(|_| vec![$default; left.len()]);)*
                let mut found = ClosestColumns::default();
                $(if let Some(column) = &mut $column { found = found.$method(column); })*
                batch::closest_columns_into(&self.tree, &left, &options, &BatchOptions::default(), found);
                $(if let (Some(to), Some(from)) = (&mut columns.$column, &$column) {
                    numbers.iter().zip(from).for_each(|(&i, value)| to[i as usize] = *value);
                })*
            };
        }
        columns! {
            distance: with_distance, T::zero();
            primitive: with_primitive, 0;
            point: with_point, Point3::origin();
            feature: with_feature, Feature::Face;
            barycentric: with_barycentric, [T::zero(); 3];
            lower_bound: with_lower_bound, T::zero();
        }
    }
}
