//! The smallest build of the library that can read a file and search an index over its scene.

use p2m_backends::BackendEntry;
use p2m_formats::FileFormat;
use std::fmt;

/// The number of crates that each set of features compiles, which `cargo xtask promises` compares with `cargo tree`.
const CRATES: &str = include_str!("crates.csv");
/// A build with some features of the crate `p2m` and without its default ones.
pub(crate) struct SmallestBuild {
    /// The features, in alphabetical order.
    pub(crate) features: Vec<&'static str>,
}

impl SmallestBuild {
    /// The features for an index, and for files of a format.
    pub(crate) fn new(backend: &BackendEntry, format: FileFormat) -> Self {
        let reader = match format {
            FileFormat::Own(_) => "scene",
            FileFormat::Foreign(_) => "formats",
        };
        let mut features: Vec<_> = backend.feature.into_iter().chain([reader]).collect();
        features.sort_unstable();
        Self { features }
    }

    /// The number of crates that it compiles, and that of a build with the default features that reads the same files.
    pub(crate) fn crates(&self) -> [Option<u32>; 2] {
        let of = |features: &str| {
            let row = CRATES.lines().find_map(|line| line.strip_prefix(features)?.strip_prefix(','));
            row.and_then(|crates| crates.parse().ok())
        };
        let default = if self.features.contains(&"formats") { "default formats" } else { "default" };
        [of(&self.features.join(" ")), of(default)]
    }
}

impl fmt::Display for SmallestBuild {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "default-features = false, features = {:?}", self.features)?;
        match self.crates() {
            [Some(crates), Some(default)] => write!(f, ": {crates} crates instead of {default}"),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_backends::BACKENDS;

    #[test]
    fn every_backend_and_format_has_a_build_with_a_number_of_crates() {
        for backend in BACKENDS {
            for format in FileFormat::all() {
                let build = SmallestBuild::new(backend, format);
                let [crates, default] = build.crates().map(|count| count.expect("a row of the table"));
                assert!(crates < default, "{build}");
            }
        }
    }
}
