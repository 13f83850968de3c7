//! Saving and loading of indexes, with their kind and a fingerprint of the set over which they were built.

use super::error::LoadError;
use super::reader::Reader;
use super::writer::Writer;
use crate::real::to_f64_array;
use crate::{Primitive, PrimitiveId, PrimitiveSet, Real};
use nalgebra::Point3;
use std::hash::Hasher;
use twox_hash::XxHash3_64;

/// The structure of an index that can be saved, without its set.
pub trait Saved: Sized {
    /// Returns the kind of the index, for example `aabb`, `kdop-14`, `octree` or `p2m`.
    fn kind() -> String;

    /// Adds the sections of the index to a file.
    fn save<'a>(&'a self, writer: &mut Writer<'a>);

    /// Creates the index from the sections of a file, without copying large arrays. The index is over a set of
    /// `primitives` primitives.
    ///
    /// A file may come from anyone, so an implementation validates everything that searches need in order not to panic
    /// and not to loop forever.
    ///
    /// # Errors
    /// It returns [`LoadError::Missing`] for a section that is missing, and [`LoadError::Inconsistent`] for sections
    /// that contradict themselves or each other.
    fn load(reader: &Reader, primitives: usize) -> Result<Self, LoadError>;
}

/// The section with the kind of the index, in UTF-8.
const KIND: &str = "index/kind";
/// The section with the number of primitives and the fingerprint of the set.
const SET: &str = "index/set";

/// Adds an index to a file, with a fingerprint of its set.
///
/// # Panics
/// It panics if the file has an index already.
pub fn save<'a, T: Real, S: PrimitiveSet<T> + ?Sized, I: Saved>(index: &'a I, set: &S, writer: &mut Writer<'a>) {
    assert!(!writer.has(KIND), "a file has one index");
    writer.put_copy(KIND, I::kind().as_bytes());
    writer.put_copy(SET, &[[set.len() as u64, fingerprint(set)]]);
    index.save(writer);
}

/// Loads an index that was built over an equal set. Primitives of your own count as equal if their boxes are equal, and
/// so are their closest points to the corners of the box of the set.
///
/// # Errors
/// It returns [`LoadError::OtherKind`] for an index of another kind, [`LoadError::OtherSet`] for an index over another
/// set, and the errors of [`Saved::load`].
pub fn load<T: Real, S: PrimitiveSet<T> + ?Sized, I: Saved>(set: &S, reader: &Reader) -> Result<I, LoadError> {
    let (found, expected) = (kind(reader)?, I::kind());
    if found != expected {
        return Err(LoadError::OtherKind { found, expected });
    }
    if reader.one::<[u64; 2]>(SET)? != [set.len() as u64, fingerprint(set)] {
        return Err(LoadError::OtherSet);
    }
    I::load(reader, set.len())
}

/// Returns the kind of the index in a file, as [`Saved::kind`] gives it.
///
/// # Errors
/// It returns [`LoadError::Missing`] if the file has no index.
pub fn kind(reader: &Reader) -> Result<String, LoadError> {
    Ok(String::from_utf8_lossy(&reader.copy::<u8>(KIND)?).into_owned())
}

/// Returns an XXH3 hash of the vertices of all primitives. For primitives of your own it covers their boxes, and their
/// closest points to the corners of the box of the set.
fn fingerprint<T: Real, S: PrimitiveSet<T> + ?Sized>(set: &S) -> u64 {
    let mut hasher = XxHash3_64::new();
    let bounds = set.aabb();
    let corners: [Point3<T>; 8] = std::array::from_fn(|i| {
        Point3::from(std::array::from_fn(|k| if i >> k & 1 == 0 { bounds.min[k] } else { bounds.max[k] }))
    });
    for id in (0..set.len()).map(PrimitiveId::new) {
        let primitive = set.get(id);
        let vertices = primitive.vertices();
        // The numbers are those of at most three vertices, or of two corners of a box; the last one says which.
        let mut numbers = [0.0; 10];
        if vertices.is_empty() || vertices.len() > 3 {
            let bounds = primitive.aabb();
            numbers[..3].copy_from_slice(&to_f64_array(&bounds.min));
            numbers[3..6].copy_from_slice(&to_f64_array(&bounds.max));
            numbers[9] = -1.0;
            for corner in &corners {
                let point: [f64; 3] = primitive.project(corner).point.coords.into();
                hasher.write(bytemuck::bytes_of(&point));
            }
        } else {
            for (to, vertex) in numbers.as_chunks_mut().0.iter_mut().zip(vertices) {
                *to = to_f64_array(vertex);
            }
            numbers[9] = vertices.len() as f64;
        }
        hasher.write(bytemuck::bytes_of(&numbers));
    }
    hasher.finish()
}
