//! The parts that the commands of `p2m-bench` share: arguments, and the loop over scenes.

use crate::backend::{Backend, ScalarKind};
use crate::backends;
use crate::scene::Scene;
use anyhow::Result;
use clap::Args;
use clap::builder::{PossibleValuesParser, RangedU64ValueParser};
use p2m_cli::harness::Provenance;
use p2m_testkit::queries::QuerySet;
use std::path::PathBuf;

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
    scalar: Vec<ScalarKind>,
}

impl Common {
    /// Returns the backends that `is_wanted` accepts and that have one of the scalars, in the order of the list.
    pub(crate) fn select(&self, is_wanted: impl Fn(&Backend) -> bool) -> Vec<&'static Backend> {
        backends::ALL.iter().filter(|b| self.scalar.contains(&b.scalar) && is_wanted(b)).collect()
    }
}

/// The rounds of a measurement.
#[derive(Args, Clone, Copy)]
pub(crate) struct Rounds {
    /// Rounds; another competitor begins in each
    #[arg(long, default_value_t = 5, value_parser = at_least_one())]
    pub(crate) rounds: usize,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
}

impl Rounds {
    /// Describes a measurement of `count` questions per round.
    pub(crate) fn describe(&self, time: &str, count: usize, questions: &str) -> String {
        format!("{time}, {} rounds in turns, {count} {questions} a round, seed {}.", self.rounds, self.seed)
    }
}

/// The document that gets the tables of a command.
#[derive(Args)]
pub(crate) struct Document {
    /// The document whose blocks of this command are replaced [default: print the blocks]
    #[arg(long, value_name = "DOCUMENT")]
    pub(crate) write: Option<PathBuf>,
}

/// Accepts numbers above zero.
pub(crate) fn at_least_one() -> RangedU64ValueParser<usize> {
    RangedU64ValueParser::new().range(1..)
}

pub(crate) fn backend_names() -> PossibleValuesParser {
    backends::ALL.iter().map(|backend| backend.name).collect::<Vec<_>>().into()
}

pub(crate) fn index_names() -> PossibleValuesParser {
    p2m_backends::BACKENDS.iter().map(|backend| backend.name).collect::<Vec<_>>().into()
}

/// Returns the provenance of a measurement by this program, which is run from its checkout.
pub(crate) fn provenance() -> Provenance {
    Provenance::collect(Some(env!("CARGO_MANIFEST_DIR").as_ref()))
}

/// Prints the provenance and a line about the measurement, measures scenes one by one, and returns whether all are
/// good.
pub(crate) fn all_good(
    scenes: &[PathBuf],
    about: &str,
    mut measure: impl FnMut(Scene) -> Result<bool>,
) -> Result<bool> {
    println!("{}\n{about}", provenance());
    scenes.iter().try_fold(true, |is_good, path| Ok(measure(Scene::read(path)?)? && is_good))
}
