//! The kernels for cards of NVIDIA: their PTX is in the repository, so that nobody needs a toolkit.

use crate::{OrSkip, Outcome, compare_or_write, output, read, target, tools};
use std::process::Command;

const SCRIPT: &str = "bindings/cuda/kernels/compile.py";
const PTX: &str = "bindings/cuda/kernels/kernels.ptx";
/// The compiler. Another version may write other PTX, and a newer one PTX that older drivers do not read.
const NVRTC: &str = "nvidia-cuda-nvrtc-cu12==12.4.127";

/// Compiles the kernels, and compares the result with the PTX of the repository, or says why they cannot be compiled
/// here. With `--build` it replaces that PTX.
pub(crate) fn run(arguments: &[String]) -> Outcome {
    let python = tools::python("cuda-env", &[NVRTC]).or_skip(&format!("{NVRTC} cannot be installed"))?;
    let compiled = target("kernels.ptx");
    output(Command::new(python).arg(SCRIPT).arg(&compiled))?;
    compare_or_write(PTX, &read(compiled)?, "cargo xtask cuda --build", !arguments.is_empty())
}
