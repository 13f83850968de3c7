//! The scene of instances and the tree of their boxes.

use crate::instance::shape;
use crate::object::Objects;
use crate::{Instance, InstanceId};
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::{Aabb, AnyIndex, Feature, Primitive, PrimitiveId, PrimitiveSet, Projection, Ray, RayHit, Real, Shape};
use std::marker::PhantomData;

/// A scene of instances of indexes, which is an index itself.
///
/// `I` is the type of the indexes, such as `AabbTree<f64, Soup<f64>>`. Instances of `dyn AnyIndex<T>`, the default, may
/// have indexes of different types. [The crate](crate) has the contract and an example.
///
/// Queries are methods of [`ClosestPoint`](p2m_core::ClosestPoint), [`NearQuery`](p2m_core::NearQuery),
/// [`RayQuery`](p2m_core::RayQuery) and [`BoxQuery`](p2m_core::BoxQuery). A scene in f64 is also a
/// [`CertifiedQuery`](p2m_core::CertifiedQuery) and an [`AnyIndex`], so instances of it can be part of another scene.
/// Certified answers in f32 are left out, because the moved vertices are not in f32.
///
/// The scene is a [`PrimitiveSet`] of the moved primitives in f64, over which another index can be built.
///
/// # Accuracy
/// All answers have the accuracy that their traits promise, with respect to the moved vertices. These differ from the
/// exact ones as [`Motion`](p2m_core::pair::Motion) states. A limit on the visits of a query has no effect,
/// and an epsilon has.
///
/// # Complexity
/// A query searches the tree of boxes in expected O(log n) for n instances, and the index of each instance whose box it
/// reaches before the answer is known. Rays and boxes test all primitives of an object whose index does not answer
/// them. A scene takes at most 400 bytes per instance besides its name.
#[derive(Debug)]
pub struct Instances<T: Real = f64, I: ?Sized = dyn AnyIndex<T>> {
    /// The instances in the order of their ids.
    pub(crate) instances: Vec<Instance<I>>,
    pub(crate) next_id: u64,
    pub(crate) objects: Objects<I>,
    /// The tree of the boxes of all instances that are not empty. It is missing during an edit.
    pub(crate) tree: Option<InstanceTree>,
    scalar: PhantomData<T>,
}

/// The tree of the boxes of instances.
#[derive(Debug)]
pub(crate) struct InstanceTree {
    pub(crate) tree: AabbTree<f64, Vec<InstanceBox>>,
    /// The surface area of all boxes after the build.
    pub(crate) area: f64,
}

/// The box of an instance, as a primitive of the tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InstanceBox {
    pub(crate) bounds: Aabb<f64>,
    /// The position in the list of instances.
    pub(crate) position: usize,
}

impl Primitive<f64> for InstanceBox {
    fn aabb(&self) -> Aabb<f64> {
        self.bounds
    }

    fn project(&self, query: &Point3<f64>) -> Projection {
        // The key is the lower bound of the box, which exceeds no key of a primitive inside.
        Projection::new(query, self.bounds.clamp(*query), Feature::Face, [1.0, 0.0, 0.0], 0.0)
    }

    fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
        unreachable!("rays visit the candidates of the tree, which are not tested")
    }
}

impl<T: Real, I: AnyIndex<T> + ?Sized> Default for Instances<T, I> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, I: AnyIndex<T> + ?Sized> Instances<T, I> {
    /// Creates a scene without instances.
    #[must_use]
    pub fn new() -> Self {
        Self { instances: Vec::new(), next_id: 0, objects: Objects::new(), tree: None, scalar: PhantomData }
    }

    /// Returns the number of instances.
    #[must_use]
    pub fn instance_count(&self) -> usize {
        self.instances.len()
    }

    /// Returns all instances in the order in which they were added.
    pub fn instances(&self) -> impl ExactSizeIterator<Item = &Instance<I>> {
        self.instances.iter()
    }

    /// Returns an instance, or `None` if the scene has none of this id.
    ///
    /// # Complexity
    /// It takes O(log n) for n instances.
    #[must_use]
    pub fn instance(&self, id: InstanceId) -> Option<&Instance<I>> {
        self.position(id).map(|at| &self.instances[at])
    }

    /// Returns the instance of a primitive of the scene, and the id of the primitive in the object of that instance. It
    /// is `None` if the scene has no such primitive.
    ///
    /// # Complexity
    /// It takes O(log n) for n instances.
    #[must_use]
    pub fn instance_of(&self, primitive: PrimitiveId) -> Option<(InstanceId, PrimitiveId)> {
        self.owner_of(primitive).map(|(instance, local)| (instance.id, local))
    }

    /// Returns a box around the moved vertices of all instances, which is empty if there are none. It may be larger
    /// than the smallest one.
    ///
    /// # Complexity
    /// It takes O(n) for n instances.
    #[must_use]
    pub fn bounds(&self) -> Aabb<f64> {
        self.instances.iter().fold(Aabb::empty(), |all, instance| all.union(&instance.bounds))
    }

    /// Returns the position of an instance in the list.
    pub(crate) fn position(&self, id: InstanceId) -> Option<usize> {
        self.instances.binary_search_by_key(&id, |instance| instance.id).ok()
    }

    /// Returns the instance of a primitive, and its id in the object.
    pub(crate) fn owner_of(&self, primitive: PrimitiveId) -> Option<(&Instance<I>, PrimitiveId)> {
        // Several instances may begin at the same id. All of them but the last are empty.
        let after = self.instances.partition_point(|instance| instance.first <= primitive.index());
        let instance = &self.instances[after.checked_sub(1)?];
        let local = primitive.index() - instance.first;
        (local < instance.object.count).then(|| (instance, PrimitiveId::new(local)))
    }

    /// Returns the number of primitives of all instances.
    pub(crate) fn count_primitives(&self) -> usize {
        self.instances.last().map_or(0, |last| last.first + last.object.count)
    }
}

/// The moved primitives in f64, for scenes of both scalars.
impl<T: Real, I: AnyIndex<T> + ?Sized> PrimitiveSet<f64> for Instances<T, I> {
    type Primitive<'a>
        = Shape<f64>
    where
        Self: 'a;

    fn len(&self) -> usize {
        self.count_primitives()
    }

    fn get(&self, id: PrimitiveId) -> Shape<f64> {
        let (instance, local) = self.owner_of(id).expect("the id of a primitive of the scene");
        shape(&instance.moved(local, &[]))
    }
}
