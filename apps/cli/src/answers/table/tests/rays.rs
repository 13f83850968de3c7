//! Files of hits have the documented bytes, and can be read as their rays.

use super::super::{AnswerFormat, HitEncoder, NumberEncoder, Table};
use nalgebra::{Point3, Vector3};
use p2m_core::{BruteForce, Element, Hit, Ray, RayQuery, Side, Soup};
use p2m_mixed::read_rays_from;
use std::io::ErrorKind;

fn ray(o: [f64; 3], d: [f64; 3]) -> Ray {
    Ray::new(&Point3::from(o), &Vector3::from(d)).unwrap()
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
    let encoder = HitEncoder::new(format, &[]);
    let mut table = Table::new(Vec::new(), encoder.header(), count)?;
    for (number, (ray, hits)) in (0..).zip(&answers()) {
        let all: Vec<_> = if is_all { hits.iter().map(Some).collect() } else { vec![hits.first()] };
        for hit in all {
            let mut record = Vec::new();
            encoder.encode(number, ray, hit, &mut record);
            table.write(1, &record)?;
        }
    }
    table.finish()
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
    for &format in AnswerFormat::ALL {
        let again = |file: Vec<u8>| bits(&read_rays_from(&file[..], format.name().parse().unwrap(), "r").unwrap());
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
        let (encoder, mut records) = (NumberEncoder::new(format, "count"), Vec::new());
        for (number, ray) in (0..).zip(&rays) {
            encoder.encode(number, ray, 1 << (10 * number), &mut records);
        }
        let mut numbers = Table::new(Vec::new(), encoder.header(), Some(4)).unwrap();
        numbers.write(4, &records).unwrap();
        assert_eq!(again(numbers.finish().unwrap()), bits(&rays), "{format}");
        let none = Table::new(Vec::new(), HitEncoder::new(format, &[]).header(), None).unwrap().finish().unwrap();
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
