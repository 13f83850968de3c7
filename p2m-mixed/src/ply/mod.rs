//! PLY, the Stanford polygon format: text and both binary encodings.

mod data;
mod header;

use crate::polygon::MAX_CORNERS;
use crate::scene::Builder;
use crate::text::quote;
use crate::{HeaderProblem, Place, ReadError, Reason, Scene};
use data::Data;
use header::{Layout, Scalar, read_header};
use nalgebra::Point3;
use p2m_core::Element;
use std::io::BufRead;

/// Reads a PLY file; `name` is for messages.
///
/// Understood are the elements `vertex` (`x`, `y`, `z` of any type), `face` and `tristrips` (a list `vertex_indices` or
/// `vertex_index`; in strips -1 starts a new one, and every other triangle is turned so that all have the winding of the
/// first), and `edge` (`vertex1`, `vertex2`). Elements and properties may come in any order. Other elements and
/// properties, and whatever follows the last element, are counted in [`Scene::skipped`]. Without any face, strip or edge
/// the file is a point cloud: each vertex is a point. But not if there are other elements with a list of vertices (named
/// `vertex_ind..`), such as polygons or tetrahedra under a name of their own: they are skipped, and the scene is empty.
///
/// Coordinates that are not finite are no error as long as no primitive uses the vertex. A point cloud leaves such
/// vertices out and counts them in [`Scene::skipped`].
///
/// In a text file, numbers are taken as they are written, in double precision, even if the header says `float`. An element
/// may go on over several lines, but nothing may follow it on its last one. Lines end at `\n`, `\r\n` or `\r`; those of a
/// header before binary data as its first one does.
///
/// # Errors
/// [`ReadError`] with the line (header, text) or the offset of the number in bytes (binary) for a header that makes no
/// sense, an early end, numbers that are none or too many for their line, indices of no vertex, vertices of primitives
/// that are not finite (with the place of the vertex), faces of fewer than three vertices or more than [`MAX_CORNERS`], and for what goes wrong in reading. No memory is taken for data that is merely announced.
pub fn read_ply(mut reader: impl BufRead, name: &str) -> Result<Scene, ReadError> {
    let header = read_header(&mut reader, name)?;
    let bad_header = |problem| ReadError::new(name, Place::File, Reason::BadHeader(problem));

    // What each element is for, before any data: a header that cannot serve is refused at once.
    let mut plans = Vec::new();
    let mut vertex_count = 0;
    let mut is_cloud = true;
    for element in &header.elements {
        let plan = match plan(element) {
            // Of what there is none, no property is missing.
            Err(_) if element.count == 0 => Plan::Skip,
            plan => plan.map_err(bad_header)?,
        };
        match plan {
            Plan::Vertices(_) => vertex_count = element.count,
            Plan::Faces(..) | Plan::Strips(..) | Plan::Edges(..) => is_cloud &= element.count == 0,
            Plan::Skip => is_cloud &= element.count == 0 || !has_vertex_list(element),
        }
        plans.push(plan);
    }
    if vertex_count > u64::from(u32::MAX) {
        let reason = Reason::ElementTooLarge { count: vertex_count, limit: u64::from(u32::MAX) };
        return Err(ReadError::new(name, Place::File, reason));
    }

    let mut reader = Elements {
        data: Data::new(reader, &header, name),
        builder: Builder::default(),
        vertex_count,
        batches: Vec::new(),
        not_finite: Vec::new(),
    };
    for (element, plan) in header.elements.iter().zip(&plans) {
        reader.element(element, plan)?;
    }
    reader.check_finite(name)?;
    let Elements { data, mut builder, batches, .. } = reader;
    let (rest, what) = data.rest()?;
    builder.skips.add_many(rest, what);
    if is_cloud {
        builder.point_cloud();
    }
    add_batches(&mut builder, &batches);
    builder.finish().map_err(|reason| ReadError::new(name, Place::File, reason))
}

/// What an element is for, with the places of its useful properties and the type of their numbers.
enum Plan {
    Vertices([(usize, Scalar); 3]),
    Faces(usize, List),
    Strips(usize, List),
    Edges([(usize, Scalar); 2]),
    Skip,
}

/// Types of a list of vertices.
#[derive(Clone, Copy)]
struct List {
    count: Scalar,
    item: Scalar,
}

/// Whether the members of an element are made of vertices, by the usual names of such a list.
fn has_vertex_list(element: &header::Element) -> bool {
    element.properties.iter().any(|p| matches!(p.layout, Layout::List { .. }) && p.name.starts_with(b"vertex_ind"))
}

fn plan(element: &header::Element) -> Result<Plan, HeaderProblem> {
    Ok(match element.name.as_slice() {
        b"vertex" => Plan::Vertices([
            scalar(element, "vertex", "x", false)?,
            scalar(element, "vertex", "y", false)?,
            scalar(element, "vertex", "z", false)?,
        ]),
        b"edge" => Plan::Edges([scalar(element, "edge", "vertex1", true)?, scalar(element, "edge", "vertex2", true)?]),
        b"face" => {
            let (at, list) = list(element, "face")?;
            Plan::Faces(at, list)
        }
        b"tristrips" => {
            let (at, list) = list(element, "tristrips")?;
            Plan::Strips(at, list)
        }
        _ => Plan::Skip,
    })
}

fn scalar(
    element: &header::Element,
    name: &'static str,
    property: &'static str,
    integer: bool,
) -> Result<(usize, Scalar), HeaderProblem> {
    let at = element.find(&[property]).ok_or(HeaderProblem::MissingProperty { element: name, property })?;
    match element.properties[at].layout {
        Layout::Scalar(scalar) if scalar.is_integer() || !integer => Ok((at, scalar)),
        _ => {
            Err(HeaderProblem::BadType { name: property.to_owned(), declared: element.properties[at].declared.clone() })
        }
    }
}

fn list(element: &header::Element, name: &'static str) -> Result<(usize, List), HeaderProblem> {
    let property = "vertex_indices";
    let at =
        element.find(&[property, "vertex_index"]).ok_or(HeaderProblem::MissingProperty { element: name, property })?;
    match element.properties[at].layout {
        Layout::List { count, item } if item.is_integer() => Ok((at, List { count, item })),
        _ => {
            let header::Property { name, declared, .. } = &element.properties[at];
            Err(HeaderProblem::BadType { name: quote(name), declared: declared.clone() })
        }
    }
}

/// Primitives of one element. Faces may precede the vertices, so polygons can only be cut at the end.
struct Batch {
    kind: Kind,
    /// Vertices of all members in a row, and how many each one has.
    vertices: Vec<u32>,
    lengths: Vec<u32>,
}

enum Kind {
    Face,
    Strip,
    Edge,
}

/// Stands for -1 in a strip; vertices are fewer than that.
const RESTART: u32 = u32::MAX;

struct Elements<'n, R> {
    data: Data<'n, R>,
    builder: Builder,
    vertex_count: u64,
    batches: Vec<Batch>,
    /// Vertices that are not finite, in ascending order, and where they stand.
    not_finite: Vec<(u32, Place)>,
}

impl<R: BufRead> Elements<'_, R> {
    fn element(&mut self, element: &header::Element, plan: &Plan) -> Result<(), ReadError> {
        match plan {
            Plan::Skip => {
                // An element without properties takes no room, however many of it there are.
                if !element.properties.is_empty() {
                    for _ in 0..element.count {
                        self.skip(&element.properties)?;
                        self.data.end_element()?;
                    }
                }
                self.builder.skips.add(&[b"element ", element.name.as_slice()].concat(), element.count);
                Ok(())
            }
            Plan::Vertices(xyz) => {
                for _ in 0..element.count {
                    self.vertex(&element.properties, xyz)?;
                }
                self.report(element, &xyz.map(|(at, _)| at));
                Ok(())
            }
            Plan::Edges(ends) => {
                let mut batch = Batch { kind: Kind::Edge, vertices: Vec::new(), lengths: Vec::new() };
                for _ in 0..element.count {
                    let mut edge = [0; 2];
                    for (k, property) in element.properties.iter().enumerate() {
                        match ends.iter().position(|&(at, _)| at == k) {
                            Some(end) => edge[end] = self.index(ends[end].1)?,
                            None => self.data.skip(property.layout)?,
                        }
                    }
                    self.data.end_element()?;
                    batch.vertices.extend(edge);
                    batch.lengths.push(2);
                }
                self.batches.push(batch);
                self.report(element, &ends.map(|(at, _)| at));
                Ok(())
            }
            &Plan::Faces(at, list) => self.lists(element, at, list, Kind::Face),
            &Plan::Strips(at, list) => self.lists(element, at, list, Kind::Strip),
        }
    }

    fn skip(&mut self, properties: &[header::Property]) -> Result<(), ReadError> {
        properties.iter().try_for_each(|p| self.data.skip(p.layout))
    }

    /// Checks that what the primitives use is finite. Faces may precede the vertices, so this comes last.
    fn check_finite(&self, name: &str) -> Result<(), ReadError> {
        if self.not_finite.is_empty() {
            return Ok(());
        }
        for &vertex in self.batches.iter().flat_map(|batch| &batch.vertices) {
            if let Ok(at) = self.not_finite.binary_search_by_key(&vertex, |&(v, _)| v) {
                let reason = Reason::NonFiniteVertex { index: u64::from(vertex) };
                return Err(ReadError::new(name, self.not_finite[at].1, reason));
            }
        }
        Ok(())
    }

    /// Notes the properties other than those `used`.
    fn report(&mut self, element: &header::Element, used: &[usize]) {
        for (_, property) in element.properties.iter().enumerate().filter(|(k, _)| !used.contains(k)) {
            let what = [b"property ", property.name.as_slice(), b" of ", element.name.as_slice()].concat();
            self.builder.skips.add(&what, element.count);
        }
    }

    fn vertex(&mut self, properties: &[header::Property], xyz: &[(usize, Scalar); 3]) -> Result<(), ReadError> {
        let mut position = Point3::origin();
        let mut bad = None;
        for (k, property) in properties.iter().enumerate() {
            match xyz.iter().position(|&(at, _)| at == k) {
                Some(axis) => {
                    position[axis] = self.data.coordinate(xyz[axis].1)?;
                    if !position[axis].is_finite() {
                        bad = Some(self.data.place());
                    }
                }
                None => self.data.skip(property.layout)?,
            }
        }
        self.data.end_element()?;
        if let Some(place) = bad {
            // read_ply refuses more vertices than u32 can count.
            let vertex = u32::try_from(self.builder.positions.len()).unwrap_or(u32::MAX);
            self.not_finite.push((vertex, place));
        }
        self.builder.positions.push(position);
        Ok(())
    }

    fn lists(&mut self, element: &header::Element, at: usize, list: List, kind: Kind) -> Result<(), ReadError> {
        let mut batch = Batch { kind, vertices: Vec::new(), lengths: Vec::new() };
        for _ in 0..element.count {
            self.skip(&element.properties[..at])?;
            self.list(list, &mut batch)?;
            self.skip(&element.properties[at + 1..])?;
            self.data.end_element()?;
        }
        self.batches.push(batch);
        self.report(element, &[at]);
        Ok(())
    }

    fn list(&mut self, list: List, batch: &mut Batch) -> Result<(), ReadError> {
        let count = self.data.count(list.count)?;
        let is_face = matches!(batch.kind, Kind::Face);
        if is_face && count < 3 {
            return Err(self.data.error(Reason::TooFewVertices { found: count, needed: 3 }));
        }
        let limit = if is_face { MAX_CORNERS as u64 } else { u64::from(u32::MAX) };
        let length = u32::try_from(count)
            .ok()
            .filter(|_| count <= limit)
            .ok_or_else(|| self.data.error(Reason::ElementTooLarge { count, limit }))?;
        for _ in 0..count {
            let index = if is_face { self.index(list.item)? } else { self.strip_index(list.item)? };
            batch.vertices.push(index);
        }
        batch.lengths.push(length);
        Ok(())
    }

    fn strip_index(&mut self, scalar: Scalar) -> Result<u32, ReadError> {
        match self.data.integer(scalar)? {
            -1 => Ok(RESTART),
            index => self.check(index),
        }
    }

    fn index(&mut self, scalar: Scalar) -> Result<u32, ReadError> {
        let index = self.data.integer(scalar)?;
        self.check(index)
    }

    fn check(&self, index: i64) -> Result<u32, ReadError> {
        let count = self.vertex_count;
        u32::try_from(index)
            .ok()
            .filter(|&i| u64::from(i) < count)
            .ok_or_else(|| self.data.error(Reason::NoSuchVertex { index, count }))
    }
}

/// Adds the primitives of all batches in the order of the file.
fn add_batches(builder: &mut Builder, batches: &[Batch]) {
    let faces = batches.iter().filter(|b| matches!(b.kind, Kind::Face)).map(|b| b.lengths.len()).sum::<usize>();
    for batch in batches {
        let mut rest = batch.vertices.as_slice();
        for (number, &length) in batch.lengths.iter().enumerate() {
            let (vertices, more) = rest.split_at(length as usize);
            rest = more;
            match batch.kind {
                Kind::Face => builder.polygon(vertices, number),
                Kind::Edge => builder.push(Element::Segment([vertices[0], vertices[1]]), number),
                Kind::Strip => {
                    for strip in vertices.split(|&v| v == RESTART) {
                        for (k, t) in strip.windows(3).enumerate() {
                            let triangle = if k % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
                            builder.push(Element::Triangle(triangle), faces + number);
                        }
                    }
                }
            }
        }
    }
}
