//! The choice of the directions of a k-DOP tree at run time.
//!
//! In the library the number of faces K is a const parameter. [`KdopVisitor`] turns a number that is known at run time
//! into that parameter.

use p2m_bvh::SplitOptions;
use p2m_core::storage::{self, LoadError, Reader, Writer};
use p2m_core::{BuildError, PrimitiveSet, Real};
use p2m_kdop::{DirectionChoice, Directions, KdopOptions, KdopTree};

/// The prefix of the kinds of k-DOP trees in saved files.
const KIND_PREFIX: &str = "kdop-";
/// The section of a saved file with the reason for the directions that were chosen for the scene.
const REASON_SECTION: &str = "kdop/choice";
/// The numbers of faces that a tree may have.
const FACE_COUNTS: [usize; 4] = [6, 14, 18, 26];

/// The directions of the faces of k-DOPs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KdopDirections {
    /// Three pairs of faces along the axes: the k-DOPs are boxes.
    Six,
    /// The faces of boxes, and four pairs that cut off their corners.
    Fourteen,
    /// The faces of boxes, and six pairs that cut off their edges.
    Eighteen,
    /// The faces of boxes, and ten pairs that cut off their corners and edges.
    TwentySix,
    /// Fourteen faces along the axes or along a frame of the scene's own.
    Scene,
}

/// The directions that a k-DOP tree was built with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChosenDirections {
    /// The number of faces of each k-DOP.
    pub faces: usize,
    /// The reason for these directions, as a sentence for people; `None` if they were not derived from the scene.
    pub reason: Option<String>,
}

impl ChosenDirections {
    /// Adds the reason to a file, if there is one.
    pub fn save(&self, writer: &mut Writer<'_>) {
        if let Some(reason) = &self.reason {
            writer.put_copy(REASON_SECTION, reason.as_bytes());
        }
    }

    /// Returns the directions of a saved tree with this number of faces, with the reason
    /// that [`save`](Self::save) wrote.
    #[must_use]
    pub fn of_saved(faces: usize, reader: &Reader) -> Self {
        let reason = reader.copy::<u8>(REASON_SECTION).ok().map(|text| String::from_utf8_lossy(&text).into_owned());
        Self { faces, reason }
    }
}

/// A function of a k-DOP tree over a set `S`, which is compiled once for each K.
pub trait KdopVisitor<S, T: Real = f64> {
    /// The result of the visit.
    type Output;
    /// Receives the tree.
    fn visit<const K: usize>(self, tree: KdopTree<T, S, K>) -> Self::Output;
}

impl KdopDirections {
    /// All values: the axes in order of the number of faces, and the choice by the scene last.
    pub const ALL: [Self; 5] = [Self::Six, Self::Fourteen, Self::Eighteen, Self::TwentySix, Self::Scene];

    /// The number of faces.
    #[must_use]
    pub const fn faces(self) -> usize {
        match self {
            Self::Six => 6,
            Self::Fourteen | Self::Scene => 14,
            Self::Eighteen => 18,
            Self::TwentySix => 26,
        }
    }

    /// Returns the number of faces of the tree in a saved file, if there is one and it has the requested directions.
    ///
    /// Without a request every tree fits. A tree whose directions were derived from its scene does not fit a request
    /// for a number of faces.
    #[must_use]
    pub fn saved_faces(requested: Option<Self>, reader: &Reader) -> Option<usize> {
        let kind = storage::kind(reader).ok()?;
        let faces = kind.strip_prefix(KIND_PREFIX)?.parse().ok().filter(|faces| FACE_COUNTS.contains(faces))?;
        let is_from_scene = reader.has(REASON_SECTION);
        let fits = requested.is_none_or(|directions| {
            is_from_scene == (directions == Self::Scene) && (is_from_scene || directions.faces() == faces)
        });
        fits.then_some(faces)
    }

    /// Loads a tree with this number of faces from a file, and passes it to the visitor.
    ///
    /// # Errors
    /// The errors of [`TreeIndex::load`](p2m_bvh::TreeIndex::load).
    pub fn load<S: PrimitiveSet<f64>, V: KdopVisitor<S>>(
        faces: usize,
        set: S,
        reader: &Reader,
        visitor: V,
    ) -> Result<(V::Output, ChosenDirections), LoadError> {
        let output = match faces {
            6 => visitor.visit::<6>(KdopTree::load(set, reader)?),
            14 => visitor.visit::<14>(KdopTree::load(set, reader)?),
            18 => visitor.visit::<18>(KdopTree::load(set, reader)?),
            _ => visitor.visit::<26>(KdopTree::load(set, reader)?),
        };
        Ok((output, ChosenDirections::of_saved(faces, reader)))
    }

    /// Builds a tree with these directions, and passes it to the visitor.
    ///
    /// # Errors
    /// The errors of [`TreeIndex::build_with`](p2m_bvh::TreeIndex::build_with).
    pub fn build<T: Real, S: PrimitiveSet<T> + Sync, V: KdopVisitor<S, T>>(
        self,
        set: S,
        splits: SplitOptions,
        visitor: V,
    ) -> Result<(V::Output, ChosenDirections), BuildError> {
        let choice = (self == Self::Scene).then(|| DirectionChoice::from_scene(&set)).transpose()?;
        let output = match self.faces() {
            6 => build_tree::<6, _, _, _>(set, splits, choice.as_ref(), visitor),
            14 => build_tree::<14, _, _, _>(set, splits, choice.as_ref(), visitor),
            18 => build_tree::<18, _, _, _>(set, splits, choice.as_ref(), visitor),
            _ => build_tree::<26, _, _, _>(set, splits, choice.as_ref(), visitor),
        }?;
        let faces = self.faces();
        Ok((output, ChosenDirections { faces, reason: choice.map(|choice| format!("{faces} {choice}")) }))
    }
}

fn build_tree<const K: usize, T: Real, S: PrimitiveSet<T> + Sync, V: KdopVisitor<S, T>>(
    set: S,
    splits: SplitOptions,
    choice: Option<&DirectionChoice>,
    visitor: V,
) -> Result<V::Output, BuildError>
where
    Directions<K>: Default,
{
    let directions = choice.map(|choice| choice.directions::<K>().expect("a choice has directions of every K here"));
    let options = KdopOptions::new(directions.unwrap_or_default()).with_splits(splits);
    KdopTree::build_with(set, &options).map(|tree| visitor.visit(tree))
}
