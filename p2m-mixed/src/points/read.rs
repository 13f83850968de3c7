//! Reading rows in any format.

use super::row::Row;
use super::{npy, table};
use crate::formats::ply::read_vertices;
use crate::{PointFormat, ReadError};
use std::io::BufRead;

/// Reads points or rays.
pub(super) fn read<R: Row<N>, const N: usize>(
    reader: impl BufRead,
    format: PointFormat,
    name: &str,
) -> Result<Vec<R>, ReadError> {
    match format {
        PointFormat::Xyz | PointFormat::Csv => table::read_table(reader, name),
        PointFormat::Npy => npy::read_npy(reader, name),
        PointFormat::Ply => read_vertices(reader, name),
    }
}
