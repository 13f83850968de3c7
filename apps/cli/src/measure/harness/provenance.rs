//! The origin of figures: machine, compiler, flags, commit and command.

use serde::Serialize;
use std::path::Path;
use std::process::Command;

/// The origin of figures, which every table and every line of a record states.
#[derive(Clone, Debug, Serialize)]
pub struct Provenance {
    /// The name of the build, `portable` or `native`.
    pub label: String,
    /// The date and time, in UTC.
    pub date: String,
    /// The commit of the checkout, with a mark if files differ from it; or the version of the program.
    pub commit: String,
    /// The model of the processor, and its instruction sets.
    pub cpu: String,
    /// The version of the compiler.
    pub rustc: String,
    /// The profile, the optimisation and RUSTFLAGS.
    pub flags: String,
    /// The instruction sets that the compiler was allowed to use everywhere.
    pub target_features: String,
    /// The command line.
    pub command: String,
}

/// The names of the features for which a macro returns true, at compile time or at run time.
macro_rules! features {
    ($has:ident) => {
        features!($has: "sse2", "sse4.1", "avx", "avx2", "fma", "bmi2", "avx512f", "avx512dq", "avx512vl")
    };
    ($has:ident: $($name:tt),+) => {
        [$(($name, $has!($name))),+].iter().filter(|(_, has)| *has).map(|(name, _)| *name).collect::<Vec<_>>().join(" ")
    };
}

/// Whether the compiler may use a feature everywhere.
macro_rules! compiled {
    ($name:tt) => {
        cfg!(target_feature = $name)
    };
}

/// Whether the processor has a feature.
#[cfg(target_arch = "x86_64")]
macro_rules! detected {
    ($name:tt) => {
        std::arch::is_x86_feature_detected!($name)
    };
}
#[cfg(not(target_arch = "x86_64"))]
macro_rules! detected {
    ($name:tt) => {
        false
    };
}

impl Provenance {
    /// Collects the origin of figures of this program. A program that runs from a checkout passes its path; any other
    /// is identified by its version.
    #[must_use]
    pub fn collect(checkout: Option<&Path>) -> Self {
        let label = if cfg!(target_feature = "avx2") { "native" } else { "portable" };
        let rustflags = env!("P2M_HARNESS_RUSTFLAGS");
        Self {
            label: label.to_owned(),
            date: output("date", &["-u", "+%Y-%m-%dT%H:%MZ"]).unwrap_or_default(),
            commit: checkout.map_or_else(|| concat!("version ", env!("CARGO_PKG_VERSION")).to_owned(), commit),
            cpu: format!("{} (has {})", cpu_model(), features!(detected)),
            rustc: env!("P2M_HARNESS_RUSTC").to_owned(),
            flags: format!(
                "{} opt-level {} RUSTFLAGS \"{rustflags}\"",
                env!("P2M_HARNESS_PROFILE"),
                env!("P2M_HARNESS_OPT_LEVEL")
            ),
            target_features: features!(compiled),
            command: command(),
        }
    }

    /// The names of the columns of [`Provenance::fields`].
    pub const COLUMNS: [&'static str; 7] = ["label", "date", "commit", "cpu", "rustc", "flags", "target_features"];

    /// Returns the fields of a record.
    #[must_use]
    pub fn fields(&self) -> [String; 7] {
        let Self { label, date, commit, cpu, rustc, flags, target_features, .. } = self.clone();
        [label, date, commit, cpu, rustc, flags, target_features]
    }
}

impl std::fmt::Display for Provenance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "Build `{}`: {}, {}, compiled for {}.", self.label, self.rustc, self.flags, self.target_features)?;
        writeln!(f, "CPU: {}. Commit {}, {}.", self.cpu, self.commit, self.date)?;
        writeln!(f, "Command: `{}`", self.command)
    }
}

/// Returns the command line, with the program without its path.
fn command() -> String {
    let mut arguments = std::env::args();
    let program = arguments.next().unwrap_or_default();
    let name = Path::new(&program).file_name().map_or(program.clone(), |name| name.to_string_lossy().into_owned());
    std::iter::once(name).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// Returns the commit of a checkout, with a mark if files differ from it.
fn commit(checkout: &Path) -> String {
    let root = checkout.to_string_lossy();
    let git = |arguments: &[&str]| output("git", &[&["-C", &*root], arguments].concat());
    let mut commit = git(&["rev-parse", "--short", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    if git(&["status", "--porcelain", "--untracked-files=no"]).is_some_and(|changes| !changes.is_empty()) {
        commit.push_str("+changes");
    }
    commit
}

fn cpu_model() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split(": ").nth(1));
    model.unwrap_or(std::env::consts::ARCH).trim().to_owned()
}

/// Returns the output of a command, or `None` if it fails.
fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
