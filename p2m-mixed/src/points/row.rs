//! Rows of tables, which are points or rays.

use crate::Reason;
use nalgebra::Point3;

/// A value made from N numbers, such as a point or a ray.
pub(crate) trait Row<const N: usize>: Sized {
    /// The names of the columns of a CSV file in lower case. The first names take precedence.
    const COLUMNS: &[[&'static str; N]];
    /// The names of two columns without a third, which is then 0. The first names take precedence.
    const FLAT: &[[&'static str; 2]] = &[];
    /// The text of a message that lists the names of columns.
    const EXPECTED_COLUMNS: &'static str;
    /// The fields of a structured array that have three numbers each.
    const TRIPLES: &[&'static str];
    /// The fields of a structured array that have one number each.
    const FIELDS: [&'static str; N];
    /// The text of a message that lists the fields.
    const EXPECTED_FIELDS: &'static str;
    /// The shape of an array without fields, as messages show it.
    const SHAPE: &'static str;
    /// The properties of the vertices of a PLY file.
    const PROPERTIES: [&'static str; N];

    /// Returns the reason why a row of `found` numbers is an error.
    fn too_few(found: usize) -> Reason;

    /// Makes a row from numbers, which may not be finite.
    fn new(numbers: [f64; N]) -> Result<Self, Reason>;
}

impl Row<3> for Point3<f64> {
    const COLUMNS: &[[&'static str; 3]] = &[
        ["qx", "qy", "qz"],
        ["x", "y", "z"],
        ["points:0", "points:1", "points:2"],
        ["easting", "northing", "height"],
        ["easting", "northing", "elevation"],
    ];
    const FLAT: &[[&'static str; 2]] = &[["x", "y"], ["easting", "northing"]];
    const EXPECTED_COLUMNS: &'static str =
        "qx, qy, qz or x, y[, z] (or like 'X [m]') or Points:0 to Points:2 or easting, northing[, height]";
    const TRIPLES: &[&'static str] = &["query"];
    const FIELDS: [&'static str; 3] = ["x", "y", "z"];
    const EXPECTED_FIELDS: &'static str = "query of shape (3,), or x, y, z";
    const SHAPE: &'static str = "(n, 3) or (n, 2)";
    const PROPERTIES: [&'static str; 3] = ["x", "y", "z"];

    fn too_few(found: usize) -> Reason {
        Reason::TooFewCoordinates { found }
    }

    fn new(numbers: [f64; 3]) -> Result<Self, Reason> {
        Ok(Self::from(numbers))
    }
}
