//! Runs tests under the memory checker of valgrind, which knows no instruction set above AVX2.

use crate::{Outcome, start};
use std::process::{Command, Stdio};

/// The crates that have vector kernels, arrays in files, or trees of both.
const CRATES: [&str; 4] = ["p2m-core", "p2m-bvh", "p2m-kdop", "p2m-interception"];
/// A test that counts how often rare cases came up on all instruction sets, of which there are fewer under valgrind.
const SKIPPED: &str = "walks_end_at_the_nearest_site_wherever_they_begin";

/// Runs the unit tests of the crates and the tests of saved files.
pub(crate) fn run() -> Outcome {
    let version = Command::new("valgrind").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !version.is_ok_and(|status| status.success()) {
        return crate::skip("there is no program 'valgrind'");
    }
    let mut units = under_valgrind();
    CRATES.iter().for_each(|name| {
        units.args(["--package", name]);
    });
    start(units.args(["--lib", "--", "--skip", SKIPPED]))?;
    start(under_valgrind().args(["--package", "p2m", "--test", "all", "--", "saved::", "crafted_files::"]))
}

/// Returns a command that runs tests under valgrind. An access that is not allowed makes a test program fail.
fn under_valgrind() -> Command {
    let mut tests = Command::new("cargo");
    tests.args(["test", "--locked"]);
    tests.env("CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER", "valgrind --quiet --error-exitcode=99");
    tests
}
