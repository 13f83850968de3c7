//! The choice of `auto`: a tree of boxes, or an octree where its build pays, or a tree of k-DOPs for slivers.
//!
//! The tree is built first, since the octree contains it. A few of the queries are searched in the tree, and their
//! nodes and packets are counted. The octree saves most of that work, so these counts tell what it saves for each
//! query; its build costs a time for each primitive. If the scene consists of slivers, cells would fall back to the
//! tree. Where queries filter many packets then, the boxes fit badly: k-DOPs are built as well, and the tree with less
//! work wins. Where there are many more queries still, an octree has finer cells, even of slivers. No time is measured, so the choice depends on the scene, the queries and their number, and not on the load
//! of the machine; only near a break-even the roundings of instruction sets may differ.
//!
//! The constants were fitted to 15 scenes of 20,000 to 870,000 primitives ([decision 068]). Other indexes win rarely
//! enough in batches that `auto` does not consider them; [`recommend`](crate::recommend) measures all.
//!
//! [decision 068]: https://github.com/p2m-rs/p2m/blob/main/docs/decisions/068-auto-counts.md

use crate::advice::{is_mostly_slivers, sample_queries};
use crate::{BackendEntry, BuildSettings, BuiltIndex, QueryRegion, Workload};
use nalgebra::Point3;
use p2m_bvh::{AabbTree, SplitOptions};
use p2m_core::{Best, BuildError, BuildIndex, IndexStats, PrimitiveSet, QueryOptions, Soup, StatsCollector};
use p2m_interception::OctreeOptions;
use std::borrow::Cow;
use std::sync::Arc;

/// Nanoseconds for each node that a query visits, and for each packet that it filters.
struct Cost {
    node: f64,
    packet: f64,
}

/// The cost of a query in a tree of boxes, and in one of k-DOPs.
const BOXES: Cost = Cost { node: 34.0, packet: 45.0 };
const KDOPS: Cost = Cost { node: 55.0, packet: 45.0 };
/// The part of the cost in a tree of boxes that an octree saves.
const SAVED_BY_OCTREE: Cost = Cost { node: 10.0, packet: 30.0 };
/// The nanoseconds for each primitive that an octree takes to build, besides its tree, and a tree of k-DOPs.
const OCTREE_BUILD: f64 = 4500.0;
/// The factor of the resolution of finer cells.
const FINER: f64 = 10.0;
/// The nanoseconds for each primitive that finer cells take to build, besides the default ones.
const FINER_BUILD: f64 = 9000.0;
/// The part of what an octree saves that its finer cells save once more.
const SAVED_BY_FINER: f64 = 0.2;
/// The bytes of cells and their lists for each primitive, in clean meshes, and of finer cells.
const CELL_BYTES: f64 = 100.0;
const FINER_CELL_BYTES: f64 = 320.0;
const KDOP_BUILD: f64 = 400.0;
/// The number of packets per query from which on boxes may fit slivers badly.
const MANY_PACKETS: f64 = 20.0;
/// The part of the queries' time that k-DOPs are expected to save then.
const SAVED_BY_KDOPS: f64 = 0.4;
/// The part of the remaining time that finer cells save then, the nanoseconds for each primitive that their build takes,
/// and their bytes for each primitive.
const SAVED_BY_FINER_OF_SLIVERS: f64 = 0.6;
const FINER_BUILD_OF_SLIVERS: f64 = 100_000.0;
const FINER_CELL_BYTES_OF_SLIVERS: f64 = 2000.0;
/// The number of primitives of the smallest scene for which an octree may pay.
const MIN_PRIMITIVES: f64 = 512.0;
/// The largest number of queries that are counted.
const MAX_COUNTED: usize = 512;
/// The smallest number of queries that are counted. If there would be fewer, none are.
const MIN_COUNTED: usize = 8;
/// One of so many queries is counted.
const QUERIES_PER_COUNTED: u64 = 200;
/// The size of the space in which an octree has cells, in boxes of the scene around its centre.
const OCTREE_BOXES: f64 = 10.0;

/// The index that suits a scene and a workload.
pub struct Choice {
    index: Chosen,
    backend: &'static BackendEntry,
    /// The resolution of an octree, unless it is the default one.
    resolution: Option<f64>,
    /// The largest number of bytes of the cells and lists of an octree.
    max_cell_bytes: usize,
    reason: Option<Reason>,
}

/// What a choice has built.
enum Chosen {
    /// The tree, which is the index or becomes a part of it.
    Tree(Box<AabbTree<f64, Arc<Soup<f64>>>>),
    /// An index, with its scene.
    Index(BuiltIndex, Arc<Soup<f64>>),
}

/// The reason of a choice, if queries were counted.
enum Reason {
    /// An octree pays from the first number of queries on, and finer cells from the second one on.
    OctreeFrom([f64; 2]),
    /// The numbers of packets per query in trees of boxes and of k-DOPs, for slivers.
    Packets([f64; 2]),
}

/// The mean work of a query.
struct Work {
    nodes: f64,
    packets: f64,
}

impl Work {
    /// Counts the work of some queries.
    fn of(index: &(impl IndexStats<f64> + ?Sized), queries: &[&Point3<f64>], max_distance: f64) -> Self {
        let options = QueryOptions::default().with_max_distance(max_distance);
        let visit = |query: &Point3<f64>, stats: &mut StatsCollector<f64>| {
            stats.best = Best::new(&options);
            index.inspect(query, stats);
        };
        let [nodes, packets, _] = StatsCollector::count_queries(queries.iter().copied(), visit);
        let count = queries.len().max(1) as f64;
        Self { nodes: nodes as f64 / count, packets: packets as f64 / count }
    }

    fn nanoseconds(&self, cost: &Cost) -> f64 {
        self.nodes * cost.node + self.packets * cost.packet
    }
}

impl Choice {
    /// Builds a tree over a scene, and chooses the index for a workload. Its limit of time has no effect.
    ///
    /// ```
    /// use p2m_backends::{Choice, QueryRegion, Workload};
    /// use p2m_mixed::generate::{IcoSphere, ico_sphere};
    /// use std::sync::Arc;
    ///
    /// let ball = Arc::new(ico_sphere(&IcoSphere::default()).unwrap());
    /// let few = Choice::new(Arc::clone(&ball), &Workload::new(1_000, QueryRegion::SceneBox))?;
    /// let many = Choice::new(ball, &Workload::new(10_000_000, QueryRegion::SceneBox))?;
    /// assert_eq!((few.backend().name, many.backend().name), ("aabb", "octree"));
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    ///
    /// # Errors
    /// [`BuildError`] for a scene with coordinates that are not finite, or with too many primitives.
    ///
    /// # Panics
    /// It does not panic: the registry has all three indexes.
    ///
    /// # Complexity
    /// It builds one tree or two, and searches for one of 200 queries, up to 512 of them.
    pub fn new(soup: Arc<Soup<f64>>, workload: &Workload<'_>) -> Result<Self, BuildError> {
        let entry = |name| BackendEntry::find(name).expect("a name of the registry");
        let (octree, kdop) = (entry("octree"), entry("kdop"));
        let primitives = soup.len() as f64;
        let tree = Box::new(AabbTree::build(Arc::clone(&soup), &SplitOptions::default())?);
        let max_cell_bytes = workload.max_bytes.saturating_sub(tree.memory());
        let finer = Some(OctreeOptions::default().resolution * FINER);
        let choice = |index, backend, reason| Self { index, backend, resolution: None, max_cell_bytes, reason };
        let boxes = |tree, reason| choice(Chosen::Tree(tree), BackendEntry::default_backend(), reason);
        let wanted = usize::try_from(workload.queries / QUERIES_PER_COUNTED).unwrap_or(MAX_COUNTED).min(MAX_COUNTED);
        // A tree of one or two levels leaves nothing to save.
        if wanted < MIN_COUNTED || primitives < MIN_PRIMITIVES {
            return Ok(boxes(tree, None));
        }
        let sample = match workload.region {
            QueryRegion::Like(points) => Cow::Borrowed(points),
            region => Cow::Owned(sample_queries(&soup, &soup, region, MAX_COUNTED)),
        };
        let chosen = sample.iter().step_by(sample.len().div_ceil(wanted).max(1)).take(wanted);
        // A query that is not finite has no answer and takes no time.
        let counted: Vec<_> = chosen.clone().filter(|query| query.iter().all(|x| x.is_finite())).collect();
        if counted.len() < MIN_COUNTED {
            return Ok(boxes(tree, None));
        }
        let queries = workload.queries as f64 * counted.len() as f64 / chosen.count() as f64;
        let work = Work::of(&*tree, &counted, workload.max_distance);
        if !is_mostly_slivers(&soup) {
            if CELL_BYTES * primitives > max_cell_bytes as f64 {
                return Ok(boxes(tree, None));
            }
            // Farther away the tree in the octree answers.
            let bounds = soup.aabb();
            let (centre, half) =
                (nalgebra::center(&bounds.min, &bounds.max), (bounds.max - bounds.min) * (OCTREE_BOXES / 2.0));
            let reach = half.x.max(half.y).max(half.z);
            let near = counted.iter().filter(|query| (**query - centre).amax() <= reach).count();
            let saved = work.nanoseconds(&SAVED_BY_OCTREE) * near as f64 / counted.len() as f64;
            let least = [OCTREE_BUILD / saved, FINER_BUILD / (saved * SAVED_BY_FINER)].map(|each| each * primitives);
            let backend = if queries > least[0] { octree } else { BackendEntry::default_backend() };
            let is_finer = queries > least[1] && FINER_CELL_BYTES * primitives <= max_cell_bytes as f64;
            let resolution = finer.filter(|_| is_finer);
            let reason = Some(Reason::OctreeFrom(least));
            return Ok(Self { resolution, ..choice(Chosen::Tree(tree), backend, reason) });
        }
        let saved = queries * work.nanoseconds(&BOXES) * SAVED_BY_KDOPS;
        if work.packets < MANY_PACKETS || saved < KDOP_BUILD * primitives {
            return Ok(boxes(tree, None));
        }
        let built = kdop.build(Arc::clone(&soup), &BuildSettings::default())?;
        let kdops = Work::of(&*built.index, &counted, workload.max_distance);
        let reason = Some(Reason::Packets([work.packets, kdops.packets]));
        let [kdop_time, box_time] = [kdops.nanoseconds(&KDOPS), work.nanoseconds(&BOXES)];
        let saved = queries * kdop_time.min(box_time) * SAVED_BY_FINER_OF_SLIVERS;
        if saved > FINER_BUILD_OF_SLIVERS * primitives
            && FINER_CELL_BYTES_OF_SLIVERS * primitives <= max_cell_bytes as f64
        {
            return Ok(Self { resolution: finer, ..choice(Chosen::Tree(tree), octree, reason) });
        }
        if kdop_time < box_time {
            return Ok(choice(Chosen::Index(built, soup), kdop, reason));
        }
        Ok(boxes(tree, reason))
    }

    /// The backend that was chosen.
    #[must_use]
    pub fn backend(&self) -> &'static BackendEntry {
        self.backend
    }

    /// The resolution of the cells of an octree, unless it is the default one.
    #[must_use]
    pub fn resolution(&self) -> Option<f64> {
        self.resolution
    }

    /// The reason of the choice as a phrase for people, if there is one.
    #[must_use]
    pub fn reason(&self) -> Option<String> {
        Some(match self.reason.as_ref()? {
            Reason::OctreeFrom(least) => {
                let [coarse, fine] = least.map(rounded);
                format!("an octree pays from about {coarse} queries on, and finer cells from {fine}")
            }
            Reason::Packets([boxes, kdops]) => {
                format!("slivers: a query filters about {boxes:.0} packets with boxes, and {kdops:.0} with k-DOPs")
            }
        })
    }

    /// Builds the index that was chosen. A resolution in the settings is used in place of the chosen one.
    ///
    /// # Errors
    /// Those of [`BackendEntry::build`].
    pub fn build(self, settings: &BuildSettings<'_>) -> Result<BuiltIndex, BuildError> {
        let settings = &settings.with_resolution(settings.resolution.or(self.resolution));
        let settings = &settings.with_max_cell_bytes(settings.max_cell_bytes.min(self.max_cell_bytes));
        match self.index {
            Chosen::Tree(tree) => self.backend.build_on(*tree, settings),
            // Other directions were asked for.
            Chosen::Index(_, soup) if settings.kdop_directions.is_some() => self.backend.build(soup, settings),
            Chosen::Index(built, _) => Ok(built),
        }
    }
}

/// Returns a number with two digits, as people read it.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least 0 and rounded")]
fn rounded(number: f64) -> String {
    if number.is_infinite() {
        return "infinitely many".to_owned();
    }
    let unit = 10f64.powf(number.max(10.0).log10().floor() - 1.0);
    let number = (number / unit).round() * unit;
    match number.round() as u64 {
        small @ ..1000 => small.to_string(),
        n @ 1000..1_000_000 => format!("{},{:03}", n / 1000, n % 1000),
        _ => format!("{:.1} million", number / 1e6),
    }
}
