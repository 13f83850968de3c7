//! What a row of a table is.

use crate::Reason;
use nalgebra::Point3;

/// Something that is told by N numbers, of which files have many.
pub(crate) trait Row<const N: usize>: Sized {
    /// The columns of a CSV file, the names that are looked for first in front, in lower case; and a message that lists
    /// them.
    const COLUMNS: &[[&'static str; N]];
    const EXPECTED_COLUMNS: &'static str;
    /// The fields of an array of NumPy: three numbers each, or one; and a message that lists them.
    const TRIPLES: &[&'static str];
    const FIELDS: [&'static str; N];
    const EXPECTED_FIELDS: &'static str;
    /// The shape of a plain array.
    const SHAPE: &'static str;
    /// The properties of the vertices of a PLY file.
    const PROPERTIES: [&'static str; N];

    /// Why fewer numbers are not enough.
    fn too_few(found: usize) -> Reason;

    /// From finite numbers.
    fn new(numbers: [f64; N]) -> Result<Self, Reason>;
}

impl Row<3> for Point3<f64> {
    const COLUMNS: &[[&'static str; 3]] = &[["qx", "qy", "qz"], ["x", "y", "z"], ["points:0", "points:1", "points:2"]];
    const EXPECTED_COLUMNS: &'static str = "qx, qy, qz or x, y, z (or like 'X [m]') or Points:0, Points:1, Points:2";
    const TRIPLES: &[&'static str] = &["query"];
    const FIELDS: [&'static str; 3] = ["x", "y", "z"];
    const EXPECTED_FIELDS: &'static str = "query of shape (3,), or x, y, z";
    const SHAPE: &'static str = "(n, 3)";
    const PROPERTIES: [&'static str; 3] = ["x", "y", "z"];

    fn too_few(found: usize) -> Reason {
        Reason::TooFewCoordinates { found }
    }

    fn new(numbers: [f64; 3]) -> Result<Self, Reason> {
        Ok(Self::from(numbers))
    }
}
