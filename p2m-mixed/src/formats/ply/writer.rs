//! Writes scenes as PLY.

use crate::{Scene, WriteError};
use nalgebra::Point3;
use p2m_core::{Element, PrimitiveSet, Soup};
use std::io::{self, Write};

/// Writes a scene as binary PLY, little-endian.
///
/// Positions are in double precision. Triangles are elements `face`, segments are `edge`, and points are `point`.
///
/// A PLY file groups primitives by kind. Ids are kept nevertheless:
///
/// - If the ids of each kind are consecutive, the elements come in the order of the ids.
/// - If kinds alternate, each primitive has a property `p2m_id` with its id, which [`read_ply`](crate::read_ply) reads
///   and other programs ignore.
/// - A scene whose primitives are all of its positions in order is written as vertices alone, which is a point cloud
///   for every program. Otherwise points are an element `point` with the property `vertex_index`. A scene with
///   positions but no primitives has this element without members.
///
/// [`read_ply`](crate::read_ply) returns the same soup, bit by bit. Objects are lost.
///
/// # Errors
/// Errors of `writer`.
pub fn write_ply(scene: &Scene, writer: impl Write) -> Result<(), WriteError> {
    write(&scene.soup, None, Rows { writer, is_text: false })
}

/// A number and a colour for each position of a scene, which viewers show.
#[derive(Clone, Copy, Debug)]
pub struct VertexValues<'a> {
    /// The name of the property of type `double` that has the numbers, a word of ASCII letters.
    pub name: &'a str,
    /// The numbers, one for each position.
    pub values: &'a [f64],
    /// Red, green and blue, one colour for each position: the properties `red`, `green` and `blue` of type `uchar`.
    pub colours: &'a [[u8; 3]],
}

/// Writes a scene as [`write_ply`] does, with a number and a colour for each vertex.
///
/// # Errors
/// Errors of `writer`.
///
/// # Panics
/// If there is not one number and one colour for each position of the scene.
pub fn write_ply_with_values(scene: &Scene, values: &VertexValues<'_>, writer: impl Write) -> Result<(), WriteError> {
    let count = scene.soup.positions().len();
    assert_eq!([values.values.len(), values.colours.len()], [count; 2], "a value and a colour for each position");
    write(&scene.soup, Some(values), Rows { writer, is_text: false })
}

/// Writes a scene as [`write_ply`] does, but as text. Numbers have the fewest digits that read back as the same number.
///
/// # Errors
/// Errors of `writer`.
pub fn write_ply_ascii(scene: &Scene, writer: impl Write) -> Result<(), WriteError> {
    write(&scene.soup, None, Rows { writer, is_text: true })
}

/// A point, as a kind of primitive. Kinds are the numbers of vertices.
const POINT: usize = 1;
/// A segment, as a kind of primitive.
const EDGE: usize = 2;
/// A triangle, as a kind of primitive.
const FACE: usize = 3;

fn write(soup: &Soup<f64>, values: Option<&VertexValues<'_>>, mut rows: Rows<impl Write>) -> Result<(), WriteError> {
    let positions = soup.positions();
    let kinds = if is_point_cloud(soup) { Some(Vec::new()) } else { kinds_in_order(soup) };
    let with_ids = kinds.is_none();
    let mut kinds = kinds.unwrap_or_else(|| {
        let counts = [(FACE, soup.triangles().len()), (EDGE, soup.segments().len()), (POINT, soup.points().len())];
        counts.into_iter().filter(|&(_, count)| count > 0).map(|(kind, _)| kind).collect()
    });
    if soup.len() == 0 && !positions.is_empty() {
        kinds = vec![POINT];
    }

    let format = if rows.is_text { "ascii" } else { "binary_little_endian" };
    let mut header = format!("ply\nformat {format} 1.0\nelement vertex {}\n", positions.len());
    header += "property double x\nproperty double y\nproperty double z\n";
    if let Some(values) = values {
        let colours = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
        header += &format!("property double {}\n{colours}", values.name);
    }
    // More programs support signed indices.
    let index = if i32::try_from(positions.len()).is_ok() { "int" } else { "uint" };
    for &kind in &kinds {
        header += &match kind {
            FACE => {
                format!("element face {}\nproperty list uchar {index} vertex_indices\n", soup.triangles().len())
            }
            EDGE => {
                format!("element edge {}\nproperty {index} vertex1\nproperty {index} vertex2\n", soup.segments().len())
            }
            _ => format!("element point {}\nproperty {index} vertex_index\n", soup.points().len()),
        };
        if with_ids {
            header += "property int p2m_id\n";
        }
    }
    rows.writer.write_all(header.as_bytes())?;
    rows.writer.write_all(b"end_header\n")?;

    for (i, p) in positions.iter().enumerate() {
        rows.position(p)?;
        if let Some(values) = values {
            rows.writer.write_all(&values.values[i].to_le_bytes())?;
            rows.writer.write_all(&values.colours[i])?;
        }
    }
    for kind in kinds {
        if with_ids {
            for (id, element) in (0..).zip(soup.elements()).filter(|(_, e)| e.indices().len() == kind) {
                rows.primitive(element, Some(id))?;
            }
        } else {
            match kind {
                FACE => soup.triangles().iter().try_for_each(|&t| rows.primitive(Element::Triangle(t), None))?,
                EDGE => soup.segments().iter().try_for_each(|&s| rows.primitive(Element::Segment(s), None))?,
                _ => soup.points().iter().try_for_each(|&p| rows.primitive(Element::Point(p), None))?,
            }
        }
    }
    rows.writer.flush()?;
    Ok(())
}

/// Returns whether the primitives are all of the positions in order.
fn is_point_cloud(soup: &Soup<f64>) -> bool {
    let points = soup.points();
    points.len() == soup.len()
        && points.len() == soup.positions().len()
        && (0..).zip(points).all(|(i, &point): (u32, _)| i == point)
}

/// Returns the kinds in the order of the ids, or `None` if the ids of a kind are not consecutive.
fn kinds_in_order(soup: &Soup<f64>) -> Option<Vec<usize>> {
    let mut kinds = Vec::new();
    for element in soup.elements() {
        let kind = element.indices().len();
        if kinds.last() != Some(&kind) {
            if kinds.contains(&kind) {
                return None;
            }
            kinds.push(kind);
        }
    }
    Some(kinds)
}

/// Writes rows of numbers as text or binary.
struct Rows<W> {
    writer: W,
    is_text: bool,
}

impl<W: Write> Rows<W> {
    fn position(&mut self, p: &Point3<f64>) -> io::Result<()> {
        if self.is_text {
            return writeln!(self.writer, "{:?} {:?} {:?}", p.x, p.y, p.z);
        }
        let mut row = [0; 24];
        for (bytes, x) in row.as_chunks_mut().0.iter_mut().zip(p.iter()) {
            *bytes = x.to_le_bytes();
        }
        self.writer.write_all(&row)
    }

    /// Writes a primitive. Signed and unsigned integers have the same bytes within the range of both.
    fn primitive(&mut self, element: Element, id: Option<u32>) -> io::Result<()> {
        let indices = element.indices();
        let is_face = indices.len() == FACE;
        let numbers = indices.iter().copied().chain(id);
        if self.is_text {
            let mut blank = "";
            if is_face {
                write!(self.writer, "{FACE}")?;
                blank = " ";
            }
            for number in numbers {
                write!(self.writer, "{blank}{number}")?;
                blank = " ";
            }
            return writeln!(self.writer);
        }
        let mut row = [0; 17];
        let mut length = usize::from(is_face);
        row[0] = 3; // if it is a face: the length of the list
        for number in numbers {
            row[length..length + 4].copy_from_slice(&number.to_le_bytes());
            length += 4;
        }
        self.writer.write_all(&row[..length])
    }
}
