//! Reading rows in any format.

use super::row::Row;
use super::{PointColumns, PointIds, npy, table};
use crate::formats::ply::read_vertices;
use crate::{PointFormat, ReadError, Reason, Unit};
use std::io::BufRead;

/// Points or rays, with their ids and unit.
pub(crate) struct Rows<R> {
    pub(crate) rows: Vec<R>,
    pub(crate) ids: Option<PointIds>,
    pub(crate) unit: Option<Unit>,
    pub(crate) is_flat: bool,
}

/// Reads points or rays. Columns can be chosen only in text tables.
pub(crate) fn read<R: Row<N>, const N: usize>(
    reader: impl BufRead,
    format: PointFormat,
    name: &str,
    columns: &PointColumns,
) -> Result<Rows<R>, ReadError> {
    let mut rows = Vec::new();
    let mut ids = PointIds::default();
    let take = |row, id: Option<&[u8]>| {
        rows.try_reserve(1).map_err(Reason::Memory)?;
        rows.push(row);
        id.map_or(Ok(()), |id| ids.push(id))
    };
    let (mut unit, mut is_flat) = (None, false);
    match format {
        PointFormat::Xyz | PointFormat::Csv => {
            let notes = table::for_each_row(reader, name, columns, take)?;
            (unit, is_flat) = (notes.unit, notes.is_flat);
        }
        PointFormat::Npy => is_flat = npy::for_each_row(reader, name, take)?,
        PointFormat::Ply => rows = read_vertices(reader, name)?,
    }
    let ids = Some(ids).filter(|ids| ids.len() > 0);
    Ok(Rows { rows, ids, unit, is_flat })
}
