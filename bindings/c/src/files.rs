//! Scenes and indexes in files.

use crate::arrays::{give, reference, text};
use crate::index::Index;
use crate::scene::Scene;
use crate::status::{Call, Failure, Status, run};
use crate::threads::in_pool;
use p2m_core::storage::SavedFile;
use p2m_mixed::engine::OutputFile;
use std::ffi::c_char;
use std::path::PathBuf;
use std::sync::Arc;

/// Returns a path from a UTF-8 string.
///
/// # Safety
/// A pointer that is not null has to point to a string that ends with a zero.
unsafe fn path(pointer: *const c_char) -> Call<PathBuf> {
    // SAFETY: the caller vouches for the string.
    unsafe { text(pointer, "path") }.map(PathBuf::from)
}

/// Reads a scene from a file: OBJ, PLY, STL, OFF, a point cloud, or a saved index. The path is UTF-8. Free the scene
/// with `p2m_scene_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_scene_read(path: *const c_char, scene: *mut *mut Scene) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        give(scene, "scene", || {
            let path = self::path(path)?;
            let read = in_pool(0, || p2m_mixed::read_scene(&path))?;
            let read = read.map_err(|error| Failure(Status::File, format!("{}: {error}", path.display())))?;
            Ok(Scene { shared: Arc::new(read) })
        })
    })
}

/// Saves an index with its scene to a file. The file appears under its name when it is complete.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_index_save(index: *const Index, path: *const c_char) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, path) = (reference(index, "index")?, self::path(path)?);
        let writer = index.saved()?;
        let failed = |error: std::io::Error| Failure(Status::File, format!("{}: {error}", path.display()));
        let mut file = OutputFile::create(&path).map_err(failed)?;
        writer.write(&mut file).map_err(failed)?;
        file.finish().map_err(failed)
    })
}

/// Loads an index with its scene from a file that any p2m program or binding has saved. Free it with `p2m_index_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_index_load(path: *const c_char, index: *mut *mut Index) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        give(index, "index", || {
            let path = self::path(path)?;
            let of_path = |Failure(status, text)| Failure(status, format!("{}: {text}", path.display()));
            in_pool(0, || Index::load(SavedFile::open(&path)))?.map_err(of_path)
        })
    })
}
