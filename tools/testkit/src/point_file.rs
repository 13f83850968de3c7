//! Files of points and rays in all their formats.

/// The names of the columns in tables.
const COLUMNS: [&str; 6] = ["x", "y", "z", "dx", "dy", "dz"];
/// The names of the properties in PLY files.
const PROPERTIES: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// Returns a file of points or rays, given as rows of three or six numbers. `format` is `xyz`, `csv`, `npy` or `ply`.
#[must_use]
pub fn point_file<const N: usize>(format: &str, rows: &[[f64; N]]) -> Vec<u8> {
    let (count, bytes) = (rows.len(), rows.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    let lines = |separator: &str| -> String {
        rows.iter().map(|row| row.map(|x| format!("{x:?}")).join(separator) + "\n").collect()
    };
    match format {
        "xyz" => lines(" ").into_bytes(),
        "csv" => format!("{}\n{}", COLUMNS[..N].join(","), lines(",")).into_bytes(),
        "npy" => {
            let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({count}, {N})}}\n");
            let length = u16::try_from(header.len()).expect("a short header");
            let head = [b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], header.as_bytes()].concat();
            head.into_iter().chain(bytes).collect()
        }
        _ => {
            let properties: String = PROPERTIES[..N].iter().map(|name| format!("property double {name}\n")).collect();
            let head =
                format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{properties}end_header\n");
            head.into_bytes().into_iter().chain(bytes).collect()
        }
    }
}
