//! Which parts of two trees may meet.
//!
//! Two k-DOPs of the same directions have nothing in common if they lie apart along one of them. If one tree is moved, its
//! k-DOPs have other directions; their heights along those of the other tree are then bounded from above: a direction
//! that is a combination of three normals, with weights that are not negative, has at most the same combination of
//! their heights. Which combinations there are depends on the movement alone, so they are computed once.

use crate::{Directions, Kdop, KdopTree};
use nalgebra::{Isometry3, Matrix3, Vector3};
use p2m_core::hierarchy::{PacketTree, Part};
use p2m_core::{PrimitiveId, Real};
use std::ops::ControlFlow;

/// Bounds on the heights of moved k-DOPs along the directions of others.
struct Heights<const K: usize, const L: usize> {
    /// For each of the L directions: combinations of normals of the moved k-DOPs, by their places and weights.
    combinations: Vec<Vec<[(usize, f64); 3]>>,
    /// What the movement adds to each.
    shift: [f64; L],
}

/// Of all combinations for a direction the narrowest are kept: the others are rarely better.
const KEPT: usize = 4;

impl<const K: usize, const L: usize> Heights<K, L> {
    /// For k-DOPs of directions `from`, moved by `motion`, along directions `to`.
    fn new(from: &Directions<K>, motion: &Isometry3<f64>, to: &Directions<L>) -> Self {
        let normals = from.normals();
        let combinations = to.normals().iter().map(|normal| {
            let direction = motion.rotation.inverse() * normal;
            let mut found = Vec::new();
            for a in 0..K {
                for b in a + 1..K {
                    for c in b + 1..K {
                        let columns = Matrix3::from_columns(&[normals[a], normals[b], normals[c]]);
                        if columns.determinant().abs() < 1e-3 {
                            continue;
                        }
                        let Some(inverse) = columns.try_inverse() else { continue };
                        let weights: Vector3<f64> = inverse * direction;
                        // What is negative by rounding alone counts as 0; the margin below has room for it.
                        if weights.min() >= -1e-12 {
                            let [x, y, z] = [0, 1, 2].map(|i: usize| weights[i].max(0.0));
                            found.push((x + y + z, [(a, x), (b, y), (c, z)]));
                        }
                    }
                }
            }
            // The sum of the weights is 1 for a normal itself and larger the wider the normals are around the direction.
            found.sort_by(|x, y| x.0.total_cmp(&y.0));
            found.into_iter().take(KEPT).map(|(_, combination)| combination).collect()
        });
        let shift = std::array::from_fn(|i| to.normals()[i].dot(&motion.translation.vector));
        Self { combinations: combinations.collect(), shift }
    }

    /// A k-DOP of the other directions around a moved one.
    fn around(&self, moved: &Kdop<K>) -> Kdop<L> {
        let size = moved.heights.iter().fold(0.0, |a: f64, h| a.max(h.abs()));
        let height = |i: usize| {
            let of = |c: &[(usize, f64); 3]| c.iter().map(|(at, weight)| weight * moved.heights[*at]).sum::<f64>();
            let least = self.combinations[i].iter().map(of).fold(f64::INFINITY, f64::min);
            // 2^-30: far more than rotations and inverses err.
            least + self.shift[i] + (size + self.shift[i].abs()) * 1e-9
        };
        Kdop { heights: std::array::from_fn(height) }
    }
}

/// Two trees, the second one moved against the first.
///
/// "May meet" is never wrong about parts that do, and leaves out all pairs that lie apart along a direction of either tree.
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
    /// `motion` takes points of the second scene to where they are in the first. For two transformed trees it is the inverse
    /// of the first one's transformation times that of the second.
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

    /// Visits all pairs of leaves that may meet, as their primitives, until `visit` breaks.
    ///
    /// # Complexity
    /// O(k log n) expected for k pairs, O(n m) at worst.
    pub fn visit(&self, mut visit: impl FnMut(&[PrimitiveId], &[PrimitiveId]) -> ControlFlow<()>) -> ControlFlow<()> {
        let (first, second) = self.trees;
        let (Some(a), Some(b)) = (first.root(), second.root()) else { return ControlFlow::Continue(()) };
        let mut open: Vec<(Part<Kdop<K>>, Part<Kdop<L>>)> = vec![(a, b)];
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
    use nalgebra::{Point3, Translation3};
    use p2m_core::{Aabb, BuildIndex, Point, PrimitiveSet, Soup};
    use p2m_testkit::rng;
    use p2m_testkit::scenes::{self, KINDS, LAYOUTS};
    use rand::RngExt;

    #[test]
    fn bounds_of_moved_heights_hold_and_are_those_themselves_without_movement() {
        let mut rng = rng("moved heights", 0);
        let (from, to) = (Directions::<14>::default(), Directions::<18>::default());
        for _ in 0..200 {
            let mut vector = || Vector3::from_fn(|_, _| rng.random_range(-3.0..3.0));
            let motion = Isometry3::new(vector(), vector());
            let points: Vec<_> = (0..5).map(|_| Point3::from(vector())).collect();
            let around = Heights::new(&from, &motion, &to).around(&Kdop::of_points(&from, &points));
            let moved: Vec<_> = points.iter().map(|p| motion * p).collect();
            let exact = Kdop::of_points(&to, &moved);
            assert!(around.contains(&exact), "{around:?} {exact:?}");
            let own = Kdop::of_points(&from, &points);
            let same = Heights::new(&from, &Isometry3::identity(), &from).around(&own);
            assert!(same.heights.iter().zip(&own.heights).all(|(a, b)| (a - b).abs() < 1e-7), "{same:?} {own:?}");
        }
    }

    /// Moved so that one point of a primitive lies on one of the other scene: that pair of leaves may meet.
    #[test]
    fn no_pair_that_touches_is_lost() {
        let mut rng = rng("overlap", 0);
        for round in 0..5 {
            for kinds in KINDS {
                for layout in LAYOUTS {
                    let [a, b]: [Soup<f64>; 2] = [(); 2].map(|()| scenes::soup(&mut rng, kinds, layout, 150));
                    let first = KdopTree::<f64, _, 14>::build(&a, &Default::default()).expect("valid");
                    let second = KdopTree::<f64, _, 18>::build(&b, &Default::default()).expect("valid");
                    let [i, j] = [a.len(), b.len()].map(|n| PrimitiveId::new(rng.random_range(0..n)));
                    let [p, q] = [a.get(i).vertices()[0], b.get(j).vertices()[0]];
                    let turn = Vector3::from_fn(|_, _| rng.random_range(-3.0..3.0)) * f64::from(round % 2);
                    let turned = Isometry3::new(Vector3::zeros(), turn);
                    let motion = Translation3::from(p - turned * q) * turned;
                    let mut found = false;
                    let _ = Overlap::new(&first, &second, &motion).visit(|of_a, of_b| {
                        found |= of_a.contains(&i) && of_b.contains(&j);
                        ControlFlow::Continue(())
                    });
                    assert!(found, "{kinds:?} {layout:?} round {round}");
                }
            }
        }
    }

    #[test]
    fn scenes_apart_do_not_meet_and_pairs_are_few() {
        let grid: Vec<Point<f64>> =
            (0..8000).map(|i| Point::new(Point3::from([i % 20, i / 20 % 20, i / 400].map(f64::from)))).collect();
        let tree = KdopTree::<f64, _, 14>::build(&grid, &Default::default()).expect("valid");
        let any = |motion: Isometry3<f64>| Overlap::new(&tree, &tree, &motion).any();
        assert!(any(Isometry3::identity()));
        assert!(!any(Isometry3::translation(19.5, 0.0, 0.0)));
        // A turned cube in the corner of another: their boxes meet, they do not.
        let turn = Isometry3::rotation(Vector3::z() * std::f64::consts::FRAC_PI_4);
        let beside =
            Isometry3::translation(19.0 + 9.5, 19.0 + 9.5, 0.0) * turn * Isometry3::translation(-9.5, -9.5, 0.0);
        assert!(!any(beside) && any(Isometry3::translation(-5.0, -5.0, 0.0) * beside));
        let mut pairs = 0;
        let _ = Overlap::new(&tree, &tree, &Isometry3::translation(18.5, 0.5, 0.5)).visit(|_, _| {
            pairs += 1;
            ControlFlow::Continue(())
        });
        assert!(pairs < 2000, "{pairs} of {}", tree.tree().packets().0.pow(2));
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
