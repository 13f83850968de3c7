//! Measures p2m and its rivals: speed, memory, agreement.
//!
//! `p2m-bench query` builds every contender over a scene and lets them answer sets of queries in turns, in one process,
//! on one thread, one call at a time; `p2m-bench verify` compares our exact backends with brute force, bit for bit.
//!
//! The default build is portable. Figures of rivals that need compile-time target features come from
//! `RUSTFLAGS="-C target-cpu=native" cargo run --release -p p2m-bench -- query ...`; the line above the tables, and the
//! column `label` of a record, say which build it was.
#![forbid(unsafe_code)]

mod adversaries;
mod advise;
mod agree;
mod backends;
mod batch;
mod bvh_crate;
mod contender;
mod delaunay;
mod extremes;
mod field;
mod kdop;
mod kinds;
mod measure;
mod memory;
mod octree;
mod paper;
mod rays;
mod report;
mod rivals;
mod saved;
mod scene;
mod splits;
mod tradeoff;
mod verify;

use crate::contender::{Backend, ScalarKind};
use crate::measure::Effort;
use crate::scene::Scene;
use anyhow::{Context, Result};
use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::{Provenance, Table, queries};
use std::path::PathBuf;
use std::process::ExitCode;

/// Measures p2m and its rivals.
#[derive(Parser)]
#[command(after_help = "\
The default release build is portable. For the native rows of the rivals:\n  \
RUSTFLAGS=\"-C target-cpu=native\" cargo run --release -p p2m-bench -- query ...\n\
Both can add to the same --csv file; its column `label` tells them apart.\n\
Times are thread CPU times; pin the process as well: taskset -c 1 p2m-bench query ...")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Build, memory, time per query and agreement of all contenders
    Query(QueryArguments),
    /// Our exact backends against brute force, bit for bit, in f64 and f32; fails on any difference
    Verify(VerifyArguments),
    /// The split rules of the AABB tree: build, nodes and primitives visited, time per query
    Splits(SplitsArguments),
    /// The figures of the k-DOP tree's manual: build, nodes and leaves visited, time per query
    Kdop(KdopArguments),
    /// Rays: the figures of the k-DOP tree's manual, or the first hit against rivals; fails if ours differ
    Ray(RayArguments),
    /// The evaluation of the P2M paper on our models: writes paper.md with its tables and plots; fails if ours differ
    Paper(PaperArguments),
    /// Speed against accuracy of all backends and settings: writes report.html, its plots and report.csv
    Report(ReportArguments),
    /// The accuracy contract where others break: writes extremes.md; fails if ours break it anywhere
    Extremes(ExtremesArguments),
    /// Two records of `report`: what became faster or slower beyond noise, and which errors changed
    Compare(CompareArguments),
    /// What is recommended for 10^5 and 10^7 queries, against what would have been best
    Advise(AdviseArguments),
    /// Distance fields on a grid, against rivals and the figures of the article; fails if ours differ
    Field(FieldArguments),
    /// Scenes that are made to be bad: writes adversaries.md; fails if a budget is exceeded or an answer is wrong
    Adversaries(AdversariesArguments),
    /// One rival over one of these, for `adversaries`
    #[command(hide = true)]
    Rival(RivalArguments),
    /// Saving and loading indexes, against building them
    Saved(SavedArguments),
    /// The settings of the octree: resolution, domain, threads
    Octree(BatchArguments),
    /// Delaunay tetrahedra of vertices, and of grids, a sphere, a plane and a line; fails if any is not valid
    Delaunay(DelaunayArguments),
    /// Batches on the AABB tree: order, hints and threads, in wall time
    Batch(BatchArguments),
}

/// What both commands take.
#[derive(Args)]
struct Common {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Query sets
    #[arg(long, value_delimiter = ',', default_values_t = QuerySet::ALL)]
    sets: Vec<QuerySet>,
    /// Scalars of contenders
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [ScalarKind::Single, ScalarKind::Double])]
    scalar: Vec<ScalarKind>,
    /// Seed of the query sets
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Args)]
struct QueryArguments {
    #[command(flatten)]
    common: Common,
    /// Contenders
    #[arg(long, value_delimiter = ',', default_value = backends::DEFAULT, value_parser = backend_names())]
    backends: Vec<String>,
    /// Rounds; every contender begins one in turn
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Queries a round; contenders slower than 20 us a query get 20,000 at most, brute force what takes a second
    #[arg(long, default_value_t = 200_000)]
    queries: usize,
    /// Builds of each index
    #[arg(long, default_value_t = 5)]
    builds: usize,
    /// Record to make or to add to, as comma-separated values; a file with other columns is refused
    #[arg(long)]
    csv: Option<PathBuf>,
    /// Name of this build in tables and record [default: native with AVX2 at compile time, else portable]
    #[arg(long)]
    label: Option<String>,
}

#[derive(Args)]
struct VerifyArguments {
    #[command(flatten)]
    common: Common,
    /// Backends [default: all exact ones of ours]
    #[arg(long, value_delimiter = ',', value_parser = backend_names())]
    backends: Vec<String>,
    /// Queries of each set
    #[arg(long, default_value_t = 5000)]
    queries: usize,
}

#[derive(Args)]
struct SplitsArguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Query sets
    #[arg(long, value_delimiter = ',', default_values_t = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near, QuerySet::Surface])]
    sets: Vec<QuerySet>,
    /// Rounds; every rule begins one in turn
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Queries a round
    #[arg(long, default_value_t = 50_000)]
    queries: usize,
    /// Seed of the query sets
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Args)]
struct KdopArguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Each scene in seven orientations
    #[arg(long)]
    turned: bool,
    /// Query set
    #[arg(long, default_value_t = QuerySet::Box1)]
    set: QuerySet,
    /// Rounds; every tree begins one in turn
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Queries a round
    #[arg(long, default_value_t = 100_000)]
    queries: usize,
    /// Seed of the query set
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Args)]
struct RayArguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Each scene in seven orientations
    #[arg(long)]
    turned: bool,
    /// The first hit against rivals, in place of the manual's tables
    #[arg(long)]
    rivals: bool,
    /// The same with these contenders only
    #[arg(long, value_delimiter = ',', value_parser = ray_names())]
    backends: Vec<String>,
    /// Query sets at which rays begin [default: 1x for the manual's tables, 10x and 1x against rivals]
    #[arg(long, value_delimiter = ',')]
    sets: Vec<QuerySet>,
    /// Rays a round [default: 20 for each primitive for the manual's tables, 200,000 against rivals]
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    rays: Option<u64>,
    /// Rounds; contenders take turns
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Seed of the rays
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Record of times against rivals to make or to add to, as comma-separated values
    #[arg(long)]
    csv: Option<PathBuf>,
    /// Name of this build in tables and record [default: native with AVX2 at compile time, else portable]
    #[arg(long)]
    label: Option<String>,
}

#[derive(Args)]
struct BatchArguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Query sets
    #[arg(long, value_delimiter = ',', default_values_t = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near, QuerySet::Surface])]
    sets: Vec<QuerySet>,
    /// Numbers of threads
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2])]
    threads: Vec<usize>,
    /// Rounds, in which all contenders take turns
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Queries a round
    #[arg(long, default_value_t = 1_000_000)]
    queries: usize,
    /// Seed of the query sets
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Args)]
struct DelaunayArguments {
    /// Files of scenes, whose vertices are triangulated besides the generated points
    scenes: Vec<PathBuf>,
    /// Rounds; every input has its turn
    #[arg(long, default_value_t = 5, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    rounds: usize,
}

/// Of this program, run from its checkout.
pub(crate) fn provenance(label: Option<&str>) -> Provenance {
    Provenance::collect(label, Some(env!("CARGO_MANIFEST_DIR").as_ref()))
}

fn backend_names() -> PossibleValuesParser {
    backends::ALL.iter().map(|backend| backend.name).collect::<Vec<_>>().into()
}

fn ray_names() -> PossibleValuesParser {
    rays::ALL.iter().map(|backend| backend.name).collect::<Vec<_>>().into()
}

fn main() -> Result<ExitCode> {
    let good = match Cli::parse().command {
        Command::Query(arguments) => query(&arguments)?,
        Command::Verify(arguments) => verify_all(&arguments)?,
        Command::Splits(arguments) => splits(&arguments)?,
        Command::Kdop(arguments) => kdops(&arguments)?,
        Command::Ray(arguments) => ray(&arguments)?,
        Command::Octree(arguments) => octrees(&arguments)?,
        Command::Delaunay(arguments) => delaunays(&arguments)?,
        Command::Batch(arguments) => batches(&arguments)?,
        Command::Advise(arguments) => advice(&arguments)?,
        Command::Field(arguments) => fields(&arguments)?,
        Command::Adversaries(arguments) => adversaries(&arguments)?,
        Command::Rival(arguments) => rival(&arguments)?,
        Command::Saved(arguments) => saved_indexes(&arguments)?,
        Command::Report(arguments) => tradeoff_page(&arguments)?,
        Command::Extremes(arguments) => extreme_page(&arguments)?,
        Command::Compare(arguments) => compare_records(&arguments)?,
        Command::Paper(arguments) => paper_page(&arguments)?,
    };
    Ok(if good { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Those of the named contenders that have one of the scalars, in the order of the list.
fn select(common: &Common, wanted: impl Fn(&Backend) -> bool) -> Vec<&'static Backend> {
    backends::ALL.iter().filter(|b| common.scalar.contains(&b.scalar) && wanted(b)).collect()
}

/// Whether our backends agree; what rivals answer is for the reader of the table.
fn query(arguments: &QueryArguments) -> Result<bool> {
    let common = &arguments.common;
    let selected = select(common, |b| arguments.backends.iter().any(|name| name == b.name));
    let provenance = provenance(arguments.label.as_deref());
    let effort =
        Effort { rounds: arguments.rounds, queries: arguments.queries, builds: arguments.builds, seed: common.seed };
    let mut record = arguments.csv.as_deref().map(report::Record::open).transpose()?;
    println!("{provenance}");
    println!(
        "One thread, thread CPU time, {} rounds in turns, {} queries a round, seed {}.",
        effort.rounds, effort.queries, effort.seed
    );
    let mut good = true;
    for path in &common.scenes {
        let scene = Scene::read(path)?;
        let mut entries = measure::build_all(&scene, &selected, effort.builds);
        for set in &common.sets {
            measure::measure_set(&scene, *set, &mut entries, &effort);
        }
        report::print_scene(&scene, &common.sets, &entries, &provenance.label);
        if let Some(record) = &mut record {
            record.add(&provenance, &scene, &common.sets, &entries, effort.seed)?;
        }
        good &= entries
            .iter()
            .filter(|entry| entry.backend.ours)
            .all(|entry| entry.sets.iter().flatten().all(|set| set.agreement.is_clean()));
    }
    Ok(good)
}

#[derive(Args)]
struct PaperArguments {
    /// The folder of models [default: that of the variable P2M_MODELS, or ../shared/models]
    #[arg(long)]
    models: Option<PathBuf>,
    /// Less of everything, in minutes
    #[arg(long)]
    quick: bool,
    /// The folder for paper.md and the folder paper of its plots [default: docs, and target/paper with --quick]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Whether all answers of ours are bitwise the same.
fn paper_page(arguments: &PaperArguments) -> Result<bool> {
    let PaperArguments { models, quick, out } = arguments;
    let models = models.clone().unwrap_or_else(usual_models);
    let out = out.clone().unwrap_or_else(|| PathBuf::from(if *quick { "target/paper" } else { "docs" }));
    paper::write(&models, *quick, &out)
}

/// Where models are unless said otherwise.
fn usual_models() -> PathBuf {
    std::env::var_os("P2M_MODELS").map_or_else(|| PathBuf::from("../shared/models"), PathBuf::from)
}

#[derive(Args)]
struct ReportArguments {
    /// The folder of models [default: that of the variable P2M_MODELS, or ../shared/models]; without those that are needed, generated
    /// scenes stand in
    #[arg(long)]
    models: Option<PathBuf>,
    /// Three scenes and fewer queries, in two minutes
    #[arg(long)]
    quick: bool,
    /// The folder for report.html, report.csv and the folder report of plots [default: docs, and target/report with --quick]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Name of this build in page and record [default: native with AVX2 at compile time, else portable]
    #[arg(long)]
    label: Option<String>,
}

/// Whether all promises were kept.
fn tradeoff_page(arguments: &ReportArguments) -> Result<bool> {
    let ReportArguments { models, quick, out, label } = arguments;
    let models = models.clone().unwrap_or_else(usual_models);
    let out = out.clone().unwrap_or_else(|| PathBuf::from(if *quick { "target/report" } else { "docs" }));
    tradeoff::write(&models, *quick, &out, &provenance(label.as_deref()))
}

#[derive(Args)]
struct ExtremesArguments {
    /// Answers about isolated primitives that are checked
    #[arg(long, default_value_t = 1_000_000)]
    cases: u64,
    /// Scenes of each family, each asked about by every backend
    #[arg(long, default_value_t = 4)]
    scenes: u64,
    /// Of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Write the page here instead of printing it
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Whether ours kept all that they promise.
fn extreme_page(arguments: &ExtremesArguments) -> Result<bool> {
    let &ExtremesArguments { cases, scenes, seed, ref out } = arguments;
    extremes::write(&extremes::Amount { cases, scenes, seed }, out.as_deref(), &provenance(None))
}

#[derive(Args)]
struct CompareArguments {
    /// The record of before
    first: PathBuf,
    /// The record of after
    second: PathBuf,
}

/// A table; only what cannot be compared fails.
fn compare_records(arguments: &CompareArguments) -> Result<bool> {
    let read = |path: &PathBuf| -> Result<Vec<p2m_tradeoff::record::Line>> {
        let name = || path.display().to_string();
        let text = std::fs::read_to_string(path).with_context(name)?;
        p2m_tradeoff::record::read_record(&text).with_context(name)
    };
    let (first, second) = (read(&arguments.first)?, read(&arguments.second)?);
    print!("{}", p2m_tradeoff::compare::compare(&first, &second)?);
    Ok(true)
}

#[derive(Args)]
struct SavedArguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// How often to load
    #[arg(long, default_value_t = 5, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    rounds: usize,
}

#[derive(Args)]
struct AdversariesArguments {
    /// Primitives of each scene
    #[arg(long, default_value_t = 20_000, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    primitives: usize,
    /// The page to write [default: the standard output]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Whether all budgets were kept and all answers right.
fn adversaries(arguments: &AdversariesArguments) -> Result<bool> {
    adversaries::print(arguments.primitives, arguments.out.as_deref(), &provenance(None))
}

#[derive(Args)]
struct RivalArguments {
    /// Its name
    backend: String,
    /// The scene
    adversary: String,
    /// Primitives of the scene
    primitives: usize,
}

/// Prints what came of it, for the program that asked.
fn rival(arguments: &RivalArguments) -> Result<bool> {
    adversaries::attempt(&arguments.backend, &arguments.adversary, arguments.primitives)?;
    Ok(true)
}

#[derive(Args)]
struct AdviseArguments {
    /// Files of scenes; those of less than 1,000 primitives are left out
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
}

/// A table; there is nothing to fail.
fn advice(arguments: &AdviseArguments) -> Result<bool> {
    println!("{}", provenance(None));
    let mut table = Table::new(advise::HEAD);
    let mut worst = [1.0f64, 0.0];
    for path in &arguments.scenes {
        let scene = Scene::read(path)?;
        if scene.len() >= 1000 {
            let [ratio, share] = advise::add_rows(&scene, &mut table)?;
            worst = [worst[0].max(ratio), worst[1].max(share)];
        }
    }
    println!(
        "One thread, thread CPU time; totals are building and all queries, from {} of them. At worst {:.2} times the best, and \
         {:.1} % of the job for advice.\n\n{table}",
        advise::QUERIES,
        worst[0],
        100.0 * worst[1]
    );
    Ok(true)
}

#[derive(Args)]
struct FieldArguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Points along the longest side
    #[arg(long, default_value_t = 256, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..=2048))]
    resolution: usize,
    /// Every how many-th slab of sixteen layers is filled
    #[arg(long, default_value_t = 1, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    stride: usize,
    /// Only the figures of the article, beside ours
    #[arg(long)]
    article: bool,
}

/// Whether all fields of ours are the same.
fn fields(arguments: &FieldArguments) -> Result<bool> {
    println!("{}", provenance(None));
    let mut good = true;
    for path in &arguments.scenes {
        let scene = Scene::read(path)?;
        if arguments.article {
            field::print_article(&scene)?;
        } else {
            good &= field::print(&scene, arguments.resolution, arguments.stride)?;
        }
    }
    Ok(good)
}

/// Whether all loaded indexes answer as those that were built.
fn saved_indexes(arguments: &SavedArguments) -> Result<bool> {
    println!("{}", provenance(None));
    let mut good = true;
    for path in &arguments.scenes {
        good &= saved::print(&Scene::read(path)?, arguments.rounds)?;
    }
    Ok(good)
}

/// Whether all octrees agree.
fn octrees(arguments: &BatchArguments) -> Result<bool> {
    let BatchArguments { scenes, sets, threads, rounds, queries, seed } = arguments;
    let effort = Effort { rounds: *rounds, queries: *queries, builds: 3, seed: *seed };
    println!("{}", provenance(None));
    println!("{rounds} rounds in turns, {queries} queries a round, seed {seed}.");
    let mut good = true;
    for path in scenes {
        good &= octree::print(&Scene::read(path)?, sets, threads, &effort)?;
    }
    Ok(good)
}

/// Whether all triangulations are valid.
fn delaunays(arguments: &DelaunayArguments) -> Result<bool> {
    println!("{}", provenance(None));
    println!("One thread, thread CPU time.");
    delaunay::print(&arguments.scenes, arguments.rounds)
}

/// Whether all batches agree with single queries.
fn batches(arguments: &BatchArguments) -> Result<bool> {
    let BatchArguments { scenes, sets, threads, rounds, queries, seed } = arguments;
    println!("{}", provenance(None));
    println!("Wall time, {rounds} rounds in turns, batches of {queries}, seed {seed}.");
    let mut good = true;
    for path in scenes {
        good &= batch::print(&Scene::read(path)?, sets, *queries, threads, *rounds, *seed)?;
    }
    println!("{}", if good { "All answers are those of single queries." } else { "DIFFERENCES from single queries." });
    Ok(good)
}

/// Whether all trees agree.
fn kdops(arguments: &KdopArguments) -> Result<bool> {
    let KdopArguments { scenes, turned, set, rounds, queries, seed } = arguments;
    let effort = Effort { rounds: *rounds, queries: *queries, builds: *rounds, seed: *seed };
    println!("{}", provenance(None));
    println!("One thread, thread CPU time, {rounds} rounds in turns, {queries} queries of {set} a round, seed {seed}.");
    kdop::print_cited();
    let mut good = true;
    for path in scenes {
        let scene = Scene::read(path)?;
        let all = if *turned { kdop::orientations(&scene)? } else { vec![scene] };
        for scene in &all {
            good &= kdop::print(scene, *set, &effort);
        }
    }
    Ok(good)
}

/// Whether all trees agree.
fn ray(arguments: &RayArguments) -> Result<bool> {
    let RayArguments { scenes, turned, rivals, backends, sets, rays, rounds, seed, csv, label } = arguments;
    let versus = *rivals || !backends.is_empty();
    let provenance = provenance(label.as_deref());
    let mut record = csv.as_deref().map(report::Record::open).transpose()?;
    println!("{provenance}");
    println!("One thread, thread CPU time, {rounds} rounds in turns, seed {seed}.");
    let usual: &[QuerySet] = if versus { &[QuerySet::Box10, QuerySet::Box1] } else { &[QuerySet::Box1] };
    let sets = if sets.is_empty() { usual } else { sets };
    if !versus {
        rays::manual::print_cited();
    }
    let mut good = true;
    for path in scenes {
        let scene = Scene::read(path)?;
        let all = if *turned { kdop::orientations(&scene)? } else { vec![scene] };
        for scene in &all {
            let count =
                rays.map_or(Ok(if versus { 200_000 } else { rays::manual::RAYS_EACH * scene.len() }), usize::try_from)?;
            let effort = Effort { rounds: *rounds, queries: count, builds: 1, seed: *seed };
            if versus {
                good &= rays::versus::print(scene, sets, backends, &effort, &provenance, record.as_mut())?;
            } else {
                for set in sets {
                    good &= rays::manual::print(scene, *set, &effort)?;
                }
            }
        }
    }
    Ok(good)
}

/// Whether all trees agree.
fn splits(arguments: &SplitsArguments) -> Result<bool> {
    let SplitsArguments { scenes, sets, rounds, queries, seed } = arguments;
    let effort = Effort { rounds: *rounds, queries: *queries, builds: *rounds, seed: *seed };
    println!("{}", provenance(None));
    println!("One thread, thread CPU time, {rounds} rounds in turns, {queries} queries a round, seed {seed}.");
    let mut good = true;
    for path in scenes {
        good &= splits::print(&Scene::read(path)?, sets, &effort);
    }
    Ok(good)
}

fn verify_all(arguments: &VerifyArguments) -> Result<bool> {
    let common = &arguments.common;
    let oracles = select(common, |b| b.ours && b.exhaustive);
    let named = |b: &Backend| arguments.backends.is_empty() || arguments.backends.iter().any(|name| name == b.name);
    let contenders = select(common, |b| b.ours && !b.exhaustive && named(b));
    println!("{}", provenance(None));
    println!(
        "{} queries of each set, seed {}: how many answers equal those of brute force.",
        arguments.queries, common.seed
    );
    let mut equal = true;
    for path in &common.scenes {
        let scene = Scene::read(path)?;
        equal &= verify::verify(&scene, &oracles, &contenders, &common.sets, arguments.queries, common.seed);
    }
    println!("\n{}", if equal { "All equal." } else { "DIFFERENCES, see above." });
    Ok(equal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
