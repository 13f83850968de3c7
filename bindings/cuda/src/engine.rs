//! A scene on a card, and batches of queries that it answers.

use crate::card::Card;
use crate::lists::{self, ListPlan, Lists, Source};
use crate::raw::{Batch, Columns, Index, KEYS, KEYS_PER_SUM};
use crate::scene::Scene;
use crate::{BatchReport, CudaError};
use bytemuck::{Pod, cast_slice, cast_slice_mut};
use nalgebra::Point3;
use p2m_core::Real;
use p2m_core::engine::query::square_within;
use std::time::Instant;

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

/// The bytes of the columns of a batch, in the order of [`Columns`]. A column that nobody wants is empty.
pub(crate) type Answers<'a> = [&'a mut [u8]; 6];

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

    /// Answers queries, and adds to a report. Returns the numbers of those that the card has not decided, in any order.
    pub(crate) fn answer<T: Real + Pod>(
        &self,
        queries: &[Point3<T>],
        radius: f64,
        reorder: bool,
        mut answers: Answers<'_>,
        report: &mut BatchReport,
    ) -> Result<Vec<u32>, CudaError> {
        let bytes = answers.each_ref().map(|column| column.len() / queries.len().max(1));
        let mut undecided = Vec::new();
        for (chunk, queries) in queries.chunks(CHUNK_QUERIES).enumerate() {
            let first = chunk * CHUNK_QUERIES;
            let range = |bytes: usize| first * bytes..(first + queries.len()) * bytes;
            let mut columns =
                answers.each_mut().into_iter().zip(bytes).map(|(column, bytes)| &mut column[range(bytes)]);
            let part = std::array::from_fn(|_| columns.next().expect("six columns"));
            let found = self.answer_chunk(queries, radius, reorder, part, report)?;
            #[allow(clippy::cast_possible_truncation, reason = "checked by the caller")]
            undecided.extend(found.into_iter().map(|i| i + first as u32));
        }
        Ok(undecided)
    }

    fn answer_chunk<T: Real + Pod>(
        &self,
        queries: &[Point3<T>],
        radius: f64,
        reorder: bool,
        answers: Answers<'_>,
        report: &mut BatchReport,
    ) -> Result<Vec<u32>, CudaError> {
        let card = &self.card;
        let count = queries.len();
        let suffix = if size_of::<T>() == 4 { "f32" } else { "f64" };
        let mut columns = Columns::default();
        let mut blocks = Vec::new();
        for (address, column) in columns.iter_mut().zip(answers).filter(|(_, column)| !column.is_empty()) {
            let block = card.allocate(column.len())?;
            *address = card.address(&block);
            blocks.push((block, column));
        }
        let queries = card.upload(cast_slice(queries))?;
        let [rest, undecided] = [card.allocate(count * 4)?, card.allocate(count * 4)?];
        let mut numbers = card.allocate(8)?;
        card.clear(&mut numbers)?;
        let mut batch = Batch {
            index: self.index,
            columns,
            queries: card.address(&queries),
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
        report.kernels += start.elapsed();
        let mut found = [0u32; 2];
        card.read(&numbers, cast_slice_mut(&mut found))?;
        report.by_tree += found[0] as usize;
        report.by_processor += found[1] as usize;
        let mut left = vec![0u32; found[1] as usize];
        card.read(&undecided, cast_slice_mut(&mut left))?;
        blocks.into_iter().try_for_each(|(block, column)| card.read(&block, column))?;
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
