//! Generalised winding numbers by a tree of dipoles.
//!
//! The winding number of triangles around q is the sum of their solid angles divided by 4 pi \[Jacobson2013\]. The
//! solid angle of one triangle has a closed form \[VanOosterom1983\]. The winding number is the integral of K(x) . n
//! over the triangles, where K(x) = (x - q) / (4 pi |x - q|^3). For the triangles of a node of the tree, which lie
//! within r of its centre p, K is replaced by its Taylor polynomial of degree 1 at p \[Barill2018\].
//!
//! **Error (proved).** K is the gradient of -1 / (4 pi |x - q|), whose third derivatives in any directions are at most
//! 3! / (4 pi rho^4) at a distance of rho. So the remainder is at most 3 r^2 / (4 pi rho^4) times the area, with rho =
//! |p - q| - r. A node stands for its triangles if that is at most `accuracy` times its share of the area of the scene,
//! so the error of all nodes together is at most `accuracy`, apart from rounding. The condition is a minimum distance
//! of q from the node, which is computed at build.

use super::boundary::Boundary;
use super::types::{Counter, SharedSoup, Sign, SignError, check_kinds};
use nalgebra::Point3;
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::vector::{V3, add, dot, length, scaled, sub};
use p2m_core::kernel::power_of_two;
use std::f64::consts::PI;
use std::ops::Range;

/// The generalised winding numbers of a set of triangles.
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
#[derive(Clone)]
pub struct WindingNumbers<S> {
    soup: S,
    /// The power of two that coordinates are multiplied by, so that the largest is about 1.
    scale: f64,
    accuracy: f64,
    boundary: Boundary,
    /// The factor of minimum distances for which winding numbers are accurate to [`ROUGH_ACCURACY`].
    rough_distance_factor: f64,
    /// The factor of minimum distances for which winding numbers are accurate to [`SHARED_SIGN_ACCURACY`].
    shared_distance_factor: f64,
    /// The triangles, ordered so that those of each node are consecutive.
    order: Vec<u32>,
    /// The nodes in depth-first order. The first child of a node follows it.
    nodes: Vec<Node>,
    ambiguous_count: Counter,
}

/// A group of triangles that a dipole approximates from far away.
#[derive(Clone)]
struct Node {
    centre: V3,
    /// An upper bound on the distance of the vertices from the centre.
    radius: f64,
    /// The minimum distance from the ball of the node at which its dipole is accurate enough.
    min_distance: f64,
    /// The sum of the normals times areas, divided by 4 pi.
    normal: V3,
    /// The sum of the outer products of these normals with the offsets of the centroids from the centre. Each row
    /// belongs to one component of the normal.
    moments: [V3; 3],
    /// The range of the triangles in the order.
    triangles: Range<u32>,
    /// The index of the second child, or 0 for a leaf.
    second: u32,
}

/// The largest number of triangles in a leaf.
const MAX_LEAF_TRIANGLES: usize = 8;
/// The accuracy of the first attempt to determine a sign, which suffices for most queries.
const ROUGH_ACCURACY: f64 = 0.45;
/// The accuracy with which the common sign of a neighbourhood is determined.
const SHARED_SIGN_ACCURACY: f64 = 0.2;
/// An upper bound on the rounding error of a winding number (observed). Closer to a half the sign is not defined.
const ROUNDING_ERROR: f64 = 1e-9;

impl<S: SharedSoup> WindingNumbers<S> {
    /// Builds the tree of dipoles of a soup.
    ///
    /// # Errors
    /// [`SignError::OtherKinds`] if a primitive is not a triangle, [`SignError::Accuracy`] if the accuracy is not above
    /// 0 and below 0.5, and [`SignError::Build`] if a tree of the boundary cannot be built.
    ///
    /// # Complexity
    /// O(n log n) time; 40 to 70 bytes for each triangle.
    pub fn new(soup: S, accuracy: f64) -> Result<Self, SignError> {
        check_kinds(&soup)?;
        if !(accuracy > 0.0 && accuracy < 0.5) {
            return Err(SignError::Accuracy(accuracy));
        }
        let bounds = soup.aabb();
        let corners = [bounds.min, bounds.max];
        let largest = corners.iter().flat_map(|p| p.iter()).filter(|x| x.is_finite());
        let largest = largest.fold(0.0f64, |largest, x| largest.max(x.abs()));
        // Coordinates are scaled to about 1, so that areas and products of lengths stay within the range of f64.
        #[allow(clippy::cast_possible_truncation, reason = "exponents of f64")]
        let exponent = if largest > 0.0 { (largest.log2() as i32).clamp(-1000, 1000) } else { 0 };
        let boundary = Boundary::new(&soup)?;
        let count = u32::try_from(soup.triangles().len()).unwrap_or(u32::MAX);
        let (order, nodes, ambiguous_count) = ((0..count).collect(), Vec::new(), Counter::default());
        let [rough_distance_factor, shared_distance_factor] =
            [ROUGH_ACCURACY, SHARED_SIGN_ACCURACY].map(|a| (accuracy / a).sqrt().sqrt().min(1.0) * (1.0 + 1e-12));
        let mut numbers = Self {
            soup,
            scale: power_of_two(-exponent),
            accuracy,
            boundary,
            rough_distance_factor,
            shared_distance_factor,
            order,
            nodes,
            ambiguous_count,
        };
        if count > 0 {
            let area: f64 = (0..count).map(|t| length(numbers.triangle(t).normal)).sum();
            let mut order = std::mem::take(&mut numbers.order);
            numbers.build(&mut order, 0, area);
            numbers.order = order;
        }
        Ok(numbers)
    }

    /// Appends the nodes of the triangles `order`, which come after `first` others. `area` is that of the scene.
    #[allow(clippy::cast_possible_truncation, reason = "numbers of triangles are u32")]
    fn build(&mut self, order: &mut [u32], first: usize, area: f64) {
        let number = self.nodes.len();
        let triangles = first as u32..(first + order.len()) as u32;
        let node = self.node(order, triangles, area);
        self.nodes.push(node);
        if order.len() <= MAX_LEAF_TRIANGLES {
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
            // Triangles without area contribute nothing, so any centre will do.
            _ => self.triangle(order[0]).centroid,
        };
        let corners = all().flat_map(|t| t.corners);
        let radius = corners.map(|corner| length(sub(corner, centre))).fold(0.0, f64::max) * (1.0 + 1e-12);
        let rho = (3.0 * radius * radius * area / (4.0 * PI * self.accuracy)).sqrt().sqrt();
        let (mut normal, mut moments) = ([0.0; 3], [[0.0; 3]; 3]);
        for t in all() {
            let dipole = scaled(t.normal, 0.25 / PI);
            let offset = sub(t.centroid, centre);
            normal = add(normal, dipole);
            moments = [0, 1, 2].map(|k| add(moments[k], scaled(offset, dipole[k])));
        }
        Node { centre, radius, min_distance: rho * (1.0 + 1e-12), normal, moments, triangles, second: 0 }
    }

    fn triangle(&self, number: u32) -> Triangle {
        let corners: [V3; 3] = self.soup.triangles()[number as usize]
            .map(|i| self.soup.positions()[i as usize].into())
            .map(|corner| scaled(corner, self.scale));
        let [a, b, c] = corners;
        let centroid = scaled(add(add(a, b), c), 1.0 / 3.0);
        Triangle { corners, centroid, normal: scaled(cross(sub(b, a), sub(c, a)), 0.5) }
    }

    /// Returns the winding number of a point, within the accuracy.
    ///
    /// It is 1 inside of a closed surface whose fronts are outside, 0 outside, and in between near holes.
    ///
    /// # Accuracy
    /// The rounding error is below 1e-9 in addition to the accuracy (observed), unless the query is so near to an edge
    /// that its offset consists of rounding errors. Triangles smaller than 1e-100 of the scene count as nothing.
    #[must_use]
    pub fn number(&self, query: &Point3<f64>) -> f64 {
        self.number_with_distance_factor(query, 1.0)
    }

    /// Returns the winding number with all minimum distances multiplied by a factor. Its error is at most the accuracy
    /// divided by the fourth power of the factor.
    fn number_with_distance_factor(&self, query: &Point3<f64>, factor: f64) -> f64 {
        let query = scaled((*query).into(), self.scale);
        let mut sum = 0.0;
        // Each level halves the triangles, so there are at most 30 levels.
        let mut stack = [0u32; 64];
        let mut len = usize::from(!self.nodes.is_empty());
        while len > 0 {
            len -= 1;
            let number = stack[len];
            let node = &self.nodes[number as usize];
            let offset = sub(node.centre, query);
            let square = dot(offset, offset);
            let far = (node.radius + node.min_distance * factor) * (1.0 + 1e-12);
            if !square.is_finite() {
                // The node is so far away that its solid angle vanishes.
            } else if square > far * far {
                sum += node.dipole(offset, square);
            } else if node.second == 0 {
                sum += self.sum_of_triangles(query, node.triangles.clone());
            } else {
                stack[len] = node.second;
                stack[len + 1] = number + 1;
                len += 2;
            }
        }
        sum
    }

    /// Returns the winding number of a point as the sum over all triangles, which is exact up to rounding.
    ///
    /// # Complexity
    /// O(n).
    #[must_use]
    pub fn exact_number(&self, query: &Point3<f64>) -> f64 {
        let query = scaled((*query).into(), self.scale);
        self.nodes.first().map_or(0.0, |root| self.sum_of_triangles(query, root.triangles.clone()))
    }

    fn sum_of_triangles(&self, query: V3, triangles: Range<u32>) -> f64 {
        let triangles = &self.order[triangles.start as usize..triangles.end as usize];
        triangles.iter().map(|t| self.triangle(*t).solid_angle(query)).sum::<f64>() / (4.0 * PI)
    }

    pub(super) fn sign(&self, query: &Point3<f64>) -> Sign {
        // Most numbers are about 0 or 1, so a rough number decides on which side of a half they are.
        let mut above_half = self.number_with_distance_factor(query, self.rough_distance_factor).abs() - 0.5;
        if above_half.abs() <= ROUGH_ACCURACY + ROUNDING_ERROR {
            above_half = self.number(query).abs() - 0.5;
        }
        if above_half.abs() <= self.accuracy + ROUNDING_ERROR {
            self.ambiguous_count.increment();
            above_half = self.exact_number(query).abs() - 0.5;
        }
        if above_half > ROUNDING_ERROR {
            Sign::Inside
        } else if above_half < -ROUNDING_ERROR {
            Sign::Outside
        } else {
            Sign::Undefined
        }
    }

    /// Returns the common sign of all points within `radius` of a centre that no triangle separates from it, or `None`
    /// if their signs may differ.
    pub(super) fn sign_within(&self, radius: f64, centre: &Point3<f64>) -> Option<Sign> {
        if self.boundary.is_empty() {
            return Some(self.sign(centre));
        }
        let change = self.boundary.max_change_within(radius, centre);
        let least = change + SHARED_SIGN_ACCURACY + self.accuracy + 2.0 * ROUNDING_ERROR;
        if least >= 0.5 {
            return None;
        }
        let above_half = self.number_with_distance_factor(centre, self.shared_distance_factor).abs() - 0.5;
        (above_half.abs() > least).then_some(if above_half > 0.0 { Sign::Inside } else { Sign::Outside })
    }

    /// Returns whether winding numbers are integers and change only at triangles.
    pub(super) fn is_closed(&self) -> bool {
        self.boundary.is_empty()
    }

    pub(super) fn ambiguous_count(&self) -> u64 {
        self.ambiguous_count.get()
    }
}

impl Node {
    /// Evaluates the Taylor polynomial of the node. `offset` is that of the centre from the query, and `square` is
    /// its squared length.
    fn dipole(&self, offset: V3, square: f64) -> f64 {
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
    /// A normal vector whose length is the area.
    normal: V3,
}

impl Triangle {
    /// Returns the solid angle of the triangle, which is positive from its back, and zero in its plane and
    /// at its vertices.
    fn solid_angle(&self, query: V3) -> f64 {
        let [a, b, c] = self.corners.map(|corner| sub(corner, query));
        let [la, lb, lc] = [a, b, c].map(length);
        let volume = dot(a, cross(b, c));
        let other = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        if volume == 0.0 { 0.0 } else { 2.0 * volume.atan2(other) }
    }
}
