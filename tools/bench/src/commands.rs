//! The commands of `p2m-bench`: each reads its scenes, runs the measurement and prints the result.

use crate::arguments::{
    Command, Common, ExtremePairsArguments, ExtremesArguments, FieldArguments, InstancesArguments, PairsArguments,
    QueryArguments, RayArguments, ScaleArguments, ThreadsArguments, VerifyArguments,
};
use crate::backend::Backend;
use crate::measure::Effort;
use crate::report::provenance;
use crate::scene::Scene;
use crate::{backends, extremes, field, instances, measure, pairs, rays, report, scale, shards, threads, verify};
use anyhow::Result;
use std::path::PathBuf;

/// Runs a command, and returns whether it found what it has to find.
pub(crate) fn run(command: Command) -> Result<bool> {
    match command {
        Command::Query(arguments) => query(&arguments),
        Command::Verify(arguments) => verify(&arguments),
        Command::Ray(arguments) => cast_rays(&arguments),
        Command::Threads(arguments) => compare_threads(&arguments),
        Command::Instances(arguments) => time_instances(&arguments),
        Command::Pairs(arguments) => time_pairs(&arguments),
        Command::Scale(arguments) => measure_scale(arguments),
        Command::Shards(arguments) => shards::run(&arguments),
        Command::Field(arguments) => fill_fields(&arguments),
        Command::Extremes(arguments) => check_extremes(&arguments),
        Command::ExtremePairs(arguments) => check_extreme_pairs(&arguments),
    }
}

/// Returns the backends that `is_wanted` accepts and that have one of the scalars, in the order of the list.
fn select(common: &Common, is_wanted: impl Fn(&Backend) -> bool) -> Vec<&'static Backend> {
    backends::ALL.iter().filter(|b| common.scalar.contains(&b.scalar) && is_wanted(b)).collect()
}

/// Measures backends, and returns whether ours agree. Answers of external libraries are left to the reader
/// of the table.
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
    let mut is_good = true;
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
        is_good &= entries
            .iter()
            .filter(|entry| entry.backend.is_ours)
            .all(|entry| entry.sets.iter().flatten().all(|set| set.agreement.is_clean()));
    }
    Ok(is_good)
}

/// Checks extreme input, and returns whether our backends kept all promises.
fn check_extremes(arguments: &ExtremesArguments) -> Result<bool> {
    let &ExtremesArguments { cases, scenes, seed, ref document } = arguments;
    extremes::run(&extremes::Amount { cases, scenes, seed }, document.write.as_deref(), &provenance(None))
}

fn check_extreme_pairs(arguments: &ExtremePairsArguments) -> Result<bool> {
    let &ExtremePairsArguments { cases, seed, ref document } = arguments;
    extremes::pairs::run(cases, seed, document.write.as_deref(), &provenance(None))
}

/// Prints the origin of figures and a line about the measurement, measures scenes one by one, and returns whether all
/// are good.
fn all_good(scenes: &[PathBuf], about: &str, mut measure: impl FnMut(Scene) -> Result<bool>) -> Result<bool> {
    println!("{}\n{about}", provenance(None));
    scenes.iter().try_fold(true, |is_good, path| Ok(measure(Scene::read(path)?)? && is_good))
}

/// Describes a measurement in rounds.
fn in_rounds(time: &str, effort: &Effort) -> String {
    let Effort { rounds, queries, seed, .. } = effort;
    format!("{time}, {rounds} rounds in turns, {queries} queries a round, seed {seed}.")
}

/// Times distance fields, and returns whether ours are equal.
fn fill_fields(arguments: &FieldArguments) -> Result<bool> {
    all_good(&arguments.scenes, "", |scene| match arguments.article {
        true => field::print_article(&scene).map(|()| true),
        false => field::print(&scene, arguments.resolution, arguments.stride),
    })
}

/// Times builds on several numbers of threads. No result counts as bad.
fn compare_threads(arguments: &ThreadsArguments) -> Result<bool> {
    let ThreadsArguments { scenes, backends, threads, rounds } = arguments;
    let about = format!("Wall time of builds, median of {rounds} rounds in turns.");
    all_good(scenes, &about, |scene| threads::print(&scene, backends, threads, *rounds).map(|()| true))
}

/// Times a scene of instances, and returns whether it answers as one index over all of them.
fn time_instances(arguments: &InstancesArguments) -> Result<bool> {
    let &InstancesArguments { ref scenes, rounds, queries, seed, instances, triangles, rays } = arguments;
    let effort = Effort { rounds, queries, builds: rounds, seed };
    println!("{}\n{}", provenance(None), in_rounds("CPU time of one thread", &effort));
    let size = instances::Size { instances, triangles, rays };
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let is_good = one_thread.install(|| instances::print(scenes, &size, &effort))?;
    println!("{}", if is_good { "All answers are equal." } else { "DIFFERENT answers." });
    Ok(is_good)
}

/// Times distances between scenes, and returns whether our exact answers agree.
fn time_pairs(arguments: &PairsArguments) -> Result<bool> {
    let PairsArguments { scene, other, poses, arms, rounds, seed } = arguments;
    let effort = Effort { rounds: *rounds, queries: *poses, builds: 1, seed: *seed };
    println!("{}\n{}", provenance(None), in_rounds("One thread, thread CPU time", &effort));
    pairs::print(&Scene::read(scene)?, &Scene::read(other)?, *arms, &effort)
}

/// Measures scenes that grow, and returns whether our indexes have the same answers.
fn measure_scale(arguments: ScaleArguments) -> Result<bool> {
    let ScaleArguments { backends, sizes, sets, queries, rounds, max_memory, max_seconds, document } = arguments;
    let document = document.write;
    scale::run(&scale::Request { backends, sizes, sets, queries, rounds, max_memory, max_seconds, document })
}

/// Times rays, and returns whether all trees agree.
fn cast_rays(arguments: &RayArguments) -> Result<bool> {
    let &RayArguments { ref scenes, ref backends, ref sets, rays, rounds, seed, ref csv, ref label } = arguments;
    let provenance = provenance(label.as_deref());
    let mut record = csv.as_deref().map(report::Record::open).transpose()?;
    println!("{provenance}");
    println!("One thread, thread CPU time, {rounds} rounds in turns, seed {seed}.");
    let effort = Effort { rounds, queries: rays, builds: 1, seed };
    let mut is_good = true;
    for path in scenes {
        is_good &= rays::versus::print(&Scene::read(path)?, sets, backends, &effort, &provenance, record.as_mut())?;
    }
    Ok(is_good)
}

/// Compares our exact backends with brute force, and returns whether all answers are equal.
fn verify(arguments: &VerifyArguments) -> Result<bool> {
    let common = &arguments.common;
    let oracles = select(common, |b| b.is_ours && b.is_exhaustive);
    let named = |b: &Backend| arguments.backends.is_empty() || arguments.backends.iter().any(|name| name == b.name);
    let backends = select(common, |b| b.is_ours && !b.is_exhaustive && named(b));
    println!("{}", provenance(None));
    println!(
        "{} queries of each set, seed {}: how many answers equal those of brute force.",
        arguments.queries, common.seed
    );
    let mut is_equal = true;
    for path in &common.scenes {
        let scene = Scene::read(path)?;
        is_equal &= verify::verify(&scene, &oracles, &backends, &common.sets, arguments.queries, common.seed);
    }
    println!("\n{}", if is_equal { "All equal." } else { "DIFFERENCES, see above." });
    Ok(is_equal)
}
