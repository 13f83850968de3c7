//! Solids: closed scenes that count as filled, so that everything inside of them has the distance 0.
//!
//! Pair queries know surfaces only: inside of a closed scene, they return the distance from its surface. A [`Solid`]
//! also tests whether a vertex of the other scene is inside. If the surfaces do not intersect, a connected part of a
//! scene is inside as a whole or not at all, so one vertex of each part decides. For points,
//! [`Signed::distance_to_solid`] is the distance.
//!
//! [`Signed::distance_to_solid`]: crate::sign::Signed::distance_to_solid

use nalgebra::Point3;
use p2m_core::engine::weld::{UnionFind, VertexWelder};
use p2m_core::pair::{ClosestPair, Hull, Motion, PairOptions, PairQuery};
use p2m_core::{Feature, Point, Primitive, PrimitiveId, Soup};

/// Returns whether a point is inside of a solid, as [`SignedDistance::contains`](crate::sign::SignedDistance::contains)
/// does.
pub type Contains<'a> = dyn Fn(&Point3<f64>) -> bool + Sync + 'a;

/// The connected parts of a scene, which share no vertex with each other: the first primitive of each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parts(Vec<PrimitiveId>);

impl Parts {
    /// Finds the parts of a scene. Vertices are welded where they have the same coordinates.
    ///
    /// # Complexity
    /// Expected linear time, and 8 bytes per position until it returns.
    #[must_use]
    pub fn of(soup: &Soup<f64>) -> Self {
        let welder = VertexWelder::new(soup);
        let mut union = UnionFind::new(welder.vertex_count);
        let vertex = |position: &u32| welder.vertex_ids[*position as usize];
        for element in soup.elements() {
            element.indices().windows(2).for_each(|pair| union.union(vertex(&pair[0]), vertex(&pair[1])));
        }
        let mut is_known = vec![false; welder.vertex_count];
        let mut is_new =
            |position: &u32| !std::mem::replace(&mut is_known[union.find(vertex(position)) as usize], true);
        let first = soup.elements().enumerate().filter(|(_, element)| is_new(&element.indices()[0]));
        Self(first.map(|(number, _)| PrimitiveId::new(number)).collect())
    }
}

/// A scene in pair queries, which counts as filled if it has an inside.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_bvh::AabbTree;
/// use p2m_core::pair::{PairOptions, PairQuery};
/// use p2m_core::Segment;
/// use p2m_field::sign::SignedDistance;
/// use p2m_field::solid::{Parts, Solid};
/// use p2m_mixed::generate::{IcoSphere, ico_sphere};
///
/// let tank = ico_sphere(&IcoSphere { frequency: 8 })?;
/// let signed = SignedDistance::new(AabbTree::new(&tank)?, &tank)?;
/// let inside = |point: &Point3<f64>| signed.contains(point);
/// let parts = Parts::of(&tank);
/// let solid = Solid::new(signed.index(), &parts, Some(&inside));
/// let arm = Segment::new(Point3::new(0.0, 0.0, -0.1), Point3::new(0.0, 0.0, 0.1));
/// let options = PairOptions::default();
/// assert!(signed.index().closest_to(&arm, &options).unwrap().distance > 0.5);
/// assert_eq!(solid.closest_to(&arm, &options).unwrap().distance, 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Solid<'a, I> {
    index: &'a I,
    parts: &'a Parts,
    contains: Option<&'a Contains<'a>>,
}

impl<I> std::fmt::Debug for Solid<'_, I> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Solid").field("parts", &self.parts).finish_non_exhaustive()
    }
}

impl<'a, I: PairQuery<f64>> Solid<'a, I> {
    /// Makes a solid of an index and the parts of its scene. Without a function that decides which points are inside,
    /// only its surface counts, as for segments and points.
    #[must_use]
    pub fn new(index: &'a I, parts: &'a Parts, contains: Option<&'a Contains<'a>>) -> Self {
        Self { index, parts, contains }
    }

    /// Returns what [`PairQuery::closest_to`] does, with the distance 0 for a shape inside.
    ///
    /// Inside, both points are the first vertex of the shape, and the primitive is the closest one to it.
    pub fn closest_to<P: Primitive<f64>>(&self, shape: &P, options: &PairOptions<f64>) -> Option<ClosestPair<f64>> {
        let found = self.index.closest_to(shape, options);
        if !may_be_inside(found.as_ref(), options) {
            return found;
        }
        let vertex = Hull::of(shape).vertices()[0];
        let vertex = options.motion.map_or(vertex, |motion| Motion::new(&motion).apply(vertex));
        self.contact(vertex.into(), PrimitiveId::new(0)).or(found)
    }

    /// Returns what [`PairQuery::closest_pair`] does, with the distance 0 if one solid is inside of the other one.
    ///
    /// Inside, both points are a vertex of the inner solid. The primitives are one of the inner solid with this vertex,
    /// and the closest one of the outer solid.
    ///
    /// # Accuracy
    /// The test of whether vertices of the first solid are inside of the second one applies the inverse of the motion,
    /// with its rounding.
    ///
    /// # Complexity
    /// One pair query, and one point query for each connected part of both scenes.
    pub fn closest_pair<J: PairQuery<f64>>(
        &self,
        other: &Solid<'_, J>,
        options: &PairOptions<f64>,
    ) -> Option<ClosestPair<f64>> {
        let found = self.index.closest_pair(other.index, options);
        if !may_be_inside(found.as_ref(), options) {
            return found;
        }
        let motion = options.motion.map(|motion| Motion::new(&motion));
        let of_other = || {
            other.parts.0.iter().find_map(|part| {
                let vertex = other.index.hull(*part).vertices()[0];
                self.contact(motion.as_ref().map_or(vertex, |motion| motion.apply(vertex)).into(), *part)
            })
        };
        let of_self = || {
            self.parts.0.iter().find_map(|part| {
                let vertex = self.index.hull(*part).vertices()[0];
                let place = motion.as_ref().map_or(Point3::from(vertex), |m| m.apply_inverse(vertex).into());
                let mut pair = other.contact(place, *part)?;
                pair.points = [vertex.into(); 2];
                Some(swapped(pair))
            })
        };
        of_other().or_else(of_self).or(found)
    }

    /// Returns the contact with a vertex of another scene that is inside, if it is.
    fn contact(&self, vertex: Point3<f64>, part: PrimitiveId) -> Option<ClosestPair<f64>> {
        if !self.contains.is_some_and(|contains| contains(&vertex)) {
            return None;
        }
        let mut pair = self.index.closest_to(&Point::new(vertex), &PairOptions::default())?;
        (pair.points, pair.distance, pair.lower_bound, pair.is_intersecting) = ([vertex; 2], 0.0, 0.0, true);
        (pair.primitives[1], pair.features[1], pair.barycentric[1]) = (part, Feature::Vertex(0), [1.0, 0.0, 0.0]);
        Some(pair)
    }
}

/// Returns whether two scenes may be inside of each other: their surfaces do not intersect, and a distance of 0 would
/// be an answer.
fn may_be_inside(found: Option<&ClosestPair<f64>>, options: &PairOptions<f64>) -> bool {
    !found.is_some_and(|pair| pair.is_intersecting) && options.max_distance >= 0.0 && options.radius >= 0.0
}

/// Returns a pair with its scenes exchanged.
fn swapped(mut pair: ClosestPair<f64>) -> ClosestPair<f64> {
    pair.points.swap(0, 1);
    pair.primitives.swap(0, 1);
    pair.features.swap(0, 1);
    pair.barycentric.swap(0, 1);
    pair
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sign::SignedDistance;
    use nalgebra::{Isometry3, Vector3};
    use p2m_bvh::AabbTree;
    use p2m_core::{Element, Segment};
    use p2m_mixed::generate::{IcoSphere, ico_sphere};

    /// Returns a ball with a centre and a radius.
    fn ball(centre: [f64; 3], radius: f64) -> Soup<f64> {
        let mut ball = ico_sphere(&IcoSphere { frequency: 6 }).unwrap();
        ball.map_positions(|point| Point3::from(point.coords * radius + Vector3::from(centre))).unwrap();
        ball
    }

    /// Returns one soup of several.
    fn joined(soups: &[Soup<f64>]) -> Soup<f64> {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for soup in soups {
            let first = u32::try_from(positions.len()).unwrap();
            positions.extend_from_slice(soup.positions());
            triangles.extend(soup.triangles().iter().map(|triangle| triangle.map(|i| i + first)));
        }
        Soup::from_triangles(positions, triangles).unwrap()
    }

    /// Compares the answer for two scenes, in both orders, with a distance.
    fn check(a: &Soup<f64>, b: &Soup<f64>, motion: Isometry3<f64>, expected: Option<f64>) {
        let signed = [a, b].map(|soup| SignedDistance::new(AabbTree::new(soup).unwrap(), soup).unwrap());
        let inside = [0, 1].map(|k| {
            let signed = &signed[k];
            move |point: &Point3<f64>| signed.contains(point)
        });
        let parts = [a, b].map(Parts::of);
        let solids = [0, 1].map(|k| Solid::new(signed[k].index(), &parts[k], Some(&inside[k])));
        for (k, motion) in [(0, motion), (1, motion.inverse())] {
            let options = PairOptions::default().with_motion(motion);
            let found = solids[k].closest_pair(&solids[1 - k], &options).unwrap();
            let surfaces = signed[k].index().closest_pair(signed[1 - k].index(), &options).unwrap();
            match expected {
                // A distance of surfaces stays as it is.
                None => assert_eq!(found, surfaces),
                Some(expected) => {
                    assert_eq!((found.distance, found.lower_bound, found.is_intersecting), (expected, expected, true))
                }
            }
            if expected.is_some() && !surfaces.is_intersecting {
                assert_eq!(found.points[0], found.points[1]);
                let motion = Motion::new(&motion);
                for side in 0..2 {
                    // The point is in both solids.
                    let point = found.points[0];
                    let point = if side == 1 { Point3::from(motion.apply_inverse(point.coords.into())) } else { point };
                    let solid = &signed[if side == 0 { k } else { 1 - k }];
                    let distance = solid.closest_point(&point).unwrap().distance().unwrap();
                    assert!(distance < 1e-12, "{distance}");
                }
            }
            let within = solids[k].closest_pair(&solids[1 - k], &options.with_max_distance(0.0));
            assert_eq!(within.is_some(), expected.is_some());
        }
    }

    #[test]
    fn what_is_inside_has_no_distance() {
        let tank = ball([0.0; 3], 2.0);
        let none = Isometry3::identity();
        check(&tank, &ball([0.5, 0.0, 0.0], 1.0), none, Some(0.0));
        check(&tank, &ball([0.0, 0.0, 5.0], 1.0), none, None);
        check(&tank, &ball([0.0, 0.0, 2.5], 1.0), none, Some(0.0));
        // One of two parts is inside.
        check(&tank, &joined(&[ball([9.0, 0.0, 0.0], 1.0), ball([0.0, 0.3, 0.0], 0.5)]), none, Some(0.0));
        check(&tank, &joined(&[ball([9.0, 0.0, 0.0], 1.0), ball([0.0, 9.0, 0.0], 0.5)]), none, None);
        // A hollow ball has nothing in its hollow.
        let mut inner = ball([0.0; 3], 1.5);
        inner = Soup::from_triangles(
            inner.positions().to_vec(),
            inner.triangles().iter().map(|[a, b, c]| [*a, *c, *b]).collect(),
        )
        .unwrap();
        check(&joined(&[tank.clone(), inner]), &ball([0.2, 0.0, 0.0], 0.5), none, None);
        // A motion brings the ball inside.
        let motion = Isometry3::new(Vector3::new(0.0, 0.0, -5.2), Vector3::new(0.0, 0.0, 1.0));
        check(&tank, &ball([0.0, 0.0, 5.0], 0.5), motion, Some(0.0));
    }

    #[test]
    fn shapes_and_scenes_without_an_inside_can_be_inside() {
        let tank = ball([0.0; 3], 2.0);
        let signed = SignedDistance::new(AabbTree::new(&tank).unwrap(), &tank).unwrap();
        let inside = |point: &Point3<f64>| signed.contains(point);
        let parts = Parts::of(&tank);
        let solid = Solid::new(signed.index(), &parts, Some(&inside));
        let arm = |x: f64| Segment::new(Point3::new(x, 0.0, 0.0), Point3::new(x + 0.5, 0.0, 0.0));
        let options = PairOptions::default();
        assert_eq!(solid.closest_to(&arm(0.0), &options).unwrap().distance, 0.0);
        assert_eq!(solid.closest_to(&arm(5.0), &options), signed.index().closest_to(&arm(5.0), &options));
        let moved = options.with_motion(Isometry3::translation(-5.0, 0.0, 0.0));
        assert_eq!(solid.closest_to(&arm(5.0), &moved).unwrap().points[0], Point3::origin());
        assert_eq!(solid.closest_to(&arm(0.0), &options.with_max_distance(f64::NAN)), None);
        let positions = vec![Point3::origin(), Point3::new(0.5, 0.0, 0.0)];
        let cable = Soup::new(positions, [Element::Segment([0, 1])]).unwrap();
        let index = AabbTree::new(&cable).unwrap();
        let of_cable = Parts::of(&cable);
        let other = Solid::new(&index, &of_cable, None);
        assert_eq!(solid.closest_pair(&other, &options).unwrap().distance, 0.0);
        assert_eq!(other.closest_pair(&solid, &options).unwrap().primitives[0], PrimitiveId::new(0));
        assert!(Solid::new(signed.index(), &parts, None).closest_pair(&other, &options).unwrap().distance > 1.0);
    }

    #[test]
    fn parts_are_those_that_share_no_vertex() {
        let ids = |soup: &Soup<f64>| Parts::of(soup).0.iter().map(|id| id.index()).collect::<Vec<_>>();
        let ball = ball([0.0; 3], 1.0);
        let count = ball.triangles().len();
        assert_eq!(ids(&ball), [0]);
        let mut far = ball.clone();
        far.map_positions(|point| point + Vector3::x() * 9.0).unwrap();
        assert_eq!(ids(&joined(&[ball, far])), [0, count]);
        assert!(ids(&Soup::default()).is_empty());
    }
}
