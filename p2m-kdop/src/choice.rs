//! Directions from the scene: model only what a scene requires.
//!
//! A slab is thin around a facet that it is parallel to, and around a segment that runs along it. So three orthogonal
//! directions are sought first along which most of the area of facets (by their normals) and most of the length of segments
//! lie: a scene that was built along some axes has such a frame wherever it was turned to. Then the leaves are asked: how large
//! are k-DOPs around their primitives, of more and more directions, along the axes and along the frame? More slabs cost
//! arithmetic and memory in every node, so they have to save a part of the area, the measure of visits.

use crate::Polytope;
use nalgebra::Vector3;
use p2m_core::hierarchy::{PacketTree, SplitOptions};
use p2m_core::{Directions, DirectionsError, Kdop, Primitive, PrimitiveId, PrimitiveSet, Real};
use std::fmt;

/// Directions chosen for a scene, and why. Prints as a sentence.
///
/// ```
/// use p2m_core::{BuildIndex, ClosestPoint, Triangle};
/// use p2m_kdop::{Choice, KdopOptions, KdopTree};
/// use nalgebra::{Point3, Rotation3, Vector3};
///
/// // Steps along the axes, turned.
/// let turn = Rotation3::new(Vector3::new(0.3, 0.5, 0.1));
/// let steps: Vec<_> = (0..300)
///     .map(|i| {
///         let (x, z) = (f64::from((i + 1) / 2), f64::from(i / 2));
///         let far = Point3::new(f64::from(i / 2 + 1), 8.0, f64::from((i + 1) / 2));
///         Triangle::new(turn * Point3::new(x, 0.0, z), turn * Point3::new(far.x, 0.0, far.z), turn * far)
///     })
///     .collect();
/// let choice = Choice::from_scene(&steps);
/// assert!(choice.is_turned());
/// let directions = choice.directions::<6>().unwrap();
/// let tree = KdopTree::<f64, _, 6>::build_with(&steps, &KdopOptions::new(directions)).unwrap();
/// assert_eq!(tree.closest_point(&Point3::origin()).unwrap().distance, 0.0);
/// println!("{choice}");
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Choice {
    /// How many directions to use, both signs counted: 6, 14, 18 or 26.
    pub k: usize,
    /// The three that were found, orthogonal and of unit length.
    pub frame: [Vector3<f64>; 3],
    /// How far facets and segments are on average from lying along the axes, 0 for all of them do and 1 for none.
    pub waste_of_axes: f64,
    /// The same for the frame.
    pub waste_of_frame: f64,
    /// The areas of leaves bounded by 6, 14, 18 and 26 faces, in parts of that of boxes along the axes: along the axes,
    pub areas_of_axes: [f64; 4],
    /// and along the frame, if that was looked at.
    pub areas_of_frame: Option<[f64; 4]>,
    turned: bool,
}

/// The numbers of faces to choose from.
const FACES: [usize; 4] = [6, 14, 18, 26];
/// What a search costs with as many faces if as much is visited, in parts of what it costs with boxes (observed, over the scenes
/// of docs/kdop.md).
const COSTS: [f64; 4] = [1.0, 1.15, 1.22, 1.30];
/// How visits fall with the area (observed).
const POWER: f64 = 0.5;
/// How many leaves are looked at.
const LEAVES: usize = 600;

/// Primitives that are looked at, at most.
const SAMPLE: usize = 40_000;
/// Sides of the cells on the faces of a cube that directions are counted in.
const CELLS: usize = 32;
/// How many of the heaviest cells may give an axis of a frame.
const PEAKS: usize = 24;
/// The sine from which a facet counts as not along an axis at all: that of 10 degrees.
const ALIGNED: f64 = 0.174;
/// A frame is used if it wastes less than this part of what the axes do.
const GAIN: f64 = 0.75;

impl Choice {
    /// Looks at a scene, or at a sample of a large one: always the same one.
    ///
    /// # Complexity
    /// O(n log n): one or two trees are built.
    pub fn from_scene<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(set: &S) -> Self {
        let directions = sample(set);
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let waste_of_axes = waste(&directions, &axes);
        let mut best = (axes, waste_of_axes);
        let peaks = peaks(&directions);
        for (i, u) in peaks.iter().enumerate() {
            for v in &peaks[i + 1..] {
                // Nearly orthogonal, and made so.
                if u.dot(v).abs() < ALIGNED {
                    let v = (v - u * u.dot(v)).normalize();
                    let frame = [*u, v, u.cross(&v)];
                    let waste = waste(&directions, &frame);
                    if waste < best.1 {
                        best = (frame, waste);
                    }
                }
            }
        }
        let [of_axes, of_frame] = [axes, best.0];
        let boxes = areas(set, &of_axes);
        let whole = boxes[0];
        let parts =
            |areas: [f64; 4]| if whole > 0.0 && whole.is_finite() { areas.map(|a| a / whole) } else { [1.0; 4] };
        let areas_of_axes = parts(boxes);
        let areas_of_frame = (best.1 < waste_of_axes * GAIN).then(|| parts(areas(set, &of_frame)));
        let mut choice = Self {
            k: 6,
            frame: of_frame,
            waste_of_axes,
            waste_of_frame: best.1,
            areas_of_axes,
            areas_of_frame,
            turned: false,
        };
        let mut least = f64::INFINITY;
        for (turned, areas) in [(false, Some(areas_of_axes)), (true, areas_of_frame)] {
            for (i, area) in areas.into_iter().flatten().enumerate() {
                let cost = COSTS[i] * area.powf(POWER);
                if cost < least {
                    (least, choice.k, choice.turned) = (cost, FACES[i], turned);
                }
            }
        }
        choice
    }

    /// Whether the frame is to be used rather than the axes.
    #[must_use]
    pub fn is_turned(&self) -> bool {
        self.turned
    }

    /// The directions as a type of K: the frame or the axes, then as many diagonals of it as there is room for.
    ///
    /// # Errors
    /// For K below 6, odd, or above 26.
    pub fn directions<const K: usize>(&self) -> Result<Directions<K>, DirectionsError> {
        along(&if self.turned { self.frame } else { [Vector3::x(), Vector3::y(), Vector3::z()] })
    }
}

/// The axes of a frame and its diagonals: the usual sets, if the frame is that of the axes.
fn along<const K: usize>(frame: &[Vector3<f64>; 3]) -> Result<Directions<K>, DirectionsError> {
    let [x, y, z] = *frame;
    let of_cube = [x + y + z, y + z - x, z - x - y, x - y + z];
    let of_faces = [x + y, x + z, y + z, x - y, x - z, y - z];
    let diagonals = if K == 18 { [&of_faces[..], &of_cube].concat() } else { [&of_cube[..], &of_faces].concat() };
    let all = [&frame[..], &diagonals].concat();
    Directions::new(&all[..(K / 2).min(all.len())])
}

/// The areas of the k-DOPs of 6, 14, 18 and 26 faces around leaves.
fn areas<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(set: &S, frame: &[Vector3<f64>; 3]) -> [f64; 4] {
    let all = along::<26>(frame).expect("thirteen directions");
    let tree = PacketTree::build_kdops(set, &SplitOptions::default(), &all);
    let leaves: Vec<Kdop<26>> =
        tree.parts().filter(|part| tree.primitives(part).is_some()).map(|part| part.volume).collect();
    let count = leaves.len().min(LEAVES);
    let mut sums = [0.0; 4];
    for i in 0..count {
        let heights = &leaves[i * leaves.len() / count].heights;
        // Of the 26 the first 6 are the axes, the next 8 the diagonals of the cube, the last 12 those of its faces.
        let fourteen = Kdop { heights: std::array::from_fn(|i| heights[i]) };
        let eighteen = Kdop { heights: std::array::from_fn(|i| heights[if i < 6 { i } else { i + 8 }]) };
        let six = Kdop { heights: std::array::from_fn(|i| heights[i]) };
        sums[0] += area::<6>(&six, frame);
        sums[1] += area::<14>(&fourteen, frame);
        sums[2] += area::<18>(&eighteen, frame);
        sums[3] += area::<26>(&Kdop { heights: *heights }, frame);
    }
    sums
}

fn area<const K: usize>(kdop: &Kdop<K>, frame: &[Vector3<f64>; 3]) -> f64 {
    Polytope::new(kdop, &along(frame).expect("as many directions")).area()
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |part: f64| 100.0 * part;
        let place = FACES.iter().position(|k| *k == self.k).unwrap_or(0);
        let areas = self.areas_of_frame.filter(|_| self.turned).unwrap_or(self.areas_of_axes);
        write!(f, "{} directions along ", self.k)?;
        if self.turned {
            write!(f, "a frame of the scene's own (")?;
            for (i, axis) in self.frame.iter().enumerate() {
                let [x, y, z] = [axis.x, axis.y, axis.z].map(|c| c + 0.0);
                write!(f, "{}{x:.3} {y:.3} {z:.3}", if i > 0 { ", " } else { "" })?;
            }
            let [axes, frame] = [self.waste_of_axes, self.waste_of_frame].map(|waste| percent(1.0 - waste));
            write!(f, "), which {frame:.0} % of its facets and segments lie along, {axes:.0} % along the axes")?;
        } else {
            write!(f, "the axes")?;
        }
        if self.turned || self.k > 6 {
            write!(f, "; leaves have {:.0} % of the area of boxes along the axes", percent(areas[place]))?;
        }
        if self.k < 26 {
            write!(f, "; with 26 directions they would have {:.0} %, which does not pay", percent(areas[3]))?;
        }
        Ok(())
    }
}

/// Normals of facets and directions of segments with their weights, which add up to 1.
fn sample<T: Real, S: PrimitiveSet<T> + ?Sized>(set: &S) -> Vec<(Vector3<f64>, f64)> {
    let len = set.len();
    let count = len.min(SAMPLE);
    let mut found = Vec::with_capacity(count);
    let size = (0..count).map(|i| set.get(PrimitiveId::new(i * len / count)).aabb().to_f64());
    // Half of the scale of the scene, so that no product overflows.
    let bounds = size.fold(p2m_core::Aabb::empty(), |a, b| a.union(&b));
    let scale = (bounds.max.coords * 0.5 - bounds.min.coords * 0.5).max();
    for i in 0..count {
        let primitive = set.get(PrimitiveId::new(i * len / count));
        let corners: Vec<Vector3<f64>> =
            primitive.vertices().iter().map(|p| p.coords.map(|x| x.to_f64() / scale)).collect();
        // A segment counts as a facet as long and as thick as its own length: there is nothing to compare areas and lengths by.
        let weighted = match corners[..] {
            [a, b] => (b - a) * (b - a).norm(),
            [a, b, c] => (b - a).cross(&(c - a)),
            _ => continue,
        };
        let weight = weighted.norm();
        if weight > 0.0 && weight.is_finite() {
            found.push((weighted / weight, weight));
        }
    }
    let total: f64 = found.iter().map(|(_, weight)| weight).sum();
    found.iter_mut().for_each(|(_, weight)| *weight /= total);
    found
}

/// What of the scene is not along a frame: 0 for directions on an axis, 1 for those [`ALIGNED`] or more away.
fn waste(directions: &[(Vector3<f64>, f64)], frame: &[Vector3<f64>; 3]) -> f64 {
    let of = |n: &Vector3<f64>| {
        let cosine = frame.iter().map(|axis| axis.dot(n).abs()).fold(0.0, f64::max);
        ((1.0 - cosine * cosine).max(0.0) / (ALIGNED * ALIGNED)).min(1.0)
    };
    directions.iter().map(|(n, weight)| of(n) * weight).sum()
}

/// Mean directions of the cells with the most weight, the heaviest first.
fn peaks(directions: &[(Vector3<f64>, f64)]) -> Vec<Vector3<f64>> {
    let mut cells = vec![(Vector3::zeros(), 0.0); 3 * CELLS * CELLS];
    for (n, weight) in directions {
        // Where the line in this direction goes through a cube.
        let axis = n.iamax();
        let n = n * n[axis].signum();
        let cell = |k: usize| {
            let x = (n[(axis + k) % 3] / n[axis] * 0.5 + 0.5) * CELLS as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to CELLS")]
            let x = x.round() as usize;
            x.min(CELLS - 1)
        };
        let (sum, total) = &mut cells[(axis * CELLS + cell(1)) * CELLS + cell(2)];
        *sum += n * *weight;
        *total += weight;
    }
    cells.retain(|(_, total)| *total > 0.0);
    cells.sort_by(|a, b| b.1.total_cmp(&a.1));
    cells.truncate(PEAKS);
    cells.into_iter().map(|(sum, _)| sum.normalize()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Rotation3};
    use p2m_core::{Segment, Triangle};

    /// The faces of boxes, turned.
    fn boxes(turn: &Rotation3<f64>) -> Vec<Triangle<f64>> {
        (0..300)
            .map(|i| {
                let axis = i % 3;
                let place = |u: f64, v: f64| {
                    let mut p = Point3::new(0.0, 0.0, 0.0);
                    p[axis] = f64::from(i as i32 / 3);
                    p[(axis + 1) % 3] = u;
                    p[(axis + 2) % 3] = v * 3.0;
                    turn * p
                };
                Triangle::new(place(0.0, 0.0), place(1.0, 0.0), place(0.2, 1.0))
            })
            .collect()
    }

    #[test]
    fn a_turned_scene_gets_its_own_frame_back() {
        let straight = Choice::from_scene(&boxes(&Rotation3::identity()));
        assert!(!straight.is_turned() && straight.waste_of_axes < 1e-9, "{straight}");
        assert_eq!(straight.directions::<14>(), Ok(Directions::default()));
        assert_eq!(straight.directions::<18>(), Ok(Directions::default()));
        assert_eq!(straight.directions::<26>(), Ok(Directions::default()));
        for turn in [Vector3::new(0.3, 0.5, 0.1), Vector3::new(0.0, 0.0, 0.8), Vector3::new(1.0, -2.0, 0.5)] {
            let turn = Rotation3::new(turn);
            let choice = Choice::from_scene(&boxes(&turn));
            assert!(choice.is_turned() && choice.waste_of_frame < 1e-6, "{choice}");
            let directions = choice.directions::<6>().expect("a frame");
            assert!(directions.starts_orthogonal());
            for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                let along = directions.normals().iter().map(|n| n.dot(&(turn * axis))).fold(0.0, f64::max);
                assert!(along > 1.0 - 1e-9, "{choice}");
            }
        }
    }

    #[test]
    fn choices_say_why() {
        let turned = Choice::from_scene(&boxes(&Rotation3::new(Vector3::z() * 0.4)));
        assert!(turned.to_string().contains(" directions along a frame of the scene's own ("), "{turned}");
        let around: Vec<_> = (0..1000)
            .map(|i| {
                let t = f64::from(i) * 2.4;
                let z = f64::from(i) / 500.0 - 1.0;
                let r = (1.0 - z * z).max(0.0).sqrt();
                Segment::new(Point3::origin(), Point3::new(r * t.cos(), r * t.sin(), z))
            })
            .collect();
        let none = Choice::from_scene(&around);
        assert!(!none.is_turned() && none.to_string().contains("along the axes"), "{none}");
    }

    #[test]
    fn any_scene_has_a_choice() {
        let nothing: [Triangle<f64>; 0] = [];
        assert!(!Choice::from_scene(&nothing).is_turned());
        let flat = [Triangle::<f64>::new(Point3::origin(), Point3::origin(), Point3::origin())];
        assert_eq!(Choice::from_scene(&flat).directions::<6>(), Ok(Directions::default()));
        let large = [Segment::new(Point3::new(-f64::MAX, 0.0, 0.0), Point3::new(f64::MAX, f64::MAX, 0.0))];
        assert!(Choice::from_scene(&large).directions::<6>().is_ok());
        assert!(Choice::from_scene(&large).directions::<30>().is_err());
    }
}
