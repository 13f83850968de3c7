//! Scans: files of points, or of scenes whose vertices are the points.

use crate::io::input::{
    SceneArgs, format_list, is_standard, or_option, read_points, read_scene_and_index, uncompressed_name, unnamed,
};
use crate::io::streams::Streams;
use crate::io::usage::{one_of, usage};
use anyhow::Context;
use nalgebra::Point3;
use p2m_core::{Element, Soup, UnknownExtension, UnknownFormat};
use p2m_mixed::{Format, PointFormat, Scene};
use rayon::ThreadPool;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::LazyLock;

/// The scan of a command.
#[derive(clap::Args)]
pub(crate) struct ScanArgs {
    #[arg(id = "scan", value_name = "SCAN", help = help())]
    pub(crate) path: PathBuf,

    /// The format of the scan [default: by the file extension]
    #[arg(id = "scan_format", long = "scan-format", value_name = "FORMAT", value_parser = one_of::<ScanFormat>(ScanFormat::names()), ignore_case = true)]
    format: Option<ScanFormat>,
}

impl ScanArgs {
    /// Returns the format: the given one, or else that of the extension.
    pub(crate) fn format(&self) -> anyhow::Result<ScanFormat> {
        ScanFormat::of(&self.path, self.format, "--scan-format")
    }

    /// Refuses the standard input for both the scan and its scene.
    pub(crate) fn refuse_same_input(&self, scene: &SceneArgs) -> anyhow::Result<()> {
        if is_standard(&self.path) && is_standard(&scene.path) {
            return Err(usage("the standard input cannot be both the scan and the scene"));
        }
        Ok(())
    }
}

/// Returns the help of a scan.
fn help() -> String {
    let formats = format_list(|_| true, "or");
    format!(
        "Scan: an NPY file of points, or an {formats} file, whose vertices are the points; `-` is the \
         standard input"
    )
}

/// The format of a scan.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ScanFormat {
    /// A file of a scene. PLY files are read as scenes, so that their triangles are known.
    Scene(Format),
    /// A file of points.
    Points(PointFormat),
}

impl ScanFormat {
    /// Returns the names of all formats, which are also the extensions of files.
    pub(crate) fn names() -> &'static [&'static str] {
        static NAMES: LazyLock<Vec<&str>> = LazyLock::new(|| {
            let of_scenes = Format::NAMES.iter().filter(|name| !PointFormat::NAMES.contains(name));
            PointFormat::NAMES.iter().chain(of_scenes).copied().collect()
        });
        &NAMES
    }

    /// Returns the format of a scan: the given one, or else that of the extension.
    fn of(path: &Path, given: Option<Self>, option: &str) -> anyhow::Result<Self> {
        match given {
            Some(format) => Ok(format),
            None if is_standard(path) => Err(unnamed(option, Self::names())),
            None => {
                let name = uncompressed_name(path)?;
                let extension = name.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
                extension.parse().map_err(|UnknownFormat { name: extension, supported }| {
                    or_option(&UnknownExtension { file: name.display().to_string(), extension, supported }, option)
                })
            }
        }
    }

    /// Returns the name of the format.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Scene(format) => format.name(),
            Self::Points(format) => format.name(),
        }
    }

    /// Reads a scan as a scene. Points of a file of points are primitives.
    pub(crate) fn read(self, streams: &Streams, pool: &ThreadPool, path: &Path) -> anyhow::Result<Scene> {
        match self {
            Self::Scene(format) => Ok(read_scene_and_index(streams, pool, path, format, false)?.0),
            Self::Points(format) => {
                let points = read_points(streams, path, format)?;
                let is_finite = |point: &Point3<f64>| point.iter().all(|x| x.is_finite());
                let finite = (0..).zip(&points).filter(|(_, point)| is_finite(point));
                let elements: Vec<_> = finite.map(|(number, _)| Element::Point(number)).collect();
                Ok(Soup::new(points, elements).with_context(|| path.display().to_string())?.into())
            }
        }
    }
}

impl FromStr for ScanFormat {
    type Err = UnknownFormat;

    fn from_str(name: &str) -> Result<Self, UnknownFormat> {
        let format = name.parse().map(Self::Scene).or_else(|_| name.parse().map(Self::Points));
        format.map_err(|error: UnknownFormat| UnknownFormat { supported: Self::names(), ..error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_formats_of_scenes_and_points_are_formats_of_scans() {
        for name in Format::NAMES.iter().chain(PointFormat::NAMES) {
            assert!(ScanFormat::names().contains(name), "{name}");
        }
        for name in ScanFormat::names() {
            assert!(name.parse::<ScanFormat>().is_ok(), "{name}");
        }
    }
}
