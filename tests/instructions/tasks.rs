//! The queries that are counted: each query set on each index of a scene.

use nalgebra::Point3;
use p2m::core::{Best, Hits, RayStatsCollector};
use p2m::core::{IndexStats, Isa};
use p2m::scene::generate::{IcoSphere, Subdivide, ico_sphere, subdivide};
use p2m::storage::{SavedFile, Writer};
use p2m::{AabbTree, ClosestPoint, KdopTree, OctreeIndex, OctreeOptions, P2mIndex, Ray, Soup};
use p2m_testkit::counted_queries::{self, QueryMode};
use p2m_testkit::queries::QuerySet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::Mutex;

/// The number of queries in each set. A count divided by 200 has at most three decimals, so the table is exact.
pub(crate) const QUERIES: usize = 200;
/// The seed of all queries.
pub(crate) const SEED: u64 = 1;
/// The scenes, in the order of the table.
pub(crate) const SCENES: [&str; 2] = ["knot_and_cables", "scan"];
/// The query sets of closest points.
pub(crate) const SETS: [QuerySet; 4] = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near, QuerySet::Surface];
/// The factor by which the cells of the second octree are finer. `p2m-bench` calls it finest.
const FINER: f64 = 30.0;
/// The number of counters of a query: nodes, packets and primitives.
pub(crate) const COUNTERS: usize = 3;

/// Returns a lump of 11,520 triangles with noise like a scan, which is the same on every platform.
fn scan() -> Soup<f64> {
    let lump = ico_sphere(&IcoSphere { frequency: 3 }).expect("valid options");
    subdivide(&lump, &Subdivide { levels: 3, amplitude: 0.15, ..Default::default() }).expect("valid options")
}

/// Returns the scene with this name.
pub(crate) fn scene(name: &str) -> Soup<f64> {
    let carried = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.obj"));
    if name == "scan" {
        scan()
    } else {
        Arc::unwrap_or_clone(p2m::scene::read_scene(&carried).expect("a carried scene").soup)
    }
}

/// Rounds to f32. This removes the last bits, in which logarithms and cosines differ between platforms.
fn rounded(x: f64) -> f64 {
    f64::from(x as f32)
}

fn points(set: QuerySet, soup: &Soup<f64>) -> Vec<Point3<f64>> {
    let points = set.generate(soup, QUERIES, SEED);
    if set == QuerySet::Near { points.into_iter().map(|point| point.map(rounded)).collect() } else { points }
}

fn rays(soup: &Soup<f64>) -> Vec<Ray> {
    let rays = QuerySet::Box1.rays(soup, QUERIES, SEED).into_iter();
    rays.map(|ray| Ray::new(&ray.origin(), &ray.direction().map(rounded)).expect("finite, and not zero")).collect()
}

/// The numbers of nodes, packets and primitives that all queries of a set visit.
pub(crate) type Counts = [usize; COUNTERS];

/// The queries of a set on an index.
pub(crate) struct Task<'a> {
    pub(crate) backend: &'static str,
    pub(crate) set: &'static str,
    /// Runs the queries as a user does.
    pub(crate) run: Box<dyn Fn() + 'a>,
    /// Runs the queries with counters.
    pub(crate) count: Box<dyn Fn() -> Counts + 'a>,
}

/// An index that counts the nodes, packets and primitives of its searches. It answers the queries of a batch one by
/// one, so interleaved searches are not counted.
struct Counted<'a, I> {
    index: &'a I,
    counts: Mutex<Counts>,
}

impl<I: IndexStats<f64>> ClosestPoint<f64> for Counted<'_, I> {
    fn search(&self, query: &Point3<f64>, best: &mut Best<f64>) {
        let before = best.counts();
        self.index.search(query, best);
        let found = best.counts().into_iter().zip(before);
        let mut counts = self.counts.lock().expect("one thread");
        counts.iter_mut().zip(found).for_each(|(sum, (after, before))| *sum += after - before);
    }
}

/// Returns the tasks for all sets of closest-point queries, given an index that counts and the same index as a trait
/// object.
fn point_tasks<'a, I: IndexStats<f64> + Sync>(
    backend: &'static str,
    index: &'a I,
    object: &'a counted_queries::Index<'a>,
    soup: &'a Soup<f64>,
    mode: QueryMode,
) -> impl Iterator<Item = Task<'a>> {
    SETS.into_iter().map(move |set| {
        let queries = points(set, soup);
        let same_queries = queries.clone();
        let run = move || counted_queries::run_queries(object, mode, &queries);
        let count = move || {
            let counted = Counted { index, counts: Mutex::default() };
            counted_queries::run_queries(&counted, mode, &same_queries);
            counted.counts.into_inner().expect("one thread")
        };
        Task { backend, set: set.name(), run: Box::new(run), count: Box::new(count) }
    })
}

/// Returns the task for rays from the scene's box, whose first hits are searched for.
fn ray_task<'a>(
    backend: &'static str,
    object: &'a dyn counted_queries::Tree,
    rays: &'a [Ray],
    visit: impl Fn(&'a Ray, &mut RayStatsCollector<Hits<'a>>) + 'a,
) -> Task<'a> {
    let run = move || counted_queries::run_rays(object, rays);
    let count = move || RayStatsCollector::count_rays(rays, &Hits::first(), &visit);
    Task { backend, set: "rays", run: Box::new(run), count: Box::new(count) }
}

/// A scene with all indexes that are measured.
#[derive(Clone)]
pub(crate) struct Indexes<'a> {
    soup: &'a Soup<f64>,
    rays: Vec<Ray>,
    aabb: AabbTree<f64, &'a Soup<f64>>,
    kdop: KdopTree<f64, &'a Soup<f64>, 14>,
    octree: OctreeIndex<f64, &'a Soup<f64>>,
    finer_octree: OctreeIndex<f64, &'a Soup<f64>>,
    p2m: P2mIndex<f64, &'a Soup<f64>>,
}

/// Returns the path of the file of an index.
fn file(folder: &Path, scene: &str, backend: &str) -> PathBuf {
    folder.join(format!("{scene}-{backend}.p2m"))
}

impl<'a> Indexes<'a> {
    pub(crate) fn build(soup: &'a Soup<f64>) -> Self {
        Self {
            soup,
            rays: rays(soup),
            aabb: AabbTree::new(soup).expect("valid"),
            kdop: KdopTree::new(soup).expect("valid"),
            octree: OctreeIndex::new(soup).expect("valid"),
            finer_octree: OctreeIndex::build_with(soup, &OctreeOptions::default().with_finer_cells(FINER))
                .expect("valid"),
            p2m: P2mIndex::new(soup).expect("valid"),
        }
    }

    pub(crate) fn save(&self, folder: &Path, scene: &str) {
        let write = |backend: &str, writer: &Writer<'_>| {
            let file = fs::File::create(file(folder, scene, backend)).expect("a folder to write to");
            writer.write(std::io::BufWriter::new(file)).expect("room on the disk");
        };
        let mut writers: [Writer<'_>; 5] = Default::default();
        self.aabb.save(&mut writers[0]);
        self.kdop.save(&mut writers[1]);
        self.octree.save(&mut writers[2]);
        self.p2m.save(&mut writers[3]);
        self.finer_octree.save(&mut writers[4]);
        ["aabb", "kdop", "octree", "p2m", "finer"]
            .iter()
            .zip(&writers)
            .for_each(|(backend, writer)| write(backend, writer));
    }

    pub(crate) fn load(soup: &'a Soup<f64>, folder: &Path, scene: &str) -> Self {
        // The files are not verified, because this takes long under valgrind.
        let open = |backend: &str| SavedFile::open(&file(folder, scene, backend)).expect("written by this program");
        Self {
            soup,
            rays: rays(soup),
            aabb: AabbTree::load(soup, open("aabb").unchecked()).expect("written by this program"),
            kdop: KdopTree::load(soup, open("kdop").unchecked()).expect("written by this program"),
            octree: OctreeIndex::load(soup, open("octree").unchecked()).expect("written by this program"),
            finer_octree: OctreeIndex::load(soup, open("finer").unchecked()).expect("written by this program"),
            p2m: P2mIndex::load(soup, open("p2m").unchecked()).expect("written by this program"),
        }
    }

    pub(crate) fn with_isa(self, isa: Isa) -> Self {
        let Self { aabb, kdop, octree, finer_octree, p2m, .. } = self;
        let (aabb, kdop, finer_octree) = (aabb.with_isa(isa), kdop.with_isa(isa), finer_octree.with_isa(isa));
        Self { aabb, kdop, octree: octree.with_isa(isa), finer_octree, p2m: p2m.with_isa(isa), ..self }
    }

    /// Returns all tasks, in the order of the table.
    pub(crate) fn tasks(&self) -> Vec<Task<'_>> {
        let Self { soup, rays, aabb, kdop, octree, finer_octree, p2m } = self;
        let (aabb_object, kdop_object) = (counted_queries::aabb_tree(aabb), counted_queries::kdop_tree(kdop));
        let (octree_object, p2m_object) = (counted_queries::octree(octree), counted_queries::p2m(p2m));
        let finer_object = counted_queries::octree(finer_octree);
        // Hints help trees, and interleaving helps cells.
        point_tasks("aabb", aabb, aabb_object, soup, QueryMode::Single)
            .chain([ray_task("aabb", aabb_object, rays, |ray, counting| aabb.visit_ray(ray, counting))])
            .chain(point_tasks("aabb batch", aabb, aabb_object, soup, QueryMode::Several))
            .chain(point_tasks("kdop-14", kdop, kdop_object, soup, QueryMode::Single))
            .chain([ray_task("kdop-14", kdop_object, rays, |ray, counting| kdop.visit_ray(ray, counting))])
            .chain(point_tasks("octree", octree, octree_object, soup, QueryMode::Single))
            .chain(point_tasks("octree batch", octree, octree_object, soup, QueryMode::Several))
            .chain(point_tasks("finer octree batch", finer_octree, finer_object, soup, QueryMode::Several))
            .chain(point_tasks("p2m", p2m, p2m_object, soup, QueryMode::Single))
            .chain(point_tasks("p2m batch", p2m, p2m_object, soup, QueryMode::Several))
            .collect()
    }
}
