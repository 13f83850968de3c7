//! Errors of loading a file.

use super::section::VERSION;

/// An error of loading an index from a file. Its message includes the message of the operating system.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be opened or read.
    #[error("cannot be read: {0}")]
    Io(std::io::Error),
    /// The file does not begin with the magic bytes of a saved index.
    #[error("is not a saved index")]
    Foreign,
    /// The file has another version of the format.
    #[error("has version {found} of the format, but this program reads version {VERSION}")]
    Version {
        /// The version of the file.
        found: u32,
    },
    /// The length of the file differs from the length in its header.
    #[error("has {found} bytes instead of {expected}")]
    Length {
        /// The number of bytes of the file.
        found: u64,
        /// The number of bytes that the header announces.
        expected: u64,
    },
    /// The checksum of a section is wrong, so the section was damaged after it was written.
    #[error("is damaged: the checksum of {section} is wrong")]
    Damaged {
        /// The name of the section, or a description of the table.
        section: String,
    },
    /// A section that the index needs is missing, or its elements have another size.
    #[error("has no section {section} of the expected kind")]
    Missing {
        /// The name of the section.
        section: String,
    },
    /// The content of a section contradicts itself or another section, so no program of this project wrote it.
    #[error("has contradictory contents: in {section}, {reason}")]
    Inconsistent {
        /// The name of the section.
        section: String,
        /// What is wrong, as a clause for the message.
        reason: &'static str,
    },
    /// The file has an index of another kind.
    #[error("has an index of the kind {found}, not {expected}")]
    OtherKind {
        /// The kind of the index in the file.
        found: String,
        /// The kind that was requested.
        expected: String,
    },
    /// The index was built over another set of primitives.
    #[error("was built over other primitives")]
    OtherSet,
    /// The processor is not little-endian, so it cannot use the numbers in a file.
    #[error("cannot be used on a processor that is not little-endian")]
    BigEndian,
}

impl LoadError {
    /// Returns the error for a section whose content contradicts itself or another section.
    #[must_use]
    pub fn inconsistent(section: &str, reason: &'static str) -> Self {
        Self::Inconsistent { section: section.to_owned(), reason }
    }
}

impl From<std::io::Error> for LoadError {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error)
    }
}
