//! The primitives of a scene, and the interface of primitives of your own.

mod box_intersection;
mod interface;
mod point;
mod projection;
mod segment;
mod shape;
mod triangle;

pub use interface::Primitive;
pub use point::Point;
pub use projection::{Feature, Projection};
pub use segment::Segment;
pub use shape::Shape;
pub use triangle::Triangle;
