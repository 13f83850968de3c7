//! The registry of backends: one table that the program `p2m`, the Python package, pages, shards, the choice of an
//! index, measurements and tests read.
//!
//! A new backend joins them with one entry of [`BACKENDS`], its [`IndexKind`], and the branches below that build and
//! load its index. The values of `--backend` and of `backend=` in Python, the files of `p2m build`, the estimates of
//! `p2m advise`, the list of `p2m-bench` and the tests of agreement all come from that entry.
//!
//! Indexes are behind one pointer, [`Arc<dyn AnyIndex>`](AnyIndex), and share their scene. The pointer costs one
//! indirect call for each query, or for each batch of queries. In rounds of `p2m tradeoff` it makes no measurable
//! difference to queries of 700 to 1000 ns, so no command needs the types behind it. The searches below that call are
//! compiled for each index.

mod backend_entry;
mod cost;
mod index;
mod kdop_directions;
mod p2m_settings;

pub use backend_entry::{BackendEntry, SearchStructure};
pub use cost::Cost;
pub use index::{BuildSettings, BuiltIndex};
pub use kdop_directions::{ChosenDirections, KdopDirections, KdopVisitor};
pub use p2m_settings::{ListFilterKind, LocatorKind, P2mSettings};

use p2m_bvh::{AabbTree, PacketTree};
use p2m_core::storage::{self, LoadError, Reader, Saved};
use p2m_core::{AnyIndex, BruteForce, BuildError, BuildIndex, PrimitiveSet, Real, Soup};
use p2m_interception::{Octree, OctreeIndex, P2mIndex, Voronoi};
use p2m_kdop::KdopTree;
use std::sync::Arc;

/// The entry of the tree of boxes, from which other entries take what they have in common with it.
const BOXES: BackendEntry = BackendEntry {
    name: "aabb",
    summary: "A tree of boxes",
    structure: SearchStructure::Tree,
    feature: Some("bvh"),
    casts_rays: true,
    answers_pairs: true,
    has_refit: true,
    reports_progress: false,
    has_kdop_directions: false,
    has_resolution: false,
    has_p2m_settings: false,
    costs: &[Cost::BOXES],
    sliver_costs: &[],
    kind: IndexKind::Aabb,
};

/// The common values of the entries with cells. Cells of slivers fall back to a tree.
const CELLS: BackendEntry = BackendEntry {
    feature: Some("interception"),
    casts_rays: false,
    answers_pairs: false,
    has_refit: false,
    reports_progress: true,
    ..BOXES
};

/// All backends, the simplest one first. Tables and estimates keep this order.
pub static BACKENDS: &[BackendEntry] = &[
    BackendEntry {
        name: "brute",
        summary: "Every primitive, every time",
        structure: SearchStructure::Exhaustive,
        feature: None,
        costs: &[Cost { primitive: 48.0, ..Cost::new(40.0, 0.0, [0.0, 0.0]) }],
        kind: IndexKind::Brute,
        ..BOXES
    },
    BOXES,
    BackendEntry {
        name: "kdop",
        summary: "A tree of k-DOPs (polytopes), which fit slanted geometry more tightly than boxes",
        feature: Some("kdop"),
        has_kdop_directions: true,
        costs: &[Cost::new(400.0, 66.0, [36.0, 47.0])],
        // The tree of boxes is built first, to count its nodes and packets.
        sliver_costs: &[Cost { counted: Some([55.0, 45.0]), ..Cost::new(770.0, 66.0, [20.4, 27.0]) }],
        kind: IndexKind::Kdop,
        ..BOXES
    },
    BackendEntry {
        name: "octree",
        summary: "Cubic cells with lists of candidates: fast queries, more memory, a slower build",
        structure: SearchStructure::SpaceCells,
        has_resolution: true,
        costs: &[
            Cost { outside: Some([0.35, 0.0]), least_bytes: 0.7, ..Cost::new(4870.0, 235.0, [24.0, 15.0]) },
            Cost { outside: Some([0.25, 0.0]), finer: Some(10.0), ..Cost::new(13_870.0, 385.0, [22.0, 9.0]) },
        ],
        sliver_costs: &[
            Cost { least_bytes: 0.7, ..Cost::new(4870.0, 235.0, [34.0, 45.0]) },
            Cost { finer: Some(10.0), ..Cost::new(100_370.0, 2065.0, [13.6, 18.0]) },
        ],
        kind: IndexKind::Octree,
        ..CELLS
    },
    BackendEntry {
        name: "p2m",
        summary: "Cells of the vertices with lists of candidates: fastest far from the scene",
        structure: SearchStructure::VertexCells,
        has_p2m_settings: true,
        costs: &[Cost { outside: Some([0.0, 17.0]), ..Cost::new(20_000.0, 330.0, [27.0, 20.0]) }],
        sliver_costs: &[Cost::new(20_000.0, 330.0, [34.0, 45.0])],
        kind: IndexKind::P2m,
        ..CELLS
    },
];

/// The type of the indexes of a backend.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum IndexKind {
    Brute,
    Aabb,
    Kdop,
    Octree,
    P2m,
}

/// Erases the number of faces of a k-DOP tree.
struct OfAnyK;

impl<T: Real, S: PrimitiveSet<T> + Send + Sync + 'static> KdopVisitor<S, T> for OfAnyK {
    type Output = Arc<dyn AnyIndex<T>>;
    fn visit<const K: usize>(self, tree: KdopTree<T, S, K>) -> Self::Output {
        Arc::new(tree)
    }
}

fn has_kind(reader: &Reader, kind: &str) -> bool {
    storage::kind(reader).is_ok_and(|found| found == kind)
}

impl BackendEntry {
    /// Builds an index over a scene.
    ///
    /// # Errors
    /// [`BuildError`] for a scene with coordinates that are not finite, or with too many primitives.
    pub fn build(&self, soup: Arc<Soup<f64>>, settings: &BuildSettings<'_>) -> Result<BuiltIndex, BuildError> {
        self.build_in(soup, settings)
    }

    /// Builds an index over a scene in the scalar `T`. It is compiled for that scalar in the crate that calls it.
    ///
    /// # Errors
    /// [`BuildError`] for a scene with coordinates that are not finite, or with too many primitives.
    pub fn build_in<T: Real>(
        &self,
        soup: Arc<Soup<T>>,
        settings: &BuildSettings<'_>,
    ) -> Result<BuiltIndex<T>, BuildError> {
        let index: Arc<dyn AnyIndex<T>> = match self.kind {
            IndexKind::Brute => Arc::new(BruteForce::build(soup, &())?),
            IndexKind::Aabb => Arc::new(AabbTree::build(soup, &settings.splits())?),
            IndexKind::Kdop => {
                let directions = settings.kdop_directions.unwrap_or(KdopDirections::Fourteen);
                let (index, directions) = directions.build(soup, settings.splits(), OfAnyK)?;
                return Ok(BuiltIndex { index, directions: Some(directions) });
            }
            IndexKind::Octree => {
                let options = settings.octree_options(soup.len());
                let visit = &mut |so_far: &_| (settings.visit_octree)(so_far);
                Arc::new(OctreeIndex::build_until(soup, &options, settings.progress, visit)?)
            }
            IndexKind::P2m => {
                let options = settings.p2m.options().with_splits(settings.splits());
                Arc::new(P2mIndex::build_with_progress(soup, &options, settings.progress)?)
            }
        };
        Ok(BuiltIndex { index, directions: None })
    }

    /// Builds an index over the scene of a tree. An index that contains such a tree takes it over.
    ///
    /// # Errors
    /// Same as [`build`](Self::build).
    pub fn build_on(
        &self,
        tree: AabbTree<f64, Arc<Soup<f64>>>,
        settings: &BuildSettings<'_>,
    ) -> Result<BuiltIndex, BuildError> {
        let index: Arc<dyn AnyIndex> = match self.kind {
            IndexKind::Aabb => Arc::new(tree),
            IndexKind::Octree => {
                let options = settings.octree_options(tree.set().len());
                let visit = &mut |so_far: &_| (settings.visit_octree)(so_far);
                Arc::new(OctreeIndex::build_on(tree, &options, settings.progress, visit))
            }
            IndexKind::Brute | IndexKind::Kdop | IndexKind::P2m => return self.build(tree.into_set(), settings),
        };
        Ok(BuiltIndex { index, directions: None })
    }

    /// Returns whether indexes of this backend can be saved and loaded.
    #[must_use]
    pub fn is_saveable(&self) -> bool {
        self.kind != IndexKind::Brute
    }

    /// Returns whether a saved file has an index of this backend, with these directions if it is a k-DOP tree.
    #[must_use]
    pub fn is_in(&self, reader: &Reader, directions: Option<KdopDirections>) -> bool {
        match self.kind {
            IndexKind::Brute => false,
            IndexKind::Aabb => has_kind(reader, &PacketTree::<p2m_core::Aabb<f64>>::kind()),
            IndexKind::Kdop => KdopDirections::saved_faces(directions, reader).is_some(),
            IndexKind::Octree => has_kind(reader, &Octree::kind()),
            IndexKind::P2m => has_kind(reader, &Voronoi::kind()),
        }
    }

    /// Loads the index of a saved file over the scene that it was built over.
    ///
    /// # Errors
    /// [`LoadError`], and always if the file has no index of this backend.
    pub fn load(&self, soup: Arc<Soup<f64>>, reader: &Reader) -> Result<BuiltIndex, LoadError> {
        let index: Arc<dyn AnyIndex> = match self.kind {
            IndexKind::Brute => {
                return Err(LoadError::OtherKind { found: storage::kind(reader)?, expected: self.name.to_owned() });
            }
            IndexKind::Aabb => Arc::new(AabbTree::load(soup, reader)?),
            IndexKind::Kdop => {
                let faces = KdopDirections::saved_faces(None, reader).unwrap_or(14);
                let (index, directions) = KdopDirections::load(faces, soup, reader, OfAnyK)?;
                return Ok(BuiltIndex { index, directions: Some(directions) });
            }
            IndexKind::Octree => Arc::new(OctreeIndex::load(soup, reader)?),
            IndexKind::P2m => Arc::new(P2mIndex::load(soup, reader)?),
        };
        Ok(BuiltIndex { index, directions: None })
    }

    /// Returns the backend of this name.
    #[must_use]
    pub fn find(name: &str) -> Option<&'static Self> {
        BACKENDS.iter().find(|backend| backend.name == name)
    }

    /// Returns the backend that is used where none is named: the tree of boxes, which is quick to build and answers
    /// every kind of query.
    ///
    /// # Panics
    /// It does not panic: the table has a tree.
    #[must_use]
    pub fn default_backend() -> &'static Self {
        BACKENDS.iter().find(|backend| backend.structure == SearchStructure::Tree).expect("the table has a tree")
    }

    /// Returns the backend of the index in a saved file, if there is one.
    #[must_use]
    pub fn from_saved(reader: &Reader) -> Option<&'static Self> {
        BACKENDS.iter().find(|backend| backend.is_in(reader, None))
    }
}
