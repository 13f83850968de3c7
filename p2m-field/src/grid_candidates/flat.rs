//! A primitive in a frame of its own, for evaluation at many places.

use p2m_core::Primitive;
use p2m_core::engine::vector::{V3, add_scaled, combine, dot, larger, norm_squared, smaller, sub};

/// A point, a segment or a triangle by its longest edge, which is the first axis of a frame; a triangle is in the plane of the first two.
///
/// All three axes are orthonormal within some u, whatever the shape: a third vertex that is too near to the longest edge to tell a
/// direction is as near to the plane of any.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flat {
    /// A vertex; the others are told by their way from it.
    pub(crate) origin: V3,
    pub(crate) axes: [V3; 3],
    /// The length of the first edge, along the first axis.
    pub(crate) length: f64,
    /// The two others; those of a triangle alone.
    pub(crate) edges: [Edge; 2],
    pub(crate) kind: Kind,
}

/// What a [`Flat`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Point,
    Segment,
    Triangle,
}

/// An edge in the plane of a triangle that has the inside to its left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    start: [f64; 2],
    /// Of unit length.
    pub(crate) direction: [f64; 2],
    pub(crate) length: f64,
    /// What `start` is along the direction, and to its left.
    pub(crate) along: f64,
    pub(crate) across: f64,
}

impl Edge {
    fn new(start: [f64; 2], end: [f64; 2]) -> Self {
        let way = [end[0] - start[0], end[1] - start[1]];
        let square = way[0] * way[0] + way[1] * way[1];
        let length = if square < SHORTEST { 0.0 } else { square.sqrt() };
        let direction = if length > 0.0 { way.map(|x| x / length) } else { [1.0, 0.0] };
        let [x, y] = direction;
        let (along, across) = (x * start[0] + y * start[1], x * start[1] - y * start[0]);
        Self { start, direction, length, along, across }
    }
}

/// Something of unit length across a vector of unit length.
fn across(axis: V3) -> V3 {
    let least = (0..3).min_by(|i, j| axis[*i].abs().total_cmp(&axis[*j].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    unit(add_scaled(other, -dot(other, axis), axis)).unwrap_or(other)
}

/// Squares below this lose digits, so what is shorter counts as nothing: 2^-450 long.
const SHORTEST: f64 = p2m_core::engine::vector::power_of_two(-900);

/// `None` for nothing.
fn unit(v: V3) -> Option<V3> {
    let square = norm_squared(v);
    (square >= SHORTEST).then(|| v.map(|x| x / square.sqrt()))
}

fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl Flat {
    /// `None` for a primitive that is not its vertices.
    pub(crate) fn of(primitive: &impl Primitive<f64>) -> Option<Self> {
        let vertex = |v: &nalgebra::Point3<f64>| -> V3 { v.coords.into() };
        match primitive.vertices() {
            [a] => Some(Self::point(vertex(a))),
            [a, b] => Some(Self::segment(vertex(a), vertex(b))),
            [a, b, c] => Some(Self::triangle([a, b, c].map(vertex))),
            _ => None,
        }
    }

    fn point(origin: V3) -> Self {
        let none = Edge::new([0.0; 2], [0.0; 2]);
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Self { origin, axes, length: 0.0, edges: [none; 2], kind: Kind::Point }
    }

    fn segment(a: V3, b: V3) -> Self {
        let Some(first) = unit(sub(b, a)) else { return Self::point(a) };
        let second = across(first);
        let length = norm_squared(sub(b, a)).sqrt();
        Self { axes: [first, second, cross(first, second)], length, kind: Kind::Segment, ..Self::point(a) }
    }

    fn triangle(vertices: [V3; 3]) -> Self {
        let edge = |i: usize| sub(vertices[(i + 1) % 3], vertices[i]);
        let longest = (0..3).max_by(|i, j| norm_squared(edge(*i)).total_cmp(&norm_squared(edge(*j)))).unwrap_or(0);
        let origin = vertices[longest];
        let length = norm_squared(edge(longest)).sqrt();
        let Some(first) = unit(edge(longest)) else { return Self::point(origin) };
        let third = sub(vertices[(longest + 2) % 3], origin);
        // What is left of it across the first axis is right to some u of its length, and so its direction is good enough to leave
        // nothing out of the plane; taken across once more it is across to some u as well. If it is not across at first, it is
        // nothing but rounding, and any direction will do.
        let height = add_scaled(third, -dot(third, first), first);
        let second = unit(height)
            .filter(|v| dot(*v, first).abs() < 0.5)
            .and_then(|v| unit(add_scaled(v, -dot(v, first), first)))
            .unwrap_or_else(|| across(first));
        let axes = [first, second, cross(first, second)];
        let top = [dot(third, first), larger(dot(third, second), 0.0)];
        let edges = [Edge::new([length, 0.0], top), Edge::new(top, [0.0; 2])];
        Self { origin, axes, length, edges, kind: Kind::Triangle }
    }

    /// A point of it that is as near to a place as any, but for roundings, by its way from the origin: as a position it would be
    /// rounded by more where the scene is far from zero.
    pub(crate) fn foot(&self, place: V3) -> V3 {
        let way = sub(place, self.origin);
        let at = [dot(way, self.axes[0]), dot(way, self.axes[1])];
        let [x, y] = match self.kind {
            Kind::Point => return [0.0; 3],
            Kind::Segment => [smaller(larger(at[0], 0.0), self.length), 0.0],
            Kind::Triangle => self.foot_in_plane(at),
        };
        combine(x, self.axes[0], y, self.axes[1])
    }

    /// The square of its distance from a place, roughly.
    pub(crate) fn square(&self, place: V3) -> f64 {
        norm_squared(sub(sub(place, self.origin), self.foot(place)))
    }

    fn foot_in_plane(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        // Not on the line of the first edge, which a triangle without a height is in all of.
        let mut is_inside = y > 0.0;
        let nearest = smaller(larger(x, 0.0), self.length);
        let mut best = [nearest, 0.0];
        let mut least = (x - nearest) * (x - nearest) + y * y;
        for edge in &self.edges {
            let [dx, dy] = edge.direction;
            let along = smaller(larger(x * dx + y * dy - edge.along, 0.0), edge.length);
            is_inside &= y * dx - x * dy >= edge.across;
            let foot = [edge.start[0] + along * dx, edge.start[1] + along * dy];
            let square = (x - foot[0]) * (x - foot[0]) + (y - foot[1]) * (y - foot[1]);
            if square < least {
                (best, least) = (foot, square);
            }
        }
        if is_inside { [x, y] } else { best }
    }
}
