//! Indexes as Python objects.

use crate::errors::value_error;
use crate::scene::{Scene, SharedScene};
use crate::signs::{SignRule, Signed, sign_rule};
use crate::threads::pool;
use crate::work::{FIRST_STEP_QUERIES, Monitor, Run, Threads, run_batch, run_owned};
use p2m_backends::{
    BACKENDS, BackendEntry, BuildSettings, BuiltIndex, Choice, KdopDirections, QueryRegion, SearchStructure, Workload,
};
use p2m_core::pair::PairQuery;
use p2m_core::{AnyIndex, BuildError, PrimitiveSet, RayQuery};
use p2m_field::sign::Normals;
use p2m_field::solid::Parts;
use p2m_interception::Progress;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The expected time of a batch below which it runs on the calling thread.
const MIN_PARALLEL_NANOSECONDS: f64 = 2e6;
/// The expected time of a query of an index with a structure. A rough estimate, without a record of a measurement.
const QUERY_NANOSECONDS: f64 = 1000.0;
/// The expected time per primitive of a query without a structure. A rough estimate, without a record of a measurement.
const EXHAUSTIVE_NANOSECONDS_PER_PRIMITIVE: f64 = 50.0;

/// The number of units in which the progress of a build is counted.
const BUILD_UNITS: usize = 100;

/// The connected parts of a scene, and the signs that decide what is inside, if the scene has an inside.
pub(crate) type SolidParts = (Arc<Parts>, Option<Arc<Signed>>);

/// An index, see `p2m.Index`. It never changes, so any number of threads may query it.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct Index {
    pub(crate) scene: SharedScene,
    pub(crate) built: BuiltIndex,
    pub(crate) backend: &'static BackendEntry,
    /// The file from which the index was loaded.
    pub(crate) origin: Option<Origin>,
    /// The signs that have been prepared so far, by rule.
    signs: Mutex<HashMap<SignRule, Arc<Signed>>>,
    /// The normals of the scene, computed at the first request.
    normals: OnceLock<Normals>,
    /// The connected parts of the scene, computed at the first request for solids.
    parts: OnceLock<Arc<Parts>>,
}

/// The file from which an index was loaded.
#[derive(Clone)]
pub(crate) struct Origin {
    pub(crate) path: PathBuf,
    pub(crate) checksum: String,
    pub(crate) is_mapped: bool,
}

impl Index {
    pub(crate) fn new(
        scene: SharedScene,
        built: BuiltIndex,
        backend: &'static BackendEntry,
        origin: Option<Origin>,
    ) -> Self {
        Self {
            scene,
            built,
            backend,
            origin,
            signs: Mutex::default(),
            normals: OnceLock::new(),
            parts: OnceLock::new(),
        }
    }

    /// Returns the normals of the scene, which are computed at the first call.
    pub(crate) fn surface_normals(&self, py: Python<'_>) -> &Normals {
        py.detach(|| self.normals.get_or_init(|| Normals::new(&self.scene.soup)))
    }

    /// Returns the connected parts of the scene, and the signs that decide what is inside if the scene consists of
    /// triangles alone.
    pub(crate) fn solid(&self, py: Python<'_>, threads: usize) -> PyResult<SolidParts> {
        let soup = &self.scene.soup;
        let parts = py.detach(|| Arc::clone(self.parts.get_or_init(|| Arc::new(Parts::of(soup)))));
        let has_inside = soup.segments().is_empty() && soup.points().is_empty();
        let signed = has_inside.then(|| self.signs(py, "auto", threads)).transpose()?;
        Ok((parts, signed))
    }

    /// Returns the index without the type of its backend.
    pub(crate) fn any(&self) -> Arc<dyn AnyIndex> {
        Arc::clone(&self.built.index)
    }

    /// Returns the expected time of a query.
    fn query_nanoseconds(&self) -> f64 {
        match self.backend.structure {
            SearchStructure::Exhaustive => EXHAUSTIVE_NANOSECONDS_PER_PRIMITIVE * self.scene.soup.len() as f64,
            _ => QUERY_NANOSECONDS,
        }
    }

    /// Returns the number of queries in the first step of a batch. The step should be short.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped")]
    pub(crate) fn first_step(&self) -> usize {
        (MIN_PARALLEL_NANOSECONDS / self.query_nanoseconds().max(1.0)).clamp(1.0, FIRST_STEP_QUERIES as f64) as usize
    }

    /// Returns the threads on which a batch of this number of queries runs.
    pub(crate) fn threads_for(&self, py: Python<'_>, queries: usize, threads: usize) -> PyResult<Threads> {
        if threads == 1 || self.query_nanoseconds() * (queries as f64) < MIN_PARALLEL_NANOSECONDS {
            return Ok(Threads::Calling);
        }
        pool(py, threads).map(Threads::Pool)
    }

    /// Runs a batch of this number of queries detached from the interpreter, on the threads of
    /// [`threads_for`](Self::threads_for).
    pub(crate) fn run<R: Send>(
        &self,
        py: Python<'_>,
        queries: usize,
        (threads, progress): Run,
        work: impl FnOnce(&Threads, &Monitor) -> PyResult<R> + Send,
    ) -> PyResult<R> {
        let threads = self.threads_for(py, queries, threads)?;
        run_batch(py, &threads, (queries, self.first_step()), progress, work)
    }

    /// Returns the index as an index that casts rays, or an error if its backend casts none.
    pub(crate) fn ray_query(&self) -> PyResult<&(dyn RayQuery<f64> + Sync)> {
        let refused = || self.refused("casts no rays: use", |backend| backend.casts_rays);
        self.built.index.as_ray_query().ok_or_else(refused)
    }

    /// Returns the index as an index that answers queries for pairs, or an error if its backend answers none.
    pub(crate) fn pair_query(&self) -> PyResult<&(dyn PairQuery<f64> + Sync)> {
        let refused = || self.refused("answers no queries for pairs: use", |backend| backend.answers_pairs);
        self.built.index.as_pair_query().ok_or_else(refused)
    }

    /// Returns the exception for a query that the backend does not support, with the names of the backends that do.
    fn refused(&self, lack: &str, fits: impl Fn(&BackendEntry) -> bool) -> PyErr {
        value_error(format!("the backend '{}' {lack} {}", self.backend, alternatives(fits)))
    }

    /// Returns the signs for the name of a rule. The first call prepares them.
    pub(crate) fn signs(&self, py: Python<'_>, rule: &str, threads: usize) -> PyResult<Arc<Signed>> {
        let rule = sign_rule(rule)?;
        let prepared = || self.signs.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(signed) = prepared().get(&rule) {
            return Ok(Arc::clone(signed));
        }
        // Two threads may both prepare the same signs; the lock must not be held while the interpreter is detached.
        let (index, soup) = (self.any(), Arc::clone(&self.scene.soup));
        let signed = run_owned(py, (threads, None), 1, move |_| match rule {
            None => Signed::new(index, soup),
            Some(rule) => Signed::with_rule(index, soup, rule),
        })?;
        let signed = Arc::new(signed.map_err(value_error)?);
        prepared().insert(rule, Arc::clone(&signed));
        Ok(signed)
    }
}

/// Returns the entry of a backend by its name; `auto` is the default backend.
pub(crate) fn backend(name: &str) -> PyResult<&'static BackendEntry> {
    let named = if name == "auto" { Some(BackendEntry::default_backend()) } else { BackendEntry::find(name) };
    named.ok_or_else(|| {
        let names: Vec<String> = BACKENDS.iter().map(|backend| format!("'{backend}'")).collect();
        PyValueError::new_err(format!("backend: '{name}' is none of 'auto', {}", names.join(", ")))
    })
}

/// Returns the names of the suitable backends as a phrase, those without a structure last.
fn alternatives(fits: impl Fn(&BackendEntry) -> bool) -> String {
    let mut fitting: Vec<&BackendEntry> = BACKENDS.iter().filter(|backend| fits(backend)).collect();
    fitting.sort_by_key(|backend| backend.structure == SearchStructure::Exhaustive);
    let names: Vec<String> = fitting.iter().map(|backend| format!("'{backend}'")).collect();
    names.split_last().map_or_else(String::new, |(last, others)| format!("{} or {last}", others.join(", ")))
}

/// Builds an index. Cancellation unwinds the build.
pub(crate) fn build(
    settings: BuildSettings<'_>,
    monitor: &Monitor,
    build: impl FnOnce(&BuildSettings<'_>) -> Result<BuiltIndex, BuildError>,
) -> Result<BuiltIndex, BuildError> {
    let progress = |progress: Progress| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part is from 0 to 1")]
        monitor.set_done((progress.part * BUILD_UNITS as f64) as usize);
        monitor.unwind_if_cancelled();
    };
    build(&settings.with_progress(&progress))
}

/// Returns the directions of k-DOPs by their number of faces or the name `scene`.
fn kdop_directions(name: &str) -> PyResult<KdopDirections> {
    let name_of = |directions: KdopDirections| match directions {
        KdopDirections::Scene => "scene".to_owned(),
        _ => directions.faces().to_string(),
    };
    KdopDirections::ALL
        .into_iter()
        .find(|&directions| name_of(directions) == name)
        .ok_or_else(|| PyValueError::new_err(format!("directions: {name} is none of 6, 14, 18, 26, 'scene'")))
}

#[pymethods]
impl Index {
    /// Builds an index of a backend of the registry.
    #[staticmethod]
    fn build(
        py: Python<'_>,
        scene: &Scene,
        backend: &str,
        run: Run,
        directions: Option<&str>,
        resolution: Option<f64>,
        queries: Option<u64>,
        max_bytes: Option<usize>,
    ) -> PyResult<Self> {
        let is_chosen = backend == "auto" && queries.is_some();
        if max_bytes.is_some() && !is_chosen {
            return Err(PyValueError::new_err("max_bytes: needs the backend 'auto' and the number of queries"));
        }
        let entry = self::backend(backend)?;
        for (option, is_given, is_used) in [
            ("directions", directions.is_some(), entry.has_kdop_directions),
            ("resolution", resolution.is_some(), entry.has_resolution),
        ] {
            if is_given && is_chosen {
                return Err(PyValueError::new_err(format!("{option}: name the backend that has it, not 'auto'")));
            }
            if is_given && !is_used {
                return Err(PyValueError::new_err(format!("{option}: the backend '{entry}' has none")));
            }
        }
        let directions = directions.map(kdop_directions).transpose()?;
        let settings = BuildSettings::default().with_kdop_directions(directions).with_resolution(resolution);
        let soup = Arc::clone(&scene.shared.soup);
        let workload = Workload::new(queries.unwrap_or_default(), QueryRegion::SceneBox);
        let workload = workload.with_needs_index(true).with_max_bytes(max_bytes.unwrap_or(usize::MAX));
        let built = run_owned(py, run, BUILD_UNITS, move |monitor| {
            let choice = if is_chosen { Some(Choice::new(Arc::clone(&soup), &workload)?) } else { None };
            let chosen = choice.as_ref().map_or(entry, Choice::backend);
            let built = build(settings, monitor, |settings| match choice {
                Some(choice) => choice.build(settings),
                None => entry.build(soup, settings),
            })?;
            Ok::<_, BuildError>((built, chosen))
        })?;
        let (built, chosen) = built.map_err(value_error)?;
        Ok(Self::new(scene.shared.clone(), built, chosen, None))
    }

    /// Returns an index over the same primitives at other positions.
    fn refitted(&self, py: Python<'_>, scene: &Scene, threads: usize) -> PyResult<Self> {
        let (index, soup) = (self.any(), Arc::clone(&scene.shared.soup));
        let refitted = run_owned(py, (threads, None), 1, move |_| index.refitted(soup))?;
        let refused = || {
            let lack = format!("the backend '{}' has no refit: build a new index, or use", self.backend);
            value_error(format!("{lack} {} for scenes that move", alternatives(|backend| backend.has_refit)))
        };
        let index = refitted.ok_or_else(refused)?.map_err(value_error)?;
        let built = BuiltIndex { index, ..self.built.clone() };
        Ok(Self::new(scene.shared.clone(), built, self.backend, None))
    }

    /// Returns the scene of the index.
    fn scene(&self) -> Scene {
        Scene { shared: self.scene.clone() }
    }

    /// Returns the name of the backend.
    fn backend(&self) -> &'static str {
        self.backend.name
    }

    /// Returns the file from which the index was loaded, its checksum, and whether it is mapped.
    fn origin(&self) -> Option<(PathBuf, String, bool)> {
        self.origin.clone().map(|origin| (origin.path, origin.checksum, origin.is_mapped))
    }

    /// Returns facts about the index by name.
    fn info<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let info = PyDict::new(py);
        let index = &self.built.index;
        info.set_item("backend", self.backend.name)?;
        info.set_item("summary", self.backend.summary)?;
        info.set_item("primitives", self.scene.soup.len())?;
        info.set_item("memory_bytes", index.memory_bytes())?;
        info.set_item("parts", index.parts().into_iter().collect::<HashMap<_, _>>())?;
        info.set_item("casts_rays", index.as_ray_query().is_some())?;
        info.set_item("answers_pairs", index.as_pair_query().is_some())?;
        info.set_item("is_saveable", self.backend.is_saveable())?;
        info.set_item("surface_area", index.surface_area())?;
        info.set_item("cells", index.cells().map(|cells| cells.text))?;
        info.set_item("directions", self.built.directions.as_ref().map(|directions| directions.faces))?;
        info.set_item("path", self.origin.as_ref().map(|origin| origin.path.clone()))?;
        Ok(info)
    }
}
