//! A bounding volume hierarchy with eight members in each group.
//!
//! Primitives are sorted along a Hilbert curve. Eight consecutive primitives form a group, eight groups form a group of
//! the next level, and the last level is one group.

use super::local_primitive::LocalPrimitive;
use nalgebra::Point3;
use p2m_core::engine::curve::sort_along_curve;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Aabb, Primitive, PrimitiveId, PrimitiveSet};

/// The largest number of members of a group.
const MAX_MEMBERS: usize = 8;
/// The largest number of levels. Each may have one group that is not full.
const MAX_LEVELS: usize = 11;

/// The primitives in their order along the curve, and all groups.
#[derive(Debug)]
pub(crate) struct Groups {
    pub(crate) primitives: Vec<LocalPrimitive>,
    /// The id of each primitive in the set.
    pub(crate) ids: Vec<PrimitiveId>,
    /// The groups of primitives, then the groups of each higher level. The last group is the root.
    groups: Vec<Group>,
}

/// A group of consecutive primitives, or of consecutive groups, and its bounding box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    /// The corners of the bounding box with the smallest and the largest coordinates.
    pub(crate) bounds: [V3; 2],
    /// The index of the first member, and the index after the last one.
    members: [u32; 2],
    has_groups: bool,
}

/// The index of a primitive or of a group. The highest bit is set for groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct EntryId(u32);

/// The primitive or group that an [`EntryId`] refers to.
#[derive(Clone, Copy)]
pub(crate) enum Entry<'a> {
    Primitive(&'a LocalPrimitive),
    Group(&'a Group),
}

const GROUP_BIT: u32 = 1 << 31;

impl EntryId {
    /// Returns the index of a primitive along the curve, or `None` for a group.
    pub(crate) fn primitive(self) -> Option<usize> {
        (self.0 & GROUP_BIT == 0).then_some(self.0 as usize)
    }
}

impl Group {
    #[inline(always)]
    pub(crate) fn members(&self) -> impl ExactSizeIterator<Item = EntryId> + use<> {
        let bit = if self.has_groups { GROUP_BIT } else { 0 };
        (self.members[0]..self.members[1]).map(move |i| EntryId(i | bit))
    }

    #[inline(always)]
    pub(crate) fn squared_diagonal(&self) -> f64 {
        norm_squared(sub(self.bounds[1], self.bounds[0]))
    }

    fn aabb(&self) -> Aabb<f64> {
        let [min, max] = self.bounds.map(Point3::from);
        Aabb { min, max }
    }

    #[allow(clippy::cast_possible_truncation, reason = "fewer than primitives, of which there are at most 2^30")]
    fn from_boxes(members: impl ExactSizeIterator<Item = Aabb<f64>>, first: usize, has_groups: bool) -> Self {
        let end = first + members.len();
        let union = members.fold(Aabb::empty(), |union, member| union.union(&member));
        let bounds = [union.min.coords.into(), union.max.coords.into()];
        Self { bounds, members: [first as u32, end as u32], has_groups }
    }
}

impl Groups {
    /// Returns `None` if a primitive is not the convex hull of its vertices, or if memory does not suffice.
    pub(crate) fn new<S: PrimitiveSet<f64> + ?Sized>(set: &S) -> Option<Self> {
        let count = set.len();
        let ids = || (0..count).map(PrimitiveId::new);
        let centres: Vec<V3> = ids()
            .map(|id| {
                let bounds = set.get(id).aabb();
                std::array::from_fn(|k| bounds.min[k] * 0.5 + bounds.max[k] * 0.5)
            })
            .collect();
        let mut order: Vec<u32> = ids().map(PrimitiveId::number).collect();
        sort_along_curve(&centres, &mut order);
        drop(centres);
        let ids: Vec<PrimitiveId> = order.into_iter().map(|i| PrimitiveId::new(i as usize)).collect();
        let mut primitives = Vec::new();
        primitives.try_reserve_exact(count).ok()?;
        for id in &ids {
            primitives.push(LocalPrimitive::from_primitive(&set.get(*id))?);
        }
        let mut groups: Vec<Group> = Vec::with_capacity(count.div_ceil(MAX_MEMBERS - 1) + MAX_LEVELS);
        for (n, members) in ids.chunks(MAX_MEMBERS).enumerate() {
            groups.push(Group::from_boxes(members.iter().map(|id| set.get(*id).aabb()), n * MAX_MEMBERS, false));
        }
        let mut first = 0;
        while groups.len() - first > 1 {
            let end = groups.len();
            for start in (first..end).step_by(MAX_MEMBERS) {
                let members = &groups[start..end.min(start + MAX_MEMBERS)];
                let group = Group::from_boxes(members.iter().map(Group::aabb), start, true);
                groups.push(group);
            }
            first = end;
        }
        Some(Self { primitives, ids, groups })
    }

    #[inline(always)]
    pub(crate) fn get(&self, entry: EntryId) -> Entry<'_> {
        let index = (entry.0 & !GROUP_BIT) as usize;
        if entry.0 & GROUP_BIT == 0 {
            Entry::Primitive(&self.primitives[index])
        } else {
            Entry::Group(&self.groups[index])
        }
    }

    /// Returns the group that contains all primitives, or `None` if there are none.
    #[allow(clippy::cast_possible_truncation, reason = "fewer than primitives")]
    pub(crate) fn root(&self) -> Option<EntryId> {
        self.groups.len().checked_sub(1).map(|last| EntryId(last as u32 | GROUP_BIT))
    }

    /// Descends from an entry to the nearest member on each level. The result is a primitive near the point, though not
    /// always the nearest one.
    pub(crate) fn descend(&self, mut entry: EntryId, point: V3) -> &LocalPrimitive {
        loop {
            match self.get(entry) {
                Entry::Primitive(primitive) => return primitive,
                Entry::Group(group) => {
                    let square = |entry: &EntryId| match self.get(*entry) {
                        Entry::Primitive(primitive) => primitive.squared_distance(point),
                        Entry::Group(group) => group.aabb().lower_bound(&point.into()),
                    };
                    entry = group
                        .members()
                        .map(|entry| (square(&entry), entry))
                        .reduce(|a, b| if b.0 < a.0 { b } else { a })
                        .expect("groups are not empty")
                        .1;
                }
            }
        }
    }

    pub(crate) fn memory(&self) -> usize {
        self.primitives.capacity() * size_of::<LocalPrimitive>()
            + self.ids.capacity() * size_of::<PrimitiveId>()
            + self.groups.capacity() * size_of::<Group>()
    }
}
