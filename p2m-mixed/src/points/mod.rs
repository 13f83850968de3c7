//! Readers of query points and rays.

pub(crate) mod npy;
mod rays;
mod read;
pub(crate) mod row;
pub(crate) mod table;

pub use rays::{read_rays, read_rays_from};

use crate::ReadError;
use crate::open::open;
use nalgebra::Point3;
use read::read;
use std::io::BufRead;
use std::path::Path;

p2m_core::formats! {
    /// The file formats of query points and rays, see [`read_points`](crate::read_points).
    PointFormat {
        /// This is a text table, usually with columns that are separated by blanks.
        Xyz = "xyz" | "txt" | "asc" | "pts",
        /// This is a text table, usually with columns that are separated by commas or semicolons.
        Csv = "csv",
        /// This is an array of NumPy.
        Npy = "npy",
        /// The points are the vertices of a PLY file.
        Ply = "ply",
    }
}

/// Reads query points from a file. Its extension, in any case, selects the format.
///
/// # Text tables: XYZ, TXT, ASC, PTS and CSV
/// The first record decides what separates the columns: semicolons, commas, tabs or blanks, or what a line such as
/// `sep=;` before it names. Fields may be quoted, but may not extend over several lines. Blank lines and lines that
/// start with `#` or `//` are ignored. A line with a whole number alone before the first record is the number of rows.
///
/// If the first record has columns named `qx`, `qy`, `qz`, or else `x`, `y`, `z`, or else `Points:0`, `Points:1`,
/// `Points:2`, these are used. The case of names is ignored, and so is text after a blank or a bracket, as in `X [m]`.
/// Other names are an error. A record has names if none of its first three fields starts like a number. The names may
/// also be in a comment before the first record, such as `# id x y z`, if it has as many words as the record.
///
/// Without names the first three columns are used. A first record that has a whole number, three other numbers and a
/// word is an error, because surveyors write the number of a point before its coordinates.
///
/// # NPY
/// An array of NumPy has the shape `(n, 3)`, C or Fortran order, and integers or floats of 4 or 8 bytes in either byte
/// order. A structured array has the shape `(n,)`, and a field `query` of shape `(3,)` or else the fields `x`, `y`,
/// `z`. Integers of 64 bits are rounded to double precision. Nothing may follow the array.
///
/// # PLY
/// The vertices are the points, whatever the primitives are.
///
/// # Files of answers
/// A file of answers that the program `p2m` wrote can be read as its queries, in each of its formats.
///
/// # Coordinates that are not finite
/// They are allowed, as scanners write `nan` where they saw nothing. Such a point has no closest point.
///
/// # Errors
/// [`ReadError`] with the location for invalid numbers, rows of fewer than three numbers, another number of rows than
/// announced,
/// columns or fields whose names do not identify the coordinates, arrays of other shapes and types, an early end, and
/// errors of the file. No memory is allocated for points that the header only announces.
pub fn read_points(path: &Path) -> Result<Vec<Point3<f64>>, ReadError> {
    let format = PointFormat::from_path(path)?;
    let name = path.display().to_string();
    read_points_from(open(path, &name)?, format, &name)
}

/// Reads query points from any reader, such as the standard input. `name` is the name of the file in messages.
///
/// ```
/// use p2m_mixed::{PointFormat, read_points_from};
///
/// let points = read_points_from("1 2 3\n".as_bytes(), PointFormat::Xyz, "standard input")?;
/// assert_eq!(points, [nalgebra::Point3::new(1.0, 2.0, 3.0)]);
/// # Ok::<(), p2m_mixed::ReadError>(())
/// ```
///
/// # Errors
/// The errors are those of [`read_points`].
pub fn read_points_from(reader: impl BufRead, format: PointFormat, name: &str) -> Result<Vec<Point3<f64>>, ReadError> {
    read(reader, format, name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Reason;

    #[test]
    fn extensions_decide() {
        let error = read_points(Path::new("queries.las")).unwrap_err();
        assert_eq!(
            error.to_string(),
            "queries.las: unknown extension 'las', expected one of xyz, txt, asc, pts, csv, npy, ply"
        );
        assert!(matches!(read_points(Path::new("/nonexistent/q.XYZ")).unwrap_err().reason, Reason::Io(_)));
    }
}
