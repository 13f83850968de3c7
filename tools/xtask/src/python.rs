//! Builds the Python package, installs it into a virtual environment, and runs its tests there.

use crate::{OrSkip, Outcome, build_for_tests, copy, debug_program, files_below, output, read, start, target, tools};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the package.
const PACKAGE: &str = "bindings/python";

/// Tests the package, or says why it cannot be tested here. A filter selects tests of pytest. With `--rivals` first,
/// the package is compared with others, which are installed into an environment of their own.
pub(crate) fn check(filter: &[String]) -> Outcome {
    let compares = filter.first().is_some_and(|first| first == "--rivals");
    let filter: Vec<&str> = filter.iter().skip(usize::from(compares)).map(String::as_str).collect();
    let manifest = read(Path::new(PACKAGE).join("pyproject.toml"))?;
    let needed = [extra(&manifest, "dependencies"), extra(&manifest, "test")].concat();
    let environment = if compares { "python-rivals-env" } else { "python-env" };
    let python = tools::python(environment, &needed).or_skip("the package for Python cannot be tested")?;
    if compares {
        for rival in extra(&manifest, "compare") {
            if let Err(why) = tools::install(&python, &[rival]) {
                println!("\n== not compared with {rival}, which cannot be installed\n{why}");
            }
        }
    }
    // The crates that search are optimised in this profile.
    build_for_tests()?;
    install_package(&python)?;
    // The program answers the same queries.
    let variable = if compares { ("P2M_RIVALS", "1".into()) } else { ("P2M_PROGRAM", debug_program()) };
    let in_folder = |folder: &str, line: &str, filter: &[&str]| {
        let mut command = Command::new(&python);
        command.arg("-m").args(line.split(' ')).args(filter);
        start(command.env(variable.0, &variable.1).current_dir(folder))
    };
    if compares {
        return in_folder(PACKAGE, "pytest -rs --durations=5 tests/test_rivals.py", &filter);
    }
    in_folder(PACKAGE, "pytest -rs --durations=5 --numprocesses=auto --dist=loadfile tests", &filter)?;
    if !filter.is_empty() {
        return Ok(());
    }
    in_folder(PACKAGE, "pytest --doctest-modules --doctest-glob=README.md --pyargs p2m README.md", &[])?;
    for page in ["docs/python.md", "docs/cluster.md", "docs/guide/training.md"] {
        in_folder(".", "pytest -q --doctest-glob=*.md", &[page])?;
    }
    in_folder(PACKAGE, "mypy", &[])?;
    in_folder(PACKAGE, "mypy.stubtest --mypy-config-file pyproject.toml p2m", &[])
}

/// Returns the packages of a list of pyproject.toml.
fn extra<'a>(manifest: &'a str, name: &str) -> Vec<&'a str> {
    let list = manifest.split_once(&format!("\n{name} = [")).and_then(|(_, rest)| rest.split_once("]\n"));
    list.map_or(Vec::new(), |(list, _)| list.split('"').skip(1).step_by(2).collect())
}

/// Copies the package with its library into the virtual environment, as pip would install it.
fn install_package(python: &Path) -> Outcome {
    let script = "import sysconfig; print(sysconfig.get_paths()['platlib'])";
    let site = output(Command::new(python).args(["-c", script]))?;
    let package = Path::new(site.trim()).join("p2m");
    crate::make_empty_folder(&package)?;
    let source = Path::new(PACKAGE).join("python/p2m");
    let is_cached = |file: &PathBuf| file.components().any(|part| part.as_os_str() == "__pycache__");
    for file in files_below(&source)?.into_iter().filter(|file| !is_cached(file)) {
        copy(&file, &package.join(file.strip_prefix(&source).unwrap_or(&file)))?;
    }
    let library = format!("{}_p2m{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let module = if cfg!(windows) { "_p2m.pyd" } else { "_p2m.abi3.so" };
    copy(&target("debug").join(library), &package.join(module))
}
