//! The writer divides a scene that may be larger than memory, so it keeps only one shard in memory.
//!
//! Primitives are written to a temporary file as they come. At the end that file is divided by space into parts, large
//! parts are divided again, and the index of each part is built and saved by itself. Temporary files are in the folder
//! of the shards and take 88 bytes per primitive, and twice that while a file is divided. While a file of a scene
//! is read, vertices that do not fit into the memory for them are in another temporary file, which takes at most 24
//! bytes per vertex of that file.
//!
//! Each run of a writer creates files under names of its own. The manifest gets its name when all shards are written,
//! and only then are the files of an index that is replaced removed. So an index that is in the folder is complete at
//! any time, because its manifest appears last.

mod names;
mod partition;
mod spill;

use crate::manifest::{MANIFEST_FILE, Manifest, ObjectEntry, ShardEntry};
use crate::shard::IDS;
use crate::{ShardError, ShardedIndex};
use hashbrown::HashTable;
use nalgebra::Point3;
pub use names::shard_file;
use names::{begin_run, files_of_runs, run_of, unfinished_manifest};
use p2m_backends::{BackendEntry, BuildSettings};
use p2m_core::storage::Writer;
use p2m_core::{BuildError, Element, PrimitiveId, PrimitiveSet, Shape, Soup};
use p2m_field::sign::{EdgeSums, SignRule};
use p2m_mixed::{PieceOptions, PieceSummary, Scene, read_scene_in_pieces, save_scene};
use partition::divide;
use spill::{Record, Spill};
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use twox_hash::XxHash3_64;

/// Options of writing shards.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct ShardOptions {
    /// The largest length of the file of a shard in bytes, by default 1 GiB. Only a shard of one primitive
    /// may be longer.
    pub max_bytes: u64,
    /// The backend of the shards, by default the tree of boxes.
    pub backend: &'static BackendEntry,
    /// Whether a sharded index in the folder is replaced when the new one is complete. By default it is an error.
    pub replace: bool,
}

impl Default for ShardOptions {
    fn default() -> Self {
        Self { max_bytes: 1 << 30, backend: BackendEntry::default_backend(), replace: false }
    }
}

impl ShardOptions {
    /// Sets the largest length of the file of a shard in bytes.
    #[must_use]
    pub fn with_max_bytes(self, max_bytes: u64) -> Self {
        Self { max_bytes, ..self }
    }

    /// Sets the backend of the shards.
    #[must_use]
    pub fn with_backend(self, backend: &'static BackendEntry) -> Self {
        Self { backend, ..self }
    }

    /// Sets whether a sharded index in the folder is replaced.
    #[must_use]
    pub fn with_replace(self, replace: bool) -> Self {
        Self { replace, ..self }
    }
}

/// The length that a first division expects of a primitive in the file of a shard, in bytes besides the index.
const FILE_BYTES_PER_PRIMITIVE: f64 = 52.0;
/// The fraction of the largest length of a file that a division aims at, because parts are not equally large.
const FILL: f64 = 0.85;

/// The number of bytes of a shard that are written at a time.
const WRITE_BUFFER_BYTES: usize = 1 << 20;

/// A writer of shards. Scenes are added piece by piece, and [`finish`](Self::finish) builds the shards.
///
/// Ids count the primitives in the order in which they were added.
///
/// The writer creates files under names that no other file in the folder has, and changes no file that it has not
/// created. The index is there as soon as its manifest is, which is the last step. A writer that is dropped before
/// removes its files, and an index that was to be replaced stays. Files of programs that were killed stay until an
/// index in the folder is replaced.
///
/// Several writers may work in one folder. Of those that do not replace an index, the first one to finish succeeds. A
/// writer that finishes its replacement removes the files of others that began before it. These fail if they had
/// written shards by then.
///
/// ```
/// use p2m_core::{Point, Soup};
/// use p2m_shards::{ShardOptions, ShardWriter};
/// use nalgebra::Point3;
///
/// let folder = tempfile::tempdir()?;
/// let mut writer = ShardWriter::new(folder.path(), ShardOptions::default().with_max_bytes(4096))?;
/// for tile in 0..4 {
///     let corner = 10.0 * f64::from(tile);
///     let positions = [[corner, 0.0, 0.0], [corner + 10.0, 0.0, 0.0], [corner, 10.0, 0.0]];
///     writer.add_scene(&Soup::from_arrays(&positions, &[[0u32, 1, 2]])?.into())?;
/// }
/// let index = writer.finish()?;
/// let answer = index.closest_point(&Point3::new(21.0, 1.0, 3.0))?.expect("the scene is not empty");
/// assert_eq!((answer.id, answer.closest.distance), (2, 3.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Complexity
/// Each primitive is written O(log n) times. Besides small buffers, [`finish`](Self::finish) has one shard in memory
/// while it is built.
pub struct ShardWriter {
    folder: PathBuf,
    options: ShardOptions,
    /// The primitives, until they are divided.
    spill: Option<Spill>,
    manifest: Manifest,
    /// The sums that tell whether the surface is closed.
    edges: EdgeSums,
    /// The number of this run, with which the names of its files begin.
    run: u64,
    /// The files of this run, which are removed unless writing is finished: the files of shards in their order.
    written: Vec<PathBuf>,
    /// Whether the folder is to be removed as well, because it was not there.
    is_new_folder: bool,
}

impl ShardWriter {
    /// Begins a sharded index in a folder, which is created if it is not there.
    ///
    /// # Errors
    /// It returns [`ShardError::Exists`] if the folder has a sharded index that is not to be replaced,
    /// [`ShardError::NotSaveable`] for a backend without a saved form, and [`ShardError::Io`].
    pub fn new(folder: &Path, options: ShardOptions) -> Result<Self, ShardError> {
        if !options.backend.is_saveable() {
            return Err(ShardError::NotSaveable { backend: options.backend.name.to_owned() });
        }
        if folder.join(MANIFEST_FILE).exists() && !options.replace {
            return Err(ShardError::Exists { folder: folder.to_owned() });
        }
        let is_new_folder = !folder.exists();
        fs::create_dir_all(folder).map_err(ShardError::io(folder))?;
        let manifest = Manifest { backend: options.backend.name.to_owned(), ..Manifest::default() };
        let (folder, written) = (folder.to_owned(), Vec::new());
        let edges = EdgeSums::default();
        let mut writer = Self { folder, options, spill: None, manifest, edges, run: 0, written, is_new_folder };
        // An error from here on drops the writer, which removes the files that it has created.
        writer.run = begin_run(&writer.folder).map_err(ShardError::io(&writer.folder))?;
        writer.written.push(writer.folder.join(shard_file(writer.run, 0)));
        writer.spill = Some(Spill::new(&writer.folder).map_err(ShardError::io(&writer.folder))?);
        Ok(writer)
    }

    /// Returns the number of this run, which is in the names of its files ([`shard_file`]).
    #[must_use]
    pub fn run(&self) -> u64 {
        self.run
    }

    /// Adds the primitives of a scene after those that were added before. An object that continues the last one, by its
    /// name and its ids, becomes a part of it.
    ///
    /// # Errors
    /// It returns [`ShardError::Io`] if the temporary file cannot be written.
    pub fn add_scene(&mut self, scene: &Scene) -> Result<(), ShardError> {
        let first = self.manifest.primitive_count();
        for object in &scene.objects {
            let (start, len) = (first + object.ids.start as u64, object.ids.len() as u64);
            match self.manifest.objects.last_mut() {
                Some(last) if last.name == object.name && last.first + last.primitives == start => {
                    last.primitives += len;
                }
                _ => {
                    self.manifest.objects.push(ObjectEntry { name: object.name.clone(), first: start, primitives: len })
                }
            }
        }
        let soup = &scene.soup;
        for (number, source) in (0..soup.len()).zip(scene.sources.iter().copied()) {
            self.add(first + number as u64, source, soup.get(PrimitiveId::new(number)))?;
        }
        Ok(())
    }

    /// Adds the primitives of a file, which may be larger than the memory, after those that were added before. It is
    /// [read in pieces](read_scene_in_pieces), with a temporary file in the folder of the shards unless `options` name
    /// another one. A piece has at most the primitives of a full shard, and the vertices besides it at most the bytes
    /// of one. The id of a primitive is its id in the scene of [`read_scene`](p2m_mixed::read_scene) plus the number of
    /// primitives that were added before, and objects are the objects of that scene.
    ///
    /// # Errors
    /// It returns [`ShardError::Scene`] if the file cannot be read, and [`ShardError::Io`] if the temporary file of
    /// primitives cannot be written. The primitives before the error have been added then.
    pub fn add_file(&mut self, path: &Path, options: &PieceOptions) -> Result<PieceSummary, ShardError> {
        let mut options = options.clone();
        options.folder.get_or_insert_with(|| self.folder.clone());
        let to_usize = |count| usize::try_from(count).unwrap_or(usize::MAX);
        let max_bytes = self.options.max_bytes;
        options.max_primitives = options.max_primitives.min(to_usize(capacity(max_bytes, 1.0, self.file_bytes())));
        options.max_position_bytes = options.max_position_bytes.min(to_usize(max_bytes));
        read_scene_in_pieces(path, &options, &mut |piece| self.add_scene(&piece))
    }

    /// Returns the number of primitives that were added.
    #[must_use]
    pub fn primitive_count(&self) -> u64 {
        self.manifest.primitive_count()
    }

    /// Returns the number of bytes that a primitive is expected to take in the file of a shard.
    fn file_bytes(&self) -> f64 {
        self.options.backend.costs[0].bytes + FILE_BYTES_PER_PRIMITIVE
    }

    fn add(&mut self, id: u64, source: u32, shape: Shape<f64>) -> Result<(), ShardError> {
        let mut record = Record { id, source, len: 0, vertices: [[0.0; 3]; 3] };
        for (place, vertex) in record.vertices.iter_mut().zip(p2m_core::Primitive::vertices(&shape)) {
            *place = vertex.coords.into();
            record.len += 1;
        }
        *match record.len {
            1 => &mut self.manifest.points,
            2 => &mut self.manifest.segments,
            _ => &mut self.manifest.triangles,
        } += 1;
        if record.len == 3 {
            self.edges.add(record.vertices);
        }
        let spill = self.spill.as_mut().ok_or(ShardError::Cancelled)?;
        spill.push(&record).map_err(ShardError::io(&self.folder))
    }

    /// Builds the shards, and returns the index that they make up.
    ///
    /// # Errors
    /// It returns [`ShardError::Io`], which includes that another writer has removed the files of this one,
    /// [`ShardError::Exists`] if the folder has got a sharded index that is not to be replaced, and
    /// [`ShardError::Build`] for a shard of more than 2^30 primitives.
    pub fn finish(self) -> Result<ShardedIndex, ShardError> {
        self.finish_with_progress(&mut |_| ControlFlow::Continue(()))
    }

    /// Builds the shards, and calls `progress` with the number of primitives that are in finished shards, after each.
    /// Breaking cancels the work.
    ///
    /// # Errors
    /// It returns the errors of [`finish`](Self::finish), and [`ShardError::Cancelled`].
    pub fn finish_with_progress(
        mut self,
        progress: &mut dyn FnMut(u64) -> ControlFlow<()>,
    ) -> Result<ShardedIndex, ShardError> {
        let rule = self.edges.rule();
        self.manifest.is_closed = rule.is_some();
        self.manifest.is_oriented = rule == Some(SignRule::Winding);
        let expected = self.file_bytes();
        let mut parts: Vec<Spill> = self.spill.take().into_iter().filter(|spill| spill.len() > 0).collect();
        let (mut done, mut bytes_per_primitive, max_bytes) = (0, expected, self.options.max_bytes);
        while let Some(mut part) = parts.pop() {
            let len = part.len();
            if len <= capacity(max_bytes, 1.0, bytes_per_primitive) || len == 1 {
                let entry = self.write_shard(&mut part)?;
                #[allow(clippy::cast_precision_loss, reason = "an estimate")]
                let found = entry.bytes as f64 / len as f64;
                if entry.bytes <= max_bytes || len == 1 {
                    done += len;
                    self.manifest.shards.push(entry);
                    if progress(done).is_break() {
                        return Err(ShardError::Cancelled);
                    }
                    continue;
                }
                bytes_per_primitive = bytes_per_primitive.max(found);
            }
            let capacity = capacity(max_bytes, FILL, bytes_per_primitive);
            let divided = divide(part, capacity, &self.folder).map_err(ShardError::io(&self.folder))?;
            // The last part is pushed first, so that shards are numbered along the tree.
            parts.extend(divided.into_iter().rev());
        }
        self.publish()?;
        ShardedIndex::open(&self.folder)
    }

    /// Builds the index of a part and writes its file, whose name is the next one.
    fn write_shard(&mut self, part: &mut Spill) -> Result<ShardEntry, ShardError> {
        let (scene, ids) = scene_of(part).map_err(ShardError::io(&self.folder))?;
        let scene = scene?;
        let built = self.options.backend.build(Arc::clone(&scene.soup), &BuildSettings::default())?;
        let file = shard_file(self.run, self.manifest.shards.len());
        let path = self.folder.join(&file);
        // The file exists if it is the first one, or if it was too long and its part was divided.
        let is_new = self.written.last() != Some(&path);
        let mut writer = Writer::default();
        save_scene(&scene, &mut writer);
        built.save(&mut writer);
        writer.put(IDS, &ids);
        let checksum = format!("{:016x}", writer.checksum());
        let mut write = || {
            let out = if is_new { File::create_new(&path)? } else { File::create(&path)? };
            if is_new {
                self.written.push(path.clone());
            }
            writer.write(BufWriter::with_capacity(WRITE_BUFFER_BYTES, &out))?;
            Ok(out.metadata()?.len())
        };
        let bytes = write().map_err(ShardError::io(&path))?;
        let bounds = scene.soup.aabb();
        let (min, max) = (bounds.min.coords.into(), bounds.max.coords.into());
        Ok(ShardEntry { file, bytes, checksum, primitives: part.len(), min, max })
    }

    /// Makes the shards the index of the folder, and removes those that they replace. Programs that have mapped the
    /// removed files are not disturbed.
    fn publish(&mut self) -> Result<(), ShardError> {
        // A replacement that has finished meanwhile has removed the files of this run.
        for path in self.manifest.shards.iter().map(|shard| self.folder.join(&shard.file)) {
            fs::metadata(&path).map_err(ShardError::io(&path))?;
        }
        // Files that an unreadable manifest names are not known.
        let replaced = Manifest::read(&self.folder).map(|manifest| manifest.shards).unwrap_or_default();
        let unfinished = self.folder.join(unfinished_manifest(self.run));
        self.written.push(unfinished.clone());
        self.manifest.write(&unfinished, &self.folder, self.options.replace)?;
        // The first file was created before the scene was known, and an empty scene has no shard for it.
        for path in self.written.drain(..).skip(self.manifest.shards.len()) {
            let _ = fs::remove_file(path);
        }
        self.is_new_folder = false;
        if self.options.replace {
            let left = files_of_runs(&self.folder).unwrap_or_default().into_iter().filter(|(run, _)| *run < self.run);
            let left = replaced.into_iter().map(|shard| shard.file).chain(left.map(|(_, file)| file));
            for file in left.filter(|file| run_of(file) != Some(self.run)) {
                // A file that cannot be removed stays until the next replacement.
                let _ = fs::remove_file(self.folder.join(file));
            }
        }
        Ok(())
    }
}

impl Drop for ShardWriter {
    fn drop(&mut self) {
        // A file that cannot be removed stays.
        for path in self.written.iter().rev() {
            let _ = fs::remove_file(path);
        }
        if self.is_new_folder {
            let _ = fs::remove_dir(&self.folder);
        }
    }
}

/// Returns how many primitives are expected to fill a part of the largest length of a file.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "an estimate of a count"
)]
fn capacity(max_bytes: u64, fill: f64, bytes_per_primitive: f64) -> u64 {
    ((fill * max_bytes as f64 / bytes_per_primitive) as u64).max(1)
}

/// Returns the scene of a part and the ids of its primitives. Equal vertices become one, with the same bits.
fn scene_of(part: &mut Spill) -> io::Result<(Result<Scene, BuildError>, Vec<u64>)> {
    let mut soup = Soup::<f64>::default();
    let (mut sources, mut ids) = (Vec::new(), Vec::new());
    let (mut vertices, mut pushed) = (HashTable::<u32>::new(), Ok(()));
    part.for_each(|record| {
        let mut corners = [0; 3];
        for (corner, vertex) in corners.iter_mut().zip(record.vertices()) {
            *corner = weld(&mut soup, &mut vertices, vertex);
        }
        let element = match record.vertices().len() {
            1 => Element::Point(corners[0]),
            2 => Element::Segment([corners[0], corners[1]]),
            _ => Element::Triangle(corners),
        };
        if pushed.is_ok() {
            pushed = soup.push(element).map(|_| ());
        }
        sources.push(record.source);
        ids.push(record.id);
        Ok(())
    })?;
    drop(vertices);
    soup.shrink_to_fit();
    let mut scene = Scene::from(soup);
    scene.sources = sources;
    Ok((pushed.map(|()| scene), ids))
}

/// Returns the index of a position with these bits, which is added if there is none.
#[allow(clippy::cast_possible_truncation, reason = "a part of 2^30 primitives has fewer than 2^32 vertices")]
fn weld(soup: &mut Soup<f64>, vertices: &mut HashTable<u32>, vertex: &[f64; 3]) -> u32 {
    let bits = |p: &[f64; 3]| p.map(f64::to_bits);
    let hash = |p: &[f64; 3]| XxHash3_64::oneshot(bytemuck::bytes_of(p));
    let position = |soup: &Soup<f64>, number: u32| -> [f64; 3] { soup.positions()[number as usize].coords.into() };
    if let Some(found) = vertices.find(hash(vertex), |other| bits(&position(soup, *other)) == bits(vertex)) {
        return *found;
    }
    let number = soup.push_position(Point3::from(*vertex)) as u32;
    vertices.insert_unique(hash(vertex), number, |other| hash(&position(soup, *other)));
    number
}
