//! The manifest: the file that lists the shards of an index, with the facts that queries need about shards that are not
//! loaded.

use crate::ShardError;
use p2m_core::Aabb;
use p2m_field::sign::SignRule;
use p2m_mixed::Object;
use p2m_mixed::statistics::Counts;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::{fs, io};
use tempfile::TempPath;
use twox_hash::XxHash3_64;

/// The name of the manifest in the folder of its shards.
pub const MANIFEST_FILE: &str = "manifest.json";
/// The value of `format` in a manifest.
const FORMAT: &str = "p2m-shards";
/// The version of the manifest that this library writes and reads.
const VERSION: u32 = 2;

/// The description of a sharded index.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Manifest {
    /// The name of the backend of all shards.
    pub backend: String,
    /// The number of triangles of the whole scene.
    pub triangles: u64,
    /// The number of segments of the whole scene.
    pub segments: u64,
    /// The number of points of the whole scene.
    pub points: u64,
    /// Whether each edge of the triangles has an even number of triangles.
    pub is_closed: bool,
    /// Whether as many triangles run through each edge in one direction as in the other.
    pub is_oriented: bool,
    /// The shards.
    pub shards: Vec<ShardEntry>,
    /// The named parts of the whole scene, in ascending order of ids.
    pub objects: Vec<ObjectEntry>,
}

/// The description of a shard in the manifest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ShardEntry {
    /// The name of the file in the folder of the manifest.
    pub file: String,
    /// The length of the file in bytes.
    pub bytes: u64,
    /// The XXH3 checksum of the table of the file in hexadecimal digits, which stands for the whole content.
    pub checksum: String,
    /// The number of primitives.
    pub primitives: u64,
    /// The least coordinates of the primitives.
    pub min: [f64; 3],
    /// The largest coordinates of the primitives.
    pub max: [f64; 3],
}

/// A named part of the scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ObjectEntry {
    /// The name.
    pub name: String,
    /// The id of the first primitive.
    pub first: u64,
    /// The number of primitives, whose ids are consecutive.
    pub primitives: u64,
}

/// The content of the file.
#[derive(Serialize, Deserialize)]
struct Document<M> {
    format: String,
    version: u32,
    /// The XXH3 checksum of the manifest in JSON without white space, in hexadecimal digits.
    checksum: String,
    manifest: M,
}

impl ShardEntry {
    /// Returns the box of the primitives.
    #[must_use]
    pub fn bounds(&self) -> Aabb<f64> {
        Aabb { min: self.min.into(), max: self.max.into() }
    }
}

impl Manifest {
    /// Returns the number of primitives of the whole scene. Their ids are the numbers below it.
    #[must_use]
    pub fn primitive_count(&self) -> u64 {
        self.counts().total()
    }

    /// Returns the number of primitives by their kind.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        (counts.triangles, counts.segments, counts.points) = (self.triangles, self.segments, self.points);
        counts
    }

    /// Returns the rule that decides which points are inside, or `None` if the surface is open or the scene has
    /// segments or points.
    #[must_use]
    pub fn sign_rule(&self) -> Option<SignRule> {
        match (self.segments + self.points, self.is_oriented, self.is_closed) {
            (0, true, _) => Some(SignRule::Winding),
            (0, false, true) => Some(SignRule::Parity),
            _ => None,
        }
    }

    /// Returns the box of the whole scene, which is empty if the scene is.
    #[must_use]
    pub fn bounds(&self) -> Aabb<f64> {
        self.shards.iter().fold(Aabb::empty(), |all, shard| all.union(&shard.bounds()))
    }

    /// Returns the objects in the form in which a [`Scene`](p2m_mixed::Scene) describes them.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "ids of a scene fit into usize where its shards can be used")]
    pub fn objects(&self) -> Vec<Object> {
        let object = |object: &ObjectEntry| {
            let first = object.first as usize;
            Object { name: object.name.clone(), ids: first..first + object.primitives as usize }
        };
        self.objects.iter().map(object).collect()
    }

    /// Reads the manifest of a folder.
    ///
    /// # Errors
    /// It returns [`ShardError::Io`] if there is none, and [`ShardError::Manifest`] if it is not the manifest of a
    /// sharded index, has another version, was changed after it was written, or contradicts itself.
    pub fn read(folder: &Path) -> Result<Self, ShardError> {
        let file = folder.join(MANIFEST_FILE);
        let text = fs::read_to_string(&file).map_err(ShardError::io(&file))?;
        let fail = |reason: String| ShardError::Manifest { file: file.clone(), reason };
        // The version is looked at first, because another one may have other members.
        let document: Document<serde_json::Value> = serde_json::from_str(&text)
            .map_err(|error| fail(format!("this is not the manifest of a sharded index: {error}")))?;
        if document.format != FORMAT {
            return Err(fail("this is not the manifest of a sharded index".to_owned()));
        }
        if document.version != VERSION {
            let found = document.version;
            return Err(fail(format!("the manifest has version {found}, but this program reads version {VERSION}")));
        }
        let manifest: Self = serde_json::from_value(document.manifest)
            .map_err(|error| fail(format!("the manifest is damaged: {error}")))?;
        if manifest.checksum() != document.checksum {
            return Err(fail("the manifest is damaged: its checksum is wrong".to_owned()));
        }
        match manifest.contradiction() {
            Some(reason) => Err(fail(format!("the manifest contradicts itself: {reason}"))),
            None => Ok(manifest),
        }
    }

    /// Writes the manifest to the file `unfinished`, and makes that the manifest of a folder when it is complete. Only
    /// with `replace` may there be another one.
    pub(crate) fn write(&self, unfinished: &Path, folder: &Path, replace: bool) -> Result<(), ShardError> {
        let document =
            Document { format: FORMAT.to_owned(), version: VERSION, checksum: self.checksum(), manifest: self };
        let file = folder.join(MANIFEST_FILE);
        let text = serde_json::to_string_pretty(&document).map_err(|error| ShardError::io(&file)(error.into()))?;
        fs::write(unfinished, text + "\n").map_err(ShardError::io(unfinished))?;
        if replace {
            return fs::rename(unfinished, &file).map_err(ShardError::io(file));
        }
        let renamed = TempPath::try_from_path(unfinished).and_then(|path| Ok(path.persist_noclobber(&file)?));
        renamed.map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => ShardError::Exists { folder: folder.to_owned() },
            _ => ShardError::io(&file)(error),
        })
    }

    /// Returns the checksum of the manifest, which is in its file as well. It is the XXH3 checksum of the manifest in
    /// JSON without white space, in hexadecimal digits.
    #[must_use]
    pub fn checksum(&self) -> String {
        // Numbers in JSON are the shortest that read back the same, so the text does not depend on the file.
        let text = serde_json::to_string(self).unwrap_or_default();
        format!("{:016x}", XxHash3_64::oneshot(text.as_bytes()))
    }

    /// Returns the first contradiction in the manifest, if there is one.
    fn contradiction(&self) -> Option<&'static str> {
        let total = self.shards.iter().try_fold(0u64, |sum, shard| sum.checked_add(shard.primitives));
        let is_name = |file: &str| {
            let path = Path::new(file);
            path.file_name().is_some_and(|name| name == file) && !file.contains(char::is_control)
        };
        let has_file_twice = || {
            // The ids of primitives are part of a file, so no two have the same content.
            let mut files = HashSet::new();
            self.shards.iter().flat_map(|shard| [&shard.file, &shard.checksum]).any(|part| !files.insert(part))
        };
        let is_in_scene = |object: &ObjectEntry| {
            object.first.checked_add(object.primitives).is_some_and(|end| total.is_some_and(|total| end <= total))
        };
        if total != self.triangles.checked_add(self.segments).and_then(|sum| sum.checked_add(self.points)) {
            Some("the shards have another number of primitives")
        } else if self.shards.iter().any(|shard| shard.bounds().is_empty() || !shard.bounds().is_finite()) {
            Some("the box of a shard is empty or not finite")
        } else if !self.shards.iter().all(|shard| is_name(&shard.file)) {
            Some("the file of a shard is not in its folder")
        } else if has_file_twice() {
            Some("the file of a shard is there twice")
        } else if !self.objects.iter().all(is_in_scene) {
            Some("an object has primitives that the scene does not have")
        } else {
            None
        }
    }
}

/// Returns the folder of a sharded index, given that folder or its manifest. It returns nothing for any other path.
#[must_use]
pub fn folder_of(path: &Path) -> Option<PathBuf> {
    if path.is_dir() {
        return path.join(MANIFEST_FILE).is_file().then(|| path.to_owned());
    }
    let is_manifest = path.file_name().is_some_and(|name| name == MANIFEST_FILE);
    is_manifest.then(|| path.parent().map_or_else(PathBuf::new, Path::to_owned))
}
