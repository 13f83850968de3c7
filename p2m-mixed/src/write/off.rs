//! Scenes to OFF.

use super::{WriteError, finite_or_origin};
use crate::Scene;
use p2m_core::PrimitiveSet;
use std::io::Write;

/// Writes a scene as OFF text: its positions, then its primitives in the order of their ids. Segments are faces of two
/// vertices, points are faces of one, which not every reader expects.
///
/// Numbers are the shortest that read back as the same ones. [`read_off`](crate::read_off) gives the soup back, with
/// two exceptions: positions without any primitive would be read as a point cloud, so they are not written; and a
/// position that is not finite (no primitive uses it) is written as the origin. Objects are lost.
///
/// # Errors
/// Those of `writer`.
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
