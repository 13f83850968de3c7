//! The arguments of commands that are about an index: its scene, its backend and its directions.

use crate::index::backend::{Backend, BackendChoice, Chosen, backend_choices};
use crate::index::kdop_directions::{kdop_faces, requested};
use crate::index::p2m_args::P2mArgs;
use crate::io::{SceneArgs, SceneFile, Session, ThreadArgs};
use p2m_backends::{KdopDirections, QueryRegion, Workload};

#[derive(clap::Args)]
pub(crate) struct IndexArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,

    /// The index [default: the saved index, or aabb]
    #[arg(long, value_parser = backend_choices())]
    backend: Option<BackendChoice>,

    /// The number of faces of k-DOPs, for --backend kdop [default: 14]
    #[arg(long, value_name = "K", value_parser = kdop_faces(), ignore_case = true, allow_negative_numbers = true)]
    k: Option<KdopDirections>,

    #[command(flatten)]
    pub(crate) p2m: P2mArgs,

    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
}

/// The number of queries that `--backend auto` chooses an index for if the command does not say how many there are.
const DEFAULT_QUERY_COUNT: u64 = 10_000_000;

impl IndexArgs {
    /// Refuses `--k` for a backend without k-DOPs, and `--locator` and `--filter` for another one than p2m, as far as
    /// the backend is known before any work.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        let (may_have_kdops, may_have_p2m_settings) = match self.backend {
            Some(BackendChoice::Auto) => (true, false),
            Some(BackendChoice::Named(backend)) => (backend.has_kdop_directions, backend.has_p2m_settings),
            None => (false, false),
        };
        self.p2m.settings(may_have_p2m_settings)?;
        requested(may_have_kdops, self.k).map(|_| ())
    }

    /// Returns the backend that was named, if one was.
    pub(crate) fn named(&self) -> Option<Backend> {
        match self.backend {
            Some(BackendChoice::Named(backend)) => Some(backend),
            _ => None,
        }
    }

    /// Whether the user left the choice of the index to the program.
    pub(crate) fn is_unspecified(&self) -> bool {
        self.named().is_none() && self.k.is_none() && self.p2m.is_unspecified()
    }

    /// Returns the backend with its options. Without a named backend it is that of the file or the default one, and
    /// with `auto` the best one for ten million queries in the box of the scene.
    ///
    /// # Errors
    /// For directions with a backend that has no k-DOPs, and for settings of a P2M index with another one.
    pub(crate) fn choice(&self, session: &Session<'_>, file: &SceneFile) -> anyhow::Result<Chosen> {
        match self.backend {
            None => self.with_options(file.backend().into()),
            Some(_) => self.choice_for(DEFAULT_QUERY_COUNT, session, file),
        }
    }

    /// Returns the same for a number of queries in the box of the scene, which decide unless a backend is named or the
    /// file has an index.
    pub(crate) fn choice_for(&self, queries: u64, session: &Session<'_>, file: &SceneFile) -> anyhow::Result<Chosen> {
        let workload = Workload::new(queries, QueryRegion::SceneBox).with_needs_index(true);
        self.with_options(file.choose(session, self.backend, &workload)?)
    }

    fn with_options(&self, chosen: Chosen) -> anyhow::Result<Chosen> {
        chosen.with_p2m(&self.p2m)?.with_k(self.k)
    }
}
