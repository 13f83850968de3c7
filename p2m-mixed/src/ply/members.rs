//! The primitives of a PLY file.
//!
//! A member of an element is added to the scene as soon as it is read, if its vertices are known and primitives have no
//! ids. Otherwise it is kept until the vertices or all ids are known.

use super::data::Data;
use super::header::Property;
use super::plan::{Form, Kind, List, MemberPlan};
use crate::builder::SceneBuilder;
use crate::bytes::Scalar;
use crate::polygon::MAX_CORNERS;
use crate::{FileLocation, ReadError, Reason, Scene};
use nalgebra::Point3;
use p2m_core::Element;
use std::io::BufRead;

/// The index that stands for -1 in a strip. No vertex has it.
const STRIP_RESTART: u32 = u32::MAX;

/// The pending members of one element.
struct PendingMembers {
    form: Form,
    /// The vertices of all members, one member after the other.
    vertices: Vec<u32>,
    /// The number of vertices of each member. It is empty as long as all members have `length` vertices.
    lengths: Vec<u32>,
    length: usize,
    /// The id of each member, if members have ids.
    ids: Vec<u32>,
}

impl PendingMembers {
    fn len(&self) -> usize {
        if self.lengths.is_empty() {
            self.vertices.len().checked_div(self.length).unwrap_or(0)
        } else {
            self.lengths.len()
        }
    }

    #[allow(clippy::cast_possible_truncation, reason = "readers refuse lists beyond the range of u32")]
    fn push(&mut self, vertices: &[u32]) {
        if self.vertices.is_empty() && self.lengths.is_empty() {
            self.length = vertices.len();
        }
        if self.lengths.is_empty() && (vertices.len() != self.length || self.length == 0) {
            // This is the first member of another length, so the lengths of all members before are stored.
            self.lengths = vec![self.length as u32; self.len()];
            self.lengths.push(vertices.len() as u32);
        } else if !self.lengths.is_empty() {
            self.lengths.push(vertices.len() as u32);
        }
        self.vertices.extend_from_slice(vertices);
    }
}

/// Builds the primitives of a PLY file.
pub(super) struct Members<'a> {
    pub(super) builder: SceneBuilder<'a>,
    vertex_count: u64,
    /// The number of faces. The sources of strips are numbered after them.
    faces: u64,
    /// The number of primitives if they have ids, otherwise `None`.
    ids: Option<u64>,
    batches: Vec<PendingMembers>,
    /// The vertices of the current member.
    member: Vec<u32>,
    /// The vertices that are not finite, in ascending order, with their locations.
    not_finite: Vec<(u32, FileLocation)>,
}

impl<'a> Members<'a> {
    pub(super) fn new(builder: SceneBuilder<'a>, vertex_count: u64, faces: u64, ids: Option<u64>) -> Self {
        Self { builder, vertex_count, faces, ids, batches: Vec::new(), member: Vec::new(), not_finite: Vec::new() }
    }

    /// Adds a vertex, with its location if it is not finite.
    pub(super) fn vertex(&mut self, position: Point3<f64>, bad: Option<FileLocation>) -> Result<(), Reason> {
        let vertex = self.builder.push_vertex(position)?;
        self.not_finite.extend(bad.map(|location| (vertex, location)));
        Ok(())
    }

    /// Adds the pending members. This is called when all vertices are known.
    pub(super) fn end_vertices(&mut self, name: &str) -> Result<(), ReadError> {
        if self.ids.is_some() {
            return Ok(());
        }
        for batch in std::mem::take(&mut self.batches) {
            self.check_finite(&batch.vertices, name)?;
            let mut rest = batch.vertices.as_slice();
            for number in 0..batch.len() {
                let length = batch.lengths.get(number).map_or(batch.length, |&length| length as usize);
                let (vertices, more) = rest.split_at(length);
                rest = more;
                self.add(batch.form, vertices, number)
                    .map_err(|reason| ReadError::new(name, FileLocation::File, reason))?;
            }
        }
        Ok(())
    }

    /// Starts an element that makes primitives.
    pub(super) fn start_element(&mut self, plan: &MemberPlan) {
        if !self.is_immediate() {
            let form = plan.form();
            let (vertices, lengths, ids) = Default::default();
            self.batches.push(PendingMembers { form, vertices, lengths, length: 0, ids });
        }
    }

    /// Ends an element that makes primitives.
    pub(super) fn end_element(&mut self) {
        if let Some(batch) = self.batches.last_mut() {
            batch.vertices.shrink_to_fit();
            batch.lengths.shrink_to_fit();
            batch.ids.shrink_to_fit();
        }
    }

    /// Returns whether members are added as soon as they are read: all vertices are known, and members have no ids.
    fn is_immediate(&self) -> bool {
        self.ids.is_none() && self.builder.vertex_count() as u64 == self.vertex_count
    }

    /// Reads a member of an element.
    pub(super) fn read<R: BufRead>(
        &mut self,
        data: &mut Data<'_, R>,
        properties: &[Property],
        plan: &MemberPlan,
        number: usize,
    ) -> Result<(), ReadError> {
        self.member.clear();
        if let Kind::Edge(_) = plan.kind {
            self.member.resize(2, 0);
        }
        let mut id = None;
        for (k, property) in properties.iter().enumerate() {
            if let Some((at, scalar)) = plan.id
                && at == k
            {
                id = self.id(data, scalar)?;
                continue;
            }
            match plan.kind {
                Kind::Face(at, list) if at == k => self.list(data, list, Form::Polygon)?,
                Kind::Strip(at, list) if at == k => self.list(data, list, Form::Strip)?,
                Kind::Point((at, scalar)) if at == k => {
                    let vertex = self.index(data, scalar)?;
                    self.member.push(vertex);
                }
                Kind::Edge(ends) if ends.iter().any(|&(at, _)| at == k) => {
                    let end = usize::from(ends[1].0 == k);
                    self.member[end] = self.index(data, ends[end].1)?;
                }
                _ => data.skip(property.layout)?,
            }
        }
        data.end_element()?; // this check comes before those of the member
        if self.is_immediate() {
            let member = std::mem::take(&mut self.member);
            self.check_finite(&member, data.file())?;
            self.add(plan.form(), &member, number).map_err(|reason| data.error(reason))?;
            self.member = member;
        } else if let Some(batch) = self.batches.last_mut() {
            batch.push(&self.member);
            batch.ids.extend(id);
        }
        Ok(())
    }

    /// Adds the primitives of a member to the scene.
    fn add(&mut self, form: Form, vertices: &[u32], number: usize) -> Result<(), Reason> {
        match form {
            Form::Polygon => match *vertices {
                [a, b] => self.builder.push(Element::Segment([a, b]), number),
                _ => self.builder.push_polygon(vertices, number),
            },
            Form::Segment => self.builder.push(Element::Segment([vertices[0], vertices[1]]), number),
            Form::Point => self.builder.push(Element::Point(vertices[0]), number),
            Form::Strip => {
                let source = usize::try_from(self.faces).unwrap_or(usize::MAX).saturating_add(number);
                for strip in vertices.split(|&v| v == STRIP_RESTART) {
                    for (k, t) in strip.windows(3).enumerate() {
                        let triangle = if k % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
                        self.builder.push(Element::Triangle(triangle), source)?;
                    }
                }
                Ok(())
            }
        }
    }

    /// Checks that the vertices of primitives are finite.
    fn check_finite(&self, vertices: &[u32], name: &str) -> Result<(), ReadError> {
        if !self.not_finite.is_empty() {
            for &vertex in vertices {
                if let Ok(at) = self.not_finite.binary_search_by_key(&vertex, |&(v, _)| v) {
                    let reason = Reason::NonFiniteVertex { index: u64::from(vertex) };
                    return Err(ReadError::new(name, self.not_finite[at].1, reason));
                }
            }
        }
        Ok(())
    }

    fn list<R: BufRead>(&mut self, data: &mut Data<'_, R>, list: List, form: Form) -> Result<(), ReadError> {
        let count = data.count(list.count)?;
        let is_face = form == Form::Polygon;
        // Some programs write segments as faces of two vertices. With ids each face is a triangle.
        let needed = if self.ids.is_some() { 3 } else { 2 };
        if is_face && count < needed {
            return Err(data.error(Reason::TooFewVertices { found: count, needed }));
        }
        let limit = match self.ids {
            Some(_) => 3, // an id belongs to one triangle
            None if is_face => MAX_CORNERS as u64,
            None => u64::from(u32::MAX),
        };
        if count > limit {
            return Err(data.error(Reason::ElementTooLarge { count, limit }));
        }
        for _ in 0..count {
            let index = data.integer(list.item)?;
            let vertex = if index == -1 && !is_face { STRIP_RESTART } else { self.check(data, index)? };
            self.member.push(vertex);
        }
        Ok(())
    }

    fn index<R: BufRead>(&self, data: &mut Data<'_, R>, scalar: Scalar) -> Result<u32, ReadError> {
        let index = data.integer(scalar)?;
        self.check(data, index)
    }

    fn check<R: BufRead>(&self, data: &Data<'_, R>, index: i64) -> Result<u32, ReadError> {
        let count = self.vertex_count;
        u32::try_from(index)
            .ok()
            .filter(|&i| u64::from(i) < count)
            .ok_or_else(|| data.error(Reason::NoSuchVertex { index, count }))
    }

    /// Reads the id of a member. Returns `None` if ids are ignored.
    fn id<R: BufRead>(&self, data: &mut Data<'_, R>, scalar: Scalar) -> Result<Option<u32>, ReadError> {
        let id = data.integer(scalar)?;
        let Some(count) = self.ids else { return Ok(None) };
        match u32::try_from(id).ok().filter(|&i| u64::from(i) < count) {
            None => Err(data.error(Reason::BadPrimitiveId { id, count })),
            id => Ok(id),
        }
    }

    pub(super) fn finish(mut self, name: &str) -> Result<Scene, ReadError> {
        let batches = std::mem::take(&mut self.batches);
        self.add_by_id(&batches, name)?;
        Ok(self.builder.finish())
    }

    /// Adds pending members in the order of their ids; each makes one primitive. Without ids no member is
    /// pending any more.
    #[allow(clippy::cast_possible_truncation, reason = "there are fewer members than ids, which are u32")]
    fn add_by_id(&mut self, batches: &[PendingMembers], name: &str) -> Result<(), ReadError> {
        let fail = |reason| ReadError::new(name, FileLocation::File, reason);
        let count: usize = batches.iter().map(|batch| batch.ids.len()).sum();
        // `order` has the number of the member of each id, counted over all elements.
        let mut order = vec![u32::MAX; count];
        for (member, &id) in batches.iter().flat_map(|batch| &batch.ids).enumerate() {
            if std::mem::replace(&mut order[id as usize], member as u32) != u32::MAX {
                return Err(fail(Reason::BadPrimitiveId { id: i64::from(id), count: count as u64 }));
            }
        }
        for batch in batches {
            self.check_finite(&batch.vertices, name)?;
        }
        for member in order {
            let mut number = member as usize;
            for batch in batches {
                if number < batch.ids.len() {
                    let vertices = &batch.vertices[number * batch.length..][..batch.length];
                    self.add(batch.form, vertices, number).map_err(fail)?;
                    break;
                }
                number -= batch.ids.len();
            }
        }
        Ok(())
    }
}
