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
//! let mut columns = ClosestColumns::default().with_distance(&mut distance);
//! index.closest_columns_into(&queries, f64::INFINITY, &mut columns)?;
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

use bytemuck::{Pod, bytes_of, cast_slice, cast_slice_mut};
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
    /// The number of answers of each batch from the memory of the processor that the processor checks: 0 by default.
    pub checked: usize,
}

impl Default for CudaOptions {
    fn default() -> Self {
        Self { ordinal: 0, reach: 10.5, memory: None, reorder: true, checked: 0 }
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
    /// The time of the kernels on the card, sorting included, without transfers. Parts of a batch from the memory of the
    /// processor run at once, so their times overlap.
    pub kernels: Duration,
}

impl BatchReport {
    fn add(&mut self, other: &Self) {
        self.by_tree += other.by_tree;
        self.by_processor += other.by_processor;
        self.kernels += other.kernels;
    }
}

/// Queries on the card, for [`CudaIndex::closest_on_card`].
#[derive(Clone, Copy, Debug)]
pub struct CardQueries {
    /// The address of the first coordinate. Three coordinates of a query follow each other, and the queries do.
    pub address: u64,
    /// The number of queries.
    pub count: usize,
    /// Whether coordinates are f32. Otherwise they have the scalar of the scene.
    pub is_f32: bool,
}

/// The addresses of columns on the card, for [`CudaIndex::closest_on_card`]; 0 for a column that nobody wants.
///
/// The values are those of [`ClosestColumns`], in the scalar of the scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct CardColumns {
    /// The address of the distances.
    pub distance: u64,
    /// The address of the certified lower bounds.
    pub lower_bound: u64,
    /// The address of the closest points, each with three coordinates.
    pub point: u64,
    /// The address of the weights of the vertices, three for each query.
    pub barycentric: u64,
    /// The address of the indices of the primitives, numbers of 32 bits; all bits are 1 where there is no answer.
    pub primitive: u64,
    /// The address of the features, of 8 bits ([`Feature::code`]); 255 where there is no answer.
    pub feature: u64,
}

/// An index on a card: a tree with its scene, and interception lists.
pub struct CudaIndex<T: Real, S> {
    index: OnCard<T, S, CudaCard>,
}

impl<T: Real + Pod, S: PrimitiveSet<T> + Sync> CudaIndex<T, S> {
    /// Copies a tree with its scene to a card, and makes the lists there.
    ///
    /// # Errors
    /// Returns a [`CudaError`] if there is no driver or no such card, if the memory of the card does not suffice, for an
    /// empty scene, for primitives without vertices, and for scenes whose size is not within 2^-320..2^300.
    pub fn new(tree: AabbTree<T, S>, options: &CudaOptions) -> Result<Self, CudaError> {
        let card = CudaCard::open(options.ordinal)?;
        Ok(Self { index: OnCard::new(card, tree, options)? })
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
    /// Queries are divided into parts of about a million. The card holds three parts at a time: while one is copied,
    /// another is searched. For them it needs up to 450 MB besides the index.
    ///
    /// # Errors
    /// Returns a [`CudaError`] if the card fails, if its memory does not suffice, or if an answer that was checked has
    /// other bits ([`CudaOptions::checked`]). Columns then have any content.
    ///
    /// # Panics
    /// Panics if a column has another length than `queries`, and for more than 2^32 - 1 queries.
    pub fn closest_columns_into(
        &self,
        queries: &[Point3<T>],
        max_distance: T,
        columns: &mut ClosestColumns<'_, T>,
    ) -> Result<BatchReport, CudaError> {
        self.index.closest_columns_into(queries, max_distance, columns)
    }

    /// Answers queries that are on the card into columns on the card. It waits for a stream of the caller first, and
    /// returns when all answers are there.
    ///
    /// The card needs 36 bytes for each of up to eight million queries at a time, and 16 MB.
    ///
    /// # Errors
    /// Returns a [`CudaError`] if the card fails, or if its memory does not suffice. Columns then have any content.
    ///
    /// # Panics
    /// Panics for more than 2^32 - 1 queries.
    ///
    /// # Safety
    /// Addresses belong to the primary context of the card of this index. Queries and columns have the sizes that
    /// [`CardQueries`] and [`CardColumns`] say, are aligned to their scalars, and do not overlap. Nothing else writes to
    /// either during the call. The stream is one of that context; 0 is the default stream.
    pub unsafe fn closest_on_card(
        &self,
        queries: &CardQueries,
        max_distance: T,
        stream: u64,
        columns: &CardColumns,
    ) -> Result<BatchReport, CudaError> {
        // SAFETY: the caller says so.
        unsafe { self.index.engine.card().wait_for(stream) }?;
        self.index.closest_on_card(queries, max_distance, columns)
    }
}

/// A tree, and its scene on a card.
struct OnCard<T: Real, S, C: Card> {
    tree: AabbTree<T, S>,
    engine: Engine<C>,
    options: CudaOptions,
}

/// The answers of the processor to some queries. Columns that nobody wants are empty.
struct Answered<T: Real> {
    distance: Vec<T>,
    lower_bound: Vec<T>,
    point: Vec<Point3<T>>,
    barycentric: Vec<[T; 3]>,
    primitive: Vec<u32>,
    feature: Vec<Feature>,
}

impl<T: Real + Pod, S: PrimitiveSet<T> + Sync, C: Card> OnCard<T, S, C> {
    fn new(card: C, tree: AabbTree<T, S>, options: &CudaOptions) -> Result<Self, CudaError> {
        let engine = Engine::new(card, &Scene::new(&tree)?, options.reach, options.memory)?;
        Ok(Self { tree, engine, options: *options })
    }

    fn closest_columns_into(
        &self,
        queries: &[Point3<T>],
        max_distance: T,
        columns: &mut ClosestColumns<'_, T>,
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
        let undecided = self.engine.answer(queries, radius, self.options.reorder, answers, &mut report)?;
        if let Some(column) = &mut columns.feature {
            // Code 255 stands for no feature.
            let feature = |code| Feature::from_code(code).unwrap_or(Feature::Vertex(0));
            column.iter_mut().zip(&features).for_each(|(to, code)| *to = feature(*code));
        }
        self.by_processor_at(queries, &undecided, max_distance, columns).write(&undecided, columns);
        let sample = sample(len, self.options.checked);
        match self.by_processor_at(queries, &sample, max_distance, columns).other_bits(&sample, columns) {
            Some(query) => Err(CudaError::Unequal { query }),
            None => Ok(report),
        }
    }

    fn closest_on_card(
        &self,
        queries: &CardQueries,
        max_distance: T,
        columns: &CardColumns,
    ) -> Result<BatchReport, CudaError> {
        assert!(u32::try_from(queries.count).is_ok(), "fewer than 2^32 queries");
        let CardColumns { distance, lower_bound, point, barycentric, primitive, feature } = *columns;
        let columns = [distance, lower_bound, point, barycentric, primitive, feature];
        let radius = max_distance.to_f64_above();
        self.engine.answer_on_card(queries, radius, self.options.reorder, &columns, |queries: &[Point3<T>]| {
            let mut is_wanted = columns.map(|address| address != 0);
            // A primitive says whether there is a feature.
            is_wanted[4] |= is_wanted[5];
            self.by_processor(queries, max_distance, is_wanted).into_bytes()
        })
    }

    /// Answers some of the queries on the processor, with the wanted columns of others.
    fn by_processor_at(
        &self,
        queries: &[Point3<T>],
        numbers: &[u32],
        max_distance: T,
        columns: &ClosestColumns<'_, T>,
    ) -> Answered<T> {
        let chosen: Vec<Point3<T>> = numbers.iter().map(|&i| queries[i as usize]).collect();
        let is_wanted = [
            columns.distance.is_some(),
            columns.lower_bound.is_some(),
            columns.point.is_some(),
            columns.barycentric.is_some(),
            columns.primitive.is_some(),
            columns.feature.is_some(),
        ];
        self.by_processor(&chosen, max_distance, is_wanted)
    }

    /// Answers queries on the processor, with the columns that are wanted.
    fn by_processor(&self, queries: &[Point3<T>], max_distance: T, is_wanted: [bool; 6]) -> Answered<T> {
        let len = is_wanted.map(|is_wanted| if is_wanted { queries.len() } else { 0 });
        let mut answered = Answered {
            distance: vec![T::zero(); len[0]],
            lower_bound: vec![T::zero(); len[1]],
            point: vec![Point3::origin(); len[2]],
            barycentric: vec![[T::zero(); 3]; len[3]],
            primitive: vec![0; len[4]],
            feature: vec![Feature::Face; len[5]],
        };
        let mut columns = ClosestColumns::default();
        // A column that is not wanted is not computed.
        columns.distance = is_wanted[0].then_some(&mut answered.distance);
        columns.lower_bound = is_wanted[1].then_some(&mut answered.lower_bound);
        columns.point = is_wanted[2].then_some(&mut answered.point);
        columns.barycentric = is_wanted[3].then_some(&mut answered.barycentric);
        columns.primitive = is_wanted[4].then_some(&mut answered.primitive);
        columns.feature = is_wanted[5].then_some(&mut answered.feature);
        let options = QueryOptions::default().with_max_distance(max_distance);
        batch::closest_columns_into(&self.tree, queries, &options, &BatchOptions::default(), columns);
        answered
    }
}

impl<T: Real + Pod> Answered<T> {
    /// Writes the answers to the places of their queries.
    fn write(&self, numbers: &[u32], columns: &mut ClosestColumns<'_, T>) {
        fn put<V: Copy>(numbers: &[u32], to: &mut Option<&mut [V]>, from: &[V]) {
            if let Some(to) = to {
                numbers.iter().zip(from).for_each(|(&i, value)| to[i as usize] = *value);
            }
        }
        put(numbers, &mut columns.distance, &self.distance);
        put(numbers, &mut columns.lower_bound, &self.lower_bound);
        put(numbers, &mut columns.point, &self.point);
        put(numbers, &mut columns.barycentric, &self.barycentric);
        put(numbers, &mut columns.primitive, &self.primitive);
        put(numbers, &mut columns.feature, &self.feature);
    }

    /// Returns the number of a query that has another answer in columns. Lower bounds may differ.
    fn other_bits(&self, numbers: &[u32], columns: &ClosestColumns<'_, T>) -> Option<usize> {
        fn other<V: Pod>(numbers: &[u32], found: Option<&[V]>, expected: &[V]) -> Option<usize> {
            let found = found?;
            let is_other = |(i, value): &(usize, &V)| bytes_of(&found[*i]) != bytes_of(*value);
            numbers.iter().map(|&i| i as usize).zip(expected).find(is_other).map(|(i, _)| i)
        }
        let is_other = |&(i, feature): &(usize, &Feature)| columns.feature.as_ref().is_some_and(|c| c[i] != *feature);
        other(numbers, columns.distance.as_deref(), &self.distance)
            .or_else(|| other(numbers, columns.point.as_deref(), &self.point))
            .or_else(|| other(numbers, columns.barycentric.as_deref(), &self.barycentric))
            .or_else(|| other(numbers, columns.primitive.as_deref(), &self.primitive))
            .or_else(|| numbers.iter().map(|&i| i as usize).zip(&self.feature).find(is_other).map(|(i, _)| i))
    }

    /// Returns the bytes of the columns, in the order of those on the card.
    fn into_bytes(self) -> [Vec<u8>; 6] {
        let is_missing = |i: usize| self.primitive.get(i) == Some(&ClosestColumns::<T>::NO_PRIMITIVE);
        let code = |(i, feature): (usize, &Feature)| if is_missing(i) { 255 } else { feature.code() };
        [
            cast_slice(&self.distance).to_vec(),
            cast_slice(&self.lower_bound).to_vec(),
            cast_slice(&self.point).to_vec(),
            cast_slice(&self.barycentric).to_vec(),
            cast_slice(&self.primitive).to_vec(),
            self.feature.iter().enumerate().map(code).collect(),
        ]
    }
}

/// Returns the numbers of so many queries, evenly spaced.
#[allow(clippy::cast_possible_truncation, reason = "numbers of queries")]
fn sample(count: usize, wanted: usize) -> Vec<u32> {
    let wanted = wanted.min(count);
    (0..wanted).map(|i| (i as u128 * count as u128 / wanted as u128) as u32).collect()
}
