//! The primitives of a PLY file.
//!
//! A member of an element is added to the scene as soon as it is read, if its vertices are known and primitives have no
//! ids. Otherwise it is kept until the vertices or all ids are known.

use super::data::{Data, Numbers};
use super::header::{Element, Property};
use super::plan::{Form, List, MemberPlan, Vertices};
use super::rows::ReadRow;
use crate::builder::SceneBuilder;
use crate::parse::blocks::Source;
use crate::parse::bytes::Scalar;
use crate::polygon::MAX_CORNERS;
use crate::{FileLocation, ReadError, Reason, Scene};
use nalgebra::Point3;
use std::collections::TryReserveError;
use std::io::BufRead;

/// The index that stands for -1 in a strip. No vertex has it.
const STRIP_RESTART: u32 = u32::MAX;

/// The members of an element, or of a block of it.
#[derive(Default)]
struct MemberList {
    /// The vertices of all members, one member after the other.
    vertices: Vec<u32>,
    /// The number of vertices of each member. It is empty as long as all members have `length` vertices.
    lengths: Vec<u32>,
    length: usize,
    /// The id of each member, if members have ids.
    ids: Vec<u32>,
}

impl MemberList {
    fn len(&self) -> usize {
        if self.lengths.is_empty() {
            self.vertices.len().checked_div(self.length).unwrap_or(0)
        } else {
            self.lengths.len()
        }
    }

    /// Returns the vertices of each member.
    fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let mut rest = self.vertices.as_slice();
        (0..self.len()).map(move |number| {
            let length = self.lengths.get(number).map_or(self.length, |&length| length as usize);
            let vertices;
            (vertices, rest) = rest.split_at(length);
            vertices
        })
    }

    #[allow(clippy::cast_possible_truncation, reason = "readers refuse lists beyond the range of u32")]
    fn push(&mut self, vertices: &[u32], id: Option<u32>) -> Result<(), TryReserveError> {
        self.ids.try_reserve(1)?;
        self.lengths.try_reserve(1)?;
        self.vertices.try_reserve(vertices.len())?;
        self.ids.extend(id);
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
        Ok(())
    }
}

/// The members of an element that are added when the vertices or all ids are known.
struct PendingMembers {
    form: Form,
    members: MemberList,
}

/// The limits of numbers in members.
#[derive(Clone, Copy)]
struct Limits {
    vertex_count: u64,
    /// The number of primitives if they have ids, otherwise `None`.
    ids: Option<u64>,
}

impl Limits {
    /// Reads a member into a vector, and returns its id.
    fn read_member<N: Numbers>(
        self,
        data: &mut N,
        properties: &[Property],
        plan: &MemberPlan,
        member: &mut Vec<u32>,
    ) -> Result<Option<u32>, N::Error> {
        member.clear();
        if let Vertices::Single(all) = &plan.vertices {
            member.resize(all.len(), 0);
        }
        let mut id = None;
        for (k, property) in properties.iter().enumerate() {
            if let Some((at, scalar)) = plan.id
                && at == k
            {
                id = self.id(data, scalar)?;
                continue;
            }
            match &plan.vertices {
                Vertices::List(at, list) if *at == k => self.list(data, *list, plan.form, member)?,
                Vertices::Single(all) => match all.iter().position(|(at, _)| *at == k) {
                    Some(i) => member[i] = self.index(data, all[i].1)?,
                    None => data.skip(property.layout)?,
                },
                Vertices::List(..) => data.skip(property.layout)?,
            }
        }
        data.end_element()?; // this check comes before those of the member
        Ok(id)
    }

    fn list<N: Numbers>(self, data: &mut N, list: List, form: Form, member: &mut Vec<u32>) -> Result<(), N::Error> {
        let count = data.count(list.count)?;
        let is_face = form == Form::Polygon;
        // Some programs write points and segments as faces of one and two vertices. With ids each face is a triangle.
        let needed = if self.ids.is_some() { 3 } else { 1 };
        if is_face && count < needed {
            return Err(data.error(|| Reason::TooFewVertices { found: count, needed }));
        }
        let limit = match self.ids {
            Some(_) => 3, // an id belongs to one triangle
            None if is_face => MAX_CORNERS as u64,
            None => u64::from(u32::MAX),
        };
        if count > limit {
            return Err(data.error(|| Reason::ElementTooLarge { count, limit }));
        }
        for _ in 0..count {
            let index = data.integer(list.item)?;
            let vertex = if index == -1 && !is_face { STRIP_RESTART } else { self.check(data, index)? };
            member.push(vertex);
        }
        Ok(())
    }

    fn index<N: Numbers>(self, data: &mut N, scalar: Scalar) -> Result<u32, N::Error> {
        let index = data.integer(scalar)?;
        self.check(data, index)
    }

    fn check<N: Numbers>(self, data: &N, index: i64) -> Result<u32, N::Error> {
        let count = self.vertex_count;
        u32::try_from(index)
            .ok()
            .filter(|&i| u64::from(i) < count)
            .ok_or_else(|| data.error(|| Reason::NoSuchVertex { index, count }))
    }

    /// Reads the id of a member. Returns `None` if ids are ignored.
    fn id<N: Numbers>(self, data: &mut N, scalar: Scalar) -> Result<Option<u32>, N::Error> {
        let id = data.integer(scalar)?;
        let Some(count) = self.ids else { return Ok(None) };
        match u32::try_from(id).ok().filter(|&i| u64::from(i) < count) {
            None => Err(data.error(|| Reason::BadPrimitiveId { id, count })),
            id => Ok(id),
        }
    }
}

/// Reads members in blocks.
struct MemberRows<'a> {
    limits: Limits,
    properties: &'a [Property],
    plan: &'a MemberPlan,
}

impl ReadRow<(Vec<u32>, MemberList)> for MemberRows<'_> {
    fn read<N: Numbers>(&self, numbers: &mut N, (member, list): &mut (Vec<u32>, MemberList)) -> Result<(), N::Error> {
        let id = self.limits.read_member(numbers, self.properties, self.plan, member)?;
        list.push(member, id).map_err(|error| numbers.error(|| Reason::Memory(error)))
    }
}

/// Builds the primitives of a PLY file.
pub(super) struct Members<'a> {
    pub(super) builder: SceneBuilder<'a>,
    limits: Limits,
    /// The number of faces. The sources of strips are numbered after them.
    faces: u64,
    batches: Vec<PendingMembers>,
    /// The vertices of the current member.
    member: Vec<u32>,
    /// The vertices that are not finite, in ascending order, with their locations.
    not_finite: Vec<(u32, FileLocation)>,
}

impl<'a> Members<'a> {
    pub(super) fn new(builder: SceneBuilder<'a>, vertex_count: u64, faces: u64, ids: Option<u64>) -> Self {
        let limits = Limits { vertex_count, ids };
        Self { builder, limits, faces, batches: Vec::new(), member: Vec::new(), not_finite: Vec::new() }
    }

    /// Adds a vertex, with its location if it is not finite.
    pub(super) fn vertex(&mut self, position: Point3<f64>, bad: Option<FileLocation>) -> Result<(), Reason> {
        let vertex = self.builder.push_vertex(position)?;
        self.not_finite.extend(bad.map(|location| (vertex, location)));
        Ok(())
    }

    /// Adds the pending members. This is called when all vertices are known.
    pub(super) fn end_vertices(&mut self, name: &str) -> Result<(), ReadError> {
        if self.limits.ids.is_some() {
            return Ok(());
        }
        for PendingMembers { form, members } in std::mem::take(&mut self.batches) {
            self.check_finite(&members.vertices, name)?;
            for (number, vertices) in members.iter().enumerate() {
                self.add(form, vertices, number).map_err(|reason| ReadError::new(name, FileLocation::File, reason))?;
            }
        }
        Ok(())
    }

    /// Starts an element that makes primitives.
    pub(super) fn start_element(&mut self, plan: &MemberPlan) {
        if !self.is_immediate() {
            self.batches.push(PendingMembers { form: plan.form, members: MemberList::default() });
        }
    }

    /// Ends an element that makes primitives.
    pub(super) fn end_element(&mut self) {
        if let Some(PendingMembers { members: batch, .. }) = self.batches.last_mut() {
            batch.vertices.shrink_to_fit();
            batch.lengths.shrink_to_fit();
            batch.ids.shrink_to_fit();
        }
    }

    /// Returns whether members are added as soon as they are read: all vertices are known, and members have no ids.
    fn is_immediate(&self) -> bool {
        self.limits.ids.is_none() && self.builder.vertex_count() as u64 == self.limits.vertex_count
    }

    /// Reads a member of an element.
    pub(super) fn read<R: BufRead>(
        &mut self,
        data: &mut Data<'_, R>,
        properties: &[Property],
        plan: &MemberPlan,
        number: usize,
    ) -> Result<(), ReadError> {
        let mut member = std::mem::take(&mut self.member);
        let id = self.limits.read_member(data, properties, plan, &mut member)?;
        let added = self.add_or_keep(plan.form, &member, id, number, data.file, |reason| data.error(|| reason));
        self.member = member;
        added
    }

    /// Reads members of an element in blocks, and returns their number.
    pub(super) fn read_blocks(
        &mut self,
        data: &mut Data<'_, Source<impl BufRead>>,
        element: &Element,
        plan: &MemberPlan,
    ) -> Result<usize, ReadError> {
        let member_rows = MemberRows { limits: self.limits, properties: &element.properties, plan };
        let file = data.file;
        let mut number = 0;
        data.read_rows(&element.properties, element.count, &member_rows, |rows| {
            let (_, list) = &rows.parsed;
            for (row, vertices) in list.iter().take(rows.count).enumerate() {
                let fail = |reason| rows.error(file, row, reason, &member_rows);
                self.add_or_keep(plan.form, vertices, list.ids.get(row).copied(), number, file, fail)?;
                number += 1;
            }
            Ok(())
        })?;
        Ok(number)
    }

    /// Adds a member to the scene, or to the pending ones. `fail` locates a reason at the member.
    fn add_or_keep(
        &mut self,
        form: Form,
        vertices: &[u32],
        id: Option<u32>,
        number: usize,
        file: &str,
        fail: impl FnOnce(Reason) -> ReadError,
    ) -> Result<(), ReadError> {
        if self.is_immediate() {
            self.check_finite(vertices, file)?;
            self.add(form, vertices, number).map_err(fail)?;
        } else if let Some(batch) = self.batches.last_mut() {
            batch.members.push(vertices, id).map_err(|error| fail(Reason::Memory(error)))?;
        }
        Ok(())
    }

    /// Adds the primitives of a member to the scene.
    fn add(&mut self, form: Form, vertices: &[u32], number: usize) -> Result<(), Reason> {
        match form {
            Form::Polygon => match *vertices {
                [a] => self.builder.push(p2m_core::Element::Point(a), number),
                [a, b] => self.builder.push(p2m_core::Element::Segment([a, b]), number),
                _ => self.builder.push_polygon(vertices, number),
            },
            Form::Segment => self.builder.push(p2m_core::Element::Segment([vertices[0], vertices[1]]), number),
            Form::Point => self.builder.push(p2m_core::Element::Point(vertices[0]), number),
            Form::Strip => {
                let source = usize::try_from(self.faces).unwrap_or(usize::MAX).saturating_add(number);
                for strip in vertices.split(|&v| v == STRIP_RESTART) {
                    for (k, t) in strip.windows(3).enumerate() {
                        let triangle = if k % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
                        self.builder.push(p2m_core::Element::Triangle(triangle), source)?;
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
        let count: usize = batches.iter().map(|batch| batch.members.ids.len()).sum();
        // `order` has the number of the member of each id, counted over all elements.
        let mut order = vec![u32::MAX; count];
        for (member, &id) in batches.iter().flat_map(|batch| &batch.members.ids).enumerate() {
            if std::mem::replace(&mut order[id as usize], member as u32) != u32::MAX {
                return Err(fail(Reason::BadPrimitiveId { id: i64::from(id), count: count as u64 }));
            }
        }
        for batch in batches {
            self.check_finite(&batch.members.vertices, name)?;
        }
        for member in order {
            let mut number = member as usize;
            for PendingMembers { form, members: batch } in batches {
                if number < batch.ids.len() {
                    let vertices = &batch.vertices[number * batch.length..][..batch.length];
                    self.add(*form, vertices, number).map_err(fail)?;
                    break;
                }
                number -= batch.ids.len();
            }
        }
        Ok(())
    }
}
