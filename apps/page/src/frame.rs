//! The frame of a page, in which the GPU computes in f32.

use nalgebra::Point3;
use p2m_core::Aabb;
use serde::Serialize;

/// Positions in the frame are divided by a scale and are relative to a point, so that a scene is drawn equally well at
/// any distance from the origin and in any unit.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct Frame {
    /// The point at the origin of the frame, in the unit of the scene.
    origin: [f64; 3],
    /// The length of the scene's unit vector in the frame is the reciprocal of this power of two.
    scale: f64,
    /// The radius of a sphere around the origin of the frame that contains everything, in the frame.
    radius: f64,
}

impl Frame {
    /// Returns the frame of a box. That of an empty box is the unit cube around the origin.
    pub(crate) fn of(bounds: &Aabb<f64>) -> Self {
        let (min, max): ([f64; 3], [f64; 3]) = if bounds.is_empty() {
            ([-0.5; 3], [0.5; 3])
        } else {
            (bounds.min.coords.into(), bounds.max.coords.into())
        };
        // Numbers are halved first, because the sum and the difference of two finite numbers may overflow.
        let origin = std::array::from_fn(|k| min[k] / 2.0 + max[k] / 2.0);
        let half: [f64; 3] = std::array::from_fn(|k| max[k] / 2.0 - min[k] / 2.0);
        let longest = half.iter().fold(0.0f64, |a, &b| a.max(b));
        let scale = if longest > 0.0 { longest.log2().ceil().clamp(-1000.0, 1023.0).exp2() } else { 1.0 };
        let norm = half.iter().map(|x| (x / scale).powi(2)).sum::<f64>().sqrt();
        Self { origin, scale, radius: if norm > 0.0 { norm } else { 1.0 } }
    }

    /// Returns a position in the frame.
    #[allow(clippy::cast_possible_truncation, reason = "the picture is in f32")]
    pub(crate) fn position(&self, point: &Point3<f64>) -> [f32; 3] {
        std::array::from_fn(|k| (point[k] / self.scale - self.origin[k] / self.scale) as f32)
    }

    /// Returns a length in the frame.
    pub(crate) fn length(&self, length: f64) -> f64 {
        length / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_any_size_and_place_are_near_the_origin() {
        for (low, high) in [(-1.0, 1.0), (1e6, 1e6 + 2.0), (-f64::MAX, f64::MAX), (1e-300, 3e-300), (5.0, 5.0)] {
            let [low, high] = [low, high].map(|x| Point3::from([x; 3]));
            let frame = Frame::of(&Aabb { min: low, max: high });
            for point in [low, high] {
                assert!(frame.position(&point).iter().all(|x| x.abs() <= 2.0), "{frame:?}");
            }
            assert!(frame.radius > 0.4 && frame.radius < 3.6, "{frame:?}");
        }
        assert!((Frame::of(&Aabb::empty()).radius - 0.75f64.sqrt() * 2.0).abs() < 1e-12);
    }
}
