//! `--backend`: what searches.

use crate::faces::{Faces, Used, WithTree};
use clap::ValueEnum;
use p2m_bvh::AabbTree;
use p2m_core::{BruteForce, BuildError, BuildIndex, ClosestPoint, RayQuery, Soup};
use p2m_interception::{OctreeReport, P2mReport};
use p2m_kdop::KdopTree;

/// Backends that answer every kind of question.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Search {
    /// Every primitive, every time
    Brute,
    /// A tree of boxes
    Aabb,
    /// A tree of polytopes with --k faces, which fit closer what does not lie along the axes
    Kdop,
}

/// What they build.
pub(crate) trait Index: ClosestPoint<f64> + RayQuery<f64> + Sync {}

impl<I: ClosestPoint<f64> + RayQuery<f64> + Sync> Index for I {}

/// What there is to say about an index.
pub(crate) enum About {
    Nothing,
    /// Of a k-DOP tree.
    Faces(Used),
    /// Of an octree.
    Cubes(OctreeReport),
    /// Of a P2M index.
    Cells(P2mReport),
}

impl Search {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Brute => "brute",
            Self::Aabb => "aabb",
            Self::Kdop => "kdop",
        }
    }

    /// The index, and what there is to say about it.
    pub(crate) fn build(self, soup: &Soup<f64>, faces: Faces) -> Result<(Box<dyn Index + '_>, About), BuildError> {
        Ok(match self {
            Self::Brute => (Box::new(BruteForce::build(soup, &())?), About::Nothing),
            Self::Aabb => (Box::new(AabbTree::build(soup, &Default::default())?), About::Nothing),
            Self::Kdop => {
                let (index, used) = faces.build(soup, AnyTree)?;
                (index, About::Faces(used))
            }
        })
    }
}

/// A k-DOP tree as an index.
struct AnyTree;

impl<'a> WithTree<'a> for AnyTree {
    type Output = Box<dyn Index + 'a>;
    fn with<const K: usize>(self, tree: KdopTree<f64, &'a Soup<f64>, K>) -> Self::Output {
        Box::new(tree)
    }
}
