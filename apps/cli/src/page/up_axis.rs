//! The axis that points up in pictures.

use clap::ValueEnum;
use nalgebra::Point3;
use p2m_page::UpAxis;

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Up {
    /// As in most scans and models for films and games; in the front view, z points at the viewer
    Y,
    /// As in CAD and maps
    Z,
}

impl Up {
    /// Rotates points with this axis up so that z is up.
    pub(crate) fn rotate_to_z_up<'a>(self, points: impl Iterator<Item = &'a mut Point3<f64>>) {
        if self == Self::Y {
            points.for_each(|p| *p = Point3::new(p.x, -p.z, p.y));
        }
    }
}

impl From<Up> for UpAxis {
    fn from(up: Up) -> Self {
        match up {
            Up::Y => Self::Y,
            Up::Z => Self::Z,
        }
    }
}
