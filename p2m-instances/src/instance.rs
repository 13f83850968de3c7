//! One instance of an object.

use crate::InstanceError;
use crate::id::InstanceId;
use crate::object::Object;
use nalgebra::Isometry3;
use p2m_core::pair::{Hull, Motion};
use p2m_core::{Aabb, AnyIndex, PrimitiveId, Real, Shape};
use std::ops::Range;
use std::sync::Arc;

/// An instance: an object with a name and a motion.
#[derive(Debug)]
pub struct Instance<I: ?Sized> {
    pub(crate) id: InstanceId,
    name: Box<str>,
    pub(crate) object: Arc<Object<I>>,
    /// The id of its first primitive in the scene.
    pub(crate) first: usize,
    isometry: Isometry3<f64>,
    pub(crate) motion: Motion,
    /// The box around the moved vertices, which is empty for an empty object.
    pub(crate) bounds: Aabb<f64>,
    /// An upper bound on the distances of the vertices from the origin before the motion, plus the translation.
    reach: f64,
}

/// The bound on the difference between a query on the moved vertices and the same query in the frame of the object, in
/// units of the largest magnitudes: 128 u.
///
/// Let q be the query, t the translation and v a vertex. A moved vertex errs by at most 32 u (|v| + |t|) and a query
/// that is moved back by 32 u (|q| + |t|). The kernel errs by 8 u (|q| + |t| + |v|) in either frame. That is less than
/// 80 u (|q| + |t| + |v|). For rays, whose tests are exact, the direction errs by 32 u of itself, which is at most 32 u
/// (|q| + |t| + |v|) where the ray reaches the object, and a radius changes by less than 32 u of itself; together 96 u.
/// Both leave room for another two errors of the kernel and for the rounding of the margin.
const MARGIN: f64 = 64.0 * f64::EPSILON;

impl<I: ?Sized> Instance<I> {
    pub(crate) fn new(
        id: InstanceId,
        name: &str,
        object: Arc<Object<I>>,
        first: usize,
        isometry: Isometry3<f64>,
    ) -> Result<Self, InstanceError> {
        let (motion, bounds, reach) = moved(&object, &isometry)?;
        Ok(Self { id, name: name.into(), object, first, isometry, motion, bounds, reach })
    }

    pub(crate) fn set_motion(&mut self, isometry: Isometry3<f64>) -> Result<(), InstanceError> {
        (self.motion, self.bounds, self.reach) = moved(&self.object, &isometry)?;
        self.isometry = isometry;
        Ok(())
    }

    /// Returns the id of the instance.
    #[must_use]
    pub fn id(&self) -> InstanceId {
        self.id
    }

    /// Returns the name, which need not be unique.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the motion.
    #[must_use]
    pub fn motion(&self) -> &Isometry3<f64> {
        &self.isometry
    }

    /// Returns the index of the object, in its own frame.
    #[must_use]
    pub fn index(&self) -> &Arc<I> {
        &self.object.index
    }

    /// Returns a box around the moved vertices, which is empty for an empty object. It is the moved box of the object,
    /// so it may be larger than the smallest one.
    #[must_use]
    pub fn bounds(&self) -> Aabb<f64> {
        self.bounds
    }

    /// Returns the ids of the primitives in the scene, as numbers. They change when an earlier instance is removed.
    #[must_use]
    pub fn primitives(&self) -> Range<usize> {
        self.first..self.first + self.object.count
    }

    /// Returns the bytes of the name, which is on the heap.
    pub(crate) fn name_bytes(&self) -> usize {
        self.name.len()
    }

    /// Returns the id in the scene of a primitive of the object.
    pub(crate) fn scene_id(&self, local: PrimitiveId) -> PrimitiveId {
        PrimitiveId::new(self.first + local.index())
    }

    /// Returns the ids of all primitives of the object.
    pub(crate) fn local_ids(&self) -> impl Iterator<Item = PrimitiveId> + use<I> {
        (0..self.object.count).map(PrimitiveId::new)
    }

    /// Returns the distance within which an answer in the frame of the object equals the answer for the moved vertices.
    /// `query_size` is at least the distance of any point of the query from the origin.
    pub(crate) fn margin(&self, query_size: f64) -> f64 {
        // The smallest normal number covers all that underflows.
        MARGIN * (query_size + self.reach) + f64::MIN_POSITIVE
    }

    /// Returns a primitive of the object after the motion. `vertices` are those in the frame of the object, if
    /// they are known.
    ///
    /// # Panics
    /// Panics if the index has lost a primitive that it had when the instance was added.
    pub(crate) fn moved<T: Real>(&self, local: PrimitiveId, vertices: &[[f64; 3]]) -> Hull
    where
        I: AnyIndex<T>,
    {
        let hull = if vertices.is_empty() {
            Hull::of(&self.object.index.shape(local).expect("the index has all primitives that it was added with"))
        } else {
            Hull::new(vertices)
        };
        hull.map(|vertex| self.motion.apply(vertex))
    }
}

/// Returns a moved primitive as a shape.
pub(crate) fn shape(hull: &Hull) -> Shape<f64> {
    Shape::from_vertices(hull.vertices()).expect("one to three vertices")
}

/// Returns the motion of an isometry, the moved box of an object, and an upper bound on the distances of its vertices
/// from the origin plus the length of the translation.
fn moved<I: ?Sized>(object: &Object<I>, isometry: &Isometry3<f64>) -> Result<(Motion, Aabb<f64>, f64), InstanceError> {
    let motion = Motion::new(isometry);
    if !motion.is_finite() {
        return Err(InstanceError::NonFiniteMotion);
    }
    // No partial sum of a moved coordinate is much larger than this one.
    let reach = object.reach + size(motion.translation());
    let bounds = if object.count == 0 { Aabb::empty() } else { motion.apply_to_box(&object.bounds) };
    if object.count > 0 && !(bounds.is_finite() && (2.0 * reach).is_finite()) {
        return Err(InstanceError::OutOfRange);
    }
    Ok((motion, bounds, reach))
}

/// Returns the sum of the magnitudes of the components, which is at least the length.
pub(crate) fn size(vector: [f64; 3]) -> f64 {
    vector[0].abs() + vector[1].abs() + vector[2].abs()
}
