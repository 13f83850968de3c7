//! Readers of query points and rays.

pub(crate) mod npy;
mod rays;
mod read;
pub(crate) mod row;
pub(crate) mod table;

pub use rays::{read_rays, read_rays_from};

use crate::open::open;
use crate::{ReadError, Reason, Unit};
use nalgebra::Point3;
use read::read;
use std::collections::TryReserveError;
use std::io::BufRead;
use std::path::Path;

p2m_core::formats! {
    /// The file formats of query points and rays, see [`read_points`](crate::read_points).
    PointFormat {
        /// Text tables, usually with columns separated by blanks.
        Xyz = "xyz" | "txt" | "asc" | "pts",
        /// Text tables, usually with columns separated by commas or semicolons.
        Csv = "csv",
        /// NumPy arrays.
        Npy = "npy",
        /// PLY files, whose vertices are the points.
        Ply = "ply",
    }
}

/// Reads query points from a file. Its extension, in any case, selects the format.
///
/// # Text tables: XYZ, TXT, ASC, PTS and CSV
/// The first record determines the separator of columns: semicolons, commas, tabs or blanks, unless a line such as
/// `sep=;` before it names one. Fields may be quoted, but may not extend over several lines. Blank lines and lines that
/// start with `#` or `//` are ignored. A line with a single whole number before the first record is the number of rows.
/// A file of several scans, such as a PTS file, may have such a line before each scan.
///
/// If the first record has columns named `qx`, `qy`, `qz`, or else `x`, `y`, `z`, or else `Points:0`, `Points:1`,
/// `Points:2`, these are used. So are `easting`, `northing`, `height` or `elevation`. Upper and lower case are equal,
/// and text after a blank or a bracket is ignored, as in `X [m]`. Other names are an error. A record has names if none
/// of its first three fields starts like a number. The names may also be in a comment before the first record, such as
/// `# id x y z`, if it has as many words as the record.
///
/// Points are planar, with z = 0, if only `x` and `y` are named or each record has two numbers. A column named `id` has
/// the ids that [`read_point_table`] returns. That function can also choose columns.
///
/// Without names, the first three columns are used. It is an error if the first record has a whole number, three other
/// numbers and a word, because surveyors write the number of a point before its coordinates.
///
/// # NPY
/// An array has the shape `(n, 3)`, or `(n, 2)` for z = 0, in C or Fortran order. Its items are integers or floats of 4
/// or 8 bytes in either byte order. A structured array has the shape `(n,)`, and a field `query` of shape `(3,)` or
/// else the fields `x`, `y`, `z`. Integers of 64 bits are rounded to double precision. Nothing may follow the array. A
/// field `id` of integers or text has ids.
///
/// # PLY
/// The vertices are the points. Primitives are ignored.
///
/// # Files of answers
/// A file of answers that the program `p2m` wrote can be read as its queries, in each of its formats.
///
/// # Coordinates that are not finite
/// Coordinates may be NaN or infinite, because scanners write `nan` where they saw nothing. Such a point has no closest
/// point.
///
/// # Errors
/// [`ReadError`] with the location for invalid numbers, rows of fewer than three numbers, a wrong announced number of
/// rows, columns or fields whose names do not identify the coordinates, arrays of other shapes and types, an early end,
/// and errors of the file. No memory is allocated for points that the header only announces.
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
    Ok(read_point_table_from(reader, format, name, &PointColumns::default())?.points)
}

/// The columns of a text table that have the points, by their names in any case, or by their numbers from 1.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PointColumns {
    /// The columns of x, y and z, or of x and y. If it is empty, the names in the file determine them.
    pub coordinates: Vec<String>,
    /// The column of the ids. `None` stands for the column named `id`, if the file has one.
    pub id: Option<String>,
}

/// The points of a file with their ids and unit.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct PointTable {
    /// The points, in the order of the file.
    pub points: Vec<Point3<f64>>,
    /// The id of each point, if the file has them.
    pub ids: Option<PointIds>,
    /// The unit of the coordinates, if the file states it. Coordinates are not converted.
    pub unit: Option<Unit>,
    /// Whether points have two coordinates in the file. Their z is then 0.
    pub is_flat: bool,
}

/// Texts that identify the points of a file, one for each point.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PointIds {
    text: String,
    /// The end of each id in the text.
    ends: Vec<usize>,
}

impl PointIds {
    /// Returns the number of ids.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a file without points has no ids")]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Returns the id of a point, which is empty where the file has none.
    #[must_use]
    pub fn get(&self, point: usize) -> Option<&str> {
        let start = point.checked_sub(1).map_or(Some(0), |before| self.ends.get(before).copied())?;
        self.text.get(start..*self.ends.get(point)?)
    }

    /// Adds an id. Bytes that are not UTF-8 are replaced by U+FFFD.
    fn push(&mut self, id: &[u8]) -> Result<(), Reason> {
        let id = String::from_utf8_lossy(id);
        let reserved: Result<(), TryReserveError> =
            self.text.try_reserve(id.len()).and_then(|()| self.ends.try_reserve(1));
        reserved.map_err(Reason::Memory)?;
        self.text.push_str(&id);
        self.ends.push(self.text.len());
        Ok(())
    }
}

/// Reads query points with their ids from a file. Its extension, in any case, selects the format.
///
/// # Errors
/// The errors are those of [`read_points`], and [`Reason::NoSuchColumn`] for a chosen column that a table lacks.
pub fn read_point_table(path: &Path, columns: &PointColumns) -> Result<PointTable, ReadError> {
    let format = PointFormat::from_path(path)?;
    let name = path.display().to_string();
    read_point_table_from(open(path, &name)?, format, &name, columns)
}

/// Reads query points with their ids from any reader. `name` is the name of the file in messages.
///
/// ```
/// use p2m_mixed::{PointColumns, PointFormat, read_point_table_from};
///
/// let text = "id,lon,lat\nP7,4.5,52.0\n";
/// let columns = PointColumns { coordinates: vec!["lon".to_owned(), "lat".to_owned()], ..PointColumns::default() };
/// let table = read_point_table_from(text.as_bytes(), PointFormat::Csv, "stations", &columns)?;
/// assert_eq!(table.points, [nalgebra::Point3::new(4.5, 52.0, 0.0)]);
/// assert_eq!((table.ids.unwrap().get(0), table.is_flat), (Some("P7"), true));
/// # Ok::<(), p2m_mixed::ReadError>(())
/// ```
///
/// # Errors
/// The errors are those of [`read_point_table`].
pub fn read_point_table_from(
    reader: impl BufRead,
    format: PointFormat,
    name: &str,
    columns: &PointColumns,
) -> Result<PointTable, ReadError> {
    let read::Rows { rows: points, ids, unit, is_flat } = read(reader, format, name, columns)?;
    Ok(PointTable { points, ids, unit, is_flat })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Reason;

    /// Returns an array of two rows with these fields, whose id has these bytes.
    fn array(fields: &str, ids: [&[u8]; 2], is_first: bool) -> Vec<u8> {
        let mut bytes = p2m_core::npy_header(fields, "(2,)", false);
        for (row, id) in (0u8..).zip(ids) {
            let point: Vec<u8> = (0u8..3).flat_map(|k| (f32::from(row) + f32::from(k)).to_le_bytes()).collect();
            bytes.extend(if is_first { [id, &point].concat() } else { [&point, id].concat() });
        }
        bytes
    }

    #[test]
    fn arrays_have_ids_of_integers_and_text() {
        let point = "('x', '<f4'), ('y', '<f4'), ('z', '<f4')";
        let ids = |descr: &str, ids: [&[u8]; 2]| {
            [true, false].map(|is_first| {
                let id = format!("('id', '{descr}')");
                let fields = if is_first { format!("[{id}, {point}]") } else { format!("[{point}, {id}]") };
                let file = array(&fields, ids, is_first);
                let table = read_point_table_from(&file[..], PointFormat::Npy, "a", &PointColumns::default()).unwrap();
                assert_eq!(table.points[1], Point3::new(1.0, 2.0, 3.0));
                table.ids.map(|ids| [0, 1].map(|i| ids.get(i).unwrap().to_owned()))
            })
        };
        let both = |a: &str, b: &str| [Some([a.to_owned(), b.to_owned()]), Some([a.to_owned(), b.to_owned()])];
        assert_eq!(ids("<i8", [&i64::MAX.to_le_bytes(), &(-7i64).to_le_bytes()]), both("9223372036854775807", "-7"));
        assert_eq!(ids(">u4", [&7u32.to_be_bytes(), &u32::MAX.to_be_bytes()]), both("7", "4294967295"));
        assert_eq!(ids("|S4", [b"P7\0\0", b"long"]), both("P7", "long"));
        let text = |text: &str| -> Vec<u8> { text.chars().flat_map(|c| u32::from(c).to_le_bytes()).collect() };
        assert_eq!(ids("<U2", [&text("\u{e9}\0"), &text("ab")]), both("\u{e9}", "ab"));
        assert_eq!(ids("<f4", [&[0; 4], &[0; 4]]), [None, None]);
    }

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
