//! A perspective camera, which makes the rays through the pixels of a picture.

use nalgebra::{Point3, Vector3};
use p2m_core::{PrimitiveSet, Ray, Soup};

/// The distance of the eye from the centre of the scene, in diagonals of the bounding box.
const EYE_DISTANCE_DIAGONALS: f64 = 2.0;

/// An eye, and a picture in a plane through the centre of the scene, in which y is up.
pub(crate) struct Camera {
    eye: Point3<f64>,
    /// The unit vectors to the right in the picture, upwards in the picture, and towards the eye.
    pub(crate) axes: [Vector3<f64>; 3],
    /// The upper left corner of the picture.
    corner: Point3<f64>,
    /// The side of a pixel, in units of the scene.
    pixel: f64,
    /// The width and height of the picture in pixels.
    pub(crate) size: [u32; 2],
}

impl Camera {
    /// Makes a camera that sees the whole scene in a picture of this width in pixels.
    ///
    /// `towards` is the direction from the centre of the scene to the eye. Returns `None` if it is vertical, zero
    /// or not finite.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    pub(crate) fn before(scene: &Soup<f64>, towards: &Vector3<f64>, width: u32) -> Option<Self> {
        let bounds = scene.aabb();
        let middle = nalgebra::center(&bounds.min, &bounds.max);
        let diagonal = Some((bounds.max - bounds.min).norm()).filter(|d| *d > 0.0).unwrap_or(1.0);
        let back = towards.try_normalize(0.0).filter(|back| back.iter().all(|x| x.is_finite()))?;
        let right = Vector3::y().cross(&back).try_normalize(0.0)?;
        let axes = [right, back.cross(&right), back];
        // The loop finds the extent of the projected vertices in the picture.
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for index in scene.elements().flat_map(|element| element.indices().to_vec()) {
            let [x, y, z] = axes.map(|axis| axis.dot(&(scene.positions()[index as usize] - middle)));
            let scale = EYE_DISTANCE_DIAGONALS * diagonal / (EYE_DISTANCE_DIAGONALS * diagonal - z);
            for (k, x) in [x, y].into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(x * scale), high[k].max(x * scale));
            }
        }
        let margin = diagonal * 0.02;
        let [across, down] = [0, 1].map(|k| high[k] - low[k] + 2.0 * margin);
        let pixel = across / f64::from(width);
        let height = (down / pixel).ceil().clamp(1.0, 4.0 * f64::from(width)) as u32;
        let corner = middle + axes[0] * (low[0] - margin) + axes[1] * (high[1] + margin);
        Some(Self {
            eye: middle + back * (EYE_DISTANCE_DIAGONALS * diagonal),
            axes,
            corner,
            pixel,
            size: [width, height],
        })
    }

    /// Returns the ray from the eye through a point of the picture, which is given in pixels from the upper left
    /// corner. The ray has a radius of 0.75 pixels.
    pub(crate) fn ray(&self, [x, y]: [f64; 2]) -> Ray {
        let point = self.corner + self.axes[0] * (x * self.pixel) - self.axes[1] * (y * self.pixel);
        let ray = Ray::through(&self.eye, &point).and_then(|ray| ray.with_radius(self.pixel * 0.75));
        ray.expect("the eye is not in the picture")
    }
}
