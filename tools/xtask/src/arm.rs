//! Runs tests for ARM processors under qemu.
//!
//! The compiler is the current one if it has the standard library of the target, and the linker and qemu are those of
//! the machine. Where any of them is missing, all are packages of Debian.

use crate::debian::{Packages, cargo_for, has_standard_library};
use crate::{OrSkip, Outcome, command, debug_program, exists, output, run as run_line, start, target};
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "aarch64-unknown-linux-gnu";
/// The packages with the standard library, the linker and what it links to, and qemu.
const PACKAGES: &str = "libstd-rust-web-dev:arm64 gcc-12-aarch64-linux-gnu binutils-aarch64-linux-gnu \
    libgcc-12-dev-arm64-cross libgcc-s1-arm64-cross libc6-dev-arm64-cross libc6-arm64-cross qemu-user-static";
/// The packages with a qemu that can have plugins.
const COUNTER_PACKAGES: &str = "qemu-user libcapstone4";
/// The plugin of qemu that counts instructions.
const COUNTER: &str = "tools/xtask/src/instructions.c";
/// The crates whose unit tests compare lanes with numbers, and searches with brute force.
const CRATES: &str = "-p p2m-core -p p2m-bvh -p p2m-kdop -p p2m-interception";
/// The tests of the facade that compare all backends with each other, in bits.
pub(crate) const AGREEMENT: [&str; 6] =
    ["agreement::", "batches::", "determinism::", "pairs::", "registry::", "saved::"];
/// Commands of the program whose output has to be that of the program for this machine.
const COMMANDS: [&str; 4] = [
    "query scenes/knot_and_cables.obj --random 1000 --quiet",
    "query scenes/knot_and_cables.obj --random 1000 --quiet --backend p2m",
    "query scenes/knot_and_cables.obj --random 1000 --quiet --backend octree --k-nearest 3",
    "ray scenes/knot_and_cables.obj --random 1000 --quiet",
];

/// Runs the tests of lanes; with `--all` the unit tests of the search, the agreement of all backends, the program, and
/// the checksums of answers. With `--instructions` it counts instructions instead.
pub(crate) fn run(arguments: &[String]) -> Outcome {
    if cfg!(target_arch = "aarch64") {
        return crate::skip("this is an ARM processor, on which `cargo test` runs all tests");
    }
    let tools = Tools::find().or_skip(&format!("there is no compiler for {TARGET}, or no qemu"))?;
    if arguments == ["--instructions"] {
        return count_instructions(&tools);
    }
    if arguments == ["--all"] {
        start(&mut tools.cargo(&format!("test --locked {CRATES} --lib")))?;
        start(tools.cargo("test --locked --package p2m --test all").arg("--").args(AGREEMENT))?;
        compare_programs(&tools)?;
        return start(&mut tools.cargo("test --locked --package p2m-testkit --test checksums"));
    }
    start(&mut tools.cargo("test --locked --package p2m-core --lib simd::"))
}

/// Runs commands of the program for ARM, and compares their output with that of the program for this machine.
fn compare_programs(tools: &Tools) -> Outcome {
    start(&mut tools.cargo("build --locked --package p2m-cli"))?;
    let program = target("arm").join(TARGET).join("debug/p2m");
    compare_outputs(|| {
        let mut emulator = Command::new(&tools.qemu);
        emulator.envs(tools.libraries()).arg(&program);
        emulator
    })
}

/// Runs commands of the program for another machine, by `program`, and compares their output with that of the program
/// for this one.
pub(crate) fn compare_outputs(program: impl Fn() -> Command) -> Outcome {
    run_line("cargo build --locked --package p2m-cli")?;
    for line in COMMANDS {
        let words = || line.split(' ');
        let expected = output(Command::new(debug_program()).args(words()))?;
        let found = output(program().args(words()))?;
        if expected.is_empty() || found != expected {
            return Err(format!("p2m {line}: other output than on this machine").into());
        }
        println!("p2m {line}: the same {} bytes", found.len());
    }
    Ok(())
}

/// Prints the instructions per query of each set on each index, with each instruction set.
fn count_instructions(tools: &Tools) -> Outcome {
    let packages = Packages::rust_and("counter", COUNTER_PACKAGES)?;
    let plugin = target("arm/instructions.so");
    start(command(&format!("cc -shared -fPIC -O2 {COUNTER} -o")).arg(&plugin))?;
    let qemu = packages.file("usr/bin/qemu-aarch64");
    let libraries = packages.file("usr/lib/x86_64-linux-gnu");
    let runner = [&*qemu, Path::new("-plugin"), &plugin];
    let mut cargo = tools.cargo_with_runner("test --locked --package p2m --test instructions", &runner);
    // One thread is counted, and qemu finds its libraries.
    cargo.args(["--", "--between-marks"]).env("RAYON_NUM_THREADS", "1").env("LD_LIBRARY_PATH", libraries);
    let counted = cargo.output().map_err(|error| format!("cargo: {error}"))?;
    let [rows, counts] = [&counted.stdout, &counted.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    if !counted.status.success() {
        return Err(counts.into());
    }
    let counts: Vec<u64> = counts.lines().filter_map(|line| line.strip_prefix("count ")?.parse().ok()).collect();
    let rows: Vec<(&str, &str)> = rows.lines().filter_map(|line| line.rsplit_once(',')).collect();
    if counts.len() != 2 * rows.len() || rows.is_empty() {
        return Err(format!("{} counts of {} rows", counts.len(), rows.len()).into());
    }
    // The queries of each set, as tests/instructions/tasks.rs has them.
    let per_query = |marks: &[u64]| (marks[1] - marks[0]) / 200;
    let counted: Vec<_> =
        rows.iter().zip(counts.chunks(2)).map(|((row, isa), marks)| (*row, *isa, per_query(marks))).collect();
    println!("scene,backend,set,portable,neon,neon / portable");
    for (row, _, portable) in counted.iter().filter(|(_, isa, _)| *isa == "portable") {
        for (_, _, neon) in counted.iter().filter(|(other, isa, _)| other == row && *isa == "neon") {
            println!("{row},{portable},{neon},{:.2}", *neon as f64 / *portable as f64);
        }
    }
    Ok(())
}

/// The programs that compile, link and run programs for ARM.
struct Tools {
    /// The packages with the compiler and the linker, unless those of the machine do it.
    packages: Option<Packages>,
    linker: PathBuf,
    qemu: PathBuf,
}

impl Tools {
    fn find() -> Result<Self, String> {
        let [linker, qemu] = ["aarch64-linux-gnu-gcc", "qemu-aarch64-static"];
        if has_standard_library(TARGET) && exists(linker) && exists(qemu) {
            return Ok(Self { packages: None, linker: linker.into(), qemu: qemu.into() });
        }
        let packages = Packages::rust_and("arm", PACKAGES)?;
        let [linker, qemu] = ["aarch64-linux-gnu-gcc-12", qemu].map(|tool| packages.file("usr/bin").join(tool));
        Ok(Self { packages: Some(packages), linker, qemu })
    }

    /// Returns a command of cargo for the target, which runs programs by another program.
    fn cargo_with_runner(&self, line: &str, runner: &[&Path]) -> Command {
        let mut cargo = cargo_for(TARGET, self.packages.as_ref(), "", line);
        let setting = |name: &str, value: String| format!("--config=target.{TARGET}.{name}={value}");
        cargo.arg(setting("linker", format!("{:?}", self.linker))).arg(setting("runner", format!("{runner:?}")));
        if let Some(packages) = &self.packages {
            let root = format!("-Clink-arg=--sysroot={}", packages.folder().display());
            cargo.arg(setting("rustflags", format!("[{root:?}]")));
        }
        cargo.env("CARGO_TARGET_DIR", target("arm")).envs(self.libraries());
        cargo
    }

    /// Returns a command of cargo for the target, which runs programs by qemu.
    fn cargo(&self, line: &str) -> Command {
        self.cargo_with_runner(line, &[&self.qemu])
    }

    /// Returns the variable that names the folder in which qemu finds libraries.
    fn libraries(&self) -> [(&'static str, PathBuf); 1] {
        let folder = "usr/aarch64-linux-gnu";
        let found = self.packages.as_ref().map(|packages| packages.file(folder));
        [("QEMU_LD_PREFIX", found.unwrap_or_else(|| PathBuf::from("/").join(folder)))]
    }
}
