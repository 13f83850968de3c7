//! Primitives and boxes as the splits of a build see them.

use crate::packet::{Kind, Member};
use crate::tree::frame::Frame;
use p2m_core::engine::simd::{InstructionSet, Lanes};
use p2m_core::{Aabb, PrimitiveId};

/// The lanes of a box in the frame of a build: its lower corner, a lane that is not part of the box, the negated
/// coordinates of its upper corner, and another such lane. So all coordinates of the box around two boxes are minima,
/// which one instruction computes.
type BoxLanes = [f32; 8];
/// The first lane of the upper corner.
const UPPER: usize = 4;

/// The number that stands for the first kind. Its distance from ids keeps the lanes that are not part of a box, which
/// take part in all arithmetic, from becoming subnormal, which would be slow.
const FIRST_KIND: f32 = 16.0;

/// A primitive that is being sorted into a leaf, in 32 bytes, because the uppermost splits are bound by memory.
///
/// Its box is in a [`Frame`] and rounded to f32. Splits need no more, because they decide how fast a tree is and not
/// what it answers. The lanes that are not part of the box have the bits of the id, and the kind.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub struct BuildPrimitive(BoxLanes);

impl BuildPrimitive {
    /// A primitive with a box of the scene in a frame around it.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounding is allowed")]
    pub(crate) fn new(frame: &Frame, bounds: &Aabb<f64>, kind: Kind, id: PrimitiveId) -> Self {
        // The sum has no negative zero. The smaller one of two zeros would depend on the order of the primitives.
        let [a, b, c] = frame.place(&[bounds.min.x, bounds.min.y, bounds.min.z]).map(|x| x as f32 + 0.0);
        let [d, e, f] = frame.place(&[bounds.max.x, bounds.max.y, bounds.max.z]).map(|x| -x as f32 + 0.0);
        // An id is less than 2^30, so it has the bits of a number below 2.
        Self([a, b, c, f32::from_bits(id.number()), d, e, f, FIRST_KIND + f32::from(kind as u8)])
    }

    /// A primitive of a set in a frame.
    pub(crate) fn from_member(frame: &Frame, member: &Member, id: PrimitiveId) -> Self {
        Self::new(frame, &member.bounds, member.kind, id)
    }

    pub(crate) fn id(&self) -> PrimitiveId {
        PrimitiveId::new(self.0[3].to_bits() as usize)
    }

    /// Whether another primitive is of the same kind.
    pub(crate) fn is_same_kind(&self, other: &Self) -> bool {
        self.0[7].to_bits() == other.0[7].to_bits()
    }

    /// The place of the primitive in its leaf: those of a kind are together, because a packet has primitives of one
    /// kind, and in the order of their ids, because neighbours in the user's order tend to be neighbours in memory.
    pub(crate) fn rank(&self) -> u64 {
        u64::from(self.0[7].to_bits()) << 32 | u64::from(self.0[3].to_bits())
    }

    /// Twice the coordinate of the centre along an axis.
    #[inline(always)]
    pub(crate) fn centre_at(&self, axis: usize) -> f32 {
        self.0[axis] - self.0[UPPER + axis]
    }

    /// Twice the coordinates of the centre. The last number has no meaning.
    #[inline(always)]
    pub(crate) fn centre(&self) -> [f32; 4] {
        std::array::from_fn(|k| self.centre_at(k))
    }

    /// The box of the centre.
    #[inline(always)]
    pub(crate) fn centre_box(&self) -> GrowingBox {
        GrowingBox(std::array::from_fn(|k| self.0[k] - self.0[k ^ UPPER]))
    }

    /// The box of the primitive.
    #[inline(always)]
    pub(crate) fn bounds(&self) -> GrowingBox {
        GrowingBox(self.0)
    }
}

/// A box that grows while others are added to it.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(crate) struct GrowingBox(BoxLanes);

impl GrowingBox {
    /// A number that is larger than all that boxes in a frame have, but not infinite, so that areas stay numbers.
    pub(crate) const NOTHING: f32 = 64.0;
    /// The box of nothing.
    pub(crate) const EMPTY: Self = Self([Self::NOTHING; 8]);

    /// The least coordinate along an axis.
    #[inline(always)]
    pub(crate) fn min(&self, axis: usize) -> f32 {
        self.0[axis]
    }

    /// The largest coordinate along an axis.
    #[inline(always)]
    pub(crate) fn max(&self, axis: usize) -> f32 {
        -self.0[UPPER + axis]
    }

    /// Adds a box.
    #[inline(always)]
    pub(crate) fn add<I: InstructionSet>(&mut self, other: &Self) {
        I::F32x8::load(&self.0).min(I::F32x8::load(&other.0)).store(&mut self.0);
    }

    /// The box around both boxes.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].min(other.0[k])))
    }

    /// The box if the condition holds, and otherwise one that adds nothing to others. There is no branch.
    #[inline(always)]
    pub(crate) fn only_if(&self, condition: bool) -> Self {
        // The limit is below all coordinates or above them: the condition is its sign.
        let limit = f32::from_bits(Self::NOTHING.to_bits() | u32::from(condition) << 31);
        Self(self.0.map(|x| if x < limit { limit } else { x }))
    }

    /// Half of the surface area of the box; a positive number for the box of nothing.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f32 {
        let negated_side = |k: usize| self.0[k] + self.0[UPPER + k];
        let [x, y, z] = [negated_side(0), negated_side(1), negated_side(2)];
        x * y + y * z + z * x
    }

    pub(crate) fn longest_side(&self) -> f32 {
        (0..3).map(|k| self.max(k) - self.min(k)).fold(0.0, f32::max)
    }

    /// The axis of the longest side, the last one if several are equally long.
    pub(crate) fn longest_axis(&self) -> usize {
        let side = |k: usize| self.max(k) - self.min(k);
        (0..3).max_by(|a, b| side(*a).total_cmp(&side(*b))).unwrap_or(0)
    }
}
