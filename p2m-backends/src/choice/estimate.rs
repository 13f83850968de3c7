//! The model that turns counts into the expected costs of each index for a scene and a workload.

use super::workload::{Workload, is_mostly_slivers};
use crate::registry::{BACKENDS, BackendEntry, Cost, SearchStructure};
use nalgebra::Point3;
use p2m_core::{IndexStats, PrimitiveSet, QueryOptions, Soup};
use p2m_interception::OctreeOptions;

/// Indexes are about equally good if their times differ by less than this factor. In the measurements of
/// docs/measurements/auto.md, almost all choices cost less than this factor of the best one.
const MODEL_ERROR: f64 = 1.15;
/// The number of packets per query from which on boxes may fit slivers badly. No record exists of how it was chosen.
const MANY_PACKETS: f64 = 20.0;
/// The number of primitives of the smallest scene for which cells may pay. A tree of one or two levels leaves nothing
/// to save.
const MIN_PRIMITIVES_FOR_CELLS: f64 = 512.0;
/// The size of the region around a scene whose cells are like the cells in its box, in boxes of the scene around its
/// centre.
const BOXES_INSIDE: f64 = 1.25;
/// The size of the space that has cells. Farther away, a tree answers.
const BOXES_WITH_CELLS: f64 = 10.0;

/// The costs that are expected of a backend for a scene and a workload, on one thread.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// The backend that is estimated.
    pub backend: &'static BackendEntry,
    /// The resolution of its cells, unless it is the default one.
    pub resolution: Option<f64>,
    /// The time to build the index, in seconds.
    pub build_seconds: f64,
    /// The time of one query, in seconds.
    pub query_seconds: f64,
    /// The memory of the index besides the scene, in bytes.
    pub bytes: f64,
    /// The time to build the index and to answer all queries, in seconds.
    pub total_seconds: f64,
    /// Whether the index takes about as long as the recommended one, as far as the model can tell.
    pub is_about_best: bool,
    /// The number of queries at which this backend and the recommended one take the same time; `None` if one of them
    /// is faster for every number of queries.
    pub break_even: Option<f64>,
    /// The reason for the rank of the index, as a phrase for people.
    pub reason: String,
    /// Whether the workload permits the index.
    pub(super) is_permitted: bool,
    /// The times of nodes and packets, if the index may be built to count them.
    pub(super) counted: Option<[f64; 2]>,
}

/// The mean work of a query.
#[derive(Clone, Copy, Default)]
pub(super) struct Work {
    nodes: f64,
    pub(super) packets: f64,
}

impl Work {
    /// Counts the work of some queries. One that is not finite has no answer and takes no time.
    pub(super) fn of(
        index: &(impl IndexStats<f64> + ?Sized),
        queries: &[Point3<f64>],
        workload: &Workload<'_>,
    ) -> Self {
        let options = QueryOptions::default().with_max_distance(workload.max_distance);
        let finite = queries.iter().filter(|query| is_finite(query));
        let counts = finite.map(|query| index.count_query(query, &options));
        let [nodes, packets] = counts.fold([0, 0], |sums, counts| [sums[0] + counts[0], sums[1] + counts[1]]);
        let count = queries.len().max(1) as f64;
        Self { nodes: nodes as f64 / count, packets: packets as f64 / count }
    }

    pub(super) fn nanoseconds(self, [node, packet]: [f64; 2]) -> f64 {
        self.nodes * node + self.packets * packet
    }
}

fn is_finite(query: &Point3<f64>) -> bool {
    query.iter().all(|x| x.is_finite())
}

/// The quantities from which the times of all indexes follow.
pub(super) struct Model {
    primitives: f64,
    queries: f64,
    /// The part of the primitives that are triangles.
    triangle_part: f64,
    /// The parts of the queries that are in and near the box, and where there are cells.
    inside: f64,
    near: f64,
    /// The work in the tree of boxes.
    work: Work,
    has_slivers: bool,
}

impl Model {
    /// Makes the model. `work` is the mean work of the queries in a tree of boxes over the scene.
    pub(super) fn new(soup: &Soup<f64>, workload: &Workload<'_>, queries: &[Point3<f64>], work: Work) -> Self {
        let bounds = soup.aabb();
        let centre = nalgebra::center(&bounds.min, &bounds.max);
        let half = (bounds.max - bounds.min).amax() / 2.0;
        let finite = || queries.iter().filter(|query| is_finite(query));
        let part = |boxes: f64| {
            let count = finite().filter(|query| (*query - centre).amax() <= boxes * half).count();
            count as f64 / finite().count().max(1) as f64
        };
        Self {
            primitives: soup.len() as f64,
            queries: workload.queries as f64,
            triangle_part: soup.triangles().len() as f64 / soup.len().max(1) as f64,
            inside: part(BOXES_INSIDE),
            near: part(BOXES_WITH_CELLS),
            work,
            has_slivers: is_mostly_slivers(soup),
        }
    }

    /// Returns the costs that are expected of each backend: with its default settings, and with finer cells.
    pub(super) fn estimates(&self, workload: &Workload<'_>) -> Vec<Estimate> {
        let costs = |backend: &'static BackendEntry| {
            let are_bad_boxes = self.has_slivers && self.work.packets >= MANY_PACKETS;
            let differs = are_bad_boxes && !backend.sliver_costs.is_empty();
            if differs { backend.sliver_costs } else { backend.costs }
        };
        let all = BACKENDS.iter().flat_map(|backend| costs(backend).iter().map(move |cost| (backend, cost)));
        all.map(|(backend, cost)| self.estimate(backend, cost, workload)).collect()
    }

    fn estimate(&self, backend: &'static BackendEntry, cost: &Cost, workload: &Workload<'_>) -> Estimate {
        let is_default = backend == BackendEntry::default_backend();
        let is_exhaustive = backend.structure == SearchStructure::Exhaustive;
        let bytes = cost.bytes * self.primitives;
        let fits = bytes * cost.least_bytes <= workload.max_bytes as f64 || is_default;
        let mut estimate = Estimate {
            backend,
            resolution: cost.finer.map(|factor| OctreeOptions::default().resolution * factor),
            build_seconds: cost.build * self.primitives * 1e-9,
            query_seconds: 0.0,
            bytes,
            total_seconds: 0.0,
            is_about_best: false,
            break_even: None,
            reason: String::new(),
            is_permitted: fits && !(workload.needs_index && is_exhaustive),
            counted: cost.counted,
        };
        self.set_query(&mut estimate, self.query_nanoseconds(backend.structure, cost));
        estimate
    }

    /// Returns the time of a query in the tree of boxes, in nanoseconds.
    fn box_nanoseconds(&self) -> f64 {
        self.work.nanoseconds(Cost::BOXES.work)
    }

    fn query_nanoseconds(&self, structure: SearchStructure, cost: &Cost) -> f64 {
        let has_long_lists = self.has_slivers && self.work.packets < MANY_PACKETS;
        let (boxes, inside) = (self.box_nanoseconds(), self.work.nanoseconds(cost.work));
        if structure == SearchStructure::Exhaustive {
            return cost.primitive * self.primitives;
        }
        if !structure.has_cells() {
            return inside;
        }
        if !self.may_have_cells() || has_long_lists {
            return boxes;
        }
        let outside = cost.outside.map_or(inside, |[part, root]| {
            let of_triangles = part * boxes + root * self.primitives.sqrt().sqrt();
            self.triangle_part * of_triangles + (1.0 - self.triangle_part) * inside
        });
        self.inside * inside + (self.near - self.inside) * outside + (1.0 - self.near) * boxes
    }

    /// Returns whether the scene is large enough for cells.
    pub(super) fn may_have_cells(&self) -> bool {
        self.primitives >= MIN_PRIMITIVES_FOR_CELLS
    }

    /// Sets the work that was counted in an index itself. Cells of slivers fall back to the fastest tree.
    pub(super) fn set_counted(&self, estimates: &mut [Estimate], i: usize, own: Work) {
        let nanoseconds = estimates[i].counted.map_or(0.0, |times| own.nanoseconds(times));
        self.set_query(&mut estimates[i], nanoseconds);
        let part = (nanoseconds / self.box_nanoseconds()).min(1.0);
        for estimate in estimates.iter_mut().filter(|e| e.backend.structure.has_cells()) {
            self.set_query(estimate, estimate.query_seconds * 1e9 * part);
        }
    }

    /// Sets the time of a query, in nanoseconds.
    fn set_query(&self, estimate: &mut Estimate, nanoseconds: f64) {
        estimate.query_seconds = nanoseconds * 1e-9;
        estimate.total_seconds = estimate.seconds_for(self.queries);
    }
}

impl Estimate {
    /// Returns the time to build the index and to answer this number of queries, in seconds.
    fn seconds_for(&self, queries: f64) -> f64 {
        self.build_seconds + queries * self.query_seconds
    }

    /// Returns the number of queries from which on `self` takes less time than `other`, which is built sooner.
    fn pays_from(&self, other: &Self) -> Option<f64> {
        let queries = (self.build_seconds - other.build_seconds) / (other.query_seconds - self.query_seconds);
        (queries > 0.0 && queries.is_finite()).then_some(queries)
    }

    /// Returns the name of the backend, and whether its cells are finer.
    fn name(&self) -> String {
        format!("{}{}", self.backend, if self.resolution.is_some() { " with finer cells" } else { "" })
    }
}

/// Ranks estimates by total time, permitted ones first. Of equal ones the tree is the first.
pub(super) fn rank(estimates: &mut [Estimate], max_bytes: f64) {
    let is_default = |e: &Estimate| e.backend == BackendEntry::default_backend();
    estimates.sort_by(|a, b| {
        let by_total = a.total_seconds.total_cmp(&b.total_seconds);
        b.is_permitted.cmp(&a.is_permitted).then(by_total).then(is_default(b).cmp(&is_default(a)))
    });
    let [best, others @ ..] = estimates else { return };
    let cells = if best.resolution.is_some() { ", with finer cells" } else { "" };
    best.reason = format!("the least time for building and all queries{cells}");
    for other in others {
        other.break_even = other.pays_from(best);
        other.is_about_best = other.is_permitted && other.total_seconds <= best.total_seconds * MODEL_ERROR;
        let is_slow = other.build_seconds > best.build_seconds;
        other.reason = match other.break_even.map(rounded) {
            _ if other.is_about_best => format!("about equal to {}", best.name()),
            _ if !other.is_permitted && other.bytes > max_bytes => "takes more memory than there may be".to_owned(),
            _ if !other.is_permitted => "is no index that can be saved or used again".to_owned(),
            Some(n) if is_slow => format!("takes longer to build; it pays from {n} queries on"),
            Some(n) => format!("is built sooner, but pays up to {n} queries alone"),
            None if is_slow => "takes longer to build, and is not faster then".to_owned(),
            None => "takes longer for queries".to_owned(),
        };
    }
}

/// Returns the fastest estimates for all numbers of queries, each with the number from which on it has the least total
/// time.
///
/// The total time is a line over the number of queries, so this walks along the lower envelope of the lines. It begins
/// with the index that is built soonest, and goes on with whichever index with faster queries pays first.
pub(super) fn turns<'e>(estimates: impl Iterator<Item = &'e Estimate> + Clone) -> Vec<(&'e Estimate, f64)> {
    let by_query = |a: &Estimate, b: &Estimate| a.query_seconds.total_cmp(&b.query_seconds);
    let first = estimates.clone().min_by(|a, b| a.build_seconds.total_cmp(&b.build_seconds).then(by_query(a, b)));
    let mut turns: Vec<_> = first.map(|first| (first, 0.0)).into_iter().collect();
    while let Some(&(current, _)) = turns.last() {
        let next = estimates.clone().filter_map(|other| Some((other, other.pays_from(current)?)));
        let next = next.filter(|(other, _)| other.query_seconds < current.query_seconds);
        let Some(next) = next.min_by(|a, b| a.1.total_cmp(&b.1).then(by_query(a.0, b.0))) else { break };
        turns.push(next);
    }
    turns
}

/// Describes from which numbers of queries on other indexes than the default tree take the least time.
pub(super) fn turns_in_words(turns: &[(&Estimate, f64)]) -> String {
    let is_default = |(estimate, _): &&(&Estimate, f64)| estimate.backend == BackendEntry::default_backend();
    let later = turns.iter().skip_while(|turn| !is_default(turn)).skip(1);
    let parts: Vec<_> = later.map(|(estimate, from)| format!("{} from {}", estimate.name(), rounded(*from))).collect();
    match parts.split_first() {
        None => "no number of queries pays for another index".to_owned(),
        Some((first, others)) => {
            let first = first.replacen(" from ", " pays from about ", 1);
            [&[format!("{first} queries on")], others].concat().join(", ")
        }
    }
}

/// Returns a number with two digits, as people read it.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least 0 and rounded")]
fn rounded(number: f64) -> String {
    let unit = 10f64.powf(number.max(10.0).log10().floor() - 1.0);
    let number = (number / unit).round() * unit;
    match number.round() as u64 {
        small @ ..1000 => small.to_string(),
        n @ 1000..1_000_000 => format!("{},{:03}", n / 1000, n % 1000),
        _ => format!("{:.1} million", number / 1e6),
    }
}
