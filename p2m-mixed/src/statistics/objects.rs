//! The primitives of each named object.

use super::Counts;
use crate::Scene;
use p2m_core::PrimitiveId;
use std::collections::HashMap;

/// The number of primitives under one name.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ObjectCounts {
    /// The name, or `None` for primitives without a name.
    pub name: Option<String>,
    /// The number of primitives of each kind.
    pub primitives: Counts,
}

/// Counts the primitives under each name of a scene, in the order in which names first appear.
///
/// Objects of the same name are counted together. Primitives without a name come last. A scene without names
/// has no counts.
///
/// ```
/// use p2m_mixed::statistics::objects;
///
/// let scene = p2m_mixed::read_obj("v 0 0 0\np 1\no pole\np 1\np 1\n".as_bytes(), "poles.obj")?;
/// let found: Vec<_> = objects(&scene).into_iter().map(|o| (o.name, o.primitives.points)).collect();
/// assert_eq!(found, [(Some("pole".to_owned()), 2), (None, 1)]);
/// # Ok::<(), p2m_mixed::ReadError>(())
/// ```
///
/// # Complexity
/// O(n).
///
/// # Panics
/// If an object has ids beyond the end of the scene, which does not happen for scenes of readers.
#[must_use]
pub fn objects(scene: &Scene) -> Vec<ObjectCounts> {
    if scene.objects.is_empty() {
        return Vec::new();
    }
    let mut list: Vec<ObjectCounts> = Vec::new();
    let mut places: HashMap<&str, usize> = HashMap::new();
    let mut unnamed = Counts::of(&scene.soup);
    for object in &scene.objects {
        let place = *places.entry(&object.name).or_insert_with(|| {
            list.push(ObjectCounts { name: Some(object.name.clone()), primitives: Counts::default() });
            list.len() - 1
        });
        for id in object.ids.clone() {
            let element = scene.soup.element(PrimitiveId::new(id));
            *list[place].primitives.of_kind(element) += 1;
            let rest = unnamed.of_kind(element);
            *rest = rest.saturating_sub(1);
        }
    }
    if unnamed.total() > 0 {
        list.push(ObjectCounts { name: None, primitives: unnamed });
    }
    list
}
