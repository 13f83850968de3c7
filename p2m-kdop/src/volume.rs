//! k-DOPs as the bounding volumes of a tree.

use crate::direction_table::DirectionTable;
use crate::node::KdopNode;
use crate::{Directions, Kdop, KdopOptions};
use nalgebra::Vector3;
use p2m_bvh::engine::volume::{TreeOptions, VolumeNodes};
use p2m_bvh::{SplitOptions, Volume};
use p2m_core::storage::{LoadError, Reader, Writer, require};

impl<const K: usize> Volume for Kdop<K> {
    type Options = KdopOptions<K>;
    type Directions = Directions<K>;

    fn directions(table: &DirectionTable<K>) -> &Directions<K> {
        &table.directions
    }
}

/// The section with the normals, as three numbers each.
const DIRECTIONS_SECTION: &str = "tree/directions";
/// The section that has 1 if the first three directions are orthogonal, and 0 otherwise.
const ORTHOGONAL_SECTION: &str = "tree/orthogonal";

impl<const K: usize> VolumeNodes for Kdop<K> {
    type Shared = DirectionTable<K>;
    type Node = KdopNode<K>;

    fn name() -> String {
        format!("kdop-{K}")
    }
    fn save_shared(table: &DirectionTable<K>, writer: &mut Writer<'_>) {
        let normals = table.directions.normals().map(<[f64; 3]>::from);
        writer.put_copy(DIRECTIONS_SECTION, normals.as_flattened());
        writer.put_copy(ORTHOGONAL_SECTION, &[u8::from(table.directions.starts_orthogonal())]);
    }
    fn load_shared(reader: &Reader) -> Result<DirectionTable<K>, LoadError> {
        let numbers = reader.array::<f64>(DIRECTIONS_SECTION)?;
        let is_orthogonal = reader.one::<u8>(ORTHOGONAL_SECTION)?;
        require(is_orthogonal <= 1, ORTHOGONAL_SECTION, "the number is neither 0 nor 1")?;
        let (normals, rest) = numbers.as_chunks::<3>();
        let normals: Vec<Vector3<f64>> = normals.iter().copied().map(Vector3::from).collect();
        let directions = Directions::from_normals(&normals, is_orthogonal == 1).filter(|_| rest.is_empty());
        let directions =
            directions.ok_or_else(|| LoadError::inconsistent(DIRECTIONS_SECTION, "they bound no polytope"))?;
        Ok(DirectionTable::new(&directions))
    }
}

impl<const K: usize> TreeOptions<DirectionTable<K>> for KdopOptions<K> {
    fn splits(&self) -> &SplitOptions {
        &self.splits
    }
    fn shared(&self) -> DirectionTable<K> {
        DirectionTable::new(&self.directions)
    }
}
