//! Generalised winding numbers, by a tree of dipoles.
//!
//! The winding number of triangles around q is the sum of their solid angles, over 4 pi \[Jacobson2013\]; that of one triangle is
//! known in closed form \[VanOosterom1983\]. It is the integral of K(x) . n over the triangles, with K(x) = (x - q) / (4 pi |x - q|^3).
//! For those of a node of the tree, which lie within r of its centre p, K is replaced by its Taylor polynomial of degree 1 in p
//! \[Barill2018\].
//!
//! **Error (proved).** K is the gradient of -1 / (4 pi |x - q|), whose third derivatives in any directions are at most
//! 3! / (4 pi rho^4) at a distance of rho. So the remainder is at most 3 r^2 / (4 pi rho^4) times the area, with rho = |p - q| - r.
//! A node stands for its triangles where that is at most `accuracy` times its part of the area of the scene; so all of them together
//! are wrong by at most `accuracy`, beside rounding. For each node that is a distance, computed at build.

use super::boundary::Boundary;
use super::{Sign, SignError, check_kinds};
use nalgebra::Point3;
use p2m_core::kernel::power_of_two;
use p2m_core::{PrimitiveSet, Soup};
use p2m_mixed::engine::vector::{V3, add, cross, dot, length, scaled, sub};
use std::f64::consts::PI;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Winding numbers of triangles.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_mixed::generate::{IcoSphere, ico_sphere};
/// use p2m_field::sign::WindingNumbers;
///
/// let ball = ico_sphere(&IcoSphere::default()).unwrap();
/// let winding = WindingNumbers::new(&ball, 0.01)?;
/// assert!((winding.number(&Point3::origin()) - 1.0).abs() <= 0.01);
/// assert!(winding.number(&Point3::new(3.0, 0.0, 0.0)).abs() <= 0.01);
/// # Ok::<(), p2m_field::sign::SignError>(())
/// ```
pub struct WindingNumbers<'a> {
    soup: &'a Soup<f64>,
    /// What coordinates are multiplied by: a power of two.
    unit: f64,
    accuracy: f64,
    boundary: Boundary,
    /// The scales of distances for [`ROUGH`] and [`SHARED`].
    rough: f64,
    shared: f64,
    /// The triangles, node by node.
    order: Vec<u32>,
    /// A node, then the nodes of its first half, then those of its second one.
    nodes: Vec<Node>,
    doubts: AtomicU64,
}

/// Triangles that are one dipole from far away.
struct Node {
    centre: V3,
    /// No vertex is farther from the centre.
    radius: f64,
    /// It is one from this distance beyond the radius on.
    beyond: f64,
    /// The sum of normals times areas, over 4 pi.
    normal: V3,
    /// The sum of these times the offset of the centroid from the centre: one row for each component of the normal.
    moments: [V3; 3],
    triangles: Range<u32>,
    /// The second half; 0 for a leaf.
    second: u32,
}

/// Triangles of a leaf.
const LEAF: usize = 8;
/// The accuracy that is enough for most signs.
const ROUGH: f64 = 0.45;
/// The accuracy that tells the sign of many places near each other.
const SHARED: f64 = 0.2;
/// Winding numbers this near to a half tell nothing: what rounding may do.
const ROUNDING: f64 = 1e-9;

impl<'a> WindingNumbers<'a> {
    /// # Errors
    /// [`SignError::OtherKinds`] for what is no triangle, and [`SignError::Accuracy`] for one that is not between 0 and 0.5.
    ///
    /// # Complexity
    /// O(n log n) time, 40 to 70 bytes a triangle.
    pub fn new(soup: &'a Soup<f64>, accuracy: f64) -> Result<Self, SignError> {
        check_kinds(soup)?;
        if !(accuracy > 0.0 && accuracy < 0.5) {
            return Err(SignError::Accuracy(accuracy));
        }
        let bounds = soup.aabb();
        let corners = [bounds.min, bounds.max];
        let largest = corners.iter().flat_map(|p| p.iter()).filter(|x| x.is_finite());
        let largest = largest.fold(0.0f64, |largest, x| largest.max(x.abs()));
        // Coordinates up to about 1, so that no area and no product of lengths leaves the range.
        #[allow(clippy::cast_possible_truncation, reason = "exponents of f64")]
        let exponent = if largest > 0.0 { (largest.log2() as i32).clamp(-1000, 1000) } else { 0 };
        let boundary = Boundary::new(soup)?;
        let count = u32::try_from(soup.triangles().len()).unwrap_or(u32::MAX);
        let (order, nodes, doubts) = ((0..count).collect(), Vec::new(), AtomicU64::new(0));
        let [rough, shared] = [ROUGH, SHARED].map(|a| (accuracy / a).sqrt().sqrt().min(1.0) * (1.0 + 1e-12));
        let mut numbers =
            Self { soup, unit: power_of_two(-exponent), accuracy, boundary, rough, shared, order, nodes, doubts };
        if count > 0 {
            let area: f64 = (0..count).map(|t| length(numbers.triangle(t).normal)).sum();
            let mut order = std::mem::take(&mut numbers.order);
            numbers.build(&mut order, 0, area);
            numbers.order = order;
        }
        Ok(numbers)
    }

    /// Appends the nodes of these triangles, of which `first` others come before.
    #[allow(clippy::cast_possible_truncation, reason = "numbers of triangles are u32")]
    fn build(&mut self, order: &mut [u32], first: usize, area: f64) {
        let number = self.nodes.len();
        let triangles = first as u32..(first + order.len()) as u32;
        let node = self.node(order, triangles, area);
        self.nodes.push(node);
        if order.len() <= LEAF {
            return;
        }
        let centroids = order.iter().map(|t| self.triangle(*t).centroid);
        let (min, max) = centroids.fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(min, max), c| {
            ([0, 1, 2].map(|k| f64::min(min[k], c[k])), [0, 1, 2].map(|k| f64::max(max[k], c[k])))
        });
        let extent = sub(max, min);
        let axis = (0..3).fold(0, |longest, k| if extent[k] > extent[longest] { k } else { longest });
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |a, b| {
            let at = |t: &u32| self.triangle(*t).centroid[axis];
            at(a).total_cmp(&at(b)).then(a.cmp(b))
        });
        let (one, other) = order.split_at_mut(half);
        self.build(one, first, area);
        self.nodes[number].second = self.nodes.len() as u32;
        self.build(other, first + half, area);
    }

    fn node(&self, order: &[u32], triangles: Range<u32>, area: f64) -> Node {
        let all = || order.iter().map(|t| self.triangle(*t));
        let weighted = all().fold((0.0, [0.0; 3]), |(weight, sum), t| {
            let area = length(t.normal);
            (weight + area, add(sum, scaled(t.centroid, area)))
        });
        let centre = match weighted {
            (weight, sum) if weight > 0.0 => scaled(sum, 1.0 / weight),
            // Without area, anywhere.
            _ => self.triangle(order[0]).centroid,
        };
        let corners = all().flat_map(|t| t.corners);
        let radius = corners.map(|corner| length(sub(corner, centre))).fold(0.0, f64::max) * (1.0 + 1e-12);
        let rho = (3.0 * radius * radius * area / (4.0 * PI * self.accuracy)).sqrt().sqrt();
        let (mut normal, mut moments) = ([0.0; 3], [[0.0; 3]; 3]);
        for t in all() {
            let part = scaled(t.normal, 0.25 / PI);
            let offset = sub(t.centroid, centre);
            normal = add(normal, part);
            moments = [0, 1, 2].map(|k| add(moments[k], scaled(offset, part[k])));
        }
        Node { centre, radius, beyond: rho * (1.0 + 1e-12), normal, moments, triangles, second: 0 }
    }

    fn triangle(&self, number: u32) -> Triangle {
        let corners: [V3; 3] = self.soup.triangles()[number as usize]
            .map(|i| self.soup.positions()[i as usize].into())
            .map(|corner| scaled(corner, self.unit));
        let [a, b, c] = corners;
        let centroid = scaled(add(add(a, b), c), 1.0 / 3.0);
        Triangle { corners, centroid, normal: scaled(cross(sub(b, a), sub(c, a)), 0.5) }
    }

    /// The winding number, within the accuracy: 1 inside of a surface that is closed and has its fronts outside, 0 outside, and
    /// something between them near holes.
    ///
    /// Rounding is beside that: less than 1e-9, unless the query is so near to an edge that its offset is rounding itself
    /// (observed). Triangles of less than 1e-100 of the scene count as nothing.
    #[must_use]
    pub fn number(&self, query: &Point3<f64>) -> f64 {
        self.number_within(query, 1.0)
    }

    /// The same within the accuracy divided by the fourth power of `scale`, since that is how the bound goes down with the distance.
    fn number_within(&self, query: &Point3<f64>, scale: f64) -> f64 {
        let query = scaled((*query).into(), self.unit);
        let mut sum = 0.0;
        // Halving triangles ends after 30 levels.
        let mut stack = [0u32; 64];
        let mut len = usize::from(!self.nodes.is_empty());
        while len > 0 {
            len -= 1;
            let number = stack[len];
            let node = &self.nodes[number as usize];
            let offset = sub(node.centre, query);
            let square = dot(offset, offset);
            let far = (node.radius + node.beyond * scale) * (1.0 + 1e-12);
            if !square.is_finite() {
                // So far away that nothing is left of the node.
            } else if square > far * far {
                sum += node.far_away(offset, square);
            } else if node.second == 0 {
                sum += self.near(query, node.triangles.clone());
            } else {
                stack[len] = node.second;
                stack[len + 1] = number + 1;
                len += 2;
            }
        }
        sum
    }

    /// The same by the sum of all triangles, beside rounding.
    ///
    /// # Complexity
    /// O(n).
    #[must_use]
    pub fn exact_number(&self, query: &Point3<f64>) -> f64 {
        let query = scaled((*query).into(), self.unit);
        self.nodes.first().map_or(0.0, |root| self.near(query, root.triangles.clone()))
    }

    fn near(&self, query: V3, triangles: Range<u32>) -> f64 {
        let triangles = &self.order[triangles.start as usize..triangles.end as usize];
        triangles.iter().map(|t| self.triangle(*t).solid_angle(query)).sum::<f64>() / (4.0 * PI)
    }

    pub(super) fn sign(&self, query: &Point3<f64>) -> Sign {
        // Mostly it is about 0 or 1, so a rough one tells which side of a half it is on.
        let mut beyond = self.number_within(query, self.rough).abs() - 0.5;
        if beyond.abs() <= ROUGH + ROUNDING {
            beyond = self.number(query).abs() - 0.5;
        }
        if beyond.abs() <= self.accuracy + ROUNDING {
            self.doubts.fetch_add(1, Ordering::Relaxed);
            beyond = self.exact_number(query).abs() - 0.5;
        }
        if beyond > ROUNDING {
            Sign::Inside
        } else if beyond < -ROUNDING {
            Sign::Outside
        } else {
            Sign::Undefined
        }
    }

    /// The sign of all places within `radius` of one, between which and it no triangle is; `None` where they may differ.
    pub(super) fn sign_within(&self, radius: f64, place: &Point3<f64>) -> Option<Sign> {
        if self.boundary.is_none() {
            return Some(self.sign(place));
        }
        let change = self.boundary.change_within(radius, place);
        let least = change + SHARED + self.accuracy + 2.0 * ROUNDING;
        if least >= 0.5 {
            return None;
        }
        let beyond = self.number_within(place, self.shared).abs() - 0.5;
        (beyond.abs() > least).then_some(if beyond > 0.0 { Sign::Inside } else { Sign::Outside })
    }

    /// Whether numbers are whole and change at triangles alone.
    pub(super) fn is_closed(&self) -> bool {
        self.boundary.is_none()
    }

    pub(super) fn doubts(&self) -> u64 {
        self.doubts.load(Ordering::Relaxed)
    }
}

impl Node {
    /// The Taylor polynomial, with the centre at `offset` from the query.
    fn far_away(&self, offset: V3, square: f64) -> f64 {
        let inverse = 1.0 / square;
        let cube = inverse * inverse.sqrt();
        let trace = self.moments[0][0] + self.moments[1][1] + self.moments[2][2];
        let along = dot(offset, self.moments.map(|row| dot(row, offset)));
        cube * (dot(offset, self.normal) + trace - 3.0 * along * inverse)
    }
}

struct Triangle {
    corners: [V3; 3],
    centroid: V3,
    /// As long as the area.
    normal: V3,
}

impl Triangle {
    /// Positive from the back. Zero in the plane of the triangle, and at its vertices.
    fn solid_angle(&self, query: V3) -> f64 {
        let [a, b, c] = self.corners.map(|corner| sub(corner, query));
        let [la, lb, lc] = [a, b, c].map(length);
        let volume = dot(a, cross(b, c));
        let other = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        if volume == 0.0 { 0.0 } else { 2.0 * volume.atan2(other) }
    }
}
