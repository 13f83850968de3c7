//! Primitives in the form that a build uses: in f64, and independent of the type of their set.

use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;
use p2m_core::{Aabb, Primitive, PrimitiveId, Real};
use std::cmp::Ordering;

/// The kind of the primitives in a packet, by the number of vertices that span them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Kind {
    /// One vertex spans each primitive.
    Point,
    /// Two vertices span each primitive.
    Segment,
    /// Three vertices span each primitive.
    Triangle,
    /// The primitives have no vertices, or more than three. The packet stores their boxes.
    Box,
}

impl Kind {
    /// Returns the kind of a primitive.
    pub fn of<T: Real>(primitive: &impl Primitive<T>) -> Self {
        match primitive.vertices().len() {
            1 => Self::Point,
            2 => Self::Segment,
            3 => Self::Triangle,
            _ => Self::Box,
        }
    }

    /// Returns the number of vertices that span a primitive.
    #[inline]
    pub(super) fn vertex_count(self) -> usize {
        match self {
            Self::Box => 0,
            Self::Point => 1,
            Self::Segment => 2,
            Self::Triangle => 3,
        }
    }
}

/// A primitive in f64, so that the code that builds packets and nodes does not depend on the set.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    /// The kind of the primitive.
    pub kind: Kind,
    /// The box around the primitive.
    pub bounds: Aabb<f64>,
    vertices: [V3; 3],
}

impl Member {
    /// Converts a primitive to f64.
    pub fn from_primitive<T: Real>(primitive: &impl Primitive<T>) -> Self {
        let kind = Kind::of(primitive);
        let mut vertices = [[0.0; 3]; 3];
        if kind != Kind::Box {
            vertices.iter_mut().zip(primitive.vertices()).for_each(|(to, vertex)| *to = to_f64_array(vertex));
        }
        Self { kind, bounds: primitive.aabb().to_f64(), vertices }
    }

    /// Compares the kinds of two primitives, and then the bits of their vertices.
    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        let bits = |member: &Self| member.vertices.map(|vertex| vertex.map(f64::to_bits));
        self.kind.cmp(&other.kind).then_with(|| bits(self).cmp(&bits(other)))
    }

    /// Returns whether two primitives have the same vertices, bit for bit and in the same order. It is `false` for
    /// primitives of which only the box is known.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.kind != Kind::Box && self.compare(other).is_eq()
    }

    /// Returns the vertices that span the primitive, which are none for [`Kind::Box`].
    pub fn vertices(&self) -> &[V3] {
        &self.vertices[..self.kind.vertex_count()]
    }
}

/// A function that returns the member with an id.
pub type Members<'a> = &'a (dyn Fn(PrimitiveId) -> Member + Sync);
