//! The node of an AABB tree, which bounds its children by boxes.

use crate::packet::Member;
use crate::tree::frame::{Frame, FrameBox};
use crate::tree::frame_line::FrameLine;
use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::ray_slab::{RayInterval, SlabRay};
use crate::tree::rounded::Rounded;
use crate::tree::wide_node::{VolumeNodes, WideNode};
use nalgebra::Point3;
use p2m_core::Aabb;
use p2m_core::engine::pairs::{Height, Rows};
use p2m_core::engine::simd::Lanes;
use p2m_core::storage::{LoadError, Reader, Writer};

/// A node of eight boxes, stored side by side. The boxes of unused slots are empty, so they are infinitely far from
/// everything.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct BoxNode {
    min: [[f32; WIDTH]; 3],
    max: [[f32; WIDTH]; 3],
    children: [NodeRef; WIDTH],
}

const _: () = assert!(size_of::<BoxNode>() == 256);

impl Rows for BoxNode {
    #[inline(always)]
    fn row(&self, number: usize) -> &[f32; WIDTH] {
        if number < 3 { &self.min[number] } else { &self.max[number - 3] }
    }
}

impl WideNode for BoxNode {
    const INLINES_PORTABLE: bool = true;
    type Volume = Aabb<f64>;
    type Shared = ();
    type Bounds = FrameBox;
    type Query = Rounded;
    type Ray = [SlabRay; 3];

    const EMPTY: FrameBox = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    const ROWS: usize = 6;

    fn new(children: [NodeRef; WIDTH]) -> Self {
        Self { min: [[f32::INFINITY; WIDTH]; 3], max: [[f32::NEG_INFINITY; WIDTH]; 3], children }
    }

    #[inline(always)]
    fn children(&self) -> &[NodeRef; WIDTH] {
        &self.children
    }

    fn from_rows(rows: &[[f32; WIDTH]], children: [NodeRef; WIDTH]) -> Self {
        let [min, max] = [0, 3].map(|first| std::array::from_fn(|k| rows[first + k]));
        Self { min, max, children }
    }

    fn set_bounds(&mut self, slot: usize, bounds: &FrameBox) {
        let [low, high] = *bounds;
        self.min.iter_mut().zip(low).for_each(|(row, x)| row[slot] = x);
        self.max.iter_mut().zip(high).for_each(|(row, x)| row[slot] = x);
    }

    fn bounds(&self, slot: usize) -> FrameBox {
        [self.min.map(|row| row[slot]), self.max.map(|row| row[slot])]
    }

    fn enclose((): &(), frame: &Frame, _: &[Member], bounds: &Aabb<f64>) -> FrameBox {
        frame.enclose(bounds)
    }

    fn union(a: &FrameBox, b: &FrameBox) -> FrameBox {
        [[0, 1, 2].map(|k| a[0][k].min(b[0][k])), [0, 1, 2].map(|k| a[1][k].max(b[1][k]))]
    }

    #[inline(always)]
    fn query((): &(), frame: &Frame, query: &[f64; 3]) -> Option<Rounded> {
        Some(Rounded::of(frame.local(query)?))
    }

    #[inline(always)]
    fn lower_bounds<L: Lanes>(&self, (): &(), query: &Rounded) -> L {
        let mut sum = L::splat(0.0);
        for k in 0..3 {
            sum = query.squared_gap(k, L::load(&self.min[k]), L::load(&self.max[k]), sum);
        }
        sum
    }

    fn height((): &(), direction: &[f64; 3]) -> Height {
        // Along a direction with a negative component, the lower side is the highest.
        Height::new(std::array::from_fn(|k| (if direction[k] < 0.0 { k } else { k + 3 }, direction[k])))
    }

    #[inline(always)]
    fn ray((): &(), line: &FrameLine) -> [SlabRay; 3] {
        let slab = |k: usize| SlabRay::new(line.base[k], line.direction[k], line.margin);
        [slab(0), slab(1), slab(2)]
    }

    #[inline(always)]
    fn entries<L: Lanes>(&self, ray: &[SlabRay; 3]) -> L {
        let mut interval = RayInterval::complete();
        for (slab, (min, max)) in ray.iter().zip(self.min.iter().zip(&self.max)) {
            interval.clip(slab, L::load(min), L::load(max));
        }
        interval.entry()
    }

    fn scene_box(bounds: &FrameBox, (): &(), frame: &Frame) -> Aabb<f64> {
        let [min, max] = bounds.map(|corner| Point3::from(corner.map(f64::from)));
        frame.to_scene(&Aabb { min, max })
    }

    fn scene_volume(bounds: &FrameBox, (): &(), frame: &Frame) -> Aabb<f64> {
        Self::scene_box(bounds, &(), frame)
    }
}

impl VolumeNodes for Aabb<f64> {
    type Shared = ();
    type Node = BoxNode;

    fn name() -> String {
        "aabb".to_owned()
    }
    fn save_shared((): &(), _: &mut Writer<'_>) {}
    fn load_shared(_: &Reader) -> Result<(), LoadError> {
        Ok(())
    }
}
