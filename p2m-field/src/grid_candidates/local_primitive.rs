//! A primitive in a frame of its own, in which its distance from many points is quick to evaluate.

use p2m_core::Primitive;
use p2m_core::engine::local_frame::LocalFrame;
use p2m_core::engine::vector::{V3, combine, dot, larger, norm_squared, smaller, sub};

/// A point, a segment or a triangle in its [`LocalFrame`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalPrimitive {
    /// The vertex that is the origin of the frame.
    pub(crate) origin: V3,
    pub(crate) axes: [V3; 3],
    /// The length of the first edge, which runs from the origin along the first axis.
    pub(crate) length: f64,
    /// The second and third edge of a triangle; unused for other kinds.
    pub(crate) edges: [Edge; 2],
    pub(crate) kind: Kind,
}

/// The kind of a [`LocalPrimitive`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Point,
    Segment,
    Triangle,
}

/// An edge of a triangle, in the plane of the triangle, with the inside to its left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    start: [f64; 2],
    /// The direction of the edge, as a vector of unit length.
    pub(crate) direction: [f64; 2],
    pub(crate) length: f64,
    /// The component of `start` along the direction.
    pub(crate) along: f64,
    /// The component of `start` perpendicular to the direction, positive to its left.
    pub(crate) across: f64,
}

/// The square of 2^-450. Edges shorter than that count as points, because their squares lose digits to underflow.
const MIN_SQUARED_LENGTH: f64 = p2m_core::engine::vector::power_of_two(-900);

impl Edge {
    fn new(start: [f64; 2], end: [f64; 2]) -> Self {
        let offset = [end[0] - start[0], end[1] - start[1]];
        let square = offset[0] * offset[0] + offset[1] * offset[1];
        let length = if square < MIN_SQUARED_LENGTH { 0.0 } else { square.sqrt() };
        let direction = if length > 0.0 { offset.map(|x| x / length) } else { [1.0, 0.0] };
        let [x, y] = direction;
        let (along, across) = (x * start[0] + y * start[1], x * start[1] - y * start[0]);
        Self { start, direction, length, along, across }
    }
}

impl LocalPrimitive {
    /// Returns `None` for a primitive that is not the convex hull of one to three vertices.
    pub(crate) fn from_primitive(primitive: &impl Primitive<f64>) -> Option<Self> {
        let vertex = |v: &nalgebra::Point3<f64>| -> V3 { v.coords.into() };
        let vertices = primitive.vertices();
        let frame = match vertices {
            [a] => LocalFrame::new(&[vertex(a)]),
            [a, b] => LocalFrame::new(&[a, b].map(vertex)),
            [a, b, c] => LocalFrame::new(&[a, b, c].map(vertex)),
            _ => return None,
        };
        let LocalFrame { origin, axes, length, apex } = frame;
        let kind = match vertices.len() {
            _ if length == 0.0 => Kind::Point,
            3 => Kind::Triangle,
            _ => Kind::Segment,
        };
        let corners = if kind == Kind::Triangle { [[length, 0.0], apex] } else { [[0.0; 2]; 2] };
        let edges = [Edge::new(corners[0], corners[1]), Edge::new(corners[1], [0.0; 2])];
        Some(Self { origin, axes, length, edges, kind })
    }

    /// Returns the closest point of the primitive, up to rounding, as an offset from the origin of the frame. As a
    /// position it would have a larger rounding error if the scene is far from zero.
    pub(crate) fn closest_offset(&self, point: V3) -> V3 {
        let offset = sub(point, self.origin);
        let local = [dot(offset, self.axes[0]), dot(offset, self.axes[1])];
        let [x, y] = match self.kind {
            Kind::Point => return [0.0; 3],
            Kind::Segment => [smaller(larger(local[0], 0.0), self.length), 0.0],
            Kind::Triangle => self.closest_in_plane(local),
        };
        combine(x, self.axes[0], y, self.axes[1])
    }

    /// Returns the approximate square of the distance from a point.
    pub(crate) fn squared_distance(&self, point: V3) -> f64 {
        norm_squared(sub(sub(point, self.origin), self.closest_offset(point)))
    }

    /// Returns the closest point of a triangle to a point in its plane.
    fn closest_in_plane(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        // Points on the line of the first edge do not count as inside, because a triangle without a height is part of
        // it.
        let mut is_inside = y > 0.0;
        let nearest = smaller(larger(x, 0.0), self.length);
        let mut best = [nearest, 0.0];
        let mut least = (x - nearest) * (x - nearest) + y * y;
        for edge in &self.edges {
            let [dx, dy] = edge.direction;
            let along = smaller(larger(x * dx + y * dy - edge.along, 0.0), edge.length);
            is_inside &= y * dx - x * dy >= edge.across;
            let closest = [edge.start[0] + along * dx, edge.start[1] + along * dy];
            let square = (x - closest[0]) * (x - closest[0]) + (y - closest[1]) * (y - closest[1]);
            if square < least {
                (best, least) = (closest, square);
            }
        }
        if is_inside { [x, y] } else { best }
    }
}
