//! Builds the Python package, installs it into a virtual environment, and runs its tests there.

use crate::{Outcome, absolute_target_folder, build_for_tests, debug_program, output, run};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The oldest version of Python that the package supports.
const MIN_VERSION: (u32, u32) = (3, 11);
/// The folder of the package.
const PACKAGE: &str = "bindings/python";
/// The packages that the tests need. They are those of the extra `test` in pyproject.toml.
const NEEDED: [&str; 22] = [
    "numpy>=1.26",
    "dask[array]>=2025.1",
    "distributed>=2025.1",
    "geopandas>=1",
    "hypothesis>=6.100",
    "laspy[lazrs]>=2.5",
    "lxml>=5",
    "mypy>=1.15",
    "networkx>=3",
    "pandas>=2.2",
    "polars>=1.20",
    "pyarrow>=18",
    "pye57>=0.4",
    "pypcd4>=1",
    "pyshp>=2.3",
    "pytest>=8",
    "pytest-xdist>=3.6",
    "scipy>=1.11",
    "tqdm>=4.66",
    "trimesh>=4",
    "types-tqdm>=4.66",
    "zarr>=3",
];

/// The packages that p2m is compared with. They are those of the extra `compare` in pyproject.toml.
const RIVALS: [&str; 6] =
    ["trimesh==5.2.0", "rtree>=1.3", "scipy>=1.11", "libigl==2.6.3", "point-cloud-utils==0.34.0", "open3d==0.20.0"];

/// Tests the package, or says why it cannot be tested here. A filter selects tests of pytest. With `--rivals` first,
/// the package is compared with others, which are installed into an environment of their own.
pub(crate) fn check(filter: &[String]) -> Outcome {
    let compares = filter.first().is_some_and(|first| first == "--rivals");
    let filter = if compares { &filter[1..] } else { filter };
    let Some(python) = find_python() else {
        let (major, minor) = MIN_VERSION;
        return crate::skip(&format!("there is no Python {major}.{minor} or newer with venv"));
    };
    let target = absolute_target_folder()?;
    let bin = environment(&python, if compares { "python-rivals-env" } else { "python-env" })?;
    let own_python = text(&bin.join("python"))?;
    if let Err(why) = install_needed(&own_python, &NEEDED) {
        return crate::skip(&format!("the packages that the tests need cannot be installed\n{why}"));
    }
    if compares {
        for rival in RIVALS {
            if let Err(why) = install_needed(&own_python, &[rival]) {
                println!("\n== not compared with {rival}, which cannot be installed\n{why}");
            }
        }
    }
    // The crates that search are optimised in this profile.
    build_for_tests()?;
    install_package(&own_python, &target.join("debug"))?;
    let in_folder = |folder: &str, arguments: &[&str], variable: (&str, &Path)| {
        let mut command = Command::new(&own_python);
        crate::start(command.arg("-m").args(arguments).env(variable.0, variable.1).current_dir(folder))
    };
    // The program answers the same queries.
    let program = debug_program()?;
    let program = ("P2M_PROGRAM", program.as_path());
    let filter: Vec<&str> = filter.iter().map(String::as_str).collect();
    let tests = |of: &'static str| [&["pytest", "-rs", "--durations=5", of], &filter[..]].concat();
    if compares {
        return in_folder(PACKAGE, &tests("tests/test_rivals.py"), ("P2M_RIVALS", Path::new("1")));
    }
    let on_all_cores = ["--numprocesses=auto", "--dist=loadfile"];
    in_folder(PACKAGE, &[&tests("tests")[..], &on_all_cores].concat(), program)?;
    if !filter.is_empty() {
        return Ok(());
    }
    let examples = ["pytest", "--doctest-modules", "--doctest-glob=README.md", "--pyargs", "p2m", "README.md"];
    in_folder(PACKAGE, &examples, program)?;
    for page in ["docs/python.md", "docs/cluster.md", "docs/guide/training.md"] {
        in_folder(".", &["pytest", "-q", "--doctest-glob=*.md", page], program)?;
    }
    in_folder(PACKAGE, &["mypy"], program)?;
    in_folder(PACKAGE, &["mypy.stubtest", "--mypy-config-file", "pyproject.toml", "p2m"], program)
}

/// Returns the folder of programs of a virtual environment below the target folder, which is made if it is absent.
pub(crate) fn environment(python: &str, name: &str) -> Result<PathBuf, String> {
    let environment = absolute_target_folder()?.join(name);
    let bin = environment.join(if cfg!(windows) { "Scripts" } else { "bin" });
    if output(&text(&bin.join("python"))?, &["--version"]).is_err() {
        run(python, &["-m", "venv", &text(&environment)?], &[])?;
    }
    Ok(bin)
}

/// Returns the first Python of the path that is new enough and can make virtual environments.
pub(crate) fn find_python() -> Option<String> {
    let (major, minor) = MIN_VERSION;
    let check = format!("import sys, venv, ensurepip; assert sys.version_info >= ({major}, {minor})");
    let names = ["python3", "python", "python3.14", "python3.13", "python3.12", "python3.11"];
    names.into_iter().find(|name| output(name, &["-c", &check]).is_ok()).map(str::to_owned)
}

/// Installs what is missing, without a look at the registry if nothing is.
pub(crate) fn install_needed(python: &str, needed: &[&str]) -> Result<(), String> {
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    let offline = [&install[..], &["--no-index"], needed].concat();
    if output(python, &offline).is_ok() {
        return Ok(());
    }
    println!("\n== {python} -m pip install {}", needed.join(" "));
    output(python, &[&install[..], needed].concat()).map(drop)
}

/// Copies the package with its library into the virtual environment, as pip would install it.
fn install_package(python: &str, libraries: &Path) -> Result<(), String> {
    let site = output(python, &["-c", "import sysconfig; print(sysconfig.get_paths()['platlib'])"])?;
    let package = Path::new(site.trim()).join("p2m");
    if package.exists() {
        fs::remove_dir_all(&package).map_err(|error| format!("{}: {error}", package.display()))?;
    }
    copy_files(&Path::new(PACKAGE).join("python/p2m"), &package)?;
    let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let library = libraries.join(format!("{prefix}_p2m{suffix}"));
    let module = package.join(if cfg!(windows) { "_p2m.pyd" } else { "_p2m.abi3.so" });
    fs::copy(&library, module).map(drop).map_err(|error| format!("{}: {error}", library.display()))
}

/// Copies the files of a folder and of those in it, apart from what Python caches.
fn copy_files(from: &Path, to: &Path) -> Result<(), String> {
    let failed = |error| format!("{}: {error}", to.display());
    fs::create_dir_all(to).map_err(failed)?;
    for entry in fs::read_dir(from).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        match path.file_name() {
            Some(name) if path.is_dir() && name != "__pycache__" => copy_files(&path, &to.join(name))?,
            Some(name) if path.is_file() => fs::copy(&path, to.join(name)).map(drop).map_err(failed)?,
            _ => {}
        }
    }
    Ok(())
}

/// Returns a path as text.
pub(crate) fn text(path: &Path) -> Result<String, String> {
    path.to_str().map(str::to_owned).ok_or_else(|| format!("{}: is not Unicode", path.display()))
}
