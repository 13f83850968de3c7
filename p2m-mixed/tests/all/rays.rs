//! Files of rays.

use nalgebra::{Point3, Vector3};
use p2m_core::{Ray, RayError};
use p2m_mixed::{FileLocation, PointFormat, ReadError, Reason, read_rays_from};

fn read(file: impl AsRef<[u8]>, format: PointFormat) -> Result<Vec<Ray>, ReadError> {
    read_rays_from(file.as_ref(), format, "r")
}

fn ray(o: [f64; 3], d: [f64; 3]) -> Ray {
    Ray::new(&Point3::from(o), &Vector3::from(d)).unwrap()
}

fn two() -> [Ray; 2] {
    [ray([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]), ray([-1.0, 0.5, 0.0], [0.0, 0.0, -1e300])]
}

/// Returns the bytes of an array of NumPy.
fn npy(descr: &str, order: &str, shape: &str, numbers: &[f64]) -> Vec<u8> {
    let description = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}}}\n");
    let data: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    crate::common::npy(&description, &data)
}

#[test]
fn tables_have_six_columns() {
    assert_eq!(read("# so\n1 2 3 4 5 6 more\n-1 .5 0 0 0 -1e300\n", PointFormat::Xyz).unwrap(), two());
    for header in ["", "x,y,z,dx,dy,dz\n", "OX,oy,oz,dx,dy,dz\n", "x [m],y [m],z [m],nx,ny,nz\n", "# made\n"] {
        let table = format!("{header}1,2,3,4,5,6\n\n-1,.5,0,0,0,-1e300\n");
        assert_eq!(read(table, PointFormat::Csv).unwrap(), two(), "{header}");
    }
    let exported = "id;Normals:0;Normals:1;Normals:2;Points:0;Points:1;Points:2\n7;4;5;6;1;2;3\n";
    assert_eq!(read(exported, PointFormat::Csv).unwrap(), two()[..1]);
    // The vertex is the origin rather than the hit.
    let answers = "ray,ox,oy,oz,dx,dy,dz,parameter,x,y,z\n0,1,2,3,4,5,6,9,9,9,9\n";
    assert_eq!(read(answers, PointFormat::Csv).unwrap(), two()[..1]);
}

#[test]
fn arrays_have_six_columns_or_fields() {
    let rows = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [-1.0, 0.5, 0.0, 0.0, 0.0, -1e300]];
    let columns: Vec<f64> = (0..6).flat_map(|k| rows.map(|row| row[k])).collect();
    let rows = rows.as_flattened();
    for file in [
        npy("'<f8'", "False", "(2, 6)", rows),
        npy("'<f8'", "True", "(2, 6)", &columns),
        npy("[('origin', '<f8', (3,)), ('direction', '<f8', (3,))]", "False", "(2,)", rows),
        npy(
            &format!("[{}]", ["x", "y", "z", "dx", "dy", "dz"].map(|n| format!("('{n}', '<f8')")).join(", ")),
            "False",
            "(2,)",
            rows,
        ),
    ] {
        assert_eq!(read(file, PointFormat::Npy).unwrap(), two());
    }
    let turned = [4.0, 5.0, 6.0, 1.0, 2.0, 3.0];
    let file = npy("[('direction', '<f8', (3,)), ('origin', '<f8', 3)]", "False", "(1,)", &turned);
    assert_eq!(read(file, PointFormat::Npy).unwrap(), two()[..1]);
    for (file, message) in [
        (npy("'<f8'", "False", "(4, 3)", rows), "bad header: the array has the shape (4, 3), expected (n, 6)"),
        (
            npy("[('origin', '<f8', (3,))]", "False", "(4,)", rows),
            "no coordinates among the fields origin; expected origin and direction of shape (3,), or x, y, z, dx, dy, dz",
        ),
    ] {
        let error = read(file, PointFormat::Npy).unwrap_err().to_string();
        assert!(error.ends_with(message), "{error}");
    }
}

#[test]
fn vertices_go_along_their_normals() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float nx\nproperty float ny\nproperty float nz\n\
        property float x\nproperty float y\nproperty float z\nend_header\n4 5 6 1 2 3\n0 0 -1e300 -1 .5 0\n";
    assert_eq!(read(ply, PointFormat::Ply).unwrap(), two());
    let error = read(ply.replace("float ny", "float n_y"), PointFormat::Ply).unwrap_err().to_string();
    assert_eq!(error, "r: bad header: element 'vertex' has no property 'ny'");
}

#[test]
fn invalid_rays_have_errors_with_their_location() {
    for (format, file, location, message) in [
        (PointFormat::Csv, "1,2,3,4,5,6\n1,2,3,0,-0,0\n", FileLocation::Line(2), "the direction of the ray is zero"),
        (
            PointFormat::Csv,
            "1,2,3,4,5,6\n1,2,3,0,0,inf\n",
            FileLocation::Line(2),
            "a coordinate of the ray is not finite",
        ),
        (PointFormat::Csv, "x,y,z,dx,dy,dz\n1,2,3,4,5\n", FileLocation::Line(2), "a ray needs 6 coordinates, found 5"),
        (PointFormat::Csv, "x,y,z\n1,2,3\n", FileLocation::Line(1), "a ray needs 6 coordinates, found 3"),
        (PointFormat::Xyz, "\n1 2 3 0 0 0\n", FileLocation::Line(2), "the direction of the ray is zero"),
        (PointFormat::Xyz, "1 2 3 4\n", FileLocation::Line(1), "a ray needs 6 coordinates, found 4"),
    ] {
        let error = read(file, format).unwrap_err();
        assert_eq!((error.location, error.reason.to_string()), (location, message.to_owned()));
    }
    for order in ["False", "True"] {
        let mut numbers = [1.0; 18];
        let places = if order == "True" { [10, 13, 16] } else { [9, 10, 11] };
        places.into_iter().for_each(|location| numbers[location] = 0.0);
        let error = read(npy("'<f8'", order, "(3, 6)", &numbers), PointFormat::Npy).unwrap_err();
        assert!(matches!(error.reason, Reason::Ray(RayError::ZeroDirection)));
        assert_eq!(error.to_string(), "r in row 1, counted from 0: the direction of the ray is zero");
    }
}
