//! The domain of an octree, and the cube around it.

use crate::options::{Domain, OctreeOptions};
use nalgebra::{Point3, Vector3};
use p2m_bvh::PacketTree;
use p2m_core::Aabb;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;

/// The side of [`Domain::Everywhere`], in sizes of the scene.
pub(crate) const EVERYWHERE_SCENE_SIZES: f64 = 10.0;

/// The cube of a domain.
pub(crate) struct DomainCube {
    /// The low corner of the cube.
    pub(crate) low: V3,
    /// The side of the cube, a power of two.
    pub(crate) side: f64,
    /// The slack of the corner test: a dominator has to be nearer by this much.
    pub(crate) slack: f64,
    /// The box of the domain.
    pub(crate) domain: Aabb<f64>,
    /// The centre of the scene.
    pub(crate) scene_centre: Point3<f64>,
    /// The lengths of the scene's box, which are not zero.
    pub(crate) scene_extent: Vector3<f64>,
}

impl DomainCube {
    /// Chooses the cube. The result is `None`, and the tree answers everything, if the scene or the domain has no
    /// extent, or if coordinates in f32 cannot resolve the scene.
    #[allow(clippy::cast_possible_truncation, reason = "an exponent")]
    pub(crate) fn from_tree(tree: &PacketTree, options: &OctreeOptions) -> Option<Self> {
        let bounds = tree.bounds();
        let extent = bounds.max - bounds.min;
        let size = extent.max();
        let centre = bounds.min + extent * 0.5;
        // The box of a flat scene is flat, but the domain has to contain queries beside the scene as well.
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
        let longest = span.max();
        let is_bounded = span.iter().all(|x| *x > 0.0 && x.is_finite()) && domain.min.iter().all(|x| x.is_finite());
        let is_usable = size > 0.0 && size.is_finite() && tree.frame.is_plain() && is_bounded;
        // The frame of the scene has to resolve cells in f32, and cells have to be small enough to be of use.
        if !is_usable || longest > size * 2f64.powi(20) || longest < size * 2f64.powi(-20) {
            return None;
        }
        // The side is a power of two and the corner is a multiple of a small part of it, so that all corners of cells
        // are exact.
        let side = 2f64.powi((longest * 1.0001).log2().ceil() as i32);
        let grain = side / 4096.0;
        let domain_centre = domain.min + span * 0.5;
        let low: V3 = std::array::from_fn(|k| ((domain_centre[k] - side * 0.5) / grain).floor() * grain);
        let scene_corners = [to_f64_array(&bounds.min), to_f64_array(&bounds.max)];
        let scale = side * 4.0 + low.iter().chain(scene_corners.as_flattened()).fold(0.0f64, |a, x| a.max(x.abs()));
        Some(Self {
            low,
            side,
            // The rounding of keys, of dominators and of locating a query is below 2^-46 of `scale`.
            slack: scale / (1u64 << 42) as f64,
            domain,
            scene_centre: centre,
            scene_extent: extent,
        })
    }
}
