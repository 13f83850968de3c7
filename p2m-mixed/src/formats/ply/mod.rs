//! Reads PLY files, the Stanford polygon format, as text or in both binary encodings.

mod data;
mod header;
mod members;
mod plan;
mod rows;
mod writer;

pub(super) use writer::write_ply as write;
pub use writer::{VertexValues, write_ply, write_ply_ascii, write_ply_with_values};

use crate::builder::SceneBuilder;
use crate::parse::blocks::Source;
use crate::points::row::Row;
use crate::{FileLocation, HeaderProblem, ReadError, Reason, Scene};
use data::{Data, Numbers};
use header::read_header;
use members::Members;
use nalgebra::Point3;
use plan::{Coordinates, ElementPlan, Form, has_vertex_list};
use rows::ReadRow;
use std::io::BufRead;

/// Reads a PLY file. `name` is the name of the file in messages.
///
/// The elements with geometry are:
///
/// - `vertex` has `x`, `y` and `z` of any type.
/// - `face` has a list `vertex_indices` or `vertex_index`. A face of one or two vertices is a point or a segment.
/// - `tristrips` has such a list, in which -1 starts a new strip. Every other triangle is reversed, so that all have
///   the winding of the first.
/// - `edge` has `vertex1` and `vertex2`.
/// - `point` has `vertex_index` of an integer type. [`write_ply`](crate::write_ply) writes such elements.
///
/// Elements and properties may come in any order. Other elements and properties, and anything after the last element,
/// are counted in [`Scene::skipped`].
///
/// A file without faces, strips and edges, and without an element `point` of that form, is a point cloud, and each
/// vertex is a point. If another element has a list of vertices (named `vertex_ind..`), such as polygons or tetrahedra
/// under another name, that element is skipped, and the scene is empty.
///
/// Primitives are numbered in the order of the file. If faces, edges and points have the property `p2m_id`, it is the
/// id of the primitive, and every face has to have three vertices.
///
/// Coordinates that are not finite are allowed if no primitive uses the vertex. A point cloud leaves such vertices out
/// and counts them in [`Scene::skipped`].
///
/// The numbers of a text file are read in double precision, even if the header says `float`. An element may extend over
/// several lines, but nothing may follow it on its last line. Lines end at `\n`, `\r\n` or `\r`. All lines of a header
/// before binary data end as its first line does.
///
/// # Errors
/// [`ReadError`] with the line (header, text) or the offset of the number in bytes (binary) for an invalid header, an
/// early end, invalid numbers or too many of them on a line, indices that are out of range, vertices of primitives that
/// are not finite (with the location of the vertex), ids that are not a permutation of 0, 1, 2, ..., faces of no vertex
/// (with ids, of fewer than three) or of more than [`MAX_CORNERS`](crate::MAX_CORNERS), and errors of `reader`. No
/// memory is allocated for data that the header only announces.
pub fn read_ply(reader: impl BufRead, name: &str) -> Result<Scene, ReadError> {
    read(Source::new(reader), name, SceneBuilder::default())
}

/// Reads a PLY file into a builder.
pub(super) fn read(
    mut reader: Source<impl BufRead>,
    name: &str,
    builder: SceneBuilder<'_>,
) -> Result<Scene, ReadError> {
    let header = read_header(&mut reader, name)?;
    let fail = |reason| ReadError::new(name, FileLocation::File, reason);

    // Every element gets its plan before any data is read, so an unsuitable header is an error at once.
    let mut plans = Vec::new();
    let mut vertex_count = 0;
    let mut is_cloud = true;
    for element in &header.elements {
        let plan = match ElementPlan::of(element) {
            // An element without members needs no properties.
            Err(_) if element.count == 0 => ElementPlan::Skip,
            plan => plan.map_err(|problem| fail(Reason::BadHeader(problem)))?,
        };
        match &plan {
            ElementPlan::Vertices(_) => vertex_count = element.count,
            // Our writer adds this element to a scene that is no point cloud, even if it has no members.
            ElementPlan::Members(members) if members.form == Form::Point => is_cloud = false,
            ElementPlan::Members(_) => is_cloud &= element.count == 0,
            ElementPlan::Skip => is_cloud &= element.count == 0 || !has_vertex_list(element),
        }
        plans.push(plan);
    }
    if vertex_count > u64::from(u32::MAX) {
        return Err(fail(Reason::ElementTooLarge { count: vertex_count, limit: u64::from(u32::MAX) }));
    }
    let ids = plan::ids(&header.elements, &plans).map_err(|problem| fail(Reason::BadHeader(problem)))?;

    let mut data = Data::new(reader, &header, name);
    let faces = header.elements.iter().filter(|e| e.name == b"face").map(|e| e.count).sum();
    let mut members = Members::new(builder, vertex_count, faces, ids);
    for (element, plan) in header.elements.iter().zip(&plans) {
        match plan {
            ElementPlan::Skip => {
                skip(&mut data, element)?;
                members.builder.skipped.add(&[b"element ", element.name.as_slice()].concat(), element.count);
            }
            ElementPlan::Vertices(xyz) => {
                let in_blocks =
                    VertexRows { element, coordinates: xyz, is_cloud }.read_blocks(&mut data, &mut members)?;
                for _ in in_blocks..element.count {
                    let (position, bad) = vertex(&mut data, &element.properties, xyz)?;
                    // No primitive of a cloud uses a vertex that is not finite.
                    let bad = bad.filter(|_| !is_cloud);
                    members
                        .vertex(Point3::from(position), bad.map(|(location, _)| location))
                        .map_err(|reason| data.error(|| reason))?;
                }
                members.end_vertices(name)?;
                count_skipped_properties(&mut members.builder, element, &xyz.map(|(at, _)| at));
            }
            ElementPlan::Members(plan) => {
                members.start_element(plan);
                let in_blocks = members.read_blocks(&mut data, element, plan)?;
                for number in in_blocks..usize::try_from(element.count).unwrap_or(usize::MAX) {
                    members.read(&mut data, &element.properties, plan, number)?;
                }
                members.end_element();
                count_skipped_properties(&mut members.builder, element, &plan.used());
            }
        }
    }
    let (rest, what) = data.rest()?;
    members.builder.skipped.add_plural(rest, what);
    if is_cloud {
        members.builder.push_point_cloud().map_err(fail)?;
    }
    members.finish(name)
}

/// Reads vertices in blocks.
struct VertexRows<'a> {
    element: &'a header::Element,
    coordinates: &'a Coordinates<3>,
    is_cloud: bool,
}

impl ReadRow<Vec<Point3<f64>>> for VertexRows<'_> {
    /// A vertex of a primitive that is not finite, and those after it, are left to the sequential reader, which finds
    /// the location of its coordinate.
    fn read<N: Numbers>(&self, numbers: &mut N, positions: &mut Vec<Point3<f64>>) -> Result<(), N::Error> {
        let (position, bad) = vertex(numbers, &self.element.properties, self.coordinates)?;
        if let Some((_, coordinate)) = bad.filter(|_| !self.is_cloud) {
            return Err(numbers.error(|| Reason::NonFinite { text: coordinate.to_string() }));
        }
        positions.push(Point3::from(position));
        Ok(())
    }
}

impl VertexRows<'_> {
    /// Reads vertices and returns their number.
    fn read_blocks(
        &self,
        data: &mut Data<'_, Source<impl BufRead>>,
        members: &mut Members<'_>,
    ) -> Result<u64, ReadError> {
        let file = data.file;
        data.read_rows(&self.element.properties, self.element.count, self, |rows| {
            for (row, &position) in rows.parsed[..rows.count].iter().enumerate() {
                members.vertex(position, None).map_err(|reason| rows.error(file, row, reason, self))?;
            }
            Ok(())
        })
    }
}

/// Reads the vertices of a PLY file as rows. Elements after the vertices are not read.
pub(crate) fn read_vertices<R: Row<N>, const N: usize>(
    mut reader: impl BufRead,
    name: &str,
) -> Result<Vec<R>, ReadError> {
    let header = read_header(&mut reader, name)?;
    let fail = |problem| ReadError::new(name, FileLocation::File, Reason::BadHeader(problem));
    let at = header.elements.iter().position(|element| element.name == b"vertex");
    let at = at.ok_or_else(|| fail(HeaderProblem::MissingElement { element: "vertex" }))?;
    let vertices = &header.elements[at];
    let mut rows = Vec::new();
    if vertices.count == 0 {
        return Ok(rows); // an element without members needs no properties
    }
    let coordinates = plan::coordinates(vertices, R::PROPERTIES).map_err(fail)?;
    let mut data = Data::new(reader, &header, name);
    for element in &header.elements[..at] {
        skip(&mut data, element)?;
    }
    for _ in 0..vertices.count {
        let (numbers, _) = vertex(&mut data, &vertices.properties, &coordinates)?;
        rows.push(R::new(numbers).map_err(|reason| data.error(|| reason))?);
    }
    Ok(rows)
}

/// Skips an element.
fn skip(data: &mut Data<'_, impl BufRead>, element: &header::Element) -> Result<(), ReadError> {
    // The members of an element without properties take no bytes.
    if !element.properties.is_empty() {
        for _ in 0..element.count {
            skip_properties(data, &element.properties)?;
            data.end_element()?;
        }
    }
    Ok(())
}

fn skip_properties(data: &mut Data<'_, impl BufRead>, properties: &[header::Property]) -> Result<(), ReadError> {
    properties.iter().try_for_each(|p| data.skip(p.layout))
}

/// A coordinate that is not finite, and its location.
type NonFiniteCoordinate = (FileLocation, f64);

/// Reads a vertex, and the last of its coordinates that is not finite.
fn vertex<D: Numbers, const N: usize>(
    data: &mut D,
    properties: &[header::Property],
    coordinates: &Coordinates<N>,
) -> Result<([f64; N], Option<NonFiniteCoordinate>), D::Error> {
    let mut position = [0.0; N];
    let mut bad = None;
    for (k, property) in properties.iter().enumerate() {
        match coordinates.iter().position(|&(at, _)| at == k) {
            Some(axis) => {
                position[axis] = data.coordinate(coordinates[axis].1)?;
                if !position[axis].is_finite() {
                    bad = Some((data.location(), position[axis]));
                }
            }
            None => data.skip(property.layout)?,
        }
    }
    data.end_element()?;
    Ok((position, bad))
}

/// Counts the properties other than those `used` as skipped.
fn count_skipped_properties(builder: &mut SceneBuilder<'_>, element: &header::Element, used: &[usize]) {
    for (_, property) in element.properties.iter().enumerate().filter(|(k, _)| !used.contains(k)) {
        let what = [b"property ", property.name.as_slice(), b" of ", element.name.as_slice()].concat();
        builder.skipped.add(&what, element.count);
    }
}
