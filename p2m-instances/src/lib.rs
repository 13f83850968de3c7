//! Scenes of moving objects: instances of indexes, each with a rotation and a translation.
//!
//! An index is built once for each object. Instances share it, and a motion changes only the boxes of the instances
//! that it moves. [`Instances`] answers the queries of any other index.
//!
//! ```
//! use nalgebra::{Isometry3, Point3};
//! use p2m_bvh::AabbTree;
//! use p2m_core::{ClosestPoint, Soup};
//! use p2m_instances::Instances;
//! use std::sync::Arc;
//!
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! let plate: Soup<f64> = Soup::from_arrays(&positions, &[[0u32, 1, 2]])?;
//! let plate = Arc::new(AabbTree::new(plate)?);
//!
//! let mut scene = Instances::new();
//! let mut edit = scene.edit();
//! edit.add("floor", &plate, Isometry3::identity())?;
//! let lid = edit.add("lid", &plate, Isometry3::translation(0.0, 0.0, 5.0))?;
//! // The scene can be queried when the edit ends.
//! drop(edit);
//!
//! let answer = scene.closest_point(&Point3::new(0.25, 0.25, 4.0)).expect("the scene is not empty");
//! let (instance, primitive) = scene.instance_of(answer.primitive).expect("the answer is of the scene");
//! assert_eq!((answer.distance, instance, primitive.index()), (1.0, lid, 0));
//!
//! scene.edit().set_motion(lid, Isometry3::translation(0.0, 0.0, 9.0))?;
//! assert_eq!(scene.closest_point(&Point3::new(0.25, 0.25, 4.0)).unwrap().distance, 4.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Contract
//!
//! The motion of an instance is applied to each vertex in f64, and each coordinate is rounded
//! ([`Motion`](p2m_core::pair::Motion)). Every answer equals the answer of one index over the scene of these vertices:
//! the bits of distances, points and parameters and the ids are equal, whatever the indexes of the objects are. The ids
//! of an instance follow the ids of the instances that were added before it. Objects in f32 are moved in f64 as well,
//! and answers are rounded at the end.
//!
//! # Method
//!
//! A tree of the boxes of the instances finds the instances that a query can reach, nearest first. For each of them,
//! the query is moved back into the frame of the object, and the index of the object searches for all primitives that
//! may win: the primitives within the best distance so far plus a margin, which covers the roundings of both motions
//! and of the kernel. These primitives are moved and evaluated by the kernel, and the best distance shrinks while the
//! index searches. Rays take the same way.
#![forbid(unsafe_code)]

mod boxes;
mod edit;
mod error;
mod id;
mod instance;
mod instances;
mod nearest;
mod object;
mod pairs;
mod rays;

pub use edit::Edit;
pub use error::InstanceError;
pub use id::InstanceId;
pub use instance::Instance;
pub use instances::Instances;
