//! Checks the script of pages, and tests pages in a browser.

use crate::{Outcome, cargo, debug_program, output, start};
use std::path::Path;
use std::process::Command;

/// The folder of the script and its tests.
const FOLDER: &str = "apps/page/web";
/// Where the tests look for a browser.
const BROWSERS: [&str; 2] = ["/usr/bin/chromium", "/usr/bin/google-chrome"];

/// Checks that the script in the assets is what the sources make, and runs the tests, or says why it cannot here.
pub(crate) fn run() -> Outcome {
    if output("npm", &["--version"]).is_err() {
        return crate::skip("there is no npm for the script of pages");
    }
    if let Err(why) = output("npm", &["view", "esbuild", "version"]) {
        return crate::skip(&format!("the registry of packages for the script of pages cannot be reached\n{why}"));
    }
    start(&mut npm(&["ci", "--no-audit", "--no-fund", "--loglevel=error"]))?;
    start(&mut npm(&["run", "check"]))?;
    if let Err(why) = find_browser() {
        return crate::skip(&format!("there is no Chromium for the tests of pages: {why}"));
    }
    // With the features of `cargo test --workspace` and of `cargo xtask python`, nothing is compiled anew after them.
    cargo(&["build", "--locked", "--workspace", "--lib", "--examples", "--bin", "p2m"], &[])?;
    start(npm(&["test"]).env("P2M", debug_program()?))
}

fn npm(arguments: &[&str]) -> Command {
    let mut npm = Command::new("npm");
    npm.args(arguments).current_dir(FOLDER);
    npm
}

/// Installs a browser if there is none and if this user may install packages.
fn find_browser() -> Outcome {
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
