//! A repeatable gate for performance: it compares the work of a query with a table, for each backend and query set.
//!
//! `tests/instructions.csv` has the nodes, packets and primitives that a query visits, and the instructions that it
//! executes with the portable instruction set and with AVX2. No time is measured.
//!
//! - **Counters** are taken in this process with the portable instruction set, and do not depend on the number of
//!   threads. They have to be exactly those of the table; after an improvement the table is renewed.
//! - **Instructions** are counted by callgrind, if valgrind is installed: this program saves the indexes and starts
//!   itself under valgrind, which counts the queries only. Instructions depend on the compiler, the target and the
//!   profile, so they are left out, with a message, if those are not the table's. The test fails for a query that takes
//!   more instructions than the table has, beyond a tolerance, and prints a message for one that takes fewer.
//!
//! `CARGO_INCREMENTAL=0 P2M_BLESS=1 cargo test --test instructions` writes the table anew. The table is made for the
//! profile `test`, which optimises the libraries in which the counted code is compiled, and not this program.

use nalgebra::Point3;
use p2m::backend::{Best, Hits, RayStatsCollector, StatsCollector};
use p2m::scene::generate::{IcoSphere, Subdivide, ico_sphere, subdivide};
use p2m::storage::{SavedFile, Writer};
use p2m::{AabbTree, BuildIndex, ClosestPoint, Inspect, Isa, KdopTree, OctreeIndex, P2mIndex, Ray, Soup};
use p2m_testkit::compiled;
use p2m_testkit::counted_queries::{self, QueryMode};
use p2m_testkit::queries::QuerySet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Mutex;
use std::{env, fs};

/// The number of queries of each set. A count divided by 200 has at most three decimals, so the table has all of them.
const QUERIES: usize = 200;
/// The seed of all queries.
const SEED: u64 = 1;
/// The fraction by which the instructions of a query may exceed those of the table. The same code takes up to 0.4 %
/// more or fewer at another address of the stack, and up to 0.2 % after a change of unrelated functions.
const TOLERANCE: f64 = 0.02;
/// The tolerance for crates that are compiled incrementally, in smaller parts with less inlining between them. The same
/// code takes up to 3.8 % more instructions.
const TOLERANCE_OF_INCREMENTAL: f64 = 0.06;
/// The scenes, in the order of the table.
const SCENES: [&str; 2] = ["knot_and_cables", "scan"];
/// The query sets of closest points.
const SETS: [QuerySet; 4] = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near, QuerySet::Surface];
/// The instruction sets whose instructions are counted. AVX-512 is missing, because valgrind does not support it.
const INSTRUCTION_SETS: [&str; 2] = ["portable", "avx2"];
/// The columns of figures.
const COLUMNS: [&str; 5] = ["nodes", "packets", "primitives", "portable", "avx2"];
/// The number of columns that are counters.
const COUNTERS: usize = 3;
/// Whether counters are compared without the tolerance. If the portable instruction set has fused multiply-add, bounds
/// differ in their last bits from those of the table, and counters may differ.
const IS_EXACT: bool = cfg!(all(target_arch = "x86_64", not(target_feature = "fma")));
/// The argument that makes this program run all queries on the indexes of a folder.
const MEASURE: &str = "--measure-in=";
/// The command that renews the table.
const RENEWAL: &str = "CARGO_INCREMENTAL=0 P2M_BLESS=1 cargo test --test instructions";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    if let Some(folder) = arguments.iter().find_map(|argument| argument.strip_prefix(MEASURE)) {
        run_everything(Path::new(folder));
        return ExitCode::SUCCESS;
    }
    if is_selected(&arguments) { check_table() } else { ExitCode::SUCCESS }
}

/// The name of the only test.
const NAME: &str = "work_is_that_of_the_table";

/// Returns whether the arguments of a test program select this test. If they request a list of the tests,
/// it is printed.
fn is_selected(arguments: &[String]) -> bool {
    let is_set = |flag: &str| arguments.iter().any(|argument| argument == flag);
    let (mut filters, mut skips) = (Vec::new(), Vec::new());
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--skip" => skips.extend(rest.next()),
            "--test-threads" | "--format" | "--color" | "--logfile" | "--shuffle-seed" | "-Z" => drop(rest.next()),
            _ if !argument.starts_with('-') => filters.push(argument),
            _ => {}
        }
    }
    let matches = |filter: &&String| if is_set("--exact") { *filter == NAME } else { NAME.contains(filter.as_str()) };
    let is_chosen = (filters.is_empty() || filters.iter().any(matches)) && !skips.iter().any(matches);
    let is_chosen = is_chosen && !is_set("--ignored");
    if is_set("--list") {
        if is_chosen {
            println!("{NAME}: test");
        }
        return false;
    }
    is_chosen
}

/// Returns a rough lump of 11,520 triangles, which is noisy like a scan and the same on every platform.
fn scan() -> Soup<f64> {
    let lump = ico_sphere(&IcoSphere::default().with_frequency(3)).expect("valid options");
    subdivide(&lump, &Subdivide::default().with_levels(3).with_amplitude(0.15)).expect("valid options")
}

fn scene(name: &str) -> Soup<f64> {
    let carried = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.obj"));
    if name == "scan" { scan() } else { p2m::scene::read_scene(&carried).expect("a carried scene").soup }
}

/// Rounds to f32, which removes the last bits, in which logarithms and cosines differ between platforms.
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

/// The nodes, packets and primitives of all queries of a set.
type Counts = [usize; COUNTERS];

/// The queries of one set on one index.
struct Task<'a> {
    backend: &'static str,
    set: &'static str,
    /// Runs the queries as a user does.
    run: Box<dyn Fn() + 'a>,
    /// Runs the queries with counters.
    count: Box<dyn Fn() -> Counts + 'a>,
}

/// An index that counts the nodes, packets and primitives of its searches. It answers the queries of a batch one by
/// one, so interleaved searches are not counted.
struct Counted<'a, I> {
    index: &'a I,
    soup: &'a Soup<f64>,
    counts: Mutex<Counts>,
}

impl<I: Inspect<f64>> ClosestPoint<f64> for Counted<'_, I> {
    fn search(&self, query: &Point3<f64>, best: &mut Best<f64>) {
        best.offer_hint(self.soup, query);
        let mut counting = StatsCollector::new(best.clone());
        self.index.inspect(query, &mut counting);
        let found = [counting.nodes, counting.packets, counting.primitives];
        self.counts.lock().expect("one thread").iter_mut().zip(found).for_each(|(sum, count)| *sum += count);
        *best = counting.best;
    }
}

/// Returns the queries of all sets of closest points, for an index that counts and the same index as a trait object.
fn point_tasks<'a, I: Inspect<f64> + Sync>(
    backend: &'static str,
    index: &'a I,
    object: &'a counted_queries::Index<'a>,
    soup: &'a Soup<f64>,
    way: QueryMode,
) -> impl Iterator<Item = Task<'a>> {
    SETS.into_iter().map(move |set| {
        let queries = points(set, soup);
        let same_queries = queries.clone();
        let run = move || counted_queries::run_queries(object, way, &queries);
        let count = move || {
            let count_rows = Counted { index, soup, counts: Mutex::default() };
            counted_queries::run_queries(&count_rows, way, &same_queries);
            count_rows.counts.into_inner().expect("one thread")
        };
        Task { backend, set: set.name(), run: Box::new(run), count: Box::new(count) }
    })
}

/// Returns the rays from the scene's box, whose first hits are searched for.
fn ray_task<'a>(
    backend: &'static str,
    object: &'a dyn counted_queries::Tree,
    rays: &'a [Ray],
    visit: impl Fn(&'a Ray, &mut RayStatsCollector<Hits<'a>>) + 'a,
) -> Task<'a> {
    let run = move || counted_queries::run_rays(object, rays);
    let count = move || RayStatsCollector::of_rays(rays, &Hits::first(), &visit);
    Task { backend, set: "rays", run: Box::new(run), count: Box::new(count) }
}

/// One scene with all indexes that are measured.
#[derive(Clone)]
struct Indexes<'a> {
    soup: &'a Soup<f64>,
    rays: Vec<Ray>,
    aabb: AabbTree<f64, &'a Soup<f64>>,
    kdop: KdopTree<f64, &'a Soup<f64>, 14>,
    octree: OctreeIndex<f64, &'a Soup<f64>>,
    p2m: P2mIndex<f64, &'a Soup<f64>>,
}

/// Returns the path of the file of an index.
fn file(folder: &Path, scene: &str, backend: &str) -> PathBuf {
    folder.join(format!("{scene}-{backend}.p2m"))
}

impl<'a> Indexes<'a> {
    fn build(soup: &'a Soup<f64>) -> Self {
        Self {
            soup,
            rays: rays(soup),
            aabb: AabbTree::build(soup, &Default::default()).expect("valid"),
            kdop: KdopTree::build(soup, &Default::default()).expect("valid"),
            octree: OctreeIndex::build(soup, &Default::default()).expect("valid"),
            p2m: P2mIndex::build(soup, &Default::default()).expect("valid"),
        }
    }

    fn save(&self, folder: &Path, scene: &str) {
        let write = |backend: &str, writer: &Writer<'_>| {
            let file = fs::File::create(file(folder, scene, backend)).expect("a folder to write to");
            writer.write(std::io::BufWriter::new(file)).expect("room on the disk");
        };
        let mut writers: [Writer<'_>; 4] = Default::default();
        self.aabb.save(&mut writers[0]);
        self.kdop.save(&mut writers[1]);
        self.octree.save(&mut writers[2]);
        self.p2m.save(&mut writers[3]);
        ["aabb", "kdop", "octree", "p2m"].iter().zip(&writers).for_each(|(backend, writer)| write(backend, writer));
    }

    fn load(soup: &'a Soup<f64>, folder: &Path, scene: &str) -> Self {
        // The files are not verified, because that takes long under valgrind.
        let open = |backend: &str| SavedFile::open(&file(folder, scene, backend)).expect("written by this program");
        Self {
            soup,
            rays: rays(soup),
            aabb: AabbTree::load(soup, open("aabb").unchecked()).expect("written by this program"),
            kdop: KdopTree::load(soup, open("kdop").unchecked()).expect("written by this program"),
            octree: OctreeIndex::load(soup, open("octree").unchecked()).expect("written by this program"),
            p2m: P2mIndex::load(soup, open("p2m").unchecked()).expect("written by this program"),
        }
    }

    fn with_isa(self, isa: Isa) -> Self {
        let Self { aabb, kdop, octree, p2m, .. } = self;
        let (aabb, kdop) = (aabb.with_isa(isa), kdop.with_isa(isa));
        Self { aabb, kdop, octree: octree.with_isa(isa), p2m: p2m.with_isa(isa), ..self }
    }

    /// Returns all queries, in the order of the table.
    fn tasks(&self) -> Vec<Task<'_>> {
        let Self { soup, rays, aabb, kdop, octree, p2m } = self;
        let (aabb_object, kdop_object) = (counted_queries::aabb_tree(aabb), counted_queries::kdop_tree(kdop));
        let (octree_object, p2m_object) = (counted_queries::octree(octree), counted_queries::p2m(p2m));
        // Hints help trees, and interleaving helps cells.
        point_tasks("aabb", aabb, aabb_object, soup, QueryMode::Single)
            .chain([ray_task("aabb", aabb_object, rays, |ray, counting| aabb.visit_ray(ray, counting))])
            .chain(point_tasks("aabb batch", aabb, aabb_object, soup, QueryMode::Hints))
            .chain(point_tasks("kdop-14", kdop, kdop_object, soup, QueryMode::Single))
            .chain([ray_task("kdop-14", kdop_object, rays, |ray, counting| kdop.visit_ray(ray, counting))])
            .chain(point_tasks("octree", octree, octree_object, soup, QueryMode::Single))
            .chain(point_tasks("octree batch", octree, octree_object, soup, QueryMode::Several))
            .chain(point_tasks("p2m", p2m, p2m_object, soup, QueryMode::Single))
            .chain(point_tasks("p2m batch", p2m, p2m_object, soup, QueryMode::Several))
            .collect()
    }
}

/// The function in which callgrind counts instructions.
#[inline(never)]
fn counted_by_callgrind(task: &Task<'_>) {
    (task.run)();
    std::hint::black_box(task);
}

/// The function after which callgrind writes a file with its counts.
#[inline(never)]
fn written_by_callgrind(task: &Task<'_>) {
    counted_by_callgrind(task);
    std::hint::black_box(task);
}

/// Runs all queries on the indexes of a folder, for each scene with each instruction set in turn, under callgrind.
fn run_everything(folder: &Path) {
    for name in SCENES {
        let soup = scene(name);
        let indexes = Indexes::load(&soup, folder, name);
        for isa in Isa::available().into_iter().filter(|isa| INSTRUCTION_SETS.contains(&isa.name())) {
            indexes.clone().with_isa(isa).tasks().iter().for_each(written_by_callgrind);
        }
    }
}

/// A row of the table: the figures of a query in columns, some of which may be unknown.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    /// The scene, the backend and the query set.
    names: [String; 3],
    figures: [Option<f64>; COLUMNS.len()],
}

impl Row {
    fn has_names_of(&self, other: &Self) -> bool {
        self.names == other.names
    }
}

/// Formats a figure as in the table.
fn formatted(figure: Option<f64>, column: usize) -> String {
    let decimals = if column < COUNTERS { 3 } else { 0 };
    figure.map_or_else(|| "-".to_owned(), |x| format!("{x:.decimals$}"))
}

/// Returns the rows of the indexes, with their counters.
fn count_rows(scene: &str, indexes: Indexes<'_>) -> Vec<Row> {
    let row = |task: &Task<'_>| {
        let mut figures = [None; COLUMNS.len()];
        for (figure, count) in figures.iter_mut().zip((task.count)()) {
            *figure = Some(count as f64 / QUERIES as f64);
        }
        Row { names: [scene, task.backend, task.set].map(str::to_owned), figures }
    };
    indexes.with_isa(Isa::PORTABLE).tasks().iter().map(row).collect()
}

/// Returns the reason why callgrind cannot count instructions as it did for the table; `None` if it can.
fn find_obstacle() -> Option<String> {
    let program = env::current_exe().expect("a program");
    let is_in_debug_folder = program.components().any(|part| part.as_os_str() == "debug");
    let is_changed = env::vars_os().any(|(name, _)| name.to_string_lossy().starts_with("CARGO_PROFILE_"));
    let is_profile_test = is_in_debug_folder && !is_changed && !cfg!(debug_assertions) && compiled::OPT_LEVEL == "3";
    if !cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        Some(format!("this is {}, not Linux on x86-64", compiled::TARGET))
    } else if !is_profile_test {
        Some("this is not the profile test of the workspace".to_owned())
    } else if !compiled::FLAGS.is_empty() {
        Some(format!("the compiler has the flags {}", compiled::FLAGS))
    } else if !Command::new("valgrind").arg("--version").output().is_ok_and(|output| output.status.success()) {
        Some("valgrind is not installed".to_owned())
    } else {
        None
    }
}

/// Adds the instructions of the indexes of a folder to the rows.
fn count_instructions(folder: &Path, rows: &mut [Row]) {
    let counts = folder.join("callgrind");
    let output = Command::new("valgrind")
        .args(["--command-line-only=yes", "--tool=callgrind", "--dump-line=no", "--collect-atstart=no"])
        .args(["--toggle-collect=*counted_by_callgrind*", "--dump-after=*written_by_callgrind*"])
        .arg(format!("--callgrind-out-file={}", counts.display()))
        .arg(env::current_exe().expect("a program"))
        .arg(format!("{MEASURE}{}", folder.display()))
        .output()
        .expect("valgrind starts");
    assert!(output.status.success(), "valgrind failed: {}", String::from_utf8_lossy(&output.stderr));
    let dumps: Vec<u64> = (1..).map_while(|number| instructions(&counts.with_extension(number.to_string()))).collect();
    let sets = dumps.len() / rows.len();
    assert!(
        [1, 2].contains(&sets) && dumps.len() == sets * rows.len(),
        "{} counts of {} rows",
        dumps.len(),
        rows.len()
    );
    if sets == 1 {
        println!("no instructions with AVX2: the processor has none");
    }
    let tasks = rows.len() / SCENES.len();
    for (rows, dumps) in rows.chunks_mut(tasks).zip(dumps.chunks(sets * tasks)) {
        for (column, dumps) in (COUNTERS..).zip(dumps.chunks(tasks)) {
            for (row, count) in rows.iter_mut().zip(dumps) {
                row.figures[column] = Some((*count as f64 / QUERIES as f64).round());
            }
        }
    }
}

/// Returns the sum of a file of callgrind; `None` if there is no such file.
fn instructions(file: &Path) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let total = text.lines().find_map(|line| line.strip_prefix("totals: ")).expect("a file of callgrind has totals");
    Some(total.trim().parse().expect("a number"))
}

/// The table that is checked in.
struct Table {
    /// The compiler and the target for which the table has instructions.
    compiler: String,
    rows: Vec<Row>,
}

const COMPILER: &str = "# Instructions are those of ";

impl Table {
    fn path() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/instructions.csv")
    }

    fn read() -> Self {
        let text = fs::read_to_string(Self::path()).unwrap_or_default();
        let compiler = text.lines().find_map(|line| line.strip_prefix(COMPILER)).unwrap_or_default().to_owned();
        let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
        let row = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), 3 + COLUMNS.len(), "a row of tests/instructions.csv: {line}");
            let figure = |column: usize| match cells[3 + column] {
                "-" => None,
                figure => Some(figure.parse().expect("a number in tests/instructions.csv")),
            };
            Row { names: [0, 1, 2].map(|i| cells[i].to_owned()), figures: std::array::from_fn(figure) }
        };
        Self { compiler, rows: lines.map(row).collect() }
    }

    fn write(&self) {
        let mut text = format!(
            "# The work of a query, written by {RENEWAL}\n\
             {COMPILER}{}\nscene,backend,set,{}\n",
            self.compiler,
            COLUMNS.join(",")
        );
        for row in &self.rows {
            let figures: Vec<String> = (0..).zip(row.figures).map(|(column, x)| formatted(x, column)).collect();
            writeln!(text, "{},{}", row.names.join(","), figures.join(",")).expect("memory");
        }
        fs::write(Self::path(), text).expect("a checkout to write to");
    }
}

/// Returns whether cargo compiles incrementally, as it does unless the environment says otherwise.
fn is_incremental() -> bool {
    env::var_os("CARGO_INCREMENTAL").is_none_or(|value| value != "0")
}

/// The difference of a figure from that of the table, beyond the tolerance.
enum Change {
    None,
    Less,
    More,
}

impl Change {
    /// Classifies the change of a figure of a column.
    fn of(column: usize, before: f64, now: f64) -> Self {
        let part = if is_incremental() { TOLERANCE_OF_INCREMENTAL } else { TOLERANCE };
        let tolerance = if column < COUNTERS && IS_EXACT { 0.0 } else { part * before };
        if now > before + tolerance {
            Self::More
        } else if now < before - tolerance {
            Self::Less
        } else {
            Self::None
        }
    }
}

fn percent(before: f64, now: f64) -> f64 {
    (now - before) / before * 100.0
}

/// Prints all figures in columns, with their difference from the table's in percent.
fn print_rows(rows: &[Row], table: &Table) {
    let heads = COLUMNS.map(|name| format!("{name:>10}{:10}", "")).join("");
    println!("{:<16} {:<13} {:<8}{}", "scene", "backend", "set", heads.trim_end());
    for row in rows {
        let before = table.rows.iter().find(|before| before.has_names_of(row));
        let cell = |column: usize| {
            let change = before.and_then(|before| before.figures[column]).zip(row.figures[column]);
            let change = change.filter(|(before, now)| before != now);
            let change = change.map(|(before, now)| format!(" {:>+7.2} %", percent(before, now)));
            format!("{:>10}{:10}", formatted(row.figures[column], column), change.unwrap_or_default())
        };
        let ([scene, backend, set], cells) =
            (&row.names, std::array::from_fn::<_, { COLUMNS.len() }, _>(cell).join(""));
        println!("{scene:<16} {backend:<13} {set:<8}{}", cells.trim_end());
    }
}

/// Compares the rows with the table, and returns messages about figures that are worse and about those that are better.
fn compare(rows: &[Row], table: &Table) -> (Vec<String>, Vec<String>) {
    let (mut wrong, mut better) = (Vec::new(), Vec::new());
    let absent = |list: &[Row], row: &Row| !list.iter().any(|other| other.has_names_of(row));
    wrong.extend(
        rows.iter()
            .filter(|row| absent(&table.rows, row))
            .map(|row| format!("{}: not in the table", row.names.join(", "))),
    );
    wrong.extend(
        table
            .rows
            .iter()
            .filter(|row| absent(rows, row))
            .map(|row| format!("{}: in the table alone", row.names.join(", "))),
    );
    for row in rows {
        let Some(before) = table.rows.iter().find(|before| before.has_names_of(row)) else { continue };
        for (column, name) in COLUMNS.into_iter().enumerate() {
            let (Some(before), Some(now)) = (before.figures[column], row.figures[column]) else { continue };
            let kind = if column < COUNTERS { "" } else { " instructions" };
            let message = format!(
                "{}: {} {}{kind} a query, {} in the table, {:+.2} %",
                row.names.join(", "),
                formatted(Some(now), column),
                name,
                formatted(Some(before), column),
                percent(before, now)
            );
            match Change::of(column, before, now) {
                Change::None => {}
                Change::Less if column >= COUNTERS => better.push(message),
                Change::Less | Change::More => wrong.push(message),
            }
        }
    }
    (wrong, better)
}

/// Measures everything, and compares it with the table or writes the table.
fn check_table() -> ExitCode {
    let is_renewed = env::var_os("P2M_BLESS").is_some();
    if is_renewed && is_incremental() {
        println!("the table is for what is not compiled incrementally: {RENEWAL}");
        return ExitCode::FAILURE;
    }
    let mut table = Table::read();
    let compiler = format!("{}, {}, profile test", compiled::RUSTC, compiled::TARGET);
    let mut obstacle = find_obstacle();
    if obstacle.is_none() && !is_renewed && table.compiler != compiler {
        obstacle = Some(format!("this is {compiler}, and the table has {}", table.compiler));
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut rows = Vec::new();
    for name in SCENES {
        let soup = scene(name);
        let indexes = Indexes::build(&soup);
        if obstacle.is_none() {
            indexes.save(folder.path(), name);
        }
        rows.extend(count_rows(name, indexes));
    }
    match &obstacle {
        None => count_instructions(folder.path(), &mut rows),
        Some(why) => println!("instructions are not counted: {why}"),
    }
    print_rows(&rows, &table);
    if is_renewed {
        table = Table { compiler, rows };
        table.write();
        println!("tests/instructions.csv is written{}", if obstacle.is_some() { ", without instructions" } else { "" });
        return ExitCode::SUCCESS;
    }
    let (wrong, better) = compare(&rows, &table);
    if !better.is_empty() {
        println!("\nfewer instructions than in the table; to keep the gain, renew it ({RENEWAL}):");
        better.iter().for_each(|message| println!("  {message}"));
    }
    if wrong.is_empty() {
        println!("test {NAME} ... ok");
        return ExitCode::SUCCESS;
    }
    println!("\nnot as in tests/instructions.csv; if it is meant to be so, renew it ({RENEWAL}):");
    wrong.iter().for_each(|message| println!("  {message}"));
    println!("test {NAME} ... FAILED");
    ExitCode::FAILURE
}
