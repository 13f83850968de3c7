//! PLY, the Stanford polygon format: text and both binary encodings.

mod data;
mod header;
mod members;
mod plan;

use crate::builder::SceneBuilder;
use crate::points::Row;
use crate::{FileLocation, HeaderProblem, ReadError, Reason, Scene};
use data::Data;
use header::read_header;
use members::Members;
use nalgebra::Point3;
use plan::{Coordinates, Plan, has_vertex_list};
use std::io::BufRead;

/// The property with the id of a primitive, for primitives that are not in the order of their ids.
const ID: &str = "p2m_id";

/// Reads a PLY file; `name` is for messages.
///
/// Understood are the elements `vertex` (`x`, `y`, `z` of any type), `face` and `tristrips` (a list `vertex_indices` or
/// `vertex_index`; in strips -1 starts a new one, and every other triangle is turned so that all have the winding of
/// the first), `edge` (`vertex1`, `vertex2`), and `point` (`vertex_index`, of an integer type;
/// [`write_ply`](crate::write_ply) writes them). Elements and properties may come in any order. Other elements and
/// properties, and whatever follows the last element, are counted in [`Scene::skipped`]. Without any face, strip or
/// edge, and without an element `point` of that form, the file is a point cloud: each vertex is a point. But not if
/// there are other elements with a list of vertices (named `vertex_ind..`), such as polygons or tetrahedra under a name
/// of their own: they are skipped, and the scene is empty.
///
/// Primitives are numbered in the order of the file, unless faces (of three vertices each, then), edges and points have
/// the property `p2m_id`: then by that.
///
/// Coordinates that are not finite are no error as long as no primitive uses the vertex. A point cloud leaves such
/// vertices out and counts them in [`Scene::skipped`].
///
/// In a text file, numbers are taken as they are written, in double precision, even if the header says `float`. An
/// element may go on over several lines, but nothing may follow it on its last one. Lines end at `\n`, `\r\n` or `\r`;
/// those of a header before binary data as its first one does.
///
/// # Errors
/// [`ReadError`] with the line (header, text) or the offset of the number in bytes (binary) for a header that makes no
/// sense, an early end, numbers that are none or too many for their line, indices of no vertex, vertices of primitives
/// that are not finite (with the place of the vertex), ids that are not 0, 1, 2, ... in some order, faces of fewer than
/// three vertices or more than [`MAX_CORNERS`](crate::MAX_CORNERS), and for what goes wrong in reading. No memory is
/// taken for data that is merely announced.
pub fn read_ply(mut reader: impl BufRead, name: &str) -> Result<Scene, ReadError> {
    let header = read_header(&mut reader, name)?;
    let fail = |reason| ReadError::new(name, FileLocation::File, reason);

    // What each element is for, before any data: a header that cannot serve is refused at once.
    let mut plans = Vec::new();
    let mut vertex_count = 0;
    let mut is_cloud = true;
    for element in &header.elements {
        let plan = match Plan::of(element) {
            // Of what there is none, no property is missing.
            Err(_) if element.count == 0 => Plan::Skip,
            plan => plan.map_err(|problem| fail(Reason::BadHeader(problem)))?,
        };
        match &plan {
            Plan::Vertices(_) => vertex_count = element.count,
            // Ours, and there to say that no vertex is a point by itself.
            Plan::Members(members) if members.is_point() => is_cloud = false,
            Plan::Members(_) => is_cloud &= element.count == 0,
            Plan::Skip => is_cloud &= element.count == 0 || !has_vertex_list(element),
        }
        plans.push(plan);
    }
    if vertex_count > u64::from(u32::MAX) {
        return Err(fail(Reason::ElementTooLarge { count: vertex_count, limit: u64::from(u32::MAX) }));
    }
    let ids = plan::ids(&header.elements, &plans).map_err(|problem| fail(Reason::BadHeader(problem)))?;

    let mut data = Data::new(reader, &header, name);
    let faces = header.elements.iter().filter(|e| e.name == b"face").map(|e| e.count).sum();
    let mut members = Members::new(vertex_count, faces, ids);
    for (element, plan) in header.elements.iter().zip(&plans) {
        match plan {
            Plan::Skip => {
                skip(&mut data, element)?;
                members.builder.skipped.add(&[b"element ", element.name.as_slice()].concat(), element.count);
            }
            Plan::Vertices(xyz) => {
                for _ in 0..element.count {
                    let (position, bad) = vertex(&mut data, &element.properties, xyz)?;
                    // Nothing uses the vertices of a cloud.
                    let bad = bad.filter(|_| !is_cloud);
                    members
                        .vertex(Point3::from(position), bad.map(|(location, _)| location))
                        .map_err(|reason| data.error(reason))?;
                }
                members.end_vertices(name)?;
                report(&mut members.builder, element, &xyz.map(|(at, _)| at));
            }
            Plan::Members(plan) => {
                members.start_element(plan);
                for number in 0..usize::try_from(element.count).unwrap_or(usize::MAX) {
                    members.read(&mut data, &element.properties, plan, number)?;
                }
                members.end_element();
                report(&mut members.builder, element, &plan.used());
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

/// Reads the vertices of a PLY file as rows; all coordinates have to be finite. What follows them is not read.
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
        return Ok(rows); // of what there is none, no property is missing
    }
    let coordinates = plan::coordinates(vertices, R::PROPERTIES).map_err(fail)?;
    let mut data = Data::new(reader, &header, name);
    for element in &header.elements[..at] {
        skip(&mut data, element)?;
    }
    for _ in 0..vertices.count {
        let (numbers, bad) = vertex(&mut data, &vertices.properties, &coordinates)?;
        if let Some((location, coordinate)) = bad {
            return Err(ReadError::new(name, location, Reason::NonFinite { text: coordinate.to_string() }));
        }
        rows.push(R::new(numbers).map_err(|reason| data.error(reason))?);
    }
    Ok(rows)
}

/// Passes over an element.
fn skip(data: &mut Data<'_, impl BufRead>, element: &header::Element) -> Result<(), ReadError> {
    // An element without properties takes no room, however many of it there are.
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

/// A coordinate that is not finite, and where it stands.
type Bad = Option<(FileLocation, f64)>;

/// Reads a vertex.
fn vertex<const N: usize>(
    data: &mut Data<'_, impl BufRead>,
    properties: &[header::Property],
    coordinates: &Coordinates<N>,
) -> Result<([f64; N], Bad), ReadError> {
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

/// Notes the properties other than those `used`.
fn report(builder: &mut SceneBuilder, element: &header::Element, used: &[usize]) {
    for (_, property) in element.properties.iter().enumerate().filter(|(k, _)| !used.contains(k)) {
        let what = [b"property ", property.name.as_slice(), b" of ", element.name.as_slice()].concat();
        builder.skipped.add(&what, element.count);
    }
}
