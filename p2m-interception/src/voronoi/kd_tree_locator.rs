//! The locator of the paper: a KD-tree of the sites.

use crate::voronoi::locator::{Locator, LocatorSites};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use std::sync::Arc;

/// A locator that keeps the sites in a KD-tree of the crate `kiddo` \[Zong2023\].
///
/// A search descends to the leaf whose part of space contains the query point and returns the nearest of the at most
/// 32 sites in it. It does not backtrack to other leaves, because the walk over Delaunay neighbours goes on from any
/// site to the nearest one. Far from the scene all distances differ by little, so backtracking would visit many leaves.
///
/// # Complexity
/// A search takes O(log n) steps for n sites. The memory is about 29 bytes per site. Queries take up to three times as
/// long as with the grid, which is the default ([docs/measurements/p2m.md] has figures).
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BuildIndex, ClosestPoint, Segment};
/// use p2m_interception::{KdTreeLocator, P2mIndex, P2mOptions};
///
/// let wires: Vec<Segment<f64>> = (0..20)
///     .map(|i| f64::from(i).sin_cos())
///     .map(|(x, y)| Segment::new(Point3::new(x, y, 0.0), Point3::new(-y, x, 1.0)))
///     .collect();
/// let options = P2mOptions::default().with_locator(KdTreeLocator::build);
/// let index = P2mIndex::build(&wires, &options)?;
/// assert!(index.closest_point(&Point3::new(2.0, 0.0, 0.0)).is_some_and(|answer| answer.distance < 1.5));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// [docs/measurements/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/p2m.md
#[derive(Debug)]
pub struct KdTreeLocator {
    /// The tree. It is `None` if `kiddo` cannot build one.
    tree: Option<ImmutableKdTree<f64, 3>>,
    /// The number of the first site.
    first: usize,
    /// The memory of the tree in bytes.
    bytes: usize,
}

impl KdTreeLocator {
    /// Puts the sites of an index into a tree. This is the function that
    /// [`P2mOptions::with_locator`](crate::P2mOptions::with_locator) takes.
    #[must_use]
    pub fn build(sites: &LocatorSites<'_>) -> Arc<dyn Locator> {
        let positions: Vec<[f64; 3]> = sites.positions().collect();
        // `kiddo` does not report its memory, so it is estimated: positions, numbers, and a split for each leaf of 32.
        let bytes = positions.len() * (size_of::<[f64; 3]>() + size_of::<u32>() + 1);
        Arc::new(Self { tree: ImmutableKdTree::new_from_slice(&positions).ok(), first: sites.first(), bytes })
    }
}

impl Locator for KdTreeLocator {
    fn start(&self, position: &[f64; 3]) -> Option<usize> {
        let nearest = self.tree.as_ref()?.query(position).nearest_one::<SquaredEuclidean<f64>>().approx().execute();
        Some(self.first + nearest.item as usize)
    }

    fn memory(&self) -> usize {
        self.bytes
    }
}
