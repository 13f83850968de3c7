//! Checks the script of pages and the npm package, and tests both in a browser.

use crate::{OrSkip, Outcome, build_for_tests, debug_program, need, output, start};
use std::path::Path;
use std::process::Command;

/// The folder of the script and its tests.
const PAGES: &str = "apps/page/web";
/// The folder of the npm package and its tests.
const PACKAGE: &str = "bindings/js";
/// Where the tests look for a browser.
const BROWSERS: [&str; 2] = ["/usr/bin/chromium", "/usr/bin/google-chrome"];

/// Checks that the script in the assets is what the sources make, and runs the tests, or says why it cannot here.
pub(crate) fn run() -> Outcome {
    install(PAGES, "the script of pages")?;
    start(&mut npm(PAGES, &["run", "check"]))?;
    test(PAGES, "pages")
}

/// Builds the npm package and runs its tests in Node and in a browser, or says why it cannot here.
pub(crate) fn package() -> Outcome {
    install(PACKAGE, "the npm package")?;
    start(Command::new("node").args(["licences.mjs", "--check"]).current_dir(PACKAGE))?;
    start(&mut npm(PACKAGE, &["run", "build"]))?;
    test(PACKAGE, "the npm package")
}

/// Installs what the scripts in a folder need.
fn install(folder: &str, what: &str) -> Outcome {
    need("npm")?;
    let found = output("npm", &["view", "esbuild", "version"]);
    found.or_skip(&format!("the registry of packages for {what} cannot be reached"))?;
    start(&mut npm(folder, &["ci", "--no-audit", "--no-fund", "--loglevel=error"]))
}

/// Runs the tests in a folder with the program.
fn test(folder: &str, what: &str) -> Outcome {
    find_browser().or_skip(&format!("there is no Chromium for the tests of {what}"))?;
    build_for_tests()?;
    start(npm(folder, &["test"]).env("P2M", debug_program()))
}

fn npm(folder: &str, arguments: &[&str]) -> Command {
    let mut npm = Command::new("npm");
    npm.args(arguments).current_dir(folder);
    npm
}

/// Installs a browser if there is none and if this user may install packages.
fn find_browser() -> Result<(), String> {
    if BROWSERS.iter().any(|path| Path::new(path).exists()) {
        return Ok(());
    }
    if output("id", &["-u"])?.trim() != "0" {
        return Err("only root can install it".to_owned());
    }
    let install = ["-y", "-qq", "--no-install-recommends", "install", "chromium"];
    output("apt-get", &install)
        .or_else(|_| output("apt-get", &["update"]).and_then(|_| output("apt-get", &install)))
        .map(drop)
}
