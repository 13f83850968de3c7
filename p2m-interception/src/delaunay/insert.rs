//! The insertion of points one by one \[Bowyer1981\], \[Watson1981\].
//!
//! A new point p removes the tetrahedra whose circumsphere contains it strictly inside, which form the *cavity*, and
//! is joined to the faces around the cavity. No point is perturbed, not even symbolically, for these reasons:
//!
//! - The tetrahedra that contain p, even on a face or an edge, are in the cavity. Apart from its vertices a
//!   tetrahedron is inside of its sphere.
//! - The cavity is connected. Let the power of p be the squared distance to the centre of a sphere minus the squared
//!   radius. Go straight from a point of a tetrahedron to p. The power of p in the spheres of the tetrahedra on the
//!   way does not grow, because they are Delaunay: behind the plane of a common face the ball of the next one contains
//!   that of the last. So if the first tetrahedron is in the cavity, all of them are.
//! - The new tetrahedra have a positive volume and do not overlap. Let t and t' be the tetrahedra on the two sides of
//!   a face around the cavity, with t inside. Both spheres have the same circle in the plane of the face. So the two
//!   powers of p are equal if p is in that plane, and the power in t' is the lower one if p is on the side of t'. But
//!   the power in t is negative and that in t' is not. So p is strictly on the side of t. This holds for the outer
//!   faces as well, since all points are strictly inside the octahedron of the bounding sites.
//!
//! The walk to the tetrahedron that contains a point ends for a related reason. A point p on a sphere is treated as
//! outside. This amounts to raising p in the paraboloid over space, by less than anything else but by more than all
//! points before. So the tetrahedra are those of a regular triangulation in general position, and in such a
//! triangulation no cycle of tetrahedra lies each in front of the next as seen from a point \[Edelsbrunner1990b\].

#![allow(clippy::inline_always, reason = "or it is compiled without the instruction set")]

use crate::delaunay::tetrahedron::{FACES, IN_CAVITY, NO_NEIGHBOUR, NOT_IN_CAVITY, Tetrahedron, Work, index_in};
use p2m_core::engine::adaptive::{PredicateStage, orientation_exact, orientation_filter, sphere_exact, sphere_filter};
use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel, prefetch};
use p2m_core::engine::vector::{V3, sub};
use std::cmp::Ordering;

/// The number of vertices around a cavity that the table of edges has room for. They are the vertices of 124 faces.
pub(crate) const MAX_LINKED_VERTICES: usize = 64;

/// The number of tetrahedra that may be created for each one that may exist at a time.
const CREATED_PER_TETRAHEDRON: u64 = 8;

/// A site, and its part in the current insertion. Half a cache line holds it, so it never lies on two.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct InsertedSite {
    /// The position of the site.
    pub(crate) point: V3,
    /// The insertion in which this site last was a vertex of the cavity's boundary, as the number of
    /// the inserted site.
    pub(crate) last_insertion: u32,
    /// The index of this site among the vertices of that boundary.
    pub(crate) boundary_index: u32,
}

/// A triangulation that grows by insertion.
pub(crate) struct Insertion {
    /// The sites, in the order of their numbers.
    pub(crate) sites: Vec<InsertedSite>,
    /// The tetrahedra, removed ones included.
    pub(crate) tetrahedra: Vec<Tetrahedron>,
    /// The numbers of removed tetrahedra, which are used again.
    free_slots: Vec<u32>,
    /// The largest number of tetrahedra at a time.
    max_tetrahedra: usize,
    /// The largest number of tetrahedra that may be created.
    max_created: u64,
    /// The tetrahedron from which the next walk begins.
    walk_start: u32,
    /// The tetrahedra in the current cavity.
    cavity: Vec<u32>,
    /// The faces around the cavity: the tetrahedron inside, and the index of its vertex opposite to the face.
    pub(crate) boundary: Vec<(u32, u32)>,
    /// The new tetrahedra, one for each face of the boundary.
    pub(crate) created: Vec<u32>,
    /// For each edge of a face around the cavity, the index of the created tetrahedron that has it. The row is the
    /// boundary index of the first end, and the column is the boundary index of the second end. Entries of earlier
    /// insertions are never read.
    pub(crate) edge_owners: Box<[u8; MAX_LINKED_VERTICES * MAX_LINKED_VERTICES]>,
    /// The work so far.
    pub(crate) work: Work,
}

/// A SIMD kernel that inserts sites. It uses the instruction set only through the compiler. Lanes are as precise as
/// single numbers, and no operation is contracted, so the tetrahedra are the same on every processor.
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
    /// Makes the tetrahedra of the six bounding sites around the diagonal from 0 to 1. The six are exactly equally far
    /// from their centre, so any diagonal is Delaunay.
    pub(crate) fn new(sites: &[V3], max_tetrahedra: usize) -> Self {
        let ring = [2, 4, 3, 5];
        // Points in space have seven times as many tetrahedra. Points on a surface have some more, removed ones
        // included.
        let mut tetrahedra = Vec::with_capacity((15 * sites.len() / 2).min(max_tetrahedra.saturating_add(4)));
        tetrahedra.extend((0..4u32).map(|i| {
            let [a, b] = [ring[i as usize], ring[(i as usize + 1) % 4]];
            // The next tetrahedron lies opposite to a, and the one before lies opposite to b.
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

    /// Inserts a site that differs from all before. It returns `false` if there are too many tetrahedra.
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

    /// Inserts sites that differ from all before, each once. It returns `false` if there are too many tetrahedra.
    #[must_use]
    pub(crate) fn insert_all(&mut self, sites: impl Iterator<Item = usize>) -> bool {
        Isa::best().run(InsertAll { insertion: self, sites })
    }

    /// Replaces the initial tetrahedra by a triangulation of some of the sites, given by vertices and neighbours.
    pub(crate) fn continue_from<'a>(&mut self, tetrahedra: impl Iterator<Item = (&'a [u32; 4], &'a [u32; 4])>) {
        self.tetrahedra.clear();
        self.tetrahedra.extend(
            tetrahedra.map(|(vertices, neighbours)| Tetrahedron { vertices: *vertices, neighbours: *neighbours }),
        );
    }

    /// Returns all tetrahedra, removed ones included.
    pub(crate) fn into_tetrahedra(self) -> Vec<Tetrahedron> {
        self.tetrahedra
    }

    /// Returns the positions of the vertices of a tetrahedron.
    #[inline(always)]
    fn vertices_of(&self, [a, b, c, d]: [u32; 4]) -> [V3; 4] {
        let at = |v: u32| &self.sites[v as usize].point;
        let (a, b, c, d) = (at(a), at(b), at(c), at(d));
        [[a[0], a[1], a[2]], [b[0], b[1], b[2]], [c[0], c[1], c[2]], [d[0], d[1], d[2]]]
    }

    /// Walks to a tetrahedron that contains p, possibly on a face.
    #[inline(always)]
    fn locate(&mut self, p: V3) -> u32 {
        let (mut at, mut from) = (self.walk_start, NO_NEIGHBOUR);
        'walk: loop {
            self.work.steps += 1;
            let Tetrahedron { vertices, neighbours } = self.tetrahedra[at as usize];
            let corners = self.vertices_of(vertices);
            let offsets = [sub(corners[0], p), sub(corners[1], p), sub(corners[2], p), sub(corners[3], p)];
            for ([i, j, k], next) in FACES.into_iter().zip(neighbours) {
                if next == from {
                    continue;
                }
                self.work.orientations += 1;
                let estimate = orientation_filter([offsets[i], offsets[j], offsets[k]]);
                let is_beyond = if estimate.is_certain() {
                    estimate.value > 0.0
                } else {
                    self.decide_orientation([corners[i], corners[j], corners[k]], p) == Ordering::Greater
                };
                // Seen from p, the vertices have the opposite orientation of the face.
                if is_beyond {
                    assert_ne!(next, NO_NEIGHBOUR, "inside the bounding sites");
                    (from, at) = (at, next);
                    continue 'walk;
                }
            }
            return at;
        }
    }

    /// Decides an orientation that the filter could not decide.
    #[cold]
    fn decide_orientation(&mut self, face: [V3; 3], p: V3) -> Ordering {
        let (sign, stage) = orientation_exact(face, p);
        match stage {
            PredicateStage::Whole => self.work.whole_orientations += 1,
            _ => self.work.adaptive_orientations += 1,
        }
        sign
    }

    /// Returns whether p is strictly inside the sphere of four vertices.
    #[inline(always)]
    fn is_in_conflict(&mut self, vertices: [u32; 4], p: V3) -> bool {
        self.work.spheres += 1;
        let corners = self.vertices_of(vertices);
        let estimate = sphere_filter(corners, p);
        if estimate.is_certain() { estimate.value > 0.0 } else { self.decide_sphere(corners, p) == Ordering::Greater }
    }

    /// Decides a sphere test that the filter could not decide.
    #[cold]
    fn decide_sphere(&mut self, corners: [V3; 4], p: V3) -> Ordering {
        let (sign, stage) = sphere_exact(corners, p);
        match stage {
            PredicateStage::Whole => self.work.whole_spheres += 1,
            PredicateStage::Double => self.work.double_spheres += 1,
            PredicateStage::Adaptive => self.work.adaptive_spheres += 1,
        }
        sign
    }

    /// Collects the tetrahedra in conflict with p, starting from one of them, and the faces around them.
    ///
    /// The outcome of a conflict test cannot be predicted and takes long to compute, so nothing branches on it. A
    /// tetrahedron and its face are written to the ends of both lists, and one of the two lists becomes longer.
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

    /// Prefetches the neighbours of a tetrahedron.
    #[inline(always)]
    fn prefetch_neighbours(&self, tetrahedron: u32) {
        for next in self.tetrahedra[tetrahedron as usize].neighbours {
            prefetch(self.tetrahedra.as_ptr().wrapping_add(next as usize).cast());
        }
    }

    /// Makes the lists long enough for four entries more than these numbers.
    #[inline(always)]
    fn reserve_lists(&mut self, cavity: usize, boundary: usize) {
        if self.cavity.len() < cavity + 4 {
            self.cavity.resize(2 * cavity + 64, 0);
        }
        if self.boundary.len() < boundary + 4 {
            self.boundary.resize(2 * boundary + 64, (0, 0));
        }
    }

    /// Creates the new tetrahedra. Each has a face of the boundary, and the site in place of the vertex opposite to
    /// it. It becomes the neighbour of both old tetrahedra at the face.
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
