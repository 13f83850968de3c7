//! A view of a scene, as rays through the pixels of a picture.

use nalgebra::{Point3, Vector3};
use p2m_core::{PrimitiveSet, Ray, Soup};

/// How far the eye is from the middle of the scene, in diagonals of its box.
const FAR: f64 = 2.0;

/// An eye, and a picture in a plane through the middle of the scene; y is up.
#[derive(Clone, Debug)]
pub struct Camera {
    eye: Point3<f64>,
    /// Right, up, and towards the eye.
    axes: [Vector3<f64>; 3],
    /// The upper left corner of the picture.
    corner: Point3<f64>,
    /// The side of a pixel, and how many of them the picture has.
    pixel: f64,
    size: [u32; 2],
    diagonal: f64,
}

impl Camera {
    /// Sees the whole scene in a picture of that width; `towards` leads from its middle towards the eye. `None` if that
    /// is up, down, zero or not finite.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    pub fn before(scene: &Soup<f64>, towards: &Vector3<f64>, width: u32) -> Option<Self> {
        let bounds = scene.aabb();
        let middle = nalgebra::center(&bounds.min, &bounds.max);
        let diagonal = Some((bounds.max - bounds.min).norm()).filter(|d| *d > 0.0).unwrap_or(1.0);
        let back = towards.try_normalize(0.0).filter(|back| back.iter().all(|x| x.is_finite()))?;
        let right = Vector3::y().cross(&back).try_normalize(0.0)?;
        let axes = [right, back.cross(&right), back];
        // Where the vertices are in the picture.
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for index in scene.elements().flat_map(|element| element.indices().to_vec()) {
            let [x, y, z] = axes.map(|axis| axis.dot(&(scene.positions()[index as usize] - middle)));
            let scale = FAR * diagonal / (FAR * diagonal - z);
            for (k, x) in [x, y].into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(x * scale), high[k].max(x * scale));
            }
        }
        let margin = diagonal * 0.02;
        let [across, down] = [0, 1].map(|k| high[k] - low[k] + 2.0 * margin);
        let pixel = across / f64::from(width);
        let height = (down / pixel).ceil().clamp(1.0, 4.0 * f64::from(width)) as u32;
        let corner = middle + axes[0] * (low[0] - margin) + axes[1] * (high[1] + margin);
        Some(Self { eye: middle + back * (FAR * diagonal), axes, corner, pixel, size: [width, height], diagonal })
    }

    /// Width and height of the picture, in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The side of a pixel, in the unit of the scene.
    #[must_use]
    pub fn pixel(&self) -> f64 {
        self.pixel
    }

    /// To the right in the picture, up, and towards the eye.
    #[must_use]
    pub fn axes(&self) -> &[Vector3<f64>; 3] {
        &self.axes
    }

    /// How far behind the middle of the scene a point is, in diagonals: from -0.5 to 0.5.
    #[must_use]
    pub fn depth(&self, point: &Point3<f64>) -> f64 {
        (self.eye - point).dot(&self.axes[2]) / self.diagonal - FAR
    }

    /// From the eye through a place of the picture, in pixels from its upper left corner, as thick as a pixel or two.
    ///
    /// # Panics
    /// For a scene whose extent leaves the range of f64.
    #[must_use]
    pub fn ray(&self, [x, y]: [f64; 2]) -> Ray {
        let place = self.corner + self.axes[0] * (x * self.pixel) - self.axes[1] * (y * self.pixel);
        let ray = Ray::through(&self.eye, &place).and_then(|ray| ray.with_radius(self.pixel * 0.75));
        ray.expect("the eye is not in the picture")
    }
}
