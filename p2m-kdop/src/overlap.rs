//! The overlap of two trees: the pairs of leaves that may intersect.
//!
//! Two k-DOPs of the same directions do not intersect if they lie apart along one of these. If one tree is
//! moved, its k-DOPs have other directions, and their heights along those of the other tree are bounded
//! from above ([`MovedHeights`]).

use crate::moved_heights::MovedHeights;
use crate::{Kdop, KdopTree};
use nalgebra::Isometry3;
use p2m_bvh::{PacketTree, TreeNode};
use p2m_core::{PrimitiveId, Real};
use std::ops::ControlFlow;

/// The overlap of two trees, the second of which is moved against the first.
///
/// Leaves that intersect are never left out, wherever the rounding of the motion puts their points. Leaves are left out
/// if their volumes, where they are, lie apart along a direction of both trees by more than rounding. Heights of turned
/// volumes along the directions of the other tree are only bounded, so leaves that lie apart along one of these alone
/// may be visited.
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
    /// The heights of the second tree along the directions of the first, and those of the first along the second.
    heights: (MovedHeights<L, K>, MovedHeights<K, L>),
}

impl<'a, const K: usize, const L: usize> Overlap<'a, K, L> {
    /// Prepares the search for overlapping leaves. `motion` maps points of the second scene to the first one. For two
    /// transformed trees it is the inverse of the first tree's transformation times that of the second.
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
        let heights = (MovedHeights::new(b, motion, a), MovedHeights::new(a, &motion.inverse(), b));
        Self { trees: (first.tree(), second.tree()), heights }
    }

    fn may_intersect(&self, a: &Kdop<K>, b: &Kdop<L>) -> bool {
        a.may_intersect(&self.heights.0.around(b)) && b.may_intersect(&self.heights.1.around(a))
    }

    /// Visits the primitives of all pairs of leaves that may intersect, until `visit` breaks.
    ///
    /// # Complexity
    /// O(k log n) expected time for k pairs, O(n m) at worst.
    pub fn visit(&self, mut visit: impl FnMut(&[PrimitiveId], &[PrimitiveId]) -> ControlFlow<()>) -> ControlFlow<()> {
        let (first, second) = self.trees;
        let (Some(a), Some(b)) = (first.root(), second.root()) else { return ControlFlow::Continue(()) };
        let mut pending: Vec<(TreeNode<Kdop<K>>, TreeNode<Kdop<L>>)> = vec![(a, b)];
        while let Some((a, b)) = pending.pop() {
            if !self.may_intersect(&a.volume, &b.volume) {
                continue;
            }
            match (first.primitives(&a), second.primitives(&b)) {
                (Some(ids_a), Some(ids_b)) => visit(ids_a, ids_b)?,
                // The node at the higher level is replaced by its children, because its volume is probably the larger.
                (None, leaf) if leaf.is_some() || a.depth <= b.depth => {
                    pending.extend(first.children(&a).map(|child| (child, b)));
                }
                _ => pending.extend(second.children(&b).map(|child| (a, child))),
            }
        }
        ControlFlow::Continue(())
    }

    /// Whether any two leaves may intersect.
    #[must_use]
    pub fn any(&self) -> bool {
        self.visit(|_, _| ControlFlow::Break(())).is_break()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Directions;
    use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
    use p2m_core::{Aabb, BuildIndex, Point, Primitive, PrimitiveSet, Soup};
    use p2m_testkit::scenes::{self, KINDS, LAYOUTS, kinds_and_layout};
    use p2m_testkit::{cases, rng};
    use rand::RngExt;

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

    fn grid(columns: usize, rows: usize, position: impl Fn(f64, f64) -> [f64; 3]) -> Vec<Point<f64>> {
        let point = |i: usize| position((i % columns) as f64, (i / columns) as f64);
        (0..columns * rows).map(|i| Point::new(point(i).into())).collect()
    }

    /// A flat scene far from the origin of its file is turned onto a point. Heights then cancel against the movement.
    #[test]
    fn flat_scenes_from_afar_overlap_after_their_motion() {
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

    /// A scene is turned without a translation, so that sums of heights cancel. Some quaternions do not have unit
    /// length any more.
    #[test]
    fn turned_scenes_overlap_after_their_motion() {
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
    fn scenes_of_any_size_overlap_after_their_motion() {
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
        // A motion that is not a number excludes no pair.
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

    /// Directions within 1e-3 of a plane are allowed, and exclude pairs as others do.
    #[test]
    fn nearly_flat_directions_exclude_pairs() {
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

    /// A scene is moved so that a vertex of it lies on one of the other scene. The pair of their leaves has
    /// to be visited.
    #[test]
    fn no_pair_that_touches_is_lost() {
        for case in cases(120, 48) {
            let (mut rng, (kinds, layout)) = (rng("overlap", case), kinds_and_layout(case));
            // In every other two dozen cases the scene is turned as well.
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
            let _ = Overlap::new(&first, &second, &motion).visit(|ids_a, ids_b| {
                found |= ids_a.contains(&i) && ids_b.contains(&j);
                ControlFlow::Continue(())
            });
            assert!(found, "case {case}: {kinds:?} {layout:?}");
        }
    }

    #[test]
    fn separate_scenes_do_not_overlap_and_pairs_are_few() {
        let grid: Vec<Point<f64>> =
            (0..8000).map(|i| Point::new(Point3::from([i % 20, i / 20 % 20, i / 400].map(f64::from)))).collect();
        let tree = KdopTree::<f64, _, 14>::build(&grid, &Default::default()).expect("valid");
        let other = KdopTree::<f64, _, 6>::build(&grid, &Default::default()).expect("valid");
        let any = |motion: Isometry3<f64>| Overlap::new(&tree, &tree, &motion).any();
        assert!(any(Isometry3::identity()));
        assert!(!any(Isometry3::translation(19.5, 0.0, 0.0)));
        // A turned cube lies beside the corner of another one: their boxes intersect, but the cubes do not.
        let turn = Isometry3::rotation(Vector3::z() * std::f64::consts::FRAC_PI_4);
        let beside =
            Isometry3::translation(19.0 + 9.5, 19.0 + 9.5, 0.0) * turn * Isometry3::translation(-9.5, -9.5, 0.0);
        assert!(!any(beside) && any(Isometry3::translation(-5.0, -5.0, 0.0) * beside));
        let few = pairs(&tree, &tree, &Isometry3::translation(18.5, 0.5, 0.5));
        assert!(few < 2000, "{few} of {}", tree.tree().packets().0.pow(2));
        // Both trees' directions and several combinations together exclude pairs that one of them would not.
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
