//! Indexes.

use crate::arrays::{give, reference, take_back, text};
use crate::scene::Scene;
use crate::status::{Call, Failure, Status, invalid, run};
use crate::threads::in_pool;
use p2m_backends::{BACKENDS, BackendEntry, BuildSettings, BuiltIndex, Choice, KdopDirections, QueryRegion, Workload};
use p2m_core::storage::{LoadError, SavedFile, Writer};
use p2m_core::{AnyIndex, PrimitiveSet, Soup};
use p2m_field::sign::{Normals, SignedDistance};
use p2m_mixed::{load_scene, save_scene};
use std::ffi::{CString, c_char};
use std::sync::{Arc, OnceLock};

pub(crate) type Signs = SignedDistance<Arc<dyn AnyIndex>, Arc<Soup<f64>>>;

/// An index over a scene, which it keeps alive. It never changes, and any number of threads may query it.
pub struct Index {
    pub(crate) scene: Arc<p2m_mixed::Scene>,
    pub(crate) built: BuiltIndex,
    backend: &'static BackendEntry,
    backend_name: CString,
    pub(crate) signs: OnceLock<Result<Signs, String>>,
    normals: OnceLock<Normals>,
}

/// The options of a build. All zeros are the defaults.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct IndexOptions {
    /// The name of a backend: "aabb", "kdop", "octree", "p2m", "brute" or "auto"; null stands for "auto".
    pub backend: *const c_char,
    /// The expected number of queries, by which "auto" chooses. With 0 it chooses "aabb".
    pub queries: u64,
    /// The fineness of the cells of an octree: a larger number makes finer cells. 0 stands for the default.
    pub resolution: f64,
    /// The number of faces of a k-DOP: 6, 14, 18 or 26; 0 stands for 14.
    pub kdop_faces: u32,
    /// The number of threads; 0 stands for all processors.
    pub threads: u32,
}

impl Index {
    fn new(scene: Arc<p2m_mixed::Scene>, built: BuiltIndex, backend: &'static BackendEntry) -> Self {
        let backend_name = CString::new(backend.name).unwrap_or_default();
        Self { scene, built, backend, backend_name, signs: OnceLock::new(), normals: OnceLock::new() }
    }

    /// Returns the normals of the scene, which the first call computes.
    pub(crate) fn normals(&self, threads: u32) -> &Normals {
        let compute = || Normals::new(&self.scene.soup);
        self.normals.get_or_init(|| in_pool(threads, compute).unwrap_or_else(|_| compute()))
    }

    /// Returns a writer with the arrays of the index and its scene.
    pub(crate) fn saved(&self) -> Call<Writer<'_>> {
        if !self.backend.is_saveable() {
            return Err(self.unsupported("has no saved form", BackendEntry::is_saveable));
        }
        let mut writer = Writer::default();
        save_scene(&self.scene, &mut writer);
        self.built.save(&mut writer);
        Ok(writer)
    }

    /// Loads an index with its scene.
    pub(crate) fn load(file: Result<SavedFile, LoadError>) -> Call<Self> {
        let failed = |error: LoadError| Failure(Status::File, error.to_string());
        let file = file.map_err(failed)?;
        let reader = file.checked().map_err(failed)?;
        let scene = Arc::new(load_scene(reader).map_err(failed)?);
        let missing = || Failure(Status::File, "the file has no index".to_owned());
        let backend = BackendEntry::from_saved(reader).ok_or_else(missing)?;
        let built = backend.load(Arc::clone(&scene.soup), reader).map_err(failed)?;
        Ok(Self::new(scene, built, backend))
    }

    /// Returns the failure for a kind of query that the backend does not answer.
    pub(crate) fn unsupported(&self, what: &str, fits: impl Fn(&BackendEntry) -> bool) -> Failure {
        let names: Vec<&str> = BACKENDS.iter().filter(|backend| fits(backend)).map(|backend| backend.name).collect();
        let message = format!("the backend \"{}\" {what}; these do: {}", self.backend.name, names.join(", "));
        Failure(Status::Unsupported, message)
    }
}

fn invalid_scene(error: impl std::fmt::Display) -> Failure {
    Failure(Status::InvalidScene, error.to_string())
}

/// Builds an index over a scene. `options` may be null. Free the index with `p2m_index_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_index_build(
    scene: *const Scene,
    options: *const IndexOptions,
    index: *mut *mut Index,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        give(index, "index", || {
            let scene = Arc::clone(&reference(scene, "scene")?.shared);
            let none =
                IndexOptions { backend: std::ptr::null(), queries: 0, resolution: 0.0, kdop_faces: 0, threads: 0 };
            let options = if options.is_null() { none } else { *reference(options, "options")? };
            let name = if options.backend.is_null() { "auto" } else { text(options.backend, "backend")? };
            build(scene, name, &options)
        })
    })
}

fn build(scene: Arc<p2m_mixed::Scene>, name: &str, options: &IndexOptions) -> Call<Index> {
    let is_auto = name == "auto";
    let entry = if is_auto { Some(BackendEntry::default_backend()) } else { BackendEntry::find(name) };
    let entry = entry.ok_or_else(|| invalid(format!("backend: there is none with the name \"{name}\"")))?;
    let is_fine = options.resolution >= 0.0 && options.resolution.is_finite();
    if !is_fine || (options.resolution > 0.0 && !entry.has_resolution) {
        return Err(invalid("resolution: it is a positive number, and only an octree has it"));
    }
    if options.kdop_faces != 0 && !entry.has_kdop_directions {
        return Err(invalid("kdop_faces: only the backend \"kdop\" has them"));
    }
    let directions = match options.kdop_faces {
        0 => None,
        faces => {
            let has_faces = |directions: &KdopDirections| {
                *directions != KdopDirections::Scene && u32::try_from(directions.faces()) == Ok(faces)
            };
            let found = KdopDirections::ALL.into_iter().find(has_faces);
            Some(found.ok_or_else(|| invalid("kdop_faces: 6, 14, 18 or 26"))?)
        }
    };
    let soup = Arc::clone(&scene.soup);
    let resolution = (options.resolution > 0.0).then_some(options.resolution);
    let queries = options.queries;
    let built = in_pool(options.threads, move || {
        let settings = BuildSettings::default();
        let settings = settings.with_kdop_directions(directions).with_resolution(resolution);
        if is_auto && queries > 0 {
            let choice = Choice::new(soup, &Workload::new(queries, QueryRegion::SceneBox).with_needs_index(true))?;
            let entry = choice.backend();
            return Ok((choice.build(&settings)?, entry));
        }
        Ok((entry.build(soup, &settings)?, entry))
    })?;
    let (built, entry) = built.map_err(|error: p2m_core::BuildError| invalid_scene(error))?;
    Ok(Index::new(scene, built, entry))
}

/// Makes an index over another scene with as many primitives in the same order, by a refit: the tree keeps its shape,
/// and its boxes are recomputed. The backend has to support it. The old index stays valid. Free the new one with
/// `p2m_index_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_index_refit(
    index: *const Index,
    scene: *const Scene,
    refitted: *mut *mut Index,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        give(refitted, "refitted", || {
            let (index, scene) = (reference(index, "index")?, Arc::clone(&reference(scene, "scene")?.shared));
            let refit = in_pool(0, || index.built.index.refitted(Arc::clone(&scene.soup)))?;
            let refit = refit.ok_or_else(|| index.unsupported("has no refit", |backend| backend.has_refit))?;
            let built = BuiltIndex { index: refit.map_err(invalid_scene)?, ..index.built.clone() };
            Ok(Index::new(scene, built, index.backend))
        })
    })
}

/// Frees an index. No other call may be using it. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_index_free(index: *mut Index) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { take_back(index) };
}

/// Returns the name of the backend, which is valid as long as the index; null for a null pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_index_backend(index: *const Index) -> *const c_char {
    // SAFETY: the caller vouches for the pointer.
    unsafe { index.as_ref() }.map_or(std::ptr::null(), |index| index.backend_name.as_ptr())
}

/// Returns the number of primitives; 0 for a null pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_index_primitive_count(index: *const Index) -> usize {
    // SAFETY: the caller vouches for the pointer.
    unsafe { index.as_ref() }.map_or(0, |index| index.scene.soup.len())
}

/// Returns the memory of the index in bytes, without its scene; 0 for a null pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_index_memory_bytes(index: *const Index) -> usize {
    // SAFETY: the caller vouches for the pointer.
    unsafe { index.as_ref() }.map_or(0, |index| index.built.index.memory_bytes())
}
