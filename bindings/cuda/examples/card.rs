//! Compares a card with the processor, and prints its speed: card [QUERIES] FILE..
//!
//! For each scene and four sets of queries, all columns of all answers are compared bit for bit. The sets are the same
//! as in p2m-bench: uniform in the box (1x), near the surface (near), on the surface (surface), and uniform in ten
//! boxes (10x). Times are given for the kernels alone, and for the whole call with queries in the memory of the
//! processor.

use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::{BatchOptions, ClosestColumns, closest_columns_into};
use p2m_core::{Feature, QueryOptions};
use p2m_cuda::{CudaIndex, CudaOptions};
use p2m_testkit::queries::QuerySet;
use std::error::Error;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// The columns of a batch.
struct Answers {
    distance: Vec<f64>,
    primitive: Vec<u32>,
    point: Vec<Point3<f64>>,
    feature: Vec<Feature>,
    weights: Vec<[f64; 3]>,
}

impl Answers {
    fn new(count: usize) -> Self {
        Self {
            distance: vec![0.0; count],
            primitive: vec![0; count],
            point: vec![Point3::origin(); count],
            feature: vec![Feature::Face; count],
            weights: vec![[0.0; 3]; count],
        }
    }

    fn columns(&mut self) -> ClosestColumns<'_, f64> {
        ClosestColumns::default()
            .with_distance(&mut self.distance)
            .with_primitive(&mut self.primitive)
            .with_point(&mut self.point)
            .with_feature(&mut self.feature)
            .with_barycentric(&mut self.weights)
    }

    /// Returns the number of queries whose answers differ in any bit.
    fn differences(&self, other: &Self) -> usize {
        let bits = |all: &Self, i: usize| {
            let point = all.point[i].coords.map(f64::to_bits);
            (all.distance[i].to_bits(), all.primitive[i], point, all.feature[i], all.weights[i].map(f64::to_bits))
        };
        (0..self.distance.len()).filter(|&i| bits(self, i) != bits(other, i)).count()
    }
}

fn main() -> ExitCode {
    match compare() {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Returns the number of answers that differ.
fn compare() -> Result<usize, Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1).peekable();
    let count = arguments.next_if(|first| first.parse::<usize>().is_ok()).map_or(Ok(10_000_000), |n| n.parse())?;
    let mut differences = 0;
    for file in arguments {
        let soup = p2m_mixed::read_scene(file.as_ref())?.soup;
        let tree = AabbTree::new(&*soup)?;
        let start = Instant::now();
        let index = CudaIndex::new(tree, &CudaOptions::default())?;
        let [scene, lists] = index.memory();
        println!(
            "{file}: uploaded with lists in {:.3} s, {} and {} bytes per primitive, {} cells without a list",
            start.elapsed().as_secs_f64(),
            scene / soup.triangles().len().max(1),
            lists / soup.triangles().len().max(1),
            index.cells_without_list()
        );
        for set in [QuerySet::Box1, QuerySet::Near, QuerySet::Surface, QuerySet::Box10] {
            let queries = set.generate(&soup, count, 7);
            let (mut found, mut expected) = (Answers::new(count), Answers::new(count));
            // The first call is not measured.
            index.closest_columns_into(&queries, f64::INFINITY, &mut found.columns())?;
            let start = Instant::now();
            let report = index.closest_columns_into(&queries, f64::INFINITY, &mut found.columns())?;
            let whole = start.elapsed();
            // The parts of a batch overlap, so kernels are timed in batches of one part.
            let mut kernels = Duration::ZERO;
            for part in queries.chunks(1 << 20) {
                let mut distance = vec![0.0; part.len()];
                let mut columns = ClosestColumns::default().with_distance(&mut distance);
                kernels += index.closest_columns_into(part, f64::INFINITY, &mut columns)?.kernels;
            }
            let options = QueryOptions::default();
            closest_columns_into(index.tree(), &queries, &options, &BatchOptions::default(), expected.columns());
            let different = found.differences(&expected);
            differences += different;
            #[allow(clippy::cast_precision_loss, reason = "a number of queries")]
            let rate = |seconds: f64| count as f64 / seconds / 1e6;
            println!(
                "  {}: {:.0} million queries per second by kernels, {:.0} with transfers, {} by the tree, {} by the \
                 processor, {different} differences",
                set.name(),
                rate(kernels.as_secs_f64()),
                rate(whole.as_secs_f64()),
                report.by_tree,
                report.by_processor
            );
        }
    }
    Ok(differences)
}
