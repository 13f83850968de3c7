//! `--k`: how many faces the polytopes of a k-DOP tree have, which is a type in the library.

use clap::ValueEnum;
use p2m_core::{BuildError, Soup};
use p2m_kdop::{Choice, KdopOptions, KdopTree};

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

/// What to do with a tree, whatever its K.
pub(crate) trait WithTree<'a> {
    type Output;
    fn with<const K: usize>(self, tree: KdopTree<f64, &'a Soup<f64>, K>) -> Self::Output;
}

impl Faces {
    /// Builds the tree.
    pub(crate) fn build<'a, W: WithTree<'a>>(
        self,
        soup: &'a Soup<f64>,
        what: W,
    ) -> Result<(W::Output, Used), BuildError> {
        let choice = (self == Self::Scene).then(|| Choice::from_scene(soup)).transpose()?;
        let k = match self {
            Self::Six => 6,
            Self::Fourteen => 14,
            Self::Eighteen => 18,
            Self::TwentySix => 26,
            Self::Scene => choice.as_ref().map_or(6, |choice| choice.k),
        };
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
    choice: Option<&Choice>,
    what: W,
) -> Result<W::Output, BuildError>
where
    p2m_core::Directions<K>: Default,
{
    let own = choice.map(|choice| choice.directions::<K>().expect("a choice of as many"));
    KdopTree::build_with(soup, &KdopOptions::new(own.unwrap_or_default())).map(|tree| what.with(tree))
}
