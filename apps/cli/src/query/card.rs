//! `p2m query --device cuda`: answers of an NVIDIA card, which have the bits of those of the processor.

use crate::answers::BlockSize;
use crate::query::answers::{ClosestAnswer, Source};
use crate::query::args::Args;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::ClosestColumns;
use p2m_core::{Closest, Feature, Soup};
use p2m_cuda::{CudaIndex, CudaOptions};
use std::sync::Arc;

/// A scene on a card.
pub(crate) struct CardScene {
    index: CudaIndex<f64, Arc<Soup<f64>>>,
    max_distance: f64,
}

impl CardScene {
    /// Builds the tree on the threads of the current pool, and copies it to the card.
    pub(crate) fn new(soup: &Arc<Soup<f64>>, args: &Args) -> anyhow::Result<Self> {
        let tree = AabbTree::new(Arc::clone(soup))?;
        let index = CudaIndex::new(tree, &CudaOptions::default())?;
        Ok(Self { index, max_distance: args.max_distance.unwrap_or(f64::INFINITY) })
    }
}

impl Source for CardScene {
    // One part of a batch. Writing the table takes longer than answering.
    const BLOCK_SIZE: BlockSize = BlockSize::Fixed(1 << 20);

    fn closest(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<ClosestAnswer>> {
        let count = queries.len();
        let (mut distance, mut lower_bound) = (vec![0.0; count], vec![0.0; count]);
        let (mut point, mut barycentric) = (vec![Point3::origin(); count], vec![[0.0; 3]; count]);
        let (mut primitive, mut feature) = (vec![0; count], vec![Feature::Face; count]);
        let mut columns = ClosestColumns::default()
            .with_distance(&mut distance)
            .with_lower_bound(&mut lower_bound)
            .with_point(&mut point)
            .with_barycentric(&mut barycentric)
            .with_primitive(&mut primitive)
            .with_feature(&mut feature);
        self.index.closest_columns_into(queries, self.max_distance, &mut columns)?;
        Ok((0..count).map(|i| (columns.closest(i), f64::NAN)).collect())
    }

    fn near(&self, _: &[Point3<f64>]) -> anyhow::Result<Vec<Vec<Closest<f64>>>> {
        unreachable!("the arguments exclude each other")
    }
}
