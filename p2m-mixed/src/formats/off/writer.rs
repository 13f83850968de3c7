//! Writes scenes as OFF.

use crate::write::finite_or_origin;
use crate::{Scene, WriteError};
use p2m_core::PrimitiveSet;
use std::io::Write;

/// Writes a scene as OFF text.
///
/// The positions come first, and then the primitives in the order of their ids. Segments are faces of two vertices, and
/// points are faces of one vertex, which not every reader supports.
///
/// Numbers have the fewest digits that read back as the same number. [`read_off`](crate::read_off) returns the
/// same soup, with two exceptions. The positions of a scene without primitives are not written, because they would
/// be read as a point cloud. A position that is not finite, which no primitive uses, is written as the origin.
/// Objects are lost.
///
/// # Errors
/// Errors of `writer`.
pub fn write_off(scene: &Scene, mut writer: impl Write) -> Result<(), WriteError> {
    let soup = &scene.soup;
    let positions = if soup.len() > 0 { soup.positions() } else { &[] };
    writeln!(writer, "OFF\n{} {} 0", positions.len(), soup.len())?;
    for p in positions.iter().map(finite_or_origin) {
        writeln!(writer, "{:?} {:?} {:?}", p.x, p.y, p.z)?;
    }
    for element in soup.elements() {
        let indices = element.indices();
        write!(writer, "{}", indices.len())?;
        for i in indices {
            write!(writer, " {i}")?;
        }
        writeln!(writer)?;
    }
    writer.flush()?;
    Ok(())
}
