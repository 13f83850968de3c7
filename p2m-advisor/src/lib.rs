//! Which index a scene and its queries call for.
//!
//! [`recommend`] estimates for each index how long it takes to build, to answer all queries, and what memory it takes, and chooses
//! the one with the least time in all that fits. It asks a *patch*, over which each index that may win is built and asked: the
//! primitives around a few of them for queries near the surface, some from everywhere for others. What that gives for a primitive
//! and for a query is scaled to the whole scene: building by the number of primitives, queries by a growth for each doubling that
//! is known for each index ([`Choice`]). Indexes that take longer to build than the tree does to be built and to answer everything
//! cannot win, and are not asked; nor are cells of slivers, which end at trees, and those that already take long for a handful of
//! primitives.
//!
//! The patch is as large as the time for advice permits, a part of what the job takes; and where indexes are close to each other
//! they are asked once more over a larger one. So advice is never a large part of the job. Where there is not even time for a small
//! patch, the figures of docs/paper.md decide. Constants were found on the models of `p2m-bench advise`, which tells how good they
//! are.
//!
//! Estimates are for one thread. They depend on the machine and its load, so advice may differ from run to run where two indexes are about as
//! good.

use nalgebra::{Point3, Vector3};
use p2m_bvh::{AabbOptions, AabbTree};
use p2m_core::{
    BruteForce, BuildError, BuildIndex, Closest, ClosestPoint, Element, Primitive, PrimitiveId, PrimitiveSet,
    QueryOptions, Soup,
};
use p2m_interception::{OctreeIndex, OctreeOptions, P2mIndex, P2mOptions};
use p2m_kdop::{KdopOptions, KdopTree};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::collections::HashMap;
use std::fmt;
use std::time::{Duration, Instant};

/// An index to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Choice {
    /// `BruteForce`
    Brute,
    /// `AabbTree`
    Aabb,
    /// `KdopTree` of 14 faces
    Kdop,
    /// `OctreeIndex`
    Octree,
    /// `P2mIndex`, asked for several queries at a time
    P2m,
}

impl Choice {
    /// All of them, simplest first.
    pub const ALL: [Self; 5] = [Self::Brute, Self::Aabb, Self::Kdop, Self::Octree, Self::P2m];

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Brute => "brute",
            Self::Aabb => "aabb",
            Self::Kdop => "kdop",
            Self::Octree => "octree",
            Self::P2m => "p2m",
        }
    }

    /// Queries take so much longer for each doubling of the scene, from a patch of it or from a thinned one (observed, in the mean
    /// over the models).
    fn growth(self, is_near: bool) -> f64 {
        match (self, is_near) {
            (Self::Brute, _) => 2.0,
            (Self::Aabb | Self::Kdop, true) => 1.11,
            (Self::Octree, true) => 1.15,
            (Self::P2m, true) => 1.12,
            (Self::Aabb | Self::Kdop, false) => 1.27,
            (Self::Octree, false) => 1.23,
            (Self::P2m, false) => 1.24,
        }
    }

    /// What is known before anything is measured.
    fn prior(self) -> Prior {
        let prior = |build, near, inside, bytes| Prior { build, near, inside, bytes };
        match self {
            Self::Brute => prior(0.04e-6, 0.0, 0.0, 0.0),
            Self::Aabb => prior(0.75e-6, 700e-9, 1200e-9, 65.0),
            Self::Kdop => prior(0.8e-6, 750e-9, 1250e-9, 66.0),
            Self::Octree => prior(10e-6, 640e-9, 690e-9, 235.0),
            Self::P2m => prior(32e-6, 430e-9, 500e-9, 330.0),
        }
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// What is known of an index before anything is measured: the figures of dragon_100k in docs/paper.md.
struct Prior {
    /// Seconds that building takes for each primitive.
    build: f64,
    /// Seconds of a query near the surface of that scene.
    near: f64,
    /// Seconds of a query in the box of that scene.
    inside: f64,
    /// Bytes of the index for each primitive.
    bytes: f64,
}

/// The primitives of that scene.
const PRIOR_SIZE: f64 = 100_000.0;
/// Seconds that a query of brute force takes for each primitive.
const SECONDS_A_PRIMITIVE_OF_BRUTE_FORCE: f64 = 48e-9;
/// The part of the job that is spent on a first patch, with all that may win; and on both patches, the second one with those that are
/// close to the best.
const FIRST: f64 = 0.022;
const SECOND: f64 = 0.021;
/// The first part where trees alone may win, which take about as long as expected.
const TREES: f64 = 0.027;
/// Within this times the best.
const CLOSE: f64 = 1.6;
/// Patches have so many primitives at least and at most.
const FEWEST: usize = 300;
const MOST: usize = 65_536;
/// Parts of a patch.
const PATCHES: usize = 4;
/// Patches face few ways, which flatters k-DOPs by this (observed).
const FLATTERED: f64 = 1.08;
/// Seconds that finding a patch takes for each primitive of the scene.
const SECONDS_A_PRIMITIVE_OF_FINDING: f64 = 30e-9;
/// The primitives of a probe, a thinned scene over which the P2M index is built on trial.
const PROBE: usize = 300;
/// Seconds that building a probe usually takes for each of its primitives.
const SECONDS_A_PRIMITIVE_OF_A_PROBE: f64 = 50e-6;
/// A probe that takes so many times as long is a reason not to build the P2M index.
const TOO_LONG: f64 = 1.2;
/// The height of a sliver in longest edges,
const SLIVER: f64 = 1.0 / 256.0;
/// and the time that k-DOPs take for them in that of boxes (observed).
const KDOP_OF_SLIVERS: f64 = 0.75;
/// Queries that are timed, at least and at most.
const QUERIES: [usize; 2] = [64, 512];

/// Where queries are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place<'a> {
    /// About a hundredth of the diagonal from the surface.
    Near,
    /// In the box of the scene.
    Box,
    /// As these are.
    Points(&'a [Point3<f64>]),
}

/// What an index is wanted for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Workload<'a> {
    /// How many queries.
    pub queries: u64,
    /// Where they are.
    pub place: Place<'a>,
    /// The most bytes that the index may take; any by default.
    pub memory: usize,
    /// The most time for advice, beside the part of the job that it takes anyway; any by default.
    pub patience: Duration,
}

impl<'a> Workload<'a> {
    /// So many queries there.
    #[must_use]
    pub fn new(queries: u64, place: Place<'a>) -> Self {
        Self { queries, place, memory: usize::MAX, patience: Duration::MAX }
    }
    /// With so much memory.
    #[must_use]
    pub fn with_memory(self, memory: usize) -> Self {
        Self { memory, ..self }
    }
    /// With so much time for advice.
    #[must_use]
    pub fn with_patience(self, patience: Duration) -> Self {
        Self { patience, ..self }
    }
}

/// What is expected of an index.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Which one.
    pub choice: Choice,
    /// Seconds to build it.
    pub build: f64,
    /// Seconds a query.
    pub query: f64,
    /// Bytes, beside the scene.
    pub memory: f64,
    /// Seconds for everything.
    pub total: f64,
    /// Whether it was asked, on a part of the scene.
    pub is_measured: bool,
    /// From how many queries on it is faster than the recommended one, or up to how many that is faster than this; `None` if
    /// one of both is always faster.
    pub break_even: Option<f64>,
    why: Why,
}

/// Why an index is recommended or not.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Why {
    Best,
    TooLarge,
    BuildTooLong,
    QueriesTooLong,
}

impl Estimate {
    /// Why it is recommended, or not, in a sentence.
    #[must_use]
    pub fn reason(&self) -> String {
        let times = |n: f64| if n < 1e6 { format!("{n:.0}") } else { format!("{:.1} million", n / 1e6) };
        match (self.why, self.break_even) {
            (Why::Best, _) => "the least time for building and all queries".to_owned(),
            (Why::TooLarge, _) => format!("takes about {:.0} MB, more than there may be", self.memory / 1e6),
            (Why::BuildTooLong, Some(n)) => format!("takes longer to build; it pays from {} queries on", times(n)),
            (Why::BuildTooLong, None) => "takes longer to build, and is not faster then".to_owned(),
            (Why::QueriesTooLong, Some(n)) => format!("is built sooner, but pays up to {} queries alone", times(n)),
            (Why::QueriesTooLong, None) => "takes longer for queries".to_owned(),
        }
    }
}

/// What [`recommend`] says.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Advice {
    /// All indexes, the recommended one first, then by time.
    pub estimates: Vec<Estimate>,
    /// Seconds that the advice took.
    pub seconds: f64,
    /// The primitives of the patch that was asked; 0 if nothing was measured.
    pub patch: usize,
}

impl Advice {
    /// The recommended index.
    #[must_use]
    pub fn choice(&self) -> Choice {
        self.estimates[0].choice
    }
}

/// Which index a scene and its queries call for.
///
/// ```
/// use p2m_advisor::{Choice, Place, Workload, recommend};
/// use p2m_mixed::generate::{IcoSphere, ico_sphere};
///
/// let ball = ico_sphere(&IcoSphere::default()).unwrap();
/// // A handful of queries is not worth an index; ten million are.
/// assert_eq!(recommend(&ball, &Workload::new(1, Place::Box))?.choice(), Choice::Brute);
/// let advice = recommend(&ball, &Workload::new(10_000_000, Place::Box))?;
/// assert_ne!(advice.choice(), Choice::Brute);
/// println!("{}: {}", advice.choice(), advice.estimates[0].reason());
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// # Errors
/// Those of building an index: for a scene that is not finite.
///
/// # Complexity
/// O(n) for finding the patch, and some per cent of the job.
pub fn recommend(soup: &Soup<f64>, workload: &Workload<'_>) -> Result<Advice, BuildError> {
    let start = Instant::now();
    let (count, queries) = (soup.len().max(1) as f64, workload.queries as f64);
    let doublings = |from: f64| (count / from).log2();
    let place = workload.place;
    let is_near = match place {
        Place::Near => true,
        Place::Box => false,
        Place::Points(points) => are_near(soup, points),
    };
    let mut estimates = Choice::ALL.map(|choice| {
        let prior = choice.prior();
        let query = match choice {
            Choice::Brute => SECONDS_A_PRIMITIVE_OF_BRUTE_FORCE * count,
            _ => (if is_near { prior.near } else { prior.inside }) * choice.growth(true).powf(doublings(PRIOR_SIZE)),
        };
        Estimate {
            choice,
            build: prior.build * count,
            query,
            memory: prior.bytes * count,
            total: 0.0,
            is_measured: false,
            break_even: None,
            why: Why::Best,
        }
    });
    let of_slivers = is_of_slivers(soup);
    if of_slivers {
        estimates[2].query = estimates[1].query * KDOP_OF_SLIVERS;
    }
    let total = |e: &Estimate| e.build + queries * e.query;
    let of_tree = total(&estimates[1]);
    // Those that may win: trees, and what is not built for longer than the tree takes for all (twice, for priors are rough).
    let is_tree = |e: &Estimate| matches!(e.choice, Choice::Aabb | Choice::Kdop);
    let may_win = |e: &Estimate| is_tree(e) || e.choice != Choice::Brute && !of_slivers && e.build < 2.0 * of_tree;
    let least = |estimates: &[Estimate; 5]| estimates.iter().map(total).fold(f64::INFINITY, f64::min);
    if !is_near && may_win(&estimates[4]) && soup.len() > PROBE {
        // Cells of a thinned scene take longer, some of them a hundred times, and have long lists then.
        let (build, ..) = Choice::P2m.measure(&thinned(soup, PROBE)?, &[])?;
        let each = build / PROBE as f64;
        if each > TOO_LONG * SECONDS_A_PRIMITIVE_OF_A_PROBE {
            (estimates[4].build, estimates[4].query) = (each * count, estimates[1].query);
        } else {
            estimates[4].build = 1.5 * each * count;
        }
    }
    // What building took for each primitive of a patch, or may take.
    let mut each = estimates.map(|e| e.build / count);
    let mut patch = 0;
    let mut spent = start.elapsed().as_secs_f64();
    for (share, contenders) in [(FIRST, f64::INFINITY), (SECOND, CLOSE)] {
        let best = least(&estimates);
        // Priors may be wrong by a factor of two, but for trees.
        let trees_alone = estimates.iter().all(|e| !may_win(e) || is_tree(e));
        let share = match patch {
            0 if trees_alone => TREES,
            0 => share / 2.0,
            _ => share,
        };
        let budget = (best * share).min(workload.patience.as_secs_f64()) - spent;
        let is_asked = |e: &Estimate| may_win(e) && total(e) <= contenders * best;
        if patch > 0 && estimates.iter().filter(|e| is_asked(e)).count() < 2 {
            break;
        }
        let a_primitive: f64 = estimates.iter().zip(&each).filter(|(e, _)| is_asked(e)).map(|(_, each)| *each).sum();
        // A third of the budget is for queries.
        let a_query: f64 = estimates.iter().filter(|e| is_asked(e)).map(|e| 2.0 * e.query).sum();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let asked = ((budget / 3.0 / a_query) as usize).clamp(QUERIES[0], QUERIES[1]);
        let asking = asked as f64 * a_query;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let affordable = ((budget - asking - 2.0 * SECONDS_A_PRIMITIVE_OF_FINDING * count) / a_primitive) as usize;
        // Twice as much as before, at least.
        let size = affordable.min(MOST).min(soup.len());
        if size < (2 * patch).max(FEWEST) {
            break;
        }
        let part = if is_near { patch_of(soup, size)? } else { thinned(soup, size)? };
        patch = part.len();
        let places = places(soup, &part, place, asked);
        let times = count / patch as f64;
        // Vertices of a thinned scene are hardly shared, and a P2M index has cells of vertices.
        let cells = (times * soup.positions().len() as f64 / part.positions().len().max(1) as f64).sqrt();
        for (estimate, each) in estimates.iter_mut().zip(&mut each).filter(|(e, _)| is_asked(e)) {
            let (build, query, memory) = estimate.choice.measure(&part, &places)?;
            let growth = estimate.choice.growth(is_near).powf(doublings(patch as f64));
            let is_flattered = estimate.choice == Choice::Kdop && !of_slivers && patch < soup.len();
            let growth = if is_flattered { growth * FLATTERED } else { growth };
            let times = if estimate.choice == Choice::P2m { cells } else { times };
            (estimate.build, estimate.query, estimate.memory) = (build * times, query * growth, memory * times);
            // It grows, if it does, by less than this for twice as many.
            *each = 1.3 * build / patch as f64;
            estimate.is_measured = true;
        }
        spent = start.elapsed().as_secs_f64();
    }
    if of_slivers {
        // Cells end at trees.
        let of_tree = estimates[1].query;
        estimates[3..].iter_mut().for_each(|e| e.query = of_tree);
    }
    estimates.iter_mut().for_each(|e| e.total = total(e));
    let fits = |e: &Estimate| e.memory <= workload.memory as f64;
    let mut estimates = estimates.to_vec();
    estimates.sort_by(|a, b| fits(b).cmp(&fits(a)).then(a.total.total_cmp(&b.total)));
    let best = estimates[0];
    for other in &mut estimates[1..] {
        let meeting = (other.build - best.build) / (best.query - other.query);
        other.break_even = (meeting > 0.0 && meeting.is_finite()).then_some(meeting);
        other.why = if !fits(other) {
            Why::TooLarge
        } else if other.build > best.build {
            Why::BuildTooLong
        } else {
            Why::QueriesTooLong
        };
    }
    Ok(Advice { estimates, seconds: start.elapsed().as_secs_f64(), patch })
}

/// Whether most primitives are slivers: places have many of them about as near, so lists are long and cells end at trees. Patches, in
/// which few of them come together, do not show it.
fn is_of_slivers(soup: &Soup<f64>) -> bool {
    let is_sliver = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| soup.positions()[i as usize]);
        let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        (b - a).cross(&(c - a)).norm() < SLIVER * longest
    };
    let step = soup.triangles().len().div_ceil(4096).max(1);
    let slivers = soup.triangles().iter().step_by(step).filter(|t| is_sliver(t)).count();
    2 * slivers * step > soup.len()
}

impl Choice {
    /// Seconds to build, seconds a query, bytes: over a part of a scene, on one thread.
    fn measure(self, part: &Soup<f64>, places: &[Point3<f64>]) -> Result<(f64, f64, f64), BuildError> {
        let splits = AabbOptions::default().with_parallel(false);
        match self {
            Self::Brute => timed(|| BruteForce::build(part, &()), |_| 0, places),
            Self::Aabb => timed(|| AabbTree::build(part, &splits), AabbTree::memory, places),
            Self::Kdop => {
                let options = KdopOptions::default().with_splits(splits);
                timed(|| KdopTree::<f64, _, 14>::build(part, &options), KdopTree::memory, places)
            }
            Self::Octree => {
                let usual = OctreeOptions::default();
                // Budgets are for 10,000 primitives at least, which a small part should not have to itself.
                let budget = (part.len() as f64 / 10_000.0).min(1.0);
                let options =
                    usual.with_splits(splits).with_memory(usual.memory * budget).with_work(usual.work * budget);
                timed(|| OctreeIndex::build(part, &options), OctreeIndex::memory, places)
            }
            Self::P2m => {
                let options = P2mOptions::default().with_splits(splits);
                timed(|| P2mIndex::build(part, &options), P2mIndex::memory, places)
            }
        }
    }
}

fn timed<I: ClosestPoint<f64>>(
    build: impl FnOnce() -> Result<I, BuildError>,
    memory: impl FnOnce(&I) -> usize,
    places: &[Point3<f64>],
) -> Result<(f64, f64, f64), BuildError> {
    let start = Instant::now();
    let index = build()?;
    let built = start.elapsed().as_secs_f64();
    let mut answers: Vec<Option<Closest<f64>>> = vec![None; places.len()];
    // The second time what is asked is in the cache, as it is in the midst of many queries.
    let mut least = f64::INFINITY;
    for _ in 0..2 {
        let start = Instant::now();
        index.closest_points_into(places, &QueryOptions::default(), &mut answers);
        least = least.min(start.elapsed().as_secs_f64());
    }
    std::hint::black_box(&answers);
    Ok((built, least / places.len().max(1) as f64, memory(&index) as f64))
}

/// The middle of a primitive's box.
fn middle(soup: &Soup<f64>, i: usize) -> Point3<f64> {
    let bounds = soup.get(PrimitiveId::new(i)).aabb();
    Point3::from(bounds.min.coords * 0.5 + bounds.max.coords * 0.5)
}

/// The primitives around some of them, from everywhere in their order: around one alone they would face one way.
fn patch_of(soup: &Soup<f64>, count: usize) -> Result<Soup<f64>, BuildError> {
    if count >= soup.len() {
        return part_of(soup, 0..soup.len());
    }
    let centres: [Point3<f64>; PATCHES] =
        std::array::from_fn(|i| middle(soup, soup.len() * (2 * i + 1) / (2 * PATCHES)));
    let mut nearest: [Vec<(f64, usize)>; PATCHES] = Default::default();
    for i in 0..soup.len() {
        let middle = middle(soup, i);
        let ways = centres.iter().map(|centre| (middle - centre).norm_squared()).enumerate();
        // Each primitive is of one patch.
        if let Some((patch, way)) = ways.reduce(|a, b| if b.1 < a.1 { b } else { a }) {
            nearest[patch].push((way, i));
        }
    }
    for ways in &mut nearest {
        let own = count / PATCHES;
        if own < ways.len() {
            ways.select_nth_unstable_by(own, |a, b| a.0.total_cmp(&b.0));
            ways.truncate(own);
        }
    }
    part_of(soup, nearest.into_iter().flatten().map(|(_, i)| i))
}

/// Primitives from everywhere in a scene: what is about as far from much of it stays so.
fn thinned(soup: &Soup<f64>, count: usize) -> Result<Soup<f64>, BuildError> {
    let count = count.min(soup.len());
    part_of(soup, (0..count).map(|i| i * soup.len() / count))
}

/// Some primitives, with their vertices shared as in the scene.
fn part_of(soup: &Soup<f64>, ids: impl Iterator<Item = usize>) -> Result<Soup<f64>, BuildError> {
    let mut part = Soup::default();
    let mut numbers = HashMap::new();
    for i in ids {
        let mut number = |position: u32| {
            *numbers.entry(position).or_insert_with(|| {
                // A part has no more positions than the scene.
                u32::try_from(part.push_position(soup.positions()[position as usize])).unwrap_or(u32::MAX)
            })
        };
        let element = match soup.element(PrimitiveId::new(i)) {
            Element::Point(p) => Element::Point(number(p)),
            Element::Segment(s) => Element::Segment(s.map(&mut number)),
            Element::Triangle(t) => Element::Triangle(t.map(&mut number)),
        };
        part.push(element)?;
    }
    Ok(part)
}

/// What is asked of a part: places like those of the workload.
fn places(soup: &Soup<f64>, part: &Soup<f64>, place: Place<'_>, count: usize) -> Vec<Point3<f64>> {
    let bounds = part.aabb();
    if let Place::Points(points) = place {
        // Those nearest to the part.
        let centre = Point3::from(bounds.min.coords * 0.5 + bounds.max.coords * 0.5);
        let stride = points.len().div_ceil(64 * count).max(1);
        let finite = points.iter().step_by(stride).filter(|p| p.iter().all(|x| x.is_finite()));
        let mut ways: Vec<(f64, &Point3<f64>)> = finite.map(|p| ((p - centre).norm_squared(), p)).collect();
        ways.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        return ways.into_iter().take(count).map(|(_, p)| *p).collect();
    }
    let mut random = ChaCha8Rng::seed_from_u64(part.len() as u64);
    #[allow(clippy::cast_precision_loss, reason = "53 bits")]
    let mut unit = move || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let scene = soup.aabb();
    let sigma = 0.01 * (scene.max.coords * 0.5 - scene.min.coords * 0.5).norm() * 2.0;
    (0..count)
        .map(|_| match place {
            Place::Near => {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below the count")]
                let i = (unit() * part.len() as f64) as usize;
                // Three of these add up to about a normal distribution of variance 1/4 in each coordinate.
                let mut offset = || (unit() + unit() + unit() - 1.5) * 2.0 * 0.58;
                middle(part, i.min(part.len() - 1)) + Vector3::new(offset(), offset(), offset()) * sigma
            }
            _ => std::array::from_fn::<f64, 3, _>(|k| {
                let t = unit();
                bounds.min[k] * (1.0 - t) + bounds.max[k] * t
            })
            .into(),
        })
        .collect()
}

/// Whether most of some points are within some hundredths of the diagonal from the middles of some primitives; their cost is that of
/// queries near the surface then.
fn are_near(soup: &Soup<f64>, points: &[Point3<f64>]) -> bool {
    let bounds = soup.aabb();
    let reach = 0.05 * (bounds.max.coords * 0.5 - bounds.min.coords * 0.5).norm() * 2.0;
    let middles: Vec<Point3<f64>> =
        (0..soup.len()).step_by(soup.len().div_ceil(512).max(1)).map(|i| middle(soup, i)).collect();
    let some = points.iter().step_by(points.len().div_ceil(64).max(1));
    let near = some.clone().filter(|p| middles.iter().any(|m| (*p - m).norm() <= reach)).count();
    2 * near > some.count()
}
