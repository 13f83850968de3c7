//! GeoJSON: points, lines and polygons of features.

use crate::File;
use crate::features::Map;
use geojson::feature::Id;
use geojson::{Feature, FeatureReader, GeoJson, Geometry, GeometryValue, Position};
use p2m_mixed::{FileLocation, ReadError, Reason, Scene, Unit};

pub(crate) fn read(file: &File<'_>) -> Result<Scene, ReadError> {
    let text = std::str::from_utf8(file.bytes)
        .map_err(|error| file.error_at(FileLocation::Byte(error.valid_up_to() as u64), "the text is not UTF-8"))?;
    let content: GeoJson = text.trim_start_matches('\u{feff}').parse().map_err(|error| located(file, &error))?;
    let mut map = Map::new(file.bytes.len());
    // Older files name their coordinate system, which RFC 7946 does not have.
    let members = match &content {
        GeoJson::Geometry(geometry) => &geometry.foreign_members,
        GeoJson::Feature(feature) => &feature.foreign_members,
        GeoJson::FeatureCollection(collection) => &collection.foreign_members,
    };
    let system = members.as_ref().and_then(|members| members.get("crs"));
    let has_system = system.is_some_and(|system| !system.to_string().contains("CRS84"));
    let result = match content {
        GeoJson::Geometry(geometry) => map.geometry(&geometry),
        GeoJson::Feature(feature) => map.feature(&feature),
        GeoJson::FeatureCollection(collection) => {
            collection.features.iter().enumerate().try_for_each(|(number, feature)| {
                map.source = number;
                map.feature(feature)
            })
        }
    };
    result.map_err(|reason| file.error(format!("feature {}, counted from 0: {reason}", map.source)))?;
    map.sink.builder.unit = (!has_system).then_some(Unit::Degree);
    Ok(map.finish())
}

/// Returns an error of the parser with its location: the line, or else the number of the feature.
fn located(file: &File<'_>, error: &geojson::Error) -> ReadError {
    let text = match error {
        geojson::Error::MalformedGeoJson(json) if json.line() > 0 => {
            return file.error_at(FileLocation::Line(json.line() as u64), json);
        }
        geojson::Error::MalformedGeoJson(json) => json.to_string(),
        _ => error.to_string(),
    };
    let mut features = FeatureReader::from_reader(file.bytes).features();
    match features.position(|feature| feature.is_err()) {
        Some(number) => file.error(format!("feature {number}, counted from 0: {text}")),
        None => file.error(format!("top level: {text}")),
    }
}

impl Map {
    fn feature(&mut self, feature: &Feature) -> Result<(), Reason> {
        let property = |name: &str| feature.properties.as_ref()?.get(name)?.as_str().map(str::to_owned);
        let id = || {
            feature.id.as_ref().map(|id| match id {
                Id::String(text) => text.clone(),
                Id::Number(number) => number.to_string(),
            })
        };
        let name = ["name", "NAME", "Name"].into_iter().find_map(property).or_else(id).unwrap_or_default();
        self.sink.builder.start_object(name.as_bytes());
        match &feature.geometry {
            Some(geometry) => self.geometry(geometry),
            None => {
                self.sink.builder.skipped.add(b"feature without geometry", 1);
                Ok(())
            }
        }
    }

    fn geometry(&mut self, geometry: &Geometry) -> Result<(), Reason> {
        match &geometry.value {
            GeometryValue::Point { coordinates } => self.points(std::slice::from_ref(coordinates)),
            GeometryValue::MultiPoint { coordinates } => self.points(coordinates),
            GeometryValue::LineString { coordinates } => self.segments(coordinates),
            GeometryValue::MultiLineString { coordinates } => {
                coordinates.iter().try_for_each(|line| self.segments(line))
            }
            GeometryValue::Polygon { coordinates } => self.triangles(coordinates),
            GeometryValue::MultiPolygon { coordinates } => {
                coordinates.iter().try_for_each(|polygon| self.triangles(polygon))
            }
            GeometryValue::GeometryCollection { geometries } => {
                geometries.iter().try_for_each(|geometry| self.geometry(geometry))
            }
        }
    }

    fn position(&mut self, position: &Position) -> Result<[f64; 3], Reason> {
        let (position, is_flat) = match *position.as_slice() {
            [x, y] => ([x, y, 0.0], true),
            [x, y, z, ..] => ([x, y, z], false),
            ref less => return Err(Reason::TooFewCoordinates { found: less.len() }),
        };
        self.note_dimension(is_flat);
        Ok(position)
    }

    fn positions(&mut self, positions: &[Position]) -> Result<Vec<[f64; 3]>, Reason> {
        positions.iter().map(|position| self.position(position)).collect()
    }

    fn points(&mut self, points: &[Position]) -> Result<(), Reason> {
        self.positions(points)?.into_iter().try_for_each(|point| self.point(point))
    }

    fn segments(&mut self, line: &[Position]) -> Result<(), Reason> {
        let line = self.positions(line)?;
        self.line(&line)
    }

    fn triangles(&mut self, rings: &[Vec<Position>]) -> Result<(), Reason> {
        let rings = rings.iter().map(|ring| self.positions(ring)).collect::<Result<Vec<_>, _>>()?;
        self.polygon(&rings)
    }
}
