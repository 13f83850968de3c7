//! Objects: the data that all instances of an index share.

use crate::InstanceError;
use p2m_core::{Aabb, AnyIndex, Primitive, PrimitiveId, Real};
use std::collections::HashMap;
use std::sync::{Arc, Weak};

/// An index and the measures of its scene.
#[derive(Debug)]
pub(crate) struct Object<I: ?Sized> {
    /// The number of primitives.
    pub(crate) count: usize,
    /// The box around all primitives in the frame of the object.
    pub(crate) bounds: Aabb<f64>,
    /// An upper bound on the distances of the vertices from the origin: the sum of the largest magnitudes of the three
    /// coordinates.
    pub(crate) reach: f64,
    pub(crate) index: Arc<I>,
}

impl<I: ?Sized> Object<I> {
    /// Measures the scene of an index.
    fn new<T: Real>(index: &Arc<I>) -> Result<Self, InstanceError>
    where
        I: AnyIndex<T>,
    {
        let count = index.primitive_count();
        let mut bounds = Aabb::<T>::empty();
        for id in (0..count).map(PrimitiveId::new) {
            let shape = index.shape(id).ok_or(InstanceError::NoVertices { id })?;
            bounds = bounds.union(&shape.aabb());
        }
        let bounds = bounds.to_f64();
        let reach = if count == 0 { 0.0 } else { (0..3).map(|k| bounds.min[k].abs().max(bounds.max[k].abs())).sum() };
        Ok(Self { count, bounds, reach, index: Arc::clone(index) })
    }
}

/// The objects of a scene by the addresses of their indexes, so that an index which has many instances
/// is measured once.
#[derive(Debug)]
pub(crate) struct Objects<I: ?Sized>(HashMap<usize, Weak<Object<I>>>);

impl<I: ?Sized> Objects<I> {
    pub(crate) fn new() -> Self {
        Self(HashMap::new())
    }

    /// Returns the object of an index.
    pub(crate) fn of<T: Real>(&mut self, index: &Arc<I>) -> Result<Arc<Object<I>>, InstanceError>
    where
        I: AnyIndex<T>,
    {
        // An object keeps its index alive, so no other index has its address.
        let address = Arc::as_ptr(index).cast::<()>().addr();
        if let Some(object) = self.0.get(&address).and_then(Weak::upgrade) {
            return Ok(object);
        }
        self.0.retain(|_, object| object.strong_count() > 0);
        let object = Arc::new(Object::new(index)?);
        self.0.insert(address, Arc::downgrade(&object));
        Ok(object)
    }
}
