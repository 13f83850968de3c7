//! Scans: files of points, or of scenes whose vertices are the points.

use crate::io::input::{format_list, name, read_points, scene_format};
use crate::io::usage::{one_of, usage};
use crate::io::{SceneArgs, SceneFile, Session, is_standard};
use anyhow::Context;
use p2m_core::Element;
use p2m_formats::FileFormat;
use p2m_mixed::engine::SceneBuilder;
use p2m_mixed::{Format, PointColumns, PointIds, Scene};
use std::path::PathBuf;

/// The scan of a command.
#[derive(clap::Args)]
pub(crate) struct ScanArgs {
    #[arg(id = "scan", value_name = "SCAN", help = help())]
    pub(crate) path: PathBuf,

    /// The format of the scan [default: by the file extension]
    #[arg(id = "scan_format", long = "scan-format", value_name = "FORMAT", value_parser = one_of::<FileFormat>(FileFormat::names()), ignore_case = true)]
    format: Option<FileFormat>,

    /// The columns of x, y and perhaps z in a scan that is a text table: names, or numbers from 1
    #[arg(id = "scan_columns", long = "scan-columns", value_name = "COLUMNS", value_delimiter = ',', num_args = 1)]
    columns: Vec<String>,
}

impl ScanArgs {
    /// Returns the format: the given one, or else that of the extension.
    pub(crate) fn format(&self) -> anyhow::Result<FileFormat> {
        scene_format(&self.path, self.format, "--scan-format")
    }

    /// Refuses the standard input for both the scan and its scene.
    pub(crate) fn refuse_same_input(&self, scene: &SceneArgs) -> anyhow::Result<()> {
        if is_standard(&self.path) && is_standard(&scene.path) {
            return Err(usage("the standard input cannot be both the scan and the scene"));
        }
        Ok(())
    }

    /// Reads the scan as a scene. Points of a file of points are primitives. If ids are wanted, those of its points are
    /// returned as well, where a table or an array has them.
    pub(crate) fn read(
        &self,
        session: &Session<'_>,
        format: FileFormat,
        wants_ids: bool,
    ) -> anyhow::Result<(Scene, Option<PointIds>)> {
        let may_have_ids = matches!(format, FileFormat::Own(Format::Xyz | Format::Csv | Format::Npy));
        if self.columns.is_empty() && !(wants_ids && may_have_ids) {
            return Ok((SceneFile::read(session, &self.path, format, false)?.scene, None));
        }
        let columns = PointColumns { coordinates: self.columns.clone(), id: None };
        let table = read_points(session.streams, &self.path, format, &columns, "--scan-columns is")?;
        let too_large = || name(&self.path);
        let (mut builder, mut left_out) = (SceneBuilder::default(), 0);
        for (number, point) in table.points.iter().enumerate() {
            let vertex = builder.push_vertex(*point).with_context(too_large)?;
            match point.iter().all(|x| x.is_finite()) {
                true => builder.push(Element::Point(vertex), number).with_context(too_large)?,
                false => left_out += 1,
            }
        }
        builder.skipped.add_plural(left_out, "vertices that are not finite");
        Ok((builder.finish(), table.ids))
    }
}

/// Returns the help of a scan.
fn help() -> String {
    let formats = format_list(FileFormat::all(), "or");
    format!("Scan: a file ({formats}), whose vertices are the points; `-` is the standard input")
}
