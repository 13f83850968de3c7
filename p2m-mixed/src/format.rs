//! The formats of files, by name and by extension.

use crate::{FileLocation, ReadError, Reason};
use std::path::Path;

/// A name that is of no format.
///
/// ```
/// let error = "step".parse::<p2m_mixed::Format>().unwrap_err();
/// assert_eq!(error.to_string(), "unknown format 'step', expected one of obj, ply, stl, off, p2m");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown format '{name}', expected one of {}", supported.join(", "))]
#[non_exhaustive]
pub struct UnknownFormat {
    /// The name.
    pub name: String,
    /// What it could have been.
    pub supported: &'static [&'static str],
}

/// Defines an enum of formats with their names, which are extensions of files, too.
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
            /// The names of all of them; each is an extension of files, too.
            pub const NAMES: &'static [&'static str] = &[$($name, $($other,)*)*];

            /// Its name, which is the usual extension of its files.
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

            /// The format that the extension of a file says, in any case.
            ///
            /// # Errors
            /// `Reason::UnknownExtension` with the name of the file.
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

            /// By name, in any case.
            fn from_str(name: &str) -> Result<Self, $crate::UnknownFormat> {
                Self::named(name).ok_or_else(|| $crate::engine::unknown_format(name, Self::NAMES))
            }
        }
    };
}

/// The error for a file whose extension is that of no format.
pub fn unknown_extension(path: &Path, extension: String, supported: &'static [&'static str]) -> ReadError {
    let reason = Reason::UnknownExtension { extension, supported };
    ReadError::new(&path.display().to_string(), FileLocation::File, reason)
}

/// The error for a name of no format.
#[must_use]
pub fn unknown_format(name: &str, supported: &'static [&'static str]) -> UnknownFormat {
    UnknownFormat { name: name.to_owned(), supported }
}

formats! {
    /// The formats of scenes: all of them are read and written.
    ///
    /// ```
    /// use p2m_mixed::Format;
    ///
    /// assert_eq!("STL".parse(), Ok(Format::Stl));
    /// assert_eq!(Format::from_path("a/b.off".as_ref()).unwrap().to_string(), "off");
    /// ```
    Format {
        /// Wavefront OBJ, a text: [`read_obj`](crate::read_obj), [`write_obj`](crate::write_obj).
        Obj = "obj",
        /// The Stanford polygon format: [`read_ply`](crate::read_ply), [`write_ply`](crate::write_ply).
        Ply = "ply",
        /// Stereolithography, triangles in single precision: [`read_stl`](crate::read_stl),
        /// [`write_stl`](crate::write_stl).
        Stl = "stl",
        /// The object file format of Geomview: [`read_off`](crate::read_off), [`write_off`](crate::write_off).
        Off = "off",
        /// Saved indexes with their scenes, of which the scene is read and written: [`read_p2m`](crate::read_p2m),
        /// [`write_p2m`](crate::write_p2m).
        P2m = "p2m",
    }
}

formats! {
    /// The formats of points to ask about, see [`read_points`](crate::read_points).
    PointFormat {
        /// Columns of text separated by white space.
        Xyz = "xyz" | "txt",
        /// Columns of text separated by commas or semicolons.
        Csv = "csv",
        /// An array of NumPy.
        Npy = "npy",
        /// The vertices of a PLY file.
        Ply = "ply",
    }
}

formats! {
    /// The formats of answers, see [`AnswerWriter`](crate::AnswerWriter).
    AnswerFormat {
        /// A table of text.
        Csv = "csv",
        /// A structured array of NumPy.
        Npy = "npy",
        /// The queries as a point cloud, with what was answered as properties.
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
