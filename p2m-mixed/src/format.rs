//! The file formats of scenes and points, with their names and extensions.

use p2m_core::formats;

formats! {
    /// The file formats of scenes, all of which can be read and written.
    ///
    /// ```
    /// use p2m_mixed::Format;
    ///
    /// assert_eq!("STL".parse(), Ok(Format::Stl));
    /// assert_eq!(Format::from_path("a/b.off".as_ref()).unwrap().to_string(), "off");
    /// let error = "step".parse::<Format>().unwrap_err();
    /// assert_eq!(error.to_string(), "unknown format 'step', expected one of obj, ply, stl, off, p2m");
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn names_and_extensions_in_any_case() {
        for (name, format) in [("obj", Format::Obj), ("Ply", Format::Ply), ("STL", Format::Stl), ("oFF", Format::Off)] {
            assert_eq!(name.parse(), Ok(format));
            assert_eq!(Format::from_path(Path::new(&format!("a.b.{name}"))).unwrap(), format);
            assert_eq!(format.to_string(), name.to_lowercase());
        }
        assert_eq!("txt".parse(), Ok(PointFormat::Xyz));
        assert_eq!("npy".parse(), Ok(PointFormat::Npy));
        assert!("".parse::<Format>().is_err() && ".stl".parse::<Format>().is_err());
        let error = PointFormat::from_path(Path::new("q.las")).unwrap_err();
        assert_eq!(error.to_string(), "q.las: unknown extension 'las', expected one of xyz, txt, csv, npy, ply");
        assert!(PointFormat::from_path(Path::new("csv")).is_err(), "a name is no extension");
    }
}
