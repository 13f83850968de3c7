//! The choice of directions that fit a scene.
//!
//! A slab is thin around a facet that is parallel to it, and around a segment that runs along it. So the basic idea is
//! to find a frame of three orthogonal directions that is aligned with most of the area of facets (by their normals)
//! and most of the length of segments. A scene that was modelled along some axes has such a frame, however it was
//! rotated afterwards. Candidates are the frames that the most frequent directions span; the least misaligned one is
//! chosen, if it is clearly better than the axes.

use crate::orientation::{candidate_frames, misalignment, sample_directions};
use crate::{Directions, DirectionsError};
use nalgebra::Vector3;
use p2m_core::{BuildError, PrimitiveSet, Real, check_set};
use std::fmt;

/// The directions that were chosen for a scene, with the reasons. `Display` prints them as a sentence.
///
/// ```
/// use p2m_core::{ClosestPoint, Triangle};
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
/// assert_eq!(tree.closest_point(&[0.0; 3]).unwrap().distance, 0.0);
/// println!("{choice}");
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct DirectionChoice {
    /// The best frame: three orthogonal unit vectors.
    pub frame: [Vector3<f64>; 3],
    /// The mean misalignment of facets and segments with the axes: 0 if all of them are aligned with the axes, and 1 if
    /// none is.
    pub waste_of_axes: f64,
    /// The mean misalignment of facets and segments with the frame.
    pub waste_of_frame: f64,
}

/// The largest ratio of the frame's misalignment to the axes' at which the frame is used. There is no record of how it
/// was tuned.
const MAX_MISALIGNMENT_RATIO: f64 = 0.75;

impl DirectionChoice {
    /// Chooses directions for a scene. Large scenes are sampled, deterministically.
    ///
    /// # Errors
    /// Returns the errors of building a tree, for a coordinate that is not finite and for more primitives than ids.
    pub fn from_scene<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(set: &S) -> Result<Self, BuildError> {
        check_set(set)?;
        let directions = sample_directions(set);
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let waste_of_axes = misalignment(&directions, &axes);
        let mut choice = Self { frame: axes, waste_of_axes, waste_of_frame: waste_of_axes };
        for frame in candidate_frames(&directions) {
            let waste = misalignment(&directions, &frame);
            if waste < choice.waste_of_frame {
                (choice.frame, choice.waste_of_frame) = (frame, waste);
            }
        }
        Ok(choice)
    }

    /// Returns whether the chosen directions are along the frame rather than along the axes.
    #[must_use]
    pub fn is_turned(&self) -> bool {
        self.waste_of_frame < self.waste_of_axes * MAX_MISALIGNMENT_RATIO
    }

    /// Returns the chosen directions for trees of K faces: the frame or the axes, and then as many of its diagonals as
    /// K admits.
    ///
    /// # Errors
    /// Returns an error if K is below 6, odd, or above 26.
    pub fn directions<const K: usize>(&self) -> Result<Directions<K>, DirectionsError> {
        frame_and_diagonals(&if self.is_turned() { self.frame } else { [Vector3::x(), Vector3::y(), Vector3::z()] })
    }

    /// Returns the directions of the best frame and its diagonals, whether or not it was chosen.
    ///
    /// # Errors
    /// Returns an error if K is below 6, odd, or above 26.
    pub fn frame_directions<const K: usize>(&self) -> Result<Directions<K>, DirectionsError> {
        frame_and_diagonals(&self.frame)
    }
}

/// Returns the axes of a frame and as many of its diagonals as K admits. If the frame consists of the coordinate axes,
/// these are the default directions.
fn frame_and_diagonals<const K: usize>(frame: &[Vector3<f64>; 3]) -> Result<Directions<K>, DirectionsError> {
    let [x, y, z] = *frame;
    let cube_diagonals = [x + y + z, y + z - x, z - x - y, x - y + z];
    let face_diagonals = [x + y, x + z, y + z, x - y, x - z, y - z];
    let diagonals = if K == 18 {
        [&face_diagonals[..], &cube_diagonals].concat()
    } else {
        [&cube_diagonals[..], &face_diagonals].concat()
    };
    let all = [&frame[..], &diagonals].concat();
    Directions::new(&all[..(K / 2).min(all.len())])
}

impl fmt::Display for DirectionChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [axes, frame] = [self.waste_of_axes, self.waste_of_frame].map(|waste| 100.0 * (1.0 - waste));
        if !self.is_turned() {
            return write!(f, "directions along the axes, which {axes:.0} % of its facets and segments lie along");
        }
        write!(f, "directions along a frame of the scene's own (")?;
        for (i, axis) in self.frame.iter().enumerate() {
            let [x, y, z] = [axis.x, axis.y, axis.z].map(|c| c + 0.0);
            write!(f, "{}{x:.3} {y:.3} {z:.3}", if i > 0 { ", " } else { "" })?;
        }
        write!(f, "), which {frame:.0} % of its facets and segments lie along, {axes:.0} % along the axes")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Rotation3};
    use p2m_core::{PrimitiveId, Segment, Triangle};

    /// Returns the facets of rotated boxes.
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
            assert!(choice.waste_of_frame < 0.05 && choice.is_turned(), "{choice:?}");
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
        assert!(turned.to_string().contains("directions along a frame of the scene's own ("), "{turned}");
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
