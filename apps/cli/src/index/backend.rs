//! The values of `--backend`, which come from the registry of backends, and the building or loading of an index.

use crate::io::interrupt::StoppableWork;
use crate::io::progress::{Progress, Unit};
use crate::io::streams::Streams;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use p2m_backends::{BACKENDS, BackendEntry, BuildSettings, BuiltIndex, Choice, KdopDirections, P2mSettings, Workload};
use p2m_core::Soup;
use p2m_core::storage::Reader;
use p2m_interception::{BuildStage, RefinementProgress, StageTimes};
use rayon::ThreadPool;
use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// A backend of the registry.
pub(crate) type Backend = &'static BackendEntry;

/// The name that leaves the choice of the backend to the program.
const AUTO: &str = "auto";

/// A value of `--backend` where the program may choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BackendChoice {
    /// The user names a backend.
    Named(Backend),
    /// The work of the queries decides.
    Auto,
}

/// A parser of the names of all backends that `fits` accepts.
pub(crate) fn backends(fits: fn(&BackendEntry) -> bool) -> impl TypedValueParser<Value = Backend> {
    let values = BACKENDS.iter().filter(move |backend| fits(backend)).map(possible_value);
    PossibleValuesParser::new(values).map(|name| named(&name))
}

/// A parser of the names of all backends and of `auto`.
pub(crate) fn backend_choices() -> impl TypedValueParser<Value = BackendChoice> {
    let auto = PossibleValue::new(AUTO)
        .help("the one with the least time by the work of the queries, else of ten million in the box of the scene");
    let values = BACKENDS.iter().map(possible_value).chain([auto]);
    PossibleValuesParser::new(values)
        .map(|name| if name == AUTO { BackendChoice::Auto } else { BackendChoice::Named(named(&name)) })
}

fn possible_value(backend: &BackendEntry) -> PossibleValue {
    PossibleValue::new(backend.name).help(backend.summary)
}

fn named(name: &str) -> Backend {
    BackendEntry::find(name).expect("the parser accepts the names of backends alone")
}

/// Returns the backend of the index in the file of the scene, or else the default one.
pub(crate) fn saved_or_default(saved: Option<&Reader>) -> Backend {
    saved.and_then(BackendEntry::from_saved).unwrap_or_else(BackendEntry::default_backend)
}

/// The index that a command searches.
pub(crate) enum Chosen {
    /// A backend that was named, or that of a saved index.
    Named(Backend),
    /// The choice by the work of queries.
    Counted(Choice),
}

impl From<Backend> for Chosen {
    fn from(backend: Backend) -> Self {
        Self::Named(backend)
    }
}

impl Chosen {
    pub(crate) fn backend(&self) -> Backend {
        match self {
            Self::Named(backend) => backend,
            Self::Counted(choice) => choice.backend(),
        }
    }

    /// The reason of a choice, if queries were counted for it.
    fn reason(&self) -> Option<String> {
        match self {
            Self::Named(_) => None,
            Self::Counted(choice) => choice.reason().map(str::to_owned),
        }
    }
}

impl BackendChoice {
    /// Returns the named backend. Without a name it is that of the saved index, and without both the work of the queries
    /// decides.
    pub(crate) fn resolve(
        choice: Option<Self>,
        saved: Option<&Reader>,
        soup: &Arc<Soup<f64>>,
        workload: &Workload<'_>,
        streams: &Streams,
        pool: &ThreadPool,
    ) -> anyhow::Result<Chosen> {
        match (choice, saved.and_then(BackendEntry::from_saved)) {
            (Some(Self::Named(backend)), _) | (None | Some(Self::Auto), Some(backend)) => return Ok(backend.into()),
            (None | Some(Self::Auto), None) => {}
        }
        let progress = Progress::start(streams, "building a tree", None, Unit::None);
        let chosen = pool.install(|| Choice::new(Arc::clone(soup), workload))?;
        drop(progress);
        Ok(Chosen::Counted(chosen))
    }
}

/// The stages of a build and their times.
pub(crate) type Stages = Vec<(BuildStage, Duration)>;

/// An index that is ready for queries.
pub(crate) struct PreparedIndex {
    pub(crate) built: BuiltIndex,
    /// Whether the index was loaded from a file.
    pub(crate) is_loaded: bool,
    /// The stages of the build; empty for backends without stages and for loaded indexes.
    pub(crate) stages: Stages,
    /// The reason of the choice of the backend, if the program chose it.
    pub(crate) reason: Option<String>,
}

/// The scene of an index, and the file that may have the index.
#[derive(Clone, Copy)]
pub(crate) struct SceneSource<'a> {
    pub(crate) soup: &'a Arc<Soup<f64>>,
    /// The directions of k-DOPs that are requested; `None` for those of the file, or else the default ones.
    pub(crate) kdop_directions: Option<KdopDirections>,
    /// The requested parts of a P2M index. A saved one has the default parts.
    pub(crate) p2m: P2mSettings,
    /// The file that has the scene, if it is one that may have an index as well.
    pub(crate) saved: Option<&'a Reader>,
}

impl SceneSource<'_> {
    /// Loads the index of the backend from the file, or builds it with the threads of a pool if the file has
    /// none that fits.
    pub(crate) fn prepare(
        self,
        streams: &Streams,
        chosen: impl Into<Chosen>,
        pool: &ThreadPool,
    ) -> anyhow::Result<PreparedIndex> {
        let chosen = chosen.into();
        let (backend, reason) = (chosen.backend(), chosen.reason());
        let soup = Arc::clone(self.soup);
        let may_be_saved = self.p2m == P2mSettings::default();
        if let Some(reader) = self.saved.filter(|reader| may_be_saved && backend.is_in(reader, self.kdop_directions)) {
            let _progress = Progress::start(streams, "loading the index", None, Unit::None);
            return Ok(PreparedIndex {
                built: pool.install(|| backend.load(soup, reader))?,
                is_loaded: true,
                stages: Stages::new(),
                reason: None,
            });
        }
        let settings = BuildSettings::default().with_kdop_directions(self.kdop_directions).with_p2m(self.p2m);
        let build = |chosen, settings: &BuildSettings<'_>| match chosen {
            Chosen::Named(backend) => backend.build(soup, settings),
            Chosen::Counted(choice) => choice.build(settings),
        };
        let start = Instant::now();
        let times = StageTimes::new(move || start.elapsed());
        let built = if backend.reports_progress {
            let bar = Progress::start(streams, "finding cells", Some(100), Unit::Percent);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part is from 0 to 1")]
            let report = |progress: p2m_interception::Progress| {
                times.tell(progress);
                bar.advance_to((progress.part * 100.0) as u64);
            };
            let shows_progress = streams.shows_progress();
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
            pool.install(|| build(chosen, &settings))?
        } else {
            let _progress = Progress::start(streams, "building the index", None, Unit::None);
            pool.install(|| build(chosen, &settings))?
        };
        Ok(PreparedIndex { built, is_loaded: false, stages: times.finish(), reason })
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
