//! Questions about what is near, on any index, against the primitives one by one.

use crate::rng;
use nalgebra::Point3;
use p2m_core::{
    Closest, ClosestPoint, Feature, NearQuery, Primitive, PrimitiveId, PrimitiveSet, Projection, QueryOptions, Real,
    Soup,
};
use rand::RngExt;
use std::ops::ControlFlow;

/// All primitives with their nearest points, nearest first.
fn sorted<T: Real>(soup: &Soup<T>, query: &Point3<T>) -> Vec<(PrimitiveId, Projection)> {
    let ids = (0..soup.len()).map(PrimitiveId::new);
    let mut all: Vec<_> = ids.map(|id| (id, soup.get(id).project(query))).collect();
    all.sort_by(|a, b| a.1.key.cmp(&b.1.key).then(a.0.cmp(&b.0)));
    all
}

/// Everything of an answer but its bound.
type Known<T> = (PrimitiveId, T, Point3<T>, Feature, [T; 3]);

fn known<T: Real>(closest: &Closest<T>) -> Known<T> {
    (closest.primitive, closest.distance, closest.point, closest.feature, closest.barycentric)
}

fn expected<T: Real>((id, projection): &(PrimitiveId, Projection)) -> Known<T> {
    let point = projection.point.map(T::of_f64);
    (*id, T::of_f64(projection.key.distance()), point, projection.feature, projection.barycentric.map(T::of_f64))
}

/// Whether an index over a soup answers every question of [`NearQuery`] as its primitives do one by one, number for number.
///
/// # Panics
/// If it does not.
pub fn agrees<T: Real>(
    seed: u64,
    soup: &Soup<T>,
    queries: &[Point3<T>],
    index: &(impl NearQuery<T> + ClosestPoint<T> + ?Sized),
) {
    let mut rng = rng("near options", seed);
    for (i, q) in queries.iter().enumerate() {
        let say = || format!("seed {seed}, query {i} {q:?}");
        let all = sorted(soup, q);
        let exactly = |expected_of: &[(PrimitiveId, Projection)], found: &[Closest<T>]| {
            assert_eq!(
                found.iter().map(known).collect::<Vec<_>>(),
                expected_of.iter().map(expected).collect::<Vec<_>>(),
                "{}",
                say()
            );
            for (closest, (_, projection)) in found.iter().zip(expected_of) {
                // Its own distance less its own error, but for some roundings; finite where the distance is.
                let least = projection.key.distance().min(f64::MAX) - projection.error;
                let most = T::of_f64(least * (1.0 - 32.0 * T::UNIT_ROUNDOFF)) - T::of_f64(4.0 * T::SMALLEST_SUBNORMAL);
                let bound = closest.lower_bound;
                assert!(bound <= closest.distance && bound.to_f64() <= least.max(0.0), "{}: {bound:?}", say());
                assert!(bound >= most, "{}: {bound:?}, not {most:?}", say());
            }
        };
        let k = [0, 1, 2, 7, soup.len() / 2, soup.len(), soup.len() + 3][rng.random_range(0..7)];
        exactly(&all[..k.min(all.len())], &index.k_nearest(q, k, T::INFINITY));

        // The radius is the distance of some primitive, or beside it.
        let some = all.get(rng.random_range(0..all.len().clamp(1, 40)));
        let radius = some.map_or(T::one(), |(_, p)| T::of_f64(p.key.distance()));
        let radius = [radius, radius * T::of_f64(0.99), radius * T::of_f64(1.01)][rng.random_range(0..3)];
        let count = all.iter().take_while(|(_, p)| T::of_f64(p.key.distance()) <= radius).count();
        let within = index.all_within(q, radius);
        exactly(&all[..count], &within);
        exactly(&all[..count.min(k)], &index.k_nearest(q, k, radius));
        assert_eq!(index.is_any_within(q, radius), count > 0, "{}", say());
        let options = QueryOptions::default().with_max_distance(radius);
        assert_eq!(within.first().map(known), index.closest_point_with(q, &options).as_ref().map(known), "{}", say());
        {
            let mut visited = Vec::new();
            let flow = index.visit_within(q, radius, &mut |closest| {
                visited.push(*closest);
                ControlFlow::Continue(())
            });
            visited.sort_by_key(|c| within.iter().position(|other| other.primitive == c.primitive));
            assert!(flow.is_continue() && visited == within, "{}", say());
            // An end, and nothing after it.
            let (mut rest, end) = (3, count >= 3);
            let flow = index.visit_within(q, radius, &mut |_| {
                rest -= 1;
                if rest == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            assert_eq!((flow.is_break(), rest), (end, if end { 0 } else { 3 - count }), "{}", say());
        }

        let odd = |id: PrimitiveId| (id.index() as u64 * 7 + seed).is_multiple_of(5);
        let first = all[..count].iter().find(|(id, _)| odd(*id)).map(expected);
        let found = index.closest_point_among(q, &options, &mut |id| odd(id));
        assert_eq!(found.as_ref().map(known), first, "{}", say());
        assert_eq!(index.closest_point_among(q, &options, &mut |_| false), None);
    }
}
