//! Reading a scene file piece by piece, for scenes larger than the memory.

mod positions;

use crate::builder::SceneBuilder;
use crate::error::{ReadError, Reason};
use crate::formats::Format;
use crate::open::open;
use crate::parse::blocks::Source;
use crate::scene::{Scene, Skipped};
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use nalgebra::Point3;
use p2m_core::{PrimitiveId, PrimitiveSet, Soup};
use positions::PositionStore;
use std::fs::File;
use std::hash::{BuildHasher, RandomState};
use std::io::{self, BufReader};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Options of reading a scene in pieces.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct PieceOptions {
    /// The largest number of primitives of a piece, by default 2^20. At least one and at most 2^30 is taken.
    pub max_primitives: usize,
    /// The largest number of bytes of vertices in memory besides those of the current piece, by default 256 MiB. Other
    /// vertices are in a temporary file. At least 192 KiB is taken.
    pub max_position_bytes: usize,
    /// The folder of the temporary file, by default that of the system for such files.
    pub folder: Option<PathBuf>,
}

impl Default for PieceOptions {
    fn default() -> Self {
        Self { max_primitives: 1 << 20, max_position_bytes: 1 << 28, folder: None }
    }
}

impl PieceOptions {
    /// Sets the largest number of primitives of a piece.
    #[must_use]
    pub fn with_max_primitives(self, max_primitives: usize) -> Self {
        Self { max_primitives, ..self }
    }

    /// Sets the largest number of bytes of vertices in memory besides those of the current piece.
    #[must_use]
    pub fn with_max_position_bytes(self, max_position_bytes: usize) -> Self {
        Self { max_position_bytes, ..self }
    }

    /// Sets the folder of the temporary file.
    #[must_use]
    pub fn with_folder(self, folder: impl Into<PathBuf>) -> Self {
        Self { folder: Some(folder.into()), ..self }
    }

    /// Returns the number of primitives of a full piece.
    fn piece_len(&self) -> usize {
        self.max_primitives.clamp(1, PrimitiveId::MAX_COUNT)
    }
}

/// The summary of a file that was read in pieces.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PieceSummary {
    /// The number of primitives of all pieces.
    pub primitive_count: u64,
    /// The number of pieces.
    pub piece_count: u64,
    /// The records that the reader left out, as in [`Scene::skipped`].
    pub skipped: Vec<Skipped>,
}

/// Reads a scene from a file and passes it to `visit` in pieces, so that a scene larger than the memory can be read.
///
/// The pieces, one after the other, have the primitives of [`read_scene`](crate::read_scene) in the same order: the id
/// of a primitive in that scene is its id in its piece plus the number of primitives in the pieces before. Their
/// [sources](Scene::sources) are the same, and so are the bits of their positions, except that a zero in an STL file
/// keeps its own sign instead of that of an equal corner in an earlier piece.
///
/// Each piece has its own vertices, those that its primitives use, in the order of their first use. An object that
/// continues in the next piece is in both pieces under the same name. All pieces but the last one are full. A scene
/// without primitives has no piece. [`Scene::skipped`] is empty, because [`PieceSummary::skipped`] has these records.
///
/// ```
/// use p2m_core::PrimitiveSet;
/// use p2m_mixed::{PieceOptions, ReadError, read_scene_in_pieces};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("strip.obj");
/// std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\no strip\nf 1 2 3\nf 2 4 3\nl 1 4\n")?;
/// let mut lengths = Vec::new();
/// let options = PieceOptions::default().with_max_primitives(2);
/// read_scene_in_pieces(&path, &options, &mut |piece| {
///     assert_eq!(piece.objects[0].name, "strip");
///     lengths.push((piece.soup.len(), piece.soup.positions().len()));
///     Ok::<(), ReadError>(())
/// })?;
/// assert_eq!(lengths, [(2, 4), (1, 2)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The errors are those of [`read_scene`](crate::read_scene), with the same locations and reasons, except that only a
/// piece is limited to 2^30 primitives. Pieces before the error have been visited then. An error of the temporary file
/// is a [`Reason::Io`]. An error of `visit` ends reading and is returned.
///
/// # Complexity
/// Time is that of [`read_scene`](crate::read_scene), and each vertex that is not in memory when it is used takes the
/// time of reading 96 KiB. Memory is that of two pieces and [`PieceOptions::max_position_bytes`], besides small buffers
/// and the longest line of a text. There are some exceptions:
///
/// - A face of an OBJ file that refers to a later vertex, and all faces after it, stay in memory up to the end, with 4
///   bytes for each corner and 40 for each face.
/// - The faces of a PLY file stay in memory up to the vertices if they come first, and up to the end if they have ids
///   (`p2m_id`), with 4 bytes for each corner and id.
/// - Vertices of a PLY file that are not finite take 24 bytes, unless the file is a point cloud.
/// - A `.p2m` file is read as a whole.
///
/// An OBJ file with statements `g` before its first `o`, or without any `o`, is read twice, because groups are objects
/// only if there is no `o`. The groups of a pipe, which cannot be read twice, are objects up to its first `o`.
pub fn read_scene_in_pieces<E: From<ReadError>>(
    path: &Path,
    options: &PieceOptions,
    visit: &mut dyn FnMut(Scene) -> Result<(), E>,
) -> Result<PieceSummary, E> {
    let format = Format::from_path(path).map_err(ReadError::from)?;
    let name = path.display().to_string();
    let reader = open(path, &name)?;
    let mut summary = PieceSummary::default();
    let mut error = None;
    let mut send = |piece: Scene| {
        summary.primitive_count += piece.soup.len() as u64;
        summary.piece_count += 1;
        match visit(piece) {
            Ok(()) => ControlFlow::Continue(()),
            Err(stop) => {
                error = Some(stop);
                ControlFlow::Break(())
            }
        }
    };
    let store = PositionStore::new(options.max_position_bytes, options.folder.clone());
    let builder = SceneBuilder::in_pieces(Pieces::new(options.piece_len(), path, store, &mut send));
    let last = format.read(Source::new(reader), &name, builder);
    let mut last = match (last, error.take()) {
        (_, Some(error)) => return Err(error),
        (last, None) => last?,
    };
    summary.skipped = std::mem::take(&mut last.skipped);
    if !last.soup.is_empty() {
        summary.primitive_count += last.soup.len() as u64;
        summary.piece_count += 1;
        visit(last)?;
    }
    Ok(summary)
}

/// A function that takes a full piece and returns whether reading goes on.
type Visitor<'a> = dyn FnMut(Scene) -> ControlFlow<()> + 'a;

/// The positions of vertices that primitives may use.
enum Positions {
    /// The vertices of the file.
    OfFile(PositionStore),
    /// The vertices since the last call of [`Pieces::forget_old_vertices`].
    OfPiece(Vec<Point3<f64>>),
}

/// The state of a builder of pieces.
pub(crate) struct Pieces<'a> {
    max_primitives: usize,
    path: &'a Path,
    positions: Positions,
    indices: IndexTable,
    visitor: &'a mut Visitor<'a>,
    /// Whether a piece has ended since the last call of [`Pieces::forget_old_vertices`].
    has_ended: bool,
}

impl<'a> Pieces<'a> {
    fn new(max_primitives: usize, path: &'a Path, store: PositionStore, visitor: &'a mut Visitor<'a>) -> Self {
        let (positions, indices) = (Positions::OfFile(store), IndexTable::default());
        Self { max_primitives, path, positions, indices, visitor, has_ended: false }
    }

    /// Keeps only the vertices of the current piece, and these in memory.
    pub(crate) fn keep_vertices_of_pieces(&mut self) {
        self.positions = Positions::OfPiece(Vec::new());
    }

    /// Opens the file another time, unless it is a pipe or cannot be opened.
    pub(crate) fn open_again(&self) -> Option<BufReader<File>> {
        let is_file = self.path.metadata().is_ok_and(|m| m.is_file());
        is_file.then(|| open(self.path, "").ok()).flatten()
    }

    /// Returns the number of primitives of a full piece.
    pub(crate) fn max_primitives(&self) -> usize {
        self.max_primitives
    }

    /// Returns the number of vertices that primitives may use.
    pub(crate) fn vertex_count(&self) -> usize {
        match &self.positions {
            Positions::OfFile(store) => store.len(),
            Positions::OfPiece(positions) => positions.len(),
        }
    }

    /// Returns the vertices that are kept in memory for each piece. Those of a file are not among them.
    pub(crate) fn resident_positions(&self) -> &[Point3<f64>] {
        match &self.positions {
            Positions::OfFile(_) => &[],
            Positions::OfPiece(positions) => positions,
        }
    }

    pub(crate) fn push_position(&mut self, position: Point3<f64>) -> Result<(), Reason> {
        match &mut self.positions {
            Positions::OfFile(store) => store.push(position).map_err(temporary_file_error),
            Positions::OfPiece(positions) => {
                positions.push(position);
                Ok(())
            }
        }
    }

    /// Returns the position of a vertex, which has to be in range.
    pub(crate) fn position(&mut self, vertex: u32) -> Result<Point3<f64>, Reason> {
        match &mut self.positions {
            Positions::OfFile(store) => store.get(vertex as usize).map_err(temporary_file_error),
            Positions::OfPiece(positions) => Ok(positions[vertex as usize]),
        }
    }

    /// Returns the index of a vertex in the soup of the current piece, to which it is added if it is not there.
    pub(crate) fn index(&mut self, vertex: u32, soup: &mut Soup<f64>) -> Result<u32, Reason> {
        let next = u32::try_from(soup.positions().len()).expect("at most three vertices for each of 2^30 primitives");
        let index = self.indices.get_or_insert(vertex, next);
        if index == next {
            soup.push_position(self.position(vertex)?);
        }
        Ok(index)
    }

    /// Passes a full piece to the visitor.
    pub(crate) fn visit(&mut self, piece: Scene) -> Result<(), Reason> {
        self.indices.clear();
        self.has_ended = true;
        match (self.visitor)(piece) {
            ControlFlow::Continue(()) => Ok(()),
            // The caller returns the error of the visitor instead.
            ControlFlow::Break(()) => Err(Reason::Io(io::ErrorKind::Interrupted.into())),
        }
    }

    /// Removes the vertices if a piece has ended since the last call, and returns whether it did.
    pub(crate) fn forget_old_vertices(&mut self) -> bool {
        let has_ended = std::mem::take(&mut self.has_ended);
        if let Positions::OfPiece(positions) = &mut self.positions
            && has_ended
        {
            positions.clear();
            self.indices.clear();
        }
        has_ended
    }
}

fn temporary_file_error(error: io::Error) -> Reason {
    Reason::Io(io::Error::new(error.kind(), format!("the temporary file of vertices: {error}")))
}

/// The index in a piece of each vertex that it uses.
struct IndexTable {
    /// Vertices and their indices.
    table: HashTable<(u32, u32)>,
    /// A random number, so that no file has vertices whose hashes are known to be equal.
    seed: u64,
}

impl Default for IndexTable {
    fn default() -> Self {
        Self { table: HashTable::new(), seed: RandomState::new().hash_one(0) }
    }
}

impl IndexTable {
    fn clear(&mut self) {
        self.table.clear();
    }

    /// Returns the index of a vertex, which is `next` if it has none yet.
    fn get_or_insert(&mut self, vertex: u32, next: u32) -> u32 {
        let seed = self.seed;
        let hash = |vertex: u32| hash(vertex, seed);
        match self.table.entry(hash(vertex), |&(other, _)| other == vertex, |&(other, _)| hash(other)) {
            Entry::Occupied(entry) => entry.get().1,
            Entry::Vacant(entry) => entry.insert((vertex, next)).get().1,
        }
    }
}

/// Returns both halves of a product of 128 bits, folded.
#[allow(clippy::cast_possible_truncation, reason = "the halves of the product are meant")]
fn hash(vertex: u32, seed: u64) -> u64 {
    let product = u128::from(u64::from(vertex) ^ seed) * 0x9e37_79b9_7f4a_7c15;
    product as u64 ^ (product >> 64) as u64
}
