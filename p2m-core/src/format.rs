//! File formats, which are named by their file extensions, and the header of NPY files.

/// The error for an unknown format name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown format '{name}', expected one of {}", supported.join(", "))]
pub struct UnknownFormat {
    /// The unknown name.
    pub name: String,
    /// The names of the formats that are supported here.
    pub supported: &'static [&'static str],
}

/// The error for a file with an unknown extension.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}: unknown extension '{extension}', expected one of {}", supported.join(", "))]
pub struct UnknownExtension {
    /// The name of the file.
    pub file: String,
    /// The extension, which is empty if there is none.
    pub extension: String,
    /// The extensions that are supported here.
    pub supported: &'static [&'static str],
}

/// Defines an enum of file formats with their names, which are also the extensions of their files.
#[doc(hidden)]
#[macro_export]
macro_rules! formats {
    (
        $(#[$doc:meta])* $format:ident {
            $($(#[$variant_doc:meta])* $variant:ident = $name:literal $(| $other:literal)*,)*
        }
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $format {
            $($(#[$variant_doc])* $variant,)*
        }

        impl $format {
            /// All formats, in the order of the variants.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// The names of all formats, which are also the extensions of their files.
            pub const NAMES: &'static [&'static str] = &[$($name, $($other,)*)*];

            /// Returns the name of the format, which is the usual extension of its files.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            fn named(name: &str) -> Option<Self> {
                match name.to_ascii_lowercase().as_str() {
                    $($name $(| $other)* => Some(Self::$variant),)*
                    _ => None,
                }
            }

            /// Returns the format of a file by its extension, ignoring case.
            ///
            /// # Errors
            /// [`UnknownExtension`]($crate::UnknownExtension) if the extension belongs to no format.
            pub fn from_path(path: &std::path::Path) -> Result<Self, $crate::UnknownExtension> {
                let extension = path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
                Self::named(&extension).ok_or_else(|| $crate::UnknownExtension {
                    file: path.display().to_string(),
                    extension,
                    supported: Self::NAMES,
                })
            }
        }

        impl std::fmt::Display for $format {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $format {
            type Err = $crate::UnknownFormat;

            /// Returns the format with this name, ignoring case.
            fn from_str(name: &str) -> Result<Self, $crate::UnknownFormat> {
                let unknown = || $crate::UnknownFormat { name: name.to_owned(), supported: Self::NAMES };
                Self::named(name).ok_or_else(unknown)
            }
        }
    };
}

/// Returns a header of an NPY file of version 1.0, padded to a multiple of 64 bytes as NumPy does.
///
/// # Panics
/// If the header is longer than 2^16 - 1 bytes.
#[doc(hidden)]
#[must_use]
pub fn npy_header(descr: &str, shape: &str, is_fortran: bool) -> Vec<u8> {
    let order = if is_fortran { "True" } else { "False" };
    let mut description = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}");
    // Magic, version and length take 10 bytes, and a line end comes last.
    while !(10 + description.len() + 1).is_multiple_of(64) {
        description.push(' ');
    }
    description.push('\n');
    let length = u16::try_from(description.len()).expect("a few hundred bytes");
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend(length.to_le_bytes());
    header.extend(description.into_bytes());
    header
}
