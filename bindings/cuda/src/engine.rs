//! A scene on a card, and batches of queries that it answers.

use crate::CudaError;
use crate::card::Card;
use crate::lists::{self, ListPlan, Lists, Source};
use crate::raw::{Batch, Columns, Index, KEYS, KEYS_PER_SUM};
use crate::scene::Scene;
use bytemuck::{Pod, cast_slice, cast_slice_mut};
use p2m_core::{Key, Real};
use std::time::{Duration, Instant};

/// The number of queries that are on the card at a time.
const CHUNK_QUERIES: usize = 1 << 22;

/// A scene on a card.
pub(crate) struct Engine<C: Card> {
    card: C,
    /// The blocks that `index` has the addresses of.
    _scene: [C::Memory; 4],
    lists: Lists<C::Memory>,
    index: Index,
    /// The bytes of the scene without its lists.
    scene_bytes: usize,
}

/// The answers to a batch, in the scalar of the scene. A column that nobody wants is empty.
pub(crate) struct Answers<'a, T> {
    pub(crate) distance: &'a mut [T],
    pub(crate) lower_bound: &'a mut [T],
    pub(crate) point: &'a mut [[T; 3]],
    pub(crate) weights: &'a mut [[T; 3]],
    pub(crate) primitive: &'a mut [u32],
    pub(crate) feature: &'a mut [u8],
}

/// How the queries of a batch were answered.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Counts {
    /// By the tree on the card.
    pub(crate) by_tree: usize,
    /// The time of the kernels, from sorting to the last answer.
    pub(crate) kernels: Duration,
}

impl<C: Card> Engine<C> {
    /// Copies a scene to a card, and makes its lists there.
    pub(crate) fn new<T: Real + Pod>(
        card: C,
        scene: &Scene<T>,
        reach: f64,
        memory: Option<usize>,
    ) -> Result<Self, CudaError> {
        let count = scene.plates.len();
        let parts: [&[u8]; 4] = [
            cast_slice(&scene.nodes),
            cast_slice(&scene.plates),
            cast_slice(&scene.primitives),
            cast_slice(&scene.vertices),
        ];
        let blocks = [card.upload(parts[0])?, card.upload(parts[1])?, card.upload(parts[2])?, card.upload(parts[3])?];
        let [nodes, plates, primitives, vertices] = [0, 1, 2, 3].map(|i: usize| card.address(&blocks[i]));
        let memory = memory.unwrap_or_else(|| default_memory(count));
        let plan = ListPlan { half_extent: scene.half_extent, primitives: count, reach, memory };
        let lists = lists::make(&card, Source { nodes, plates }, &plan)?;
        let mut index = Index {
            nodes,
            plates,
            primitives,
            vertices,
            entries: card.address(&lists.entries),
            items: card.address(&lists.items),
            grid_count: i32::try_from(lists.grids.len()).expect("two grids"),
            centre: scene.centre,
            per_unit: scene.per_unit,
            ..Index::default()
        };
        index.grids[..lists.grids.len()].copy_from_slice(&lists.grids);
        Ok(Self { card, _scene: blocks, lists, index, scene_bytes: parts.iter().map(|part| part.len()).sum() })
    }

    /// The bytes of the scene and of its lists on the card.
    pub(crate) fn memory(&self) -> [usize; 2] {
        [self.scene_bytes, self.lists.memory]
    }

    /// The number of cells that have no list.
    pub(crate) fn cells_without_list(&self) -> u64 {
        self.lists.left_out
    }

    /// Answers queries. Returns the numbers of those that the card has not decided, in any order.
    pub(crate) fn answer<T: Real + Pod>(
        &self,
        queries: &[[T; 3]],
        radius: f64,
        reorder: bool,
        answers: &mut Answers<'_, T>,
    ) -> Result<(Vec<u32>, Counts), CudaError> {
        let (mut undecided, mut counts) = (Vec::new(), Counts::default());
        for (chunk, queries) in queries.chunks(CHUNK_QUERIES).enumerate() {
            let first = chunk * CHUNK_QUERIES;
            let found = self.answer_chunk(queries, first, radius, reorder, answers, &mut counts)?;
            #[allow(clippy::cast_possible_truncation, reason = "checked by the caller")]
            undecided.extend(found.into_iter().map(|i| i + first as u32));
        }
        Ok((undecided, counts))
    }

    fn answer_chunk<T: Real + Pod>(
        &self,
        queries: &[[T; 3]],
        first: usize,
        radius: f64,
        reorder: bool,
        answers: &mut Answers<'_, T>,
        counts: &mut Counts,
    ) -> Result<Vec<u32>, CudaError> {
        let card = &self.card;
        let count = queries.len();
        let last = first + count;
        let scalar = size_of::<T>();
        let suffix = if scalar == 4 { "f32" } else { "f64" };
        let column = |is_wanted: bool, bytes: usize| is_wanted.then(|| card.allocate(count * bytes)).transpose();
        let distance = column(!answers.distance.is_empty(), scalar)?;
        let lower_bound = column(!answers.lower_bound.is_empty(), scalar)?;
        let point = column(!answers.point.is_empty(), 3 * scalar)?;
        let weights = column(!answers.weights.is_empty(), 3 * scalar)?;
        let primitive = column(!answers.primitive.is_empty(), 4)?;
        let feature = column(!answers.feature.is_empty(), 1)?;
        let address = |memory: &Option<C::Memory>| memory.as_ref().map_or(0, |memory| card.address(memory));
        let columns = Columns {
            distance: address(&distance),
            lower_bound: address(&lower_bound),
            point: address(&point),
            weights: address(&weights),
            primitive: address(&primitive),
            feature: address(&feature),
        };
        let queries_there = card.upload(cast_slice(queries))?;
        let [rest, undecided] = [card.allocate(count * 4)?, card.allocate(count * 4)?];
        let mut numbers = card.allocate(8)?;
        card.clear(&mut numbers)?;
        let mut batch = Batch {
            index: self.index,
            columns,
            queries: card.address(&queries_there),
            rest: card.address(&rest),
            rest_count: card.address(&numbers),
            undecided: card.address(&undecided),
            undecided_count: card.address(&numbers) + 4,
            radius,
            prune: square_within(radius),
            ..Batch::default()
        };
        card.wait()?;
        let start = Instant::now();
        let _sorting = if reorder { Some(self.sort(count, suffix, &mut batch)?) } else { None };
        card.launch(&format!("p2m_answer_by_list_{suffix}"), count, &batch)?;
        card.launch(&format!("p2m_answer_by_tree_{suffix}"), count, &batch)?;
        card.wait()?;
        counts.kernels += start.elapsed();
        let mut found = [0u32; 2];
        card.read(&numbers, cast_slice_mut(&mut found))?;
        counts.by_tree += found[0] as usize;
        let mut left = vec![0u32; found[1] as usize];
        card.read(&undecided, cast_slice_mut(&mut left))?;
        let read = |memory: &Option<C::Memory>, bytes: &mut [u8]| {
            memory.as_ref().map_or(Ok(()), |memory| card.read(memory, bytes))
        };
        if distance.is_some() {
            read(&distance, cast_slice_mut(&mut answers.distance[first..last]))?;
        }
        if lower_bound.is_some() {
            read(&lower_bound, cast_slice_mut(&mut answers.lower_bound[first..last]))?;
        }
        if point.is_some() {
            read(&point, cast_slice_mut(&mut answers.point[first..last]))?;
        }
        if weights.is_some() {
            read(&weights, cast_slice_mut(&mut answers.weights[first..last]))?;
        }
        if primitive.is_some() {
            read(&primitive, cast_slice_mut(&mut answers.primitive[first..last]))?;
        }
        if feature.is_some() {
            read(&feature, &mut answers.feature[first..last])?;
        }
        Ok(left)
    }

    /// Sorts the queries of a batch, and returns the memory of their order.
    fn sort(&self, count: usize, suffix: &str, batch: &mut Batch) -> Result<[C::Memory; 5], CudaError> {
        let card = &self.card;
        let [order, keys, ranks] = [card.allocate(count * 4)?, card.allocate(count * 4)?, card.allocate(count * 4)?];
        let (mut starts, sums) = (card.allocate(KEYS * 4)?, card.allocate(KEYS / KEYS_PER_SUM * 4)?);
        card.clear(&mut starts)?;
        batch.keys = card.address(&keys);
        batch.ranks = card.address(&ranks);
        batch.starts = card.address(&starts);
        batch.sums = card.address(&sums);
        card.launch(&format!("p2m_count_key_{suffix}"), count, batch)?;
        card.launch("p2m_sum_keys", KEYS / KEYS_PER_SUM, batch)?;
        card.launch("p2m_scan_sums", 1, batch)?;
        card.launch("p2m_scan_keys", KEYS / KEYS_PER_SUM, batch)?;
        batch.order = card.address(&order);
        card.launch("p2m_scatter", count, batch)?;
        Ok([order, keys, ranks, starts, sums])
    }
}

/// The bytes that lists may take: 280 for each primitive of a scene of 100,000, and more for those of a larger one,
/// whose lists are searched from far more cells.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "a size")]
fn default_memory(primitives: usize) -> usize {
    let n = primitives as f64;
    (280.0 * n * (n / 1e5).max(1.0).powf(0.75)) as usize
}

/// Returns a square above those of all keys within a radius.
fn square_within(radius: f64) -> f64 {
    Key::from_offset([radius + f64::from_bits(1), 0.0, 0.0]).square_above() * (1.0 + 8.0 * f64::EPSILON)
}
