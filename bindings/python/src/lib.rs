//! The native part of the Python package `p2m`.
//!
//! The classes here take and fill contiguous NumPy arrays. Shapes, other types of arrays, records of answers and the
//! documentation for users are in Python (`python/p2m`). Every build and every batch runs detached from the
//! interpreter, on threads that never call it (see the module `work`).
//!
//! `unsafe` is needed in three places: two map saved files and shards at the request of the user, and one passes memory
//! of other libraries to a card.
#![deny(unsafe_code)]
#![allow(clippy::too_many_arguments, reason = "the Python layer passes all arguments of a call")]

mod advise;
mod alignment;
mod arrays;
mod columns;
mod contacts;
#[cfg(feature = "cuda")]
mod cuda;
mod deviations;
mod errors;
mod fields;
mod hausdorff;
mod index;
mod memory;
mod pages;
mod pair_columns;
mod pairs;
mod parts;
mod program;
mod queries;
mod rays;
mod samples;
mod saved;
mod scene;
mod sharded;
mod signs;
mod source;
mod threads;
mod work;

use pyo3::prelude::*;

/// The functions and classes for the Python files of the package.
#[pymodule]
mod _p2m {
    #[cfg(feature = "cuda")]
    #[pymodule_export]
    use super::cuda::CudaIndex;
    #[pymodule_export]
    use super::{
        advise::advise,
        alignment::align,
        columns::NearList,
        deviations::{Report, deviation_on_vertices, deviation_ply, deviation_statistics, isolated_points},
        hausdorff::hausdorff,
        index::Index,
        pages::{grid_around, grid_of_offset, scene_page},
        pair_columns::PairList,
        program::main,
        queries::{closest, is_any_within, k_nearest, within},
        rays::{HitList, rays},
        samples::{sample_box, sample_surface},
        saved::{load, load_bytes, write_bytes},
        scene::{Scene, read_points},
        sharded::{ShardWriter, Shards},
        threads::default_threads,
    };
    use p2m_backends::BACKENDS;
    use pyo3::prelude::*;

    /// Returns the names of all backends.
    #[pyfunction]
    fn backends() -> Vec<&'static str> {
        BACKENDS.iter().map(|backend| backend.name).collect()
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
