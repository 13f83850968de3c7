//! Readers of rays.

use super::read::read;
use super::row::Row;
use crate::open::open;
use crate::{PointColumns, PointFormat, ReadError, Reason};
use nalgebra::{Point3, Vector3};
use p2m_core::Ray;
use std::io::BufRead;
use std::path::Path;

impl Row<6> for Ray {
    const COLUMNS: &[[&'static str; 6]] = &[
        ["ox", "oy", "oz", "dx", "dy", "dz"],
        ["x", "y", "z", "dx", "dy", "dz"],
        ["x", "y", "z", "nx", "ny", "nz"],
        ["points:0", "points:1", "points:2", "normals:0", "normals:1", "normals:2"],
    ];
    const EXPECTED_COLUMNS: &'static str =
        "ox, oy, oz, dx, dy, dz or x, y, z, dx, dy, dz or x, y, z, nx, ny, nz or Points:0 to Normals:2";
    const TRIPLES: &[&'static str] = &["origin", "direction"];
    const FIELDS: [&'static str; 6] = ["x", "y", "z", "dx", "dy", "dz"];
    const EXPECTED_FIELDS: &'static str = "origin and direction of shape (3,), or x, y, z, dx, dy, dz";
    const SHAPE: &'static str = "(n, 6)";
    const PROPERTIES: [&'static str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

    fn too_few(found: usize) -> Reason {
        Reason::IncompleteRay { found }
    }

    fn new([x, y, z, dx, dy, dz]: [f64; 6]) -> Result<Self, Reason> {
        Self::new(&Point3::new(x, y, z), &Vector3::new(dx, dy, dz)).map_err(Reason::Ray)
    }
}

/// Reads rays from a file. Its extension, in any case, selects the format.
///
/// The formats are those of [`read_points`](crate::read_points) with six numbers for each ray: the origin, and then the
/// direction, which may have any length but zero.
///
/// - The columns of a CSV file are named `ox`, `oy`, `oz`, `dx`, `dy`, `dz`, or else `x`, `y`, `z`, `dx`, `dy`, `dz`,
///   or else `x`, `y`, `z`, `nx`, `ny`, `nz`, or else `Points:0` to `Points:2` and `Normals:0` to `Normals:2`.
/// - An array has the shape `(n, 6)`, or the fields `origin` and `direction` of shape `(3,)`, or else the fields `x`,
///   `y`, `z`, `dx`, `dy`, `dz`.
/// - The vertices of a PLY file are the origins, and their normals `nx`, `ny`, `nz` are the directions.
///
/// A file of answers that the program `p2m` wrote can be read as its rays, in each of its formats.
///
/// # Errors
/// The errors are those of [`read_points`](crate::read_points), and [`Reason::Ray`] for a direction that is zero.
pub fn read_rays(path: &Path) -> Result<Vec<Ray>, ReadError> {
    let format = PointFormat::from_path(path)?;
    let name = path.display().to_string();
    read_rays_from(open(path, &name)?, format, &name)
}

/// Reads rays from any reader, such as the standard input. `name` is the name of the file in messages.
///
/// ```
/// use p2m_mixed::{PointFormat, read_rays_from};
///
/// let rays = read_rays_from("x,y,z,dx,dy,dz\n1,2,3,0,0,-1\n".as_bytes(), PointFormat::Csv, "standard input")?;
/// assert_eq!(rays[0].at(3.0), nalgebra::Point3::new(1.0, 2.0, 0.0));
/// # Ok::<(), p2m_mixed::ReadError>(())
/// ```
///
/// # Errors
/// The errors are those of [`read_rays`].
pub fn read_rays_from(reader: impl BufRead, format: PointFormat, name: &str) -> Result<Vec<Ray>, ReadError> {
    Ok(read(reader, format, name, &PointColumns::default())?.rows)
}
