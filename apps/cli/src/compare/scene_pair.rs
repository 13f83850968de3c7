//! The arguments of commands that are about two scenes, and what they print about a point of each.

use crate::io::input::{COMPRESSED, read_small_text, scene_format, scene_help};
use crate::io::usage::{one_of, usage};
use crate::io::{SceneFile, Session, Streams, json};
use anyhow::Context;
use nalgebra::{Isometry3, Point3};
use p2m_core::pair::{is_rotation_and_translation, isometry_of_matrix};
use p2m_core::{Feature, PrimitiveId};
use p2m_formats::FileFormat;
use p2m_mixed::Scene;
use p2m_mixed::statistics::figure::Length;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct ScenePairArgs {
    #[arg(value_name = "A", help = scene_help("First scene") + COMPRESSED)]
    first: PathBuf,

    /// The second scene
    #[arg(value_name = "B")]
    second: PathBuf,

    /// The format of the first scene [default: by the file extension]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<FileFormat>(FileFormat::names()), ignore_case = true)]
    format: Option<FileFormat>,

    /// The format of the second scene [default: by the file extension]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<FileFormat>(FileFormat::names()), ignore_case = true)]
    second_format: Option<FileFormat>,

    /// Move the second scene by a rotation and a translation: the 12 or 16 numbers of a matrix, row by row, or a file
    /// with them
    #[arg(long, value_name = "MATRIX|FILE", allow_hyphen_values = true)]
    transform: Option<String>,
}

impl ScenePairArgs {
    /// Returns the files of the scenes.
    pub(crate) fn paths(&self) -> [&Path; 2] {
        [&self.first, &self.second]
    }

    /// Returns the formats of the scenes.
    pub(crate) fn formats(&self) -> anyhow::Result<[FileFormat; 2]> {
        Ok([
            scene_format(&self.first, self.format, "--format")?,
            scene_format(&self.second, self.second_format, "--second-format")?,
        ])
    }

    /// Returns the motion of the second scene.
    pub(crate) fn motion(&self, streams: &Streams) -> anyhow::Result<Option<Isometry3<f64>>> {
        self.transform.as_deref().map(|text| parse_motion(streams, text)).transpose()
    }

    /// Reads the scenes as they are in their files.
    pub(crate) fn read(&self, session: &Session<'_>, formats: [FileFormat; 2]) -> anyhow::Result<[SceneFile; 2]> {
        let read = |path: &Path, format| SceneFile::read(session, path, format, false);
        Ok([read(&self.first, formats[0])?, read(&self.second, formats[1])?])
    }
}

/// Parses a matrix, or reads it from the file of that name.
fn parse_motion(streams: &Streams, text: &str) -> anyhow::Result<Isometry3<f64>> {
    let numbers = |text: &str| -> Option<Vec<f64>> {
        let words = text.split(|c: char| c.is_whitespace() || ",;[]".contains(c)).filter(|word| !word.is_empty());
        words.map(|word| word.parse().ok()).collect()
    };
    let (matrix, place) = match numbers(text) {
        Some(matrix) => (matrix, "--transform".to_owned()),
        None => {
            let content = read_small_text(streams, Path::new(text)).context("--transform")?;
            let matrix = numbers(&content).with_context(|| format!("--transform {text}: has something but numbers"))?;
            (matrix, format!("--transform {text}"))
        }
    };
    let is_affine = matrix.len() == 12 || (matrix.len() == 16 && matrix[12..] == [0.0, 0.0, 0.0, 1.0]);
    if !is_affine {
        let count = matrix.len();
        return Err(usage(format!("{place}: {count} numbers are no matrix of 12, or of 16 with the last row 0 0 0 1")));
    }
    if !is_rotation_and_translation(&matrix) {
        return Err(usage(format!("{place}: the first three columns are no rotation, or a number is not finite")));
    }
    Ok(isometry_of_matrix(&matrix))
}

/// Returns the word for the kind of a primitive.
fn kind(scene: &Scene, primitive: PrimitiveId) -> &'static str {
    match scene.soup.element(primitive).indices().len() {
        1 => "point",
        2 => "segment",
        _ => "triangle",
    }
}

/// Returns a line about a point of a primitive and the feature that contains it, if that is known.
pub(crate) fn line_of_point(
    SceneFile { name, scene, .. }: &SceneFile,
    point: Point3<f64>,
    primitive: PrimitiveId,
    feature: Option<Feature>,
) -> String {
    let (kind, number) = (kind(scene, primitive), primitive.index());
    let feature = feature.map_or(String::new(), |feature| format!(" ({feature})"));
    let object = scene.object_of(primitive).map_or(String::new(), |object| format!(" of {}", object.name));
    let [x, y, z] = [point.x, point.y, point.z].map(Length);
    format!("on {name}: ({x}, {y}, {z}), {kind} {number}{feature}{object}\n")
}

/// Returns the report of a point of a primitive. `feature` is an object with the feature that contains it, if that is
/// known.
pub(crate) fn report_of_point(scene: &Scene, point: Point3<f64>, primitive: PrimitiveId, feature: Value) -> Value {
    let place = json!({
        "point": [point.x, point.y, point.z],
        "primitive": primitive.index(),
        "kind": kind(scene, primitive),
    });
    json::joined([place, feature, json!({ "object": scene.object_of(primitive).map(|object| &object.name) })])
}
