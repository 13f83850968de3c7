//! glTF 2.0 and GLB: meshes, lines and points of the nodes of a scene, with their transforms.
//!
//! The description is parsed by serde, without the members that p2m ignores, such as materials, animations and cameras.
//! Its numbers are not trusted: every index, count and offset is checked where it is used.

use crate::sink::{Sink, fan, is_mirrored, moved, strip};
use crate::{File, sink};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use nalgebra::{Matrix4, Quaternion, UnitQuaternion, Vector3};
use p2m_core::Element;
use p2m_mixed::engine::Scalar;
use p2m_mixed::{FileLocation, ReadError, Reason, Scene, Unit};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::borrow::Cow;
use std::path::{Component, Path};

/// The description of a file. Members have the names of the format, and refer to others by their index.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Description {
    #[serde(rename = "asset")]
    _asset: IgnoredAny,
    #[serde(default)]
    extensions_required: Vec<String>,
    scene: Option<usize>,
    #[serde(default)]
    scenes: Vec<Roots>,
    #[serde(default)]
    nodes: Vec<Node>,
    #[serde(default)]
    meshes: Vec<Mesh>,
    #[serde(default)]
    accessors: Vec<Accessor>,
    #[serde(default)]
    buffer_views: Vec<View>,
    #[serde(default)]
    buffers: Vec<Buffer>,
}

/// A scene: the nodes that have no parents.
#[derive(Deserialize)]
struct Roots {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize)]
struct Node {
    name: Option<String>,
    mesh: Option<usize>,
    children: Option<Vec<usize>>,
    matrix: Option<[f32; 16]>,
    translation: Option<[f32; 3]>,
    rotation: Option<[f32; 4]>,
    scale: Option<[f32; 3]>,
}

#[derive(Deserialize)]
struct Mesh {
    name: Option<String>,
    primitives: Vec<Primitive>,
}

/// A part of a mesh. Its mode says which primitives its vertices make.
#[derive(Deserialize)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    mode: Option<u32>,
}

#[derive(Deserialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: Option<usize>,
}

/// Numbers in a view of a buffer, `count` items of the same type.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    byte_offset: Option<usize>,
    component_type: u32,
    #[serde(default)]
    normalized: bool,
    count: usize,
    #[serde(rename = "type")]
    item_type: String,
    sparse: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct View {
    buffer: usize,
    byte_offset: Option<usize>,
    byte_length: usize,
    byte_stride: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Buffer {
    uri: Option<String>,
    #[serde(default)]
    byte_length: usize,
}

/// The mode of primitives without one: separate triangles.
const TRIANGLES: u32 = 4;

pub(crate) fn read(file: &File<'_>) -> Result<Scene, ReadError> {
    let is_binary = file.bytes.starts_with(b"glTF");
    let (json, bin) = if is_binary { chunks(file)? } else { (file.bytes, None) };
    let description: Description = serde_json::from_slice(json).map_err(|error| {
        let location = if is_binary { FileLocation::File } else { FileLocation::Line(error.line() as u64) };
        file.error_at(location, format!("description: {error}"))
    })?;
    // The numbers of KHR_mesh_quantization are those of accessors, which are read here.
    let mut required = description.extensions_required.iter();
    if let Some(extension) = required.find(|name| *name != "KHR_mesh_quantization") {
        let advice = if extension.contains("compression") {
            "compressed meshes are not read: gltf-transform or Blender write the file without compression"
        } else {
            "files that need it are not read"
        };
        return Err(file.error(format!("extension {}: {advice}", extension.escape_debug())));
    }
    let buffers = description.buffers.iter().enumerate().map(|(number, buffer)| load(file, number, buffer, bin));
    let buffers = buffers.collect::<Result<Vec<_>, _>>()?;
    let visited = vec![false; description.nodes.len()];
    let mut reader = Reader { file, description: &description, buffers, sink: Sink::new(file.bytes.len()), visited };
    match description.scene.or((!description.scenes.is_empty()).then_some(0)) {
        Some(scene) => reader.nodes(&reader.item(&description.scenes, "scene", scene)?.nodes)?,
        // A file without scenes is a library of meshes.
        None => (0..description.meshes.len()).try_for_each(|mesh| reader.mesh(mesh, None, &Matrix4::identity()))?,
    }
    reader.sink.builder.unit = Some(Unit::Metre);
    Ok(reader.sink.finish())
}

/// Returns the JSON chunk of a binary file, and its binary chunk if it has one.
fn chunks<'a>(file: &'a File<'_>) -> Result<(&'a [u8], Option<&'a [u8]>), ReadError> {
    let version = u32::from_le_bytes(file.array(4)?);
    if version != 2 {
        return Err(file.error_at(FileLocation::Byte(4), format!("version {version} is not 2")));
    }
    let chunk = |at: usize, kind: &[u8; 4]| -> Result<&'a [u8], ReadError> {
        if file.array(at + 4)? != *kind {
            let name = kind.escape_ascii();
            return Err(
                file.error_at(FileLocation::Byte(at as u64 + 4), format!("the chunk is not of the kind {name}"))
            );
        }
        file.slice(at + 8, u32::from_le_bytes(file.array(at)?) as usize)
    };
    let json = chunk(12, b"JSON")?;
    let mut at = 20 + json.len();
    while at < file.bytes.len() {
        if file.array(at + 4)? == *b"BIN\0" {
            return Ok((json, Some(chunk(at, b"BIN\0")?)));
        }
        // Chunks of other kinds are extensions, which readers ignore.
        at += 8 + file.slice(at + 8, u32::from_le_bytes(file.array(at)?) as usize)?.len();
    }
    Ok((json, None))
}

/// Returns the bytes of a buffer, which are in the binary chunk, in a data URI, or in another file.
fn load<'a>(
    file: &File<'_>,
    number: usize,
    buffer: &Buffer,
    bin: Option<&'a [u8]>,
) -> Result<Cow<'a, [u8]>, ReadError> {
    let fail = |what: String| file.error(format!("buffer {number}: {what}"));
    let bytes = match &buffer.uri {
        None => Cow::Borrowed(bin.ok_or_else(|| fail("the file has no binary part".to_owned()))?),
        Some(uri) if uri.starts_with("data:") => {
            let data = uri.split_once(";base64,").ok_or_else(|| fail("its data is not in base64".to_owned()))?.1;
            Cow::Owned(STANDARD.decode(data).map_err(|error| fail(error.to_string()))?)
        }
        Some(uri) => {
            let name = uri.replace("%20", " ");
            // A file may not read files outside of its folder.
            let is_inside = Path::new(&name).components().all(|part| matches!(part, Component::Normal(_)));
            let shown = name.escape_debug();
            let path =
                file.path.filter(|_| is_inside).ok_or_else(|| fail(format!("'{shown}' is not beside the file")))?;
            Cow::Owned(std::fs::read(path.with_file_name(&name)).map_err(|error| fail(format!("'{shown}': {error}")))?)
        }
    };
    if bytes.len() < buffer.byte_length {
        return Err(fail(format!("it has {} bytes instead of {}", bytes.len(), buffer.byte_length)));
    }
    Ok(bytes)
}

struct Reader<'a> {
    file: &'a File<'a>,
    description: &'a Description,
    buffers: Vec<Cow<'a, [u8]>>,
    sink: Sink,
    /// Whether each node was visited. A node that is reached twice is an error, because a node has at most one parent.
    visited: Vec<bool>,
}

impl Reader<'_> {
    /// Returns an item of a list of the description.
    fn item<'l, T>(&self, list: &'l [T], what: &str, index: usize) -> Result<&'l T, ReadError> {
        list.get(index).ok_or_else(|| self.file.error(format!("description: there is no {what} {index}")))
    }

    /// Adds nodes and their descendants, with a list of pending nodes instead of a recursion that a file could make
    /// deep.
    fn nodes(&mut self, roots: &[usize]) -> Result<(), ReadError> {
        let mut pending: Vec<_> = roots.iter().rev().map(|node| (*node, Matrix4::identity())).collect();
        while let Some((number, above)) = pending.pop() {
            let node = self.item(&self.description.nodes, "node", number)?;
            if std::mem::replace(&mut self.visited[number], true) {
                return Err(self.file.error(format!("node {number} has two parents")));
            }
            let matrix = above * matrix(node);
            if let Some(mesh) = node.mesh {
                self.mesh(mesh, node.name.as_deref(), &matrix)?;
            }
            pending.extend(node.children.iter().flatten().rev().map(|child| (*child, matrix)));
        }
        Ok(())
    }

    fn mesh(&mut self, number: usize, name: Option<&str>, matrix: &Matrix4<f64>) -> Result<(), ReadError> {
        let mesh = self.item(&self.description.meshes, "mesh", number)?;
        let name = name.filter(|name| !name.trim().is_empty()).or(mesh.name.as_deref()).unwrap_or_default();
        self.sink.builder.start_object(name.as_bytes());
        for (part, primitive) in mesh.primitives.iter().enumerate() {
            let fail =
                |what: &dyn std::fmt::Display| self.file.error(format!("mesh {number}, primitive {part}: {what}"));
            let Some(positions) = primitive.attributes.position else { continue };
            let mut vertices = Vec::new();
            for position in self.numbers(positions, "VEC3", 3)?.as_chunks::<3>().0 {
                vertices.push(self.sink.vertex(moved(matrix, *position)).map_err(|reason| fail(&reason))?);
            }
            let corners = match primitive.indices {
                None => vertices,
                Some(indices) => {
                    let mut corners = Vec::new();
                    for index in self.numbers(indices, "SCALAR", 1)? {
                        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number")]
                        let vertex = vertices.get(index as usize);
                        let count = vertices.len();
                        let missing =
                            || fail(&format_args!("index {index} is out of range, there are {count} vertices"));
                        corners.push(*vertex.ok_or_else(missing)?);
                    }
                    corners
                }
            };
            let mode = primitive.mode.unwrap_or(TRIANGLES);
            push(&mut self.sink, mode, &corners, is_mirrored(matrix)).map_err(|reason| fail(&reason))?;
        }
        Ok(())
    }

    /// Returns all numbers of an accessor, whose items have to be of this type and width.
    fn numbers(&self, number: usize, item_type: &str, width: usize) -> Result<Vec<f64>, ReadError> {
        let accessor = self.item(&self.description.accessors, "accessor", number)?;
        let fail = |what: String| self.file.error(format!("accessor {number}: {what}"));
        if accessor.sparse.is_some() {
            return Err(fail("sparse accessors are not read: Blender writes the file without them".to_owned()));
        }
        if accessor.item_type != item_type {
            return Err(fail(format!("its type is {} instead of {item_type}", accessor.item_type.escape_debug())));
        }
        let view = accessor.buffer_view.ok_or_else(|| fail("it has no data".to_owned()))?;
        let view = self.item(&self.description.buffer_views, "view", view)?;
        let kind = accessor.component_type;
        let component = component(kind).ok_or_else(|| fail(format!("the type {kind} of its numbers is unknown")))?;
        let (scalar, largest) = component;
        let size = scalar.size();
        let number = |bytes: &[u8]| scalar.number(bytes).expect("the bytes of one number");
        let stride = view.byte_stride.unwrap_or(size * width);
        let buffer = self.item(&self.buffers, "buffer", view.buffer)?;
        let range = |start: usize, len: usize| buffer.get(start..start.checked_add(len)?);
        let data = range(view.byte_offset.unwrap_or(0), view.byte_length);
        let data = data.ok_or_else(|| fail(format!("its view is outside of buffer {}", view.buffer)))?;
        let (count, offset) = (accessor.count, accessor.byte_offset.unwrap_or(0));
        let needed = count
            .checked_sub(1)
            .map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(offset)?.checked_add(size * width));
        if needed.is_none_or(|needed| needed > data.len()) {
            return Err(fail(format!("its {count} items are outside of its view of {} bytes", data.len())));
        }
        // Views of buffers may overlap, so a file of few bytes may announce many items.
        if count.saturating_mul(width * size_of::<f64>()) > sink::expanded_limit(self.file.bytes.len()) {
            return Err(fail(format!("it has {count} items, too many for the file")));
        }
        let item = |i: usize| &data[offset + i * stride..][..size * width];
        let scaled = |value: f64| if accessor.normalized { (value / largest).max(-1.0) } else { value };
        Ok((0..count).flat_map(|i| item(i).chunks_exact(size).map(number).map(scaled)).collect())
    }
}

/// Returns the type of numbers with an OpenGL code, and the number that stands for 1 if they are normalized.
fn component(code: u32) -> Option<(Scalar, f64)> {
    Some(match code {
        5120 => (Scalar::I8, i8::MAX.into()),
        5121 => (Scalar::U8, u8::MAX.into()),
        5122 => (Scalar::I16, i16::MAX.into()),
        5123 => (Scalar::U16, u16::MAX.into()),
        5125 => (Scalar::U32, u32::MAX.into()),
        5126 => (Scalar::F32, 1.0),
        _ => return None,
    })
}

/// Returns the transform of a node in double precision, either its matrix or the product of its translation, rotation
/// and scale.
fn matrix(node: &Node) -> Matrix4<f64> {
    if let Some(matrix) = &node.matrix {
        return Matrix4::from_column_slice(matrix).map(f64::from);
    }
    let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]).map(f64::from);
    Matrix4::new_translation(&Vector3::from(node.translation.unwrap_or_default()).map(f64::from))
        * UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).to_homogeneous()
        * Matrix4::new_nonuniform_scaling(&Vector3::from(node.scale.unwrap_or([1.0; 3])).map(f64::from))
}

/// Adds the primitives of a mode. The modes 0 to 6 are points, lines, a line loop, a line strip, triangles, a triangle
/// strip and a triangle fan. Mirrored triangles are reversed.
fn push(sink: &mut Sink, mode: u32, corners: &[u32], is_mirrored: bool) -> Result<(), Reason> {
    let turned = |element: Element| match element {
        Element::Triangle([a, b, c]) if is_mirrored => Element::Triangle([a, c, b]),
        _ => element,
    };
    let mut segment = |ends: &[u32]| sink.push(Element::Segment([ends[0], ends[1]]));
    match mode {
        0 => corners.iter().try_for_each(|vertex| sink.push(Element::Point(*vertex))),
        1 => corners.chunks_exact(2).try_for_each(segment),
        3 => corners.windows(2).try_for_each(segment),
        2 => {
            corners.windows(2).try_for_each(&mut segment)?;
            match corners {
                [first, .., last] => segment(&[*last, *first]),
                _ => Ok(()),
            }
        }
        TRIANGLES => corners.chunks_exact(3).try_for_each(|t| sink.push(turned(Element::Triangle([t[0], t[1], t[2]])))),
        5 => strip(corners).try_for_each(|triangle| sink.push(turned(triangle))),
        6 => fan(corners).try_for_each(|triangle| sink.push(turned(triangle))),
        _ => Err(Reason::Format(format!("mode {mode} is unknown").into())),
    }
}
