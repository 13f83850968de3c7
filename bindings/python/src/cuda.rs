//! Indexes on an NVIDIA card.

use crate::arrays::triples;
use crate::columns::ClosestArrays;
use crate::errors::value_error;
use crate::index::Index;
use crate::parts::check_finite;
use crate::threads::pool;
use crate::work::{catch, run_owned};
use numpy::PyReadonlyArray1;
use p2m_bvh::AabbTree;
use p2m_core::Soup;
use p2m_cuda::{BatchReport, CardColumns, CardQueries, CudaError, CudaOptions};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// The number of queries answered by the tree, the number answered by the processor, and the seconds of the kernels.
type Report = (usize, usize, f64);

/// An index on a card, see `p2m.CudaIndex`. It never changes, so any number of threads may query it.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct CudaIndex {
    index: p2m_cuda::CudaIndex<f64, Arc<Soup<f64>>>,
    threads: usize,
}

fn cuda_error(error: CudaError) -> PyErr {
    match error {
        CudaError::Memory(_) => PyMemoryError::new_err(error.to_string()),
        CudaError::NoDriver | CudaError::Driver(_) | CudaError::Unequal { .. } => {
            PyRuntimeError::new_err(error.to_string())
        }
        _ => value_error(error),
    }
}

fn reported(result: Result<BatchReport, CudaError>) -> PyResult<Report> {
    let report = result.map_err(cuda_error)?;
    Ok((report.by_tree, report.by_processor, report.kernels.as_secs_f64()))
}

#[pymethods]
impl CudaIndex {
    /// Builds a tree over the scene of an index, and copies both to a card.
    #[staticmethod]
    fn build(
        py: Python<'_>,
        index: &Index,
        threads: usize,
        ordinal: usize,
        reach: f64,
        memory: Option<usize>,
        reorder: bool,
        checked: usize,
    ) -> PyResult<Self> {
        let soup = Arc::clone(&index.scene.soup);
        let mut options = CudaOptions::default();
        (options.ordinal, options.reach, options.memory) = (ordinal, reach, memory);
        (options.reorder, options.checked) = (reorder, checked);
        let build = move |_: &_| AabbTree::new(soup).map(|tree| p2m_cuda::CudaIndex::new(tree, &options));
        let index = run_owned(py, (threads, None), 1, build)?.map_err(value_error)?.map_err(cuda_error)?;
        Ok(Self { index, threads })
    }

    /// Answers queries from NumPy arrays, and writes the answers into the arrays of `out`.
    fn closest(
        &self,
        py: Python<'_>,
        points: PyReadonlyArray1<'_, f64>,
        out: &Bound<'_, PyDict>,
        max_distance: f64,
    ) -> PyResult<Report> {
        let points = triples(points.as_slice())?;
        let mut arrays = ClosestArrays::borrow(out)?;
        let columns = arrays.columns(points.len())?;
        self.run(py, || {
            check_finite("points", points, 1)?;
            let mut result = Ok(BatchReport::default());
            columns.fill(|mut columns| {
                result = self.index.closest_columns_into(bytemuck::cast_slice(points), max_distance, &mut columns);
            });
            reported(result)
        })
    }

    /// Answers queries on the card, on a stream of the caller. The Python layer has checked the addresses and sizes.
    /// The addresses of columns are in the order of `CardColumns`, 0 for an unwanted column.
    #[allow(unsafe_code, reason = "other libraries own the memory")]
    fn closest_on_card(
        &self,
        py: Python<'_>,
        queries: (u64, usize, bool),
        columns: [u64; 6],
        max_distance: f64,
        stream: u64,
    ) -> PyResult<Report> {
        let (address, count, is_f32) = queries;
        let queries = CardQueries { address, count, is_f32 };
        let [distance, lower_bound, point, barycentric, primitive, feature] = columns;
        let columns = CardColumns { distance, lower_bound, point, barycentric, primitive, feature };
        // SAFETY: the Python layer passes the addresses of contiguous arrays of torch or CuPy of the right type and
        // size on this card, which it holds, and their current stream. `p2m.CudaIndex` says that nobody may write to
        // the points during the call; nobody else knows the new arrays of answers.
        self.run(py, || reported(unsafe { self.index.closest_on_card(&queries, max_distance, stream, &columns) }))
    }

    /// Returns the bytes of the scene and of its lists on the card, and the number of cells without a list.
    fn size(&self) -> (usize, usize, u64) {
        let [scene, lists] = self.index.memory();
        (scene, lists, self.index.cells_without_list())
    }
}

impl CudaIndex {
    /// Runs a batch detached from the interpreter. The threads of the index answer the queries that the card leaves to
    /// the processor.
    fn run(&self, py: Python<'_>, work: impl FnOnce() -> PyResult<Report> + Send) -> PyResult<Report> {
        let pool = pool(py, self.threads)?;
        py.detach(|| catch(|| pool.install(work)))?
    }
}
