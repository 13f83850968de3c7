//! Files for the tests of the readers.
#![allow(dead_code, reason = "each test binary uses a part of this")]

use p2m_core::{Element, npy_header};
use p2m_mixed::{Format, ReadError, Scene, read_obj, read_off, read_ply, read_scene_from, read_stl, write_scene};

pub(crate) fn obj(text: impl AsRef<[u8]>) -> Result<Scene, ReadError> {
    read_obj(text.as_ref(), "t.obj")
}

pub(crate) fn ply(bytes: impl AsRef<[u8]>) -> Result<Scene, ReadError> {
    read_ply(bytes.as_ref(), "t.ply")
}

pub(crate) fn stl(bytes: impl AsRef<[u8]>) -> Result<Scene, ReadError> {
    read_stl(bytes.as_ref(), "t.stl")
}

pub(crate) fn off(bytes: impl AsRef<[u8]>) -> Result<Scene, ReadError> {
    read_off(bytes.as_ref(), "t.off")
}

/// Runs `work` on a single thread, and returns the bytes that it allocated.
pub(crate) fn measured_on_one_thread(work: impl FnOnce() + Send) -> allocation_counter::AllocationInfo {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| allocation_counter::measure(work))
}

pub(crate) fn written(scene: &Scene, format: Format) -> Vec<u8> {
    let mut file = Vec::new();
    write_scene(scene, format, &mut file).unwrap();
    file
}

/// Writes a scene and reads it again.
pub(crate) fn read_back(scene: &Scene, format: Format) -> Scene {
    read_scene_from(&written(scene, format)[..], format, "again").unwrap()
}

/// Returns the bits of the coordinates.
pub(crate) fn bits(scene: &Scene) -> Vec<[u64; 3]> {
    scene.soup.positions().iter().map(|p| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()]).collect()
}

pub(crate) fn elements(scene: &Scene) -> Vec<Element> {
    scene.soup.elements().collect()
}

pub(crate) fn skipped(scene: &Scene) -> Vec<(&str, u64)> {
    scene.skipped.iter().map(|s| (s.what.as_str(), s.count)).collect()
}

pub(crate) fn t(a: u32, b: u32, c: u32) -> Element {
    Element::Triangle([a, b, c])
}

pub(crate) fn s(a: u32, b: u32) -> Element {
    Element::Segment([a, b])
}

pub(crate) fn p(a: u32) -> Element {
    Element::Point(a)
}

/// An encoding of PLY files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    Ascii,
    Little,
    Big,
}

pub(crate) const ENCODINGS: [Encoding; 3] = [Encoding::Ascii, Encoding::Little, Encoding::Big];

/// A number of a PLY file.
#[derive(Clone, Copy, Debug)]
pub(crate) enum N {
    I8(i8),
    U8(u8),
    I16(i16),
    U16(u16),
    I32(i32),
    U32(u32),
    F32(f32),
    F64(f64),
}

/// Builds a PLY file.
pub(crate) struct Ply {
    encoding: Encoding,
    pub(crate) bytes: Vec<u8>,
}

impl Ply {
    /// Starts a file with these lines of the header. The first, the format and the last line are added.
    pub(crate) fn new(encoding: Encoding, header: &str) -> Self {
        Self::with_line_end(encoding, header, "\n")
    }

    pub(crate) fn with_line_end(encoding: Encoding, header: &str, end: &str) -> Self {
        let format = match encoding {
            Encoding::Ascii => "ascii",
            Encoding::Little => "binary_little_endian",
            Encoding::Big => "binary_big_endian",
        };
        let text = format!("ply\nformat {format} 1.0\n{header}\nend_header\n");
        Self { encoding, bytes: text.replace('\n', end).into_bytes() }
    }

    pub(crate) fn row(mut self, numbers: &[N]) -> Self {
        macro_rules! each {
            ($n:expr, $($kind:ident)*) => {
                match (self.encoding, $n) {
                    $((Encoding::Ascii, N::$kind(x)) => self.bytes.extend(format!("{x} ").bytes()),
                    (Encoding::Little, N::$kind(x)) => self.bytes.extend(x.to_le_bytes()),
                    (Encoding::Big, N::$kind(x)) => self.bytes.extend(x.to_be_bytes()),)*
                }
            };
        }
        for &n in numbers {
            each!(n, I8 U8 I16 U16 I32 U32 F32 F64);
        }
        if self.encoding == Encoding::Ascii {
            self.bytes.push(b'\n');
        }
        self
    }

    pub(crate) fn float_row(self, numbers: [f32; 3]) -> Self {
        self.row(&numbers.map(N::F32))
    }

    pub(crate) fn list(self, indices: &[i32]) -> Self {
        let count = N::U8(u8::try_from(indices.len()).unwrap());
        let row: Vec<N> = std::iter::once(count).chain(indices.iter().map(|&i| N::I32(i))).collect();
        self.row(&row)
    }

    pub(crate) fn read(&self) -> Result<Scene, ReadError> {
        ply(&self.bytes)
    }
}

/// Returns a file that uses every part of the format.
pub(crate) fn rich_ply(encoding: Encoding) -> Vec<u8> {
    let header = "comment all of it\nobj_info here\nelement face 3\nproperty uchar flags\n\
        property list uchar int vertex_indices\nelement vertex 6\nproperty float x\nproperty list uchar short bones\n\
        property double y\nproperty int z\nelement edge 2\nproperty ushort vertex1\nproperty float weight\n\
        property uint vertex2\nelement material 2\nproperty list uint double colours\nelement tristrips 1\n\
        property list int int vertex_indices";
    let mut file = Ply::new(encoding, header)
        .row(&[N::U8(1)])
        .list(&[0, 1, 2])
        .row(&[N::U8(2)])
        .list(&[0, 1, 2, 3])
        .row(&[N::U8(3)])
        .list(&[0, 4, 1, 2, 3]);
    for (i, (x, y, z)) in
        (0i16..).zip([(0.0, 0.0, 0), (4.0, 0.0, 0), (4.0, 4.0, 0), (0.0, 4.0, 0), (2.0, 1.0, 0), (0.5, 0.5, 7)])
    {
        file = file.row(&[N::F32(x), N::U8(2), N::I16(i), N::I16(-i), N::F64(y), N::I32(z)]);
    }
    file.row(&[N::U16(0), N::F32(0.5), N::U32(5)])
        .row(&[N::U16(5), N::F32(0.25), N::U32(1)])
        .row(&[N::U32(0)])
        .row(&[N::U32(2), N::F64(0.5), N::F64(1.5)])
        .row(&[N::I32(8), N::I32(0), N::I32(1), N::I32(2), N::I32(3), N::I32(-1), N::I32(3), N::I32(4), N::I32(5)])
        .bytes
}

/// An OBJ file that uses every part of the format.
pub(crate) const RICH_OBJ: &str = "# caf\u{e9}\r\nmtllib x.mtl\r\nv 0 0 0\nv 4 0 0 1.0\n  v\t4 4 0 1 0 0 # red\nv 0 4 0\nv 2 1 0\n\
    v .5 5e-1 -7.\nvt 0 0\nvn 0 0 1\nusemtl a\\\nb\nf 1 2 3\nf 1/1 2/1/1 3//1 4 # quad\nf -6 5 -5 \\\n -4 -3\nl 1 6 2\n\
    l 1/1 2/2\np 1 6\nfo 1 1 2\ncurv 0 1 1 2\n";

/// A text STL file that uses every part of the format.
pub(crate) const RICH_STL: &str = "solid text\r\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
    vertex 0 1 0\n  endloop\n endfacet\nendsolid text\n\nSOLID\nFACET NORMAL nan nan nan\nOUTER LOOP\nVERTEX 0 0 -0\n\
    VERTEX 1e0 0 0\nVERTEX 5 .5 5\nVERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID\n";

/// Returns a binary STL file whose header looks like text.
pub(crate) fn rich_binary_stl() -> Vec<u8> {
    let mut file = b"solid but binary".to_vec();
    file.resize(80, b' ');
    file.extend(3u32.to_le_bytes());
    for facet in [[0.0f32; 9], [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, -0.0, 1.0, 2.0], [7.5; 9]] {
        file.extend([0; 12]);
        file.extend(facet.iter().flat_map(|x| x.to_le_bytes()));
        file.extend([0, 1]);
    }
    file
}

/// A text OFF file that uses every part of the format.
pub(crate) const RICH_OFF: &str = "CNOFF # text\n5 5 0\n0 0 0 0 0 1 255 0 0 255\n1 0 0\n1 1 0\n0 1 0\n.5 .5 1e0\n\n4 0 1 2 3 \
    255 0 0\n3 0 1 4 0.5 0.5 0.5 1\n2 0 4 7\n1 4\n5 0 1\n2 4 3\n";

/// Returns a binary OFF file that uses every part of the format.
pub(crate) fn rich_binary_off() -> Vec<u8> {
    let mut file = b"NOFF BINARY\n".to_vec();
    let counts = [4, 3, 0].iter().flat_map(|n: &i32| n.to_be_bytes());
    file.extend(counts);
    file.extend((0u8..24).flat_map(|i| f32::from(i).to_be_bytes()));
    file.extend([4, 0, 1, 2, 3, 0, 2, 0, 2, 1, 9, 1, 3, 0].iter().flat_map(|n: &i32| n.to_be_bytes()));
    file
}

/// A table of points that uses every part of the format.
pub(crate) const RICH_TABLE: &str =
    "sep=;\n# a scan\n//id;x;y;z;code\n\n7;0;0;1e0;\"a;b\"\r\n8;nan;0;0;c\n9; 4 ;\"5\";-6;d\n10;1;2;3;e\n";

/// Returns an array of NumPy with fields besides the coordinates, one of which is not finite.
pub(crate) fn rich_npy() -> Vec<u8> {
    let fields = "[('id', '<i2'), ('z', '>f4'), ('x', '<f8'), ('name', '<U1'), ('y', '<i8')]";
    let mut file = npy_header(fields, "(5,)", false);
    let rows = [[1.0, 2.0, 3.0f32], [f32::NAN, 0.0, -1.0], [0.5, -7.0, 1e9], [0.0, 0.0, -0.0], [4.0, 5.0, 6.0]];
    for (id, [x, y, z]) in (7i16..).zip(rows) {
        file.extend(id.to_le_bytes());
        file.extend(z.to_be_bytes());
        file.extend(f64::from(x).to_le_bytes());
        file.extend(u32::from('a').to_le_bytes());
        #[allow(clippy::cast_possible_truncation, reason = "a small integer")]
        file.extend((y as i64).to_le_bytes());
    }
    file
}

/// Returns files of every format that use every part of it. The numbers say at how many lengths a file that is cut
/// off is still valid.
pub(crate) fn rich_files() -> Vec<(Vec<u8>, Format, usize)> {
    let mut files: Vec<(Vec<u8>, Format, usize)> = vec![
        (RICH_OBJ.into(), Format::Obj, usize::MAX),
        // A text needs neither a line end nor text after the word `endsolid`, which occurs twice.
        (RICH_STL.into(), Format::Stl, 9),
        (rich_binary_stl(), Format::Stl, 0),
        (RICH_OFF.into(), Format::Off, 1),
        (rich_binary_off(), Format::Off, 0),
        (written(&obj(RICH_OBJ).unwrap(), Format::P2m), Format::P2m, 0),
        // A table without its last rows, or the last digits of a number, is valid as well.
        (RICH_TABLE.into(), Format::Xyz, usize::MAX),
        (RICH_TABLE.into(), Format::Csv, usize::MAX),
        (rich_npy(), Format::Npy, 0),
    ];
    files.extend(ENCODINGS.map(|encoding| (rich_ply(encoding), Format::Ply, 3)));
    assert!(Format::ALL.iter().all(|format| files.iter().any(|(_, of, _)| of == format)), "a file for each format");
    files
}

/// Returns the formats whose files hold triangles.
pub(crate) fn formats_of_triangles() -> impl Iterator<Item = Format> {
    Format::ALL.iter().copied().filter(|format| !matches!(format, Format::Xyz | Format::Csv | Format::Npy))
}

/// Returns the formats whose files hold every scene.
pub(crate) fn lossless() -> impl Iterator<Item = Format> {
    Format::ALL.iter().copied().filter(|format| format.is_lossless())
}

/// Descriptions of an array that use every part of the grammar.
pub(crate) const RICH_NPY: &str = "{'descr': [('a', '<U2'), (('t', 'query'), '>f4', (3,)), ('b', [('c', '|V4'), \
    ('d', '<i4', (2, 2))]), ('e', '|S4')], 'fortran_order': False, 'shape': (2,), }";

/// Returns a file with an array.
pub(crate) fn npy(description: &str, data: &[u8]) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((description.len() as u16).to_le_bytes());
    file.extend(description.bytes());
    file.extend(data);
    file
}
