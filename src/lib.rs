//! What is the closest point of this scene?
//!
//! A scene is any mix of triangles, segments and points. An index answers closest-point queries over it; which index,
//! is a type. All of them implement [`ClosestPoint`], keep one accuracy contract (stated there, derived in
//! docs/proofs/accuracy.md) and return the same bits.
//!
//! ```
//! use nalgebra::Point3;
//! use p2m::{AabbTree, BuildIndex, ClosestPoint, Element, Feature, QueryOptions, Soup};
//!
//! // A roof of two triangles and a cable beside it, over shared positions.
//! let positions = vec![
//!     Point3::new(0.0, 0.0, 0.0),
//!     Point3::new(4.0, 0.0, 0.0),
//!     Point3::new(4.0, 3.0, 0.0),
//!     Point3::new(0.0, 3.0, 0.0),
//!     Point3::new(5.0, 0.0, 2.0),
//!     Point3::new(5.0, 3.0, 2.0),
//! ];
//! let scene = Soup::new(
//!     positions,
//!     [Element::Triangle([0, 1, 2]), Element::Triangle([0, 2, 3]), Element::Segment([4, 5])],
//! )?;
//! let index = AabbTree::build(&scene, &Default::default())?;
//!
//! let answer = index.closest_point(&Point3::new(3.0, 1.0, 2.0)).expect("the scene is not empty");
//! assert_eq!(answer.distance, 2.0);
//! assert_eq!(answer.primitive.index(), 0); // the lowest id among equals: the cable is as near
//! assert_eq!(answer.feature, Feature::Face);
//!
//! // Nothing within 1: no answer. The bound is inclusive.
//! let near = QueryOptions::default().with_max_distance(1.0);
//! assert!(index.closest_point_with(&Point3::new(3.0, 1.0, 2.0), &near).is_none());
//! # Ok::<(), p2m::BuildError>(())
//! ```
//!
//! # Which question
//!
//! | what | trait | of |
//! |---|---|---|
//! | the closest point, within a distance, from a hint | [`ClosestPoint`] | every index |
//! | the same with an approximation of a stated error | [`QueryOptions`] | every index |
//! | the same proved: the nearest primitive of the real numbers, the distance rounded once | [`CertifiedQuery`] | every index |
//! | the same for many places, on all cores | [`batch`] | every index |
//! | the k nearest, all within a distance, any, the closest of some | [`NearQuery`] | every index |
//! | what a ray intersects | [`RayQuery`] | trees and brute force |
//! | what intersects a box | [`BoxQuery`] | trees and brute force |
//! | what a query costs | [`Inspect`] | every index |
//!
//! # Which index
//!
//! If in doubt, [`AabbTree`]: it is built in no time and fast everywhere.
//!
//! | type | what it is | feature |
//! |---|---|---|
//! | [`BruteForce`] | every primitive, every time: the oracle, and right for a handful of queries | |
//! | [`AabbTree`] | boxes split by surface area, searched nearest first | `bvh` |
//! | [`OctreeIndex`] | cells with short lists of what can be nearest in them, a tree elsewhere: no search, for more memory | `interception` |
//! | [`P2mIndex`] | the same with the cells of the vertices: fastest far away, for still more memory | `interception` |
//! | `PaperIndex` | that with the KD-tree, the R-trees and the long lists of the paper, for comparison | `kiddo`, `rstar` |
//! | [`KdopTree`] | trees of polytopes of K faces: closer to what does not lie along the axes | `kdop` |
//!
//! Write functions over `I: ClosestPoint<T>` to leave the choice to the caller, or take `&dyn ClosestPoint<T>`. The
//! page "Which type do I need" (module `guide`, docs/guide.md) has an example for every choice of scene, index and
//! question.
//!
//! # Cargo features
//!
//! | feature | adds | default |
//! |---|---|---|
//! | `bvh` | [`AabbTree`] | yes |
//! | `interception` | [`OctreeIndex`], [`P2mIndex`] | yes |
//! | `kiddo` | `KdTreeLocator`, the paper's way to the nearest vertex, for [`P2mOptions`]: slower than the default | yes |
//! | `rstar` | `RegionTree`, the paper's filter of long lists, for [`P2mOptions`]: slower than the default; with `kiddo` also `PaperIndex`; `scene::adapters::RstarIndex` | yes |
//! | `parry` | shapes of parry3d-f64 in [`scene`]s; its tree as an index, `scene::adapters::ParryIndex` | no |
//! | `parry-f32` | shapes of parry3d in [`scene`]s | no |
//! | `mint` | positions of the crate mint in [`scene`] | no |
//! | `kdop` | [`KdopTree`] | yes |
//! | `advisor` | `advisor`: which index a scene and its queries call for | no |
//! | `field` | [`field`]: distances on grids, signs, winding numbers | yes |
//! | `rayon` | building and [`batch`] on all cores | yes |
//! | `mixed` | [`scene`]: reading scenes and points from files | yes |
#![forbid(unsafe_code)]

/// Which index a scene and its queries call for.
#[cfg(feature = "advisor")]
pub use p2m_advisor as advisor;
/// Everything else about trees of boxes: their nodes and packets, and trees of other volumes.
#[cfg(feature = "bvh")]
pub use p2m_bvh as bvh;
#[cfg(feature = "bvh")]
pub use p2m_bvh::{AabbOptions, AabbTree, SplitOptions, SplitRule};
/// The parts of an index of your own, and of what examines others: collectors, the kernel, predicates. This is the
/// crate `p2m-core` as a whole.
pub use p2m_core as backend;
pub use p2m_core::{
    Aabb, BoxQuery, BruteForce, BuildError, BuildIndex, CertifiedQuery, CertifyError, Closest, ClosestLeaf,
    ClosestPoint, Element, Feature, Hit, Indexed, Inspect, Isa, NearQuery, Point, Primitive, PrimitiveId, PrimitiveSet,
    Projection, QueryCost, QueryOptions, Ray, RayError, RayQuery, Real, Segment, Shape, Side, Soup, Triangle, batch,
    storage,
};
/// Distance fields, and on which side of a surface a point is.
#[cfg(feature = "field")]
pub use p2m_field as field;
/// Everything else about interception indexes: partitions, locators, Delaunay tetrahedra.
#[cfg(feature = "interception")]
pub use p2m_interception as interception;
#[cfg(feature = "kiddo")]
pub use p2m_interception::KdTreeLocator;
#[cfg(feature = "rstar")]
pub use p2m_interception::RegionTree;
#[cfg(feature = "interception")]
pub use p2m_interception::{
    BuildListFilter, BuildLocator, Domain, InterceptionIndex, ListFilter, Locator, LocatorSites, OctreeIndex,
    OctreeOptions, OctreeReport, P2mIndex, P2mOptions, P2mReport, Region, Voronoi,
};
#[cfg(all(feature = "kiddo", feature = "rstar"))]
pub use p2m_interception::{PaperIndex, PaperOptions};
/// Everything else about k-DOPs: polytopes, overlap of trees, directions from a scene.
#[cfg(feature = "kdop")]
pub use p2m_kdop as kdop;
#[cfg(feature = "kdop")]
pub use p2m_kdop::{KdopOptions, KdopTree};
/// Scenes from files and generators.
#[cfg(feature = "mixed")]
pub use p2m_mixed as scene;

#[doc = include_str!("../docs/guide.md")]
#[cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "mixed"))]
pub mod guide {}

/// The README's example, compiled and run.
#[cfg(all(doctest, feature = "bvh", feature = "mixed"))]
#[doc = include_str!("../README.md")]
struct Readme;
