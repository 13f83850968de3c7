//! Indexes of all backends over a shared scene, behind one pointer.
//!
//! The registry of backends (`p2m_backends::BACKENDS`) builds indexes over borrowed scenes, which an object of Python
//! cannot keep. So indexes are built here over [`SharedScene`]; names and saved forms are those of the registry.

use crate::scene::SharedScene;
use crate::work::Monitor;
use p2m_backends::{BackendEntry, ChosenDirections, KdopDirections};
use p2m_bvh::{AabbTree, SplitOptions, TreeIndex, Volume};
use p2m_core::storage::{LoadError, Reader};
use p2m_core::{AnyIndex, BruteForce, BuildError, BuildIndex};
use p2m_interception::{
    InterceptionIndex, Octree, OctreeIndex, OctreeOptions, P2mIndex, P2mOptions, Progress, Voronoi,
};
use p2m_kdop::{DirectionChoice, Directions, Kdop, KdopOptions, KdopTree};
use std::fmt;
use std::sync::Arc;

/// The part of a build, of which `part` is finished, in these units.
pub(crate) const BUILD_UNITS: usize = 100;

/// An index over a shared scene.
pub(crate) trait Searchable: AnyIndex<f64> {
    /// Returns a copy that is fitted to a scene in which the same primitives have moved, or nothing if the backend
    /// has to build anew.
    fn refitted(&self, scene: &SharedScene) -> Option<Result<Arc<dyn Searchable>, BuildError>>;

    /// Returns the sum of the areas of the boxes of a tree.
    fn surface_area(&self) -> Option<f64> {
        None
    }

    /// Returns a phrase about the cells of the index.
    fn cells(&self) -> Option<String> {
        None
    }
}

impl Searchable for BruteForce<SharedScene> {
    fn refitted(&self, scene: &SharedScene) -> Option<Result<Arc<dyn Searchable>, BuildError>> {
        Some(build_brute(scene.clone()))
    }
}

/// Implements the trait for trees.
macro_rules! searchable_trees {
    ($($tree:ty, $options:ty;)*) => { $(
        impl Searchable for $tree {
            fn refitted(&self, scene: &SharedScene) -> Option<Result<Arc<dyn Searchable>, BuildError>> {
                let mut copy = self.clone();
                let refitted = copy.refit(scene.clone(), &<$options>::default());
                Some(refitted.map(|()| Arc::new(copy) as Arc<dyn Searchable>))
            }

            fn surface_area(&self) -> Option<f64> {
                Some(TreeIndex::surface_area(self))
            }
        }
    )* };
}

searchable_trees! {
    AabbTree<f64, SharedScene>, SplitOptions;
    KdopTree<f64, SharedScene, 6>, KdopOptions<6>;
    KdopTree<f64, SharedScene, 14>, KdopOptions<14>;
    KdopTree<f64, SharedScene, 18>, KdopOptions<18>;
    KdopTree<f64, SharedScene, 26>, KdopOptions<26>;
}

impl Searchable for OctreeIndex<f64, SharedScene> {
    fn refitted(&self, _: &SharedScene) -> Option<Result<Arc<dyn Searchable>, BuildError>> {
        None
    }
    fn cells(&self) -> Option<String> {
        Some(self.report().to_string())
    }
}

impl Searchable for P2mIndex<f64, SharedScene> {
    fn refitted(&self, _: &SharedScene) -> Option<Result<Arc<dyn Searchable>, BuildError>> {
        None
    }
    fn cells(&self) -> Option<String> {
        Some(self.report().to_string())
    }
}

/// An index with the details that its saved form has beside it.
#[derive(Clone)]
pub(crate) struct Built {
    pub(crate) index: Arc<dyn Searchable>,
    /// The directions of a k-DOP tree.
    pub(crate) directions: Option<ChosenDirections>,
}

impl Built {
    fn new<I: Searchable + 'static>(index: I) -> Self {
        Self { index: Arc::new(index), directions: None }
    }
}

/// The settings of a build.
#[derive(Clone, Copy, Default)]
pub(crate) struct Settings {
    /// The directions of a k-DOP tree.
    pub(crate) directions: Option<KdopDirections>,
    /// The fineness of the cells of an octree.
    pub(crate) resolution: Option<f64>,
}

fn build_brute(scene: SharedScene) -> Result<Arc<dyn Searchable>, BuildError> {
    Ok(Arc::new(BruteForce::build(scene, &())?))
}

/// Builds the index of a backend of the registry, and returns nothing for one that is not known here.
pub(crate) fn build(
    backend: &BackendEntry,
    scene: SharedScene,
    settings: &Settings,
    monitor: &Monitor,
) -> Option<Result<Built, BuildError>> {
    let progress = |progress: Progress| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part is from 0 to 1")]
        monitor.set_done((progress.part * BUILD_UNITS as f64) as usize);
        monitor.unwind_if_cancelled();
    };
    Some(match backend.name {
        "brute" => build_brute(scene).map(|index| Built { index, directions: None }),
        "aabb" => AabbTree::build(scene, &SplitOptions::default()).map(Built::new),
        "kdop" => build_kdop(scene, settings.directions.unwrap_or(KdopDirections::Fourteen)),
        "octree" => {
            let options = OctreeOptions::default();
            let factor = settings.resolution.map_or(1.0, |resolution| resolution / options.resolution);
            let options = options.with_finer_cells(factor);
            InterceptionIndex::<f64, _, Octree>::build_with_progress(scene, &options, &progress).map(Built::new)
        }
        "p2m" => {
            let options = P2mOptions::default();
            InterceptionIndex::<f64, _, Voronoi>::build_with_progress(scene, &options, &progress).map(Built::new)
        }
        _ => return None,
    })
}

fn build_kdop(scene: SharedScene, directions: KdopDirections) -> Result<Built, BuildError> {
    let choice = if directions == KdopDirections::Scene { Some(DirectionChoice::from_scene(&scene)?) } else { None };
    let choice = choice.as_ref();
    let mut built = match directions.faces() {
        6 => build_kdop_of::<6>(scene, choice),
        14 => build_kdop_of::<14>(scene, choice),
        18 => build_kdop_of::<18>(scene, choice),
        _ => build_kdop_of::<26>(scene, choice),
    }?;
    let faces = directions.faces();
    let reason = choice.map(|choice| format!("{faces} {choice}"));
    built.directions = Some(ChosenDirections { faces, reason });
    Ok(built)
}

fn build_kdop_of<const K: usize>(scene: SharedScene, choice: Option<&DirectionChoice>) -> Result<Built, BuildError>
where
    Directions<K>: Default,
    KdopTree<f64, SharedScene, K>: Searchable,
    Kdop<K>: Volume<Options = KdopOptions<K>>,
{
    let directions = choice.and_then(|choice| choice.directions::<K>().ok()).unwrap_or_default();
    KdopTree::<f64, SharedScene, K>::build_with(scene, &KdopOptions::new(directions)).map(Built::new)
}

/// Loads the index of a backend of the registry from a file, and returns nothing for one that is not known here.
pub(crate) fn load(backend: &BackendEntry, scene: SharedScene, reader: &Reader) -> Option<Result<Built, LoadError>> {
    Some(match backend.name {
        "aabb" => AabbTree::load(scene, reader).map(Built::new),
        "kdop" => load_kdop(scene, reader),
        "octree" => OctreeIndex::load(scene, reader).map(Built::new),
        "p2m" => P2mIndex::load(scene, reader).map(Built::new),
        _ => return None,
    })
}

fn load_kdop(scene: SharedScene, reader: &Reader) -> Result<Built, LoadError> {
    let faces = KdopDirections::saved_faces(None, reader).unwrap_or(14);
    let built = match faces {
        6 => KdopTree::<f64, _, 6>::load(scene, reader).map(Built::new),
        14 => KdopTree::<f64, _, 14>::load(scene, reader).map(Built::new),
        18 => KdopTree::<f64, _, 18>::load(scene, reader).map(Built::new),
        _ => KdopTree::<f64, _, 26>::load(scene, reader).map(Built::new),
    }?;
    Ok(Built { directions: Some(ChosenDirections::of_saved(faces, reader)), ..built })
}

impl fmt::Debug for Built {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Built").field("directions", &self.directions).finish_non_exhaustive()
    }
}
