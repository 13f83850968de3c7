//! Interception: what can be the nearest primitive anywhere in a cell, found once and kept.
//!
//! A *partition* cuts the domain of queries into convex cells. Each cell has *dominators*: points y of the scene, so
//! that |q - y| bounds the answer for every q of the cell. Its *interception list* holds every primitive that can beat
//! all dominators somewhere in the cell. A query *locates* its cell and tests the list: no search, no backtracking
//! \[Zong2023\].
//!
//! What is in a list is decided by the corner test, for any convex cell; how cells are made and located is the
//! [`Partition`]'s affair: cubes ([`Octree`]: `cube`, `corner`, `refine`), or the Voronoi cells of the vertices
//! ([`Voronoi`]: `sites`, `sphere`, `hull`, `features`, `matters`, `cells`; located by a [`Locator`], `hints` unless
//! told otherwise, and `fan`; `lookup`; long lists cut short by a [`ListFilter`]). Lists are lists of packets with the lanes that matter, eight to a block, with
//! bounds (`block`). Where a list would be too long, and outside of the domain, the tree over the same packets answers.
//! docs/proofs/octree.md and docs/proofs/p2m.md have the proofs.

mod allowance;
mod block;
mod cells;
mod corner;
mod cube;
mod fan;
mod features;
mod hints;
mod hull;
mod list_filter;
mod locator;
mod lookup;
mod matters;
mod nearer;
mod octree;
mod options;
mod partition;
mod progress;
mod refine;
mod shares;
mod sites;
mod sphere;
mod voronoi;

pub use list_filter::{BuildListFilter, ListFilter, Region};
pub use locator::{BuildLocator, Locator, LocatorSites};
pub use octree::Octree;
pub use options::{Domain, OctreeOptions, OctreeReport, P2mOptions, P2mReport};
pub use partition::{Partition, SIDE_BY_SIDE};
pub use progress::{Progress, Stage};
pub use voronoi::Voronoi;
