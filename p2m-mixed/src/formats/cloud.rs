//! Clouds of points as tables and arrays.

use crate::builder::SceneBuilder;
use crate::parse::blocks::Source;
use crate::points::npy;
use crate::points::table::{self, TableNotes};
use crate::{PointColumns, ReadError, Reason, Scene, WriteError};
use nalgebra::Point3;
use p2m_core::{Element, PrimitiveId, npy_header};
use std::io::{BufRead, Write};

/// Reads a point cloud. `for_each_row` reads a file and calls a function for each row, and each finite point becomes a
/// primitive.
fn read_cloud(
    mut builder: SceneBuilder<'_>,
    for_each_row: impl FnOnce(&mut dyn FnMut(Point3<f64>) -> Result<(), Reason>) -> Result<TableNotes, ReadError>,
) -> Result<Scene, ReadError> {
    let (mut left_out, mut row) = (0, 0);
    let TableNotes { unit, is_flat } = for_each_row(&mut |point| {
        let vertex = builder.push_vertex(point)?;
        match point.iter().all(|x| x.is_finite()) {
            true => builder.push(Element::Point(vertex), row)?,
            false => left_out += 1,
        }
        row += 1;
        Ok(())
    })?;
    (builder.unit, builder.is_flat) = (unit, is_flat);
    builder.skipped.add_plural(left_out, "vertices that are not finite");
    Ok(builder.finish())
}

/// Reads a table of points.
pub(super) fn read_table(
    source: Source<impl BufRead>,
    name: &str,
    builder: SceneBuilder<'_>,
) -> Result<Scene, ReadError> {
    read_cloud(builder, |take| {
        table::for_each_row(source.into_reader(), name, &PointColumns::default(), |point, _| take(point))
    })
}

/// Returns the points of a scene, or an error if the scene has other primitives.
fn points_of(scene: &Scene) -> Result<impl ExactSizeIterator<Item = Point3<f64>>, WriteError> {
    let soup = &scene.soup;
    match soup.elements().position(|element| !matches!(element, Element::Point(_))) {
        Some(at) => Err(WriteError::NotAPoint { id: PrimitiveId::new(at) }),
        None => Ok(soup.points().iter().map(|&point| soup.positions()[point as usize])),
    }
}

/// Writes a table of points after the text `head`, with a separator between coordinates.
fn write_table(scene: &Scene, mut writer: impl Write, head: &str, separator: char) -> Result<(), WriteError> {
    let points = points_of(scene)?;
    writer.write_all(head.as_bytes())?;
    for p in points {
        writeln!(writer, "{:?}{separator}{:?}{separator}{:?}", p.x, p.y, p.z)?;
    }
    writer.flush()?;
    Ok(())
}

/// Writes columns that are separated by blanks.
pub(super) fn write_xyz(scene: &Scene, writer: impl Write) -> Result<(), WriteError> {
    write_table(scene, writer, "", ' ')
}

/// Writes columns with names that are separated by commas.
pub(super) fn write_csv(scene: &Scene, writer: impl Write) -> Result<(), WriteError> {
    write_table(scene, writer, "x,y,z\n", ',')
}

/// Reads an array of NumPy.
pub(super) fn read_npy(
    source: Source<impl BufRead>,
    name: &str,
    builder: SceneBuilder<'_>,
) -> Result<Scene, ReadError> {
    read_cloud(builder, |take| {
        let is_flat = npy::for_each_row(source.into_reader(), name, |point, _| take(point))?;
        Ok(TableNotes { unit: None, is_flat })
    })
}

/// Writes an array of NumPy.
pub(super) fn write_npy(scene: &Scene, mut writer: impl Write) -> Result<(), WriteError> {
    let points = points_of(scene)?;
    writer.write_all(&npy_header("'<f8'", &format!("({}, 3)", points.len()), false))?;
    for x in points.flat_map(|p| [p.x, p.y, p.z]) {
        writer.write_all(&x.to_le_bytes())?;
    }
    writer.flush()?;
    Ok(())
}
