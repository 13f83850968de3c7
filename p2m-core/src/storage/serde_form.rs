//! Indexes and scenes as values of serde.
//!
//! An index is serialised as its scene and the bytes of its saved file, so whatever is checked when a file is loaded is
//! checked here as well.

use super::{Saved, SavedFile, Writer, load, save};
use crate::real::to_f64_array;
use crate::{Element, PrimitiveSet, Real, Soup};
use nalgebra::Point3;
use serde::de::{Error as _, Visitor};
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;

/// An index and its scene, in the form that is serialised.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Index")]
struct IndexForm<'a, S> {
    scene: S,
    index: Bytes<'a>,
}

/// Bytes, which binary formats store as such.
struct Bytes<'a>(Cow<'a, [u8]>);

impl Serialize for Bytes<'_> {
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        serializer.serialize_bytes(&self.0)
    }
}

impl<'de> Deserialize<'de> for Bytes<'_> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Collect;
        impl<'de> Visitor<'de> for Collect {
            type Value = Vec<u8>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the bytes of a saved index")
            }
            fn visit_bytes<E>(self, bytes: &[u8]) -> Result<Vec<u8>, E> {
                Ok(bytes.to_vec())
            }
            fn visit_byte_buf<E>(self, bytes: Vec<u8>) -> Result<Vec<u8>, E> {
                Ok(bytes)
            }
            // Formats of text have sequences of numbers instead of bytes.
            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut sequence: A) -> Result<Vec<u8>, A::Error> {
                let mut bytes = Vec::new();
                while let Some(byte) = sequence.next_element()? {
                    bytes.push(byte);
                }
                Ok(bytes)
            }
        }
        Ok(Self(Cow::Owned(deserializer.deserialize_byte_buf(Collect)?)))
    }
}

/// Serialises an index with its scene.
///
/// # Errors
/// It returns the errors of the serialiser.
pub fn serialize_index<T: Real, S: PrimitiveSet<T> + Serialize, I: Saved, Z: Serializer>(
    index: &I,
    set: &S,
    serializer: Z,
) -> Result<Z::Ok, Z::Error> {
    let mut writer = Writer::default();
    save(index, set, &mut writer);
    let mut bytes = Vec::new();
    writer.write(&mut bytes).map_err(Z::Error::custom)?;
    IndexForm { scene: set, index: Bytes(Cow::Owned(bytes)) }.serialize(serializer)
}

/// Deserialises an index and its scene.
///
/// # Errors
/// It returns the errors of the deserialiser, and those of loading a file with a wrong checksum, another kind of index
/// or another scene.
pub fn deserialize_index<'de, T: Real, S: PrimitiveSet<T> + Deserialize<'de>, I: Saved, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<(S, I), D::Error> {
    let IndexForm { scene, index }: IndexForm<'_, S> = IndexForm::deserialize(deserializer)?;
    let file = SavedFile::read(&*index.0).map_err(D::Error::custom)?;
    let index = load(&scene, file.checked().map_err(D::Error::custom)?).map_err(D::Error::custom)?;
    Ok((scene, index))
}

/// A soup in the form that is serialised. Coordinates are the bits of f64, since formats of text may round decimals and
/// have none for NaN, which a position that no primitive uses may be.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Soup")]
struct SoupForm {
    positions: Vec<[u64; 3]>,
    elements: Vec<Element>,
}

impl<T: Real> Serialize for Soup<T> {
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        let positions = self.positions().iter().map(|p| to_f64_array(p).map(f64::to_bits)).collect();
        SoupForm { positions, elements: self.elements().collect() }.serialize(serializer)
    }
}

impl<'de, T: Real> Deserialize<'de> for Soup<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let SoupForm { positions, elements } = SoupForm::deserialize(deserializer)?;
        let position = |bits: [u64; 3]| Point3::from(bits.map(|x| T::round_from_f64(f64::from_bits(x))));
        Self::new(positions.into_iter().map(position).collect(), elements).map_err(D::Error::custom)
    }
}
