//! E57: scans of laser scanners, decoded by the crate e57. The pose of each scan is applied.

use crate::File;
use crate::sink::Sink;
use e57::{CartesianCoordinate, E57Reader, RecordDataType};
use p2m_mixed::{ReadError, Scene, Unit};
use std::io::Cursor;

pub(crate) fn read(file: &File<'_>) -> Result<Scene, ReadError> {
    let header = |error: e57::Error| file.error(format!("header: {}", text(&error)));
    let mut reader = E57Reader::new(Cursor::new(file.bytes)).map_err(header)?;
    let mut sink = Sink::new(file.bytes.len());
    for (number, scan) in reader.pointclouds().iter().enumerate() {
        let fail = |what: &dyn std::fmt::Display| file.error(format!("scan {number}, counted from 0: {what}"));
        // Constant values take no bytes, so a file may announce any number of points that consist of nothing else.
        let is_constant = |kind: &RecordDataType| match kind {
            RecordDataType::Integer { min, max } | RecordDataType::ScaledInteger { min, max, .. } => min == max,
            _ => false,
        };
        if scan.prototype.iter().all(|record| is_constant(&record.data_type)) {
            return Err(fail(&"it has no values that differ between points"));
        }
        sink.builder.start_object(scan.name.as_deref().unwrap_or_default().as_bytes());
        let mut points = reader.pointcloud_simple(scan).map_err(|error| fail(&text(&error)))?;
        points.intensity_to_color(false);
        for (row, point) in points.enumerate() {
            let at = |what: &dyn std::fmt::Display| fail(&format_args!("point {row}, counted from 0: {what}"));
            let position = match point.map_err(|error| at(&text(&error)))?.cartesian {
                CartesianCoordinate::Valid { x, y, z } => [x, y, z],
                // An invalid point keeps its place, so that points keep their numbers.
                _ => [f64::NAN; 3],
            };
            sink.point(position).map_err(|reason| at(&reason))?;
        }
    }
    sink.builder.unit = Some(Unit::Metre);
    Ok(sink.finish())
}

/// Returns the text of an error and of its causes.
fn text(error: &e57::Error) -> String {
    let causes = std::iter::successors(Some(error as &dyn std::error::Error), |error| error.source());
    causes.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}
