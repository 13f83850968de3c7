//! The primitives of a PLY file: added as they come where that is possible, otherwise kept until all is known.

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

/// Stands for -1 in a strip; vertices are fewer than that.
const RESTART: u32 = u32::MAX;

/// Members of one element that wait.
struct Batch {
    form: Form,
    /// Vertices of all members in a row.
    vertices: Vec<u32>,
    /// How many each one has; empty as long as all have `length`.
    lengths: Vec<u32>,
    length: usize,
    /// The id of each, if they have any.
    ids: Vec<u32>,
}

impl Batch {
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
            // The first one that differs: write down what was implicit so far.
            self.lengths = vec![self.length as u32; self.len()];
            self.lengths.push(vertices.len() as u32);
        } else if !self.lengths.is_empty() {
            self.lengths.push(vertices.len() as u32);
        }
        self.vertices.extend_from_slice(vertices);
    }
}

/// Primitives under construction.
pub(super) struct Members {
    pub(super) builder: SceneBuilder,
    vertex_count: u64,
    /// How many faces there are: sources of strips go on behind them.
    faces: u64,
    /// How many primitives have an id of their own, if they have.
    ids: Option<u64>,
    batches: Vec<Batch>,
    /// The vertices of the member at hand.
    member: Vec<u32>,
    /// Vertices that are not finite, in ascending order, and where they stand.
    not_finite: Vec<(u32, FileLocation)>,
}

impl Members {
    pub(super) fn new(vertex_count: u64, faces: u64, ids: Option<u64>) -> Self {
        Self {
            builder: SceneBuilder::default(),
            vertex_count,
            faces,
            ids,
            batches: Vec::new(),
            member: Vec::new(),
            not_finite: Vec::new(),
        }
    }

    /// Adds a vertex, and where it stands if it is not finite.
    pub(super) fn vertex(&mut self, position: Point3<f64>, bad: Option<FileLocation>) -> Result<(), Reason> {
        let vertex = self.builder.push_vertex(position)?;
        self.not_finite.extend(bad.map(|location| (vertex, location)));
        Ok(())
    }

    /// Called when all vertices are there: what waited for them is added.
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

    /// Called before the members of an element that makes primitives.
    pub(super) fn start_element(&mut self, plan: &MemberPlan) {
        if !self.is_immediate() {
            let form = plan.form();
            let (vertices, lengths, ids) = Default::default();
            self.batches.push(Batch { form, vertices, lengths, length: 0, ids });
        }
    }

    /// Called behind them.
    pub(super) fn end_element(&mut self) {
        if let Some(batch) = self.batches.last_mut() {
            batch.vertices.shrink_to_fit();
            batch.lengths.shrink_to_fit();
            batch.ids.shrink_to_fit();
        }
    }

    /// Whether primitives are added as they come: their vertices are there, and they come in the order of their ids.
    fn is_immediate(&self) -> bool {
        self.ids.is_none() && self.builder.positions().len() as u64 == self.vertex_count
    }

    /// Reads a member.
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
        data.end_element()?; // before what the member itself is checked for
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

    /// Adds the primitives of a member.
    fn add(&mut self, form: Form, vertices: &[u32], number: usize) -> Result<(), Reason> {
        match form {
            Form::Polygon => self.builder.push_polygon(vertices, number),
            Form::Segment => self.builder.push(Element::Segment([vertices[0], vertices[1]]), number),
            Form::Point => self.builder.push(Element::Point(vertices[0]), number),
            Form::Strip => {
                let source = usize::try_from(self.faces).unwrap_or(usize::MAX).saturating_add(number);
                for strip in vertices.split(|&v| v == RESTART) {
                    for (k, t) in strip.windows(3).enumerate() {
                        let triangle = if k % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
                        self.builder.push(Element::Triangle(triangle), source)?;
                    }
                }
                Ok(())
            }
        }
    }

    /// Checks that what primitives use is finite.
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
        if is_face && count < 3 {
            return Err(data.error(Reason::TooFewVertices { found: count, needed: 3 }));
        }
        let limit = match self.ids {
            Some(_) => 3, // one id, one triangle
            None if is_face => MAX_CORNERS as u64,
            None => u64::from(u32::MAX),
        };
        if count > limit {
            return Err(data.error(Reason::ElementTooLarge { count, limit }));
        }
        for _ in 0..count {
            let index = data.integer(list.item)?;
            let vertex = if index == -1 && !is_face { RESTART } else { self.check(data, index)? };
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

    /// The id of a member; nothing if ids are passed over because no member has one.
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

    /// Adds members in the order of their ids: one primitive each. Nothing waits otherwise.
    #[allow(clippy::cast_possible_truncation, reason = "there are fewer members than ids, which are u32")]
    fn add_by_id(&mut self, batches: &[Batch], name: &str) -> Result<(), ReadError> {
        let fail = |reason| ReadError::new(name, FileLocation::File, reason);
        let count: usize = batches.iter().map(|batch| batch.ids.len()).sum();
        // Of each id the number of its member, counted over all batches.
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
