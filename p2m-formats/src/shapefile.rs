//! Shapefiles: points, lines, polygons and patches. The source of a primitive is the number of its record, which joins
//! it with the table of attributes.

use crate::features::{Map, surrounds};
use crate::sink::{fan, strip};
use crate::{File, wkt};
use p2m_mixed::{FileLocation, ReadError, Reason, Scene};
use shapefile::record::traits::HasXY;
use shapefile::{Patch, PointZ, PolygonRing, ReadableShape, Shape};
use std::io::Cursor;

/// The length of the header, of which only the first four bytes are used.
const HEADER_BYTES: usize = 100;
/// The magic number in the first four bytes of a file.
const FILE_CODE: u32 = 9994;
/// The most corners of a hole that are tested to find its outer ring.
const MAX_TESTED_CORNERS: usize = 8;

pub(crate) fn read(file: &File<'_>) -> Result<Scene, ReadError> {
    if u32::from_be_bytes(file.array(0)?) != FILE_CODE {
        return Err(file.error_at(FileLocation::Byte(0), "the file does not start with the code of shapefiles"));
    }
    file.slice(0, HEADER_BYTES)?;
    let mut map = Map::new(file.bytes.len());
    let mut at = HEADER_BYTES;
    while at < file.bytes.len() {
        let len = 2 * u64::from(u32::from_be_bytes(file.array(at + 4)?));
        let number = map.source;
        let fail = |reason: &dyn std::fmt::Display| file.error(format!("record {number}, counted from 0: {reason}"));
        let left = (file.bytes.len() - at - 8) as u64;
        let content = usize::try_from(len).ok().filter(|len| *len as u64 <= left);
        let content = content.ok_or_else(|| fail(&format_args!("it has {len} bytes, but the file has {left} more")))?;
        let record = file.slice(at + 8, content)?;
        check_counts(record).map_err(|reason| fail(&reason))?;
        // Records are parsed one by one, because the crate loses its position after a record that is longer than its
        // shape.
        let size = i32::try_from(content).map_err(|_| fail(&"it has more than 2 GiB"))?;
        let shape = Shape::read_from(&mut Cursor::new(record), size).map_err(|error| fail(&text(&error)))?;
        match shape {
            Shape::NullShape => {}
            Shape::PointZ(_)
            | Shape::PolylineZ(_)
            | Shape::PolygonZ(_)
            | Shape::MultipointZ(_)
            | Shape::Multipatch(_) => map.note_dimension(false),
            _ => map.note_dimension(true),
        }
        add(&mut map, shape).map_err(|reason| fail(&reason))?;
        map.source += 1;
        at += 8 + content;
    }
    let projection = file.path.and_then(|path| std::fs::read_to_string(path.with_extension("prj")).ok());
    map.sink.builder.unit = projection.and_then(|text| wkt::unit(&text));
    Ok(map.finish())
}

/// Refuses a record that announces more parts and positions than its bytes can have, or parts out of order, because the
/// crate would reserve memory for them.
fn check_counts(record: &[u8]) -> Result<(), String> {
    let number = |at: usize| {
        record.get(at..at + 4).map_or(0, |bytes| u64::from(u32::from_le_bytes(bytes.try_into().expect("four"))))
    };
    let (parts, points) = match number(0) {
        3 | 5 | 13 | 15 | 23 | 25 | 31 => (number(36), number(40)),
        8 | 18 | 28 => (0, number(36)),
        _ => (0, 0),
    };
    if 4 * parts + 16 * points > record.len() as u64 {
        return Err(format!("{parts} parts and {points} positions are more than its {} bytes have", record.len()));
    }
    let mut before = 0;
    for part in 0..usize::try_from(parts).expect("fewer than bytes") {
        let start = number(44 + 4 * part);
        if start < before || start > points {
            return Err(format!("part {part} starts at position {start} of {points}, after one at {before}"));
        }
        before = start;
    }
    Ok(())
}

/// Returns the text of an error.
fn text(error: &shapefile::Error) -> String {
    match error {
        shapefile::Error::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            "unexpected end of file".to_owned()
        }
        _ => error.to_string(),
    }
}

fn add(map: &mut Map, shape: Shape) -> Result<(), Reason> {
    match shape {
        Shape::NullShape => {
            map.sink.builder.skipped.add(b"record without shape", 1);
            Ok(())
        }
        Shape::Point(point) => map.point(flat(&point)),
        Shape::PointM(point) => map.point(flat(&point)),
        Shape::PointZ(point) => map.point(raised(&point)),
        Shape::Multipoint(points) => points.points().iter().try_for_each(|point| map.point(flat(point))),
        Shape::MultipointM(points) => points.points().iter().try_for_each(|point| map.point(flat(point))),
        Shape::MultipointZ(points) => points.points().iter().try_for_each(|point| map.point(raised(point))),
        Shape::Polyline(line) => lines(map, line.parts(), flat),
        Shape::PolylineM(line) => lines(map, line.parts(), flat),
        Shape::PolylineZ(line) => lines(map, line.parts(), raised),
        Shape::Polygon(polygon) => polygons(map, polygon.rings(), flat),
        Shape::PolygonM(polygon) => polygons(map, polygon.rings(), flat),
        Shape::PolygonZ(polygon) => polygons(map, polygon.rings(), raised),
        Shape::Multipatch(patches) => patches.patches().iter().try_for_each(|patch| add_patch(map, patch)),
    }
}

fn flat(point: &impl HasXY) -> [f64; 3] {
    [point.x(), point.y(), 0.0]
}

fn raised(point: &PointZ) -> [f64; 3] {
    [point.x, point.y, point.z]
}

fn lines<P>(map: &mut Map, parts: &[Vec<P>], position: impl Fn(&P) -> [f64; 3]) -> Result<(), Reason> {
    parts.iter().try_for_each(|part| map.line(&part.iter().map(&position).collect::<Vec<_>>()))
}

/// Adds polygons. A hole may come anywhere among the rings, so it goes to the outer ring that surrounds most of its
/// corners, and to the smallest one of rings that surround equally many.
fn polygons<P>(map: &mut Map, rings: &[PolygonRing<P>], position: impl Fn(&P) -> [f64; 3]) -> Result<(), Reason> {
    let ring = |ring: &PolygonRing<P>| ring.points().iter().map(&position).collect::<Vec<_>>();
    let is_outer = |ring: &&PolygonRing<P>| matches!(ring, PolygonRing::Outer(_));
    let mut polygons: Vec<_> = rings.iter().filter(is_outer).map(|outer| vec![ring(outer)]).collect();
    let outer_count = polygons.len();
    for hole in rings.iter().filter(|ring| !is_outer(ring)).map(ring) {
        // One corner does not suffice, because it may touch the outer ring, and there may be an island in a lake. All
        // corners would take long in large files.
        let corners = || hole.iter().step_by(hole.len().div_ceil(MAX_TESTED_CORNERS).max(1));
        let corners_within = |outer: &[[f64; 3]]| corners().filter(|corner| surrounds(outer, **corner)).count();
        let candidates = polygons[..outer_count].iter_mut().map(|polygon| (corners_within(&polygon[0]), polygon));
        let nearest = candidates
            .filter(|(count, _)| *count > 0)
            .max_by(|(a, p), (b, q)| a.cmp(b).then_with(|| doubled_area(&q[0]).total_cmp(&doubled_area(&p[0]))));
        match nearest {
            Some((_, polygon)) => polygon.push(hole),
            // A ring in the wrong direction that no outer ring surrounds is a polygon.
            None => polygons.push(vec![hole]),
        }
    }
    polygons.iter().try_for_each(|polygon| map.polygon(polygon))
}

/// Returns twice the area of a ring.
fn doubled_area(ring: &[[f64; 3]]) -> f64 {
    let [x, y, _] = ring.first().copied().unwrap_or_default();
    ring.windows(2).map(|w| (w[0][0] - x) * (w[1][1] - y) - (w[1][0] - x) * (w[0][1] - y)).sum::<f64>().abs()
}

fn add_patch(map: &mut Map, patch: &Patch) -> Result<(), Reason> {
    let positions: Vec<_> = patch.points().iter().map(raised).collect();
    let vertices = map.vertices(&positions)?;
    let source = map.source;
    match patch {
        Patch::TriangleStrip(_) => strip(&vertices).try_for_each(|triangle| map.sink.push_from(triangle, source)),
        Patch::TriangleFan(_) => fan(&vertices).try_for_each(|triangle| map.sink.push_from(triangle, source)),
        Patch::InnerRing(_) => {
            map.sink.builder.skipped.add(b"hole of a patch", 1);
            Ok(())
        }
        Patch::OuterRing(_) | Patch::FirstRing(_) | Patch::Ring(_) => {
            map.sink.polygon(&vertices[..vertices.len().saturating_sub(1)], source)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shapefile::Point;

    /// Returns a square around a point, with its first corner on the right.
    fn square([x, y]: [f64; 2], half: f64) -> Vec<Point> {
        [[half, 0.0], [0.0, half], [-half, 0.0], [0.0, -half], [half, 0.0]]
            .map(|[a, b]| Point::new(x + a, y + b))
            .into()
    }

    /// Returns the area of the triangles of polygons, and the number of triangles.
    fn area(rings: &[PolygonRing<Point>]) -> (f64, usize) {
        let mut map = Map::new(0);
        polygons(&mut map, rings, flat).unwrap();
        let soup = map.sink.finish().soup;
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| soup.positions()[i as usize]);
            (b - a).cross(&(c - a)).norm() / 2.0
        };
        (soup.triangles().iter().map(of).sum(), soup.triangles().len())
    }

    #[test]
    fn holes_are_in_the_smallest_ring_around_them() {
        let (outer, inner) = (PolygonRing::Outer, PolygonRing::Inner);
        // The areas of the squares are twice the square of half their diagonal.
        let island = [outer(square([0.0; 2], 10.0)), inner(square([0.0; 2], 8.0)), outer(square([0.0; 2], 6.0))];
        assert_eq!(area(&island).0, 200.0 - 128.0 + 72.0);
        let pond = [&island[..], &[inner(square([0.0; 2], 4.0))]].concat();
        let reversed: Vec<_> = pond.iter().rev().cloned().collect();
        assert_eq!([area(&pond).0, area(&reversed).0], [200.0 - 128.0 + 72.0 - 32.0; 2]);
        // The first corner of the hole is one of the ring.
        let touching = [outer(square([0.0; 2], 4.0)), inner(square([3.0, 0.0], 1.0))];
        assert_eq!(area(&touching).0, 32.0 - 2.0);
        // A ring in the wrong direction is a polygon.
        assert_eq!(area(&[inner(square([0.0; 2], 1.0))]), (2.0, 2));
    }

    #[test]
    fn the_area_of_a_ring_does_not_depend_on_its_direction() {
        let mut ring = vec![[5.0, 5.0, 0.0], [7.0, 5.0, 0.0], [7.0, 8.0, 0.0], [5.0, 8.0, 0.0], [5.0, 5.0, 0.0]];
        assert_eq!(doubled_area(&ring), 12.0);
        ring.reverse();
        assert_eq!(doubled_area(&ring), 12.0);
    }
}
