//! Primitives and boxes in the form that the splits of a build use.

use crate::packet::{Kind, Member};
use crate::tree::frame::Frame;
use p2m_core::engine::simd::{InstructionSet, Lanes};
use p2m_core::{Aabb, PrimitiveId};

/// The lanes of a box in the frame of a build: its lower corner, a lane that is not part of the box, the negated
/// coordinates of its upper corner, and another such lane. So the union of two boxes is a minimum in every lane, which
/// takes one instruction.
type BoxLanes = [f32; 8];
/// The first lane of the upper corner.
const UPPER: usize = 4;

/// The number of the first kind. The lanes that are not part of a box take part in all arithmetic. The distance between
/// ids, which are below 2, and kinds keeps the results in these lanes from becoming subnormal, which would be slow.
const FIRST_KIND: f32 = 16.0;

/// A primitive during a build, in 32 bytes, because the uppermost splits are bound by memory bandwidth.
///
/// Its box is in a [`Frame`] and rounded to f32. Splits need no more precision, because they affect how fast a tree is
/// and not its answers. The two lanes that are not part of the box hold the bits of the id, and the kind.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub struct BuildPrimitive(BoxLanes);

impl BuildPrimitive {
    /// Creates a primitive from its box in the scene, which is converted to the frame.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounding is allowed")]
    pub(crate) fn new(frame: &Frame, bounds: &Aabb<f64>, kind: Kind, id: PrimitiveId) -> Self {
        // Adding 0 removes negative zeros. Otherwise the smaller of two zeros would depend on the order of the
        // primitives.
        let [a, b, c] = frame.place(&[bounds.min.x, bounds.min.y, bounds.min.z]).map(|x| x as f32 + 0.0);
        let [d, e, f] = frame.place(&[bounds.max.x, bounds.max.y, bounds.max.z]).map(|x| -x as f32 + 0.0);
        // An id is less than 2^30, so its bits are those of a float below 2.
        Self([a, b, c, f32::from_bits(id.number()), d, e, f, FIRST_KIND + f32::from(kind as u8)])
    }

    /// Creates the primitive of a member of a set.
    pub(crate) fn from_member(frame: &Frame, member: &Member, id: PrimitiveId) -> Self {
        Self::new(frame, &member.bounds, member.kind, id)
    }

    pub(crate) fn id(&self) -> PrimitiveId {
        PrimitiveId::new(self.0[3].to_bits() as usize)
    }

    /// Returns whether another primitive is of the same kind.
    pub(crate) fn is_same_kind(&self, other: &Self) -> bool {
        self.0[7].to_bits() == other.0[7].to_bits()
    }

    /// Returns the sort key of the primitive within its leaf: first by kind, because a packet has primitives of one
    /// kind, and then by id, because neighbours in the user's order tend to be neighbours in memory.
    pub(crate) fn rank(&self) -> u64 {
        u64::from(self.0[7].to_bits()) << 32 | u64::from(self.0[3].to_bits())
    }

    /// Returns twice the coordinate of the centre along an axis.
    #[inline(always)]
    pub(crate) fn centre_at(&self, axis: usize) -> f32 {
        self.0[axis] - self.0[UPPER + axis]
    }

    /// Returns twice the coordinates of the centre. The last number is meaningless.
    #[inline(always)]
    pub(crate) fn centre(&self) -> [f32; 4] {
        std::array::from_fn(|k| self.centre_at(k))
    }

    /// Returns the centre as a box.
    #[inline(always)]
    pub(crate) fn centre_box(&self) -> GrowingBox {
        GrowingBox(std::array::from_fn(|k| self.0[k] - self.0[k ^ UPPER]))
    }

    /// Returns the box of the primitive.
    #[inline(always)]
    pub(crate) fn bounds(&self) -> GrowingBox {
        GrowingBox(self.0)
    }
}

/// A box that grows as other boxes are added to it.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(crate) struct GrowingBox(BoxLanes);

impl GrowingBox {
    /// A number above all coordinates of boxes in a frame. It is not infinite, so that areas stay finite.
    pub(crate) const NOTHING: f32 = 64.0;
    /// The empty box.
    pub(crate) const EMPTY: Self = Self([Self::NOTHING; 8]);

    /// Returns the least coordinate along an axis.
    #[inline(always)]
    pub(crate) fn min(&self, axis: usize) -> f32 {
        self.0[axis]
    }

    /// Returns the largest coordinate along an axis.
    #[inline(always)]
    pub(crate) fn max(&self, axis: usize) -> f32 {
        -self.0[UPPER + axis]
    }

    /// Adds a box.
    #[inline(always)]
    pub(crate) fn add<I: InstructionSet>(&mut self, other: &Self) {
        I::F32x8::load(&self.0).min(I::F32x8::load(&other.0)).store(&mut self.0);
    }

    /// Returns the box around both boxes.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].min(other.0[k])))
    }

    /// Returns the box if the condition holds, and otherwise a box that adds nothing to others. There is no branch.
    #[inline(always)]
    pub(crate) fn only_if(&self, condition: bool) -> Self {
        // The sign of the limit is the condition: the limit is below all coordinates or above them.
        let limit = f32::from_bits(Self::NOTHING.to_bits() | u32::from(condition) << 31);
        Self(self.0.map(|x| if x < limit { limit } else { x }))
    }

    /// Returns half of the surface area of the box, which is a positive number for the empty box.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f32 {
        let negated_side = |k: usize| self.0[k] + self.0[UPPER + k];
        let [x, y, z] = [negated_side(0), negated_side(1), negated_side(2)];
        x * y + y * z + z * x
    }

    pub(crate) fn longest_side(&self) -> f32 {
        (0..3).map(|k| self.max(k) - self.min(k)).fold(0.0, f32::max)
    }

    /// Returns the axis of the longest side. Ties go to the last one.
    pub(crate) fn longest_axis(&self) -> usize {
        let side = |k: usize| self.max(k) - self.min(k);
        (0..3).max_by(|a, b| side(*a).total_cmp(&side(*b))).unwrap_or(0)
    }
}
