//! The primitives of a scene, and the interface of primitives of your own.

mod box_intersection;
mod check;
mod feature;
mod interface;
mod point;
mod projection;
mod segment;
mod shape;
mod triangle;

pub use check::{PrimitiveDefect, check_primitive};
pub use feature::Feature;
pub use interface::Primitive;
pub use point::Point;
pub use projection::Projection;
pub use segment::Segment;
pub use shape::Shape;
pub use triangle::Triangle;
