//! The subject of a check: an index with its scene and with brute force.

use super::backends::Index;
use nalgebra::Point3;
use p2m::{BruteForce, Closest, Feature, PrimitiveId, PrimitiveSet, Real, Soup};

/// An index, with the scene that it was built over.
pub struct Subject<'a, T: Real> {
    pub soup: &'a Soup<T>,
    pub brute: &'a BruteForce<&'a Soup<T>>,
    pub index: &'a dyn Index<T>,
    pub name: &'static str,
    pub seed: u64,
}

/// All fields of an answer except its lower bound, comparable to the last bit.
pub type ComparedFields = (PrimitiveId, u64, [u64; 3], Feature, [u64; 3]);

/// Returns the fields of an answer that every index has to return.
pub fn compared_fields<T: Real>(c: &Closest<T>) -> ComparedFields {
    let bits = |x: T| x.to_f64().to_bits();
    let point: [T; 3] = c.point.coords.into();
    (c.primitive, bits(c.distance), point.map(bits), c.feature, c.barycentric.map(bits))
}

impl<T: Real> Subject<'_, T> {
    pub fn describe(&self, query: &Point3<T>) -> String {
        format!("{} of {} primitives, {query:?}", self.name, self.soup.len())
    }
}
