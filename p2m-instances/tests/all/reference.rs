//! A scene of instances beside the moved vertices that its answers have to be about.

use nalgebra::{Isometry3, Point3, Vector3};
use p2m_core::pair::{ClosestPair, Motion, PairOptions, PairQuery};
use p2m_core::{AnyIndex, Element, PrimitiveId, PrimitiveSet, Real, Soup};
use p2m_instances::{InstanceId, Instances};
use p2m_testkit::vector;
use rand::{Rng, RngExt};
use std::ops::ControlFlow;
use std::sync::Arc;

/// An object: its scene and its index.
pub(crate) type Object<'a, T> = (&'a Soup<T>, Arc<dyn AnyIndex<T> + 'a>);

/// An instance that a scene should have: its id, the number of its object, and its motion.
pub(crate) type Expected = (InstanceId, usize, Isometry3<f64>);

/// Returns a motion: none, a translation, or a rotation with a translation; small, about as large as an object, or far.
pub(crate) fn motion(rng: &mut impl Rng, size: f64) -> Isometry3<f64> {
    let far = [0.0, 0.01, 0.5, 1.0, 3.0, 1e3, 1e12][rng.random_range(0..7)] * size;
    let quarter = std::f64::consts::FRAC_PI_2;
    let turn = [Vector3::zeros(), Vector3::z() * quarter, vector(rng) * 3.0][rng.random_range(0..3)];
    Isometry3::new(vector(rng) * far, turn)
}

/// Returns the soup of all moved vertices, in the order of ids.
pub(crate) fn moved_soup<T: Real>(objects: &[Object<'_, T>], expected: &[Expected]) -> Soup<f64> {
    let (mut positions, mut elements): (Vec<Point3<f64>>, Vec<Element>) = Default::default();
    for (_, object, isometry) in expected {
        let motion = Motion::new(isometry);
        let soup = objects[*object].0;
        let first = u32::try_from(positions.len()).expect("few positions");
        positions.extend(soup.positions().iter().map(|p| Point3::from(motion.apply([p.x, p.y, p.z].map(T::to_f64)))));
        elements.extend(soup.elements().map(|element| match element {
            Element::Point(a) => Element::Point(a + first),
            Element::Segment(ends) => Element::Segment(ends.map(|i| i + first)),
            Element::Triangle(corners) => Element::Triangle(corners.map(|i| i + first)),
        }));
    }
    Soup::new(positions, elements).expect("finite")
}

/// Makes a scene of random instances by several edits that add, move and remove.
pub(crate) fn scene<'a, T: Real>(
    rng: &mut impl Rng,
    objects: &[Object<'a, T>],
    size: f64,
) -> (Instances<T, dyn AnyIndex<T> + 'a>, Vec<Expected>) {
    let (mut scene, mut expected) = (Instances::new(), Vec::<Expected>::new());
    for round in 0..rng.random_range(1..4) {
        let mut edit = scene.edit();
        for _ in 0..rng.random_range(0..4) {
            let (object, motion) = (rng.random_range(0..objects.len()), motion(rng, size));
            if let Ok(id) = edit.add(&format!("{object} of round {round}"), &objects[object].1, motion) {
                expected.push((id, object, motion));
            }
        }
        if rng.random_range(0..3) == 0 && !expected.is_empty() {
            let (id, ..) = expected.remove(rng.random_range(0..expected.len()));
            edit.remove(id).expect("in the scene");
            assert!(edit.remove(id).is_err() && edit.instance(id).is_none());
        }
        drop(edit);
        let mut edit = scene.edit();
        for (id, _, motion) in &mut expected {
            let next = self::motion(rng, size);
            if rng.random_range(0..2) == 0 && edit.set_motion(*id, next).is_ok() {
                *motion = next;
            }
        }
    }
    let ids: Vec<InstanceId> = scene.instances().map(|instance| instance.id()).collect();
    assert_eq!(ids, expected.iter().map(|(id, ..)| *id).collect::<Vec<_>>());
    let mut first = 0;
    for (id, object, motion) in &expected {
        let instance = scene.instance(*id).expect("in the scene");
        assert_eq!((instance.motion(), instance.primitives().start), (motion, first));
        assert!(instance.name().starts_with(&format!("{object} of")));
        for local in (0..objects[*object].0.len()).map(PrimitiveId::new) {
            assert_eq!(scene.instance_of(PrimitiveId::new(first)), Some((*id, local)));
            first += 1;
        }
    }
    assert_eq!((PrimitiveSet::len(&scene), scene.instance_of(PrimitiveId::new(first))), (first, None));
    (scene, expected)
}

/// Returns all fields but the lower bound, which depends on what a search evaluates.
pub(crate) fn fields(pair: Option<ClosestPair<f64>>) -> Option<ClosestPair<f64>> {
    pair.map(|mut pair| {
        pair.lower_bound = 0.0;
        pair
    })
}

/// Returns the pairs of ids within the distance of the options, with the bits of their distances.
pub(crate) fn within(
    a: &impl PairQuery<f64>,
    b: &impl PairQuery<f64>,
    options: &PairOptions<f64>,
) -> Vec<([PrimitiveId; 2], u64)> {
    let mut found = Vec::new();
    let _ = a.visit_pairs_within(b, options, &mut |pair| {
        found.push((pair.primitives, pair.distance.to_bits()));
        ControlFlow::Continue(())
    });
    found.sort_unstable();
    found
}
