//! Checks of the promises of readers for any file: reading does not panic, returns the same in blocks of any size, and
//! takes memory in proportion to the size of the file; and the scene can be written in every format, and reading it
//! returns the same scene. Formats of other programs are read from memory, and may take more of it.

use super::memory;
use p2m_core::{Element, PrimitiveSet, Soup};
use p2m_formats::{FileFormat, ForeignFormat};
use p2m_mixed::engine::read_scene_in_blocks;
use p2m_mixed::{
    Format, Object, PointFormat, Scene, read_points_from, read_scene_from, stl_rounding, write_ply_ascii, write_scene,
    write_stl,
};

/// The memory that a reader may take for each byte of the file, in addition to buffers of a fixed size.
///
/// The most memory is needed for a polygon whose corners are two bytes each.
const MEMORY_PER_BYTE: usize = 256;

fn measured<T>(file: &[u8], read: impl FnOnce() -> T) -> T {
    memory::at_most(MEMORY_PER_BYTE * file.len(), read)
}

/// Checks that blocks of any size return the scene or the error of sequential reading.
fn check_blocks(file: &[u8], format: Format) {
    let outcome = |block_bytes| {
        let scene = read_scene_in_blocks(file, format, "fuzz", block_bytes).map_err(|error| error.to_string())?;
        let elements: Vec<_> = scene.soup.elements().collect();
        Ok::<_, String>((bits(&scene.soup), elements, scene.sources, scene.objects, scene.skipped))
    };
    let expected = outcome(0);
    for block_bytes in [1, 16, 256] {
        assert_eq!(outcome(block_bytes), expected, "blocks of {block_bytes} bytes");
    }
}

/// A reader of files.
#[derive(Clone, Copy)]
pub enum Reader {
    /// Files of scenes.
    Scene(Format),
    /// Files of points.
    Points(PointFormat),
    /// Files of other programs.
    Foreign(ForeignFormat),
}

impl Reader {
    /// Returns the readers of all formats except for saved indexes, which [`saved`](super::saved) checks.
    pub fn all() -> Vec<Self> {
        let scenes = Format::ALL.iter().filter(|format| **format != Format::P2m);
        scenes
            .map(|format| Self::Scene(*format))
            .chain(PointFormat::ALL.iter().map(|format| Self::Points(*format)))
            .chain(ForeignFormat::ALL.iter().map(|format| Self::Foreign(*format)))
            .collect()
    }

    /// Returns the name of the reader, which is also the name of the folder of its seeds.
    pub fn name(self) -> String {
        match self {
            Self::Scene(format) => format.to_string(),
            Self::Points(format) => format!("{format}_points"),
            Self::Foreign(format) => format.to_string(),
        }
    }

    /// Checks the promises for a file.
    pub fn check(self, file: &[u8]) {
        match self {
            Self::Scene(format) => scene(file, format),
            Self::Points(format) => points(file, format),
            Self::Foreign(format) => foreign(file, format),
        }
    }
}

/// Reads a scene, writes it, and reads it again.
fn scene(file: &[u8], format: Format) {
    check_blocks(file, format);
    let scene = match measured(file, || read_scene_from(file, format, "fuzz")) {
        Ok(scene) => scene,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    check_written(&scene);
}

/// The memory in bytes that a file of another program may take, beyond the memory in proportion to its length.
const FOREIGN_BYTES: usize = 1 << 28;

/// Reads a scene of another program, after correcting checksums if the format has them, and writes it.
fn foreign(file: &[u8], format: ForeignFormat) {
    let mut file = file.to_vec();
    if format == ForeignFormat::E57 {
        p2m_testkit::restore_e57_checksums(&mut file);
    }
    let read = || {
        // The decoder of LAZ panics at damaged data, and its reader turns the panic into an error. The hook of the
        // fuzzer would end the program before.
        let hook = (cfg!(fuzzing) && format == ForeignFormat::Las).then(std::panic::take_hook);
        if hook.is_some() {
            std::panic::set_hook(Box::new(|_| ()));
        }
        let scene = p2m_formats::read_scene_from(&file[..], FileFormat::Foreign(format), "fuzz", None);
        hook.into_iter().for_each(std::panic::set_hook);
        scene
    };
    match memory::at_most(FOREIGN_BYTES, read) {
        Ok(scene) => check_written(&scene),
        Err(error) => {
            let text = error.to_string();
            assert!(!text.is_empty() && !text.contains("failed at damaged data"), "{text}");
        }
    }
}

/// Writes a scene in every format, and reads it again.
fn check_written(scene: &Scene) {
    assert_eq!(scene.sources.len(), scene.soup.len());
    check_objects(&scene.objects, scene.soup.len());
    assert!(scene.skipped.iter().all(|s| s.count > 0 && !s.to_string().is_empty()));

    for &format in Format::ALL.iter().filter(|format| format.is_lossless()) {
        let mut written = Vec::new();
        write_scene(scene, format, &mut written).unwrap();
        let again = read_scene_from(&written[..], format, "again").unwrap();
        assert!(again.skipped.is_empty() || format == Format::P2m, "{format}: {:?}", again.skipped);
        let expected = match format {
            Format::Ply | Format::P2m => bits(&scene.soup),
            // These exceptions are documented at the writers.
            _ if scene.soup.len() == 0 => Vec::new(),
            _ => bits(&scene.soup).into_iter().map(finite_or_origin).collect(),
        };
        assert_eq!(bits(&again.soup), expected, "{format}");
        assert!(again.soup.elements().eq(scene.soup.elements()), "{format}");
        if format == Format::Obj {
            assert_eq!(again.objects, scene.objects);
        }
    }

    let mut written = Vec::new();
    write_ply_ascii(scene, &mut written).unwrap();
    let again = read_scene_from(&written[..], Format::Ply, "again").unwrap();
    assert!(again.soup.elements().eq(scene.soup.elements()));
    let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
    let pairs = again.soup.positions().iter().zip(scene.soup.positions());
    assert!(pairs.clone().all(|(a, b)| (0..3).all(|k| same(a[k], b[k]))));
    assert_eq!(pairs.len(), scene.soup.positions().len());

    stl(scene);
}

fn check_objects(objects: &[Object], len: usize) {
    let mut end = 0;
    for object in objects {
        assert!(end <= object.ids.start && object.ids.start < object.ids.end && object.ids.end <= len);
        assert!(!object.name.is_empty());
        end = object.ids.end;
    }
}

fn stl(scene: &Scene) {
    let rounding = stl_rounding(scene);
    let mut written = Vec::new();
    let is_all_triangles = scene.soup.elements().all(|e| matches!(e, Element::Triangle(_)));
    let result = write_stl(scene, &mut written);
    assert_eq!(result.is_ok(), is_all_triangles && rounding.largest.is_finite());
    if result.is_err() {
        return assert!(written.is_empty());
    }
    let again = read_scene_from(&written[..], Format::Stl, "again").unwrap();
    assert!(again.skipped.is_empty());
    assert_eq!(again.soup.triangles().len(), scene.soup.triangles().len());
    let corner = |soup: &Soup<f64>, i: u32| soup.positions()[i as usize].map(|x| x as f32);
    let pairs = again.soup.triangles().as_flattened().iter().zip(scene.soup.triangles().as_flattened());
    for (&i, &j) in pairs {
        assert_eq!(corner(&again.soup, i), corner(&scene.soup, j)); // 0 and -0 are equal.
    }
    // A scene that was read from an STL file stays the same when it is written as STL again.
    let mut twice = Vec::new();
    write_stl(&again, &mut twice).unwrap();
    assert_eq!(read_scene_from(&twice[..], Format::Stl, "twice").unwrap().soup, again.soup);
}

fn bits(soup: &Soup<f64>) -> Vec<[u64; 3]> {
    soup.positions().iter().map(|p| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()]).collect()
}

fn finite_or_origin(position: [u64; 3]) -> [u64; 3] {
    if position.iter().all(|x| f64::from_bits(*x).is_finite()) { position } else { [0; 3] }
}

/// Reads points, writes them in every format, and reads them again.
fn points(file: &[u8], format: PointFormat) {
    let points = match measured(file, || read_points_from(file, format, "fuzz")) {
        Ok(points) => points,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    let rows: Vec<[f64; 3]> = points.iter().map(|point| point.coords.into()).collect();
    // Text does not distinguish the bits of NaN.
    let bits = |p: &[f64; 3]| p.map(|x| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() });
    for &format in PointFormat::ALL {
        let written = p2m_testkit::point_file(format.name(), &rows);
        let again = read_points_from(&written[..], format, "again").unwrap();
        assert!(again.iter().map(|p| bits(&p.coords.into())).eq(rows.iter().map(bits)), "{format}");
    }
}
