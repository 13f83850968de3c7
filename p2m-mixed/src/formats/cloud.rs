//! Clouds of points as text tables.

use crate::builder::SceneBuilder;
use crate::parse::blocks::Source;
use crate::points::for_each_row;
use crate::{ReadError, Scene, WriteError};
use nalgebra::Point3;
use p2m_core::{Element, PrimitiveId};
use std::io::{BufRead, Write};

/// Reads a table of points, each of which is a primitive.
pub(super) fn read_cloud(
    source: Source<impl BufRead>,
    name: &str,
    mut builder: SceneBuilder<'_>,
) -> Result<Scene, ReadError> {
    let (mut left_out, mut row) = (0, 0);
    for_each_row(source.into_reader(), name, |point: Point3<f64>| {
        let vertex = builder.push_vertex(point)?;
        match point.iter().all(|x| x.is_finite()) {
            true => builder.push(Element::Point(vertex), row)?,
            false => left_out += 1,
        }
        row += 1;
        Ok(())
    })?;
    builder.skipped.add_plural(left_out, "vertices that are not finite");
    Ok(builder.finish())
}

/// Writes the points of a scene that has nothing else after the text `head`, with a separator between coordinates.
fn write_cloud(scene: &Scene, mut writer: impl Write, head: &str, separator: char) -> Result<(), WriteError> {
    let soup = &scene.soup;
    if let Some(at) = soup.elements().position(|element| !matches!(element, Element::Point(_))) {
        return Err(WriteError::NotAPoint { id: PrimitiveId::new(at) });
    }
    writer.write_all(head.as_bytes())?;
    for &point in soup.points() {
        let p = soup.positions()[point as usize];
        writeln!(writer, "{:?}{separator}{:?}{separator}{:?}", p.x, p.y, p.z)?;
    }
    writer.flush()?;
    Ok(())
}

/// Columns that are separated by blanks.
pub(super) mod xyz {
    pub(in crate::formats) use super::read_cloud as read;
    use crate::{Scene, WriteError};
    use std::io::Write;

    pub(in crate::formats) fn write(scene: &Scene, writer: impl Write) -> Result<(), WriteError> {
        super::write_cloud(scene, writer, "", ' ')
    }
}

/// Columns with names that are separated by commas.
pub(super) mod csv {
    pub(in crate::formats) use super::read_cloud as read;
    use crate::{Scene, WriteError};
    use std::io::Write;

    pub(in crate::formats) fn write(scene: &Scene, writer: impl Write) -> Result<(), WriteError> {
        super::write_cloud(scene, writer, "x,y,z\n", ',')
    }
}
