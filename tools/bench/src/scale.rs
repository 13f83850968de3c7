//! `p2m-bench scale`: the costs of each index as the scene grows, for docs/measurements/scale.md.
//!
//! The scene is a torus knot of more and more triangles. A size is left out for an index if its build would exceed the
//! limits on memory or time, as extrapolated from its last build.

use crate::backend::Unavailable;
use crate::blocks::Blocks;
use crate::command::{Document, at_least_one, index_names, provenance};
use crate::contest;
use crate::measure::{BuildFigures, MedianRange, measure_build};
use crate::memory;
use crate::rounds::{checksum, checksum_of_closest, thread_seconds};
use anyhow::{Context as _, Result};
use clap::Args;
use nalgebra::Point3;
use p2m_backends::{AnyIndex, BackendEntry, BuildSettings};
use p2m_cli::harness::Table;
use p2m_core::{PrimitiveSet, Soup};
use p2m_mixed::generate::{TorusKnot, torus_knot};
use p2m_testkit::queries::QuerySet;
use p2m_testkit::rng;
use rand::seq::SliceRandom;
use std::hint::black_box;
use std::sync::Arc;

/// The blocks of docs/measurements/scale.md.
pub(crate) const BLOCKS: Blocks<3> = Blocks { command: "scale", names: ["provenance", "builds", "queries"] };
/// The ratio of vertices around the tube of the knot to rings along it. With it, triangles are about as wide as long.
const SIDES_PER_RING: f64 = 0.06;
/// The number of queries for which visits are counted.
const COUNTED: usize = 2000;
/// The number of dependent reads in a measurement of the latency of memory.
const READS: usize = 2_000_000;
/// The number of times that the latency is measured.
const LATENCY_ROUNDS: usize = 5;
/// The seconds below which a build is repeated.
const SHORT_BUILD_SECONDS: f64 = 1.0;

#[derive(Args)]
pub(crate) struct Arguments {
    /// Backends of the registry
    #[arg(long, value_delimiter = ',', default_value = "aabb,kdop,octree,p2m", value_parser = index_names())]
    backends: Vec<String>,
    /// Numbers of triangles, in ascending order
    #[arg(long, value_delimiter = ',', default_values_t = [10_000, 100_000, 1_000_000, 10_000_000, 100_000_000])]
    sizes: Vec<usize>,
    /// Query sets
    #[arg(long, value_delimiter = ',', default_values_t = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near])]
    sets: Vec<QuerySet>,
    /// Queries in a round
    #[arg(long, default_value_t = 200_000)]
    queries: usize,
    /// Rounds of queries, and builds that take less than a second
    #[arg(long, default_value_t = 5, value_parser = at_least_one())]
    rounds: usize,
    /// The largest number of heap bytes at a time; a size that would take more is left out for that index
    #[arg(long, default_value_t = 20_000_000_000)]
    max_memory: usize,
    /// The longest time of a build in seconds; a size that would take longer is left out for that index
    #[arg(long, default_value_t = 900.0)]
    max_seconds: f64,
    #[command(flatten)]
    document: Document,
}

/// The costs of an index over a scene.
struct Costs {
    triangles: usize,
    build_seconds: f64,
    /// The bytes of the index without the scene.
    owned: usize,
    /// The largest number of bytes of the build without the scene.
    peak: usize,
    /// The nanoseconds of a dependent read in an array as large as the index.
    latency: f64,
    sets: Vec<SetCosts>,
}

/// The costs of a query of a set.
struct SetCosts {
    /// The nanoseconds of a single query.
    single: f64,
    /// The nanoseconds of a query in a batch.
    batch: f64,
    /// The numbers of visited nodes, packets and primitives of a query.
    visits: [f64; 3],
    /// A checksum of all answers.
    checksum: u64,
}

impl SetCosts {
    /// Returns the number of nodes, packets and primitives that a query reads.
    fn reads(&self) -> f64 {
        self.visits.iter().sum()
    }
}

/// Measures and publishes all costs, and returns whether all backends have the same answers.
pub(crate) fn run(request: &Arguments) -> Result<bool> {
    BLOCKS.check(request.document.write.as_deref())?;
    let entries: Vec<&'static BackendEntry> =
        request.backends.iter().filter_map(|name| BackendEntry::find(name)).collect();
    let mut costs: Vec<Vec<Costs>> = entries.iter().map(|_| Vec::new()).collect();
    let mut is_equal = true;
    for &size in &request.sizes {
        let (soup, scene_bytes) = memory::measured(|| knot(size));
        let soup = Arc::new(soup?);
        let queries: Vec<Vec<Point3<f64>>> =
            request.sets.iter().map(|set| set.generate(&soup, request.queries, 1)).collect();
        let mut sums = Vec::new();
        for (entry, costs) in entries.iter().zip(&mut costs) {
            if let Some(reason) = obstacle(costs, soup.len(), scene_bytes, request) {
                eprintln!("{} is not built over {} triangles: {reason}", entry.name, soup.len());
                continue;
            }
            let found = measure(entry, &soup, &queries, request.rounds)?;
            eprintln!("{}, {} triangles: built in {:.2} s", entry.name, soup.len(), found.build_seconds);
            sums.push(found.sets.iter().map(|set| set.checksum).collect::<Vec<_>>());
            costs.push(found);
        }
        is_equal &= sums.windows(2).all(|pair| pair[0] == pair[1]);
    }
    publish(request, &entries, &costs)?;
    Ok(is_equal)
}

/// Returns a torus knot with about this number of triangles.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "numbers of rings and sides are small")]
fn knot(triangles: usize) -> Result<Soup<f64>> {
    let vertices = triangles as f64 / 2.0;
    let rings = (vertices / SIDES_PER_RING).sqrt().round().max(3.0);
    let sides = (vertices / rings).round().max(3.0);
    Ok(torus_knot(&TorusKnot { rings: rings as u32, sides: sides as u32, ..Default::default() })?)
}

/// Returns the reason, if any, why an index should not be built over this number of triangles, given its last build.
fn obstacle(costs: &[Costs], triangles: usize, scene_bytes: usize, request: &Arguments) -> Option<String> {
    let last = costs.last()?;
    let factor = triangles as f64 / last.triangles as f64;
    let (bytes, seconds) = (last.peak as f64 * factor + scene_bytes as f64, last.build_seconds * factor);
    if bytes > request.max_memory as f64 {
        return Some(format!("it would take {:.1} GB", bytes / 1e9));
    }
    (seconds > request.max_seconds).then(|| format!("it would take {seconds:.0} s"))
}

/// Builds an index and measures its queries.
fn measure(
    entry: &'static BackendEntry,
    soup: &Arc<Soup<f64>>,
    queries: &[Vec<Point3<f64>>],
    rounds: usize,
) -> Result<Costs> {
    let settings = BuildSettings::default().with_parallel(false);
    let mut figures = BuildFigures::default();
    let mut index = None;
    while figures.seconds.len() < rounds && figures.seconds.iter().sum::<f64>() < SHORT_BUILD_SECONDS {
        drop(index.take());
        let before = memory::current();
        let built = measure_build(&mut figures, before, || {
            entry.build(Arc::clone(soup), &settings).map_err(Unavailable::because)
        });
        let built = built.with_context(|| format!("{} over {} triangles", entry.name, soup.len()))?;
        index = Some(built.index);
    }
    let index = index.context("there has to be at least one round")?;
    let sets = queries.iter().map(|queries| measure_set(&*index, queries, rounds)).collect();
    drop(index);
    Ok(Costs {
        triangles: soup.len(),
        build_seconds: MedianRange::of(&figures.seconds).map_or(f64::NAN, |range| range.median),
        owned: figures.owned,
        peak: figures.peak,
        latency: latency(figures.owned),
        sets,
    })
}

/// Measures the queries of a set, one by one and as a batch in turns.
fn measure_set(index: &dyn AnyIndex<f64>, queries: &[Point3<f64>], rounds: usize) -> SetCosts {
    let scores = contest::measure(queries, &mut contest::single_and_batch(index), rounds, &None);
    let [single, batch] = [&scores[0], &scores[1]];
    let counted = &queries[..COUNTED.min(queries.len())];
    let visits = index.count_queries(counted);
    let sums = [checksum_of_closest(&single.answers), checksum_of_closest(&batch.answers)];
    SetCosts {
        single: single.seconds.median * 1e9,
        batch: batch.seconds.median * 1e9,
        visits: visits.map(|count| count as f64 / counted.len() as f64),
        checksum: checksum(sums[0], [(sums[1], 0)].into_iter()),
    }
}

/// Returns the nanoseconds of a read in an array of this many bytes, if each address depends on the previous read.
fn latency(bytes: usize) -> f64 {
    const LINE: usize = 64;
    let lines = (bytes / LINE).max(2);
    let mut order: Vec<u32> = (0..u32::try_from(lines).unwrap_or(u32::MAX)).collect();
    order.shuffle(&mut rng("latency", 0));
    // The lines form one cycle in random order: each has the number of the line that is read next.
    let mut next = vec![[0u32; LINE / size_of::<u32>()]; lines];
    for pair in order.windows(2) {
        next[pair[0] as usize][0] = pair[1];
    }
    next[order[order.len() - 1] as usize][0] = order[0];
    drop(order);
    let walk = |steps: usize| (0..steps).fold(0u32, |at, _| black_box(next[at as usize][0]));
    // The shortest of several times is taken, because other processes share the caches.
    let times = (0..LATENCY_ROUNDS).map(|_| thread_seconds(|| black_box(walk(READS))).1);
    times.fold(f64::INFINITY, f64::min) * 1e9 / READS as f64
}

/// Prints the tables, or replaces the blocks of the document.
fn publish(request: &Arguments, entries: &[&'static BackendEntry], costs: &[Vec<Costs>]) -> Result<()> {
    let mut builds = Table::new(
        ["triangles", "index", "build s", "us per triangle", "bytes per triangle", "peak of the build"]
            .map(str::to_owned),
    );
    let heads = ["triangles", "index", "set", "one by one", "batch", "nodes", "packets", "primitives", "read", "reads"];
    let mut queries = Table::new(heads.map(str::to_owned));
    for (entry, costs) in entries.iter().zip(costs) {
        for cost in costs {
            let each = |bytes: usize| format!("{:.0}", bytes as f64 / cost.triangles as f64);
            let first = [cost.triangles.to_string(), entry.name.to_owned()];
            let us = cost.build_seconds * 1e6 / cost.triangles as f64;
            let seconds = [format!("{:.3}", cost.build_seconds), format!("{us:.2}")];
            builds.push([&first[..], &seconds, &[each(cost.owned), each(cost.peak)]].concat());
            for (set, found) in request.sets.iter().zip(&cost.sets) {
                let times = [found.single, found.batch].map(|ns| format!("{ns:.0}"));
                let visits = found.visits.map(|count| format!("{count:.1}"));
                let floor = [format!("{:.1}", cost.latency), format!("{:.0}", found.reads() * cost.latency)];
                queries.push([&first[..], &[set.to_string()], &times, &visits, &floor].concat());
            }
        }
    }
    let Arguments { queries: count, rounds, .. } = request;
    let origin =
        format!("{}\nOne thread, thread CPU time, medians of {rounds} rounds of {count} queries.", provenance());
    BLOCKS.publish(request.document.write.as_deref(), &[origin, builds.to_string(), queries.to_string()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_have_about_the_wanted_number_of_triangles() {
        for wanted in [10_000, 123_456, 1_000_000] {
            let found = knot(wanted).unwrap().len();
            assert!(found.abs_diff(wanted) * 20 < wanted, "{found} instead of {wanted}");
        }
    }

    #[test]
    fn builds_beyond_a_limit_are_not_tried() {
        let mut request = Arguments {
            backends: Vec::new(),
            sizes: Vec::new(),
            sets: Vec::new(),
            queries: 0,
            rounds: 1,
            max_memory: 2_000_000,
            max_seconds: 20.0,
            document: Document { write: None },
        };
        let last =
            Costs { triangles: 1000, build_seconds: 1.0, owned: 50_000, peak: 100_000, latency: 1.0, sets: Vec::new() };
        assert_eq!(obstacle(&[], 1_000_000, 0, &request), None);
        let costs = [last];
        assert_eq!(obstacle(&costs, 10_000, 500_000, &request), None);
        assert!(obstacle(&costs, 10_000, 1_500_000, &request).unwrap().contains("GB"));
        request.max_seconds = 5.0;
        assert_eq!(obstacle(&costs, 10_000, 0, &request).unwrap(), "it would take 10 s");
    }
}
