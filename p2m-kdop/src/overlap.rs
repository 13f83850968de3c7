//! Which parts of two trees may meet.
//!
//! Two k-DOPs of the same directions have nothing in common if they lie apart along one of them. If one tree is moved,
//! its k-DOPs have other directions; their heights along those of the other tree are then bounded from above: a
//! direction that is a combination of three normals, with weights that are not negative, has at most the same
//! combination of their heights. Which combinations there are depends on the movement alone, so they are computed once.

use crate::{Directions, Kdop, KdopTree};
use nalgebra::{Isometry3, Matrix3, Vector3};
use p2m_bvh::{PacketTree, TreeNode};
use p2m_core::{PrimitiveId, Real};
use std::ops::ControlFlow;

/// A combination of three normals that is a direction, but for what is rounded.
#[derive(Clone, Copy, Debug)]
struct Combination {
    /// Places of the normals, and weights that are not negative.
    terms: [(usize, f64); 3],
    /// What the sum lacks at most, in units of the largest height.
    lack: f64,
}

/// Bounds on the heights of moved k-DOPs along the directions of others.
struct Heights<const K: usize, const L: usize> {
    /// For each of the L directions.
    combinations: Vec<Vec<Combination>>,
    /// What the movement adds to each.
    shift: [f64; L],
    /// What these lack at most.
    lack: f64,
}

/// Of all combinations for a direction the narrowest are kept: the others are rarely better.
const KEPT: usize = 4;
/// Normals whose volume is less are not combined: 2^-21. The first three of any directions have twice as much.
const FLAT: f64 = 1.0 / (1u32 << 21) as f64;
/// What movements and products err by, in parts of what they are computed from: 2^-46.
const ROUNDING: f64 = 1.0 / (1u64 << 46) as f64;

impl<const K: usize, const L: usize> Heights<K, L> {
    /// For k-DOPs of directions `from`, moved by `motion`, along directions `to`.
    ///
    /// Let A be what the quaternion of the motion does to points and t its translation, m a direction, d = A^T m and x
    /// a point of a k-DOP of heights h_i, all at most s in size: m . (A x + t) = d . x + m . t. With weights w_i >=
    /// 0 and r = d - sum w_i n_i, d . x is at most sum w_i h_i + |r| |x|; and |x| is at most s times what the
    /// inverse of the first three normals makes of (1, 1, 1), with absolute values. So weights may be anything, if
    /// the computed |r| is added.
    ///
    /// With u = 2^-53: d is computed to 25 u, r to 4 u (1 + sum w_i) besides, sum w_i h_i to 4 u s sum w_i, m . t to
    /// 3 u |t|, and where a point is said to be after the motion, or after the inverse one, differs by 57 u (|x| + |t|)
    /// at most. All of that and the sums are less than 2^-46 = 128 u of (1 + sum w_i) |x| and of |t|. If the square
    /// of the quaternion is 1 + e, the inverse motion is one to 5 e.
    fn new(from: &Directions<K>, motion: &Isometry3<f64>, to: &Directions<L>) -> Self {
        let normals = from.normals();
        let first = Matrix3::from_rows(&[0, 2, 4].map(|i: usize| normals[i].transpose()));
        let inverse = first.try_inverse().expect("directions do not lie in a plane");
        let reach = (inverse.abs() * Vector3::repeat(1.0)).norm() * (1.0 + FLAT);
        let rounding = ROUNDING + 5.0 * (motion.rotation.quaternion().norm_squared() - 1.0).abs();
        let combinations = to.normals().iter().map(|normal| {
            let direction = motion.rotation.inverse() * normal;
            let mut found = Vec::new();
            for a in 0..K {
                for b in a + 1..K {
                    for c in b + 1..K {
                        let columns = Matrix3::from_columns(&[normals[a], normals[b], normals[c]]);
                        if columns.determinant().abs() < FLAT {
                            continue;
                        }
                        let Some(inverse) = columns.try_inverse() else { continue };
                        let weights: Vector3<f64> = inverse * direction;
                        // What is negative by rounding alone counts as 0: the rest is computed from that.
                        if weights.min() >= -1e-12 {
                            let weights = weights.map(|x| x.max(0.0));
                            let rest = (direction - columns * weights).norm();
                            let lack = (rest + rounding * (1.0 + weights.sum())) * reach;
                            let terms = [(a, weights.x), (b, weights.y), (c, weights.z)];
                            found.push((weights.sum(), Combination { terms, lack }));
                        }
                    }
                }
            }
            // The sum of the weights is 1 for a normal itself and larger the wider the normals are around the
            // direction.
            found.sort_by(|x, y| x.0.total_cmp(&y.0));
            found.into_iter().take(KEPT).map(|(_, combination)| combination).collect()
        });
        let translation = &motion.translation.vector;
        Self {
            combinations: combinations.collect(),
            shift: std::array::from_fn(|i| to.normals()[i].dot(translation)),
            // And what underflows.
            lack: rounding * translation.abs().sum() + f64::MIN_POSITIVE,
        }
    }

    /// A k-DOP of the other directions around a moved one.
    fn around(&self, moved: &Kdop<K>) -> Kdop<L> {
        let size = moved.heights.iter().fold(0.0, |a: f64, h| a.max(h.abs()));
        let height = |i: usize| {
            let of = |c: &Combination| {
                c.terms.iter().map(|(at, weight)| weight * moved.heights[*at]).sum::<f64>() + c.lack * size
            };
            let least = self.combinations[i].iter().map(|c| told(of(c))).fold(f64::INFINITY, f64::min);
            told(least + self.shift[i] + self.lack)
        };
        Kdop { heights: std::array::from_fn(height) }
    }
}

/// A height that cannot be told, for what it was computed from has overflowed, is infinite.
fn told(height: f64) -> f64 {
    if height.is_finite() { height } else { f64::INFINITY }
}

/// Two trees, the second one moved against the first.
///
/// Parts that meet, wherever the motion's arithmetic puts points, are never left out. Parts that lie apart along a
/// direction of both trees, where they are, by more than rounding are; turned volumes are bounded along the other
/// tree's directions, so some of those that lie apart along one alone may be visited.
///
/// ```
/// use p2m_core::{BuildIndex, Segment};
/// use p2m_kdop::{KdopTree, Overlap};
/// use nalgebra::{Isometry3, Point3, Vector3};
///
/// let wires: Vec<_> = (0..100)
///     .map(|i| Segment::new(Point3::new(f64::from(i), 0.0, 0.0), Point3::new(f64::from(i) + 1.0, 0.0, 0.0)))
///     .collect();
/// let tree = KdopTree::<f64, _, 14>::build(&wires, &Default::default()).unwrap();
/// let beside = Isometry3::translation(0.0, 0.5, 0.0);
/// let across = Isometry3::new(Vector3::new(20.5, -50.0, 0.0), Vector3::z() * std::f64::consts::FRAC_PI_2);
/// assert!(!Overlap::new(&tree, &tree, &beside).any());
/// assert!(Overlap::new(&tree, &tree, &across).any());
/// ```
pub struct Overlap<'a, const K: usize, const L: usize> {
    trees: (&'a PacketTree<Kdop<K>>, &'a PacketTree<Kdop<L>>),
    /// Of the second tree along the directions of the first, and the other way round.
    heights: (Heights<L, K>, Heights<K, L>),
}

impl<'a, const K: usize, const L: usize> Overlap<'a, K, L> {
    /// `motion` takes points of the second scene to where they are in the first. For two transformed trees it is the
    /// inverse of the first one's transformation times that of the second.
    pub fn new<T: Real, U: Real, S, R>(
        first: &'a KdopTree<T, S, K>,
        second: &'a KdopTree<U, R, L>,
        motion: &Isometry3<f64>,
    ) -> Self
    where
        S: p2m_core::PrimitiveSet<T>,
        R: p2m_core::PrimitiveSet<U>,
    {
        let (a, b) = (first.directions(), second.directions());
        let heights = (Heights::new(b, motion, a), Heights::new(a, &motion.inverse(), b));
        Self { trees: (first.tree(), second.tree()), heights }
    }

    fn may_meet(&self, a: &Kdop<K>, b: &Kdop<L>) -> bool {
        a.may_meet(&self.heights.0.around(b)) && b.may_meet(&self.heights.1.around(a))
    }

    /// QueryCost all pairs of leaves that may meet, as their primitives, until `visit` breaks.
    ///
    /// # Complexity
    /// O(k log n) expected for k pairs, O(n m) at worst.
    pub fn visit(&self, mut visit: impl FnMut(&[PrimitiveId], &[PrimitiveId]) -> ControlFlow<()>) -> ControlFlow<()> {
        let (first, second) = self.trees;
        let (Some(a), Some(b)) = (first.root(), second.root()) else { return ControlFlow::Continue(()) };
        let mut open: Vec<(TreeNode<Kdop<K>>, TreeNode<Kdop<L>>)> = vec![(a, b)];
        while let Some((a, b)) = open.pop() {
            if !self.may_meet(&a.volume, &b.volume) {
                continue;
            }
            match (first.primitives(&a), second.primitives(&b)) {
                (Some(of_a), Some(of_b)) => visit(of_a, of_b)?,
                // The one with the larger volumes is opened first; levels tell that well enough.
                (None, leaf) if leaf.is_some() || a.depth <= b.depth => {
                    open.extend(first.children(&a).map(|child| (child, b)));
                }
                _ => open.extend(second.children(&b).map(|child| (a, child))),
            }
        }
        ControlFlow::Continue(())
    }

    /// Whether any leaves may meet.
    #[must_use]
    pub fn any(&self) -> bool {
        self.visit(|_, _| ControlFlow::Break(())).is_break()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Translation3, UnitQuaternion};
    use p2m_core::{Aabb, BuildIndex, Point, Primitive, PrimitiveSet, Soup};
    use p2m_testkit::scenes::{self, KINDS, LAYOUTS, of_case};
    use p2m_testkit::{cases, rng};
    use rand::RngExt;

    #[test]
    fn bounds_of_moved_heights_hold_and_are_those_themselves_without_movement() {
        let (from, to) = (Directions::<14>::default(), Directions::<18>::default());
        for case in cases(200, 60) {
            let mut rng = rng("moved heights", case);
            let mut vector = || Vector3::from_fn(|_, _| rng.random_range(-3.0..3.0));
            let motion = Isometry3::new(vector(), vector());
            let points: Vec<_> = (0..5).map(|_| Point3::from(vector())).collect();
            let around = Heights::new(&from, &motion, &to).around(&Kdop::of_points(&from, &points));
            let moved: Vec<_> = points.iter().map(|p| motion * p).collect();
            let exact = Kdop::of_points(&to, &moved);
            assert!(around.contains(&exact), "{around:?} {exact:?}");
            let own = Kdop::of_points(&from, &points);
            let same = Heights::new(&from, &Isometry3::identity(), &from).around(&own);
            assert!(same.heights.iter().zip(&own.heights).all(|(a, b)| a >= b && a - b < 1e-12), "{same:?} {own:?}");
        }
    }

    fn pairs<const K: usize, const L: usize>(
        first: &KdopTree<f64, impl PrimitiveSet<f64>, K>,
        second: &KdopTree<f64, impl PrimitiveSet<f64>, L>,
        motion: &Isometry3<f64>,
    ) -> usize {
        let mut pairs = 0;
        let _ = Overlap::new(first, second, motion).visit(|_, _| {
            pairs += 1;
            ControlFlow::Continue(())
        });
        pairs
    }

    fn grid(columns: usize, rows: usize, place: impl Fn(f64, f64) -> [f64; 3]) -> Vec<Point<f64>> {
        let at = |i: usize| place((i % columns) as f64, (i / columns) as f64);
        (0..columns * rows).map(|i| Point::new(at(i).into())).collect()
    }

    /// A flat scene far from the origin of its file, turned onto a point: heights cancel against the movement.
    #[test]
    fn flat_scenes_from_afar_meet_where_they_are_put() {
        let point = [Point::new(Point3::<f64>::origin())];
        let first = KdopTree::<f64, _, 14>::build(&point[..], &Default::default()).expect("valid");
        for case in cases(600, 96) {
            let (round, mut rng) = (case as usize, rng("flat scenes from afar", case));
            let far = [1e2, 1e4, 1e6, 1e9][round % 4];
            let floor: Vec<_> = (0..40)
                .map(|_| {
                    let mut p = Point3::from([(); 3].map(|()| far + rng.random_range(0.0..10.0)));
                    p[round / 4 % 3] = 0.0;
                    Point::new(p)
                })
                .collect();
            let second = KdopTree::<f64, _, 14>::build(&floor[..], &Default::default()).expect("valid");
            let turned = Isometry3::new(Vector3::zeros(), Vector3::from_fn(|_, _| rng.random_range(-3.0..3.0)));
            let motion = Translation3::from(Point3::origin() - turned * floor[0].vertices()[0]) * turned;
            assert_eq!(motion * floor[0].vertices()[0], Point3::origin());
            assert!(Overlap::new(&first, &second, &motion).any(), "{far:e} round {round}");
            let back = motion.inverse();
            if back * Point3::origin() == floor[0].vertices()[0] {
                assert!(Overlap::new(&second, &first, &back).any(), "back: {far:e} round {round}");
            }
        }
    }

    /// The same without a movement, where sums of heights cancel, and with rotations that are none any more.
    #[test]
    fn turned_scenes_meet_where_they_are_put() {
        for case in cases(600, 96) {
            let (round, mut rng) = (case as usize, rng("turned scenes", case));
            let mut vector = |size: f64| Vector3::from_fn(|_, _| rng.random_range(-size..size));
            let far = vector(1.0) * [1.0, 1e6, 1e12, 1e-310][round % 4];
            let scene: Vec<_> = (0..40).map(|_| Point::new(Point3::from(far + vector(1e-9 * far.amax())))).collect();
            let second = KdopTree::<f64, _, 14>::build(&scene[..], &Default::default()).expect("valid");
            let drift = if round % 3 == 0 { 1.0 + 1e-7 } else { 1.0 };
            let turn = *UnitQuaternion::new(vector(3.0)).quaternion() * drift;
            let turned = Isometry3::from_parts(Default::default(), UnitQuaternion::new_unchecked(turn));
            let point = [Point::new(turned * scene[0].vertices()[0])];
            let first = KdopTree::<f64, _, 18>::build(&point[..], &Default::default()).expect("valid");
            assert!(Overlap::new(&first, &second, &turned).any(), "{far:?} round {round}");
        }
    }

    #[test]
    fn scenes_of_any_size_meet_where_they_are_put() {
        for size in [1e-300, 1e150, 1e300, 0.5 * f64::MAX, 0.7 * f64::MAX, f64::MAX] {
            let at = |x: f64| [x, x * 0.9].map(|x| Point::new(Point3::new(x, x, x)));
            let [here, there] = [at(size), at(-size)];
            let here = KdopTree::<f64, _, 14>::build(&here[..], &Default::default()).expect("finite");
            let there = KdopTree::<f64, _, 26>::build(&there[..], &Default::default()).expect("finite");
            assert!(Overlap::new(&here, &here, &Isometry3::identity()).any(), "{size:e}");
            assert!(Overlap::new(&there, &there, &Isometry3::identity()).any(), "{size:e}");
            let step = Vector3::repeat(-size) * 2.0;
            if size <= 0.5 * f64::MAX {
                assert!(Overlap::new(&there, &here, &Isometry3::from_parts(step.into(), Default::default())).any());
                let back = Isometry3::from_parts((-step).into(), Default::default());
                assert!(Overlap::new(&here, &there, &back).any(), "{size:e}");
            }
            if size <= 1e300 {
                assert!(!Overlap::new(&there, &here, &Isometry3::identity()).any(), "{size:e}");
            }
            let mut found = 0;
            let all = Aabb { min: Vector3::repeat(-f64::MAX).into(), max: Vector3::repeat(f64::MAX).into() };
            let _ = here.tree().visit_leaves_in_box(&all, |ids| {
                found += ids.len();
                ControlFlow::Continue(())
            });
            assert_eq!(found, 2, "{size:e}");
            let p = here.set()[0].vertices()[0];
            assert!(here.tree().visit_leaves_in_box(&Aabb { min: p, max: p }, |_| ControlFlow::Break(())).is_break());
        }
        // What is not a number leaves nothing out.
        let at = [Point::new(Point3::<f64>::origin())];
        let tree = KdopTree::<f64, _, 14>::build(&at[..], &Default::default()).expect("finite");
        assert!(Overlap::new(&tree, &tree, &Isometry3::translation(f64::NAN, 0.0, 0.0)).any());
    }

    #[test]
    fn far_scenes_have_as_few_pairs_as_near_ones() {
        let tree_at = |far: f64| {
            let points = grid(50, 40, |x, y| [x + far, y + far, 0.0]);
            KdopTree::<f64, _, 14>::build(points, &Default::default()).expect("valid")
        };
        let count = |far: f64, x: f64| {
            let tree = tree_at(far);
            pairs(&tree, &tree, &Isometry3::translation(x, 0.0, 0.0))
        };
        let near = count(0.0, 0.5);
        for far in [1e6, 1e9, 1e11] {
            println!("{far:e}: {} of {near} pairs", count(far, 0.5));
            assert!(count(far, 0.5) * 100 <= near * 105 && count(far, 60.0) == 0, "{far:e}");
        }
    }

    /// Directions within 1e-3 of a plane are allowed, and bound movements as others do.
    #[test]
    fn nearly_flat_directions_leave_pairs_out() {
        let flat = [[1.0, 0.0, 0.0], [0.0, 1.0, 1e-4], [1.0, 1.0, 2e-4], [1.0, -1.0, -3e-4]].map(Vector3::from);
        let options = crate::KdopOptions::new(Directions::<8>::new(&flat).expect("four"));
        let points = grid(50, 40, |x, y| [x, y, 0.0]);
        let tree = KdopTree::<f64, _, 8>::build_with(points, &options).expect("valid");
        assert_eq!(pairs(&tree, &tree, &Isometry3::translation(60.0, 0.0, 0.0)), 0);
        let turned = Isometry3::new(Vector3::new(200.0, 0.0, 0.0), Vector3::z() * 0.3);
        assert_eq!(pairs(&tree, &tree, &turned), 0);
        let all = tree.tree().packets().0.pow(2);
        let some = pairs(&tree, &tree, &Isometry3::translation(0.5, 0.0, 0.0));
        println!("{some} of {all} pairs");
        assert!(some * 10 < all, "{some} of {all}");
    }

    /// Moved so that one point of a primitive lies on one of the other scene: that pair of leaves may meet.
    #[test]
    fn no_pair_that_touches_is_lost() {
        for case in cases(120, 48) {
            let (mut rng, (kinds, layout)) = (rng("overlap", case), of_case(case));
            // Every other two dozen are turned as well.
            let turned = if case / 24 % 2 == 1 { 1.0 } else { 0.0 };
            let [a, b]: [Soup<f64>; 2] = [(); 2].map(|()| scenes::soup(&mut rng, kinds, layout, 150));
            let first = KdopTree::<f64, _, 14>::build(&a, &Default::default()).expect("valid");
            let second = KdopTree::<f64, _, 18>::build(&b, &Default::default()).expect("valid");
            let [i, j] = [a.len(), b.len()].map(|n| PrimitiveId::new(rng.random_range(0..n)));
            let [p, q] = [a.get(i).vertices()[0], b.get(j).vertices()[0]];
            let turn = Vector3::from_fn(|_, _| rng.random_range(-3.0..3.0)) * turned;
            let turned = Isometry3::new(Vector3::zeros(), turn);
            let motion = Translation3::from(p - turned * q) * turned;
            let mut found = false;
            let _ = Overlap::new(&first, &second, &motion).visit(|of_a, of_b| {
                found |= of_a.contains(&i) && of_b.contains(&j);
                ControlFlow::Continue(())
            });
            assert!(found, "case {case}: {kinds:?} {layout:?}");
        }
    }

    #[test]
    fn scenes_apart_do_not_meet_and_pairs_are_few() {
        let grid: Vec<Point<f64>> =
            (0..8000).map(|i| Point::new(Point3::from([i % 20, i / 20 % 20, i / 400].map(f64::from)))).collect();
        let tree = KdopTree::<f64, _, 14>::build(&grid, &Default::default()).expect("valid");
        let other = KdopTree::<f64, _, 6>::build(&grid, &Default::default()).expect("valid");
        let any = |motion: Isometry3<f64>| Overlap::new(&tree, &tree, &motion).any();
        assert!(any(Isometry3::identity()));
        assert!(!any(Isometry3::translation(19.5, 0.0, 0.0)));
        // A turned cube in the corner of another: their boxes meet, they do not.
        let turn = Isometry3::rotation(Vector3::z() * std::f64::consts::FRAC_PI_4);
        let beside =
            Isometry3::translation(19.0 + 9.5, 19.0 + 9.5, 0.0) * turn * Isometry3::translation(-9.5, -9.5, 0.0);
        assert!(!any(beside) && any(Isometry3::translation(-5.0, -5.0, 0.0) * beside));
        let few = pairs(&tree, &tree, &Isometry3::translation(18.5, 0.5, 0.5));
        assert!(few < 2000, "{few} of {}", tree.tree().packets().0.pow(2));
        // Turned, both trees' directions and the narrowest combinations leave out what one of each would not.
        let counts = [0.3, 0.8, 1.2].map(|angle| {
            let turned = Isometry3::new(Vector3::new(12.0, 3.0, 5.0), Vector3::new(0.2, 0.5, 1.0) * angle);
            [pairs(&tree, &tree, &turned), pairs(&tree, &other, &turned)]
        });
        println!("{counts:?} pairs");
        let least = [[215, 215], [1090, 758], [959, 969]];
        assert!(
            counts.iter().flatten().zip(least.as_flattened()).all(|(n, least)| n * 100 <= least * 103),
            "{counts:?}"
        );
    }

    #[test]
    fn leaves_in_a_box_have_all_its_primitives() {
        let mut rng = rng("leaves in boxes", 0);
        for layout in LAYOUTS {
            let soup = scenes::soup(&mut rng, KINDS[0], layout, 600);
            let tree = KdopTree::<f64, _, 26>::build(&soup, &Default::default()).expect("valid");
            let vertex = soup.positions()[rng.random_range(0..soup.positions().len())];
            let half = Vector3::repeat((soup.aabb().max - soup.aabb().min).norm() * 0.05);
            let bounds = Aabb { min: vertex - half, max: vertex + half };
            let mut found = Vec::new();
            let _ = tree.tree().visit_leaves_in_box(&bounds, |ids| {
                found.extend_from_slice(ids);
                ControlFlow::Continue(())
            });
            let mut inside = Vec::new();
            p2m_core::BoxQuery::primitives_in_box_into(&tree, &bounds, &mut inside);
            assert!(!inside.is_empty() && inside.iter().all(|id| found.contains(id)), "{layout:?}");
            assert!(found.len() < soup.len() || layout != LAYOUTS[0], "{layout:?}");
        }
    }
}
