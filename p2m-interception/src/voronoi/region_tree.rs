//! The filter of the paper for long lists: an R-tree of boxes around regions.

use crate::voronoi::list_filter::{ListFilter, Region};
use rstar::{AABB, RTree, RTreeObject};
use std::sync::Arc;

/// A filter that keeps the boxes of a list in an R-tree of the crate `rstar` \[Zong2023\].
///
/// # Complexity
/// A filter takes about 84 bytes per primitive of its list. It is slower than the lists in order, which are the
/// default, on every scene that was measured: between slivers, where lists are long, queries take three to ten times
/// as long ([docs/measurements/p2m.md] has figures).
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BuildIndex, ClosestPoint, Segment};
/// use p2m_interception::{P2mIndex, P2mOptions, RegionTree};
///
/// let wires: Vec<Segment<f64>> = (0..20)
///     .map(|i| f64::from(i).sin_cos())
///     .map(|(x, y)| Segment::new(Point3::new(x, y, 0.0), Point3::new(-y, x, 1.0)))
///     .collect();
/// let options = P2mOptions::default().with_list_filter(RegionTree::build).with_filter_above(8);
/// let index = P2mIndex::build(&wires, &options)?;
/// assert!(index.report().filtered > 0);
/// assert!(index.closest_point(&Point3::new(2.0, 0.0, 0.0)).is_some_and(|answer| answer.distance < 1.5));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// [docs/measurements/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/p2m.md
#[derive(Clone, Debug)]
pub struct RegionTree {
    /// The regions with a bounded box.
    tree: RTree<Bounded>,
    /// The regions with an unbounded box, which an R-tree cannot store.
    unbounded: Vec<Region>,
}

/// A region with a bounded box.
#[derive(Clone, Debug)]
struct Bounded(Region);

impl RTreeObject for Bounded {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.0.low, self.0.high)
    }
}

impl RegionTree {
    /// Puts the regions of a list into a tree. This is the function that
    /// [`P2mOptions::with_list_filter`](crate::P2mOptions::with_list_filter) takes.
    #[must_use]
    pub fn build(regions: Vec<Region>) -> Arc<dyn ListFilter> {
        let finite = |region: &Region| region.low.iter().chain(&region.high).all(|x| x.is_finite());
        let (bounded, unbounded): (Vec<_>, Vec<_>) = regions.into_iter().partition(finite);
        Arc::new(Self { tree: RTree::bulk_load(bounded.into_iter().map(Bounded).collect()), unbounded })
    }
}

impl ListFilter for RegionTree {
    fn containing(&self, point: &[f64; 3], visit: &mut dyn FnMut(&Region)) {
        let bounded = self.tree.locate_in_envelope_intersecting(AABB::from_point(*point));
        bounded.map(|bounded| &bounded.0).chain(&self.unbounded).for_each(visit);
    }

    /// Returns an estimate, since `rstar` does not report its memory: the leaves, and half as many nodes with boxes.
    fn memory(&self) -> usize {
        self.tree.size() * size_of::<Region>() * 3 / 2 + self.unbounded.capacity() * size_of::<Region>()
    }
}
