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
    let mut reader = Reader { map: Map::new(file.bytes.len()), has_two: false, has_three: false };
    // Older files name their coordinate system, which RFC 7946 does not have.
    let members = match &content {
        GeoJson::Geometry(geometry) => &geometry.foreign_members,
        GeoJson::Feature(feature) => &feature.foreign_members,
        GeoJson::FeatureCollection(collection) => &collection.foreign_members,
    };
    let system = members.as_ref().and_then(|members| members.get("crs"));
    let has_system = system.is_some_and(|system| !system.to_string().contains("CRS84"));
    let result = match content {
        GeoJson::Geometry(geometry) => reader.geometry(&geometry),
        GeoJson::Feature(feature) => reader.feature(&feature),
        GeoJson::FeatureCollection(collection) => {
            collection.features.iter().enumerate().try_for_each(|(number, feature)| {
                reader.map.source = number;
                reader.feature(feature)
            })
        }
    };
    result.map_err(|reason| file.error(format!("feature {}, counted from 0: {reason}", reader.map.source)))?;
    let builder = &mut reader.map.sink.builder;
    builder.unit = (!has_system).then_some(Unit::Degree);
    builder.is_flat = reader.has_two && !reader.has_three;
    Ok(reader.map.finish())
}

/// Returns an error of the parser with its place: the line, or else the number of the feature.
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

struct Reader {
    map: Map,
    /// Whether a position has two coordinates.
    has_two: bool,
    /// Whether a position has three coordinates.
    has_three: bool,
}

impl Reader {
    fn feature(&mut self, feature: &Feature) -> Result<(), Reason> {
        let property = |name: &str| feature.properties.as_ref()?.get(name)?.as_str().map(str::to_owned);
        let id = || {
            feature.id.as_ref().map(|id| match id {
                Id::String(text) => text.clone(),
                Id::Number(number) => number.to_string(),
            })
        };
        let name = ["name", "NAME", "Name"].into_iter().find_map(property).or_else(id).unwrap_or_default();
        self.map.sink.builder.start_object(name.as_bytes());
        match &feature.geometry {
            Some(geometry) => self.geometry(geometry),
            None => {
                self.map.sink.builder.skipped.add(b"feature without geometry", 1);
                Ok(())
            }
        }
    }

    fn geometry(&mut self, geometry: &Geometry) -> Result<(), Reason> {
        match &geometry.value {
            GeometryValue::Point { coordinates } => {
                let position = self.position(coordinates)?;
                self.map.point(position)
            }
            GeometryValue::MultiPoint { coordinates } => coordinates.iter().try_for_each(|position| {
                let position = self.position(position)?;
                self.map.point(position)
            }),
            GeometryValue::LineString { coordinates } => self.line(coordinates),
            GeometryValue::MultiLineString { coordinates } => coordinates.iter().try_for_each(|line| self.line(line)),
            GeometryValue::Polygon { coordinates } => self.polygon(coordinates),
            GeometryValue::MultiPolygon { coordinates } => {
                coordinates.iter().try_for_each(|polygon| self.polygon(polygon))
            }
            GeometryValue::GeometryCollection { geometries } => {
                geometries.iter().try_for_each(|geometry| self.geometry(geometry))
            }
        }
    }

    fn position(&mut self, position: &Position) -> Result<[f64; 3], Reason> {
        match *position.as_slice() {
            [x, y] => {
                self.has_two = true;
                Ok([x, y, 0.0])
            }
            [x, y, z, ..] => {
                self.has_three = true;
                Ok([x, y, z])
            }
            ref less => Err(Reason::TooFewCoordinates { found: less.len() }),
        }
    }

    fn line(&mut self, line: &[Position]) -> Result<(), Reason> {
        let line = line.iter().map(|position| self.position(position)).collect::<Result<Vec<_>, _>>()?;
        self.map.line(&line)
    }

    fn polygon(&mut self, rings: &[Vec<Position>]) -> Result<(), Reason> {
        let ring = |ring: &Vec<Position>| ring.iter().map(|position| self.position(position)).collect();
        let rings = rings.iter().map(ring).collect::<Result<Vec<Vec<_>>, _>>()?;
        self.map.polygon(&rings)
    }
}
