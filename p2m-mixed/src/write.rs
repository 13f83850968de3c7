//! Scenes to OBJ.

use p2m_core::{Element, Soup};
use std::io::{self, Write};

/// Writes a scene as OBJ: its positions, then its primitives in the order of their ids, one statement each.
///
/// Numbers are the shortest that read back as the same ones. [`read_obj`](crate::read_obj) gives the scene back, with
/// one exception: positions without any primitive are read as a point cloud. A position that no primitive uses may be
/// anything, but a file cannot hold all of that: one that is not finite is written as the origin.
///
/// # Errors
/// Those of `writer`.
pub fn write_obj(soup: &Soup<f64>, mut writer: impl Write) -> io::Result<()> {
    for p in soup.positions() {
        let p = if p.iter().all(|x| x.is_finite()) { *p } else { nalgebra::Point3::origin() };
        writeln!(writer, "v {:?} {:?} {:?}", p.x, p.y, p.z)?;
    }
    for element in soup.elements() {
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
    writer.flush()
}
