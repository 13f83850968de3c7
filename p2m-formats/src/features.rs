//! Points, lines and polygons of maps, for GeoJSON and shapefiles.

use crate::sink::Sink;
use earcut::Earcut;
use p2m_core::Element;
use p2m_mixed::{MAX_CORNERS, Reason};

/// The largest relative difference between the area of a polygon and the area of its triangles. It is well above the
/// rounding of 2^15 additions.
const AREA_TOLERANCE: f64 = 1e-9;

/// Adds the features of a map to a sink. `source` is the number of the feature.
pub(crate) struct Map {
    pub(crate) sink: Sink,
    pub(crate) source: usize,
    cutter: Earcut<f64>,
    /// The number of polygons that are kept as outlines.
    outlines: u64,
    /// Whether there are positions of two coordinates, and whether there are positions of three.
    has_flat: bool,
    has_raised: bool,
}

impl Map {
    pub(crate) fn new(file_len: usize) -> Self {
        Self {
            sink: Sink::new(file_len),
            source: 0,
            cutter: Earcut::new(),
            outlines: 0,
            has_flat: false,
            has_raised: false,
        }
    }

    /// Notes whether a position has two coordinates, or three.
    pub(crate) fn note_dimension(&mut self, is_flat: bool) {
        self.has_flat |= is_flat;
        self.has_raised |= !is_flat;
    }

    pub(crate) fn point(&mut self, position: [f64; 3]) -> Result<(), Reason> {
        let vertex = self.sink.vertex(position)?;
        self.sink.push_from(Element::Point(vertex), self.source)
    }

    /// Adds the segments of a line. A line of one position is a point.
    pub(crate) fn line(&mut self, positions: &[[f64; 3]]) -> Result<(), Reason> {
        if let [position] = positions {
            return self.point(*position);
        }
        let vertices = self.vertices(positions)?;
        vertices.windows(2).try_for_each(|ends| self.sink.push_from(Element::Segment([ends[0], ends[1]]), self.source))
    }

    /// Adds a polygon in the plane of x and y as triangles, given by its outer ring and the rings of its holes. If the
    /// triangles do not add up to its area, because it crosses itself or has no area, its rings are added as segments.
    pub(crate) fn polygon(&mut self, rings: &[Vec<[f64; 3]>]) -> Result<(), Reason> {
        // The last position of a ring repeats the first one.
        let open = |ring: &Vec<[f64; 3]>| {
            let closes = ring.len() > 1 && ring.first() == ring.last();
            ring[..ring.len() - usize::from(closes)].to_vec()
        };
        let rings: Vec<_> = rings.iter().map(open).filter(|ring| !ring.is_empty()).collect();
        let corners = rings.concat();
        let count = corners.len();
        if count > MAX_CORNERS {
            return Err(Reason::ElementTooLarge { count: count as u64, limit: MAX_CORNERS as u64 });
        }
        let vertices = self.vertices(&corners)?;
        if let Some(at) = corners.iter().position(|corner| !corner.iter().all(|x| x.is_finite())) {
            return Err(Reason::NonFiniteVertex { index: vertices[at].into() });
        }
        let starts: Vec<usize> =
            rings.iter().scan(0, |start, ring| Some(std::mem::replace(start, *start + ring.len()))).collect();
        // Areas are computed relative to a corner, so that they keep their digits far from the origin.
        let origin = corners.first().copied().unwrap_or_default();
        let plane: Vec<[f64; 2]> = corners.iter().map(|c| [c[0] - origin[0], c[1] - origin[1]]).collect();
        let mut triangles: Vec<usize> = Vec::new();
        self.cutter.earcut(plane.iter().copied(), starts.get(1..).unwrap_or_default(), &mut triangles);
        let area = |indices: &[usize]| {
            let pairs = indices.iter().zip(indices.iter().cycle().skip(1));
            pairs.map(|(&i, &j)| plane[i][0] * plane[j][1] - plane[i][1] * plane[j][0]).sum::<f64>().abs()
        };
        let of_rings = rings.iter().zip(&starts).map(|(ring, start)| area(&Vec::from_iter(*start..start + ring.len())));
        let of_rings: Vec<f64> = of_rings.collect();
        let expected = of_rings.first().map_or(0.0, |outer| outer - of_rings[1..].iter().sum::<f64>());
        let (triangles, _) = triangles.as_chunks::<3>();
        let covered: f64 = triangles.iter().map(|triangle| area(triangle)).sum();
        if covered > 0.0 && (covered - expected).abs() <= AREA_TOLERANCE * covered {
            return triangles.iter().try_for_each(|corners| {
                self.sink.push_from(Element::Triangle(corners.map(|corner| vertices[corner])), self.source)
            });
        }
        self.outlines += u64::from(count > 2);
        for (ring, start) in rings.iter().zip(starts) {
            let of_ring = &vertices[start..start + ring.len()];
            for (&a, &b) in of_ring.iter().zip(of_ring.iter().cycle().skip(1)) {
                self.sink.push_from(Element::Segment([a, b]), self.source)?;
            }
        }
        Ok(())
    }

    pub(crate) fn vertices(&mut self, positions: &[[f64; 3]]) -> Result<Vec<u32>, Reason> {
        positions.iter().map(|position| self.sink.vertex(*position)).collect()
    }

    pub(crate) fn finish(mut self) -> p2m_mixed::Scene {
        let builder = &mut self.sink.builder;
        builder.is_flat = self.has_flat && !self.has_raised;
        builder.skipped.add_plural(self.outlines, "insides of polygons that cross themselves or have no area");
        self.sink.finish()
    }
}

/// Returns whether a ring surrounds a position in the plane of x and y.
pub(crate) fn surrounds(ring: &[[f64; 3]], [x, y, _]: [f64; 3]) -> bool {
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    let crosses = |(a, b): &(&[f64; 3], &[f64; 3])| {
        (a[1] > y) != (b[1] > y) && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0]
    };
    edges.filter(crosses).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, side: f64) -> Vec<[f64; 3]> {
        vec![[x, x, 1.0], [x + side, x, 1.0], [x + side, x + side, 1.0], [x, x + side, 1.0], [x, x, 1.0]]
    }

    fn counts(rings: &[Vec<[f64; 3]>]) -> (usize, usize, usize) {
        let mut map = Map::new(0);
        map.polygon(rings).unwrap();
        let scene = map.finish();
        (scene.soup.triangles().len(), scene.soup.segments().len(), scene.skipped.len())
    }

    #[test]
    fn polygons_have_holes_and_an_outline_if_they_have_no_inside() {
        assert_eq!(counts(&[square(0.0, 4.0)]), (2, 0, 0));
        assert_eq!(counts(&[square(0.0, 4.0), square(1.0, 2.0)]), (8, 0, 0));
        assert_eq!(counts(&[square(1e8, 4.0), square(1e8 + 1.0, 2.0)]), (8, 0, 0));
        let bow_tie = vec![[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        assert_eq!(counts(&[bow_tie]), (0, 4, 1));
        assert_eq!(counts(&[square(0.0, 0.0)]), (0, 4, 1));
        assert_eq!(counts(&[]), (0, 0, 0));
    }

    #[test]
    fn a_ring_surrounds_its_inside() {
        assert!(surrounds(&square(0.0, 4.0), [1.0, 3.0, 0.0]));
        assert!(!surrounds(&square(0.0, 4.0), [5.0, 3.0, 0.0]));
    }
}
