//! Local planes of a cloud of points, which give deviations from it a sign.

use nalgebra::{Matrix3, Point3, SymmetricEigen, Vector3};
use p2m_core::batch::{self, BatchOptions};
use p2m_core::{Closest, ClosestPoint, NearQuery, QueryOptions, Soup};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The number of points that define a plane.
const NEIGHBOURS: usize = 12;

/// The plane of least squares through each point of a cloud and its eleven nearest others, and its normal.
///
/// Normals of neighbours agree along a tree of minimal turns \[Hoppe1992\], which starts at the highest point (by z)
/// with a normal that points up. So they point outwards on a closed surface, and up on a terrain. Parts that share no
/// neighbours have a start each.
///
/// The deviation of a query is measured from the plane of its closest point: along the normal where the foot of the
/// perpendicular is no farther from the closest point than its neighbours, and otherwise as the distance from the
/// closest point, with the sign of the side. So noise of the cloud is averaged over twelve points, and the spacing of
/// its points does not count.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, ClosestPoint, Element, Soup};
/// use p2m_field::deviation::LocalPlanes;
///
/// let points: Vec<_> = (0..100).map(|i| Point3::new(f64::from(i % 10), f64::from(i / 10), 5.0)).collect();
/// let cloud = Soup::new(points, (0..100).map(Element::Point))?;
/// let index = BruteForce::new(&cloud)?;
/// let planes = LocalPlanes::new(&cloud, &index).expect("a cloud");
/// let query = Point3::new(4.5, 4.5, 4.75);
/// let closest = index.closest_point(&query).expect("not empty");
/// assert!((closest.distance - 0.75).abs() < 1e-3 && (planes.deviation(&query, &closest) + 0.25).abs() < 1e-12);
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[derive(Clone, Debug)]
pub struct LocalPlanes {
    planes: Vec<Plane>,
}

/// The plane of a point of the cloud.
#[derive(Clone, Copy, Debug)]
struct Plane {
    /// The mean of the neighbourhood, relative to the point.
    centre: Vector3<f64>,
    /// The unit normal; zero where all neighbours are at one place or along a line.
    normal: Vector3<f64>,
    /// The distance from the point to the farthest of its neighbours.
    radius: f64,
}

impl LocalPlanes {
    /// Computes the planes of a scene that has at least three points and nothing else, or returns `None` for any other
    /// scene.
    /// `index` is an index of the scene.
    ///
    /// # Complexity
    /// Expected O(n log n) time: about 10 microseconds per point, and 150 bytes.
    #[must_use]
    pub fn new<I: NearQuery<f64> + Sync + ?Sized>(cloud: &Soup<f64>, index: &I) -> Option<Self> {
        let points = cloud.points();
        if points.len() < 3 || !cloud.segments().is_empty() || !cloud.triangles().is_empty() {
            return None;
        }
        let place = |i: u32| cloud.positions()[points[i as usize] as usize];
        let numbers: Vec<u32> = (0u32..).take(points.len()).collect();
        let neighbourhood = |i: &u32| {
            let found = index.k_nearest(&place(*i), NEIGHBOURS, f64::INFINITY);
            let others = found.iter().map(|other| other.primitive.number());
            (plane(&place(*i), &found), others.collect::<Vec<u32>>())
        };
        let found = batch::map(&numbers, &BatchOptions::default(), |i| place(*i), neighbourhood);
        let (mut planes, neighbours): (Vec<Plane>, Vec<Vec<u32>>) = found.into_iter().unzip();
        let mut downwards = numbers;
        downwards.sort_by(|a, b| place(*b).z.total_cmp(&place(*a).z));
        orient(&mut planes, &neighbours, &downwards);
        Some(Self { planes })
    }

    /// Returns the deviations of queries, in their order and computed as a [`batch`], with NaN where there is no
    /// answer.
    pub fn deviations<I: ClosestPoint<f64> + Sync + ?Sized>(
        &self,
        index: &I,
        queries: &[Point3<f64>],
        options: &QueryOptions<f64>,
        batch: &BatchOptions,
    ) -> Vec<f64> {
        let mut answers = vec![None; queries.len()];
        batch::closest_points_into(index, queries, options, batch, &mut answers);
        let answered = queries.iter().zip(&answers);
        answered
            .map(|(query, answer)| answer.as_ref().map_or(f64::NAN, |answer| self.deviation(query, answer)))
            .collect()
    }

    /// Returns the deviation of a query with the closest point `closest` of the cloud: positive on the side of the
    /// normal. It is NaN where all neighbours are at one place, or along a line, which has no sides.
    ///
    /// # Panics
    /// If the primitive is not one of the cloud.
    #[must_use]
    pub fn deviation(&self, query: &Point3<f64>, closest: &Closest<f64>) -> f64 {
        let Plane { centre, normal, radius } = self.planes[closest.primitive.index()];
        if normal == Vector3::zeros() {
            return f64::NAN;
        }
        let offset = query - closest.point;
        let height = normal.dot(&(offset - centre));
        if (offset - normal * height).norm() <= radius { height } else { closest.distance.copysign(height) }
    }
}

/// The least variance of neighbours across their main direction, relative to the variance along it. Neighbours with
/// less are on a line and have no plane.
const LEAST_WIDTH: f64 = 1e-3;

/// Returns the plane through a point and its neighbours, which include the point, with either normal.
fn plane(point: &Point3<f64>, neighbours: &[Closest<f64>]) -> Plane {
    let count = neighbours.len() as f64;
    let centre = neighbours.iter().map(|other| other.point - point).sum::<Vector3<f64>>() / count;
    let radius = neighbours.last().map_or(0.0, |last| last.distance);
    if radius == 0.0 {
        return Plane { centre, normal: Vector3::zeros(), radius };
    }
    // Offsets are scaled so that their squares are in range.
    let covariance = neighbours.iter().fold(Matrix3::zeros(), |sum, other| {
        let offset = (other.point - point - centre) / radius;
        sum + offset * offset.transpose()
    });
    let eigen = SymmetricEigen::new(covariance);
    let mut ascending = [0, 1, 2];
    ascending.sort_unstable_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let [least, middle, most] = ascending;
    let is_line = eigen.eigenvalues[middle] <= LEAST_WIDTH * eigen.eigenvalues[most];
    let normal = if is_line { Vector3::zeros() } else { eigen.eigenvectors.column(least).into_owned() };
    Plane { centre, normal, radius }
}

/// Turns normals so that they agree along the tree of minimal turns. `downwards` has all planes, the highest first.
///
/// This is Prim's algorithm for a spanning tree of neighbours. A queue has planes that are not oriented yet, each with
/// a neighbour that is. The pair whose normals are the most nearly parallel is taken first: the plane is turned to
/// agree with its oriented neighbour, and its own neighbours enter the queue. Wherever no neighbour is oriented, a new
/// tree starts at the highest plane that is left.
fn orient(planes: &mut [Plane], neighbours: &[Vec<u32>], downwards: &[u32]) {
    let mut is_done = vec![false; planes.len()];
    // Queued planes whose normals are not oriented yet: the absolute cosine of the angle to an oriented neighbour, the
    // plane, and that neighbour. The bits of the cosine are ordered as the cosine is.
    let mut waiting: BinaryHeap<(u64, Reverse<u32>, Reverse<u32>)> = BinaryHeap::new();
    let entry = |planes: &[Plane], from: u32, plane: u32| {
        let cosine = planes[from as usize].normal.dot(&planes[plane as usize].normal).abs();
        (cosine.to_bits(), Reverse(plane), Reverse(from))
    };
    for start in downwards {
        if !is_done[*start as usize] {
            // A point that is in no neighbourhood of an oriented point may have oriented points in its own.
            let done = neighbours[*start as usize].iter().filter(|other| is_done[**other as usize]);
            waiting.extend(done.map(|other| entry(planes, *other, *start)));
            if waiting.is_empty() {
                let normal = &mut planes[*start as usize].normal;
                *normal *= if normal.z < 0.0 { -1.0 } else { 1.0 };
                waiting.push((1.0f64.to_bits(), Reverse(*start), Reverse(*start)));
            }
        }
        while let Some((_, Reverse(plane), Reverse(from))) = waiting.pop() {
            if std::mem::replace(&mut is_done[plane as usize], true) {
                continue;
            }
            if planes[from as usize].normal.dot(&planes[plane as usize].normal) < 0.0 {
                planes[plane as usize].normal.neg_mut();
            }
            let others = neighbours[plane as usize].iter().filter(|other| !is_done[**other as usize]);
            waiting.extend(others.map(|other| entry(planes, plane, *other)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_bvh::AabbTree;
    use p2m_core::{ClosestPoint, Element};
    use p2m_mixed::generate::{TorusKnot, torus_knot};
    use p2m_testkit::{normal_number, rng};
    use rand::RngExt;

    fn cloud(points: Vec<Point3<f64>>) -> Soup<f64> {
        let elements: Vec<Element> = (0u32..).take(points.len()).map(Element::Point).collect();
        Soup::new(points, elements).unwrap()
    }

    /// Returns the deviations of points from a cloud.
    fn deviations(points: Vec<Point3<f64>>, queries: &[Point3<f64>]) -> Vec<f64> {
        let cloud = cloud(points);
        let index = AabbTree::new(&cloud).unwrap();
        let planes = LocalPlanes::new(&cloud, &index).unwrap();
        let found = planes.deviations(&index, queries, &QueryOptions::default(), &BatchOptions::default());
        for (query, found) in queries.iter().zip(&found) {
            let single = planes.deviation(query, &index.closest_point(query).unwrap());
            assert!(single.to_bits() == found.to_bits() || single.is_nan() && found.is_nan());
        }
        found
    }

    #[test]
    fn points_along_a_line_have_no_sides() {
        let pole = (0..200).map(|i| Point3::new(0.0, 0.0, f64::from(i) * 0.1)).collect();
        assert!(deviations(pole, &[Point3::new(0.03, 0.0, 5.02)])[0].is_nan());
    }

    #[test]
    fn a_cloud_on_a_knot_has_an_inside() {
        let knot = torus_knot(&TorusKnot::default()).unwrap();
        let (mut rng, mut points, mut queries, mut expected) = (rng("planes", 0), Vec::new(), Vec::new(), Vec::new());
        for triangle in knot.triangles() {
            let [a, b, c] = triangle.map(|i| knot.positions()[i as usize]);
            let normal = (b - a).cross(&(c - a)).normalize();
            points.extend([a, b, c, a + ((b - a) + (c - a)) / 3.0]);
            let height = 0.05 * normal_number(&mut rng);
            queries.push(a + (b - a) * 0.3 + (c - a) * 0.3 + normal * height);
            expected.push(height);
        }
        let found = deviations(points, &queries);
        // The planes miss the curvature of the tube by about this much.
        let wrong = found.iter().zip(&expected).filter(|(x, y)| (**x - **y).abs() > 0.02).count();
        assert!(wrong <= found.len() / 200, "{wrong} of {}", found.len());
        let flipped = found.iter().zip(&expected).filter(|(x, y)| y.abs() > 0.02 && **x * **y < 0.0).count();
        assert_eq!(flipped, 0);
    }

    #[test]
    fn terrains_face_up_wherever_they_are_and_noise_is_averaged() {
        for origin in [0.0, 1e6] {
            let mut rng = rng("terrain", 0);
            let ground = |x: f64, y: f64| 3.0 * (x / 20.0).sin() + 2.0 * (y / 15.0).cos();
            let point = |x: f64, y: f64, z: f64| Point3::new(origin + x, origin + y, z);
            let mut places = || [rng.random_range(0.0..100.0), rng.random_range(0.0..100.0)];
            let points = (0..20_000).map(|_| places()).map(|[x, y]| point(x, y, ground(x, y))).collect();
            // Near the border, a query may have the distance from its closest point instead.
            let inner = |x: f64| 5.0 + 0.9 * x;
            let places = (0..500).map(|_| places().map(inner));
            let queries: Vec<_> = places.map(|[x, y]| point(x, y, ground(x, y) - 0.3)).collect();
            for found in deviations(points, &queries) {
                assert!((-0.32..-0.25).contains(&found), "{found} at {origin}");
            }
        }
    }

    #[test]
    fn queries_beyond_the_border_have_their_distance_and_side() {
        let plane: Vec<_> = (0..400).map(|i| Point3::new(f64::from(i % 20), f64::from(i / 20), 0.0)).collect();
        let queries = [[30.0, 10.0, 0.5], [30.0, 10.0, -0.5], [10.2, 10.3, -2.0]].map(Point3::from);
        let distance = f64::hypot(11.0, 0.5);
        let found = deviations(plane, &queries);
        assert!((found[0] - distance).abs() < 1e-12 && (found[1] + distance).abs() < 1e-12, "{found:?}");
        assert!((found[2] + 2.0).abs() < 1e-12, "{found:?}");
        assert!(deviations(vec![Point3::origin(); 20], &queries)[0].is_nan());
        let few = cloud(vec![Point3::origin(); 2]);
        assert!(LocalPlanes::new(&few, &AabbTree::new(&few).unwrap()).is_none());
    }
}
