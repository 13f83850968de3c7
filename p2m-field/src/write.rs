//! Writers of fields.

use crate::format::FieldFormat;
use crate::grid::Grid;
use crate::refined::Cell;
use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use p2m_core::npy_header;
use std::io::{self, Write};

/// Writes a field in one of the formats.
///
/// - **NPY**: an array of NumPy of type `<f4` and shape (x, y, z) in Fortran order. `field[i, j, k]` is the value at
///   `Grid::point([i, j, k])`.
/// - **VTI**: an ImageData of VTK with origin and spacing, which ParaView reads. The values are the point data
///   `distance`, in base64, so that the file is XML.
/// - **Raw**: the values alone as little-endian f32, with x running fastest.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_field::{FieldFormat, Grid, write_field};
///
/// let grid = Grid::new(Point3::origin(), 0.5, [2, 1, 1]).unwrap();
/// let mut file = Vec::new();
/// write_field(&grid, &[1.0, -2.0], FieldFormat::Raw, &mut file)?;
/// assert_eq!(file, [0, 0, 128, 63, 0, 0, 0, 192]);
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// Errors of `writer`, and [`InvalidInput`](io::ErrorKind::InvalidInput) if the values are not one for each point.
pub fn write_field(grid: &Grid, values: &[f32], format: FieldFormat, mut writer: impl Write) -> io::Result<()> {
    if values.len() != grid.len() {
        let message = format!("there are {} values for {} points", values.len(), grid.len());
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let [x, y, z] = grid.counts();
    match format {
        FieldFormat::Npy => {
            writer.write_all(&npy_header("'<f4'", &format!("({x}, {y}, {z})"), true))?;
            write_values(values, &mut writer)?;
        }
        FieldFormat::Raw => write_values(values, &mut writer)?,
        FieldFormat::Vti => {
            let extent = format!("0 {} 0 {} 0 {}", x - 1, y - 1, z - 1);
            let (origin, spacing) = (grid.origin(), grid.spacing());
            write!(
                writer,
                "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" \
                 header_type=\"UInt64\">\n<ImageData WholeExtent=\"{extent}\" Origin=\"{:?} {:?} {:?}\" \
                 Spacing=\"{spacing:?} {spacing:?} {spacing:?}\">\n<Piece Extent=\"{extent}\">\n\
                 <PointData Scalars=\"distance\">\n<DataArray type=\"Float32\" Name=\"distance\" format=\"appended\" \
                 offset=\"0\"/>\n</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"base64\">\n_",
                origin.x, origin.y, origin.z
            )?;
            // The number of bytes and the values are encoded together.
            let mut encoder = EncoderWriter::new(&mut writer, &STANDARD);
            encoder.write_all(&(4 * values.len() as u64).to_le_bytes())?;
            write_values(values, &mut encoder)?;
            encoder.finish()?;
            drop(encoder);
            writer.write_all(b"\n</AppendedData>\n</VTKFile>\n")?;
        }
    }
    writer.flush()
}

/// Writes values as little-endian f32.
fn write_values(values: &[f32], mut writer: impl Write) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(4 * CHUNK_VALUES);
    for values in values.chunks(CHUNK_VALUES) {
        bytes.clear();
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        writer.write_all(&bytes)?;
    }
    Ok(())
}

/// The number of values in one call of the writer.
const CHUNK_VALUES: usize = 1 << 14;

/// Writes the cells of a field on an octree as a structured array of NumPy.
///
/// The fields of the array are `origin` (`<f8`, 3), `size` (`<f8`) and `values` (`<f8`, 8, in the order of
/// [`Cell::values`]).
///
/// # Errors
/// Errors of `writer`.
pub fn write_cells(cells: &[Cell], mut writer: impl Write) -> io::Result<()> {
    let fields = "[('origin', '<f8', (3,)), ('size', '<f8'), ('values', '<f8', (8,))]";
    writer.write_all(&npy_header(fields, &format!("({},)", cells.len()), false))?;
    for cell in cells {
        let numbers = cell.origin.iter().chain([&cell.size]).chain(&cell.values);
        let bytes: Vec<u8> = numbers.flat_map(|x| x.to_le_bytes()).collect();
        writer.write_all(&bytes)?;
    }
    writer.flush()
}
