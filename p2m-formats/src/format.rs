//! The formats of files: those of `p2m-mixed`, those of this crate, and programs that convert other formats.

use crate::{File, e57, geojson, gltf, las, pcd, shapefile, threemf};
use p2m_core::{UnknownExtension, UnknownFormat};
use p2m_mixed::{FileLocation, Format, ReadError, Reason, Scene};
use std::fmt;
use std::path::Path;
use std::str::FromStr;
use std::sync::LazyLock;

p2m_core::formats! {
    /// The formats that this crate reads.
    ForeignFormat {
        /// Point clouds of laser scanners, compressed or not. The unit is that of the coordinate system in the file.
        Las = "las" | "laz",
        /// Scans of several stations, in metres. The pose of each scan is applied, and its name is that of an object.
        E57 = "e57",
        /// Point clouds of the Point Cloud Library: text, binary or compressed.
        Pcd = "pcd",
        /// Scenes of glTF 2.0, in metres. The transforms of nodes are applied, and the names of nodes or else of their
        /// meshes are those of objects.
        Gltf = "gltf" | "glb",
        /// Parts for 3D printers, with their unit. Items of the build plate are placed and named.
        ThreeMf = "3mf",
        /// Points, lines and polygons of RFC 7946, in degrees. A feature with a `name` or an `id` is an object.
        GeoJson = "geojson" | "json",
        /// Points, lines, polygons and patches of a shapefile. Its companion `.prj` has the unit.
        Shapefile = "shp",
    }
}

impl ForeignFormat {
    pub(crate) fn read(self, file: &File<'_>) -> Result<Scene, ReadError> {
        match self {
            Self::Las => las::read(file),
            Self::E57 => e57::read(file),
            Self::Pcd => pcd::read(file),
            Self::Gltf => gltf::read(file),
            Self::ThreeMf => threemf::read(file),
            Self::GeoJson => geojson::read(file),
            Self::Shapefile => shapefile::read(file),
        }
    }
}

/// A format of files that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FileFormat {
    /// A format of `p2m-mixed`, which can be written as well.
    Own(Format),
    /// A format of this crate.
    Foreign(ForeignFormat),
}

/// Extensions of unsupported formats, with advice on how to convert such files.
const CONVERTERS: [(&str, &str); 9] = [
    ("step stp iges igs brep", "FreeCAD or gmsh convert it to STL"),
    ("fbx blend dae 3ds abc usd usda usdc usdz x3d wrl", "Blender converts it to GLB"),
    ("dwg dxf ifc", "FreeCAD or Blender convert it to OBJ"),
    ("sldprt sldasm ipt iam prt catpart catproduct x_t jt 3dm", "the program that wrote it exports STL"),
    ("vtk vtu vtp vtm msh inp bdf nas med xdmf", "the Python package meshio converts it to PLY"),
    ("gpkg kml kmz gml fgb gdb gpx tab", "ogr2ogr of GDAL converts it to GeoJSON"),
    ("tif tiff dem hgt", "gdal_translate of GDAL converts it to XYZ"),
    ("ptx rcp rcs fls zfs bin copc", "CloudCompare converts it to E57 or LAS"),
    ("xlsx xls ods", "a spreadsheet program saves it as CSV"),
];

impl FileFormat {
    /// Returns the names of all formats, which are also the extensions of files.
    #[must_use]
    pub fn names() -> &'static [&'static str] {
        static NAMES: LazyLock<Vec<&str>> = LazyLock::new(|| [Format::NAMES, ForeignFormat::NAMES].concat());
        &NAMES
    }

    /// Returns all formats.
    pub fn all() -> impl Iterator<Item = Self> {
        let own = Format::ALL.iter().map(|format| Self::Own(*format));
        own.chain(ForeignFormat::ALL.iter().map(|format| Self::Foreign(*format)))
    }

    /// Returns the name of the format, which is the usual extension of its files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Own(format) => format.name(),
            Self::Foreign(format) => format.name(),
        }
    }

    /// Returns the format that the extension of a file stands for, in any case.
    ///
    /// # Errors
    /// [`ReadError`] if the extension belongs to no format. It names a program that converts the file, if one is known.
    pub fn from_path(path: &Path) -> Result<Self, ReadError> {
        let extension = path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
        extension.parse().map_err(|UnknownFormat { name: extension, supported }| {
            let file = path.display().to_string();
            let lower = extension.to_ascii_lowercase();
            match CONVERTERS.iter().find(|(extensions, _)| extensions.split(' ').any(|known| known == lower)) {
                Some((_, advice)) => {
                    let text = format!("files with the extension '{extension}' are not read: {advice}");
                    ReadError::new(&file, FileLocation::File, Reason::Format(text.into()))
                }
                None => UnknownExtension { file, extension, supported }.into(),
            }
        })
    }
}

impl From<Format> for FileFormat {
    fn from(format: Format) -> Self {
        Self::Own(format)
    }
}

impl fmt::Display for FileFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for FileFormat {
    type Err = UnknownFormat;

    /// Returns the format with this name, in any case.
    fn from_str(name: &str) -> Result<Self, UnknownFormat> {
        let format = name.parse().map(Self::Own).or_else(|_| name.parse().map(Self::Foreign));
        format.map_err(|error: UnknownFormat| UnknownFormat { supported: Self::names(), ..error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_that_of_a_format_and_no_converter_has_one() {
        for name in FileFormat::names() {
            assert!(name.to_uppercase().parse::<FileFormat>().is_ok(), "{name}");
            assert!(
                CONVERTERS.iter().all(|(extensions, _)| extensions.split(' ').all(|known| known != *name)),
                "{name}"
            );
        }
    }

    #[test]
    fn errors_name_a_converter() {
        let error = |name: &str| FileFormat::from_path(name.as_ref()).unwrap_err().to_string();
        assert_eq!(
            error("a/part.STEP"),
            "a/part.STEP: files with the extension 'STEP' are not read: FreeCAD or gmsh convert it to STL"
        );
        assert!(error("part.xyzw").contains("unknown extension 'xyzw', expected one of obj, ply, stl"));
        assert!(error("part.xyzw").ends_with("pcd, gltf, glb, 3mf, geojson, json, shp"));
    }
}
