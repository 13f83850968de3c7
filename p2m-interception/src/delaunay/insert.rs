//! Insertion of points one by one \[Bowyer1981\], \[Watson1981\].
//!
//! A new point p removes the tetrahedra whose circumsphere has it strictly inside, the cavity, and is joined to the
//! faces around it. No point is moved, not even symbolically, for
//! - the tetrahedra that contain p, be it on a face or an edge, are in the cavity: but for its vertices a tetrahedron is
//!   inside its sphere;
//! - the cavity is connected. Let the power of p be the squared distance to the centre of a sphere less the squared
//!   radius. On the way from a point of a tetrahedron straight to p the power of p in the spheres of the tetrahedra met
//!   does not grow: they are Delaunay, so behind the plane of a common face the ball of the next one contains that of
//!   the walk_start. So if the first is in the cavity, all are;
//! - the new tetrahedra have a volume above zero and do not overlap. Let t and t' be the tetrahedra on the two sides of
//!   a face around the cavity, t inside. Spheres of both have the same circle in the plane of the face, so the powers
//!   of p in both are equal if p is in that plane, and if p is on the side of t' that in t' is the lower one. But
//!   that in t is below zero and that in t' is not. So p is strictly on the side of t. For the outer faces it is as
//!   well, as all points are strictly inside the hull of the bounding sites.
//!
//! Walks end for the same reason: to keep out a point p that is on a sphere is to raise it by less than anything in the
//! paraboloid over space, but by more than all the points before. So the tetrahedra are those of a regular
//! triangulation in general index_in, in which no cycle of tetrahedra lies each in front of the next as seen from a
//! point \[Edelsbrunner1990b\].

#![allow(clippy::inline_always, reason = "or it is compiled without the instruction set")]

use crate::delaunay::tetrahedron::{FACES, IN_CAVITY, NO_NEIGHBOUR, NOT_IN_CAVITY, Tetrahedron, Work, index_in};
use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel, prefetch};
use p2m_core::engine::staged::{PredicateStage, orientation_exact, orientation_filter, sphere_exact, sphere_filter};
use p2m_core::engine::vector::{V3, sub};
use std::cmp::Ordering;

/// Vertices of the faces around a cavity that have positions in the table of edge_owners: those of 124 faces.
pub(crate) const MAX_LINKED_VERTICES: usize = 64;

/// For each tetrahedron that there may be at a time so many may be made.
const CREATED_PER_TETRAHEDRON: u64 = 8;

/// A site with what is known of it in the current insertion: half a cache line as well, never on two.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct InsertedSite {
    pub(crate) point: V3,
    /// For which site it was a vertex of the faces around the cavity walk_start,
    pub(crate) last_insertion: u32,
    /// and the how manieth of those.
    pub(crate) boundary_index: u32,
}

/// A triangulation that grows.
pub(crate) struct Insertion {
    pub(crate) sites: Vec<InsertedSite>,
    pub(crate) tetrahedra: Vec<Tetrahedron>,
    free_slots: Vec<u32>,
    /// So many may there be,
    max_tetrahedra: usize,
    /// and so many be made.
    max_created: u64,
    /// Where the next walk begins.
    walk_start: u32,
    cavity: Vec<u32>,
    /// Faces around the cavity: a tetrahedron inside, and the vertex that its face is opposite to.
    pub(crate) boundary: Vec<(u32, u32)>,
    pub(crate) created: Vec<u32>,
    /// Of an edge of a face around the cavity, from the boundary_index of one vertex to that of another: which of the created
    /// tetrahedra has it. What is left of earlier insertions is not read.
    pub(crate) edge_owners: Box<[u8; MAX_LINKED_VERTICES * MAX_LINKED_VERTICES]>,
    pub(crate) work: Work,
}

/// Insertion of sites, with all instructions that there are. Only compilers use them: lanes are no more precise than
/// one number at a time, and nothing is contracted, so the tetrahedra are the same on every processor.
struct InsertAll<'a, S> {
    insertion: &'a mut Insertion,
    sites: S,
}

impl<S: Iterator<Item = usize>> SimdKernel for InsertAll<'_, S> {
    type Output = bool;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> bool {
        for site in self.sites {
            #[allow(clippy::cast_possible_truncation, reason = "at most MAX_POINTS and six")]
            if !self.insertion.insert(site as u32) {
                return false;
            }
        }
        true
    }
}

impl Insertion {
    /// The tetrahedra of the six bounding sites, around the diagonal from 0 to 1. They are at the same distance from
    /// their centre, exactly, so any diagonal is Delaunay.
    pub(crate) fn new(sites: &[V3], max_tetrahedra: usize) -> Self {
        let ring = [2, 4, 3, 5];
        // Points in space have seven times as many; on a surface there are some more, with the removed ones.
        let mut tetrahedra = Vec::with_capacity((15 * sites.len() / 2).min(max_tetrahedra.saturating_add(4)));
        tetrahedra.extend((0..4u32).map(|i| {
            let [a, b] = [ring[i as usize], ring[(i as usize + 1) % 4]];
            // Opposite to a lies the next one, opposite to b the one before.
            Tetrahedron { vertices: [0, 1, a, b], neighbours: [NO_NEIGHBOUR, NO_NEIGHBOUR, (i + 1) % 4, (i + 3) % 4] }
        }));
        Self {
            sites: sites.iter().map(|&point| InsertedSite { point, last_insertion: 0, boundary_index: 0 }).collect(),
            tetrahedra,
            free_slots: Vec::new(),
            max_tetrahedra: max_tetrahedra.min(NO_NEIGHBOUR as usize),
            max_created: (max_tetrahedra as u64).saturating_mul(CREATED_PER_TETRAHEDRON),
            walk_start: 0,
            cavity: Vec::new(),
            boundary: Vec::new(),
            created: Vec::new(),
            edge_owners: Box::new([0; MAX_LINKED_VERTICES * MAX_LINKED_VERTICES]),
            work: Work::default(),
        }
    }

    /// Inserts a site other than all before; whether its tetrahedra are not too many.
    #[must_use]
    #[inline(always)]
    fn insert(&mut self, site: u32) -> bool {
        let p = self.sites[site as usize].point;
        let start = self.locate(p);
        self.find_cavity(start, p);
        let more = self.boundary.len().saturating_sub(self.free_slots.len());
        if self.tetrahedra.len() + more >= self.max_tetrahedra
            || self.work.created + self.boundary.len() as u64 > self.max_created
        {
            return false;
        }
        self.create_tetrahedra(site);
        if !self.link(site) {
            self.work.large_cavities += 1;
            self.link_by_turning();
        }
        for &t in &self.cavity {
            self.tetrahedra[t as usize].vertices[0] = NO_NEIGHBOUR;
        }
        self.free_slots.extend_from_slice(&self.cavity);
        self.walk_start = self.created[0];
        true
    }

    /// Inserts sites other than all before, each once; whether their tetrahedra are not too many.
    #[must_use]
    pub(crate) fn insert_all(&mut self, sites: impl Iterator<Item = usize>) -> bool {
        Isa::best().run(InsertAll { insertion: self, sites })
    }

    /// What has become of it, with the positions of removed ones.
    pub(crate) fn into_tetrahedra(self) -> Vec<Tetrahedron> {
        self.tetrahedra
    }

    /// The vertices of a tetrahedron.
    #[inline(always)]
    fn vertices_of(&self, [a, b, c, d]: [u32; 4]) -> [V3; 4] {
        let at = |v: u32| &self.sites[v as usize].point;
        let (a, b, c, d) = (at(a), at(b), at(c), at(d));
        [[a[0], a[1], a[2]], [b[0], b[1], b[2]], [c[0], c[1], c[2]], [d[0], d[1], d[2]]]
    }

    /// A tetrahedron that contains p, maybe on a face.
    #[inline(always)]
    fn locate(&mut self, p: V3) -> u32 {
        let (mut at, mut from) = (self.walk_start, NO_NEIGHBOUR);
        'walk: loop {
            self.work.steps += 1;
            let Tetrahedron { vertices, neighbours } = self.tetrahedra[at as usize];
            let vertices_of = self.vertices_of(vertices);
            let offsets =
                [sub(vertices_of[0], p), sub(vertices_of[1], p), sub(vertices_of[2], p), sub(vertices_of[3], p)];
            for ([i, j, k], next) in FACES.into_iter().zip(neighbours) {
                if next == from {
                    continue;
                }
                self.work.orientations += 1;
                let estimate = orientation_filter([offsets[i], offsets[j], offsets[k]]);
                let is_beyond = if estimate.is_certain() {
                    estimate.value > 0.0
                } else {
                    self.orientation([vertices_of[i], vertices_of[j], vertices_of[k]], p) == Ordering::Greater
                };
                // Of the vertices_of as seen from p: the other way last_insertion.
                if is_beyond {
                    assert_ne!(next, NO_NEIGHBOUR, "inside the bounding sites");
                    (from, at) = (at, next);
                    continue 'walk;
                }
            }
            return at;
        }
    }

    #[cold]
    fn orientation(&mut self, face: [V3; 3], p: V3) -> Ordering {
        let (sign, stage) = orientation_exact(face, p);
        match stage {
            PredicateStage::Whole => self.work.whole_orientations += 1,
            _ => self.work.adaptive_orientations += 1,
        }
        sign
    }

    /// Whether p is strictly inside the sphere of four vertices.
    #[inline(always)]
    fn is_in_conflict(&mut self, vertices: [u32; 4], p: V3) -> bool {
        self.work.spheres += 1;
        let vertices_of = self.vertices_of(vertices);
        let estimate = sphere_filter(vertices_of, p);
        if estimate.is_certain() { estimate.value > 0.0 } else { self.sphere(vertices_of, p) == Ordering::Greater }
    }

    #[cold]
    fn sphere(&mut self, vertices_of: [V3; 4], p: V3) -> Ordering {
        let (sign, stage) = sphere_exact(vertices_of, p);
        match stage {
            PredicateStage::Whole => self.work.whole_spheres += 1,
            PredicateStage::Double => self.work.double_spheres += 1,
            PredicateStage::Adaptive => self.work.adaptive_spheres += 1,
        }
        sign
    }

    /// Collects the tetrahedra in conflict with p, from one of them, and the faces around them.
    ///
    /// Which are in conflict cannot be predicted, and takes long to compute. So nothing branches on it: a tetrahedron
    /// and its face are written to the end of both lists, and one of the two becomes longer.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "one of four faces")]
    fn find_cavity(&mut self, start: u32, p: V3) {
        self.tetrahedra[start as usize].vertices[0] |= IN_CAVITY;
        self.reserve_lists(0, 0);
        self.cavity[0] = start;
        let (mut done, mut cavity, mut boundary) = (0, 1, 0);
        while done < cavity {
            let t = self.cavity[done];
            done += 1;
            self.reserve_lists(cavity, boundary);
            if done < cavity {
                self.prefetch_neighbours(self.cavity[done]);
            }
            for (face, next) in self.tetrahedra[t as usize].neighbours.into_iter().enumerate() {
                let mut conflict = false;
                if let Some(&Tetrahedron { vertices, .. }) = self.tetrahedra.get(next as usize) {
                    if vertices[0] & IN_CAVITY != 0 {
                        continue;
                    }
                    if vertices[0] & NOT_IN_CAVITY == 0 {
                        conflict = self.is_in_conflict(vertices, p);
                        self.tetrahedra[next as usize].vertices[0] |= if conflict { IN_CAVITY } else { NOT_IN_CAVITY };
                    }
                }
                self.cavity[cavity] = next;
                cavity += usize::from(conflict);
                self.boundary[boundary] = (t, face as u32);
                boundary += usize::from(!conflict);
            }
        }
        self.cavity.truncate(cavity);
        self.boundary.truncate(boundary);
    }

    /// Asks for the neighbours of a tetrahedron before they are read.
    #[inline(always)]
    fn prefetch_neighbours(&self, tetrahedron: u32) {
        for next in self.tetrahedra[tetrahedron as usize].neighbours {
            prefetch(self.tetrahedra.as_ptr().wrapping_add(next as usize).cast());
        }
    }

    /// Makes the lists long enough for four more than so many.
    #[inline(always)]
    fn reserve_lists(&mut self, cavity: usize, boundary: usize) {
        if self.cavity.len() < cavity + 4 {
            self.cavity.resize(2 * cavity + 64, 0);
        }
        if self.boundary.len() < boundary + 4 {
            self.boundary.resize(2 * boundary + 64, (0, 0));
        }
    }

    /// Makes the new tetrahedra: of those in the cavity that have a face around it, with the site in boundary_index of the
    /// vertex behind the face. In the old ones they become the neighbours there.
    #[inline(always)]
    fn create_tetrahedra(&mut self, site: u32) {
        self.created.clear();
        for &(t, face) in &self.boundary {
            let face = face as usize;
            let old = self.tetrahedra[t as usize];
            let mut new = Tetrahedron { vertices: old.vertices, neighbours: [NO_NEIGHBOUR; 4] };
            new.vertices[0] &= !IN_CAVITY;
            new.vertices[face] = site;
            new.neighbours[face] = old.neighbours[face];
            #[allow(clippy::cast_possible_truncation, reason = "checked")]
            let number = self.free_slots.pop().unwrap_or_else(|| {
                self.tetrahedra.push(new);
                self.tetrahedra.len() as u32 - 1
            });
            self.tetrahedra[number as usize] = new;
            if let Some(beyond) = self.tetrahedra.get_mut(old.neighbours[face] as usize) {
                beyond.vertices[0] &= !NOT_IN_CAVITY;
                let back = index_in(&beyond.neighbours, t);
                beyond.neighbours[back] = number;
            }
            self.tetrahedra[t as usize].neighbours[face] = number;
            self.created.push(number);
        }
        self.work.created += self.created.len() as u64;
    }
}
