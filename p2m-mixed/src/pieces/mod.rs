//! Reading a scene file piece by piece, for scenes larger than the memory.

mod positions;
pub(crate) mod state;

use crate::builder::SceneBuilder;
use crate::error::ReadError;
use crate::formats::Format;
use crate::open::open;
use crate::parse::blocks::Source;
use crate::scene::{Scene, Skipped};
use p2m_core::{PrimitiveId, PrimitiveSet};
use positions::PositionStore;
use state::Pieces;
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
/// is a [`Reason::Io`](crate::Reason::Io). An error of `visit` ends reading and is returned.
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
