//! Closest points of scenes on an NVIDIA card, bit for bit equal to the answers of [`AabbTree`].
//!
//! [`CudaIndex`] copies a scene with its tree to the card, and makes *interception lists* there: for each cell of an
//! octree, the primitives that can be nearest to some point of the cell. A query reads the list of its cell, or
//! searches the tree if it is outside of all lists. Distances in f32 with a proved error select the candidates, and the
//! kernel of the contract, in f64 and in the same order of operations, decides between them. The slower paths of that
//! kernel, such as those for slivers and extreme scales, stay with the processor. So distance, primitive, point,
//! feature and weights have the bits of [`AabbTree`]. The proofs are in docs/proofs/cuda.md.
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
//! The driver is loaded when an index is made, so programs start on machines without one.

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

use bytemuck::{Pod, cast_slice, cast_slice_mut};
use card::{CallersContext, Card, CudaCard};
use engine::{Engine, after_error};
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::{self, BatchOptions, ClosestColumns};
use p2m_core::{Feature, PrimitiveSet, QueryOptions, Real};
use scene::Scene;
use std::mem::ManuallyDrop;
use std::time::Duration;

/// Options of an index on a card.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CudaOptions {
    /// The number of the card, from 0. The default is 0.
    pub ordinal: usize,
    /// The size of the region with lists, in boxes of the scene around its centre: 10.5 by default. Queries farther
    /// away search the tree. Below 1 and above 10^6, only the box has lists.
    pub reach: f64,
    /// The largest number of bytes of the lists, up to 4 GB. The default is about 280 for each primitive, and more in
    /// scenes of more than 100,000, but at most a quarter of the free memory. While lists are made, the card needs
    /// twice as many, and up to 400 for each cell of a level.
    pub memory: Option<usize>,
    /// Whether the card sorts the queries. Sorting is wasted if neighbouring queries are near each other already.
    pub reorder: bool,
    /// The number of answers of each batch that the processor checks, 0 by default. Batches that are on the card
    /// already are not checked.
    pub checked: usize,
}

impl Default for CudaOptions {
    fn default() -> Self {
        Self { ordinal: 0, reach: 10.5, memory: None, reorder: true, checked: 0 }
    }
}

/// A report on how the queries of a batch were answered.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct BatchReport {
    /// The number of queries without a list, which the card has answered by the tree.
    pub by_tree: usize,
    /// The number of queries that the processor has answered.
    pub by_processor: usize,
    /// The time of the kernels on the card, including sorting and without transfers. The parts of a batch from the
    /// memory of the processor overlap, and so do their times.
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
    /// The address of the first coordinate. Queries follow each other without gaps, each with three coordinates.
    pub address: u64,
    /// The number of queries.
    pub count: usize,
    /// Whether coordinates are f32. Otherwise they have the scalar of the scene.
    pub is_f32: bool,
}

/// The addresses of columns on the card, for [`CudaIndex::closest_on_card`]; 0 for an unwanted column.
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
    /// The address of the indices of the primitives, as 32-bit numbers. All bits are 1 if there is no answer.
    pub primitive: u64,
    /// The address of the features, of 8 bits ([`Feature::code`]); 255 if there is no answer.
    pub feature: u64,
}

/// An index on a card: a tree with its scene, and interception lists.
pub struct CudaIndex<T: Real, S> {
    index: ManuallyDrop<OnCard<T, S, CudaCard>>,
}

impl<T: Real, S> Drop for CudaIndex<T, S> {
    fn drop(&mut self) {
        let _caller = CallersContext::new();
        // SAFETY: it is not used again.
        unsafe { ManuallyDrop::drop(&mut self.index) }
    }
}

impl<T: Real + Pod, S: PrimitiveSet<T> + Sync> CudaIndex<T, S> {
    /// Copies a tree with its scene to a card, and makes the lists there.
    ///
    /// # Errors
    /// Returns a [`CudaError`] if there is no driver or no such card, if the memory of the card does not suffice, for
    /// an empty scene, for primitives without vertices, and for scenes whose size is not within 2^-320..2^300.
    pub fn new(tree: AabbTree<T, S>, options: &CudaOptions) -> Result<Self, CudaError> {
        // The library for the driver panics if there is none.
        if !card::is_driver_present() {
            return Err(CudaError::NoDriver);
        }
        let _caller = CallersContext::new();
        let card = CudaCard::open(options.ordinal)?;
        Ok(Self { index: ManuallyDrop::new(OnCard::new(card, tree, options)?) })
    }

    /// Returns the tree, which answers single queries and other kinds of queries.
    pub fn tree(&self) -> &AabbTree<T, S> {
        &self.index.tree
    }

    /// Returns the bytes of the scene and of its lists on the card.
    pub fn memory(&self) -> [usize; 2] {
        self.index.engine.memory()
    }

    /// Returns the number of cells without a list, whose queries search the tree.
    pub fn cells_without_list(&self) -> u64 {
        self.index.engine.cells_without_list()
    }

    /// Answers queries into columns, in their order. The values are the same as those of
    /// [`batch::closest_columns_into`], except for lower bounds, which are valid but may differ.
    ///
    /// Queries are divided into parts of about a million. The card holds three parts at a time: while one is copied,
    /// another is searched. For each query of a part it needs 20 bytes besides its coordinates and columns.
    ///
    /// # Errors
    /// Returns a [`CudaError`] if the card fails, if its memory does not suffice, or if a checked answer differs from
    /// the processor's ([`CudaOptions::checked`]). The content of the columns is then unspecified.
    ///
    /// # Panics
    /// Panics if a column has another length than `queries`, and for more than 2^32 - 1 queries.
    pub fn closest_columns_into(
        &self,
        queries: &[Point3<T>],
        max_distance: T,
        columns: &mut ClosestColumns<'_, T>,
    ) -> Result<BatchReport, CudaError> {
        let _caller = CallersContext::new();
        self.index.closest_columns_into(queries, max_distance, columns)
    }

    /// Answers queries on the card into columns on the card. First it waits for a stream of the caller, and it returns
    /// when all answers are there.
    ///
    /// The card needs 20 bytes for each of up to eight million queries at a time.
    ///
    /// # Errors
    /// Returns a [`CudaError`] if the card fails, or if its memory does not suffice. The content of the columns is then
    /// unspecified.
    ///
    /// # Panics
    /// Panics for more than 2^32 - 1 queries.
    ///
    /// # Safety
    /// All addresses belong to the primary context of the card of this index. Queries and columns have the sizes that
    /// [`CardQueries`] and [`CardColumns`] state, are aligned to their scalars, and do not overlap. Nothing else writes
    /// to either during the call. The stream belongs to that context; 0 is the default stream.
    pub unsafe fn closest_on_card(
        &self,
        queries: &CardQueries,
        max_distance: T,
        stream: u64,
        columns: &CardColumns,
    ) -> Result<BatchReport, CudaError> {
        let _caller = CallersContext::new();
        // SAFETY: the caller says so.
        unsafe { self.index.engine.card().wait_for(stream) }?;
        self.index.closest_on_card(queries, max_distance, columns)
    }
}

/// The number of the column of lower bounds, which the processor does not check because its bounds may differ.
const LOWER_BOUND: usize = 1;

/// A tree with a copy of its scene on a card.
struct OnCard<T: Real, S, C: Card> {
    tree: AabbTree<T, S>,
    engine: Engine<C>,
    options: CudaOptions,
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
        let mut answers = [
            cast_slice_mut(columns.distance.as_deref_mut().unwrap_or_default()),
            cast_slice_mut(columns.lower_bound.as_deref_mut().unwrap_or_default()),
            cast_slice_mut(columns.point.as_deref_mut().unwrap_or_default()),
            cast_slice_mut(columns.barycentric.as_deref_mut().unwrap_or_default()),
            cast_slice_mut(columns.primitive.as_deref_mut().unwrap_or_default()),
            features.as_mut_slice(),
        ];
        let widths = answers.each_ref().map(|column| column.len() / len.max(1));
        let mut report = BatchReport::default();
        let parts = answers.each_mut().map(|column| &mut **column);
        let left =
            self.engine.answer(queries, max_distance.to_f64_above(), self.options.reorder, parts, &mut report)?;
        let by_processor = |numbers: &[u32]| {
            let chosen: Vec<Point3<T>> = numbers.iter().map(|&i| queries[i as usize]).collect();
            self.by_processor(&chosen, max_distance, widths.map(|width| width > 0))
        };
        for ((column, from), width) in answers.iter_mut().zip(by_processor(&left)).zip(widths) {
            for (&i, value) in left.iter().zip(from.chunks_exact(width.max(1))) {
                column[i as usize * width..][..width].copy_from_slice(value);
            }
        }
        let sample = sample(len, self.options.checked);
        for (number, from) in by_processor(&sample).iter().enumerate().filter(|(number, _)| *number != LOWER_BOUND) {
            let (column, width) = (&answers[number], widths[number]);
            let is_other = |(i, value): &(&u32, &[u8])| column[**i as usize * width..][..width] != **value;
            if let Some((&i, _)) = sample.iter().zip(from.chunks_exact(width.max(1))).find(is_other) {
                return Err(CudaError::Unequal { query: i as usize });
            }
        }
        if let Some(column) = &mut columns.feature {
            // Code 255 stands for no feature.
            let feature = |code| Feature::from_code(code).unwrap_or(Feature::Vertex(0));
            column.iter_mut().zip(&features).for_each(|(to, code)| *to = feature(*code));
        }
        Ok(report)
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
        let is_wanted = columns.map(|address| address != 0);
        let by_processor = |queries: &[Point3<T>]| self.by_processor(queries, max_distance, is_wanted);
        let answered = self.engine.answer_on_card(queries, radius, self.options.reorder, &columns, by_processor);
        after_error(self.engine.card(), answered)
    }

    /// Answers queries on the processor. Returns the bytes of the wanted columns, in the order of the columns of the
    /// card. The bytes of an unwanted column are empty.
    fn by_processor(&self, queries: &[Point3<T>], max_distance: T, is_wanted: [bool; 6]) -> [Vec<u8>; 6] {
        let len = is_wanted.map(|is_wanted| if is_wanted { queries.len() } else { 0 });
        let (mut distance, mut lower_bound) = (vec![T::zero(); len[0]], vec![T::zero(); len[1]]);
        let (mut point, mut barycentric) = (vec![Point3::origin(); len[2]], vec![[T::zero(); 3]; len[3]]);
        // The primitive tells whether there is a feature, so it is computed for that column as well.
        let (mut primitive, mut feature) = (vec![0; len[4].max(len[5])], vec![Feature::Face; len[5]]);
        let mut columns = ClosestColumns::default();
        // A column that is not wanted is not computed.
        columns.distance = is_wanted[0].then_some(&mut distance);
        columns.lower_bound = is_wanted[1].then_some(&mut lower_bound);
        columns.point = is_wanted[2].then_some(&mut point);
        columns.barycentric = is_wanted[3].then_some(&mut barycentric);
        columns.primitive = (is_wanted[4] || is_wanted[5]).then_some(&mut primitive);
        columns.feature = is_wanted[5].then_some(&mut feature);
        let options = QueryOptions::default().with_max_distance(max_distance);
        batch::closest_columns_into(&self.tree, queries, &options, &BatchOptions::default(), columns);
        let is_missing = |id: u32| id == ClosestColumns::<T>::NO_PRIMITIVE;
        let code = |(feature, id): (&Feature, &u32)| if is_missing(*id) { 255 } else { feature.code() };
        let codes = feature.iter().zip(&primitive).map(code).collect();
        primitive.truncate(len[4]);
        let [distance, lower_bound] = [cast_slice(&distance).to_vec(), cast_slice(&lower_bound).to_vec()];
        let [point, barycentric] = [cast_slice(&point).to_vec(), cast_slice(&barycentric).to_vec()];
        [distance, lower_bound, point, barycentric, cast_slice(&primitive).to_vec(), codes]
    }
}

/// Returns the numbers of `wanted` of `count` queries, evenly spaced.
#[allow(clippy::cast_possible_truncation, reason = "numbers of queries")]
fn sample(count: usize, wanted: usize) -> Vec<u32> {
    let wanted = wanted.min(count);
    (0..wanted).map(|i| (i as u128 * count as u128 / wanted as u128) as u32).collect()
}
