//! Checks the script of pages and the npm package, and tests both in a browser.

use crate::{OrSkip, Outcome, build_for_tests, command, debug_program, need, output, start};
use std::path::Path;

/// The folder of the script and its tests.
const PAGES: &str = "apps/page/web";
/// The folder of the npm package and its tests.
const PACKAGE: &str = "bindings/js";
/// Where the tests look for a browser.
const BROWSERS: [&str; 2] = ["/usr/bin/chromium", "/usr/bin/google-chrome"];

/// Checks that the script in the assets is what the sources make, and runs the tests, or says why it cannot here.
pub(crate) fn run() -> Outcome {
    install(PAGES, "the script of pages")?;
    start(command("npm run check").current_dir(PAGES))?;
    test(PAGES, "pages")
}

/// Builds the npm package and runs its tests in Node and in a browser, or says why it cannot here.
pub(crate) fn package() -> Outcome {
    install(PACKAGE, "the npm package")?;
    start(command("node licences.mjs --check").current_dir(PACKAGE))?;
    start(command("npm run build").current_dir(PACKAGE))?;
    test(PACKAGE, "the npm package")
}

/// Installs what the scripts in a folder need.
fn install(folder: &str, what: &str) -> Outcome {
    need("npm")?;
    let found = output(&mut command("npm view esbuild version"));
    found.or_skip(&format!("the registry of packages for {what} cannot be reached"))?;
    start(command("npm ci --no-audit --no-fund --loglevel=error").current_dir(folder))
}

/// Runs the tests in a folder with the program.
fn test(folder: &str, what: &str) -> Outcome {
    find_browser().or_skip(&format!("there is no Chromium for the tests of {what}"))?;
    build_for_tests()?;
    start(command("npm test").current_dir(folder).env("P2M", debug_program()))
}

/// Installs a browser if there is none and if this user may install packages.
fn find_browser() -> Result<(), String> {
    if BROWSERS.iter().any(|path| Path::new(path).exists()) {
        return Ok(());
    }
    if output(&mut command("id -u"))?.trim() != "0" {
        return Err("only root can install it".to_owned());
    }
    let install = || output(&mut command("apt-get -y -qq --no-install-recommends install chromium"));
    install().or_else(|_| output(&mut command("apt-get update")).and_then(|_| install())).map(drop)
}
