//! Scenes to OBJ.

use super::{WriteError, finite_or_origin};
use crate::Scene;
use p2m_core::{Element, PrimitiveSet};
use std::io::Write;

/// Writes a scene as OBJ: its positions, then its primitives in the order of their ids, one statement each, with an `o`
/// where an object begins (and one without a name where it ends and no other begins).
///
/// Numbers are the shortest that read back as the same ones. [`read_obj`](crate::read_obj) gives soup and objects back,
/// with these exceptions: positions without any primitive would be read as a point cloud, so they are not written. A
/// position that no primitive uses may be anything, but a file cannot hold all of that: one that is not finite is
/// written as the origin. Line ends in names become blanks, blanks around names are lost.
///
/// # Errors
/// Those of `writer`.
pub fn write_obj(scene: &Scene, mut writer: impl Write) -> Result<(), WriteError> {
    let soup = &scene.soup;
    if soup.len() > 0 {
        for p in soup.positions().iter().map(finite_or_origin) {
            writeln!(writer, "v {:?} {:?} {:?}", p.x, p.y, p.z)?;
        }
    }
    let mut objects = scene.objects.iter().peekable();
    let mut end = None;
    for (id, element) in soup.elements().enumerate() {
        // Objects that are in no order are none of the reader's: they are passed over.
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

/// The line that names an object.
fn statement(name: &str) -> String {
    let mut line = format!("o {}", name.replace(['\n', '\r'], " "));
    if line.ends_with('\\') {
        line.push(' '); // otherwise the next line would be part of the name
    }
    line
}
