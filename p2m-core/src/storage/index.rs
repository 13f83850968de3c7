//! Which index a file has, and over which set.

use super::{LoadError, Reader, Writer};
use crate::real::to_f64_array;
use crate::{Primitive, PrimitiveId, PrimitiveSet, Real};
use nalgebra::Point3;
use std::hash::Hasher;
use twox_hash::XxHash3_64;

/// What can be saved: the structure of an index, without the set that it was built over.
pub trait Saved: Sized {
    /// Which one it is: `aabb`, `kdop-14`, `octree` or `p2m`.
    fn kind() -> String;

    /// Adds its sections to a file.
    fn save<'a>(&'a self, writer: &mut Writer<'a>);

    /// Takes it from the sections of a file; arrays stay where they are.
    ///
    /// # Errors
    /// [`LoadError::Missing`] and [`LoadError::Inconsistent`].
    fn load(reader: &Reader) -> Result<Self, LoadError>;
}

const KIND: &str = "index/kind";
const SET: &str = "index/set";

/// Adds an index, and what tells whether another set is the same.
///
/// # Panics
/// If the file has an index already.
pub fn save<'a, T: Real, S: PrimitiveSet<T> + ?Sized, I: Saved>(index: &'a I, set: &S, writer: &mut Writer<'a>) {
    assert!(!writer.has(KIND), "a file has one index");
    writer.put_copy(KIND, I::kind().as_bytes());
    writer.put_copy(SET, &[[set.len() as u64, fingerprint(set)]]);
    index.save(writer);
}

/// Takes an index that was built over an equal set. Primitives of your own are equal if their boxes are, and their
/// closest points for the corners of the box of the set.
///
/// # Errors
/// [`LoadError::OtherKind`], [`LoadError::OtherSet`], and what [`Saved::load`] says.
pub fn load<T: Real, S: PrimitiveSet<T> + ?Sized, I: Saved>(set: &S, reader: &Reader) -> Result<I, LoadError> {
    let (found, expected) = (kind(reader)?, I::kind());
    if found != expected {
        return Err(LoadError::OtherKind { found, expected });
    }
    if reader.one::<[u64; 2]>(SET)? != [set.len() as u64, fingerprint(set)] {
        return Err(LoadError::OtherSet);
    }
    I::load(reader)
}

/// Which index a file has, as [`Saved::kind`].
///
/// # Errors
/// [`LoadError::Missing`].
pub fn kind(reader: &Reader) -> Result<String, LoadError> {
    Ok(String::from_utf8_lossy(&reader.copy::<u8>(KIND)?).into_owned())
}

/// XXH3 of all vertices; of primitives of your own that of their boxes, and of the points that are closest to the
/// corners of a box around everything.
fn fingerprint<T: Real, S: PrimitiveSet<T> + ?Sized>(set: &S) -> u64 {
    let mut hasher = XxHash3_64::new();
    let whole = set.aabb();
    let corners: [Point3<T>; 8] = std::array::from_fn(|i| {
        Point3::from(std::array::from_fn(|k| if i >> k & 1 == 0 { whole.min[k] } else { whole.max[k] }))
    });
    for id in (0..set.len()).map(PrimitiveId::new) {
        let primitive = set.get(id);
        let vertices = primitive.vertices();
        // At most three vertices, or the corners of a box, and how many there are.
        let (mut numbers, mut count) = ([0.0; 10], 0);
        if vertices.is_empty() || vertices.len() > 3 {
            let bounds = primitive.aabb();
            for corner in [to_f64_array(&bounds.min), to_f64_array(&bounds.max)] {
                numbers[3 * count..][..3].copy_from_slice(&corner);
                count += 1;
            }
            numbers[9] = -1.0;
            for corner in &corners {
                let point: [f64; 3] = primitive.project(corner).point.coords.into();
                hasher.write(bytemuck::bytes_of(&point));
            }
        } else {
            for vertex in vertices {
                numbers[3 * count..][..3].copy_from_slice(&to_f64_array(vertex));
                count += 1;
            }
            numbers[9] = count as f64;
        }
        hasher.write(bytemuck::bytes_of(&numbers));
    }
    hasher.finish()
}
