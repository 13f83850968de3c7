//! Sums of solid angles of triangles, between bounds.
//!
//! The solid angle of a triangle has a closed form \[VanOosterom1983\]. Divided by 4 pi it is the integral of K(x) . n
//! over the triangle, where K(x) = (x - q) / (4 pi |x - q|^3). For the triangles of a node with the centre p, K is
//! replaced by its Taylor polynomial of degree 1 at p: a dipole and its first moments \[Barill2018\].
//!
//! **Error (proved, [docs/proofs/fields.md]).** K is the gradient of -1 / (4 pi |x - q|), whose third derivatives in
//! any directions are at most 3! / (4 pi rho^4) at a distance of rho. So the remainder is at most 3 I / (4 pi rho^4),
//! with rho the distance of q from the box of the node and I the integral of |x - p|^2 over the triangles. Where this
//! is not below a half for each triangle, the node has the value 0 and that error, since no solid angle exceeds 2 pi.
//!
//! Nodes are divided by the surface-area heuristic in 16 bins, for caps have very different sizes.
//!
//! A sum starts at the root. While its error is too large, a node whose error is at least half of the largest is
//! replaced by its children, and a leaf by the solid angles of its triangles. Values and errors are rounded to
//! multiples of a unit that is so large that sums are exact.
//!
//! [docs/proofs/fields.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/fields.md

use super::triangle::ROUNDING;
use super::types::ray;
use nalgebra::Point3;
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::simd::Isa;
use p2m_core::engine::vector::{V3, add, dot, length, scaled, sub};
use p2m_core::kernel::power_of_two;
use p2m_core::predicates::orientation_3d;
use p2m_core::{Crossing, PrimitiveSet, Side, Soup};
use std::cmp::Ordering;
use std::f64::consts::PI;
use std::ops::Range;

/// A tree of triangles whose solid angles are summed up.
#[derive(Clone)]
pub(super) struct SolidAngles {
    /// The vertices of the triangles, with coordinates multiplied by `scale`. Triangles of a node are consecutive.
    pub(super) triangles: Vec<[V3; 3]>,
    /// The power of two that makes the largest coordinate about 1.
    pub(super) scale: f64,
    /// The nodes, from the root. The two children of a node are side by side.
    pub(super) nodes: Vec<Node>,
    /// The unit of values and errors.
    pub(super) unit: f64,
    pub(super) isa: Isa,
}

/// A group of triangles that a dipole approximates from far away.
#[derive(Clone)]
pub(super) struct Node {
    pub(super) centre: V3,
    /// The corners of the box of the triangles.
    pub(super) bounds: [V3; 2],
    /// The area of the triangles over 2 pi: times 1 / d^3 it bounds the gradient of the sum at the distance d.
    pub(super) area: f64,
    /// 3 / (4 pi) times the integral of the squared distance from the centre over the triangles.
    pub(super) spread: f64,
    /// The sum of the normals times areas, divided by 4 pi.
    pub(super) normal: V3,
    /// The sum of the outer products of these normals with the offsets of the centroids from the centre. Each row
    /// belongs to one component of the normal.
    pub(super) moments: [V3; 3],
    /// The range of the triangles.
    pub(super) triangles: Range<u32>,
    /// The index of the first child, or 0 for a leaf.
    pub(super) children: u32,
}

/// A number of windings, and a bound on its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// The largest number of triangles in a leaf.
const MAX_LEAF_TRIANGLES: usize = 4;
/// The largest cancellation of the terms of a tangent with which an angle is known. Beyond it, the query is on an edge
/// up to rounding.
pub(super) const MAX_CANCELLATION: f64 = (1u64 << 40) as f64;
/// The depth below which nodes are halved by number, so that no path is long.
const MAX_DIVIDED_DEPTH: usize = 48;
/// The largest coordinate, in units of the largest one of the triangles, of a query that is not far away. Beyond it up
/// to 2^30 triangles have a total solid angle over 4 pi below 2^30 * 32 / (4 pi 2^80) < 1e-9.
pub(super) const MAX_RELATIVE_COORDINATE: f64 = (1u64 << 40) as f64;
/// The factor by which nodes allow for the rounding of their moments and of distances.
pub(super) const INFLATION: f64 = 1.0 + 1e-9;

impl SolidAngles {
    /// Builds the tree of a soup of triangles.
    ///
    /// # Complexity
    /// O(n log n) time; about 130 bytes per triangle.
    pub(super) fn new(soup: &Soup<f64>) -> Self {
        let largest = soup.positions().iter().map(|p| p.coords.amax()).fold(0.0, f64::max);
        let scale = scale_of(largest);
        let corner = |i: u32| scaled(soup.positions()[i as usize].into(), scale);
        let mut triangles: Vec<[V3; 3]> = soup.triangles().iter().map(|corners| corners.map(corner)).collect();
        // The sum of all values and errors is at most n, and f64 has 53 bits.
        let bits = usize::BITS - triangles.len().leading_zeros();
        let unit = power_of_two(i32::try_from(bits).unwrap_or(0) - 51);
        let mut nodes = Vec::new();
        if !triangles.is_empty() {
            nodes.push(Node::new(&triangles, 0));
            build(&mut triangles, 0, 0, &mut nodes, 0);
        }
        Self { triangles, scale, nodes, unit, isa: Isa::best() }
    }

    /// Returns the sum of the solid angles over 4 pi, refined until `is_enough` says that the estimate is. It is `None`
    /// if the query is on an edge of a triangle, apart from rounding, and the estimate was not enough without it.
    pub(super) fn estimate(&self, query: &Point3<f64>, is_enough: impl Fn(Estimate) -> bool) -> Option<Estimate> {
        let Some(root) = self.nodes.first() else { return Some(Estimate::ZERO) };
        let q = self.point(query);
        // Far away the solid angle vanishes: the area is at most 32 for each triangle.
        if q.iter().any(|x| x.abs() > MAX_RELATIVE_COORDINATE) {
            return Some(Estimate { value: 0.0, error: 1e-9 });
        }
        let mut sum = self.node(root, q);
        let mut queue = Queue::new(self.unit);
        queue.push(sum.error, (sum, 0));
        while !is_enough(sum) {
            let Some((estimate, number)) = queue.pop() else { break };
            sum = sum.minus(estimate);
            let node = &self.nodes[number as usize];
            if node.children == 0 {
                sum = sum.plus(self.leaf(node.triangles.clone(), q)?);
            } else {
                for child in [node.children, node.children + 1] {
                    let estimate = self.node(&self.nodes[child as usize], q);
                    sum = sum.plus(estimate);
                    queue.push(estimate.error, (estimate, child));
                }
            }
        }
        Some(sum)
    }

    /// Returns the solid angles of the triangles of a leaf over 4 pi.
    fn leaf(&self, range: Range<u32>, q: V3) -> Option<Estimate> {
        // The solid angle is twice the argument of a complex number. Arguments below pi / 4 are added as the argument
        // of the product of their numbers.
        let (mut product, mut error, mut sum) = ([1.0, 0.0], 0.0, 0.0);
        for triangle in &self.triangles[range.start as usize..range.end as usize] {
            let angle = HalfAngle::new(triangle, q)?;
            error += angle.error;
            let [x, y] = angle.tangent;
            if y.abs() < x {
                product = [product[0] * x - product[1] * y, product[0] * y + product[1] * x];
            } else {
                sum += angle.value(triangle, q)?;
            }
        }
        sum += f64::atan2(product[1], product[0]);
        Some(self.rounded(Estimate { value: sum / (2.0 * PI), error }))
    }

    /// Evaluates the Taylor polynomial of a node.
    fn node(&self, node: &Node, q: V3) -> Estimate {
        let rho_square = node.square_from_box(q);
        let most = 0.5 * f64::from(node.triangles.end - node.triangles.start);
        let error = node.spread / (rho_square * rho_square);
        let (value, _) = node.dipole(q);
        // The comparison is false for NaN.
        if error < most && value.abs() <= most {
            self.rounded(Estimate { value, error: error + ROUNDING })
        } else {
            self.rounded(Estimate { value: 0.0, error: most })
        }
    }

    /// Rounds the value to a multiple of the unit, and the error upwards.
    pub(super) fn rounded(&self, estimate: Estimate) -> Estimate {
        // Adding a number of 2^52 units and subtracting it again rounds to a unit.
        let shift = self.unit * (3u64 << 51) as f64;
        let round = |x: f64| (x + shift) - shift;
        Estimate { value: round(estimate.value), error: round(estimate.error) + 2.0 * self.unit }
    }

    /// Returns the triangles with some numbers.
    pub(super) fn triangles<'a>(&'a self, numbers: &'a [u32]) -> impl Iterator<Item = &'a [V3; 3]> {
        numbers.iter().map(|i| &self.triangles[*i as usize])
    }

    /// Returns a point in the coordinates of the tree.
    pub(super) fn point(&self, point: &Point3<f64>) -> V3 {
        scaled((*point).into(), self.scale)
    }
}

impl Estimate {
    fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, error: self.error + other.error }
    }

    fn minus(self, other: Self) -> Self {
        Self { value: self.value - other.value, error: self.error - other.error }
    }
}

/// The corners of a box without points.
const EMPTY_BOX: [V3; 2] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
/// The end of a list.
const END: u32 = u32::MAX;

/// The terms of a sum, in lists by the magnitudes of their errors.
pub(super) struct Queue<T> {
    /// Each entry with the next one of its list.
    entries: Vec<(T, u32)>,
    /// The first entry of the list of each magnitude.
    heads: [u32; 64],
    /// A bit for each list that is not empty.
    used: u64,
    /// The exponent of the least magnitude.
    least: u64,
}

impl<T: Copy> Queue<T> {
    pub(super) fn new(unit: f64) -> Self {
        Self { entries: Vec::with_capacity(128), heads: [END; 64], used: 0, least: unit.to_bits() >> 52 }
    }

    #[allow(clippy::cast_possible_truncation, reason = "a sum has fewer than 2^32 nodes")]
    pub(super) fn push(&mut self, error: f64, term: T) {
        let list = ((error.to_bits() >> 52) - self.least).min(63);
        let entry = self.entries.len() as u32;
        self.entries.push((term, self.heads[list as usize]));
        self.heads[list as usize] = entry;
        self.used |= 1 << list;
    }

    /// Removes a term whose error is at least half of the largest one.
    pub(super) fn pop(&mut self) -> Option<T> {
        let list = 63u32.checked_sub(self.used.leading_zeros())?;
        let head = &mut self.heads[list as usize];
        let (term, next) = self.entries[*head as usize];
        *head = next;
        if next == END {
            self.used &= !(1 << list);
        }
        Some(term)
    }
}

/// Appends the nodes below a node. Its triangles come after `first` others.
#[allow(clippy::cast_possible_truncation, reason = "numbers of triangles are u32")]
fn build(triangles: &mut [[V3; 3]], first: u32, node: usize, nodes: &mut Vec<Node>, depth: usize) {
    if triangles.len() <= MAX_LEAF_TRIANGLES {
        return;
    }
    let [min, max] = box_of(triangles.iter().map(centroid));
    let half = if depth < MAX_DIVIDED_DEPTH { divide(triangles, min, max) } else { triangles.len() / 2 };
    let (one, other) = triangles.split_at_mut(half);
    let (children, second) = (nodes.len(), first + half as u32);
    nodes[node].children = children as u32;
    nodes.push(Node::new(one, first));
    nodes.push(Node::new(other, second));
    build(one, first, children, nodes, depth + 1);
    build(other, second, children + 1, nodes, depth + 1);
}

/// Divides triangles into two groups with small boxes, by the surface-area heuristic. The triangles are reordered, and
/// the number of triangles in the first group is returned. `min` and `max` are the corners of the box of the centroids.
fn divide(triangles: &mut [[V3; 3]], min: V3, max: V3) -> usize {
    const BINS: usize = 16;
    let area = |b: [V3; 2]| {
        let [x, y, z] = sub(b[1], b[0]);
        if x >= 0.0 { x * y + y * z + z * x } else { 0.0 }
    };
    let extent = sub(max, min);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bins are below 16")]
    let bin = |t: &[V3; 3], axis: usize| {
        (((centroid(t)[axis] - min[axis]) / extent[axis] * BINS as f64) as usize).min(BINS - 1)
    };
    let mut best = (f64::INFINITY, 0, 0);
    for axis in (0..3).filter(|k| extent[*k] > 0.0) {
        let (mut boxes, mut counts) = ([EMPTY_BOX; BINS], [0usize; BINS]);
        for t in triangles.iter() {
            let b = bin(t, axis);
            boxes[b] = t.iter().fold(boxes[b], |all, corner| united(all, [*corner, *corner]));
            counts[b] += 1;
        }
        let mut after = [(EMPTY_BOX, 0); BINS + 1];
        for b in (0..BINS).rev() {
            after[b] = (united(after[b + 1].0, boxes[b]), after[b + 1].1 + counts[b]);
        }
        let (mut before, mut count) = (EMPTY_BOX, 0);
        for b in 1..BINS {
            before = united(before, boxes[b - 1]);
            count += counts[b - 1];
            let cost = area(before) * count as f64 + area(after[b].0) * after[b].1 as f64;
            if count > 0 && after[b].1 > 0 && cost < best.0 {
                best = (cost, axis, b);
            }
        }
    }
    let (cost, axis, first) = best;
    if cost == f64::INFINITY {
        return triangles.len() / 2;
    }
    let mut half = 0;
    for i in 0..triangles.len() {
        if bin(&triangles[i], axis) < first {
            triangles.swap(i, half);
            half += 1;
        }
    }
    half
}

/// Returns the corners of the box of some points.
pub(super) fn box_of(points: impl IntoIterator<Item = V3>) -> [V3; 2] {
    points.into_iter().fold(EMPTY_BOX, |all, point| united(all, [point, point]))
}

/// Returns the corners of the box around two boxes.
fn united(a: [V3; 2], b: [V3; 2]) -> [V3; 2] {
    [[0, 1, 2].map(|k| a[0][k].min(b[0][k])), [0, 1, 2].map(|k| a[1][k].max(b[1][k]))]
}

pub(super) fn centroid([a, b, c]: &[V3; 3]) -> V3 {
    scaled(add(add(*a, *b), *c), 1.0 / 3.0)
}

/// Returns the normal of a triangle, with its area as the length.
pub(super) fn normal([a, b, c]: &[V3; 3]) -> V3 {
    scaled(cross(sub(*b, *a), sub(*c, *a)), 0.5)
}

impl Node {
    /// Returns the squared distance of a point from the box of the triangles.
    #[inline]
    pub(super) fn square_from_box(&self, q: V3) -> f64 {
        let [low, high] = &self.bounds;
        let beyond = [0, 1, 2].map(|k: usize| (low[k] - q[k]).max(q[k] - high[k]).max(0.0));
        dot(beyond, beyond)
    }

    /// Returns the value of the dipole and its moments at a point, and the gradient of the dipole alone.
    #[inline]
    pub(super) fn dipole(&self, q: V3) -> (f64, V3) {
        let offset = sub(self.centre, q);
        let square = dot(offset, offset);
        let inverse = 1.0 / square;
        let cube = inverse / square.sqrt();
        let height = dot(offset, self.normal);
        let trace = self.moments[0][0] + self.moments[1][1] + self.moments[2][2];
        let along = dot(offset, self.moments.map(|row| dot(row, offset)));
        let gradient = scaled(sub(scaled(offset, 3.0 * height * inverse), self.normal), cube);
        (cube * (height + trace - 3.0 * along * inverse), gradient)
    }

    #[allow(clippy::cast_possible_truncation, reason = "numbers of triangles are u32")]
    pub(super) fn new(triangles: &[[V3; 3]], first: u32) -> Self {
        let weighted = triangles.iter().fold((0.0, [0.0; 3]), |(weight, sum), t| {
            let area = length(normal(t));
            (weight + area, add(sum, scaled(centroid(t), area)))
        });
        let centre = match weighted {
            (weight, sum) if weight > 0.0 => scaled(sum, 1.0 / weight),
            // Triangles without area contribute nothing, so any centre will do.
            _ => centroid(&triangles[0]),
        };
        let (mut normals, mut moments, mut spread, mut area) = ([0.0; 3], [[0.0; 3]; 3], 0.0, 0.0);
        for t in triangles {
            let normal = normal(t);
            let offsets = t.map(|corner| sub(corner, centre));
            let offset = centroid(&offsets);
            // The integral of a quadratic form over a triangle is a twelfth of its area times the sum of the form at
            // the vertices and at their sum.
            let sum = scaled(offset, 3.0);
            let squares = offsets.iter().map(|o| dot(*o, *o)).sum::<f64>() + dot(sum, sum);
            area += length(normal);
            spread += length(normal) * squares / 12.0;
            let dipole = scaled(normal, 0.25 / PI);
            normals = add(normals, dipole);
            moments = [0, 1, 2].map(|k| add(moments[k], scaled(offset, dipole[k])));
        }
        let (bounds, spread) = (box_of(triangles.as_flattened().iter().copied()), spread * (0.75 / PI) * INFLATION);
        let area = area * (0.5 / PI) * INFLATION;
        let triangles = first..first + triangles.len() as u32;
        Self { centre, bounds, area, spread, normal: normals, moments, triangles, children: 0 }
    }
}

/// Half of the solid angle of a triangle.
pub(super) struct HalfAngle {
    /// The cosine and the sine of the half-angle, multiplied by a common factor. The sine is positive from the back of
    /// the triangle, apart from rounding.
    tangent: [f64; 2],
    /// The product of the distances from the vertices, multiplied by the same factor.
    size: f64,
    /// The bound on the error of the solid angle over 4 pi, apart from the sign of half-angles near pi.
    pub(super) error: f64,
}

impl HalfAngle {
    /// Computes the half-angle, or returns `None` if the query is on an edge of the triangle, up to rounding.
    #[inline]
    pub(super) fn new(triangle: &[V3; 3], q: V3) -> Option<Self> {
        Self::with_cancellation(triangle, q, MAX_CANCELLATION)
    }

    /// Computes the half-angle, or returns `None` if the terms of the tangent cancel more than `most`.
    #[inline]
    fn with_cancellation(triangle: &[V3; 3], q: V3, most: f64) -> Option<Self> {
        let [a, b, c] = triangle.map(|corner| sub(corner, q));
        let [la, lb, lc] = [a, b, c].map(|x| dot(x, x).sqrt());
        let volume = dot(a, cross(b, c));
        let size = la * lb * lc;
        let other = size + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        // The terms of both have errors of a few units of roundoff of their size.
        let cancellation = size / (volume * volume + other * other).sqrt();
        (cancellation < most).then(|| {
            // Arguments stay within the range of f64 when four of them are multiplied.
            let unit = cancellation / size;
            Self { tangent: [other * unit, volume * unit], size: cancellation, error: ROUNDING * (1.0 + cancellation) }
        })
    }

    /// Returns the half-angle, which is positive from behind the triangle, or `None` as `is_positive` does.
    pub(super) fn value(&self, triangle: &[V3; 3], q: V3) -> Option<f64> {
        let [x, y] = self.tangent;
        let size = y.abs().atan2(x);
        let is_positive = if y.abs() < x { y > 0.0 } else { self.is_positive(triangle, q)? };
        Some(if is_positive { size } else { -size })
    }

    /// Returns whether the query is behind the triangle. A query in the plane of the triangle counts as just before the
    /// triangle on its ray. `None` is returned if the ray runs in the plane.
    fn is_positive(&self, triangle: &[V3; 3], q: V3) -> Option<bool> {
        if self.tangent[1].abs() > ROUNDING * self.size {
            return Some(self.tangent[1] > 0.0);
        }
        match orientation_3d(triangle[0], triangle[1], triangle[2], q) {
            Ordering::Less => Some(true),
            Ordering::Greater => Some(false),
            Ordering::Equal => {
                let ray = ray(&q.into());
                Some(Crossing::from_vertices(&ray, triangle, f64::INFINITY, true)?.side() == Side::Back)
            }
        }
    }
}

/// Returns the sum of the solid angles of all triangles of a soup over 4 pi. The query has to be on no triangle.
pub(super) fn sum_of_all(soup: &Soup<f64>, query: &Point3<f64>) -> Estimate {
    let bounds = soup.aabb();
    let scale = scale_of([bounds.min, bounds.max, *query].iter().map(|p| p.coords.amax()).fold(0.0, f64::max));
    let q = scaled((*query).into(), scale);
    let mut sum = Estimate::ZERO;
    for triangle in soup.triangles() {
        let triangle = triangle.map(|i| scaled(soup.positions()[i as usize].into(), scale));
        // At an edge the angle is unknown, and so it is where products of lengths underflow.
        let angle = HalfAngle::with_cancellation(&triangle, q, f64::MAX);
        let known = angle
            .and_then(|angle| Some(Estimate { value: angle.value(&triangle, q)? / (2.0 * PI), error: angle.error }));
        sum = sum.plus(known.unwrap_or(Estimate { value: 0.0, error: 0.5 }));
    }
    Estimate { error: sum.error + f64::EPSILON * soup.triangles().len() as f64 * sum.value.abs().max(1.0), ..sum }
}

/// Returns the power of two that makes a number about 1.
#[allow(clippy::cast_possible_truncation, reason = "exponents of f64")]
fn scale_of(largest: f64) -> f64 {
    power_of_two(if largest > 0.0 { -(largest.log2() as i32).clamp(-1000, 1000) } else { 0 })
}
