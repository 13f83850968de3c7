//! A primitive in a frame of its own, in which its distance from many points is quick to evaluate.

use p2m_core::Primitive;
use p2m_core::engine::vector::{V3, add_scaled, combine, dot, larger, norm_squared, smaller, sub};

/// A point, a segment or a triangle in a local frame.
///
/// The longest edge is on the first axis, and a triangle is in the plane of the first two axes. The axes are
/// orthonormal within some u for any shape: if the third vertex is too near to the longest edge to determine a
/// direction, it is as near to the plane of any direction.
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

/// Returns a unit vector that is perpendicular to a unit vector.
fn perpendicular(axis: V3) -> V3 {
    let least = (0..3).min_by(|i, j| axis[*i].abs().total_cmp(&axis[*j].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    normalized(add_scaled(other, -dot(other, axis), axis)).unwrap_or(other)
}

/// The square of 2^-450. Vectors shorter than that count as zero, because their squares lose digits to underflow.
const MIN_SQUARED_LENGTH: f64 = p2m_core::engine::vector::power_of_two(-900);

/// Returns a vector scaled to unit length, or `None` if it counts as zero.
fn normalized(v: V3) -> Option<V3> {
    let square = norm_squared(v);
    (square >= MIN_SQUARED_LENGTH).then(|| v.map(|x| x / square.sqrt()))
}

fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl LocalPrimitive {
    /// Returns `None` for a primitive that is not the convex hull of one to three vertices.
    pub(crate) fn from_primitive(primitive: &impl Primitive<f64>) -> Option<Self> {
        let vertex = |v: &nalgebra::Point3<f64>| -> V3 { v.coords.into() };
        match primitive.vertices() {
            [a] => Some(Self::point(vertex(a))),
            [a, b] => Some(Self::segment(vertex(a), vertex(b))),
            [a, b, c] => Some(Self::triangle([a, b, c].map(vertex))),
            _ => None,
        }
    }

    fn point(origin: V3) -> Self {
        let unused = Edge::new([0.0; 2], [0.0; 2]);
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Self { origin, axes, length: 0.0, edges: [unused; 2], kind: Kind::Point }
    }

    fn segment(a: V3, b: V3) -> Self {
        let Some(first) = normalized(sub(b, a)) else { return Self::point(a) };
        let second = perpendicular(first);
        let length = norm_squared(sub(b, a)).sqrt();
        Self { axes: [first, second, cross(first, second)], length, kind: Kind::Segment, ..Self::point(a) }
    }

    fn triangle(vertices: [V3; 3]) -> Self {
        let edge = |i: usize| sub(vertices[(i + 1) % 3], vertices[i]);
        let longest = (0..3).max_by(|i, j| norm_squared(edge(*i)).total_cmp(&norm_squared(edge(*j)))).unwrap_or(0);
        let origin = vertices[longest];
        let length = norm_squared(edge(longest)).sqrt();
        let Some(first) = normalized(edge(longest)) else { return Self::point(origin) };
        let third = sub(vertices[(longest + 2) % 3], origin);
        // The component of the third vertex perpendicular to the first axis is accurate to some u of the vertex, so its
        // direction leaves the vertex in the plane within some u. A second projection makes it perpendicular to some u
        // as well. If it is far from perpendicular at first, it consists of rounding errors, and any direction will do.
        let height = add_scaled(third, -dot(third, first), first);
        let second = normalized(height)
            .filter(|v| dot(*v, first).abs() < 0.5)
            .and_then(|v| normalized(add_scaled(v, -dot(v, first), first)))
            .unwrap_or_else(|| perpendicular(first));
        let axes = [first, second, cross(first, second)];
        let apex = [dot(third, first), larger(dot(third, second), 0.0)];
        let edges = [Edge::new([length, 0.0], apex), Edge::new(apex, [0.0; 2])];
        Self { origin, axes, length, edges, kind: Kind::Triangle }
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
