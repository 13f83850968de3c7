//! Files of built indexes.
//!
//! A file is a head, a table of *sections* and the sections, each an array of plain numbers as it stands in memory:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `89 P2M \r\n 1A \n`, hexadecimal but for the letters: a transfer as text breaks it |
//! | 4 | the version of the format, [`VERSION`] |
//! | 4 | how many sections there are |
//! | 8 | the length of the file |
//! | 8 | XXH3 of the table |
//! | 32 | free, zero |
//! | 64 each | the table: name (32 bytes, filled up with zeros), offset, number of elements, bytes of an element, XXH3 of the section (8 each) |
//!
//! All numbers are little-endian. Sections begin at multiples of 64 bytes, so a file in memory is used where it is: an
//! index has its arrays there, and nothing is copied or converted but what is small. [`SavedFile::open`] maps a file,
//! which several processes then share; [`SavedFile::read`] copies it. [`SavedFile::checked`] looks at all sums.
//!
//! Sums tell damage, not malice: whoever makes a file on purpose can make one that gives wrong answers, panics, or searches
//! without end.
//! Nothing that is read is undefined for any bytes, but for a mapped file that changes.
//!
//! ```
//! use nalgebra::Point3;
//! use p2m_bvh::AabbTree;
//! use p2m_core::storage::{SavedFile, Writer};
//! use p2m_core::{BuildIndex, ClosestPoint, Point};
//!
//! // Of the type of an index that can be saved: AabbTree, KdopTree, OctreeIndex or P2mIndex.
//! type Index<'a> = AabbTree<f64, &'a [Point<f64>]>;
//!
//! let scene = [1.0, 5.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)));
//! let index = Index::build(&scene, &Default::default())?;
//! let mut file = Vec::new(); // or a File
//! let mut writer = Writer::default();
//! index.save(&mut writer);
//! writer.write(&mut file)?;
//!
//! // Later, over the same scene: it is not in the file, unless `p2m_mixed::save_scene` put it there.
//! let file = SavedFile::read(&file[..])?; // or SavedFile::open, for a path
//! let index = Index::load(&scene, file.checked()?)?;
//! assert_eq!(index.closest_point(&Point3::new(4.0, 0.0, 0.0)).unwrap().distance, 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod array;
mod file;
mod index;
mod sections;

pub use array::Array;
pub use file::SavedFile;
pub use index::{Saved, kind, load, save};
pub use sections::{Reader, Writer};

/// The version of the format that is written, and the only one that is read.
pub const VERSION: u32 = 1;

/// Why a file is no saved index, or not the one that is wanted.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// It cannot be opened or read.
    #[error("cannot be read")]
    Io(#[from] std::io::Error),
    /// It does not begin as such files do.
    #[error("is not a saved index")]
    Foreign,
    /// It was written by another version of the format.
    #[error("has version {found} of the format, but this program reads version {VERSION}")]
    Version {
        /// The version that it has.
        found: u32,
    },
    /// It ends too early or too late.
    #[error("has {found} bytes instead of {expected}")]
    Length {
        /// The bytes there are.
        found: u64,
        /// The bytes that there should be.
        expected: u64,
    },
    /// The sum of a section is another one than when it was written.
    #[error("is damaged: the sum of {section} is wrong")]
    Damaged {
        /// The section, or the table.
        section: String,
    },
    /// A section is missing that the index needs, or its elements are of another size: it is an index of another kind.
    #[error("has no section {section} of the expected kind")]
    Missing {
        /// The section.
        section: String,
    },
    /// What it has does not fit together.
    #[error("{section} does not fit the rest")]
    Inconsistent {
        /// The section.
        section: String,
    },
    /// It has another index.
    #[error("has an index of the kind {found}, not {expected}")]
    OtherKind {
        /// The kind it has.
        found: String,
        /// The kind that is wanted.
        expected: String,
    },
    /// It was built over another set than the one that it is to be used with.
    #[error("was built over other primitives")]
    OtherSet,
    /// The processor is not little-endian.
    #[error("cannot be used on a processor that is not little-endian")]
    BigEndian,
}
