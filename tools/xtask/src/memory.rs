//! Runs tests under AddressSanitizer, and under the memory checker of valgrind, which knows no instruction set above AVX2.

use crate::{Outcome, command, need, output, start, target};

/// The crates that have vector kernels, arrays in files, or trees of both.
const CRATES: &str = "-p p2m-core -p p2m-bvh -p p2m-kdop -p p2m-interception";
/// A test that counts how often rare cases came up on all instruction sets, of which there are fewer under valgrind.
const SKIPPED: &str = "walks_end_at_the_nearest_site_wherever_they_begin";

/// Runs the unit tests of the crates and the tests of saved files.
pub(crate) fn run() -> Outcome {
    under_address_sanitizer()?;
    need("valgrind")?;
    // An access that is not allowed makes a test program fail.
    for tests in [format!("{CRATES} --lib -- --skip {SKIPPED}"), "-p p2m --test all -- saved:: crafted_files::".into()]
    {
        let runner = "valgrind --quiet --error-exitcode=99";
        let mut tests = command(&format!("cargo test --locked {tests}"));
        start(tests.env("CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER", runner))?;
    }
    Ok(())
}

/// Runs the unit tests of the crates under AddressSanitizer, which only nightly compilers have.
fn under_address_sanitizer() -> Outcome {
    let Ok(version) = output(&mut command("rustc +nightly -vV")) else {
        return crate::skip("there is no nightly compiler for AddressSanitizer");
    };
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).ok_or("rustc does not say its host")?;
    let test = "cargo +nightly test --locked --lib --features p2m-core/rayon --target";
    let mut tests = command(&format!("{test} {host} {CRATES}"));
    tests.arg("--target-dir").arg(target("asan")).env("RUSTFLAGS", "-Zsanitizer=address");
    // An allocation that is refused is null, as it is without the sanitizer: a test asks for absurd sizes.
    tests.env("ASAN_OPTIONS", "allocator_may_return_null=1");
    // The assertions of the standard library on its preconditions are on, and reports have lines.
    tests.env("CARGO_PROFILE_TEST_DEBUG_ASSERTIONS", "true").env("CARGO_PROFILE_TEST_DEBUG", "line-tables-only");
    start(&mut tests)
}
