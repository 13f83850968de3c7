//! The choice of the directions that a scene needs.
//!
//! A slab is thin around a facet that is parallel to it, and around a segment that runs along it. The choice therefore
//! begins with three orthogonal directions along which most of the area of facets (by their normals) and most of the
//! length of segments lie. A scene that was built along some axes has such a frame however it was turned afterwards.
//!
//! Then trees with 6 to 26 faces, along the axes and along the frame, answer trial queries, and the visited
//! nodes and packets are counted. More slabs cost arithmetic in every node, so they have to save visits. The
//! sizes of the volumes of leaves do not predict that: those of a thin wire shrink most, but few other
//! primitives are near it (docs/kdop.md).

use crate::orientation::{candidate_frames, misalignment, sample_directions};
use crate::trial::{FACES, frame_and_diagonals, query_times, to_shape, trial_queries};
use crate::{Directions, DirectionsError};
use nalgebra::Vector3;
use p2m_core::{BuildError, PrimitiveId, PrimitiveSet, Real, Shape, check_set};
use std::fmt;

/// The directions that were chosen for a scene, with the reasons. `Display` prints them as a sentence.
///
/// ```
/// use p2m_core::{BuildIndex, ClosestPoint, Triangle};
/// use p2m_kdop::{DirectionChoice, KdopOptions, KdopTree};
/// use nalgebra::{Point3, Rotation3, Vector3};
///
/// // The scene has long boards side by side, which are turned.
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
    /// The number of faces, which is twice that of directions: 6, 14, 18 or 26.
    pub k: usize,
    /// The frame that was found: three orthogonal unit vectors.
    pub frame: [Vector3<f64>; 3],
    /// The mean misalignment of facets and segments with the axes: 0 if all of them lie along the axes, and 1
    /// if none does.
    pub waste_of_axes: f64,
    /// The mean misalignment of facets and segments with the frame.
    pub waste_of_frame: f64,
    /// The work of a trial query with 6, 14, 18 and 26 faces along the axes, relative to that with boxes
    /// along the axes.
    pub work_along_axes: [f64; 4],
    /// The work of a trial query with 6, 14, 18 and 26 faces along the frame, relative to that with boxes along the
    /// axes; `None` if the frame was not tried.
    pub work_along_frame: Option<[f64; 4]>,
    is_turned: bool,
}

/// The relative work below which more faces or another frame are used, so that chance does not decide.
const MAX_WORK_RATIO: f64 = 0.97;
/// The frame is tried if its misalignment is below this part of that of the axes.
const MAX_MISALIGNMENT_RATIO: f64 = 0.75;

impl DirectionChoice {
    /// Chooses directions for a scene. A large scene is sampled, always in the same way.
    ///
    /// # Errors
    /// Returns the errors of building a tree: for a coordinate that is not finite, and for more primitives than ids.
    ///
    /// # Complexity
    /// O(n log n), because four or eight trees are built.
    pub fn from_scene<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(set: &S) -> Result<Self, BuildError> {
        check_set(set)?;
        let directions = sample_directions(set);
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let waste_of_axes = misalignment(&directions, &axes);
        let mut best = (axes, waste_of_axes);
        for frame in candidate_frames(&directions) {
            let waste = misalignment(&directions, &frame);
            if waste < best.1 {
                best = (frame, waste);
            }
        }
        let shapes: Vec<Shape<f64>> = (0..set.len()).map(|i| to_shape(&set.get(PrimitiveId::new(i)))).collect();
        let queries = trial_queries(&shapes);
        let axes_times = query_times(&shapes, &queries, &axes);
        let frame_times =
            (best.1 < waste_of_axes * MAX_MISALIGNMENT_RATIO).then(|| query_times(&shapes, &queries, &best.0));
        let relative = |times: [f64; 4]| times.map(|time| time / axes_times[0]);
        let mut choice = Self {
            k: 6,
            frame: best.0,
            waste_of_axes,
            waste_of_frame: best.1,
            work_along_axes: relative(axes_times),
            work_along_frame: frame_times.map(relative),
            is_turned: false,
        };
        let mut least = 1.0;
        for (is_turned, work) in [(false, Some(choice.work_along_axes)), (true, choice.work_along_frame)] {
            for (k, work) in FACES.into_iter().zip(work.into_iter().flatten()) {
                if work < least * MAX_WORK_RATIO {
                    (least, choice.k, choice.is_turned) = (work, k, is_turned);
                }
            }
        }
        Ok(choice)
    }

    /// Whether the chosen directions are along the frame rather than along the axes.
    #[must_use]
    pub fn is_turned(&self) -> bool {
        self.is_turned
    }

    /// The chosen directions for trees of K faces: the frame or the axes, and then as many of its diagonals as K
    /// has room for.
    ///
    /// # Errors
    /// Returns an error if K is below 6, odd, or above 26.
    pub fn directions<const K: usize>(&self) -> Result<Directions<K>, DirectionsError> {
        frame_and_diagonals(&if self.is_turned { self.frame } else { [Vector3::x(), Vector3::y(), Vector3::z()] })
    }

    /// The frame that was found and its diagonals, whether or not it was chosen.
    ///
    /// # Errors
    /// Returns an error if K is below 6, odd, or above 26.
    pub fn frame_directions<const K: usize>(&self) -> Result<Directions<K>, DirectionsError> {
        frame_and_diagonals(&self.frame)
    }
}

impl fmt::Display for DirectionChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |part: f64| 100.0 * part;
        let index = FACES.iter().position(|k| *k == self.k).unwrap_or(0);
        let work = self.work_along_frame.filter(|_| self.is_turned).unwrap_or(self.work_along_axes);
        write!(f, "{} directions along ", self.k)?;
        if self.is_turned {
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
        if self.is_turned || self.k > 6 {
            write!(f, "; trial queries take {:.0} % of their work with boxes along the axes", percent(work[index]))?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Rotation3};
    use p2m_core::{Segment, Soup, Triangle};
    use p2m_testkit::scenes;

    /// Returns facets of boxes, which are turned.
    fn boxes(turn: &Rotation3<f64>) -> Vec<Triangle<f64>> {
        (0..300)
            .map(|i| {
                let axis = i % 3;
                let at = |u: f64, v: f64| {
                    let mut p = Point3::new(0.0, 0.0, 0.0);
                    p[axis] = f64::from(i as i32 / 3);
                    p[(axis + 1) % 3] = u;
                    p[(axis + 2) % 3] = v;
                    turn * p
                };
                Triangle::new(at(0.0, 0.0), at(1.0, 0.0), at(0.2, 1.0))
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
    fn a_choice_prints_its_reasons() {
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

    /// More faces are chosen only where they save more visits, near and far, than their nodes cost.
    #[test]
    fn more_faces_are_chosen_where_they_save_work() {
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
