//! The command line of `p2m-bench`: its commands and their arguments.

use crate::backend::ScalarKind;
use crate::{backends, rays};
use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use p2m_testkit::queries::QuerySet;
use std::path::PathBuf;

/// Measures p2m and other libraries.
#[derive(Parser)]
#[command(after_help = "\
The default release build is portable. For the native rows of other libraries:\n  \
RUSTFLAGS=\"-C target-cpu=native\" cargo run --release -p p2m-bench -- query ...\n\
Both can add to the same --csv file; its column `label` names the build.\n\
Times are thread CPU times; pin the process as well: taskset -c 1 p2m-bench query ...")]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Build time, memory, time per query and agreement of all backends
    Query(QueryArguments),
    /// Compares our exact backends with brute force, bit for bit, in f64 and f32; fails on any difference
    Verify(VerifyArguments),
    /// Times the first hits of rays against other libraries; fails if ours differ
    Ray(RayArguments),
    /// Checks the accuracy contract where other libraries fail, for docs/extremes.md; fails if ours break it
    Extremes(ExtremesArguments),
    /// Checks distances between primitives where other libraries fail, for docs/extremes.md; fails if ours break the
    /// contract
    ExtremePairs(ExtremePairsArguments),
    /// Times distance fields on a grid, against other libraries and the figures of an article; fails if ours differ
    Field(FieldArguments),
    /// Compares builds on several numbers of threads, in wall time
    Threads(ThreadsArguments),
    /// Compares a scene of moving instances of meshes with one index over all of them; fails if an answer differs
    Instances(InstancesArguments),
    /// Measures builds, memory and queries of scenes that grow, for docs/scale.md; fails if ours differ
    Scale(ScaleArguments),
    /// Times distances between two scenes at many poses, and between a scene and an arm of capsules, against parry3d
    Pairs(PairsArguments),
    /// Writes a generated terrain as shards and asks them within a limit of memory; fails if an answer differs
    Shards(ShardsArguments),
}

/// The arguments of `scale`.
#[derive(Args)]
pub(crate) struct ScaleArguments {
    /// Backends of the registry
    #[arg(long, value_delimiter = ',', default_value = "aabb,kdop,octree,p2m", value_parser = index_names())]
    pub(crate) backends: Vec<String>,
    /// Numbers of triangles, in ascending order
    #[arg(long, value_delimiter = ',', default_values_t = [10_000, 100_000, 1_000_000, 10_000_000, 100_000_000])]
    pub(crate) sizes: Vec<usize>,
    /// Query sets
    #[arg(long, value_delimiter = ',', default_values_t = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near])]
    pub(crate) sets: Vec<QuerySet>,
    /// Queries in a round
    #[arg(long, default_value_t = 200_000)]
    pub(crate) queries: usize,
    /// Rounds of queries, and builds that take less than a second
    #[arg(long, default_value_t = 5, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) rounds: usize,
    /// The largest number of heap bytes at a time; a size that would take more is left out for that index
    #[arg(long, default_value_t = 20_000_000_000)]
    pub(crate) max_memory: usize,
    /// The longest time of a build in seconds; a size that would take longer is left out for that index
    #[arg(long, default_value_t = 900.0)]
    pub(crate) max_seconds: f64,
    #[command(flatten)]
    pub(crate) document: Document,
}

/// The arguments of `shards`.
#[derive(Args)]
pub(crate) struct ShardsArguments {
    /// The least number of triangles of the terrain, which is generated in tiles of 500,000
    #[arg(long, default_value_t = 10_000_000)]
    pub(crate) triangles: u64,

    /// The largest length of the file of a shard in bytes
    #[arg(long, default_value_t = 1 << 28)]
    pub(crate) max_bytes: u64,

    /// The largest amount of shards in memory in bytes
    #[arg(long, default_value_t = 1 << 30)]
    pub(crate) max_memory: u64,

    /// The number of queries of each set
    #[arg(long, default_value_t = 1_000_000)]
    pub(crate) queries: usize,

    /// The number of queries of each set that are compared with brute force
    #[arg(long, default_value_t = 16)]
    pub(crate) checked: usize,

    /// Build one tree over all triangles as well, and compare all answers
    #[arg(long)]
    pub(crate) whole: bool,

    /// The folder for the shards, if it is not that for temporary files
    #[arg(long)]
    pub(crate) folder: Option<PathBuf>,
}

/// The arguments that `query` and `verify` share.
#[derive(Args)]
pub(crate) struct Common {
    /// Files of scenes
    #[arg(required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    /// Query sets
    #[arg(long, value_delimiter = ',', default_values_t = QuerySet::ALL)]
    pub(crate) sets: Vec<QuerySet>,
    /// Scalars of backends
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [ScalarKind::Single, ScalarKind::Double])]
    pub(crate) scalar: Vec<ScalarKind>,
    /// Seed of the query sets
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
}

#[derive(Args)]
pub(crate) struct QueryArguments {
    #[command(flatten)]
    pub(crate) common: Common,
    /// Backends
    #[arg(long, value_delimiter = ',', default_value = backends::DEFAULT, value_parser = backend_names())]
    pub(crate) backends: Vec<String>,
    /// Rounds; another backend begins in each
    #[arg(long, default_value_t = 5)]
    pub(crate) rounds: usize,
    /// Queries in a round; backends slower than 20 us a query get at most 20,000, brute force as many as take a second
    #[arg(long, default_value_t = 200_000)]
    pub(crate) queries: usize,
    /// Number of times that each index is built
    #[arg(long, default_value_t = 5)]
    pub(crate) builds: usize,
    /// Record to create or to append to, as comma-separated values; a file with other columns is an error
    #[arg(long)]
    pub(crate) csv: Option<PathBuf>,
    /// Name of this build in tables and record [default: native with AVX2 at compile time, else portable]
    #[arg(long)]
    pub(crate) label: Option<String>,
}

#[derive(Args)]
pub(crate) struct VerifyArguments {
    #[command(flatten)]
    pub(crate) common: Common,
    /// Backends [default: all exact ones of ours]
    #[arg(long, value_delimiter = ',', value_parser = backend_names())]
    pub(crate) backends: Vec<String>,
    /// Queries of each set
    #[arg(long, default_value_t = 5000)]
    pub(crate) queries: usize,
}

#[derive(Args)]
pub(crate) struct RayArguments {
    /// Files of scenes
    #[arg(required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    /// Backends [default: all]
    #[arg(long, value_delimiter = ',', value_parser = ray_names())]
    pub(crate) backends: Vec<String>,
    /// Query sets at which rays begin
    #[arg(long, value_delimiter = ',', default_values_t = [QuerySet::Box10, QuerySet::Box1])]
    pub(crate) sets: Vec<QuerySet>,
    /// Rays in a round
    #[arg(long, default_value_t = 200_000, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) rays: usize,
    /// Rounds; another backend begins in each
    #[arg(long, default_value_t = 5)]
    pub(crate) rounds: usize,
    /// Seed of the rays
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Record of times to create or to append to, as comma-separated values
    #[arg(long)]
    pub(crate) csv: Option<PathBuf>,
    /// Name of this build in tables and record [default: native with AVX2 at compile time, else portable]
    #[arg(long)]
    pub(crate) label: Option<String>,
}

#[derive(Args)]
pub(crate) struct ThreadsArguments {
    /// Files of scenes
    #[arg(required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    /// Indexes
    #[arg(long, value_delimiter = ',', default_value = "aabb,kdop,octree,p2m", value_parser = index_names())]
    pub(crate) backends: Vec<String>,
    /// Numbers of threads; times are compared with those of the first
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2])]
    pub(crate) threads: Vec<usize>,
    /// Rounds; another number of threads begins in each
    #[arg(long, default_value_t = 5, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) rounds: usize,
}

#[derive(Args)]
pub(crate) struct InstancesArguments {
    /// Files of scenes
    #[arg(required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    /// Rounds; another backend begins in each
    #[arg(long, default_value_t = 5, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) rounds: usize,
    /// Queries in a round
    #[arg(long, default_value_t = 1_000_000)]
    pub(crate) queries: usize,
    /// Seed of the query sets
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Instances
    #[arg(long, default_value_t = 10_000, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) instances: usize,
    /// Largest number of triangles of an object; larger meshes are simplified [default: no limit]
    #[arg(long)]
    pub(crate) triangles: Option<usize>,
    /// Rays in a round
    #[arg(long, default_value_t = 200_000)]
    pub(crate) rays: usize,
}

#[derive(Args)]
pub(crate) struct PairsArguments {
    /// File of the scene that stays
    pub(crate) scene: PathBuf,
    /// File of the scene that is moved
    pub(crate) other: PathBuf,
    /// Number of poses in each set
    #[arg(long, default_value_t = 1000, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) poses: usize,
    /// Number of poses of the arm
    #[arg(long, default_value_t = 100_000, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) arms: usize,
    /// Rounds; another competitor begins in each
    #[arg(long, default_value_t = 5, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) rounds: usize,
    /// Seed of the poses
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
}

/// The document that gets the tables of a command.
#[derive(Args)]
pub(crate) struct Document {
    /// The document whose blocks of this command are replaced [default: print the blocks]
    #[arg(long, value_name = "DOCUMENT")]
    pub(crate) write: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct ExtremesArguments {
    /// Answers about isolated primitives that are checked
    #[arg(long, default_value_t = 1_000_000)]
    pub(crate) cases: u64,
    /// Scenes of each family, which every backend queries
    #[arg(long, default_value_t = 4)]
    pub(crate) scenes: u64,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) document: Document,
}

#[derive(Args)]
pub(crate) struct ExtremePairsArguments {
    /// Pairs of primitives that are checked
    #[arg(long, default_value_t = 1_000_000)]
    pub(crate) cases: u64,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) document: Document,
}

#[derive(Args)]
pub(crate) struct FieldArguments {
    /// Files of scenes
    #[arg(required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    /// Points along the longest side of the grid
    #[arg(long, default_value_t = 256, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..=2048))]
    pub(crate) resolution: usize,
    /// Fill every n-th slab of sixteen layers only
    #[arg(long, default_value_t = 1, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) stride: usize,
    /// Print only the figures of the article beside ours
    #[arg(long)]
    pub(crate) article: bool,
}

fn backend_names() -> PossibleValuesParser {
    backends::ALL.iter().map(|backend| backend.name).collect::<Vec<_>>().into()
}

fn index_names() -> PossibleValuesParser {
    p2m_backends::BACKENDS.iter().map(|backend| backend.name).collect::<Vec<_>>().into()
}

fn ray_names() -> PossibleValuesParser {
    rays::ALL.iter().map(|backend| backend.name).collect::<Vec<_>>().into()
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
