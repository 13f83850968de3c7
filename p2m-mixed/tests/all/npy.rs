//! Points from arrays of NumPy, and arrays that are errors.

use nalgebra::Point3;
use p2m_mixed::{HeaderProblem, PointFormat, ReadError, Reason, read_points_from};

fn read(file: &[u8]) -> Result<Vec<[f64; 3]>, ReadError> {
    let points = read_points_from(file, PointFormat::Npy, "q.npy")?;
    Ok(points.into_iter().map(|p: Point3<f64>| p.coords.into()).collect())
}

fn npy(version: u8, description: &str, data: &[u8]) -> Vec<u8> {
    let mut file = vec![0x93, b'N', b'U', b'M', b'P', b'Y', version, 0];
    let length = description.len() + 1;
    match version {
        1 => file.extend((length as u16).to_le_bytes()),
        _ => file.extend((length as u32).to_le_bytes()),
    }
    file.extend(description.bytes());
    file.push(b'\n');
    file.extend(data);
    file
}

fn described(descr: &str, fortran: &str, shape: &str) -> String {
    format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}")
}

const POINTS: [[f64; 3]; 2] = [[1.0, 2.0, 3.0], [4.0, 5.0, 100.0]];

#[test]
fn every_type_order_and_version() {
    macro_rules! each {
        ($($descr:literal $type:ident $bytes:ident),*) => {
            $(for version in 1..=3 {
                let c: Vec<u8> = POINTS.as_flattened().iter().flat_map(|&x| (x as $type).$bytes()).collect();
                let file = npy(version, &described(concat!("'", $descr, "'"), "False", "(2, 3)"), &c);
                assert_eq!(read(&file).unwrap(), POINTS, $descr);
                let columns = (0..3).flat_map(|k| POINTS.map(|p| p[k]));
                let f: Vec<u8> = columns.flat_map(|x| (x as $type).$bytes()).collect();
                let file = npy(version, &described(concat!("'", $descr, "'"), "True", "(2, 3)"), &f);
                assert_eq!(read(&file).unwrap(), POINTS, $descr);
            })*
        };
    }
    each!("<f8" f64 to_le_bytes, ">f8" f64 to_be_bytes, "<f4" f32 to_le_bytes, ">f4" f32 to_be_bytes,
        "|i1" i8 to_le_bytes, "|u1" u8 to_le_bytes, "<i2" i16 to_le_bytes, ">i2" i16 to_be_bytes,
        "<u2" u16 to_le_bytes, ">u2" u16 to_be_bytes, "<i4" i32 to_le_bytes, ">i4" i32 to_be_bytes,
        "<u4" u32 to_le_bytes, ">u4" u32 to_be_bytes, "<i8" i64 to_le_bytes, ">i8" i64 to_be_bytes,
        "<u8" u64 to_le_bytes, ">u8" u64 to_be_bytes);
}

fn doubles(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

#[test]
fn descriptions_in_other_hands() {
    let data = doubles(POINTS.as_flattened());
    for description in [
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }                 ",
        "{'shape': (2, 3), 'fortran_order': False, 'descr': '<f8'}",
        "{'descr': ('<f8'), 'fortran_order': (False), 'shape': ((2), 3)}",
        "{\"descr\":\"<f8\",\"fortran_order\":False,\"shape\":(2,3)}",
        " {  'descr' : '<f8' ,\n'fortran_order' : False, 'shape' : ( 2L , 3L , ) , 'more': [(1, 'it\\'s')] } ",
    ] {
        assert_eq!(read(&npy(1, description, &data)).unwrap(), POINTS, "{description}");
    }
    assert_eq!(read(&npy(1, &described("'<f8'", "False", "(0, 3)"), &[])).unwrap(), [] as [[f64; 3]; 0]);
    // Negative zero and the smallest number keep their bits; integers of 64 bits are rounded.
    let numbers = [-0.0, 5e-324, -f64::MAX];
    let again = read(&npy(1, &described("'<f8'", "False", "(1, 3)"), &doubles(&numbers))).unwrap();
    assert_eq!(again[0].map(f64::to_bits), numbers.map(f64::to_bits));
    let large: Vec<u8> = [i64::MAX, i64::MIN, (1 << 53) + 1].iter().flat_map(|x| x.to_le_bytes()).collect();
    let again = read(&npy(1, &described("'<i8'", "False", "(1, 3)"), &large)).unwrap();
    assert_eq!(again, [[2.0f64.powi(63), -2.0f64.powi(63), 2.0f64.powi(53)]]);
}

#[test]
fn structured_arrays() {
    let fields = "[('a', '<U2'), (('title', 'query'), '>f4', (3,)), ('b', [('c', '|V3'), ('d', '<i2', (2, 2))], 2)]";
    let mut data = Vec::new();
    for point in POINTS {
        data.extend([b'a'; 8]);
        data.extend(point.iter().flat_map(|&x| (x as f32).to_be_bytes()));
        data.extend([0xff; 22]);
    }
    for fortran in ["True", "False"] {
        assert_eq!(read(&npy(1, &described(fields, fortran, "(2,)"), &data)).unwrap(), POINTS);
    }
    // Coordinates may be in any order, of any types and with gaps. Fields of these names with another shape are
    // ignored.
    let fields = "[('z', '<i2'), ('', '|V5'), ('x', '>f8'), ('y', '<u8'), ('X', '|S3')]";
    let mut data = Vec::new();
    for [x, y, z] in POINTS {
        data.extend((z as i16).to_le_bytes());
        data.extend([7; 5]);
        data.extend(x.to_be_bytes());
        data.extend((y as u64).to_le_bytes());
        data.extend(b"abc");
    }
    assert_eq!(read(&npy(1, &described(fields, "False", "(2,)"), &data)).unwrap(), POINTS);
    // Without a third column z is 0, in both orders.
    let flat = [[1.0, 2.0, 0.0], [4.0, 5.0, 0.0]];
    assert_eq!(read(&npy(1, &described("'<f8'", "False", "(2, 2)"), &doubles(&[1.0, 2.0, 4.0, 5.0]))).unwrap(), flat);
    assert_eq!(read(&npy(1, &described("'<f8'", "True", "(2, 2)"), &doubles(&[1.0, 4.0, 2.0, 5.0]))).unwrap(), flat);
    // The field `query` takes precedence over x, y, z.
    let fields = "[('x', '<f8'), ('y', '<f8'), ('z', '<f8'), ('query', '<f8', 3)]";
    let data = doubles(&[9.0, 9.0, 9.0, 1.0, 2.0, 3.0, 9.0, 9.0, 9.0, 4.0, 5.0, 100.0]);
    assert_eq!(read(&npy(1, &described(fields, "False", "(2,)"), &data)).unwrap(), POINTS);
}

#[test]
fn other_arrays_are_errors() {
    let message = |descr: &str, shape: &str| {
        read(&npy(1, &described(descr, "False", shape), &[0; 400]))
            .unwrap_err()
            .to_string()
            .split_once("bad header: ")
            .unwrap()
            .1
            .to_owned()
    };
    for shape in ["(3,)", "(2, 4)", "(2, 3, 1)", "()", "(3, 1)"] {
        assert_eq!(message("'<f8'", shape), format!("the array has the shape {shape}, expected (n, 3) or (n, 2)"));
    }
    assert_eq!(message("[('query', '<f8', (3,))]", "(2, 3)"), "the array has the shape (2, 3), expected (n,)");
    for descr in
        ["'|O'", "'|b1'", "'<f2'", "'<c16'", "'<U8'", "'|S8'", "'<M8[ns]'", "'=f8'", "'|f8'", "'f8'", "'<f16'", "''"]
    {
        assert_eq!(
            message(descr, "(2, 3)"),
            format!("items of type {descr} are no coordinates, expected integers or floats of 4 or 8 bytes")
        );
    }
    assert_eq!(
        message("[('a', '<f8'), ('query', '<f8', (2,)), ('x', '<f8', (1,))]", "(2,)"),
        "no coordinates among the fields a, query, x; expected query of shape (3,), or x, y, z"
    );
    assert_eq!(
        message("[('query', '|S8', (3,))]", "(2,)"),
        "items of type '|S8' are no coordinates, expected integers or floats of 4 or 8 bytes"
    );
    assert!(message("[('o', '|O8'), ('query', '<f8', (3,))]", "(2,)").starts_with("items of type ('o', '|O8') are no"));
    // A field of objects is an error, because the size of an object is not known and the data is a pickle.
    assert_eq!(
        message("[('o', '|O'), ('query', '<f8', (3,))]", "(2,)"),
        "items of type ('o', '|O') are no coordinates, expected integers or floats of 4 or 8 bytes"
    );
    for descr in [
        "[('a', '<f18446744073709551615', (2,))]",
        "[('a', '|V18446744073709551615'), ('b', '|V9')]",
        "[('a', 'V8')]",
        "[1]",
        "[(1, 2)]",
        "[('a',)]",
    ] {
        assert!(message(descr, "(2,)").starts_with("items of type "), "{descr}");
    }
    assert!(message("7", "(2, 3)").starts_with("items of type 7"));
    assert_eq!(message("'<f8'", "7"), "the description of the array is not understood near '7'");
}

#[test]
fn headers_that_make_no_sense() {
    let problem = |file: &[u8]| match read(file).unwrap_err().reason {
        Reason::BadHeader(problem) => problem,
        other => panic!("{other}"),
    };
    for file in [&b""[..], b"\x93NUMP", b"\x80\x04pickled", b"PK\x03\x04zipped", b"1 2 3\n4 5 6\n"] {
        assert_eq!(problem(file), HeaderProblem::NotNpy);
    }
    for description in [
        "",
        "x",
        "{",
        "{'descr': '<f8', 'fortran_order': maybe}",
        "{'a' 1}",
        "{'a': 1 'b': 2}",
        "(1 2)",
        "{'a': 'b}",
        "{}}",
        "{'a': -1}",
        "[1]",
    ] {
        assert!(matches!(problem(&npy(1, description, &[])), HeaderProblem::BadDescription { .. }), "{description}");
    }
    let nested = "(".repeat(100_000);
    assert_eq!(problem(&npy(2, &nested, &[])), HeaderProblem::LineTooLong);
    assert!(matches!(problem(&npy(2, &nested[..60_000], &[])), HeaderProblem::BadDescription { .. }));
    for key in ["descr", "fortran_order", "shape"] {
        let description = described("'<f8'", "False", "(1, 3)").replace(key, "other");
        assert_eq!(problem(&npy(1, &description, &[])), HeaderProblem::MissingKey { key });
    }
    let error = read(&npy(4, &described("'<f8'", "False", "(1, 3)"), &[0; 24])).unwrap_err();
    assert_eq!(error.to_string(), "q.npy at byte 6: unsupported format 'NPY 4.0'");
}

#[test]
fn every_byte_is_needed_and_none_more() {
    for fortran in ["False", "True"] {
        let mut file = npy(1, &described("'<f8'", fortran, "(2, 3)"), &doubles(POINTS.as_flattened()));
        for end in 6..file.len() {
            let error = read(&file[..end]).unwrap_err();
            assert!(matches!(error.reason, Reason::UnexpectedEnd), "{end}: {error}");
        }
        let end = file.len();
        file.extend(b"abc");
        assert_eq!(
            read(&file).unwrap_err().to_string(),
            format!("q.npy at byte {end}: 3 bytes follow the end of the array")
        );
    }
}

#[test]
fn numbers_need_not_be_finite() {
    for bad in [f64::NAN, f64::INFINITY] {
        let file = npy(1, &described("'<f8'", "False", "(2, 3)"), &doubles(&[1.0, 2.0, 3.0, 4.0, bad, 6.0]));
        let points = read(&file).unwrap();
        assert_eq!((points[0][0], points[1][1].to_bits()), (1.0, bad.to_bits()));
    }
}

#[test]
fn announced_points_are_not_believed() {
    for (descr, shape) in [
        ("'<f8'", "(1152921504606846976, 3)"), // 2^60
        ("'<f8'", "(18446744073709551615, 3)"),
        ("[('query', '<f8', (3,)), ('a', '|V9223372036854775807')]", "(9,)"),
        ("[('a', '|V1152921504606846976', (4,)), ('query', '<f8', (3,))]", "(9,)"),
    ] {
        for fortran in ["False", "True"] {
            let error = read(&npy(1, &described(descr, fortran, shape), &[0; 240])).unwrap_err();
            assert!(matches!(error.reason, Reason::UnexpectedEnd), "{error}");
        }
    }
}
