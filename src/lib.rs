//! Closest points of scenes of triangles, segments and points.
//!
//! A scene is any mix of triangles, segments and points. An index is built over a scene and answers closest-point
//! queries. The type of the index is chosen at compile time, or at run time through `dyn ClosestPoint`. All indexes
//! implement [`ClosestPoint`], which states their accuracy ([docs/proofs/accuracy.md] has the proof). Exact queries
//! return the same primitive and, bit for bit, the same distance from every index.
//!
//! ```
//! use p2m::prelude::*;
//! use p2m::{AabbTree, Element, Feature, QueryOptions, Soup};
//!
//! // A roof of two triangles and a cable beside it.
//! let roof = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 3.0, 0.0], [0.0, 3.0, 0.0], [5.0, 0.0, 2.0], [5.0, 3.0, 2.0]];
//! let mut scene: Soup = Soup::from_arrays(&roof, &[[0, 1, 2], [0, 2, 3]])?;
//! scene.push(Element::Segment([4, 5]))?;
//! let index = AabbTree::new(scene)?;
//!
//! let answer = index.closest_point(&[3.0, 1.0, 2.0]).expect("the scene is not empty");
//! assert_eq!(answer.distance, 2.0);
//! assert_eq!(answer.primitive.index(), 0); // the lowest id among equals: the cable is as near
//! assert_eq!(answer.feature, Feature::Face);
//!
//! // Nothing within 1: no answer. The bound is inclusive.
//! let near = QueryOptions::default().with_max_distance(1.0);
//! assert!(index.closest_point_with(&[3.0, 1.0, 2.0], &near).is_none());
//! # Ok::<(), p2m::BuildError>(())
//! ```
//!
//! # Which query
//!
//! | you want | trait or module | available for |
//! |---|---|---|
//! | the closest point, optionally with a largest distance or a hint | [`ClosestPoint`] | every index |
//! | the closest point with an approximation of a stated error | [`QueryOptions`] | every index |
//! | the certainly closest primitive, with a distance that is rounded once | [`CertifiedQuery`] | every index |
//! | the closest points to many queries, on all cores | [`batch`] | every index |
//! | the k nearest, all or any within a distance, the closest that passes a filter | [`NearQuery`] | every index |
//! | the hits of a ray | [`RayQuery`] | trees and brute force |
//! | the primitives that intersect a box | [`BoxQuery`] | trees and brute force |
//! | the primitive nearest to a segment or a triangle, or whether one is near | [`PairQuery`] | trees and brute force |
//! | the first contact of a moving ball | [`pair::MovingBall`] | trees and brute force |
//! | the statistics of deviations of a scan | `field::deviation::DeviationStatistics` | signed distances |
//! | the Hausdorff distance of two scenes | `field::hausdorff_distance` | every index |
//! | the nearest points of two scenes, one of them moved | [`pair::PairQuery::closest_pair`] | trees and brute force |
//! | most of these in a scene larger than memory | `shards::ShardedIndex` | shards of every index |
//! | any of these in a scene of moving objects | [`instances::Instances`] | objects of every index |
//! | the cost of a query | [`core::IndexStats`] | every index |
//!
//! # Which index
//!
//! [`AabbTree`] is a good first choice, because it is built in a fraction of a second and is fast everywhere.
//!
//! | type | structure | feature |
//! |---|---|---|
//! | [`BruteForce`] | no structure: it tests every primitive, which is best for one or two queries | |
//! | [`AabbTree`] | a tree of boxes, split by the surface-area heuristic and searched nearest first | `bvh` |
//! | [`OctreeIndex`] | cubic cells with candidate lists; faster for many queries, takes more memory | `interception` |
//! | [`P2mIndex`] | Voronoi cells of the vertices with such lists; fastest far away, most memory | `interception` |
//! | [`P2mIndex`] with `P2mOptions::as_in_paper()` | KD-tree, R-trees, long lists of the paper, to compare | `paper` |
//! | [`KdopTree`] | a tree of polytopes of K faces, which fit oblique primitives more closely than boxes do | `kdop` |
//!
//! A candidate list is short: it has the primitives that can be nearest in its cell.
//!
//! Functions over `I: ClosestPoint<T>` or `&dyn ClosestPoint<T>` leave the choice to the caller. The [guide] has a
//! tutorial, an example for every choice of scene, index and query, and a list of platforms and limits.
//!
//! [guide]: https://github.com/p2m-rs/p2m/blob/main/docs/guide/README.md
//!
//! # Cargo features
//!
//! | feature | adds | default |
//! |---|---|---|
//! | `bvh` | [`AabbTree`] | yes |
//! | `interception` | [`OctreeIndex`], [`P2mIndex`] | yes |
//! | `lean` | all default features except `paper` | yes |
//! | `paper` | `paper`: the index of the P2M paper, with the trees of kiddo and rstar; slower than [`P2mIndex`] | yes |
//! | `glam` | [`Position`]s of the crate glam in scenes and batches | no |
//! | `mint` | [`Position`]s of the crate mint in scenes and batches | no |
//! | `serde` | [`Soup`] and indexes as values of serde, in the form of saved files | no |
//! | `kdop` | [`KdopTree`] | yes |
//! | `backends` | `backends`: every index by its name, and which one a scene and its queries call for | no |
//! | `formats` | `formats`: scenes and scans in the formats of other programs | no |
//! | `field` | [`field`]: distances on grids, signs, winding numbers, Hausdorff distances | yes |
//! | `instances` | [`instances`]: scenes of moving objects | yes |
//! | `shards` | `shards`: scenes larger than memory, in shards that are loaded on demand | no |
//! | `rayon` | building and [`batch`] on all cores | yes |
//! | `scene` | [`scene`]: reading scenes and points from files | yes |
//!
//! `default-features = false, features = ["lean"]` compiles 29 crates fewer than the default.
//!
//! [docs/proofs/accuracy.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/accuracy.md
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

/// The linear-algebra library of the interface, re-exported so that programs need not match its version.
pub use nalgebra;
/// The registry of indexes by name, and the recommendation of an index for a scene and its queries.
#[cfg(feature = "backends")]
pub use p2m_backends as backends;
/// The whole crate p2m-bvh: split rules, nodes and packets, and trees of other volumes.
#[cfg(feature = "bvh")]
pub use p2m_bvh as bvh;
#[cfg(feature = "bvh")]
pub use p2m_bvh::{AabbTree, SplitOptions};
/// The whole crate p2m-core: the contract, collectors, the kernel, predicates, and the parts for an index of your own.
pub use p2m_core as core;
pub use p2m_core::pair::{self, PairQuery};
pub use p2m_core::{
    Aabb, AnyIndex, BoxQuery, BruteForce, BuildError, BuildIndex, CertifiedQuery, Closest, ClosestPoint, Element,
    Feature, Hit, NearQuery, Point, Position, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, Ray, RayHit,
    RayQuery, Real, Segment, Shape, Soup, Triangle, batch, storage,
};
/// Distance fields, signs (the side of a surface on which a point lies), and Hausdorff distances.
#[cfg(feature = "field")]
pub use p2m_field as field;
/// Scenes and scans in the formats of other programs: LAS, E57, PCD, glTF, 3MF, GeoJSON, shapefiles.
#[cfg(feature = "formats")]
pub use p2m_formats as formats;
/// Scenes of moving objects: instances of indexes, each with a rotation and a translation.
#[cfg(feature = "instances")]
pub use p2m_instances as instances;
/// The whole crate p2m-interception: partitions, reports, Delaunay tetrahedra.
#[cfg(feature = "interception")]
pub use p2m_interception as interception;
#[cfg(feature = "interception")]
pub use p2m_interception::{OctreeIndex, OctreeOptions, P2mIndex, P2mOptions};
/// The whole crate p2m-kdop: polytopes, directions from a scene.
#[cfg(feature = "kdop")]
pub use p2m_kdop as kdop;
#[cfg(feature = "kdop")]
pub use p2m_kdop::{KdopOptions, KdopTree};
/// Scenes from files and generators.
#[cfg(feature = "scene")]
pub use p2m_mixed as scene;
/// Scenes larger than memory: indexes in shards, which are loaded on demand.
#[cfg(feature = "shards")]
pub use p2m_shards as shards;

/// The traits of queries, scenes and indexes, for `use p2m::prelude::*`.
pub mod prelude {
    pub use crate::{
        AnyIndex, BoxQuery, BuildIndex, CertifiedQuery, ClosestPoint, NearQuery, PairQuery, Position, Primitive,
        PrimitiveSet, RayQuery, Real,
    };
}

/// The index of the P2M paper, for comparison: its KD-tree, its R-trees, and the traits that give a [`P2mIndex`] other
/// ones.
#[cfg(feature = "paper")]
pub mod paper {
    pub use p2m_interception::{
        BuildListFilter, BuildLocator, KdTreeLocator, ListFilter, Locator, LocatorSites, Region, RegionTree,
    };
}

/// The examples of the guide, compiled and run. `cargo test -p xtask` checks that no page is missing here.
#[cfg(all(
    doctest,
    feature = "bvh",
    feature = "field",
    feature = "instances",
    feature = "interception",
    feature = "kdop",
    feature = "scene"
))]
mod guide {
    #[doc = include_str!("../docs/guide/README.md")]
    struct Index;
    #[doc = include_str!("../docs/guide/tutorial.md")]
    struct Tutorial;
    #[doc = include_str!("../docs/guide/clearance.md")]
    struct Clearance;
    #[doc = include_str!("../docs/guide/inspection.md")]
    struct Inspection;
    #[doc = include_str!("../docs/guide/training.md")]
    struct Training;
    #[doc = include_str!("../docs/guide/maps.md")]
    struct Maps;
    #[doc = include_str!("../docs/guide/shell.md")]
    struct Shell;
    #[doc = include_str!("../docs/guide/scenes.md")]
    struct Scenes;
    #[doc = include_str!("../docs/guide/indexes.md")]
    struct Indexes;
    #[doc = include_str!("../docs/guide/queries.md")]
    struct Queries;
    #[doc = include_str!("../docs/guide/accuracy.md")]
    struct Accuracy;
    #[doc = include_str!("../docs/guide/pairs.md")]
    struct Pairs;
    #[doc = include_str!("../docs/guide/motion.md")]
    struct Motion;
    #[doc = include_str!("../docs/guide/fields.md")]
    struct Fields;
    #[doc = include_str!("../docs/guide/files.md")]
    struct Files;
    #[doc = include_str!("../docs/guide/platforms.md")]
    struct Platforms;
}

/// The README's example, compiled and run.
#[cfg(all(doctest, feature = "bvh", feature = "scene"))]
#[doc = include_str!("../README.md")]
struct Readme;
