//! Scenes as sections of the files of saved indexes.

use crate::builder::SceneBuilder;
use crate::{FileLocation, Object, ReadError, Reason, Scene, Skipped, WriteError};
use nalgebra::Point3;
use p2m_core::storage::{LoadError, Reader, SavedFile, Writer, require};
use p2m_core::{Element, Soup};
use std::io::{BufRead, Write};
use std::sync::Arc;

/// `(n, 3)` f64: the positions.
const POSITIONS: &str = "scene/positions";
/// `(n,)` u8: the number of vertices of each primitive. The section is empty if all primitives are triangles.
const KINDS: &str = "scene/kinds";
/// u32: the indices of the vertices of all primitives, one primitive after the other.
const INDICES: &str = "scene/indices";
/// `(n,)` u32: [`Scene::sources`].
const SOURCES: &str = "scene/sources";
/// u8: the names of objects and then of skipped records, as concatenated UTF-8.
const TEXTS: &str = "scene/texts";
/// `(n, 3)` u64: for each object the length of its name, its first id, and the id after its last one.
const OBJECTS: &str = "scene/objects";
/// `(n, 3)` u64: for each kind of skipped records the length of its name, the count, and whether the name is a plural.
const SKIPPED: &str = "scene/skipped";

pub(super) use write_p2m as write;

/// Adds the sections of a scene to a file.
///
/// # Panics
/// If the file has a scene.
pub fn save_scene(scene: &Scene, writer: &mut Writer<'_>) {
    let soup = &scene.soup;
    let positions: Vec<[f64; 3]> = soup.positions().iter().map(|p| p.coords.into()).collect();
    writer.put_copy(POSITIONS, positions.as_flattened());
    let only_triangles = soup.points().is_empty() && soup.segments().is_empty();
    if only_triangles {
        writer.put_copy::<u8>(KINDS, &[]);
        writer.put_copy(INDICES, soup.triangles().as_flattened());
    } else {
        let kinds: Vec<u8> = soup.elements().map(|e| [0, 1, 2, 3][e.indices().len()]).collect();
        let indices: Vec<u32> = soup.elements().flat_map(|e| e.indices().to_vec()).collect();
        writer.put_copy(KINDS, &kinds);
        writer.put_copy(INDICES, &indices);
    }
    writer.put_copy(SOURCES, &scene.sources);
    let texts = scene.objects.iter().map(|o| &o.name).chain(scene.skipped.iter().map(|s| &s.what));
    writer.put_copy(TEXTS, &texts.flat_map(|text| text.bytes()).collect::<Vec<u8>>());
    let objects = scene.objects.iter().map(|o| [o.name.len(), o.ids.start, o.ids.end].map(|n| n as u64));
    writer.put_copy(OBJECTS, objects.collect::<Vec<_>>().as_flattened());
    let skipped = scene.skipped.iter().map(|s| [s.what.len() as u64, s.count, u64::from(s.is_plural)]);
    writer.put_copy(SKIPPED, skipped.collect::<Vec<_>>().as_flattened());
}

/// Loads the scene of a file.
///
/// # Errors
/// [`LoadError::Missing`] if the file has no scene, and [`LoadError::Inconsistent`] if its sections
/// contradict each other.
pub fn load_scene(reader: &Reader) -> Result<Scene, LoadError> {
    let numbers: Vec<f64> = reader.copy(POSITIONS)?;
    let positions: Vec<Point3<f64>> = numbers.chunks_exact(3).map(|p| Point3::new(p[0], p[1], p[2])).collect();
    let (kinds, indices): (Vec<u8>, Vec<u32>) = (reader.copy(KINDS)?, reader.copy(INDICES)?);
    let count = if kinds.is_empty() { indices.len() / 3 } else { kinds.len() };
    let sources: Vec<u32> = reader.copy(SOURCES)?;
    let mut rest = &indices[..];
    let mut elements = Vec::with_capacity(count);
    for i in 0..count {
        let kind = usize::from(kinds.get(i).copied().unwrap_or(3));
        let own = rest.split_at_checked(kind);
        let (own, others) = own.ok_or_else(|| LoadError::inconsistent(INDICES, "there are too few"))?;
        rest = others;
        elements.push(match *own {
            [a] => Element::Point(a),
            [a, b] => Element::Segment([a, b]),
            [a, b, c] => Element::Triangle([a, b, c]),
            _ => return Err(LoadError::inconsistent(KINDS, "a primitive has no vertex or more than three")),
        });
    }
    require(rest.is_empty(), INDICES, "there are too many")?;
    require(numbers.len().is_multiple_of(3), POSITIONS, "a coordinate is missing")?;
    require(sources.len() == count, SOURCES, "there is not one for each primitive")?;
    let invalid = "a coordinate is not finite, or an index has no position";
    let soup = Soup::new(positions, elements).map_err(|_| LoadError::inconsistent(POSITIONS, invalid))?;
    let texts: Vec<u8> = reader.copy(TEXTS)?;
    let mut texts = &texts[..];
    let mut text = |len: u64| -> Option<String> {
        let (own, others) = texts.split_at_checked(usize::try_from(len).ok()?)?;
        texts = others;
        String::from_utf8(own.to_vec()).ok()
    };
    let mut objects = Vec::new();
    for object in reader.copy::<u64>(OBJECTS)?.chunks_exact(3) {
        let ids = [object[1], object[2]].map(usize::try_from);
        let ([Ok(start), Ok(end)], Some(name)) = (ids, text(object[0])) else {
            return Err(LoadError::inconsistent(OBJECTS, "a name is missing"));
        };
        require(start <= end && end <= count, OBJECTS, "an object has ids that do not exist")?;
        objects.push(Object { name, ids: start..end });
    }
    let mut skipped = Vec::new();
    for own in reader.copy::<u64>(SKIPPED)?.chunks_exact(3) {
        let what = text(own[0]).ok_or_else(|| LoadError::inconsistent(SKIPPED, "a name is missing"))?;
        skipped.push(Skipped { what, count: own[1], is_plural: own[2] != 0 });
    }
    Ok(Scene { soup: Arc::new(soup), sources, objects, skipped, ..Scene::default() })
}

/// Reads the scene from a file of a saved index. `name` is the name of the file in messages.
///
/// # Errors
/// [`ReadError`] with [`Reason::Saved`] if the file is damaged or has no scene.
pub fn read_p2m(reader: impl BufRead, name: &str) -> Result<Scene, ReadError> {
    read(reader, name, SceneBuilder::default())
}

/// Reads the scene from a file of a saved index, and adds it to a builder only if that makes pieces.
pub(super) fn read(reader: impl BufRead, name: &str, builder: SceneBuilder<'_>) -> Result<Scene, ReadError> {
    let load = || load_scene(SavedFile::read(reader)?.checked()?);
    let scene = load().map_err(Reason::Saved);
    let scene = scene.and_then(|scene| if builder.makes_pieces() { divide(scene, builder) } else { Ok(scene) });
    scene.map_err(|reason| ReadError::new(name, FileLocation::File, reason))
}

/// Adds the primitives of a scene to a builder of pieces, and returns its last piece.
fn divide(scene: Scene, mut builder: SceneBuilder<'_>) -> Result<Scene, Reason> {
    for &position in scene.soup.positions() {
        builder.push_vertex(position)?;
    }
    let mut objects = scene.objects.iter().peekable();
    for (id, element) in scene.soup.elements().enumerate() {
        while let Some(object) = objects.peek()
            && object.ids.start <= id
        {
            if id < object.ids.end {
                if id == object.ids.start {
                    builder.start_run(object.name.as_bytes());
                }
                break;
            }
            builder.start_run(b"");
            objects.next();
        }
        builder.push(element, scene.sources[id] as usize)?;
    }
    let mut last = builder.finish();
    last.skipped = scene.skipped;
    Ok(last)
}

/// Writes a scene as a file of saved indexes that has no index. Reading it returns the same scene, including
/// names and sources.
///
/// # Errors
/// Errors of `writer`.
pub fn write_p2m(scene: &Scene, writer: impl Write) -> Result<(), WriteError> {
    let mut sections = Writer::default();
    save_scene(scene, &mut sections);
    Ok(sections.write(writer)?)
}
