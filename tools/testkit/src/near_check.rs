//! Comparison of an index's answers about near primitives with those of the primitives one by one.

use crate::rng;
use nalgebra::Point3;
use p2m_core::{
    Closest, ClosestPoint, Feature, NearQuery, Primitive, PrimitiveId, PrimitiveSet, Projection, QueryOptions, Real,
    Soup,
};
use rand::RngExt;
use std::ops::ControlFlow;

/// Returns all primitives with their projections, nearest first.
fn sorted<T: Real>(soup: &Soup<T>, query: &Point3<T>) -> Vec<(PrimitiveId, Projection)> {
    let ids = (0..soup.len()).map(PrimitiveId::new);
    let mut all: Vec<_> = ids.map(|id| (id, soup.get(id).project(query))).collect();
    all.sort_by(|a, b| a.1.key.cmp(&b.1.key).then(a.0.cmp(&b.0)));
    all
}

/// The fields of an answer that are compared exactly: all except the lower bound.
pub type ComparedFields<T> = (PrimitiveId, T, Point3<T>, Feature, [T; 3]);

/// Returns the fields of an answer that every exact backend has to return: all except the certified bound, which
/// depends on the candidates that were evaluated.
#[must_use]
pub fn compared_fields<T: Real>(closest: &Closest<T>) -> ComparedFields<T> {
    (closest.primitive, closest.distance, closest.point, closest.feature, closest.barycentric)
}

fn expected<T: Real>((id, projection): &(PrimitiveId, Projection)) -> ComparedFields<T> {
    let point = projection.point.map(T::round_from_f64);
    (
        *id,
        T::round_from_f64(projection.key.distance()),
        point,
        projection.feature,
        projection.barycentric.map(T::round_from_f64),
    )
}

/// Checks that every method of [`NearQuery`] gives the same numbers for an index over a soup as for its primitives one
/// by one.
///
/// # Panics
/// Panics if an answer differs.
pub fn agrees<T: Real>(
    seed: u64,
    soup: &Soup<T>,
    queries: &[Point3<T>],
    index: &(impl NearQuery<T> + ClosestPoint<T> + ?Sized),
) {
    let mut rng = rng("near options", seed);
    for (i, q) in queries.iter().enumerate() {
        let context = || format!("seed {seed}, query {i} {q:?}");
        let all = sorted(soup, q);
        let exactly = |expected_of: &[(PrimitiveId, Projection)], found: &[Closest<T>]| {
            assert_eq!(
                found.iter().map(compared_fields).collect::<Vec<_>>(),
                expected_of.iter().map(expected).collect::<Vec<_>>(),
                "{}",
                context()
            );
            for (closest, (_, projection)) in found.iter().zip(expected_of) {
                // The lower bound is the primitive's own distance minus its error, up to a few roundings. It is finite
                // if the distance is.
                let exact_bound = projection.key.distance().min(f64::MAX) - projection.error;
                let min_bound = T::round_from_f64(exact_bound * (1.0 - 32.0 * T::UNIT_ROUNDOFF))
                    - T::round_from_f64(4.0 * T::SMALLEST_SUBNORMAL);
                let bound = closest.lower_bound;
                assert!(
                    bound <= closest.distance && bound.to_f64() <= exact_bound.max(0.0),
                    "{}: {bound:?}",
                    context()
                );
                assert!(bound >= min_bound, "{}: {bound:?}, not {min_bound:?}", context());
            }
        };
        let k = [0, 1, 2, 7, soup.len() / 2, soup.len(), soup.len() + 3][rng.random_range(0..7)];
        exactly(&all[..k.min(all.len())], &index.k_nearest(q, k, T::INFINITY));

        // The radius equals the distance of some primitive, or differs slightly.
        let reference = all.get(rng.random_range(0..all.len().clamp(1, 40)));
        let radius = reference.map_or(T::one(), |(_, p)| T::round_from_f64(p.key.distance()));
        let radius =
            [radius, radius * T::round_from_f64(0.99), radius * T::round_from_f64(1.01)][rng.random_range(0..3)];
        let count = all.iter().take_while(|(_, p)| T::round_from_f64(p.key.distance()) <= radius).count();
        let within = index.all_within(q, radius);
        exactly(&all[..count], &within);
        exactly(&all[..count.min(k)], &index.k_nearest(q, k, radius));
        assert_eq!(index.is_any_within(q, radius), count > 0, "{}", context());
        let options = QueryOptions::default().with_max_distance(radius);
        assert_eq!(
            within.first().map(compared_fields),
            index.closest_point_with(q, &options).as_ref().map(compared_fields),
            "{}",
            context()
        );
        {
            let mut visited = Vec::new();
            let flow = index.visit_within(q, radius, &mut |closest| {
                visited.push(*closest);
                ControlFlow::Continue(())
            });
            visited.sort_by_key(|c| within.iter().position(|other| other.primitive == c.primitive));
            assert!(flow.is_continue() && visited == within, "{}", context());
            // The iterator has to end, and to remain at its end.
            let (mut rest, end) = (3, count >= 3);
            let flow = index.visit_within(q, radius, &mut |_| {
                rest -= 1;
                if rest == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            assert_eq!((flow.is_break(), rest), (end, if end { 0 } else { 3 - count }), "{}", context());
        }

        let odd = |id: PrimitiveId| (id.index() as u64 * 7 + seed).is_multiple_of(5);
        let first = all[..count].iter().find(|(id, _)| odd(*id)).map(expected);
        let found = index.closest_point_among(q, &options, &mut |id| odd(id));
        assert_eq!(found.as_ref().map(compared_fields), first, "{}", context());
        assert_eq!(index.closest_point_among(q, &options, &mut |_| false), None);
    }
}
