//! The values of `--backend`, which come from the registry of backends, and the building or loading of an index.

use crate::index::kdop_directions::requested;
use crate::index::p2m_args::P2mArgs;
use crate::io::interrupt::StoppableWork;
use crate::io::usage::choices;
use crate::io::{Progress, SceneFile, Session, Unit};
use anyhow::Context;
use clap::builder::TypedValueParser;
use p2m_backends::{BACKENDS, BackendEntry, BuildSettings, BuiltIndex, Choice, KdopDirections, P2mSettings, Workload};
use p2m_interception::{BuildStage, RefinementProgress, StageTimes};
use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// A backend of the registry.
pub(crate) type Backend = &'static BackendEntry;

/// A value of `--backend` where the program may choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BackendChoice {
    /// The user names a backend.
    Named(Backend),
    /// The work of the queries decides.
    Auto,
}

/// Returns a parser of the names of all backends that `fits` accepts.
pub(crate) fn backends(fits: fn(&BackendEntry) -> bool) -> impl TypedValueParser<Value = Backend> {
    choices(
        BACKENDS.iter().filter(move |backend| fits(backend)).map(|backend| (backend.name, backend.summary, backend)),
    )
}

/// Returns a parser of the names of all backends and of `auto`.
pub(crate) fn backend_choices() -> impl TypedValueParser<Value = BackendChoice> {
    let help = "the one with the least time by the work of the queries, else of ten million in the box of the scene";
    let named = BACKENDS.iter().map(|backend| (backend.name, backend.summary, BackendChoice::Named(backend)));
    choices(named.chain([("auto", help, BackendChoice::Auto)]))
}

/// The index that a command searches, and its options.
pub(crate) struct Chosen {
    pub(crate) backend: Backend,
    /// The choice by the work of queries, unless the backend was named or is that of a saved index.
    counted: Option<Choice>,
    /// Requested k-DOP directions; `None` for those of the saved file, or else the default ones.
    kdop_directions: Option<KdopDirections>,
    /// The requested parts of a P2M index. A saved one has the default parts.
    p2m: P2mSettings,
}

impl From<Backend> for Chosen {
    fn from(backend: Backend) -> Self {
        Self { backend, counted: None, kdop_directions: None, p2m: P2mSettings::default() }
    }
}

impl Chosen {
    /// Returns whether the work of queries decided.
    pub(crate) fn is_counted(&self) -> bool {
        self.counted.is_some()
    }

    /// Sets the directions that `--k` requests, which are an error for a backend without k-DOPs.
    pub(crate) fn with_k(self, k: Option<KdopDirections>) -> anyhow::Result<Self> {
        Ok(Self { kdop_directions: requested(self.backend.has_kdop_directions, k)?, ..self })
    }

    /// Sets the parts of a P2M index, which are an error for another backend.
    pub(crate) fn with_p2m(self, args: &P2mArgs) -> anyhow::Result<Self> {
        Ok(Self { p2m: args.settings(self.backend.has_p2m_settings)?, ..self })
    }
}

/// The stages of a build and their times.
pub(crate) type Stages = Vec<(BuildStage, Duration)>;

/// An index that is ready for queries.
pub(crate) struct PreparedIndex {
    pub(crate) backend: Backend,
    pub(crate) built: BuiltIndex,
    /// Whether the index was loaded from a file.
    pub(crate) is_loaded: bool,
    /// The stages of the build; empty for backends without stages and for loaded indexes.
    pub(crate) stages: Stages,
    /// The reason of the choice of the backend, if the program chose it.
    pub(crate) reason: Option<String>,
}

impl SceneFile {
    /// Returns the backend of the index in the file, or else the default one.
    pub(crate) fn backend(&self) -> Backend {
        self.saved_backend().unwrap_or_else(BackendEntry::default_backend)
    }

    /// Returns the backend of the index in the file, if it has one.
    pub(crate) fn saved_backend(&self) -> Option<Backend> {
        self.saved.as_ref().and_then(BackendEntry::from_saved)
    }

    /// Returns the named backend. Without a name it is that of the saved index, and without both the work of the
    /// queries decides.
    pub(crate) fn choose(
        &self,
        session: &Session<'_>,
        choice: Option<BackendChoice>,
        workload: &Workload<'_>,
    ) -> anyhow::Result<Chosen> {
        match (choice, self.saved_backend()) {
            (Some(BackendChoice::Named(backend)), _) | (_, Some(backend)) => return Ok(backend.into()),
            (None | Some(BackendChoice::Auto), None) => {}
        }
        let _progress = Progress::start(session.streams, "building a tree", None, Unit::None);
        let choice = session.pool.install(|| Choice::new(Arc::clone(&self.scene.soup), workload));
        let choice = choice.with_context(|| self.name.clone())?;
        let backend = choice.backend();
        Ok(Chosen { counted: Some(choice), ..backend.into() })
    }

    /// Loads the index from the file, or builds it with the threads of a pool if the file has none that fits.
    pub(crate) fn prepare(&self, session: &Session<'_>, chosen: impl Into<Chosen>) -> anyhow::Result<PreparedIndex> {
        self.load_or_build(session, chosen.into()).with_context(|| self.name.clone())
    }

    fn load_or_build(&self, session: &Session<'_>, chosen: Chosen) -> anyhow::Result<PreparedIndex> {
        let Chosen { backend, counted, kdop_directions, p2m } = chosen;
        let soup = Arc::clone(&self.scene.soup);
        let may_be_saved = p2m == P2mSettings::default();
        let saved = self.saved.as_ref().filter(|reader| may_be_saved && backend.is_in(reader, kdop_directions));
        if let Some(reader) = saved {
            let _progress = Progress::start(session.streams, "loading the index", None, Unit::None);
            let built = session.pool.install(|| backend.load(soup, reader))?;
            return Ok(PreparedIndex { backend, built, is_loaded: true, stages: Stages::new(), reason: None });
        }
        let reason = counted.as_ref().and_then(|choice| choice.reason().map(str::to_owned));
        let settings = BuildSettings::default().with_kdop_directions(kdop_directions).with_p2m(p2m);
        let build = |settings: &BuildSettings<'_>| match counted {
            Some(choice) => choice.build(settings),
            None => backend.build(soup, settings),
        };
        let start = Instant::now();
        let times = StageTimes::new(move || start.elapsed());
        let built = if backend.reports_progress {
            let bar = Progress::start(session.streams, "finding cells", Some(100), Unit::Percent);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part is from 0 to 1")]
            let report = |progress: p2m_interception::Progress| {
                times.tell(progress);
                bar.advance_to((progress.part * 100.0) as u64);
            };
            let shows_progress = session.streams.shows_progress();
            let work = OnceLock::new();
            let visit = |so_far: &RefinementProgress| {
                // Users who see no progress do not see either that the refinement can end early.
                if shows_progress {
                    work.get_or_init(StoppableWork::start);
                    bar.set_note(octree_note(so_far));
                }
                if StoppableWork::is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            };
            let settings = settings.with_progress(&report).with_visit_octree(&visit);
            session.pool.install(|| build(&settings))?
        } else {
            let _progress = Progress::start(session.streams, "building the index", None, Unit::None);
            session.pool.install(|| build(&settings))?
        };
        Ok(PreparedIndex { backend, built, is_loaded: false, stages: times.finish(), reason })
    }
}

/// Returns what a progress bar says about an octree whose refinement goes on.
fn octree_note(so_far: &RefinementProgress) -> String {
    let (cells, megabytes) = (so_far.cells, so_far.bytes as f64 / 1e6);
    let length = so_far.mean_list_length();
    if StoppableWork::is_stopped() {
        return format!(", ending early with {cells} cells, lists of {length:.1} packets, {megabytes:.0} MB");
    }
    format!(", so far {cells}, lists of {length:.1} packets, {megabytes:.0} MB (Ctrl-C ends here)")
}
