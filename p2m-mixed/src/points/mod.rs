//! Points and rays to ask about.

mod npy;
mod rays;
mod row;
mod table;

pub use rays::{read_rays, read_rays_from};
pub(crate) use row::Row;

use crate::ply::read_vertices;
use crate::scene::open;
use crate::{PointFormat, ReadError};
use nalgebra::Point3;
use std::io::BufRead;
use std::path::Path;

/// Reads points, in the format that the extension of the file's name says, in any case.
///
/// `xyz` and `txt`: the first three columns, separated by white space, are x, y and z; further ones are ignored, as are
/// blank lines and lines that begin with `#` or `//`. There is no line with the number of points in front, as chemists
/// have it.
///
/// `csv`: separated by semicolons if the first line has one, otherwise by commas; fields may be quoted, but not run
/// over several lines; blank lines and lines that begin with `#` are passed over. If the first record has columns named
/// `qx`, `qy`, `qz`, or else `x`, `y`, `z`, or else `Points:0`, `Points:1`, `Points:2`, these are used. Case does not
/// matter, nor does what follows a name behind a blank or a bracket, as in `X [m]`. Without such names the first three
/// columns are used. A first record with other names, that is one with none of its first three fields starting like a
/// number, is passed over if it has exactly three fields.
///
/// `npy`: an array of NumPy of shape `(n, 3)`, in C or Fortran order, of integers or floats of 4 or 8 bytes, in either
/// byte order; or a structured array of shape `(n,)` with a field `query` of shape `(3,)`, or else with fields `x`,
/// `y`, `z`. Integers of 64 bits are rounded to double precision. Nothing may follow the array.
///
/// `ply`: the vertices, whatever the primitives.
///
/// What an [`AnswerWriter`](crate::AnswerWriter) writes asks the same questions again, in each of its formats.
///
/// # Errors
/// [`ReadError`] with the place for numbers that are none or not finite, for fewer than three of them, for names of
/// columns or fields that do not tell which are the coordinates, for arrays of other shapes and types, and for an early
/// end. No memory is taken for points that are merely announced.
pub fn read_points(path: &Path) -> Result<Vec<Point3<f64>>, ReadError> {
    let format = PointFormat::from_path(path)?;
    let name = path.display().to_string();
    read_points_from(open(path, &name)?, format, &name)
}

/// Reads points from whatever can be read, such as the standard input; `name` is for messages.
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
/// As [`read_points`].
pub fn read_points_from(reader: impl BufRead, format: PointFormat, name: &str) -> Result<Vec<Point3<f64>>, ReadError> {
    read(reader, format, name)
}

/// Reads rows of any kind.
fn read<R: Row<N>, const N: usize>(reader: impl BufRead, format: PointFormat, name: &str) -> Result<Vec<R>, ReadError> {
    match format {
        PointFormat::Xyz => table::read_xyz(reader, name),
        PointFormat::Csv => table::read_csv(reader, name),
        PointFormat::Npy => npy::read_npy(reader, name),
        PointFormat::Ply => read_vertices(reader, name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Reason;

    #[test]
    fn extensions_decide() {
        let error = read_points(Path::new("queries.las")).unwrap_err();
        assert_eq!(error.to_string(), "queries.las: unknown extension 'las', expected one of xyz, txt, csv, npy, ply");
        assert!(matches!(read_points(Path::new("/nonexistent/q.XYZ")).unwrap_err().reason, Reason::Io(_)));
    }
}
