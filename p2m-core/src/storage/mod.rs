//! Files of built indexes.
//!
//! A file consists of a header, a table of sections, and the *sections*. Each section is an array of plain numbers in
//! their form in memory:
//!
//! | bytes | content |
//! |---|---|
//! | 8 | `89 P2M \r\n 1A \n`, hexadecimal except for the letters; a transfer as text damages it |
//! | 4 | version of the format, [`VERSION`] |
//! | 4 | number of sections |
//! | 8 | length of the file |
//! | 8 | XXH3 checksum of the table |
//! | 32 | unused, zero |
//! | 64 each | entries of the table |
//!
//! An entry of the table has
//!
//! | bytes | content |
//! |---|---|
//! | 32 | name, padded with zeros |
//! | 8 | offset of the section in bytes |
//! | 8 | number of elements |
//! | 8 | bytes of an element |
//! | 8 | XXH3 checksum of the section |
//!
//! All numbers are little-endian. Sections begin at multiples of 64 bytes, one after the other with zeros between them,
//! so an index uses its large arrays where they are in the file, and only small arrays are copied. [`SavedFile::open`]
//! and [`SavedFile::read`] copy a file into memory. [`SavedFile::map`] maps it, so that processes share its memory; it
//! is unsafe because another process may change the file. [`SavedFile::checked`] verifies all checksums.
//!
//! Checksums detect damage, not malice. Loading an index therefore validates everything that searches need in order to
//! end without a panic: numbers are in range, children come after their parents, nodes and packets are used once, and
//! every walk ends. A maliciously crafted file can still give wrong answers, for example by wrong bounds, but its index
//! neither panics nor searches forever.
//!
//! ```
//! use nalgebra::Point3;
//! use p2m_bvh::AabbTree;
//! use p2m_core::storage::{SavedFile, Writer};
//! use p2m_core::{BuildIndex, ClosestPoint, Point};
//!
//! // The type is that of an index that can be saved: AabbTree, KdopTree, OctreeIndex or P2mIndex.
//! type Index<'a> = AabbTree<f64, &'a [Point<f64>]>;
//!
//! let scene = [1.0, 5.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)));
//! let index = Index::build(&scene, &Default::default())?;
//! let mut file = Vec::new(); // or a File
//! let mut writer = Writer::default();
//! index.save(&mut writer);
//! writer.write(&mut file)?;
//!
//! // The index is loaded over the same scene, which is not in the file unless `p2m_mixed::save_scene` put it there.
//! let file = SavedFile::read(&file[..])?; // or SavedFile::open, for a path
//! let index = Index::load(&scene, file.checked()?)?;
//! assert_eq!(index.closest_point(&Point3::new(4.0, 0.0, 0.0)).unwrap().distance, 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod array;
mod error;
mod file;
mod ids;
mod index;
mod reader;
mod section;
#[cfg(feature = "serde")]
mod serde_form;
mod validate;
mod writer;

pub use array::Array;
pub use error::LoadError;
pub use file::SavedFile;
#[doc(hidden)]
pub use ids::as_ids;
pub use index::{Saved, kind, load, save};
pub use reader::Reader;
pub use section::VERSION;
#[cfg(feature = "serde")]
#[doc(hidden)]
pub use serde_form::{deserialize_index, serialize_index};
pub use validate::{check_chunks, require};
pub use writer::Writer;
