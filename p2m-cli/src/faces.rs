//! `--k`: how many faces the polytopes of a k-DOP tree have, which is a type in the library.

use crate::usage::usage;
use clap::ValueEnum;
use p2m_core::storage::{self, LoadError, Reader, Writer};
use p2m_core::{BuildError, Soup};
use p2m_kdop::{DirectionChoice, KdopOptions, KdopTree};

/// How the kinds of k-DOP trees begin.
const KIND: &str = "kdop-";
/// The section of a file that says why the directions of a scene are these.
const CHOICE: &str = "kdop/choice";

/// The faces of k-DOPs.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Faces {
    /// Boxes along the axes
    #[value(name = "6")]
    Six,
    /// Boxes with their corners cut off
    #[value(name = "14")]
    Fourteen,
    /// Boxes with their edges cut off
    #[value(name = "18")]
    Eighteen,
    /// Boxes with both cut off
    #[value(name = "26")]
    TwentySix,
    /// As many as the scene is worth, along the axes or turned with it: the summary says which and why
    Scene,
}

/// The faces that were used.
pub(crate) struct Used {
    /// How many.
    pub(crate) k: usize,
    /// Why these, if the scene was asked.
    pub(crate) choice: Option<String>,
}

impl Used {
    /// Adds to a file why these were chosen.
    pub(crate) fn save(&self, writer: &mut Writer<'_>) {
        if let Some(choice) = &self.choice {
            writer.put_copy(CHOICE, choice.as_bytes());
        }
    }
}

/// How many faces k-DOPs have, if that was said.
///
/// # Errors
/// If it was, and this is another backend.
pub(crate) fn only_for(is_kdop: bool, k: Option<Faces>) -> anyhow::Result<Option<Faces>> {
    if k.is_some() && !is_kdop { Err(usage("--k is for --backend kdop")) } else { Ok(k) }
}

/// What to do with a tree, whatever its K.
pub(crate) trait WithTree<'a> {
    type Output;
    fn with<const K: usize>(self, tree: KdopTree<f64, &'a Soup<f64>, K>) -> Self::Output;
}

impl Faces {
    /// How many there are, if that does not depend on the scene.
    pub(crate) fn k(self) -> Option<usize> {
        match self {
            Self::Six => Some(6),
            Self::Fourteen => Some(14),
            Self::Eighteen => Some(18),
            Self::TwentySix => Some(26),
            Self::Scene => None,
        }
    }

    /// How many the tree has that a file keeps, if there is one, and these are what is wanted. Where nothing is wanted
    /// any tree will do, and where a number is, not one whose directions are those of the scene.
    pub(crate) fn of_saved(wanted: Option<Self>, reader: &Reader) -> Option<usize> {
        let kind = storage::kind(reader).ok()?;
        let k = kind.strip_prefix(KIND)?.parse().ok().filter(|k| [6, 14, 18, 26].contains(k))?;
        let of_scene = reader.has(CHOICE);
        let fits = wanted.is_none_or(|faces| if of_scene { faces == Self::Scene } else { faces.k() == Some(k) });
        fits.then_some(k)
    }

    /// Takes a tree of so many from a file.
    pub(crate) fn load<'a, W: WithTree<'a>>(
        k: usize,
        soup: &'a Soup<f64>,
        reader: &Reader,
        what: W,
    ) -> Result<(W::Output, Used), LoadError> {
        let output = match k {
            6 => what.with::<6>(KdopTree::load(soup, reader)?),
            14 => what.with::<14>(KdopTree::load(soup, reader)?),
            18 => what.with::<18>(KdopTree::load(soup, reader)?),
            _ => what.with::<26>(KdopTree::load(soup, reader)?),
        };
        let choice = reader.copy::<u8>(CHOICE).ok().map(|text| String::from_utf8_lossy(&text).into_owned());
        Ok((output, Used { k, choice }))
    }

    /// Builds the tree.
    pub(crate) fn build<'a, W: WithTree<'a>>(
        self,
        soup: &'a Soup<f64>,
        what: W,
    ) -> Result<(W::Output, Used), BuildError> {
        let choice = (self == Self::Scene).then(|| DirectionChoice::from_scene(soup)).transpose()?;
        let k = self.k().unwrap_or_else(|| choice.as_ref().map_or(6, |choice| choice.k));
        let output = match k {
            6 => build::<6, _>(soup, choice.as_ref(), what),
            14 => build::<14, _>(soup, choice.as_ref(), what),
            18 => build::<18, _>(soup, choice.as_ref(), what),
            _ => build::<26, _>(soup, choice.as_ref(), what),
        }?;
        Ok((output, Used { k, choice: choice.map(|choice| choice.to_string()) }))
    }
}

fn build<'a, const K: usize, W: WithTree<'a>>(
    soup: &'a Soup<f64>,
    choice: Option<&DirectionChoice>,
    what: W,
) -> Result<W::Output, BuildError>
where
    p2m_kdop::Directions<K>: Default,
{
    let own = choice.map(|choice| choice.directions::<K>().expect("a choice of as many"));
    KdopTree::build_with(soup, &KdopOptions::new(own.unwrap_or_default())).map(|tree| what.with(tree))
}
