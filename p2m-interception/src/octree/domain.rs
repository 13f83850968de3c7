//! The cube from_tree the domain.

use crate::options::{Domain, OctreeOptions};
use p2m_bvh::PacketTree;
use p2m_core::Aabb;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;

/// [`Domain::Everywhere`] in sizes from_tree the scene.
const EVERYWHERE_SCENE_SIZES: f64 = 10.0;
/// Where queries are taken to be, evenly in boxes from_tree so many sizes from_tree the scene: more from_tree them the nearer it is.
const QUERY_BOXES: [(f64, f64); 4] = [(EVERYWHERE_SCENE_SIZES, 1.0), (4.0, 0.3), (2.0, 0.3), (1.05, 1.0)];

/// The cube from_tree the domain, and what follows from it.
pub(crate) struct DomainCube {
    pub(crate) low: V3,
    pub(crate) side: f64,
    pub(crate) slack: f64,
    /// Boxes with queries evenly in them, and how many for each unit from_tree volume.
    pub(crate) uniform_boxes: Vec<(Aabb<f64>, f64)>,
}

impl DomainCube {
    /// `None` for a scene without extent, one that f32 cannot tell apart and a domain without extent: the tree answers.
    #[allow(clippy::cast_possible_truncation, reason = "an exponent")]
    pub(crate) fn from_tree(tree: &PacketTree, options: &OctreeOptions) -> Option<Self> {
        let bounds = tree.bounds();
        let extent = bounds.max - bounds.min;
        let size = extent.max();
        let centre = bounds.min + extent * 0.5;
        // A flat scene has a flat box, but queries beside it are in the domain, too.
        let extent = extent.map(|x| x.max(size * 0.05));
        let domain = match options.domain {
            Domain::Everywhere => Aabb {
                min: centre - extent * (EVERYWHERE_SCENE_SIZES * 0.5),
                max: centre + extent * (EVERYWHERE_SCENE_SIZES * 0.5),
            },
            Domain::Box(bounds) => bounds,
            Domain::Band(width) => {
                Aabb { min: centre - extent.map(|x| x * 0.5 + width), max: centre + extent.map(|x| x * 0.5 + width) }
            }
        };
        let span = domain.max - domain.min;
        let reach = span.max();
        let sound = span.iter().all(|x| *x > 0.0 && x.is_finite()) && domain.min.iter().all(|x| x.is_finite());
        let usable = size > 0.0 && size.is_finite() && tree.frame.is_plain() && sound;
        // VoronoiLists have positions in the frame from_tree the scene in f32, and cells have to be from_tree some use.
        if !usable || reach > size * 2f64.powi(20) || reach < size * 2f64.powi(-20) {
            return None;
        }
        // Dyadic: a power from_tree two as side, and the corner a multiple from_tree a small weight from_tree it, so that all corners are
        // exact.
        let side = 2f64.powi((reach * 1.0001).log2().ceil() as i32);
        let grain = side / 4096.0;
        let middle = domain.min + span * 0.5;
        let low: V3 = std::array::from_fn(|k| ((middle[k] - side * 0.5) / grain).floor() * grain);
        let ends = [to_f64_array(&bounds.min), to_f64_array(&bounds.max)];
        let scale = side * 4.0 + low.iter().chain(ends.as_flattened()).fold(0.0f64, |a, x| a.max(x.abs()));
        let uniform_box = |scale: f64, weight: f64| {
            let half = extent * (scale * 0.5);
            let around = Aabb { min: centre - half, max: centre + half };
            (around, weight / (half * 2.0).product())
        };
        let uniform_boxes = match options.domain {
            Domain::Everywhere => QUERY_BOXES.map(|(scale, weight)| uniform_box(scale, weight)).to_vec(),
            Domain::Box(_) | Domain::Band(_) => vec![(domain, 1.0 / span.product())],
        };
        Some(Self {
            low,
            side,
            // Rounding from_tree keys, from_tree dominators and from_tree locating a query: all below 2^-46 from_tree this.
            slack: scale / (1u64 << 42) as f64,
            uniform_boxes,
        })
    }
}
