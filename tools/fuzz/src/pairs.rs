//! Checks of the nearest pairs of two scenes from bytes: trees are compared with all pairs and with rational
//! arithmetic.
//!
//! The first byte selects the scalar, the second one the kind of motion, and the third one a seed. Then come the first
//! scene, the second scene and the motion.

use super::bytes::Bytes;
use super::scene::{SceneDraft, vertices};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use p2m::field::{HausdorffOptions, hausdorff_distance};
use p2m::pair::{ClosestPair, Motion, MovingBall, PairOptions, PairQuery};
use p2m::{AabbTree, BruteForce, KdopTree, PrimitiveId, PrimitiveSet, Real, Soup};
use p2m_testkit::oracle::Distance;
use p2m_testkit::scenes::narrow;
use std::ops::ControlFlow;

/// The largest number of primitives of a scene.
const MAX_PRIMITIVES: usize = 20;
/// The largest number of queries for a Hausdorff distance.
const MAX_QUERIES: u64 = 200;

struct Input {
    is_single: bool,
    seed: usize,
    drafts: [SceneDraft; 2],
    motion: Option<Isometry3<f64>>,
}

impl Input {
    fn new(input: &[u8]) -> Self {
        let mut bytes = Bytes::new(input);
        let is_single = bytes.byte() % 4 == 1;
        let (kind, seed) = (bytes.below(4), usize::from(bytes.byte()));
        let drafts = [(); 2].map(|()| SceneDraft::new(&mut bytes, MAX_PRIMITIVES));
        let motion = draw_motion(&mut bytes, kind, &drafts);
        Self { is_single, seed, drafts, motion }
    }
}

/// Returns one of these: no motion, a translation that brings a point of the second scene to a point of the first, a
/// rotation with such a translation, or a rotation with any translation.
fn draw_motion(bytes: &mut Bytes<'_>, kind: usize, drafts: &[SceneDraft; 2]) -> Option<Isometry3<f64>> {
    if kind == 0 {
        return None;
    }
    let rotation = match kind {
        1 => UnitQuaternion::identity(),
        _ => UnitQuaternion::new_normalize(Quaternion::from([0; 4].map(|_| f64::from(bytes.signed())))),
    };
    let translation = match bytes.below(4) {
        0 => Vector3::from([0; 3].map(|_| f64::from_bits(bytes.word()))),
        1 => Vector3::from([0; 3].map(|_| f64::from(bytes.signed()) * 0.125)),
        _ => drafts[0].query(bytes).coords - rotation * drafts[1].query(bytes).coords,
    };
    Some(Isometry3::from_parts(Translation3::from(translation), rotation))
}

/// Formats both scenes and the motion of an input.
#[must_use]
pub fn describe(input: &[u8]) -> String {
    let Input { drafts: [a, b], motion, .. } = Input::new(input);
    format!("{}\n{}\nmotion {motion:?}", a.describe(), b.describe())
}

/// Runs the check of an input, and returns whether there is a nearest pair; `None` if a scene is invalid.
///
/// # Panics
/// Panics if an answer is wrong.
pub fn check(input: &[u8]) -> Option<bool> {
    let Input { is_single, seed, drafts, motion } = Input::new(input);
    let [Ok(a), Ok(b)] = drafts.each_ref().map(SceneDraft::soup) else { return None };
    match [&a, &b].map(narrow) {
        [Some(a), Some(b)] if is_single => Some(check_in([&a, &b], motion, seed)),
        _ => Some(check_in([&a, &b], motion, seed)),
    }
}

/// Returns the ids of all pairs within the largest distance of the options, in ascending order.
fn ids_within<T: Real>(
    a: &impl PairQuery<T>,
    b: &impl PairQuery<T>,
    options: &PairOptions<T>,
) -> Vec<[PrimitiveId; 2]> {
    let mut ids = Vec::new();
    let flow = a.visit_pairs_within(b, options, &mut |pair| {
        ids.push(pair.primitives);
        ControlFlow::Continue(())
    });
    assert!(flow.is_continue());
    ids.sort_unstable();
    ids
}

/// Returns all fields of an answer except its lower bound, with the bits of the distance.
fn compared_fields<T: Real>(pair: &ClosestPair<T>) -> impl PartialEq + std::fmt::Debug + use<T> {
    let ClosestPair { points, distance, primitives, features, barycentric, is_intersecting, .. } = *pair;
    (distance.to_f64().to_bits(), points, primitives, features, barycentric, is_intersecting)
}

fn check_in<T: Real>(soups: [&Soup<T>; 2], motion: Option<Isometry3<f64>>, seed: usize) -> bool {
    let [a, b] = soups;
    let mut options = PairOptions::default();
    options.motion = motion;
    let moved = motion.as_ref().map(Motion::new);
    let [brute_a, brute_b] = soups.map(|soup| BruteForce::new(soup).expect("finite"));
    let [tree_a, tree_b] = soups.map(|soup| AabbTree::<T, _>::new(soup).expect("finite"));
    let kdop_a: KdopTree<T, _, 26> = KdopTree::new(a).expect("finite");
    let kdop_b: KdopTree<T, _, 14> = KdopTree::new(b).expect("finite");
    let expected = brute_a.closest_pair(&brute_b, &options);
    let same = |found: Option<ClosestPair<T>>, expected: Option<ClosestPair<T>>, how: &str| {
        let fields = [&found, &expected].map(|pair| pair.as_ref().map(compared_fields));
        assert_eq!(fields[0], fields[1], "{how}: {found:?} {expected:?}");
    };
    same(tree_a.closest_pair(&tree_b, &options), expected, "boxes");
    same(kdop_a.closest_pair(&kdop_b, &options), expected, "k-DOPs");
    same(kdop_a.closest_pair(&tree_b, &options), expected, "k-DOPs and boxes");
    let hinted = options.with_hint([PrimitiveId::new(seed % 21), PrimitiveId::new(seed / 12)]);
    same(tree_a.closest_pair(&kdop_b, &hinted), expected, "with a hint");
    let Some(nearest) = expected else { return false };
    let below = T::round_down_from_f64(nearest.distance.to_f64() * (1.0 - 1e-6));
    for limit in [nearest.distance, below] {
        let limited = options.with_max_distance(limit);
        let within = brute_a.closest_pair(&brute_b, &limited);
        same(kdop_a.closest_pair(&tree_b, &limited), within, "within a distance");
        assert_eq!(tree_a.is_any_pair_near(&kdop_b, &limited), within.is_some(), "{limit:?}");
        assert_eq!(ids_within(&tree_a, &kdop_b, &limited), ids_within(&brute_a, &brute_b, &limited), "{limit:?}");
    }
    check_certified(soups, moved.as_ref(), &nearest, tree_a.certified_closest_pair(&tree_b, &options));
    for shape in (0..b.len().min(3)).map(|id| b.get(PrimitiveId::new(id))) {
        let thick = options.with_radius(nearest.distance * T::round_from_f64(0.125 * (seed % 16) as f64));
        let expected = brute_a.closest_to(&shape, &thick);
        same(tree_a.closest_to(&shape, &thick), expected, "a shape with a radius");
        same(kdop_a.closest_to(&shape, &thick), expected, "a shape with a radius at k-DOPs");
    }
    check_ball(soups, &tree_a, nearest.distance);
    let options = HausdorffOptions::new(T::zero()).with_max_queries(MAX_QUERIES);
    let mut go_on = |_: &_| ControlFlow::Continue(());
    let found = hausdorff_distance((a, &tree_a), (b, &tree_b), &options, &mut go_on).expect("primitives have vertices");
    let bounds = found.expect("neither is empty");
    assert!(bounds.lower_bound <= bounds.upper_bound, "{bounds:?}");
    true
}

/// Checks that the distance of the certified pair is within the bounds of the plain one, and that no pair is nearer.
fn check_certified<T: Real>(
    [a, b]: [&Soup<T>; 2],
    motion: Option<&Motion>,
    plain: &ClosestPair<T>,
    certified: Option<ClosestPair<T>>,
) {
    let certified = certified.expect("there is a pair");
    assert!(certified.distance >= plain.lower_bound, "{certified:?} {plain:?}");
    let second = |id: PrimitiveId| -> Vec<[f64; 3]> {
        let at = vertices(b, id.index());
        at.into_iter().map(|vertex| motion.map_or(vertex, |motion| motion.apply(vertex))).collect()
    };
    let exact = |[i, j]: [PrimitiveId; 2]| Distance::between(&vertices(a, i.index()), &second(j));
    let least = exact(certified.primitives);
    assert!(least.is_at_least(certified.lower_bound.to_f64()), "{certified:?}");
    assert!(least.is_at_least(plain.lower_bound.to_f64()), "{plain:?} above {certified:?}");
    let other = exact(plain.primitives);
    let order = least.compare(&other).then(certified.primitives.cmp(&plain.primitives));
    assert!(order.is_le(), "{certified:?} {plain:?}");
}

/// Checks that a ball that moves from one scene to the other one touches nothing before its parameter.
fn check_ball<T: Real>([a, b]: [&Soup<T>; 2], tree: &impl PairQuery<T>, radius: T) {
    let (start, end) = (b.positions()[0], b.positions()[b.positions().len() - 1]);
    let ball = MovingBall::new(start, end, radius * T::round_from_f64(0.5));
    let contact = ball.first_contact(tree);
    if !ball.radius.to_f64().is_finite() {
        return assert_eq!(contact, None);
    }
    let brute = BruteForce::new(a).expect("finite");
    let path = p2m::Segment::new(start, end);
    let along = brute.certified_closest_to(&path, &PairOptions::default());
    if let Some(contact) = contact {
        assert!(contact.parameter >= T::zero() && contact.parameter <= contact.upper_parameter, "{contact:?}");
        assert!(contact.upper_parameter <= T::one(), "{contact:?}");
        let along = along.expect("a primitive");
        assert!(along.lower_bound <= contact.distance_bound, "{contact:?} {along:?}");
    } else if let Some(along) = along {
        assert!(along.distance >= ball.radius, "{along:?} {ball:?}");
    }
}
