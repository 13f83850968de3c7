//! The kernels for cards of NVIDIA: their PTX is in the repository, so that nobody needs a toolkit.

use crate::python::{environment, find_python, install_needed, text};
use crate::{Outcome, absolute_target_folder, output};
use std::fs;

const SCRIPT: &str = "bindings/cuda/kernels/compile.py";
const PTX: &str = "bindings/cuda/kernels/kernels.ptx";
/// The compiler. Another version may write other PTX, and a newer one PTX that older drivers do not read.
const NVRTC: &str = "nvidia-cuda-nvrtc-cu12==12.4.127";

/// Compiles the kernels, and compares the result with the PTX of the repository, or says why they cannot be compiled
/// here. With `--build` it replaces that PTX.
pub(crate) fn run(arguments: &[String]) -> Outcome {
    let builds = match arguments {
        [] => false,
        [argument] if argument == "--build" => true,
        _ => return Err("the only argument of this task is --build".to_owned()),
    };
    let Some(python) = find_python() else { return crate::skip("there is no Python for NVRTC") };
    let python = text(&environment(&python, "cuda-env")?.join("python"))?;
    if let Err(why) = install_needed(&python, &[NVRTC]) {
        return crate::skip(&format!("{NVRTC} cannot be installed\n{why}"));
    }
    let compiled = absolute_target_folder()?.join("kernels.ptx");
    output(&python, &[SCRIPT, &text(&compiled)?])?;
    let read = |path: &str| fs::read_to_string(path).map_err(|error| format!("{path}: {error}"));
    let ptx = read(&text(&compiled)?)?;
    if builds {
        return fs::write(PTX, ptx).map_err(|error| format!("{PTX}: {error}"));
    }
    if ptx == read(PTX)? {
        Ok(())
    } else {
        Err(format!("{PTX} is not that of its sources: run `cargo xtask cuda --build`"))
    }
}
