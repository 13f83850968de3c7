//! Insertion of points one by one \[Bowyer1981\], \[Watson1981\].
//!
//! A new point p removes the tetrahedra whose circumsphere has it strictly inside, the cavity, and is joined to the
//! faces around it. No point is moved, not even symbolically, for
//! - the tetrahedra that contain p, be it on a face or an edge, are in the cavity: but for its vertices a tetrahedron is
//!   inside its sphere;
//! - the cavity is connected. Let the power of p be the squared distance to the centre of a sphere less the squared
//!   radius. On the way from a point of a tetrahedron straight to p the power of p in the spheres of the tetrahedra met
//!   does not grow: they are Delaunay, so behind the plane of a common face the ball of the next one contains that of
//!   the last. So if the first is in the cavity, all are;
//! - the new tetrahedra have a volume above zero and do not overlap. Let t and t' be the tetrahedra on the two sides of
//!   a face around the cavity, t inside. Spheres of both have the same circle in the plane of the face, so the powers
//!   of p in both are equal if p is in that plane, and if p is on the side of t' that in t' is the lower one. But
//!   that in t is below zero and that in t' is not. So p is strictly on the side of t. For the outer faces it is as
//!   well, as all points are strictly inside the hull of the bounding sites.
//!
//! Walks end for the same reason: to keep out a point p that is on a sphere is to raise it by less than anything in the
//! paraboloid over space, but by more than all the points before. So the tetrahedra are those of a regular
//! triangulation in general position, in which no cycle of tetrahedra lies each in front of the next as seen from a
//! point \[Edelsbrunner1990b\].

use super::{Delaunay, Work};
use crate::kernel::vector::{V3, sub};
use crate::predicates::staged::{Stage, orientation_exact, orientation_filter, sphere_exact, sphere_filter};
use std::cmp::Ordering;

/// The face opposite to each vertex, so that orientation_3d of it and the vertex is `Greater`.
pub(super) const FACES: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// Half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Tetrahedron {
    /// In place of a removed one the first is [`Delaunay::NONE`].
    pub(super) vertices: [u32; 4],
    /// Across the face opposite to each vertex.
    pub(super) neighbours: [u32; 4],
}

/// A triangulation that grows.
pub(super) struct Insertion<'a> {
    sites: &'a [V3],
    tetrahedra: Vec<Tetrahedron>,
    /// Of each tetrahedron: twice the number of the site for which it was tested last, and one more if it is in the
    /// cavity.
    marks: Vec<u32>,
    free: Vec<u32>,
    /// Where the next walk begins.
    last: u32,
    cavity: Vec<u32>,
    /// Faces around the cavity: a tetrahedron inside, and the vertex that its face is opposite to.
    boundary: Vec<(u32, usize)>,
    created: Vec<u32>,
    pub(super) work: Work,
}

/// What `number` is the index of; it occurs.
#[inline(always)]
#[allow(clippy::inline_always, reason = "a handful of instructions in the innermost loops")]
fn position(of: &[u32; 4], number: u32) -> usize {
    // Without branches: which it is cannot be predicted.
    usize::from(of[1] == number) + 2 * usize::from(of[2] == number) + 3 * usize::from(of[3] == number)
}

impl<'a> Insertion<'a> {
    /// The tetrahedra of the six bounding sites, around the diagonal from 0 to 1. They are at the same distance from
    /// their centre, exactly, so any diagonal is Delaunay.
    pub(super) fn new(sites: &'a [V3]) -> Self {
        let ring = [2, 4, 3, 5];
        let tetrahedra: Vec<Tetrahedron> = (0..4u32)
            .map(|i| {
                let [a, b] = [ring[i as usize], ring[(i as usize + 1) % 4]];
                // Opposite to a lies the next one, opposite to b the one before.
                Tetrahedron {
                    vertices: [0, 1, a, b],
                    neighbours: [Delaunay::NONE, Delaunay::NONE, (i + 1) % 4, (i + 3) % 4],
                }
            })
            .collect();
        Self {
            sites,
            marks: vec![0; tetrahedra.len()],
            tetrahedra,
            free: Vec::new(),
            last: 0,
            cavity: Vec::new(),
            boundary: Vec::new(),
            created: Vec::new(),
            work: Work::default(),
        }
    }

    /// Inserts a site other than all before; whether there are numbers enough for its tetrahedra.
    #[must_use]
    pub(super) fn insert(&mut self, site: u32) -> bool {
        let p = self.sites[site as usize];
        let start = self.locate(p);
        self.find_cavity(start, p, site);
        if self.tetrahedra.len() + self.boundary.len() >= Delaunay::NONE as usize {
            return false;
        }
        self.fill(site);
        self.link();
        for &t in &self.cavity {
            self.tetrahedra[t as usize].vertices[0] = Delaunay::NONE;
        }
        self.free.append(&mut self.cavity);
        self.last = self.created[0];
        true
    }

    /// What has become of it, with the places of removed ones.
    pub(super) fn into_tetrahedra(self) -> Vec<Tetrahedron> {
        self.tetrahedra
    }

    /// A tetrahedron that contains p, maybe on a face.
    fn locate(&mut self, p: V3) -> u32 {
        let (mut at, mut from) = (self.last, Delaunay::NONE);
        'walk: loop {
            self.work.steps += 1;
            let Tetrahedron { vertices, neighbours } = self.tetrahedra[at as usize];
            let corners = vertices.map(|v| self.sites[v as usize]);
            let offsets = corners.map(|v| sub(v, p));
            for (face, next) in FACES.iter().zip(neighbours) {
                if next == from {
                    continue;
                }
                self.work.orientations += 1;
                let sign = match orientation_filter(face.map(|k| offsets[k])) {
                    Some(sign) => sign,
                    None => self.orientation(face.map(|k| corners[k]), p),
                };
                // Of the corners as seen from p: the other way round.
                if sign == Ordering::Greater {
                    debug_assert_ne!(next, Delaunay::NONE, "inside the bounding sites");
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
            Stage::Small => self.work.small_orientations += 1,
            _ => self.work.adaptive_orientations += 1,
        }
        sign
    }

    /// Whether p is strictly inside the sphere of a tetrahedron.
    #[inline]
    fn conflicts(&mut self, tetrahedron: u32, p: V3) -> bool {
        self.work.spheres += 1;
        let corners = self.tetrahedra[tetrahedron as usize].vertices.map(|v| self.sites[v as usize]);
        let sign = match sphere_filter(corners, p) {
            Some(sign) => sign,
            None => self.sphere(corners, p),
        };
        sign == Ordering::Greater
    }

    #[cold]
    fn sphere(&mut self, corners: [V3; 4], p: V3) -> Ordering {
        let (sign, stage) = sphere_exact(corners, p);
        match stage {
            Stage::Small => self.work.small_spheres += 1,
            Stage::Double => self.work.double_spheres += 1,
            Stage::Adaptive => self.work.adaptive_spheres += 1,
        }
        sign
    }

    /// Collects the tetrahedra in conflict with p, from one of them, and the faces around them.
    fn find_cavity(&mut self, start: u32, p: V3, site: u32) {
        let outside = 2 * site;
        let inside = outside + 1;
        self.cavity.clear();
        self.boundary.clear();
        self.marks[start as usize] = inside;
        self.cavity.push(start);
        let mut done = 0;
        while let Some(&t) = self.cavity.get(done) {
            done += 1;
            for (face, next) in self.tetrahedra[t as usize].neighbours.into_iter().enumerate() {
                if next != Delaunay::NONE {
                    let mark = self.marks[next as usize];
                    if mark == inside {
                        continue;
                    }
                    if mark != outside {
                        if self.conflicts(next, p) {
                            self.marks[next as usize] = inside;
                            self.cavity.push(next);
                            continue;
                        }
                        self.marks[next as usize] = outside;
                    }
                }
                self.boundary.push((t, face));
            }
        }
    }

    /// Makes the new tetrahedra: of those in the cavity that have a face around it, with the site in place of the vertex
    /// behind the face. In the old ones they become the neighbours there.
    fn fill(&mut self, site: u32) {
        self.created.clear();
        for &(t, face) in &self.boundary {
            let old = self.tetrahedra[t as usize];
            let mut new = Tetrahedron { vertices: old.vertices, neighbours: [Delaunay::NONE; 4] };
            new.vertices[face] = site;
            new.neighbours[face] = old.neighbours[face];
            #[allow(clippy::cast_possible_truncation, reason = "checked")]
            let number = self.free.pop().unwrap_or_else(|| {
                self.tetrahedra.push(new);
                self.marks.push(0);
                self.tetrahedra.len() as u32 - 1
            });
            self.tetrahedra[number as usize] = new;
            self.marks[number as usize] = 0;
            if let Some(beyond) = self.tetrahedra.get_mut(old.neighbours[face] as usize) {
                let back = position(&beyond.neighbours, t);
                beyond.neighbours[back] = number;
            }
            self.tetrahedra[t as usize].neighbours[face] = number;
            self.created.push(number);
        }
        self.work.created += self.created.len() as u64;
    }

    /// Makes neighbours of the new tetrahedra that share an edge of faces around the cavity, by turning around the edge
    /// through the old ones.
    fn link(&mut self) {
        let inside = |marks: &[u32], t: u32| marks[t as usize] & 1 == 1;
        for (&(t, face), &number) in self.boundary.iter().zip(&self.created) {
            for side in (0..4).filter(|&side| side != face) {
                if self.tetrahedra[number as usize].neighbours[side] != Delaunay::NONE {
                    continue;
                }
                // The edge and the vertex `pivot` make the face that is crossed, opposite to vertex `exit`.
                let (mut at, mut exit, mut pivot) = (t, side, face);
                let other = loop {
                    let old = &self.tetrahedra[at as usize];
                    let next = old.neighbours[exit];
                    if !inside(&self.marks, next) {
                        break next;
                    }
                    let vertex = old.vertices[pivot];
                    let old = &self.tetrahedra[next as usize];
                    (exit, pivot, at) = (position(&old.vertices, vertex), position(&old.neighbours, at), next);
                };
                self.tetrahedra[number as usize].neighbours[side] = other;
                self.tetrahedra[other as usize].neighbours[pivot] = number;
            }
        }
    }
}
