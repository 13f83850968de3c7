//! Files of rays and of their hits.

use nalgebra::{Point3, Vector3};
use p2m_core::{BruteForce, Element, Hit, Ray, RayError, RayQuery, Side, Soup};
use p2m_mixed::{AnswerFormat, FileLocation, HitWriter, NumberWriter, PointFormat, ReadError, Reason, read_rays_from};
use std::io::ErrorKind;

const FORMATS: [AnswerFormat; 3] = [AnswerFormat::Csv, AnswerFormat::Npy, AnswerFormat::Ply];

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
    for header in
        ["", "a,b,c,d,e,f\n", "x,y,z,dx,dy,dz\n", "OX,oy,oz,dx,dy,dz\n", "x [m],y [m],z [m],nx,ny,nz\n", "# made\n"]
    {
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
        (PointFormat::Csv, "1,2,3,4,5,6\n1,2,3,0,0,inf\n", FileLocation::Line(2), "coordinate 'inf' is not finite"),
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

/// Returns rays with hits from all sides, and one without a hit.
fn answers() -> Vec<(Ray, Vec<Hit>)> {
    let at = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    let positions = vec![at(0.0, 0.0, 0.0), at(4.0, 0.0, 0.0), at(0.0, 4.0, 0.0), at(1.0, 1.0, 2.0), at(3.0, 1.0, 2.0)];
    let elements = [Element::Point(3), Element::Triangle([0, 1, 2]), Element::Segment([3, 4])];
    let soup = Soup::new(positions, elements).unwrap();
    let index = BruteForce::new(&soup).unwrap();
    let rays = [
        ray([1.0, 1.0, 5.0], [0.0, 0.0, -1.0]),
        ray([1.0 / 3.0, 0.3, -1.0], [0.0, 0.0, 0.1]),
        ray([9.0, 9.0, 9.0], [0.0, 0.0, -1.0]),
        ray([1.5, 1.0, 3.0], [0.0, -0.0, -0.5]),
    ];
    let answers: Vec<_> = rays.into_iter().map(|ray| (ray, index.all_intersections(&ray))).collect();
    assert_eq!(answers.iter().map(|(_, hits)| hits.len()).collect::<Vec<_>>(), [3, 1, 0, 2]);
    let sides: Vec<Side> = answers.iter().flat_map(|(_, hits)| hits).map(|hit| hit.side).collect();
    assert!([Side::Front, Side::Back, Side::Along].iter().all(|side| sides.contains(side)));
    answers
}

/// Writes a record for the first hit of each ray, or for each hit.
fn write(format: AnswerFormat, is_all: bool, count: Option<u64>) -> std::io::Result<Vec<u8>> {
    let mut writer = HitWriter::new(Vec::new(), format, count)?;
    for (number, (ray, hits)) in (0..).zip(&answers()) {
        if is_all {
            hits.iter().try_for_each(|hit| writer.write(number, ray, Some(hit)))?;
        } else {
            writer.write(number, ray, hits.first())?;
        }
    }
    writer.finish()
}

fn bits(rays: &[Ray]) -> Vec<[u64; 6]> {
    let numbers = |r: &Ray| [r.origin().coords, r.direction()].map(<[f64; 3]>::from);
    rays.iter().map(|r| std::array::from_fn(|k| numbers(r).as_flattened()[k].to_bits())).collect()
}

#[test]
fn every_format_asks_the_same_questions_again() {
    let answers = answers();
    let rays: Vec<Ray> = answers.iter().map(|(ray, _)| *ray).collect();
    let each: Vec<Ray> = answers.iter().flat_map(|(ray, hits)| hits.iter().map(|_| *ray)).collect();
    for format in FORMATS {
        let again = |file: Vec<u8>| bits(&read(file, format.name().parse().unwrap()).unwrap());
        let first = write(format, false, Some(4)).unwrap();
        assert_eq!(again(first.clone()), bits(&rays), "{format}");
        // The number of records may be announced or counted.
        assert_eq!(write(format, false, None).unwrap(), first, "{format}");
        let all = write(format, true, None).unwrap();
        assert_eq!(write(format, true, Some(6)).unwrap(), all, "{format}");
        assert_eq!(again(all), bits(&each), "{format}");
        for wrong in [3, 5] {
            assert_eq!(write(format, false, Some(wrong)).unwrap_err().kind(), ErrorKind::InvalidInput, "{format}");
        }
        let mut numbers = NumberWriter::new(Vec::new(), format, "count", 4).unwrap();
        for (number, ray) in (0..).zip(&rays) {
            numbers.write(number, ray, 1 << (10 * number)).unwrap();
        }
        assert_eq!(again(numbers.finish().unwrap()), bits(&rays), "{format}");
        let none = HitWriter::new(Vec::new(), format, None).unwrap().finish().unwrap();
        assert!(again(none).is_empty(), "{format}");
    }
}

#[test]
fn a_table_has_the_numbers_as_they_are() {
    let table = String::from_utf8(write(AnswerFormat::Csv, false, Some(4)).unwrap()).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("ray,ox,oy,oz,dx,dy,dz,parameter,x,y,z,primitive,side,w0,w1,w2"));
    assert_eq!(lines.next(), Some("0,1.0,1.0,5.0,0.0,0.0,-1.0,3.0,1.0,1.0,2.0,0,along,1.0,0.0,0.0"));
    let fields: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(fields[11..13], ["1", "back"]);
    assert_eq!(lines.next(), Some("2,9.0,9.0,9.0,0.0,0.0,-1.0,,,,,,,,,"));
    assert_eq!(lines.next(), Some("3,1.5,1.0,3.0,0.0,-0.0,-0.5,2.0,1.5,1.0,2.0,2,along,0.75,0.25,0.0"));
    assert_eq!(lines.next(), None);
}

#[test]
fn records_are_laid_out_as_documented() {
    for (format, size, ray_number) in
        [(AnswerFormat::Npy, 120, 1u64.to_le_bytes()), (AnswerFormat::Ply, 120, 1f64.to_le_bytes())]
    {
        let file = write(format, false, Some(4)).unwrap();
        let records = &file[file.len() - 4 * size..];
        let answers = answers();
        let hit = answers[1].1[0];
        let record = &records[size..][..size];
        let number = |at: usize| f64::from_le_bytes(record[at..at + 8].try_into().unwrap());
        let whole = |record: &[u8], at: usize| i32::from_le_bytes(record[at..at + 4].try_into().unwrap());
        assert_eq!([0, 8, 16].map(number), [1.0 / 3.0, 0.3, -1.0]);
        assert_eq!([24, 32, 40].map(number), [0.0, 0.0, 0.1]);
        assert_eq!(record[48..56], ray_number);
        assert_eq!(number(56), hit.parameter);
        assert_eq!(Point3::from([64, 72, 80].map(number)), hit.point());
        assert_eq!([88, 96, 104].map(number), hit.barycentric());
        assert_eq!((whole(record, 112), whole(record, 116)), (1, 1));
        let none = &records[2 * size..][..size];
        assert!((56..112).step_by(8).all(|at| f64::from_le_bytes(none[at..at + 8].try_into().unwrap()).is_nan()));
        assert_eq!((whole(none, 112), whole(none, 116)), (-1, -1));
    }
    let header = |format| String::from_utf8_lossy(&write(format, false, Some(4)).unwrap()).into_owned();
    assert!(header(AnswerFormat::Npy).contains(
        "{'descr': [('origin', '<f8', (3,)), ('direction', '<f8', (3,)), ('ray', '<i8'), ('parameter', '<f8'), \
        ('point', '<f8', (3,)), ('barycentric', '<f8', (3,)), ('primitive', '<i4'), ('side', '<i4')], \
        'fortran_order': False, 'shape': (4,), }"
    ));
    assert!(header(AnswerFormat::Ply).contains("element vertex 4\nproperty double x\n"));
}
