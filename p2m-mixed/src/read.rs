//! Reading a scene in any format.

use crate::builder::SceneBuilder;
use crate::error::ReadError;
use crate::formats::Format;
use crate::open::open;
use crate::parse::blocks::{BLOCK_BYTES, Source};
use crate::scene::Scene;
use std::io::BufRead;
use std::path::Path;

/// Reads a scene from a file. Its extension, in any case, is the name of its [`Format`].
///
/// # Errors
/// [`ReadError`] has the file, the location and the reason. No scene is returned for a file with an error.
pub fn read_scene(path: &Path) -> Result<Scene, ReadError> {
    let format = Format::from_path(path)?;
    let name = path.display().to_string();
    read_scene_from(open(path, &name)?, format, &name)
}

/// Reads a scene from any reader, such as the standard input. `name` is the name of the file in messages.
///
/// The file is read once from its start to its end. That takes at most three times the memory of the finished scene,
/// whatever the file announces, besides small buffers and the longest line of a text. The file of a saved index is in
/// memory in addition.
///
/// ```
/// use p2m_mixed::{Format, read_scene_from};
///
/// let scene = read_scene_from("OFF 3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".as_bytes(), Format::Off, "standard input")?;
/// assert_eq!(scene.soup.triangles(), [[0, 1, 2]]);
/// # Ok::<(), p2m_mixed::ReadError>(())
/// ```
///
/// # Errors
/// The errors are those of [`read_scene`].
pub fn read_scene_from(reader: impl BufRead, format: Format, name: &str) -> Result<Scene, ReadError> {
    read_scene_in_blocks(reader, format, name, BLOCK_BYTES)
}

/// Reads a scene in blocks of about this number of bytes, or sequentially if it is 0. The result is the same.
///
/// # Errors
/// The errors are those of [`read_scene`].
pub fn read_scene_in_blocks(
    reader: impl BufRead,
    format: Format,
    name: &str,
    block_bytes: usize,
) -> Result<Scene, ReadError> {
    format.read(Source::with_block_bytes(reader, block_bytes), name, SceneBuilder::default())
}
