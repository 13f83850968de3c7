//! Generators of scenes, which make measurements repeatable.
//!
//! Each kind of scene has a function and a struct of options, and [`Kind`] lists them by name. [`Transform`],
//! [`subdivide`], [`gapped`] and [`penetrating`] change any scene. Scenes are the same on every platform, bit for bit:
//! sines come from the crate libm and random numbers from ChaCha, and tests compare each kind with a checksum.
//!
//! ```
//! use p2m_mixed::generate::{Kind, Subdivide, Transform, penetrating, subdivide};
//!
//! let gear = Kind::from_name("skewed-gear").unwrap().generate().unwrap();
//! let gear = Transform::default().rotated_x(45.0).rotated_y(45.0).apply(&gear).unwrap();
//! let rough = subdivide(&gear, &Subdivide { levels: 2, amplitude: 0.1, ..Default::default() }).unwrap();
//! assert_eq!(rough.triangles().len(), 16 * 56_696);
//! let burr = penetrating(&gear, 1.5).unwrap();
//! assert_eq!(burr.positions().len(), 3 * 56_696);
//! ```

mod cable_bundle;
mod error;
mod gaps;
mod gear;
mod ico_sphere;
mod kind;
mod knot;
mod knot_and_cables;
mod mixed_sizes;
mod portable;
mod revolved;
mod subdivide;
mod transform;

pub use cable_bundle::{CableBundle, cable_bundle};
pub use error::GenerateError;
pub use gaps::{gapped, penetrating};
pub use gear::{SkewedGear, skewed_gear};
pub use ico_sphere::{IcoSphere, ico_sphere};
pub use kind::Kind;
pub use knot::{TorusKnot, torus_knot};
pub use knot_and_cables::{KnotAndCables, knot_and_cables};
pub use mixed_sizes::{MixedSizes, mixed_sizes};
pub use revolved::{Cone, Cylinder, Sphere, cone, cylinder, sphere};
pub use subdivide::{Subdivide, subdivide};
pub use transform::Transform;
