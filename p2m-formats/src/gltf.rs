//! glTF 2.0 and GLB: meshes, lines and points of the nodes of a scene, with their transforms.
//!
//! The crate gltf parses and validates the description. Containers and the numbers in buffers are read here, because
//! that crate trusts lengths.

use crate::sink::{Sink, fan, is_mirrored, moved, strip};
use crate::{File, sink};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::mesh::Mode;
use gltf::{Accessor, Document, Mesh, Node, Semantic};
use nalgebra::{Matrix4, Quaternion, UnitQuaternion, Vector3};
use p2m_core::Element;
use p2m_mixed::{FileLocation, ReadError, Reason, Scene, Unit};
use std::borrow::Cow;
use std::path::{Component, Path};

pub(crate) fn read(file: &File<'_>) -> Result<Scene, ReadError> {
    let is_binary = file.bytes.starts_with(b"glTF");
    let (json, bin) = if is_binary { chunks(file)? } else { (file.bytes, None) };
    let mut root = gltf::json::Root::from_slice(json).map_err(|error| {
        let location = if is_binary { FileLocation::File } else { FileLocation::Line(error.line() as u64) };
        file.error_at(location, format!("description: {error}"))
    })?;
    // The numbers of this extension are those of accessors, which are read here.
    root.extensions_required.retain(|extension| extension != "KHR_mesh_quantization");
    if let Some(extension) = root.extensions_required.iter().find(|name| name.contains("compression")) {
        let advice = "gltf-transform or Blender write the file without compression";
        return Err(
            file.error(format!("extension {}: compressed meshes are not read: {advice}", extension.escape_debug()))
        );
    }
    // The validation of the crate indexes accessors by these numbers.
    let accessors = root.accessors.len();
    for (number, mesh) in root.meshes.iter().enumerate() {
        let mut attributes = mesh.primitives.iter().flat_map(|primitive| primitive.attributes.values());
        if let Some(accessor) = attributes.find(|accessor| accessor.value() >= accessors) {
            return Err(file.error(format!("mesh {number}: there is no accessor {}", accessor.value())));
        }
    }
    let document = Document::from_json(root).map_err(|error| file.error(format!("description: {error}")))?;
    let buffers = document.buffers().map(|buffer| load(file, &buffer, bin));
    let buffers = buffers.collect::<Result<Vec<_>, _>>()?;
    let mut reader =
        Reader { file, buffers, sink: Sink::new(file.bytes.len()), visited: vec![false; document.nodes().len()] };
    match document.default_scene().or_else(|| document.scenes().next()) {
        Some(scene) => reader.nodes(scene.nodes().collect())?,
        // A file without scenes is a library of meshes.
        None => document.meshes().try_for_each(|mesh| reader.mesh(&mesh, None, &Matrix4::identity()))?,
    }
    reader.sink.builder.unit = Some(Unit::Metre);
    Ok(reader.sink.finish())
}

/// Returns the description in a binary file, and its buffer if it has one.
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

/// Returns the bytes of a buffer, which are in the file, in the text of its address, or in another file.
fn load<'a>(file: &File<'_>, buffer: &gltf::Buffer<'_>, bin: Option<&'a [u8]>) -> Result<Cow<'a, [u8]>, ReadError> {
    let fail = |what: String| file.error(format!("buffer {}: {what}", buffer.index()));
    let bytes = match buffer.source() {
        Source::Bin => Cow::Borrowed(bin.ok_or_else(|| fail("the file has no binary part".to_owned()))?),
        Source::Uri(uri) if uri.starts_with("data:") => {
            let data = uri.split_once(";base64,").ok_or_else(|| fail("its data is not in base64".to_owned()))?.1;
            Cow::Owned(STANDARD.decode(data).map_err(|error| fail(error.to_string()))?)
        }
        Source::Uri(uri) => {
            let name = uri.replace("%20", " ");
            // A file may not read files outside of its folder.
            let is_inside = Path::new(&name).components().all(|part| matches!(part, Component::Normal(_)));
            let shown = name.escape_debug();
            let path =
                file.path.filter(|_| is_inside).ok_or_else(|| fail(format!("'{shown}' is not beside the file")))?;
            Cow::Owned(std::fs::read(path.with_file_name(&name)).map_err(|error| fail(format!("'{shown}': {error}")))?)
        }
    };
    if bytes.len() < buffer.length() {
        return Err(fail(format!("it has {} bytes instead of {}", bytes.len(), buffer.length())));
    }
    Ok(bytes)
}

struct Reader<'a> {
    file: &'a File<'a>,
    buffers: Vec<Cow<'a, [u8]>>,
    sink: Sink,
    /// The nodes that were visited. A node has at most one parent.
    visited: Vec<bool>,
}

impl Reader<'_> {
    /// Adds nodes and those below them, without a recursion that a file could make deep.
    fn nodes(&mut self, roots: Vec<Node<'_>>) -> Result<(), ReadError> {
        let mut pending: Vec<_> = roots.into_iter().rev().map(|node| (node, Matrix4::identity())).collect();
        while let Some((node, above)) = pending.pop() {
            if std::mem::replace(&mut self.visited[node.index()], true) {
                return Err(self.file.error(format!("node {} has two parents", node.index())));
            }
            let matrix = above * matrix(&node);
            if let Some(mesh) = node.mesh() {
                self.mesh(&mesh, node.name(), &matrix)?;
            }
            let children: Vec<_> = node.children().collect();
            pending.extend(children.into_iter().rev().map(|child| (child, matrix)));
        }
        Ok(())
    }

    fn mesh(&mut self, mesh: &Mesh<'_>, name: Option<&str>, matrix: &Matrix4<f64>) -> Result<(), ReadError> {
        let name = name.filter(|name| !name.trim().is_empty()).or(mesh.name()).unwrap_or_default();
        self.sink.builder.start_object(name.as_bytes());
        for primitive in mesh.primitives() {
            let fail = |what: &dyn std::fmt::Display| {
                self.file.error(format!("mesh {}, primitive {}: {what}", mesh.index(), primitive.index()))
            };
            let Some(accessor) = primitive.get(&Semantic::Positions) else { continue };
            if accessor.dimensions() != Dimensions::Vec3 {
                return Err(fail(&"positions have no three coordinates"));
            }
            let mut vertices = Vec::new();
            let numbers = self.numbers(&accessor)?;
            for position in numbers.as_chunks::<3>().0 {
                vertices.push(self.sink.vertex(moved(matrix, *position)).map_err(|reason| fail(&reason))?);
            }
            let corners = match primitive.indices() {
                None => vertices,
                Some(accessor) => {
                    let mut corners = Vec::new();
                    for index in self.numbers(&accessor)? {
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
            push(&mut self.sink, primitive.mode(), &corners, is_mirrored(matrix)).map_err(|reason| fail(&reason))?;
        }
        Ok(())
    }

    /// Returns all numbers of an accessor.
    fn numbers(&self, accessor: &Accessor<'_>) -> Result<Vec<f64>, ReadError> {
        let fail = |what: String| self.file.error(format!("accessor {}: {what}", accessor.index()));
        if accessor.sparse().is_some() {
            return Err(fail("sparse accessors are not read: Blender writes the file without them".to_owned()));
        }
        let view = accessor.view().ok_or_else(|| fail("it has no data".to_owned()))?;
        let size = accessor.data_type().size();
        let width = accessor.dimensions().multiplicity();
        let stride = view.stride().unwrap_or(size * width);
        let buffer = &self.buffers[view.buffer().index()];
        let range = |start: usize, len: usize| buffer.get(start..start.checked_add(len)?);
        let data = range(view.offset(), view.length());
        let data = data.ok_or_else(|| fail(format!("its view is outside of buffer {}", view.buffer().index())))?;
        let needed = accessor.count().checked_sub(1).map_or(Some(0), |last| {
            last.checked_mul(stride)?.checked_add(accessor.offset())?.checked_add(size * width)
        });
        if needed.is_none_or(|needed| needed > data.len()) {
            return Err(fail(format!(
                "its {} items are outside of its view of {} bytes",
                accessor.count(),
                data.len()
            )));
        }
        // Views may overlap themselves, so that few bytes have many items.
        let total = accessor.count().saturating_mul(width * size_of::<f64>());
        if total > sink::expanded_limit(self.file.bytes.len()) {
            return Err(fail(format!("it has {} items, too many for the file", accessor.count())));
        }
        let item = |i: usize| &data[accessor.offset() + i * stride..][..size * width];
        let number = |bytes: &[u8]| number(accessor.data_type(), accessor.normalized(), bytes);
        Ok((0..accessor.count()).flat_map(|i| item(i).chunks_exact(size).map(number)).collect())
    }
}

/// Returns a number of a buffer.
fn number(kind: DataType, is_normalized: bool, bytes: &[u8]) -> f64 {
    let (value, largest) = match (kind, bytes) {
        (DataType::F32, &[a, b, c, d]) => (f64::from(f32::from_le_bytes([a, b, c, d])), 1.0),
        (DataType::U32, &[a, b, c, d]) => (f64::from(u32::from_le_bytes([a, b, c, d])), f64::from(u32::MAX)),
        (DataType::U16, &[a, b]) => (f64::from(u16::from_le_bytes([a, b])), f64::from(u16::MAX)),
        (DataType::I16, &[a, b]) => (f64::from(i16::from_le_bytes([a, b])), f64::from(i16::MAX)),
        (DataType::U8, &[a]) => (f64::from(a), f64::from(u8::MAX)),
        (DataType::I8, &[a]) => (f64::from(i8::from_le_bytes([a])), f64::from(i8::MAX)),
        _ => unreachable!("the bytes are those of the type"),
    };
    if is_normalized { (value / largest).max(-1.0) } else { value }
}

/// Returns the transform of a node. It is computed in double precision, from parts where the node has parts.
fn matrix(node: &Node<'_>) -> Matrix4<f64> {
    match node.transform() {
        gltf::scene::Transform::Matrix { matrix } => Matrix4::from(matrix).map(f64::from),
        gltf::scene::Transform::Decomposed { translation, rotation: [x, y, z, w], scale } => {
            let rotation = Quaternion::new(w.into(), x.into(), y.into(), z.into());
            Matrix4::new_translation(&Vector3::from(translation).map(f64::from))
                * UnitQuaternion::new_normalize(rotation).to_homogeneous()
                * Matrix4::new_nonuniform_scaling(&Vector3::from(scale).map(f64::from))
        }
    }
}

/// Adds the primitives that corners make in a mode, the triangles in the other direction if they are mirrored.
fn push(sink: &mut Sink, mode: Mode, corners: &[u32], is_mirrored: bool) -> Result<(), Reason> {
    let turned = |element: Element| match element {
        Element::Triangle([a, b, c]) if is_mirrored => Element::Triangle([a, c, b]),
        _ => element,
    };
    let mut segment = |ends: &[u32]| sink.push(Element::Segment([ends[0], ends[1]]));
    match mode {
        Mode::Points => corners.iter().try_for_each(|vertex| sink.push(Element::Point(*vertex))),
        Mode::Lines => corners.chunks_exact(2).try_for_each(segment),
        Mode::LineStrip => corners.windows(2).try_for_each(segment),
        Mode::LineLoop => {
            corners.windows(2).try_for_each(&mut segment)?;
            match corners {
                [first, .., last] => segment(&[*last, *first]),
                _ => Ok(()),
            }
        }
        Mode::Triangles => {
            corners.chunks_exact(3).try_for_each(|t| sink.push(turned(Element::Triangle([t[0], t[1], t[2]]))))
        }
        Mode::TriangleStrip => strip(corners).try_for_each(|triangle| sink.push(turned(triangle))),
        Mode::TriangleFan => fan(corners).try_for_each(|triangle| sink.push(turned(triangle))),
    }
}
