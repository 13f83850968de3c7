//! Edits of a scene, at the end of which its tree is updated once.

use crate::instance::Instance;
use crate::instances::{InstanceBox, InstanceTree};
use crate::{InstanceError, InstanceId, Instances};
use nalgebra::Isometry3;
use p2m_core::{AnyIndex, BuildIndex, PrimitiveId, Real};
use std::ops::Deref;
use std::sync::Arc;

/// The largest factor by which a refit may enlarge the area of the boxes since the tree was built. Beyond it, the tree
/// is built anew.
const MAX_AREA_GROWTH: f64 = 4.0 / 3.0;

/// An edit of a scene: instances are added, moved and removed, and the tree of the scene is updated when the edit is
/// dropped. The methods of the edit read the scene as well.
///
/// An edit that is leaked ([`std::mem::forget`]) leaves the scene without a tree until the next edit, so that queries
/// test all instances.
///
/// # Complexity
/// The end of an edit takes O(n log n) for n instances if any was added or removed. It takes O(n) after motions alone,
/// unless the boxes have become so large that the tree is built anew.
#[derive(Debug)]
pub struct Edit<'a, T: Real, I: AnyIndex<T> + ?Sized> {
    scene: &'a mut Instances<T, I>,
    /// The tree before the edit, if there was one and it still has the same instances.
    tree: Option<InstanceTree>,
    /// Whether an instance was moved.
    has_moved: bool,
}

impl<T: Real, I: AnyIndex<T> + ?Sized> Instances<T, I> {
    /// Begins to change the scene. The changes are complete when the edit is dropped, which
    /// `scene.edit().add(..)` does at once.
    pub fn edit(&mut self) -> Edit<'_, T, I> {
        Edit::new(self)
    }
}

impl<'a, T: Real, I: AnyIndex<T> + ?Sized> Edit<'a, T, I> {
    pub(crate) fn new(scene: &'a mut Instances<T, I>) -> Self {
        let tree = scene.tree.take();
        Self { scene, tree, has_moved: false }
    }

    /// Adds an instance of an index, whose motion is applied to its vertices, and returns its id. Its primitives get
    /// the ids after the ids of all other instances.
    ///
    /// The index has to answer as if its scene never changed, which all indexes of this project do.
    ///
    /// # Errors
    /// Returns [`InstanceError::NonFiniteMotion`] and [`InstanceError::OutOfRange`] for the motion,
    /// [`InstanceError::NoVertices`] for the object, and [`InstanceError::TooMany`] for the scene.
    ///
    /// # Complexity
    /// It takes O(n) for the first instance of an index of n primitives, and O(1) for others.
    pub fn add(&mut self, name: &str, index: &Arc<I>, motion: Isometry3<f64>) -> Result<InstanceId, InstanceError> {
        let scene = &mut *self.scene;
        let object = scene.objects.of(index)?;
        let (first, id) = (scene.count_primitives(), InstanceId(scene.next_id));
        let len = first.saturating_add(object.count);
        if len > PrimitiveId::MAX_COUNT {
            return Err(InstanceError::TooMany { len });
        }
        scene.instances.push(Instance::new(id, name, object, first, motion)?);
        scene.next_id += 1;
        self.tree = None;
        Ok(id)
    }

    /// Replaces the motion of an instance.
    ///
    /// # Errors
    /// Returns [`InstanceError::Unknown`], and [`InstanceError::NonFiniteMotion`] and
    /// [`InstanceError::OutOfRange`] for the motion.
    ///
    /// # Complexity
    /// It takes O(log n) for n instances.
    pub fn set_motion(&mut self, id: InstanceId, motion: Isometry3<f64>) -> Result<(), InstanceError> {
        let at = self.scene.position(id).ok_or(InstanceError::Unknown { id })?;
        self.has_moved = true;
        self.scene.instances[at].set_motion(motion)
    }

    /// Replaces the motions of all instances, in the order of their ids, by what `motion` returns for each.
    ///
    /// # Errors
    /// Returns the errors of [`set_motion`](Self::set_motion). The instances before the one that failed have moved.
    pub fn move_all(&mut self, mut motion: impl FnMut(&Instance<I>) -> Isometry3<f64>) -> Result<(), InstanceError> {
        self.has_moved = true;
        self.scene.instances.iter_mut().try_for_each(|instance| {
            let motion = motion(instance);
            instance.set_motion(motion)
        })
    }

    /// Removes an instance. The primitives of all later instances get lower ids, as if it had never been added.
    ///
    /// # Errors
    /// Returns [`InstanceError::Unknown`].
    ///
    /// # Complexity
    /// It takes O(n) for n instances.
    pub fn remove(&mut self, id: InstanceId) -> Result<(), InstanceError> {
        let at = self.scene.position(id).ok_or(InstanceError::Unknown { id })?;
        let removed = self.scene.instances.remove(at);
        for later in &mut self.scene.instances[at..] {
            later.first -= removed.object.count;
        }
        self.tree = None;
        Ok(())
    }
}

impl<T: Real, I: AnyIndex<T> + ?Sized> Deref for Edit<'_, T, I> {
    type Target = Instances<T, I>;

    fn deref(&self) -> &Self::Target {
        self.scene
    }
}

impl<T: Real, I: AnyIndex<T> + ?Sized> Drop for Edit<'_, T, I> {
    fn drop(&mut self) {
        let scene = &mut *self.scene;
        let options = Default::default();
        let kept = self.tree.take().and_then(|mut tree| {
            if !self.has_moved {
                return Some(tree);
            }
            let refit = tree.tree.refit_in_place(&options, |boxes: &mut Vec<InstanceBox>| {
                boxes.iter_mut().for_each(|one| one.bounds = scene.instances[one.position].bounds);
                Ok(())
            });
            let is_good = refit.is_ok() && tree.tree.surface_area() <= tree.area * MAX_AREA_GROWTH;
            is_good.then_some(tree)
        });
        scene.tree = kept.or_else(|| {
            let instances = scene.instances.iter().enumerate();
            let boxes = instances
                .filter(|(_, instance)| instance.object.count > 0)
                .map(|(position, instance)| InstanceBox { bounds: instance.bounds, position })
                .collect();
            // A scene without a tree tests all instances. That does not happen, because all boxes are finite.
            let tree = p2m_bvh::AabbTree::build(boxes, &options).ok()?;
            Some(InstanceTree { area: tree.surface_area(), tree })
        });
    }
}
