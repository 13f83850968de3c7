//! Files of answers have the documented bytes, and can be read as their queries.

use super::super::{AnswerColumn, AnswerEncoder, AnswerFormat, AnswerRecord, Table};
use nalgebra::Point3;
use p2m_core::{BruteForce, Closest, ClosestPoint, Element, Feature, Soup};
use p2m_mixed::{Format, read_points_from, read_scene_from};
use std::io::ErrorKind;

/// Returns queries with answers of every feature, and queries without an answer.
fn answers() -> Vec<(Point3<f64>, Option<Closest<f64>>)> {
    let at = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    let positions = vec![at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(50.0, 0.0, 0.1)];
    let elements = [Element::Point(3), Element::Triangle([0, 1, 2]), Element::Segment([2, 3])];
    let soup = Soup::new(positions, elements).unwrap();
    let index = BruteForce::new(&soup).unwrap();
    let queries = [
        at(0.25, 0.1, 1.0 / 3.0),
        at(-1.0, -1.0, 0.0),
        at(0.5, -1e-9, -0.0),
        at(1e300, 0.0, 5e-324),
        at(25.0, 3.0, 0.0),
        at(-1.0, 0.5, 0.0),
    ];
    let mut answers: Vec<_> = queries.iter().map(|q| (*q, index.closest_point(q))).collect();
    let features: Vec<_> = answers.iter().map(|(_, a)| a.unwrap().feature).collect();
    assert!(features.contains(&Feature::Face) && features.contains(&Feature::Edge(2)), "{features:?}");
    answers.insert(2, (at(7.0, 8.0, 9.0), None));
    answers.push((at(f64::MAX, -0.0, 0.1), None));
    answers
}

fn encoder(format: AnswerFormat) -> AnswerEncoder<'static> {
    AnswerEncoder::new(format, &[], AnswerColumn::defaults(format, false, false))
}

fn write(answers: &[(Point3<f64>, Option<Closest<f64>>)], format: AnswerFormat) -> Vec<u8> {
    let encoder = encoder(format);
    let mut table = Table::new(Vec::new(), encoder.header(), Some(answers.len() as u64)).unwrap();
    for (number, (query, answer)) in (0..).zip(answers) {
        let mut record = Vec::new();
        let answer = answer.as_ref();
        encoder.encode(&AnswerRecord { number, query, answer, signed_distance: f64::NAN }, &mut record);
        table.write(1, &record).unwrap();
    }
    table.finish().unwrap()
}

#[test]
fn every_format_asks_the_same_questions_again() {
    let answers = answers();
    for &format in AnswerFormat::ALL {
        for answers in [&answers[..], &[]] {
            let file = write(answers, format);
            let again = read_points_from(&file[..], format.name().parse().unwrap(), "a").unwrap();
            let bits = |p: &Point3<f64>| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()];
            assert!(again.iter().map(bits).eq(answers.iter().map(|(q, _)| bits(q))), "{format}");
        }
    }
}

#[test]
fn a_table_has_the_numbers_as_they_are() {
    let answers = answers();
    let table = String::from_utf8(write(&answers, AnswerFormat::Csv)).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("qx,qy,qz,x,y,z,distance,primitive,feature"));
    for ((query, answer), line) in answers.iter().zip(lines.by_ref()) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |i: usize| fields[i].parse::<f64>().unwrap().to_bits();
        assert_eq!([number(0), number(1), number(2)], [query.x, query.y, query.z].map(f64::to_bits));
        match answer {
            None => assert_eq!(fields[3..], [""; 6]),
            Some(a) => {
                let expected = [a.point.x, a.point.y, a.point.z, a.distance].map(f64::to_bits);
                assert_eq!([number(3), number(4), number(5), number(6)], expected);
                assert_eq!(fields[7..], [a.primitive.index().to_string(), a.feature.to_string()]);
            }
        }
    }
    assert_eq!(lines.next(), None);
}

/// Returns the kind and number of a feature as documented.
fn feature(answer: Option<&Closest<f64>>) -> (i16, i16) {
    match answer.map(|a| a.feature) {
        None => (-1, -1),
        Some(Feature::Vertex(i)) => (0, i.into()),
        Some(Feature::Edge(i)) => (1, i.into()),
        Some(Feature::Face) => (2, 0),
    }
}

fn f64_at(record: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(record[at..at + 8].try_into().unwrap())
}

fn i32_at(record: &[u8], at: usize) -> i32 {
    i32::from_le_bytes(record[at..at + 4].try_into().unwrap())
}

#[test]
fn an_array_has_the_documented_bytes() {
    let answers = answers();
    let file = write(&answers, AnswerFormat::Npy);
    assert_eq!(file[..8], *b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([file[8], file[9]]));
    assert!((10 + length).is_multiple_of(64));
    let header = std::str::from_utf8(&file[10..10 + length]).unwrap();
    assert!(header.ends_with('\n'));
    assert_eq!(
        header.trim_end(),
        "{'descr': [('query', '<f8', (3,)), ('point', '<f8', (3,)), ('distance', '<f8'), ('lower_bound', '<f8'), \
        ('barycentric', '<f8', (3,)), ('primitive', '<i4'), ('feature_kind', '<i2'), ('feature_number', '<i2')], \
        'fortran_order': False, 'shape': (8,), }"
    );
    let records: Vec<&[u8]> = file[10 + length..].chunks(96).collect();
    assert_eq!(records.len(), answers.len());
    for ((query, answer), record) in answers.iter().zip(records) {
        let a = answer.as_ref();
        let point = a.map_or([f64::NAN; 3], |a| a.point.coords.into());
        let weights = a.map_or([f64::NAN; 3], |a| a.barycentric);
        let numbers = [query.x, query.y, query.z]
            .into_iter()
            .chain(point)
            .chain([a.map_or(f64::NAN, |a| a.distance), a.map_or(f64::NAN, |a| a.lower_bound)])
            .chain(weights);
        let found: Vec<u64> = (0..11).map(|i| f64_at(record, 8 * i)).collect();
        assert_eq!(found, numbers.map(f64::to_bits).collect::<Vec<_>>());
        assert_eq!(i32_at(record, 88), a.map_or(-1, |a| a.primitive.index() as i32));
        let number = |at: usize| i16::from_le_bytes([record[at], record[at + 1]]);
        assert_eq!((number(92), number(94)), feature(a));
    }
}

#[test]
fn a_cloud_has_the_documented_properties() {
    let answers = answers();
    let file = write(&answers, AnswerFormat::Ply);
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty double x\nproperty double y\n\
        property double z\nproperty double cx\nproperty double cy\nproperty double cz\nproperty double distance\n\
        property int primitive\nproperty int feature_kind\nproperty int feature_number\nend_header\n";
    assert!(file.starts_with(header.as_bytes()));
    for ((query, answer), vertex) in answers.iter().zip(file[header.len()..].chunks(68)) {
        let a = answer.as_ref();
        let point = a.map_or([f64::NAN; 3], |a| a.point.coords.into());
        let numbers = [query.x, query.y, query.z].into_iter().chain(point).chain([a.map_or(f64::NAN, |a| a.distance)]);
        let found: Vec<u64> = (0..7).map(|i| f64_at(vertex, 8 * i)).collect();
        assert_eq!(found, numbers.map(f64::to_bits).collect::<Vec<_>>());
        assert_eq!(i32_at(vertex, 56), a.map_or(-1, |a| a.primitive.index() as i32));
        assert_eq!([60, 64].map(|at| i32_at(vertex, at)), [feature(a).0, feature(a).1].map(i32::from));
    }
    // The vertices of the file are the queries.
    let scene = read_scene_from(&file[..], Format::Ply, "a").unwrap();
    assert_eq!(scene.soup.points().len(), answers.len());
}

#[test]
fn the_count_has_to_be_right() {
    for &format in AnswerFormat::ALL {
        let table = |count| Table::new(Vec::new(), encoder(format).header(), Some(count)).unwrap();
        let mut one = table(2);
        one.write(1, b"").unwrap();
        let error = one.finish().unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        assert_eq!(error.to_string(), "there are 1 answers, not the 2 announced");
        let mut two = table(1);
        two.write(1, b"").unwrap();
        let error = two.write(1, b"").unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        assert_eq!(error.to_string(), "there are more answers than the 1 announced");
    }
}

#[test]
fn numpy_reads_the_array() {
    let folder = std::env::temp_dir().join(format!("p2m-answers-{}", std::process::id()));
    let python = |script: &str| std::process::Command::new("python3").arg("-c").arg(script).output();
    if !python("import numpy").is_ok_and(|o| o.status.success()) {
        p2m_testkit::skip("there is no numpy");
        return;
    }
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("a.npy");
    std::fs::write(&path, write(&answers(), AnswerFormat::Npy)).unwrap();
    // Python reads numbers as Rust writes them. A distance without an answer is 0 here.
    let queries: Vec<[f64; 3]> = answers().iter().map(|(q, _)| q.coords.into()).collect();
    let distances: Vec<f64> = answers().iter().map(|(_, a)| a.map_or(0.0, |a| a.distance)).collect();
    let script = format!(
        "import numpy\na = numpy.load({path:?})\n\
        assert a.dtype == numpy.dtype([('query', '<f8', (3,)), ('point', '<f8', (3,)), ('distance', '<f8'), \
        ('lower_bound', '<f8'), ('barycentric', '<f8', (3,)), ('primitive', '<i4'), ('feature_kind', '<i2'), \
        ('feature_number', '<i2')]) and a.dtype.itemsize == 96 and a.shape == (8,), a.dtype\n\
        assert list(a['primitive'] == -1) == [False, False, True, False, False, False, False, True]\n\
        assert (numpy.isnan(a['distance']) == (a['primitive'] == -1)).all()\n\
        assert a['query'].tolist() == {queries:?}\n\
        assert numpy.nan_to_num(a['distance']).tolist() == {distances:?}"
    );
    let output = python(&script).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
