//! A bounding volume hierarchy of boxes: primitives along a Hilbert curve, eight in a group, and eight groups in one, up to a single
//! group.

use super::flat::Flat;
use nalgebra::Point3;
use p2m_core::engine::curve::along_the_curve;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Aabb, Primitive, PrimitiveId, PrimitiveSet};

/// Members of a group.
const MEMBERS: usize = 8;
/// At most, of which each may have a group that is not full.
const LEVELS: usize = 11;

/// Primitives in their order along the curve, and groups of them.
#[derive(Debug)]
pub(crate) struct Groups {
    pub(crate) flats: Vec<Flat>,
    pub(crate) ids: Vec<PrimitiveId>,
    /// The groups of primitives, the groups of these, and so on; the last one has all.
    groups: Vec<Group>,
}

/// The box around some neighbours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    pub(crate) bounds: [V3; 2],
    members: [u32; 2],
    of_groups: bool,
}

/// A primitive or a group: its number, with the upper bit for groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Item(u32);

/// What an [`Item`] is.
#[derive(Clone, Copy)]
pub(crate) enum Is<'a> {
    One(&'a Flat),
    Many(&'a Group),
}

const GROUP: u32 = 1 << 31;

impl Item {
    /// The place of a primitive; `None` for a group.
    pub(crate) fn one(self) -> Option<usize> {
        (self.0 & GROUP == 0).then_some(self.0 as usize)
    }
}

impl Group {
    #[inline(always)]
    pub(crate) fn members(&self) -> impl ExactSizeIterator<Item = Item> + use<> {
        let bit = if self.of_groups { GROUP } else { 0 };
        (self.members[0]..self.members[1]).map(move |i| Item(i | bit))
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
    fn of(members: impl ExactSizeIterator<Item = Aabb<f64>>, first: usize, of_groups: bool) -> Self {
        let members_end = first + members.len();
        let all = members.fold(Aabb::empty(), |all, one| all.union(&one));
        let bounds = [all.min.coords.into(), all.max.coords.into()];
        Self { bounds, members: [first as u32, members_end as u32], of_groups }
    }
}

impl Groups {
    /// `None` if a primitive is not told by its vertices, or if there is no memory.
    pub(crate) fn new<S: PrimitiveSet<f64> + ?Sized>(set: &S) -> Option<Self> {
        let count = set.len();
        let ids = || (0..count).map(PrimitiveId::new);
        let middles: Vec<V3> = ids()
            .map(|id| {
                let bounds = set.get(id).aabb();
                std::array::from_fn(|k| bounds.min[k] * 0.5 + bounds.max[k] * 0.5)
            })
            .collect();
        let mut order: Vec<u32> = ids().map(PrimitiveId::number).collect();
        along_the_curve(&middles, &mut order);
        drop(middles);
        let ids: Vec<PrimitiveId> = order.into_iter().map(|i| PrimitiveId::new(i as usize)).collect();
        let mut flats = Vec::new();
        flats.try_reserve_exact(count).ok()?;
        for id in &ids {
            flats.push(Flat::of(&set.get(*id))?);
        }
        let mut groups: Vec<Group> = Vec::with_capacity(count.div_ceil(MEMBERS - 1) + LEVELS);
        for (n, members) in ids.chunks(MEMBERS).enumerate() {
            groups.push(Group::of(members.iter().map(|id| set.get(*id).aabb()), n * MEMBERS, false));
        }
        let mut first = 0;
        while groups.len() - first > 1 {
            let end = groups.len();
            for start in (first..end).step_by(MEMBERS) {
                let members = &groups[start..end.min(start + MEMBERS)];
                let group = Group::of(members.iter().map(Group::aabb), start, true);
                groups.push(group);
            }
            first = end;
        }
        Some(Self { flats, ids, groups })
    }

    #[inline(always)]
    pub(crate) fn get(&self, item: Item) -> Is<'_> {
        let number = (item.0 & !GROUP) as usize;
        if item.0 & GROUP == 0 { Is::One(&self.flats[number]) } else { Is::Many(&self.groups[number]) }
    }

    /// The group of all; `None` if there is nothing.
    #[allow(clippy::cast_possible_truncation, reason = "fewer than primitives")]
    pub(crate) fn all(&self) -> Option<Item> {
        self.groups.len().checked_sub(1).map(|last| Item(last as u32 | GROUP))
    }

    /// The primitive that is found by way of the nearest boxes, which is among the nearer ones of an item.
    pub(crate) fn near(&self, mut item: Item, place: V3) -> &Flat {
        loop {
            match self.get(item) {
                Is::One(flat) => return flat,
                Is::Many(group) => {
                    let square = |item: &Item| match self.get(*item) {
                        Is::One(flat) => flat.square(place),
                        Is::Many(group) => group.aabb().lower_bound(&place.into()),
                    };
                    item = group
                        .members()
                        .map(|item| (square(&item), item))
                        .reduce(|a, b| if b.0 < a.0 { b } else { a })
                        .expect("groups are not empty")
                        .1;
                }
            }
        }
    }

    pub(crate) fn memory(&self) -> usize {
        self.flats.capacity() * size_of::<Flat>()
            + self.ids.capacity() * size_of::<PrimitiveId>()
            + self.groups.capacity() * size_of::<Group>()
    }
}
