//! 3MF: a ZIP archive of models in XML. The items of the build plate are placed, with the components of their objects.

use crate::File;
use crate::sink::{Sink, expanded_limit, is_mirrored, moved};
use nalgebra::Matrix4;
use p2m_core::Element;
use p2m_mixed::{ReadError, Scene, Unit};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::collections::HashMap;
use std::fmt::Display;
use std::io::{Cursor, Read};
use std::str::FromStr;
use zip::ZipArchive;

/// The deepest nesting of objects.
const MAX_DEPTH: usize = 32;

/// A mesh or a group of placed objects.
#[derive(Default)]
struct Object {
    name: String,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    components: Vec<Placed>,
}

/// An object placed by a matrix. It may be in another model of the archive.
struct Placed {
    model: Option<String>,
    object: u32,
    matrix: Matrix4<f64>,
}

#[derive(Default)]
struct Model {
    unit: Option<Unit>,
    objects: HashMap<u32, Object>,
    items: Vec<Placed>,
}

pub(crate) fn read(file: &File<'_>) -> Result<Scene, ReadError> {
    let mut archive =
        ZipArchive::new(Cursor::new(file.bytes)).map_err(|error| file.error(format!("archive: {error}")))?;
    let mut left = expanded_limit(file.bytes.len()) as u64;
    let mut extract = |name: &str| -> Result<String, ReadError> {
        let fail = |error: &dyn Display| file.error(format!("{}: {error}", name.escape_debug()));
        let entry = archive.by_name(name).map_err(|error| fail(&error))?;
        let mut text = String::new();
        entry.take(left).read_to_string(&mut text).map_err(|error| fail(&error))?;
        left -= text.len() as u64;
        if left == 0 {
            return Err(fail(&"it expands to more than 1,000 times the size of the file"));
        }
        Ok(text)
    };
    let mut main = "3D/3dmodel.model".to_owned();
    if let Ok(text) = extract("_rels/.rels") {
        each_element(&text, &mut |element| {
            let of_model = attribute(element, "Type")?.is_some_and(|kind| kind.ends_with("/3dmodel"));
            if let (true, Some(target)) = (of_model, attribute(element, "Target")?) {
                main = target.trim_start_matches('/').to_owned();
            }
            Ok(())
        })
        .map_err(|error| file.error(format!("_rels/.rels {error}")))?;
    }
    let mut models: HashMap<String, Model> = HashMap::new();
    let mut pending = vec![main.clone()];
    while let Some(name) = pending.pop() {
        if models.contains_key(&name) {
            continue;
        }
        let model = Model::parse(&extract(&name)?);
        let model = model.map_err(|error| file.error(format!("{} {error}", name.escape_debug())))?;
        let placed = model.objects.values().flat_map(|object| &object.components).chain(&model.items);
        pending.extend(placed.filter_map(|placed| placed.model.clone()));
        models.insert(name, model);
    }
    let mut sink = Sink::new(file.bytes.len());
    sink.builder.unit = Some(models[&main].unit.unwrap_or(Unit::Millimetre));
    for (number, item) in models[&main].items.iter().enumerate() {
        let placed = place(&mut sink, &models, &main, item, &Matrix4::identity(), "", 0);
        placed.map_err(|error| file.error(format!("item {number} of the build, counted from 0: {error}")))?;
    }
    Ok(sink.finish())
}

/// Adds an object and its components. They are named after the outermost object that has a name.
fn place(
    sink: &mut Sink,
    models: &HashMap<String, Model>,
    from: &str,
    placed: &Placed,
    above: &Matrix4<f64>,
    name: &str,
    depth: usize,
) -> Result<(), String> {
    let from = placed.model.as_deref().unwrap_or(from);
    let object = models[from].objects.get(&placed.object);
    let object = object.ok_or_else(|| format!("there is no object {}", placed.object))?;
    if depth > MAX_DEPTH {
        return Err(format!("object {} is part of itself, or nested too deeply", placed.object));
    }
    let matrix = above * placed.matrix;
    let is_mirrored = is_mirrored(&matrix);
    let name = if name.is_empty() { object.name.as_str() } else { name };
    let at = |reason: &dyn Display| format!("object {}: {reason}", placed.object);
    sink.builder.start_object(name.as_bytes());
    // Each component counts as a byte. A file could otherwise have so many empty ones that visiting them takes too
    // long.
    sink.take(1).map_err(|reason| at(&reason))?;
    let mut vertices = Vec::new();
    for position in &object.vertices {
        vertices.push(sink.vertex(moved(&matrix, *position)).map_err(|reason| at(&reason))?);
    }
    for corners in &object.triangles {
        let mut triangle = [0; 3];
        for (corner, &index) in triangle.iter_mut().zip(corners) {
            let missing = || at(&format_args!("vertex {index} is out of range, there are {}", vertices.len()));
            *corner = *vertices.get(index as usize).ok_or_else(missing)?;
        }
        if is_mirrored {
            triangle.swap(1, 2);
        }
        sink.push(Element::Triangle(triangle)).map_err(|reason| at(&reason))?;
    }
    object.components.iter().try_for_each(|part| place(sink, models, from, part, &matrix, name, depth + 1))
}

impl Model {
    fn parse(text: &str) -> Result<Self, String> {
        let mut model = Self::default();
        let mut id = None;
        // Slices have vertices of their own, which are not those of the mesh.
        let mut is_in_slices = false;
        each_element(text, &mut |element| {
            match element.local_name().as_ref() {
                "model" => {
                    if requires_slices(element)? {
                        return Err("the model requires the extension for slices, which are not read: save it with \
                                    meshes of full resolution"
                            .to_owned());
                    }
                    let unit = attribute(element, "unit")?;
                    model.unit = unit
                        .map(|name| Unit::named(&name).ok_or(format!("unit '{}' is unknown", name.escape_debug())))
                        .transpose()?;
                }
                "slicestack" => is_in_slices = true,
                "vertex" if is_in_slices => {}
                "object" => {
                    is_in_slices = false;
                    let name = attribute(element, "name")?.unwrap_or_default();
                    let new = number(element, "id")?;
                    id = Some(new);
                    if model.objects.insert(new, Object { name, ..Object::default() }).is_some() {
                        return Err(format!("there is another object {new}"));
                    }
                }
                "item" => model.items.push(Placed::parse(element)?),
                part @ ("vertex" | "triangle" | "component") => {
                    let object = id.and_then(|id| model.objects.get_mut(&id));
                    let object = object.ok_or_else(|| format!("<{part}> is outside of an object"))?;
                    match part {
                        "vertex" => {
                            object.vertices.push([number(element, "x")?, number(element, "y")?, number(element, "z")?]);
                        }
                        "triangle" => object.triangles.push([
                            number(element, "v1")?,
                            number(element, "v2")?,
                            number(element, "v3")?,
                        ]),
                        _ => object.components.push(Placed::parse(element)?),
                    }
                }
                _ => {}
            }
            Ok(())
        })?;
        Ok(model)
    }
}

impl Placed {
    fn parse(element: &BytesStart<'_>) -> Result<Self, String> {
        let mut matrix = Matrix4::identity();
        if let Some(text) = attribute(element, "transform")? {
            let numbers = text.split_ascii_whitespace().map(parse).collect::<Result<Vec<f64>, _>>()?;
            if numbers.len() != 12 {
                return Err(format!("a transform has {} numbers instead of 12", numbers.len()));
            }
            // The file has matrices for row vectors, so they are transposed here.
            (0..12).for_each(|k| matrix[(k % 3, k / 3)] = numbers[k]);
        }
        let model = attribute(element, "path")?.map(|path| path.trim_start_matches('/').to_owned());
        Ok(Self { model, object: number(element, "objectid")?, matrix })
    }
}

/// Calls a function for each element of the text. An error has the location in the text.
fn each_element(text: &str, take: &mut dyn FnMut(&BytesStart<'_>) -> Result<(), String>) -> Result<(), String> {
    let mut reader = Reader::from_str(text);
    loop {
        let event = reader.read_event().map_err(|error| error.to_string());
        let result = event.and_then(|event| match event {
            Event::Start(element) | Event::Empty(element) => take(&element).map(|()| true),
            Event::Eof => Ok(false),
            _ => Ok(true),
        });
        match result {
            Ok(true) => {}
            Ok(false) => return Ok(()),
            Err(error) => return Err(format!("at byte {}: {error}", reader.buffer_position())),
        }
    }
}

/// Returns whether a model requires its reader to know slices.
fn requires_slices(model: &BytesStart<'_>) -> Result<bool, String> {
    let required = attribute(model, "requiredextensions")?.unwrap_or_default();
    for prefix in required.split_ascii_whitespace() {
        if attribute(model, prefix)?.is_some_and(|space| space.contains("/slice/")) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Returns the value of an attribute, whose name may have a prefix.
fn attribute(element: &BytesStart<'_>, name: &str) -> Result<Option<String>, String> {
    for attribute in element.attributes() {
        let attribute = attribute.map_err(|error| error.to_string())?;
        if attribute.key.local_name().as_ref() == name {
            let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|error| error.to_string())?;
            return Ok(Some(value.into_owned()));
        }
    }
    Ok(None)
}

/// Returns the number in an attribute.
fn number<T: FromStr>(element: &BytesStart<'_>, name: &str) -> Result<T, String> {
    parse(&attribute(element, name)?.ok_or_else(|| format!("<{}> has no {name}", element.local_name().as_ref()))?)
}

fn parse<T: FromStr>(text: &str) -> Result<T, String> {
    text.trim().parse().map_err(|_| format!("'{}' is not a number that fits here", text.escape_debug()))
}
