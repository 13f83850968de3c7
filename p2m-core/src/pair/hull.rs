//! A primitive as the convex hull of its vertices in f64.

use crate::kernel::vector::V3;
use crate::real::to_f64_array;
use crate::{Primitive, Real};

/// The one to three vertices of a primitive in f64. The primitive is their convex hull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull {
    /// The vertices; unused ones are zero.
    vertices: [V3; 3],
    len: usize,
}

impl Hull {
    /// Makes the hull of one to three vertices.
    ///
    /// # Panics
    /// Panics if there are more than three.
    #[must_use]
    pub fn new(vertices: &[[f64; 3]]) -> Self {
        let mut hull = Self { vertices: [[0.0; 3]; 3], len: vertices.len() };
        hull.vertices[..vertices.len()].copy_from_slice(vertices);
        hull
    }

    /// Makes the hull of a primitive.
    ///
    /// # Panics
    /// Panics if the primitive has no [vertices](Primitive::vertices), as primitives of your own may.
    #[must_use]
    pub fn of<T: Real>(primitive: &impl Primitive<T>) -> Self {
        let vertices = primitive.vertices();
        assert!(!vertices.is_empty(), "distances between primitives are defined for those that have vertices");
        let mut hull = Self { vertices: [[0.0; 3]; 3], len: vertices.len() };
        hull.vertices.iter_mut().zip(vertices).for_each(|(to, vertex)| *to = to_f64_array(vertex));
        hull
    }

    /// Returns the vertices.
    #[must_use]
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices[..self.len]
    }

    /// Applies a motion to the vertices.
    #[must_use]
    pub fn map(mut self, motion: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        self.vertices[..self.len].iter_mut().for_each(|vertex| *vertex = motion(*vertex));
        self
    }
}
