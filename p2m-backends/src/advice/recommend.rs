//! The recommendation: which backends are measured on which samples, and how the results are scaled to the scene.

use super::estimate::{Advice, Estimate};
use super::sample::{is_mostly_slivers, is_near_surface, neighbourhood_sample, sample_queries, subsample};
use super::workload::Workload;
use crate::registry::{BACKENDS, BackendEntry, BuildSettings, SearchStructure};
use nalgebra::Point3;
use p2m_core::{BuildError, Closest, PrimitiveSet, QueryOptions, Soup};
use std::sync::Arc;
use std::time::Instant;

/// The part of the expected time of the job that advice may take.
const TIME_SHARE: f64 = 0.015;
/// The part of the time for a sample that its queries may take.
const QUERY_TIME_DIVISOR: f64 = 3.0;
/// Backends whose build takes longer than this factor of the total time of the AABB tree are not measured. It is
/// larger than 1 because estimates without measurements are rough.
const MAX_BUILD_PER_TREE_TOTAL: f64 = 2.0;
/// The smallest number of primitives of a sample.
const MIN_SAMPLE_PRIMITIVES: usize = 300;
/// The largest number of primitives of a sample.
const MAX_SAMPLE_PRIMITIVES: usize = 65_536;
/// The smallest number of queries that are timed.
const MIN_SAMPLE_QUERIES: usize = 64;
/// The largest number of queries that are timed.
const MAX_SAMPLE_QUERIES: usize = 512;
/// The larger sample has at least this many times the primitives of the smallest one.
const MIN_SAMPLE_GROWTH: usize = 2;
/// The time that taking a sample needs for each primitive of the scene, in seconds.
const SAMPLING_SECONDS_PER_PRIMITIVE: f64 = 30e-9;
/// The largest build time per primitive of the larger sample, relative to that of the smallest sample.
const MAX_BUILD_GROWTH: f64 = 2.0;
/// The smallest number of primitives for which the octree has budgets.
const MIN_OCTREE_BUDGET_PRIMITIVES: f64 = 10_000.0;

/// Recommends an index for a scene and a workload.
///
/// ```
/// use p2m_backends::{QueryRegion, SearchStructure, Workload, recommend};
/// use p2m_mixed::generate::{IcoSphere, ico_sphere};
///
/// let ball = ico_sphere(&IcoSphere::default()).unwrap();
/// // One query is not worth an index; ten million are.
/// let advice = recommend(&ball, &Workload::new(1, QueryRegion::SceneBox))?;
/// assert_eq!(advice.backend().structure, SearchStructure::Exhaustive);
/// let advice = recommend(&ball, &Workload::new(10_000_000, QueryRegion::SceneBox))?;
/// assert_ne!(advice.backend().structure, SearchStructure::Exhaustive);
/// println!("{}: {}", advice.backend(), advice.estimates[0].reason());
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// # Errors
/// [`BuildError`] if the scene has coordinates that are not finite.
///
/// # Complexity
/// O(n) for the samples, and some per cent of the expected time of the job.
pub fn recommend(soup: &Soup<f64>, workload: &Workload<'_>) -> Result<Advice, BuildError> {
    let start = Instant::now();
    let mut comparison = Comparison::new(soup, workload);
    comparison.measure_samples(&start)?;
    comparison.finish_estimates();
    let Comparison { estimates, sample_primitives, .. } = comparison;
    Ok(Advice::rank(estimates, workload.max_bytes, start.elapsed().as_secs_f64(), sample_primitives))
}

/// The state of a recommendation.
struct Comparison<'a> {
    soup: &'a Soup<f64>,
    workload: &'a Workload<'a>,
    /// The number of primitives of the scene, at least 1.
    primitives: f64,
    is_near: bool,
    has_slivers: bool,
    /// The estimates, in the order of [`BACKENDS`].
    estimates: Vec<Estimate>,
    /// The expected time to build each backend over the next sample, in seconds for each of its primitives.
    sample_build_seconds: Vec<f64>,
    /// The number of primitives of the last sample, or 0.
    sample_primitives: usize,
    /// The largest number of seconds for a build of a backend that is measured.
    max_build_seconds: f64,
}

impl<'a> Comparison<'a> {
    fn new(soup: &'a Soup<f64>, workload: &'a Workload<'a>) -> Self {
        let primitives = soup.len().max(1) as f64;
        let is_near = is_near_surface(soup, workload.region);
        let mut estimates: Vec<Estimate> =
            BACKENDS.iter().map(|backend| Estimate::unmeasured(backend, primitives, is_near)).collect();
        let tree = *tree_estimate(&estimates);
        let has_slivers = is_mostly_slivers(soup);
        if has_slivers {
            for estimate in estimates.iter_mut().filter(|e| is_tree(e)) {
                estimate.query_seconds = tree.query_seconds * estimate.backend.cost.sliver_query_factor;
            }
        }
        let max_build_seconds = MAX_BUILD_PER_TREE_TOTAL * tree.seconds_for(workload.queries as f64);
        let sample_build_seconds = estimates.iter().map(|e| e.build_seconds / primitives).collect();
        Self {
            soup,
            workload,
            primitives,
            is_near,
            has_slivers,
            estimates,
            sample_build_seconds,
            sample_primitives: 0,
            max_build_seconds,
        }
    }

    /// The total time of a backend for the workload, in seconds.
    fn total_seconds(&self, estimate: &Estimate) -> f64 {
        estimate.seconds_for(self.workload.queries as f64)
    }

    /// Whether a backend may turn out to be the best one: a tree, or one whose build is not much longer than the whole
    /// job with a tree.
    ///
    /// Cells of slivers fall back to trees, and exhaustive searches take as long as expected, so neither is measured.
    fn may_win(&self, estimate: &Estimate) -> bool {
        let is_exhaustive = estimate.backend.structure == SearchStructure::Exhaustive;
        is_tree(estimate) || !is_exhaustive && !self.has_slivers && estimate.build_seconds < self.max_build_seconds
    }

    /// Measures the backends that may win on the smallest sample, and those that may still win on one as large
    /// as time permits.
    ///
    /// Some scenes have a hundred times the usual time to build cells of vertices. The smallest sample shows that
    /// before a larger one would take too long.
    fn measure_samples(&mut self, start: &Instant) -> Result<(), BuildError> {
        for is_first in [true, false] {
            let affordable = self.affordable_sample(start.elapsed().as_secs_f64());
            let Some((contenders, size, query_count)) = affordable else { return Ok(()) };
            let size = if is_first { MIN_SAMPLE_PRIMITIVES.min(size) } else { size };
            let sample =
                if self.is_near { neighbourhood_sample(self.soup, size)? } else { subsample(self.soup, size)? };
            let sample = Arc::new(sample);
            self.sample_primitives = sample.len();
            let queries = sample_queries(self.soup, &sample, self.workload.region, query_count);
            for i in contenders {
                let measured = measure(self.estimates[i].backend, &sample, &queries)?;
                self.scale(i, &measured, &sample);
            }
        }
        Ok(())
    }

    /// Returns the backends that may win, the number of primitives of the largest sample that there is time for, and
    /// the number of queries; `None` if that sample would be too small.
    fn affordable_sample(&self, spent_seconds: f64) -> Option<(Vec<usize>, usize, usize)> {
        let best = self.estimates.iter().map(|e| self.total_seconds(e)).fold(f64::INFINITY, f64::min);
        let seconds = (best * TIME_SHARE).min(self.workload.max_time.as_secs_f64()) - spent_seconds;
        let contenders: Vec<usize> = (0..self.estimates.len()).filter(|i| self.may_win(&self.estimates[*i])).collect();
        let build_seconds: f64 = contenders.iter().map(|i| self.sample_build_seconds[*i]).sum();
        // All queries are timed twice.
        let seconds_per_query: f64 = contenders.iter().map(|i| 2.0 * self.estimates[*i].query_seconds).sum();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let query_count =
            ((seconds / QUERY_TIME_DIVISOR / seconds_per_query) as usize).clamp(MIN_SAMPLE_QUERIES, MAX_SAMPLE_QUERIES);
        let query_seconds = query_count as f64 * seconds_per_query;
        let sampling_seconds = 2.0 * SAMPLING_SECONDS_PER_PRIMITIVE * self.primitives;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let affordable = ((seconds - query_seconds - sampling_seconds) / build_seconds) as usize;
        let size = affordable.min(MAX_SAMPLE_PRIMITIVES).min(self.soup.len());
        let is_useful = size >= (MIN_SAMPLE_GROWTH * self.sample_primitives).max(MIN_SAMPLE_PRIMITIVES);
        is_useful.then_some((contenders, size, query_count))
    }

    /// Replaces the estimate of a backend by what was measured on a sample, scaled to the whole scene.
    fn scale(&mut self, i: usize, measured: &Measured, sample: &Soup<f64>) {
        let backend = self.estimates[i].backend;
        let cost = &backend.cost;
        let sample_primitives = sample.len() as f64;
        let per_primitive = self.primitives / sample_primitives;
        // A P2M index has cells of vertices. The primitives of a subsample hardly share any, so it has more cells for
        // each primitive than the scene.
        let positions = self.soup.positions().len() as f64;
        let per_vertex_and_primitive = (per_primitive * positions / sample.positions().len().max(1) as f64).sqrt();
        let size_factor = match backend.structure {
            SearchStructure::VertexCells => per_vertex_and_primitive,
            _ => per_primitive,
        };
        let growth = if self.is_near { cost.near_growth } else { cost.box_growth };
        let growth = growth.powf((self.primitives / sample_primitives).log2());
        let is_corrected = !self.has_slivers && sample.len() < self.soup.len();
        let growth = if is_corrected { growth * cost.sample_correction } else { growth };
        let estimate = &mut self.estimates[i];
        estimate.build_seconds = measured.build_seconds * size_factor;
        estimate.query_seconds = measured.query_seconds * growth;
        estimate.bytes = measured.bytes * size_factor;
        estimate.is_measured = true;
        self.sample_build_seconds[i] = MAX_BUILD_GROWTH * measured.build_seconds / sample_primitives;
    }

    /// Computes the total times. Cells of slivers fall back to a tree, which determines the time of their queries.
    fn finish_estimates(&mut self) {
        let tree_query_seconds = tree_estimate(&self.estimates).query_seconds;
        let queries = self.workload.queries as f64;
        for estimate in &mut self.estimates {
            if self.has_slivers && estimate.backend.structure.has_cells() {
                estimate.query_seconds = tree_query_seconds;
            }
            estimate.total_seconds = estimate.seconds_for(queries);
        }
    }
}

fn is_tree(estimate: &Estimate) -> bool {
    estimate.backend.structure == SearchStructure::Tree
}

/// The estimate of the tree that others are compared with: the first one of the registry.
fn tree_estimate(estimates: &[Estimate]) -> &Estimate {
    estimates.iter().find(|e| is_tree(e)).expect("the registry has a tree")
}

/// The costs of a backend over a sample, on one thread.
struct Measured {
    build_seconds: f64,
    /// The time of one query, in seconds.
    query_seconds: f64,
    /// The memory of the index besides the scene, in bytes.
    bytes: f64,
}

/// Builds a backend over a sample and times the queries.
fn measure(backend: &BackendEntry, sample: &Arc<Soup<f64>>, queries: &[Point3<f64>]) -> Result<Measured, BuildError> {
    // A small sample has to get as small a part of the budgets as it has of the scene.
    let budget_scale = (sample.len() as f64 / MIN_OCTREE_BUDGET_PRIMITIVES).min(1.0);
    let settings = BuildSettings::default().with_parallel(false).with_octree_budget_scale(budget_scale);
    let start = Instant::now();
    let index = backend.build(Arc::clone(sample), &settings)?.index;
    let build_seconds = start.elapsed().as_secs_f64();
    let mut answers: Vec<Option<Closest<f64>>> = vec![None; queries.len()];
    // The second pass finds in the cache what it needs, as a query amid many others does.
    let mut best_seconds = f64::INFINITY;
    for _ in 0..2 {
        let start = Instant::now();
        index.closest_points_into(queries, &QueryOptions::default(), &mut answers);
        best_seconds = best_seconds.min(start.elapsed().as_secs_f64());
    }
    std::hint::black_box(&answers);
    let query_seconds = best_seconds / queries.len().max(1) as f64;
    Ok(Measured { build_seconds, query_seconds, bytes: index.memory_bytes() as f64 })
}
