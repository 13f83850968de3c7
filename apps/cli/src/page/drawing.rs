//! Line drawings, such as the bounding volumes of a tree level by level, and scenes in colours.
//!
//! A [`Panel`] is one of the drawings in an SVG file ([`write_svg`]), and a value of the property `panel` in a PLY file
//! ([`write_picture_ply`]). [`box_edges`] returns the lines of a box.

use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, Element, PrimitiveSet, Soup};
use p2m_page::template::escape;
use std::io::{self, Write};

/// A drawing with a title.
pub(crate) struct Panel {
    /// The title above the drawing.
    pub(crate) title: String,
    /// The line segments, in units of the scene. Coordinates have to be finite.
    pub(crate) lines: Vec<[Point3<f64>; 2]>,
}

/// Returns the twelve edges of a box.
pub(crate) fn box_edges(bounds: &Aabb<f64>) -> impl Iterator<Item = [Point3<f64>; 2]> + use<> {
    let corners = [bounds.min, bounds.max];
    (0..12).map(move |edge: usize| {
        // The edge runs along `axis`, at one of the four corners in the plane of the other two axes.
        let (axis, at) = (edge / 4, edge % 4);
        [0, 1].map(|end| {
            let mut corner = corners[end];
            corner[(axis + 1) % 3] = corners[at % 2][(axis + 1) % 3];
            corner[(axis + 2) % 3] = corners[at / 2][(axis + 2) % 3];
            corner
        })
    })
}

/// The direction of view, with z upwards. The help of the command line shows these texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum View {
    /// From a corner
    Isometric,
    /// Along y: x to the right
    Front,
    /// Along -x: y to the right
    Side,
    /// Along -z: x to the right, y up
    Top,
}

impl View {
    /// Returns the directions to the right and upwards in the picture.
    fn axes(self) -> [Vector3<f64>; 2] {
        match self {
            Self::Isometric => {
                let (a, b) = (0.5f64.sqrt(), 6f64.sqrt().recip());
                [Vector3::new(a, -a, 0.0), Vector3::new(-b, -b, 2.0 * b)]
            }
            Self::Front => [Vector3::x(), Vector3::z()],
            Self::Side => [Vector3::y(), Vector3::z()],
            Self::Top => [Vector3::x(), Vector3::y()],
        }
    }
}

/// Maps the drawing to a cube of side 1 around the origin.
struct Frame {
    centre: Point3<f64>,
    /// Half of the longest side of the drawing.
    half: f64,
}

impl Frame {
    fn around<'a>(points: impl Iterator<Item = &'a Point3<f64>>) -> Self {
        let bounds = points.fold(Aabb::empty(), |b, p| b.union(&Aabb { min: *p, max: *p }));
        if bounds.is_empty() {
            return Self { centre: Point3::origin(), half: 1.0 };
        }
        // Bounds are halved before they are subtracted, because the difference of two finite numbers may be infinite.
        let half = (bounds.max.coords / 2.0 - bounds.min.coords / 2.0).max();
        let centre = Point3::from(bounds.max.coords / 2.0 + bounds.min.coords / 2.0);
        Self { centre, half: if half > 0.0 { half } else { 1.0 } }
    }

    fn to_frame(&self, p: &Point3<f64>) -> Vector3<f64> {
        (p.coords / 2.0 - self.centre.coords / 2.0) / self.half
    }
}

/// The side of a panel, in units of the picture.
const PANEL_SIDE: f64 = 300.0;
/// The margin around the drawing of a panel, in units of the picture.
const PANEL_MARGIN: f64 = 24.0;
/// The largest number of panels in a row.
const MAX_COLUMNS: usize = 4;

/// Writes the panels side by side. Each is drawn over `backdrop`, which are points of the scene.
///
/// All panels have the same scale. Coordinates are rounded to a tenth of a unit, and a panel has a side of 300 units.
pub(crate) fn write_svg(
    panels: &[Panel],
    backdrop: &[Point3<f64>],
    view: View,
    mut writer: impl Write,
) -> io::Result<()> {
    let lines = || panels.iter().flat_map(|panel| &panel.lines);
    let frame = Frame::around(lines().flatten().chain(backdrop));
    let [right, up] = view.axes();
    // A cube of side 1 that stands on a corner is 1.634 high in the picture.
    let scale = (PANEL_SIDE - 2.0 * PANEL_MARGIN) / if view == View::Isometric { 1.65 } else { 1.0 };
    let at = |p: &Point3<f64>| {
        let p = frame.to_frame(p);
        let middle = PANEL_SIDE / 2.0;
        format!("{:.1} {:.1}", middle + scale * right.dot(&p), middle - scale * up.dot(&p))
    };
    let (columns, rows) = (panels.len().clamp(1, MAX_COLUMNS), panels.len().div_ceil(MAX_COLUMNS));
    let [width, height] = [columns, rows].map(|n| n as f64 * PANEL_SIDE);
    writeln!(
        writer,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"14\" fill=\"none\" stroke-width=\"0.6\" stroke-linecap=\"round\">"
    )?;
    writeln!(writer, "<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>")?;
    // Points are drawn as lines without length and with round ends.
    write!(writer, "<defs><path id=\"scene\" stroke=\"#bbb\" stroke-width=\"1.2\" d=\"")?;
    for p in backdrop {
        write!(writer, "M{}h0", at(p))?;
    }
    writeln!(writer, "\"/></defs>")?;
    for (number, panel) in panels.iter().enumerate() {
        let [x, y] = [number % MAX_COLUMNS, number / MAX_COLUMNS].map(|n| n as f64 * PANEL_SIDE);
        let [r, g, b] = colour(number, panels.len());
        writeln!(writer, "<g transform=\"translate({x} {y})\">")?;
        writeln!(writer, "<use href=\"#scene\"/>")?;
        write!(writer, "<path stroke=\"#{r:02x}{g:02x}{b:02x}\" stroke-opacity=\"0.7\" d=\"")?;
        for [a, b] in &panel.lines {
            write!(writer, "M{}L{}", at(a), at(b))?;
        }
        writeln!(writer, "\"/>")?;
        writeln!(writer, "<text x=\"8\" y=\"18\" fill=\"#222\">{}</text>", escape(&panel.title))?;
        writeln!(writer, "</g>")?;
    }
    writeln!(writer, "</svg>")?;
    writer.flush()
}

/// Writes the lines of all panels as edges of a binary PLY file. Vertices have a colour and the property `panel`, which
/// is the number of their panel, counted from 0.
/// More than 2^31 - 1 vertices are an error.
pub(crate) fn write_picture_ply(panels: &[Panel], mut writer: impl Write) -> io::Result<()> {
    let count: usize = panels.iter().map(|panel| panel.lines.len()).sum();
    let edges = i32::try_from(count).ok().filter(|n| n.checked_mul(2).is_some());
    let edges = edges.ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "too many lines for a PLY file"))?;
    write!(
        writer,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int panel\n\
         element edge {edges}\nproperty int vertex1\nproperty int vertex2\nend_header\n",
        2 * edges
    )?;
    for (number, panel) in (0i32..).zip(panels) {
        let colour = colour(usize::try_from(number).unwrap_or_default(), panels.len());
        for p in panel.lines.iter().flatten() {
            for x in p.iter() {
                writer.write_all(&x.to_le_bytes())?;
            }
            writer.write_all(&colour)?;
            writer.write_all(&number.to_le_bytes())?;
        }
    }
    for edge in 0..edges {
        writer.write_all(&(2 * edge).to_le_bytes())?;
        writer.write_all(&(2 * edge + 1).to_le_bytes())?;
    }
    writer.flush()
}

/// Returns a colour for each value, from blue for the smallest over green to red for the largest, by the logarithm of
/// the value. Values that are not positive are blue.
pub(crate) fn value_colours(values: &[f64]) -> Vec<[u8; 3]> {
    let logarithms = || values.iter().filter(|x| **x > 0.0).map(|x| x.ln());
    let (smallest, largest) =
        (logarithms().fold(f64::INFINITY, f64::min), logarithms().fold(f64::NEG_INFINITY, f64::max));
    let fraction =
        |x: f64| if x > 0.0 && largest > smallest { (x.ln() - smallest) / (largest - smallest) } else { 0.0 };
    values.iter().map(|x| shade(fraction(*x))).collect()
}

/// Writes a scene as a binary PLY file in which each primitive has the colour of its value ([`value_colours`]).
/// Primitives share no vertices, and vertices have the value as the property `value`.
/// There has to be a value for each primitive. More than 2^31 - 1 vertices are an error.
pub(crate) fn write_values_ply(soup: &Soup<f64>, values: &[f64], mut writer: impl Write) -> io::Result<()> {
    assert_eq!(soup.len(), values.len(), "a value for each primitive");
    let [points, segments, triangles] = [soup.points().len(), soup.segments().len(), soup.triangles().len()];
    let vertices = points + 2 * segments + 3 * triangles;
    if i32::try_from(vertices).is_err() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "too many vertices for a PLY file"));
    }
    write!(
        writer,
        "ply\nformat binary_little_endian 1.0\ncomment value: {} to {}\nelement vertex {vertices}\n\
         property double x\nproperty double y\nproperty double z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nproperty double value\n\
         element face {triangles}\nproperty list uchar int vertex_indices\n\
         element edge {segments}\nproperty int vertex1\nproperty int vertex2\nend_header\n",
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    )?;
    let (mut next, mut faces, mut edges) = (0i32, Vec::new(), Vec::new());
    for ((element, value), colour) in soup.elements().zip(values).zip(value_colours(values)) {
        for index in element.indices() {
            let position = soup.positions()[*index as usize];
            position.iter().try_for_each(|x| writer.write_all(&x.to_le_bytes()))?;
            writer.write_all(&colour)?;
            writer.write_all(&value.to_le_bytes())?;
        }
        match element {
            Element::Triangle(_) => faces.push(next),
            Element::Segment(_) => edges.push(next),
            Element::Point(_) => {}
        }
        next += i32::try_from(element.indices().len()).unwrap_or_default();
    }
    for first in faces {
        writer.write_all(&[3])?;
        [first, first + 1, first + 2].iter().try_for_each(|i| writer.write_all(&i.to_le_bytes()))?;
    }
    for first in edges {
        [first, first + 1].iter().try_for_each(|i| writer.write_all(&i.to_le_bytes()))?;
    }
    writer.flush()
}

/// Returns the colour of a panel, from blue over green to red.
fn colour(number: usize, of: usize) -> [u8; 3] {
    shade(if of > 1 { number as f64 / (of - 1) as f64 } else { 0.0 })
}

/// Returns a colour from blue for 0 over green to red for 1. All are dark enough for thin lines on white.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 255")]
fn shade(t: f64) -> [u8; 3] {
    [40.0 + 170.0 * t, 90.0 + 160.0 * t * (1.0 - t), 200.0 - 160.0 * t].map(|x| x as u8)
}

#[cfg(test)]
mod tests;
