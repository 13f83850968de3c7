//! The trees of other crates are compared with the contract of our indexes.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use super::{ParryIndex, RstarIndex};
use crate::near_check;
use crate::scenes::{extreme_soups, narrow, queries, random_soups, to_f32};
use nalgebra::Point3;
use p2m_core::{BruteForce, BuildError, BuildIndex, Closest, ClosestPoint, NearQuery, PrimitiveSet, Real, Soup};

macro_rules! adapters {
    ($($name:ident: $index:ident),+ $(,)?) => {
        $(mod $name {
            use super::*;

            #[test]
            fn agrees_on_random_scenes() {
                for (seed, soup) in random_soups(stringify!($name)) {
                    let queries = queries(seed, &soup);
                    agrees::<f64, $index<f64, _>>(seed, &soup, &queries);
                    let single: Vec<_> = queries.into_iter().map(to_f32).collect();
                    agrees::<f32, $index<f32, _>>(seed, &narrow(&soup).expect("fits f32"), &single);
                }
            }

            #[test]
            fn agrees_at_extreme_scales() {
                for (seed, soup, queries) in extreme_soups("scales of adapters") {
                    agrees::<f64, $index<f64, _>>(seed, &soup, &queries);
                }
            }
        })+
    };
}

adapters! {
    parry: ParryIndex,
    rstar: RstarIndex,
}

fn agrees<'a, T: Real, I>(seed: u64, soup: &'a Soup<T>, queries: &[Point3<T>])
where
    I: NearQuery<T> + BuildIndex<T, &'a Soup<T>, Options = (), Error = BuildError>,
{
    let index = I::build(soup, &()).expect("valid scene");
    let brute = BruteForce::new(soup).expect("valid scene");
    let known = |c: Option<Closest<T>>| c.map(|c| (c.point, c.distance, c.primitive, c.feature, c.barycentric));
    for q in queries {
        assert_eq!(known(index.closest_point(q)), known(brute.closest_point(q)), "seed {seed}, {q:?}");
        assert_eq!(index.closest_point(q).is_some(), !soup.is_empty());
    }
    near_check::agrees(seed, soup, queries, &index);
}

/// A set with more primitives than ids, none of which is ever requested.
struct Absurd(usize);

impl PrimitiveSet<f64> for Absurd {
    type Primitive<'a>
        = p2m_core::Point<f64>
    where
        Self: 'a;

    fn len(&self) -> usize {
        self.0
    }
    fn get(&self, id: p2m_core::PrimitiveId) -> p2m_core::Point<f64> {
        panic!("primitive {id} of {} was asked for", self.0)
    }
}

#[test]
fn more_primitives_than_ids_are_an_error_before_anything_else() {
    for len in [(1 << 30) + 1, usize::MAX] {
        assert_eq!(ParryIndex::<f64, _>::build(Absurd(len), &()).err(), Some(BuildError::TooMany { len }));
        assert_eq!(RstarIndex::<f64, _>::build(Absurd(len), &()).err(), Some(BuildError::TooMany { len }));
    }
}
