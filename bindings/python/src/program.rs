//! The program `p2m` for `python -m p2m`.

use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the program with arguments, the first of which is its name, and returns its exit code. Ctrl-C ends the process,
/// as it ends the program.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    p2m_cli::listen().map_err(|error| PyOSError::new_err(format!("cannot listen for Ctrl-C: {error}")))?;
    Ok(py.detach(|| p2m_cli::run(&p2m_cli::Streams::standard(), arguments)))
}
