//! Checks an interception index against brute force with every instruction set.

use nalgebra::Point3;
use p2m_core::{BruteForce, Closest, ClosestPoint, Isa, PrimitiveSet, Real};
use p2m_interception::{InterceptionIndex, Partition};

/// Checks that an index returns the same distance bits and primitive as brute force, with each instruction set, one
/// query at a time and interleaved. `name` stands in the message of a failure.
pub(super) fn agrees<T: Real, S: PrimitiveSet<T> + Sync + Copy, P: Partition + Sync>(
    name: &str,
    set: S,
    mut index: InterceptionIndex<T, S, P>,
    queries: &[Point3<T>],
) {
    let brute = BruteForce::new(set).expect("valid");
    let key = |c: Closest<T>| (c.distance.to_f64().to_bits(), c.primitive);
    let expected: Vec<_> = queries.iter().map(|q| brute.closest_point(q).map(key)).collect();
    for isa in Isa::available() {
        index = index.with_isa(isa);
        let mut interleaved = vec![None; queries.len()];
        index.closest_points_into(queries, &Default::default(), &mut interleaved);
        for ((q, interleaved), expected) in queries.iter().zip(interleaved).zip(&expected) {
            assert_eq!(index.closest_point(q).map(key), *expected, "{name} {isa} {q:?}");
            assert_eq!(interleaved.map(key), *expected, "{name} {isa} interleaved {q:?}");
        }
    }
}
