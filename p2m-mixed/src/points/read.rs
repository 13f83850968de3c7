//! Reading rows in any format.

use super::row::Row;
use super::{npy, table};
use crate::formats::ply::read_vertices;
use crate::{PointFormat, ReadError, Reason};
use std::io::BufRead;

/// Reads points or rays.
pub(super) fn read<R: Row<N>, const N: usize>(
    reader: impl BufRead,
    format: PointFormat,
    name: &str,
) -> Result<Vec<R>, ReadError> {
    let mut rows = Vec::new();
    let take = |row| {
        rows.try_reserve(1).map_err(Reason::Memory)?;
        rows.push(row);
        Ok(())
    };
    match format {
        PointFormat::Xyz | PointFormat::Csv => table::for_each_row(reader, name, take)?,
        PointFormat::Npy => npy::for_each_row(reader, name, take)?,
        PointFormat::Ply => return read_vertices(reader, name),
    }
    Ok(rows)
}
