//! `p2m-bench instances`: compares a scene of moving instances with a single index over all of its moved triangles.

use crate::command::{Rounds, at_least_one, provenance};
use crate::contest::{self, Competitor, Kind};
use crate::measure::MedianRange;
use crate::our_indexes::aabb_options;
use crate::rounds::{checksum_of_closest, thread_seconds};
use anyhow::{Context, Result, bail};
use chacha20::ChaCha8Rng;
use clap::Args;
use nalgebra::{Isometry3, Point3, Vector3};
use p2m_bvh::AabbTree;
use p2m_cli::harness::Table;
use p2m_core::pair::Motion;
use p2m_core::{BuildError, BuildIndex, Element, PrimitiveSet, Ray, RayQuery, Soup};
use p2m_instances::{InstanceId, Instances};
use p2m_testkit::{rng, vector};
use rand::RngExt;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// The number of triangles above which the single index is left out, for lack of memory.
const MAX_TRIANGLES_OF_ONE_INDEX: usize = 25_000_000;
/// The largest movement of an instance between two frames: the distance along each axis in diagonals of an object, and
/// the angle about each axis in radians.
const STEP: f64 = 0.02;

type Tree<S> = AabbTree<f64, S>;
type InstanceScene = Instances<f64, Tree<Soup<f64>>>;

#[derive(Args)]
pub(crate) struct Arguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    rounds: Rounds,
    /// Queries in a round
    #[arg(long, default_value_t = 1_000_000)]
    queries: usize,
    /// Instances
    #[arg(long, default_value_t = 10_000, value_parser = at_least_one())]
    instances: usize,
    /// Largest number of triangles of an object; larger meshes are simplified [default: no limit]
    #[arg(long)]
    triangles: Option<usize>,
    /// Rays in a round
    #[arg(long, default_value_t = 200_000)]
    rays: usize,
}

/// Times a scene of instances, and returns whether its answers equal those of the single index.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let about = arguments.rounds.describe("CPU time of one thread", arguments.queries, "queries");
    println!("{}\n{about}", provenance());
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let is_good = one_thread.install(|| print(arguments))?;
    println!("{}", if is_good { "All answers are equal." } else { "DIFFERENT answers." });
    Ok(is_good)
}

/// Times updates, points and rays in a scene of instances of meshes. Returns whether all answers are equal.
fn print(arguments: &Arguments) -> Result<bool> {
    let objects: Vec<Arc<Tree<Soup<f64>>>> = (arguments.scenes.iter())
        .map(|path| {
            let soup = object(&p2m_mixed::read_scene(path)?.soup, arguments.triangles)?;
            Ok(Arc::new(AabbTree::build(soup, &aabb_options())?))
        })
        .collect::<Result<_>>()?;
    let mut bench = Bench::new(objects, arguments.instances, arguments.rounds.seed)?;
    let total: usize = bench.scene.instances().map(|instance| instance.primitives().len()).sum();
    println!(
        "\n{} instances of {} objects of {} triangles, {total} triangles in all.\n",
        arguments.instances,
        bench.objects.len(),
        bench.objects.iter().map(|object| object.set().len().to_string()).collect::<Vec<_>>().join(", "),
    );
    let mut whole = match total <= MAX_TRIANGLES_OF_ONE_INDEX {
        true => Some(AabbTree::build(bench.moved_soup()?, &aabb_options())?),
        false => None,
    };
    let bounds = bench.scene.bounds();
    let mut at = || Point3::from(std::array::from_fn(|k| bench.rng.random_range(bounds.min[k]..bounds.max[k])));
    let queries: Vec<_> = (0..arguments.queries).map(|_| at()).collect();
    let origins: Vec<_> = (0..arguments.rays).map(|_| at()).collect();
    let rays = origins.iter().map(|origin| Ray::new(origin, &vector(&mut bench.rng)));
    let rays = rays.collect::<Result<Vec<_>, _>>().context("directions are not zero")?;
    // Each row has the times of the scene of instances, and then those of the single index.
    let mut seconds: [[Vec<f64>; 2]; 2] = Default::default();
    for _ in 0..arguments.rounds.rounds {
        bench.step();
        seconds[0][0].push(thread_seconds(|| bench.build()).1);
        seconds[1][0].push(thread_seconds(|| bench.update()).1);
        if let Some(whole) = &mut whole {
            let positions = bench.moved_positions();
            let (refitted, time) =
                thread_seconds(|| whole.refit_in_place(&aabb_options(), |soup| soup.set_positions(positions)));
            refitted?;
            seconds[1][1].push(time);
            let soup = bench.moved_soup()?;
            let (built, time) = thread_seconds(|| AabbTree::build(soup, &aabb_options()));
            seconds[0][1].push(time);
            *whole = built?;
        }
    }
    let mut points = Vec::from(contest::single_and_batch(&bench.scene));
    let mut casters = vec![caster("instances", &bench.scene)];
    if let Some(whole) = &whole {
        points.extend(contest::single_and_batch(whole));
        casters.push(caster("one index", whole));
    }
    let points = contest::measure(&queries, &mut points, arguments.rounds.rounds, &None);
    let hits = contest::measure(&rays, &mut casters, arguments.rounds.rounds, &None);
    let sum = checksum_of_closest(&points[0].answers);
    let is_equal = points.iter().all(|score| checksum_of_closest(&score.answers) == sum)
        && hits.iter().all(|score| score.answers == hits[0].answers);
    let mut table = Table::new(["", "instances", "one index"]);
    for (name, times) in ["build", "move"].iter().zip(&seconds) {
        let cell = |times: &Vec<f64>| MedianRange::of(times).map(|range| format!("{:.3} ms", range.median * 1e3));
        let cells = times.iter().map(|times| cell(times).unwrap_or_else(|| "-".to_owned()));
        table.push(std::iter::once((*name).to_owned()).chain(cells).collect());
    }
    let ns = |seconds: Option<MedianRange>| seconds.map_or("-".to_owned(), |s| format!("{:.3} ns", s.median * 1e9));
    for (name, at) in [("points, one by one", 0), ("points, batch", 1)] {
        let [ours, other] = [at, at + 2].map(|at| ns(points.get(at).map(|score| score.seconds)));
        table.push(vec![name.to_owned(), ours, other]);
    }
    let [ours, other] = [0, 1].map(|at| ns(hits.get(at).map(|score| score.seconds)));
    table.push(vec!["first hits of rays".to_owned(), ours, other]);
    println!("{table}");
    Ok(is_equal)
}

/// The bits of the parameter of the first hit, and the id of the primitive.
type Hit = Option<(u64, usize)>;

/// Returns an index that casts rays.
fn caster<'a>(name: &'static str, index: &'a impl RayQuery<f64>) -> Competitor<'a, Ray, Hit> {
    Competitor::new(name, Kind::Exact, |ray| {
        index.first_intersection(ray).map(|hit| (hit.parameter.to_bits(), hit.primitive.index()))
    })
}

/// A scene of instances in motion.
struct Bench {
    objects: Vec<Arc<Tree<Soup<f64>>>>,
    scene: InstanceScene,
    ids: Vec<InstanceId>,
    motions: Vec<Isometry3<f64>>,
    rng: ChaCha8Rng,
}

impl Bench {
    /// Scatters instances over a cube, with one instance per unit of volume on average.
    fn new(objects: Vec<Arc<Tree<Soup<f64>>>>, instances: usize, seed: u64) -> Result<Self> {
        if objects.is_empty() {
            bail!("there is no object");
        }
        let mut rng = rng("p2m-bench instances", seed);
        let side = (instances as f64).cbrt();
        let at = |rng: &mut ChaCha8Rng| Vector3::from_fn(|_, _| rng.random_range(0.0..side));
        let motions = (0..instances).map(|_| Isometry3::new(at(&mut rng), vector(&mut rng) * 3.0)).collect();
        let mut bench = Self { objects, scene: Instances::new(), ids: Vec::new(), motions, rng };
        bench.build()?;
        Ok(bench)
    }

    /// Rebuilds the scene.
    fn build(&mut self) -> Result<()> {
        let mut scene = Instances::new();
        let mut edit = scene.edit();
        let added = self.motions.iter().enumerate().map(|(i, motion)| {
            let object = i % self.objects.len();
            Ok(edit.add("object", &self.objects[object], *motion)?)
        });
        self.ids = added.collect::<Result<_>>()?;
        drop(edit);
        self.scene = scene;
        Ok(())
    }

    /// Moves all instances a little, without updating the scene.
    fn step(&mut self) {
        for motion in &mut self.motions {
            let step = Isometry3::new(vector(&mut self.rng) * STEP, vector(&mut self.rng) * STEP);
            *motion = Isometry3::from_parts(
                (motion.translation.vector + step.translation.vector).into(),
                step.rotation * motion.rotation,
            );
        }
    }

    /// Updates the scene with the motions of all instances.
    fn update(&mut self) -> Result<()> {
        let mut edit = self.scene.edit();
        for (id, motion) in self.ids.iter().zip(&self.motions) {
            edit.set_motion(*id, *motion)?;
        }
        Ok(())
    }

    /// Returns the positions of all vertices after their motions.
    fn moved_positions(&self) -> Vec<Point3<f64>> {
        let moved = self.motions.iter().enumerate().flat_map(|(i, motion)| {
            let motion = Motion::new(motion);
            let positions = self.objects[i % self.objects.len()].set().positions();
            positions.iter().map(move |p| Point3::from(motion.apply([p.x, p.y, p.z])))
        });
        moved.collect()
    }

    /// Returns all triangles after their motions.
    fn moved_soup(&self) -> Result<Soup<f64>, BuildError> {
        let mut elements = Vec::new();
        let mut first = 0;
        for i in 0..self.motions.len() {
            let soup = self.objects[i % self.objects.len()].set();
            elements.extend(soup.triangles().iter().map(|corners| Element::Triangle(corners.map(|i| i + first))));
            first += u32::try_from(soup.positions().len()).unwrap_or(u32::MAX);
        }
        Soup::new(self.moved_positions(), elements)
    }
}

/// Returns the triangles of a mesh, scaled to a box with a diagonal of 1 about the origin, and simplified to at most
/// `most` triangles by merging the vertices in each cell of a grid.
fn object(soup: &Soup<f64>, most: Option<usize>) -> Result<Soup<f64>> {
    let bounds = soup.aabb();
    let (centre, diagonal) = (nalgebra::center(&bounds.min, &bounds.max), (bounds.max - bounds.min).norm());
    let positions: Vec<_> = soup.positions().iter().map(|p| Point3::from((p - centre) / diagonal)).collect();
    let triangles = soup.triangles();
    let Some(most) = most.filter(|most| triangles.len() > *most) else {
        return Ok(Soup::new(positions, triangles.iter().map(|t| Element::Triangle(*t)))?);
    };
    let mut merged = Vec::new();
    let mut kept: Vec<Point3<f64>> = Vec::new();
    for cells in 2..4096 {
        let mut of_cell = HashMap::new();
        let mut vertices = Vec::new();
        #[allow(clippy::cast_possible_truncation, reason = "the coordinates of cells are small")]
        let representative: Vec<u32> = (positions.iter())
            .map(|p| {
                *of_cell.entry(<[i32; 3]>::from(p.coords.map(|x| (x * f64::from(cells)) as i32))).or_insert_with(|| {
                    vertices.push(*p);
                    vertices.len() as u32 - 1
                })
            })
            .collect();
        let moved = triangles.iter().map(|t| t.map(|i| representative[i as usize]));
        let next: Vec<_> = moved.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        if next.len() > most {
            break;
        }
        (merged, kept) = (next, vertices);
    }
    Ok(Soup::new(kept, merged.into_iter().map(Element::Triangle))?)
}
