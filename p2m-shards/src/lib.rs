//! Scenes larger than memory: an index in shards, each of which is a saved index of a part of the scene.
//!
//! [`ShardWriter`] divides a scene by space, builds the index of one part after the other, and writes a folder of files
//! with a [`Manifest`]. [`ShardedIndex`] answers queries and loads a shard when a query needs it.
//!
//! ```
//! use nalgebra::Point3;
//! use p2m_mixed::generate::{IcoSphere, ico_sphere};
//! use p2m_shards::{ShardOptions, ShardWriter, ShardedIndex};
//!
//! let folder = tempfile::tempdir()?;
//! let mut writer = ShardWriter::new(folder.path(), ShardOptions::default().with_max_bytes(20_000))?;
//! writer.add_scene(&ico_sphere(&IcoSphere::default())?.into())?;
//! writer.finish()?;
//!
//! let index = ShardedIndex::open(folder.path())?;
//! assert!(index.manifest().shards.len() > 1);
//! let answer = index.closest_point(&Point3::new(0.0, 0.0, 3.0))?.expect("the scene is not empty");
//! assert!((answer.closest.distance - 2.0).abs() < 0.01);
//! // Shards that are farther than the answer stay on the disk.
//! assert!((index.loads() as usize) < index.manifest().shards.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Contract
//!
//! A primitive of the whole scene has an id, which counts from 0 in the order in which primitives were added. Every
//! answer equals the answer of one index over the whole scene: distances, points, features, weights and parameters have
//! the same bits. The key of a primitive is its squared distance as the kernel computes it, which is a square with a
//! tier ([`Key`](p2m_core::Key)), and its distance is the rounded root of the key. The least key wins, and of equal
//! keys the lowest id. So answers depend neither on how the scene was divided, nor on the order in which shards are
//! loaded, nor on the memory that they may take. Lower bounds are certified, but in their last bits they depend on the
//! primitives that a search evaluates, as they do between backends. The lower bounds of the k nearest primitives have
//! the bits that one index gives.
//!
//! Approximate queries, which have an epsilon or a limit on visits, may have other answers than one index. Their errors
//! are within the bounds that these options promise.
//!
//! A query fails if it needs a shard whose file is missing, cut off, damaged, or not the one that the manifest
//! describes. It never answers without such a shard.
//!
//! # Method
//!
//! The box of a shard bounds the distances of its primitives from below, by the arithmetic of the kernel
//! ([`Aabb::lower_bound`](p2m_core::Aabb::lower_bound)), so a shard is left out if its bound exceeds the best distance
//! by more than the error of the kernel, because then none of its primitives can be the answer or lower the bound.
//! Shards are asked in the order of these bounds, each with that distance as the largest one. The nearest of the
//! answers is the answer: distances are compared, where they are equal the keys, and where these are equal the ids.
//! That is the order of keys and then ids, because a smaller key never has a larger distance. Crossings of a ray add up
//! over the shards, because each triangle is in one of them.
//!
//! Two phases answer a batch: each query asks the shard with the nearest box, and then the shards whose bounds are
//! within the distance that was found. In each phase a shard is loaded at most once and answers all queries that need
//! it. Several processes share these phases by [`nearest_shard`](ShardedIndex::nearest_shard),
//! [`shards_within`](ShardedIndex::shards_within) and
//! [`closest_points_in_shard`](ShardBatch::closest_points_in_shard).

#![deny(unsafe_code)]

mod batch;
mod cache;
mod error;
mod index;
mod manifest;
mod nearest;
mod rays;
mod search;
mod shard;
mod signs;
mod write;

pub use batch::ShardBatch;
pub use error::ShardError;
pub use index::ShardedIndex;
pub use manifest::{MANIFEST_FILE, Manifest, ObjectEntry, ShardEntry, folder_of};
pub use nearest::ShardClosest;
pub use rays::ShardHit;
pub use search::Proceed;
pub use shard::Shard;
pub use write::{ShardOptions, ShardWriter, shard_file};
