//! Writes scenes as OBJ.

use crate::write::finite_or_origin;
use crate::{Scene, WriteError};
use p2m_core::{Element, PrimitiveSet};
use std::io::Write;

/// Writes a scene as OBJ.
///
/// The positions come first, and then the primitives in the order of their ids, one statement each. An `o` starts each
/// object, and an `o` without a name ends an object that no other object follows.
///
/// Numbers have the fewest digits that read back as the same number. [`read_obj`](crate::read_obj) returns the same
/// soup and objects, with these exceptions:
///
/// - The positions of a scene without primitives are not written, because they would be read as a point cloud. The file
///   is a comment then.
/// - A position that is not finite, which no primitive uses, is written as the origin.
/// - Line ends in names become blanks, and blanks around names are lost.
///
/// # Errors
/// Errors of `writer`.
pub fn write_obj(scene: &Scene, mut writer: impl Write) -> Result<(), WriteError> {
    let soup = &scene.soup;
    if soup.is_empty() {
        // A file without bytes would be no OBJ file.
        writeln!(writer, "# an empty scene")?;
    } else {
        for p in soup.positions().iter().map(finite_or_origin) {
            writeln!(writer, "v {:?} {:?} {:?}", p.x, p.y, p.z)?;
        }
    }
    let mut objects = scene.objects.iter().peekable();
    let mut end = None;
    for (id, element) in soup.elements().enumerate() {
        // Objects that are not in ascending order do not come from a reader, and are skipped.
        while objects.next_if(|o| o.ids.start < id || o.ids.is_empty()).is_some() {}
        if let Some(object) = objects.next_if(|o| o.ids.start == id) {
            writeln!(writer, "{}", statement(&object.name))?;
            end = Some(object.ids.end);
        } else if end == Some(id) {
            writeln!(writer, "o")?;
        }
        let keyword = match element {
            Element::Point(_) => "p",
            Element::Segment(_) => "l",
            Element::Triangle(_) => "f",
        };
        write!(writer, "{keyword}")?;
        for &i in element.indices() {
            write!(writer, " {}", u64::from(i) + 1)?;
        }
        writeln!(writer)?;
    }
    writer.flush()?;
    Ok(())
}

/// Returns the line that starts an object.
fn statement(name: &str) -> String {
    let mut line = format!("o {}", name.replace(['\n', '\r'], " "));
    if line.ends_with('\\') {
        line.push(' '); // otherwise the next line would be part of the name
    }
    line
}
