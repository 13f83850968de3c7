//! Indexes and scenes as serde values.
//!
//! An index is serialised as its scene and the bytes of its saved file, so all checks for loading a file apply here as
//! well.

use super::{Saved, SavedFile, Writer, load, save};
use crate::real::to_f64_array;
use crate::{Element, PrimitiveSet, Real, Soup};
use nalgebra::Point3;
use serde::de::Error as _;
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The serialised form of an index and its scene.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Index")]
struct IndexForm<S> {
    scene: S,
    /// The bytes of the saved file.
    #[serde(with = "serde_bytes")]
    index: Vec<u8>,
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
    IndexForm { scene: set, index: bytes }.serialize(serializer)
}

/// Deserialises an index and its scene.
///
/// # Errors
/// It returns the errors of the deserialiser, and the errors of loading a file with a wrong checksum, another kind of
/// index or another scene.
pub fn deserialize_index<'de, T: Real, S: PrimitiveSet<T> + Deserialize<'de>, I: Saved, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<(S, I), D::Error> {
    let IndexForm { scene, index }: IndexForm<S> = IndexForm::deserialize(deserializer)?;
    let file = SavedFile::read(&*index).map_err(D::Error::custom)?;
    let index = load(&scene, file.checked().map_err(D::Error::custom)?).map_err(D::Error::custom)?;
    Ok((scene, index))
}

/// The serialised form of a soup. Coordinates are stored as the bits of f64: text formats may round decimals, and have
/// none for NaN, which a position that no primitive uses may be.
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
