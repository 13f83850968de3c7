//! Directions from the scene: model only what a scene requires.
//!
//! A slab is thin around a facet that it is parallel to, and around a segment that runs along it. So three orthogonal
//! directions are sought first along which most of the area of facets (by their normals) and most of the length of
//! segments lie: a scene that was built along some axes has such a frame wherever it was turned to. Then trees of more
//! and more directions, along the axes and along the frame, answer some queries, and nodes and packets that they visit
//! are counted: more slabs cost arithmetic in every node, so they have to save visits. How large the volumes of leaves
//! are does not tell that: those of a thin wire shrink most, but nothing else is in their way (docs/kdop.md).

use crate::{Directions, DirectionsError, KdopOptions, KdopTree};
use nalgebra::{Point3, Vector3};
use p2m_core::{
    Aabb, BuildError, Primitive, PrimitiveId, PrimitiveSet, Real, Segment, Shape, StatsCollector, Triangle, check_set,
};
use std::fmt;

/// Directions chosen for a scene, and why. Prints as a sentence.
///
/// ```
/// use p2m_core::{BuildIndex, ClosestPoint, Triangle};
/// use p2m_kdop::{DirectionChoice, KdopOptions, KdopTree};
/// use nalgebra::{Point3, Rotation3, Vector3};
///
/// // Long boards side by side, turned.
/// let turn = Rotation3::new(Vector3::z() * 0.7);
/// let at = |x: i32, y: i32, z: i32| turn * Point3::new(f64::from(x * 200), f64::from(y), f64::from(z * 9));
/// let boards: Vec<_> = (0..2000)
///     .map(|i| {
///         let (y, z) = (i / 2 % 50, i / 100);
///         if i % 2 == 0 {
///             Triangle::new(at(0, y, z), at(1, y, z), at(1, y + 1, z))
///         } else {
///             Triangle::new(at(0, y, z), at(1, y + 1, z), at(0, y + 1, z))
///         }
///     })
///     .collect();
/// let choice = DirectionChoice::from_scene(&boards).unwrap();
/// assert!(choice.is_turned());
/// let directions = choice.directions::<6>().unwrap();
/// let tree = KdopTree::<f64, _, 6>::build_with(&boards, &KdopOptions::new(directions)).unwrap();
/// assert_eq!(tree.closest_point(&Point3::origin()).unwrap().distance, 0.0);
/// println!("{choice}");
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct DirectionChoice {
    /// How many faces, which is directions with both signs counted: 6, 14, 18 or 26.
    pub k: usize,
    /// The three that were found, orthogonal and of unit length.
    pub frame: [Vector3<f64>; 3],
    /// How far facets and segments are on average from lying along the axes, 0 for all of them do and 1 for none.
    pub waste_of_axes: f64,
    /// The same for the frame.
    pub waste_of_frame: f64,
    /// The work of a trial query with 6, 14, 18 and 26 faces, in parts of that with boxes along the axes: along the
    /// axes,
    pub work_along_axes: [f64; 4],
    /// and along the frame, if that was tried.
    pub work_along_frame: Option<[f64; 4]>,
    turned: bool,
}

/// The numbers of faces to choose from.
const FACES: [usize; 4] = [6, 14, 18, 26];
/// Nanoseconds that a query of a k-DOP tree takes whatever it visits (observed on one processor; of these costs only the ratios matter).
const NANOSECONDS_A_QUERY: f64 = 100.0;
/// Nanoseconds that a query takes to visit a node of a tree with 6, 14, 18 and 26 faces.
const NANOSECONDS_A_NODE: [f64; 4] = [30.0, 50.0, 50.0, 74.0];
/// Nanoseconds that a query takes to test a packet of such a tree; the octree has a figure of its own, on which its cells depend.
const NANOSECONDS_A_PACKET: f64 = 45.0;
/// What has to be saved before more faces or another frame are used: so that chance does not decide.
const WORTH: f64 = 0.97;
/// Queries that are tried.
const TRIALS: usize = 256;

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

impl DirectionChoice {
    /// Looks at a scene, or at a sample of a large one: always the same one.
    ///
    /// # Errors
    /// Those of building a tree: a coordinate that is not finite, or more primitives than ids.
    ///
    /// # Complexity
    /// O(n log n): four or eight trees are built.
    pub fn from_scene<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(set: &S) -> Result<Self, BuildError> {
        check_set(set)?;
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
        let shapes: Vec<Shape<f64>> = (0..set.len()).map(|i| shape(&set.get(PrimitiveId::new(i)))).collect();
        let queries = queries(&shapes);
        let of_axes = work(&shapes, &queries, &axes);
        let of_frame = (best.1 < waste_of_axes * GAIN).then(|| work(&shapes, &queries, &best.0));
        let parts = |work: [f64; 4]| work.map(|w| w / of_axes[0]);
        let mut choice = Self {
            k: 6,
            frame: best.0,
            waste_of_axes,
            waste_of_frame: best.1,
            work_along_axes: parts(of_axes),
            work_along_frame: of_frame.map(parts),
            turned: false,
        };
        let mut least = 1.0;
        for (turned, work) in [(false, Some(choice.work_along_axes)), (true, choice.work_along_frame)] {
            for (k, work) in FACES.into_iter().zip(work.into_iter().flatten()) {
                if work < least * WORTH {
                    (least, choice.k, choice.turned) = (work, k, turned);
                }
            }
        }
        Ok(choice)
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

    /// The frame that was found, and its diagonals, whether or not it was chosen.
    ///
    /// # Errors
    /// As [`directions`](Self::directions).
    pub fn frame_directions<const K: usize>(&self) -> Result<Directions<K>, DirectionsError> {
        along(&self.frame)
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

/// A primitive as what its vertices span, or as a diagonal of its box.
fn shape<T: Real>(primitive: &impl Primitive<T>) -> Shape<f64> {
    let wide = |p: &Point3<T>| p.map(|x| x.to_f64());
    match primitive.vertices() {
        [a] => p2m_core::Point::new(wide(a)).into(),
        [a, b] => Segment::new(wide(a), wide(b)).into(),
        [a, b, c] => Triangle::new(wide(a), wide(b), wide(c)).into(),
        _ => {
            let bounds = primitive.aabb();
            Segment::new(wide(&bounds.min), wide(&bounds.max)).into()
        }
    }
}

/// Points spread evenly in the box of the scene, and as many near its primitives.
fn queries(shapes: &[Shape<f64>]) -> Vec<Point3<f64>> {
    let bounds = shapes.iter().map(Primitive::aabb).fold(Aabb::empty(), |a, b| a.union(&b));
    if shapes.is_empty() {
        return Vec::new();
    }
    let place = |i: usize| {
        // Multiples of powers of the root of x^4 = x + 1, which fill a cube evenly.
        let fraction = |step: f64| (0.5 + step * i as f64).fract();
        [0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_3].map(fraction)
    };
    let inside = |i: usize| {
        Point3::from([0, 1, 2].map(|k: usize| {
            let t = place(i)[k];
            bounds.min[k] * (1.0 - t) + bounds.max[k] * t
        }))
    };
    let near = |i: usize| {
        let around = shapes[i * shapes.len() / TRIALS].aabb();
        let towards = inside(i);
        Point3::from([0, 1, 2].map(|k: usize| around.min[k] * 0.98 + towards[k] * 0.02))
    };
    (0..TRIALS).map(|i| if i % 2 == 0 { inside(i) } else { near(i) }).collect()
}

/// The expected work of a query for 6, 14, 18 and 26 directions along a frame.
fn work(shapes: &[Shape<f64>], queries: &[Point3<f64>], frame: &[Vector3<f64>; 3]) -> [f64; 4] {
    [
        trial::<6>(shapes, queries, frame, NANOSECONDS_A_NODE[0]),
        trial::<14>(shapes, queries, frame, NANOSECONDS_A_NODE[1]),
        trial::<18>(shapes, queries, frame, NANOSECONDS_A_NODE[2]),
        trial::<26>(shapes, queries, frame, NANOSECONDS_A_NODE[3]),
    ]
}

fn trial<const K: usize>(shapes: &[Shape<f64>], queries: &[Point3<f64>], frame: &[Vector3<f64>; 3], node: f64) -> f64 {
    let options = KdopOptions::new(along::<K>(frame).expect("as many directions"));
    let tree = KdopTree::<f64, _, K>::build_with(shapes, &options).expect("a scene that has been checked");
    let finite = queries.iter().filter(|q| q.iter().all(|x| x.is_finite()));
    let [nodes, packets, _] = StatsCollector::of_queries(finite, |query, counting| tree.visit(query, counting));
    NANOSECONDS_A_QUERY + (node * nodes as f64 + NANOSECONDS_A_PACKET * packets as f64) / queries.len().max(1) as f64
}

impl fmt::Display for DirectionChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |part: f64| 100.0 * part;
        let place = FACES.iter().position(|k| *k == self.k).unwrap_or(0);
        let work = self.work_along_frame.filter(|_| self.turned).unwrap_or(self.work_along_axes);
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
            write!(f, "; trial queries take {:.0} % of their work with boxes along the axes", percent(work[place]))?;
        } else {
            write!(
                f,
                "; with more, trial queries take {:.0} % of their work or more",
                percent(work[1..].iter().fold(f64::MAX, |a, b| a.min(*b)))
            )?;
        }
        Ok(())
    }
}

/// Normals of facets and directions of segments and long facets with their weights, which add up to 1.
fn sample<T: Real, S: PrimitiveSet<T> + ?Sized>(set: &S) -> Vec<(Vector3<f64>, f64)> {
    let len = set.len();
    let count = len.min(SAMPLE);
    let mut found = Vec::with_capacity(count);
    let boxes = (0..count).map(|i| set.get(PrimitiveId::new(i * len / count)).aabb().to_f64());
    // Half of the scale of the scene, so that no product overflows.
    let bounds = boxes.fold(Aabb::empty(), |a, b| a.union(&b));
    let scale = (bounds.max.coords * 0.5 - bounds.min.coords * 0.5).max();
    for i in 0..count {
        let primitive = set.get(PrimitiveId::new(i * len / count));
        let corners: Vec<Vector3<f64>> =
            primitive.vertices().iter().map(|p| p.coords.map(|x| x.to_f64() / scale)).collect();
        // A segment counts as a facet as long and as thick as its own length: there is nothing to compare areas and
        // lengths by. A long facet counts as a segment besides, the more the longer it is for its height.
        let weighted = match corners[..] {
            [a, b] => [(b - a) * (b - a).norm(), Vector3::zeros()],
            [a, b, c] => {
                let normal = (b - a).cross(&(c - a));
                let longest = [b - a, c - b, a - c].into_iter().max_by(|x, y| x.norm().total_cmp(&y.norm()));
                let edge = longest.unwrap_or_default();
                let slender = (1.0 - normal.norm() / edge.norm_squared()).max(0.0).powi(4);
                [normal, edge.normalize() * (normal.norm() * slender)]
            }
            _ => continue,
        };
        for vector in weighted {
            let weight = vector.norm();
            if weight > 0.0 && weight.is_finite() {
                found.push((vector / weight, weight));
            }
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
    use nalgebra::Rotation3;
    use p2m_core::Soup;
    use p2m_testkit::scenes;

    /// The faces of boxes, turned.
    fn boxes(turn: &Rotation3<f64>) -> Vec<Triangle<f64>> {
        (0..300)
            .map(|i| {
                let axis = i % 3;
                let place = |u: f64, v: f64| {
                    let mut p = Point3::new(0.0, 0.0, 0.0);
                    p[axis] = f64::from(i as i32 / 3);
                    p[(axis + 1) % 3] = u;
                    p[(axis + 2) % 3] = v;
                    turn * p
                };
                Triangle::new(place(0.0, 0.0), place(1.0, 0.0), place(0.2, 1.0))
            })
            .collect()
    }

    #[test]
    fn a_turned_scene_gets_its_own_frame_back() {
        let straight = DirectionChoice::from_scene(&boxes(&Rotation3::identity())).expect("finite");
        assert!(!straight.is_turned() && straight.waste_of_axes < 0.05, "{straight}");
        assert_eq!(straight.directions::<14>(), Ok(Directions::default()));
        assert_eq!(straight.directions::<18>(), Ok(Directions::default()));
        assert_eq!(straight.directions::<26>(), Ok(Directions::default()));
        for turn in [Vector3::new(0.3, 0.5, 0.1), Vector3::new(0.0, 0.0, 0.8), Vector3::new(1.0, -2.0, 0.5)] {
            let turn = Rotation3::new(turn);
            let choice = DirectionChoice::from_scene(&boxes(&turn)).expect("finite");
            assert!(choice.waste_of_frame < 0.05 && choice.work_along_frame.is_some(), "{choice:?}");
            let directions = choice.frame_directions::<6>().expect("a frame");
            assert!(directions.starts_orthogonal());
            for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                let along = directions.normals().iter().map(|n| n.dot(&(turn * axis))).fold(0.0, f64::max);
                assert!(along > 1.0 - 1e-9, "{choice}");
            }
        }
    }

    #[test]
    fn choices_say_why() {
        let turn = Rotation3::new(Vector3::z() * 0.7);
        let at = |x: i32, y: i32, z: i32| turn * Point3::new(f64::from(x * 200), f64::from(y), f64::from(z * 9));
        let boards: Vec<_> = (0..1000)
            .map(|i| Triangle::new(at(0, i % 50, i / 50), at(1, i % 50, i / 50), at(1, i % 50 + 1, i / 50)))
            .collect();
        let turned = DirectionChoice::from_scene(&boards).expect("finite");
        assert!(turned.is_turned(), "{turned:?}");
        assert!(turned.to_string().contains(" directions along a frame of the scene's own ("), "{turned}");
        assert_eq!(turned.directions::<26>(), turned.frame_directions());
        let around: Vec<_> = (0..1000)
            .map(|i| {
                let t = f64::from(i) * 2.4;
                let z = f64::from(i) / 500.0 - 1.0;
                let r = (1.0 - z * z).max(0.0).sqrt();
                Segment::new(Point3::origin(), Point3::new(r * t.cos(), r * t.sin(), z))
            })
            .collect();
        let none = DirectionChoice::from_scene(&around).expect("finite");
        assert!(!none.is_turned() && none.to_string().contains("along the axes"), "{none}");
    }

    /// Faces are chosen by what nodes cost, by queries near and far, and only where that saves something.
    #[test]
    fn as_many_faces_as_the_scene_is_worth() {
        let chosen = |soup: &Soup<f64>| {
            let choice = DirectionChoice::from_scene(soup).expect("finite");
            println!("{choice}: {:.3?}", choice.work_along_axes);
            choice.k
        };
        let mut rng = p2m_testkit::rng("choices", 0);
        assert_eq!(chosen(&scenes::soup(&mut rng, scenes::Kinds::Triangles, scenes::Layout::Uniform, 3000)), 18);
        assert_eq!([20, 50, 100, 300, 1000].map(|teeth| chosen(&scenes::skewed_gear(teeth))), [18, 14, 18, 18, 18]);
    }

    #[test]
    fn any_scene_has_a_choice() {
        let nothing: [Triangle<f64>; 0] = [];
        assert!(!DirectionChoice::from_scene(&nothing).expect("finite").is_turned());
        let flat = [Triangle::<f64>::new(Point3::origin(), Point3::origin(), Point3::origin())];
        assert_eq!(DirectionChoice::from_scene(&flat).expect("finite").directions::<6>(), Ok(Directions::default()));
        let large = [Segment::new(Point3::new(-f64::MAX, 0.0, 0.0), Point3::new(f64::MAX, f64::MAX, 0.0))];
        assert!(DirectionChoice::from_scene(&large).expect("finite").directions::<6>().is_ok());
        assert!(DirectionChoice::from_scene(&large).expect("finite").directions::<30>().is_err());
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
            let set = [large[0], Segment::new(Point3::origin(), Point3::new(0.0, bad, 0.0))];
            assert_eq!(DirectionChoice::from_scene(&set), Err(BuildError::NonFinite { id: PrimitiveId::new(1) }));
        }
    }
}
