//! The file formats of scenes, points and answers, with their names and extensions.

use crate::{FileLocation, ReadError, Reason};
use std::path::Path;

/// The error for a name that belongs to no format.
///
/// ```
/// let error = "step".parse::<p2m_mixed::Format>().unwrap_err();
/// assert_eq!(error.to_string(), "unknown format 'step', expected one of obj, ply, stl, off, p2m");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown format '{name}', expected one of {}", supported.join(", "))]
#[non_exhaustive]
pub struct UnknownFormat {
    /// The unknown name.
    pub name: String,
    /// The names of the formats that are supported here.
    pub supported: &'static [&'static str],
}

/// Defines an enum of formats with their names, which are also the extensions of files.
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
            /// The names of all formats, which are also the extensions of files.
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

            /// Returns the format that the extension of a file stands for, in any case.
            ///
            /// # Errors
            /// `Reason::UnknownExtension` if the extension belongs to no format.
            pub fn from_path(path: &std::path::Path) -> Result<Self, $crate::ReadError> {
                let extension = path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
                let known = Self::named(&extension);
                known.ok_or_else(|| $crate::engine::unknown_extension(path, extension, Self::NAMES))
            }
        }

        impl std::fmt::Display for $format {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $format {
            type Err = $crate::UnknownFormat;

            /// Returns the format with this name, in any case.
            fn from_str(name: &str) -> Result<Self, $crate::UnknownFormat> {
                Self::named(name).ok_or_else(|| $crate::engine::unknown_format(name, Self::NAMES))
            }
        }
    };
}

/// Returns the error for a file whose extension belongs to no format.
pub fn unknown_extension(path: &Path, extension: String, supported: &'static [&'static str]) -> ReadError {
    let reason = Reason::UnknownExtension { extension, supported };
    ReadError::new(&path.display().to_string(), FileLocation::File, reason)
}

/// Returns the error for a name that belongs to no format.
#[must_use]
pub fn unknown_format(name: &str, supported: &'static [&'static str]) -> UnknownFormat {
    UnknownFormat { name: name.to_owned(), supported }
}

formats! {
    /// The file formats of scenes, all of which can be read and written.
    ///
    /// ```
    /// use p2m_mixed::Format;
    ///
    /// assert_eq!("STL".parse(), Ok(Format::Stl));
    /// assert_eq!(Format::from_path("a/b.off".as_ref()).unwrap().to_string(), "off");
    /// ```
    Format {
        /// Wavefront OBJ is a text format, see [`read_obj`](crate::read_obj) and [`write_obj`](crate::write_obj).
        Obj = "obj",
        /// This is the Stanford polygon format, see [`read_ply`](crate::read_ply) and [`write_ply`](crate::write_ply).
        Ply = "ply",
        /// Stereolithography files have triangles in single precision, see [`read_stl`](crate::read_stl) and
        /// [`write_stl`](crate::write_stl).
        Stl = "stl",
        /// This is the object file format of Geomview, see [`read_off`](crate::read_off) and
        /// [`write_off`](crate::write_off).
        Off = "off",
        /// Files of saved indexes can have a scene, see [`read_p2m`](crate::read_p2m) and
        /// [`write_p2m`](crate::write_p2m).
        P2m = "p2m",
    }
}

formats! {
    /// The file formats of query points and rays, see [`read_points`](crate::read_points).
    PointFormat {
        /// This is text with columns that are separated by white space.
        Xyz = "xyz" | "txt",
        /// This is text with columns that are separated by commas or semicolons.
        Csv = "csv",
        /// This is an array of NumPy.
        Npy = "npy",
        /// The points are the vertices of a PLY file.
        Ply = "ply",
    }
}

formats! {
    /// The file formats of answers, see [`AnswerWriter`](crate::AnswerWriter).
    AnswerFormat {
        /// This is a text table.
        Csv = "csv",
        /// This is a structured array of NumPy.
        Npy = "npy",
        /// This is a point cloud of the queries, which have the answers as properties.
        Ply = "ply",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_extensions_in_any_case() {
        for (name, format) in [("obj", Format::Obj), ("Ply", Format::Ply), ("STL", Format::Stl), ("oFF", Format::Off)] {
            assert_eq!(name.parse(), Ok(format));
            assert_eq!(Format::from_path(Path::new(&format!("a.b.{name}"))).unwrap(), format);
            assert_eq!(format.to_string(), name.to_lowercase());
        }
        assert_eq!("txt".parse(), Ok(PointFormat::Xyz));
        assert_eq!("npy".parse(), Ok(AnswerFormat::Npy));
        assert!("".parse::<Format>().is_err() && ".stl".parse::<Format>().is_err());
        let error = PointFormat::from_path(Path::new("q.las")).unwrap_err();
        assert_eq!(error.to_string(), "q.las: unknown extension 'las', expected one of xyz, txt, csv, npy, ply");
        assert!(AnswerFormat::from_path(Path::new("csv")).is_err(), "a name is no extension");
    }
}
