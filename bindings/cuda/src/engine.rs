//! A scene on a card, and the batches of queries that it answers.

use crate::card::Card;
use crate::lists::{self, ListPlan, Lists, Source};
use crate::raw::{Address, Batch, Columns, Index, KEYS, KEYS_PER_GROUP};
use crate::scene::Scene;
use crate::{BatchReport, CardQueries, CudaError};
use bytemuck::{Pod, cast_slice, cast_slice_mut};
use nalgebra::Point3;
use p2m_core::Real;
use p2m_core::engine::query::square_within;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// The number of lanes, which work in turns: while one copies its queries, others search or copy their answers.
const LANES: usize = 3;
/// The number of queries that a lane copies and answers at a time.
const LANE_QUERIES: usize = 1 << 20;
/// The number of queries that are answered at a time if they are on the card already.
const CARD_QUERIES: usize = 1 << 23;

/// A scene on a card, with the lanes that answer batches.
pub(crate) struct Engine<C: Card> {
    lanes: Vec<C>,
    /// The memory of the scene, to which `index` has addresses.
    _scene: [C::Memory; 4],
    lists: Lists<C::Memory>,
    index: Index,
    /// The bytes of the scene without its lists.
    scene_bytes: usize,
}

/// The columns of a batch as bytes, in the order of [`Columns`]. An unwanted column is empty.
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
        // Making lists takes twice their memory, and the scene and batches take some as well.
        let memory = match memory {
            Some(memory) => memory,
            None => default_memory(count).min(card.free_memory()? / 4),
        };
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
        // The lanes have other streams, which do not wait for this one.
        card.wait()?;
        let mut lanes = vec![card];
        for _ in 1..LANES {
            lanes.push(lanes[0].lane()?);
        }
        let scene_bytes = parts.iter().map(|part| part.len()).sum();
        let engine = Self { lanes, _scene: blocks, lists, index, scene_bytes };
        engine.card().keep(engine.kept_bytes())?;
        Ok(engine)
    }

    /// The bytes of the scene and of its lists. The driver has to keep them in addition: its limit includes memory in
    /// use, so otherwise each wait would return the memory of a batch, and the next batch would map it anew.
    fn kept_bytes(&self) -> i64 {
        i64::try_from(self.scene_bytes + self.lists.memory).unwrap_or(i64::MAX)
    }

    /// The bytes of the scene and of its lists on the card.
    pub(crate) fn memory(&self) -> [usize; 2] {
        [self.scene_bytes, self.lists.memory]
    }

    /// The number of cells that have no list.
    pub(crate) fn cells_without_list(&self) -> u64 {
        self.lists.left_out
    }

    /// The first lane.
    pub(crate) fn card(&self) -> &C {
        &self.lanes[0]
    }

    /// Answers queries and adds to a report. Returns the numbers of the queries that the card has not decided, in any
    /// order.
    pub(crate) fn answer<T: Real + Pod>(
        &self,
        queries: &[Point3<T>],
        radius: f64,
        reorder: bool,
        mut answers: Answers<'_>,
        report: &mut BatchReport,
    ) -> Result<Vec<u32>, CudaError> {
        let widths = answers.each_ref().map(|column| column.len() / queries.len().max(1));
        let mut chunks = queries.chunks(LANE_QUERIES).enumerate();
        let next = Mutex::new(move || {
            let (chunk, queries) = chunks.next()?;
            let part: Answers<'_> = std::array::from_fn(|column| {
                let (part, rest) = std::mem::take(&mut answers[column]).split_at_mut(queries.len() * widths[column]);
                answers[column] = rest;
                part
            });
            Some((chunk * LANE_QUERIES, queries, part))
        });
        let result = Mutex::new(Ok((Vec::new(), BatchReport::default())));
        let work = |lane: &C| {
            let chunk = || (*unpoisoned(&next))();
            while let Some((first, queries, part)) = chunk() {
                let found = after_error(lane, self.answer_chunk(lane, queries, radius, reorder, part));
                let mut result = unpoisoned(&result);
                match (&mut *result, found) {
                    (Ok((undecided, so_far)), Ok((numbers, report))) => {
                        #[allow(clippy::cast_possible_truncation, reason = "checked by the caller")]
                        undecided.extend(numbers.into_iter().map(|i: u32| i + first as u32));
                        so_far.add(&report);
                    }
                    (Ok(_), Err(error)) => return *result = Err(error),
                    (Err(_), _) => return,
                }
            }
        };
        std::thread::scope(|scope| {
            let lanes = self.lanes.iter().take(queries.len().div_ceil(LANE_QUERIES));
            lanes.skip(1).for_each(|lane| drop(scope.spawn(|| work(lane))));
            work(self.card());
        });
        let (undecided, found) = result.into_inner().unwrap_or_else(PoisonError::into_inner)?;
        report.add(&found);
        Ok(undecided)
    }

    fn answer_chunk<T: Real + Pod>(
        &self,
        card: &C,
        queries: &[Point3<T>],
        radius: f64,
        reorder: bool,
        answers: Answers<'_>,
    ) -> Result<(Vec<u32>, BatchReport), CudaError> {
        let mut report = BatchReport::default();
        let mut columns = Columns::default();
        let mut blocks = Vec::new();
        for (address, column) in columns.iter_mut().zip(answers).filter(|(_, column)| !column.is_empty()) {
            let block = card.allocate(column.len())?;
            *address = card.address(&block);
            blocks.push((block, column));
        }
        let memory = card.upload(cast_slice(queries))?;
        let mut batch = self.batch(card.address(&memory), columns, radius);
        let found = Self::search::<T>(card, queries.len(), reorder, &mut batch, &mut report)?;
        let mut left = vec![0u32; found.count];
        if found.count > 0 {
            card.read(&found.numbers, cast_slice_mut(&mut left))?;
        }
        blocks.into_iter().try_for_each(|(block, column)| card.read(&block, column))?;
        Ok((left, report))
    }

    /// Answers queries on the card into columns on the card. `by_processor` answers those that the card does not
    /// decide. After an error, kernels may still be running.
    pub(crate) fn answer_on_card<T: Real + Pod>(
        &self,
        queries: &CardQueries,
        radius: f64,
        reorder: bool,
        columns: &Columns,
        mut by_processor: impl FnMut(&[Point3<T>]) -> [Vec<u8>; 6],
    ) -> Result<BatchReport, CudaError> {
        let card = self.card();
        let (mut report, scalar) = (BatchReport::default(), size_of::<T>());
        let query_bytes = 3 * if queries.is_f32 { 4 } else { scalar };
        let widths = [scalar, scalar, 3 * scalar, 3 * scalar, 4, 1];
        let moved = |address: Address, first: usize, width: usize| match address {
            0 => 0,
            _ => address + (first * width) as Address,
        };
        for first in (0..queries.count).step_by(CARD_QUERIES) {
            let count = CARD_QUERIES.min(queries.count - first);
            let columns = std::array::from_fn(|column| moved(columns[column], first, widths[column]));
            let mut batch = self.batch(moved(queries.address, first, query_bytes), columns, radius);
            batch.has_f32_queries = u32::from(queries.is_f32);
            let found = Self::search::<T>(card, count, reorder, &mut batch, &mut report)?;
            if found.count > 0 {
                let gathered = card.allocate(found.count * 3 * scalar)?;
                batch.gathered = card.address(&gathered);
                card.launch(&format!("p2m_gather_{}", suffix::<T>()), found.count, &batch)?;
                let mut left = vec![Point3::<T>::origin(); found.count];
                card.read(&gathered, cast_slice_mut(&mut left))?;
                let mut blocks = Vec::new();
                let wanted = batch.answers.iter_mut().zip(by_processor(&left)).filter(|(_, bytes)| !bytes.is_empty());
                for (address, bytes) in wanted {
                    let block = card.upload(&bytes)?;
                    *address = card.address(&block);
                    blocks.push(block);
                }
                card.launch(&format!("p2m_put_{}", suffix::<T>()), found.count, &batch)?;
                card.wait()?;
            }
        }
        Ok(report)
    }

    /// Returns a batch without the temporary memory of a search.
    fn batch(&self, queries: Address, columns: Columns, radius: f64) -> Batch {
        Batch { index: self.index, columns, queries, radius, prune: square_within(radius), ..Batch::default() }
    }

    /// Runs the kernels of a batch, and waits for them.
    fn search<T: Real>(
        card: &C,
        count: usize,
        reorder: bool,
        batch: &mut Batch,
        report: &mut BatchReport,
    ) -> Result<Undecided<C::Memory>, CudaError> {
        let [rest, undecided] = [card.allocate(count * 4)?, card.allocate(count * 4)?];
        let mut numbers = card.allocate(8)?;
        card.clear(&mut numbers)?;
        batch.rest = card.address(&rest);
        batch.rest_count = card.address(&numbers);
        batch.undecided = card.address(&undecided);
        batch.undecided_count = card.address(&numbers) + 4;
        card.wait()?;
        let start = Instant::now();
        let _sorting = if reorder { Some(Self::sort::<T>(card, count, batch)?) } else { None };
        card.launch(&format!("p2m_answer_by_list_{}", suffix::<T>()), count, batch)?;
        card.launch(&format!("p2m_answer_by_tree_{}", suffix::<T>()), count, batch)?;
        card.wait()?;
        report.kernels += start.elapsed();
        let mut found = [0u32; 2];
        card.read(&numbers, cast_slice_mut(&mut found))?;
        report.by_tree += found[0] as usize;
        report.by_processor += found[1] as usize;
        Ok(Undecided { numbers: undecided, count: found[1] as usize })
    }

    /// Sorts the queries of a batch spatially, and returns the memory of the order.
    fn sort<T: Real>(card: &C, count: usize, batch: &mut Batch) -> Result<[C::Memory; 4], CudaError> {
        let [order, keys, ranks] = [card.allocate(count * 4)?, card.allocate(count * 4)?, card.allocate(count * 4)?];
        let mut starts = card.allocate((KEYS + 1) * 4)?;
        card.clear(&mut starts)?;
        batch.keys = card.address(&keys);
        batch.ranks = card.address(&ranks);
        batch.starts = card.address(&starts);
        batch.placed = batch.starts + (KEYS * 4) as Address;
        card.launch(&format!("p2m_count_key_{}", suffix::<T>()), count, batch)?;
        card.launch("p2m_place_keys", KEYS / KEYS_PER_GROUP, batch)?;
        batch.order = card.address(&order);
        card.launch("p2m_scatter", count, batch)?;
        Ok([order, keys, ranks, starts])
    }
}

impl<C: Card> Drop for Engine<C> {
    fn drop(&mut self) {
        let _ = self.card().keep(-self.kept_bytes());
    }
}

/// The queries of a batch that the card has left to the processor.
struct Undecided<M> {
    /// The numbers of these queries, in any order.
    numbers: M,
    count: usize,
}

/// Returns the suffix of the names of kernels for a scalar.
fn suffix<T>() -> &'static str {
    if size_of::<T>() == 4 { "f32" } else { "f64" }
}

/// Waits for the kernels of failed work, because they still use the memory of the caller.
pub(crate) fn after_error<V>(card: &impl Card, result: Result<V, CudaError>) -> Result<V, CudaError> {
    result.inspect_err(|_| drop(card.wait()))
}

fn unpoisoned<V>(mutex: &Mutex<V>) -> MutexGuard<'_, V> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the default memory of lists in bytes: 280 for each primitive of a scene of 100,000, and more in a larger
/// scene, whose lists are searched from far more cells. No record exists of how it was chosen; no card has run the
/// kernels yet (docs/decisions/067-a-card-is-a-device.md).
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "a size")]
fn default_memory(primitives: usize) -> usize {
    let n = primitives as f64;
    (280.0 * n * (n / 1e5).max(1.0).powf(0.75)) as usize
}
