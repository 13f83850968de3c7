//! `p2m ray`: what rays meet, as a table.

use crate::asking::{Asking, Questions, ask};
use crate::backend::{Built, Index, Search, Source};
use crate::faces;
use crate::findings::Findings;
use crate::input::{self, SceneArgs, point_format, read_rays, read_scene_and_index};
use crate::json;
use crate::output::Output;
use crate::sampling::{Region, random_rays};
use crate::streams::Streams;
use crate::summary::{Indexed, Run};
use crate::usage::{finite_not_negative, number, one_of, positive, usage, whole};
use anyhow::Context;
use clap::{ArgGroup, ValueEnum};
use nalgebra::{Point3, Vector3};
use p2m_core::{Hit, Ray, RayError};
use p2m_mixed::{AnswerFormat, HitWriter, NumberWriter, Object, PointFormat, Scene};
use rayon::ThreadPool;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Each paragraph is one line, so that it wraps at the width of the terminal.
fn help() -> String {
    format!(
        "\
A ray has an origin and a direction of any length but zero: its points are origin + t direction with the parameter t from \
--min to --max. Whether it meets a primitive is decided without rounding, so nothing slips through between two \
triangles with a common edge, and every backend gives the same table, but for `any`. A hit on a common edge is one of both \
triangles, and as a crossing it counts once.

The table has the columns ray,ox,oy,oz,dx,dy,dz: the number of the ray from 0, its origin and its direction. With --mode \
do, count and crossings it has one more, called hit (0 or 1), count or crossings. With the others it has \
parameter,x,y,z,primitive,side,w0,w1,w2: the parameter t and the point of the hit, the number of the primitive from 0, the \
side of the triangle that is met (front, back, or along for one in its plane, and for segments and points), and the weights \
of the primitive's vertices. With --mode first and any each ray has one line, where the last nine are empty if it \
meets nothing; with --mode all it has a line for each of its hits, by parameter and then by primitive. Of a scene with named \
objects hits have one column more, object: the name of that of the primitive, empty where it is in none. Numbers are the \
shortest that read back the same. A summary goes to the standard error.

Answers as NPY are an array of NumPy with the fields origin, direction and ray, and hit, count or crossings, or parameter, \
point, barycentric, primitive and side (0 front, 1 back, 2 along); as PLY a cloud of the origins with the directions as \
normals. Where there is no hit, numbers are NaN and -1.

Rays from a CSV file are taken from its columns ox, oy, oz, dx, dy, dz, or else x, y, z, dx, dy, dz, or else x, y, z, nx, ny, \
nz, or else Points:0 to Points:2 and Normals:0 to Normals:2, or else from the first six columns; so the table itself can be \
asked about again. XYZ and TXT files have six or more columns separated by blanks. NPY files are arrays of six columns. Of \
PLY files the vertices are asked about, along their normals nx, ny, nz. Numbers that are not finite, and directions that \
are zero, are errors.

{}

The exit code is 0 for success, with or without hits; 1 for what could not be read, written or done; 2 for wrong usage; and \
130 after Ctrl-C.

Examples:
  p2m ray bunny.obj --rays scan.csv --out hits.csv
  p2m ray scene.ply --random 100000 --seed 7 --mode all --out hits.npy --json
  p2m ray part.stl --random 1000 --line --mode crossings > crossings.csv
  p2m ray wires.obj --rays rays.npy --radius 0.01 --max 10 --backend kdop --k 14
  p2m generate torus-knot | p2m ray - --format obj --random 1000 --mode do --out hit.ply",
        json::STABILITY
    )
}

/// Find what given or random rays meet of a scene: the first hit, all of them, or their number
#[derive(clap::Args)]
#[command(after_help = help())]
#[command(group = ArgGroup::new("questions").required(true).args(["rays", "random"]))]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// Ask about the rays of this XYZ, TXT, CSV, NPY or PLY file; `-` is the standard input
    #[arg(long, value_name = "FILE")]
    rays: Option<PathBuf>,

    /// The format of the rays, if the extension of their file does not tell
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<PointFormat>(PointFormat::NAMES), ignore_case = true, conflicts_with = "random")]
    rays_format: Option<PointFormat>,

    /// Ask about N rays from uniformly distributed points in the scaled box of the scene into uniformly distributed
    /// directions of length 1
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true)]
    random: Option<u64>,

    /// Scale the box of the scene about its centre by this factor before filling it.
    ///
    /// Along an axis on which the scene is flat, the box is widened to each side by as much as the factor adds to its
    /// longest side.
    #[arg(long, value_name = "S", default_value_t = 1.05, value_parser = positive, allow_negative_numbers = true, conflicts_with = "rays")]
    box_scale: f64,

    /// Seed of the random rays
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole, allow_negative_numbers = true, conflicts_with = "rays")]
    seed: u64,

    /// What to find
    #[arg(long, value_enum, default_value_t = Mode::First)]
    mode: Mode,

    /// Go both ways: parameters from minus infinity on
    #[arg(long, conflicts_with = "min")]
    line: bool,

    /// The least parameter, in lengths of the direction, itself included
    #[arg(long, value_name = "T", default_value_t = 0.0, value_parser = number, allow_hyphen_values = true)]
    min: f64,

    /// The largest parameter, itself included [default: none]
    #[arg(long, value_name = "T", value_parser = number, allow_hyphen_values = true)]
    max: Option<f64>,

    /// Segments and points are hit within this distance, in the unit of the scene; it does not matter to triangles
    #[arg(long, value_name = "R", default_value_t = 0.0, value_parser = finite_not_negative, allow_negative_numbers = true)]
    radius: f64,

    /// How to search; interception indexes (octree, p2m) answer no rays [default: aabb, or as a saved index does]
    #[arg(long, value_enum)]
    backend: Option<Search>,

    #[command(flatten)]
    asking: Asking,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Mode {
    /// Whether a ray meets anything
    Do,
    /// The hit that is found first: some hit, which depends on the backend
    Any,
    /// The hit with the least parameter
    First,
    /// All hits
    All,
    /// The number of hits
    Count,
    /// How often the surface of the triangles is crossed: once, too, where it is met on an edge or a vertex
    Crossings,
}

impl Mode {
    fn name(self) -> &'static str {
        match self {
            Self::Do => "do",
            Self::Any => "any",
            Self::First => "first",
            Self::All => "all",
            Self::Count => "count",
            Self::Crossings => "crossings",
        }
    }
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let (scene_args, asking) = (&args.scene, &args.asking);
    asking.check(scene_args, args.rays.as_deref(), "rays")?;
    let along_x = Ray::new(&Point3::<f64>::origin(), &Vector3::x()).and_then(|ray| args.limited(&ray));
    along_x.map_err(|error| usage(format!("{error} (--min, --max)")))?;
    let (format, out_format) = (scene_args.format()?, asking.format(streams)?);
    let start = Instant::now();
    let (scene, saved) = read_scene_and_index(streams, &scene_args.path, format)?;
    let rays = rays(streams, args, &scene)?;
    let read = start.elapsed();
    // Before any work, so that it is not lost to a wrong name.
    let mut output = Output::open(streams, Some(&asking.out))?;

    let start = Instant::now();
    let saved = saved.as_ref();
    let backend = args.backend.or_else(|| Search::of_saved(saved)).unwrap_or(Search::Aabb);
    let source = Source { soup: &scene.soup, faces: faces::only_for(backend == Search::Kdop, asking.k)?, saved };
    let Built { index, about, loaded, .. } = backend.build(streams, source).with_context(|| scene_args.name())?;
    let build = start.elapsed();

    let pool = asking.pool()?;
    let (index, output_file, objects) = (&*index, &mut output, scene.objects.as_slice());
    let task = Task { streams, index, pool: &pool, rays, output: output_file, format: out_format, objects };
    let (asked, findings) = task.run(args.mode).with_context(|| output.cannot_write())?;
    let bytes = output.bytes();
    output.finish()?;

    let (scene_name, backend, threads) = (scene_args.name(), backend.name(), pool.current_num_threads());
    let indexed = Indexed { scene_name, scene: &scene, format, backend, about, loaded, read, build };
    let run = Run { indexed, threads, asked };
    if asking.json {
        let report = args.report(findings.json());
        return json::print(streams, &run.json("ray", report, &asking.written(out_format, bytes)));
    }
    // The answers are complete; whether anybody reads this is not our concern.
    let _ = write!(streams.stderr(), "{}{findings}", run.text("rays", "ray", findings.rays()));
    Ok(())
}

impl Args {
    fn range(&self) -> [f64; 2] {
        [if self.line { f64::NEG_INFINITY } else { self.min }, self.max.unwrap_or(f64::INFINITY)]
    }

    /// The ray as far as it is asked about.
    fn limited(&self, ray: &Ray) -> Result<Ray, RayError> {
        let [min, max] = self.range();
        ray.with_range(min, max)?.with_radius(self.radius)
    }

    /// What was asked, and what came of it.
    fn report(&self, findings: Value) -> Value {
        let asked_about = match &self.rays {
            Some(path) => json!({ "rays": input::name(path) }),
            None => json!({ "random": self.random, "seed": self.seed, "box_scale": self.box_scale }),
        };
        let [min, max] = self.range().map(json::number);
        let mut report = json!({
            "mode": self.mode.name(),
            "range": { "min": min, "max": max },
            "radius": self.radius,
            "asked_about": asked_about,
        });
        if let (Value::Object(report), Value::Object(findings)) = (&mut report, findings) {
            report.extend(findings);
        }
        report
    }
}

type Rays<'a> = Questions<Box<dyn Iterator<Item = Ray> + 'a>>;

fn rays<'a>(streams: &Streams, args: &'a Args, scene: &Scene) -> anyhow::Result<Rays<'a>> {
    let (count, rays): (u64, Box<dyn Iterator<Item = Ray>>) = match &args.rays {
        Some(path) => {
            let rays = read_rays(streams, path, point_format(path, args.rays_format, "--rays-format")?)?;
            (rays.len() as u64, Box::new(rays.into_iter()))
        }
        None => {
            let count = args.random.unwrap_or(0);
            (count, Box::new(random_rays(Region::around(&scene.soup, args.box_scale), count, args.seed)))
        }
    };
    let rays = rays.map(|ray| args.limited(&ray).expect("the limits fit every ray"));
    Ok(Questions { name: "rays", count, iter: Box::new(rays) })
}

/// Rays to ask, and where their answers go.
struct Task<'a, 's> {
    streams: &'a Streams,
    index: &'a dyn Index,
    pool: &'a ThreadPool,
    rays: Rays<'a>,
    output: &'a mut Output<'s>,
    format: AnswerFormat,
    objects: &'a [Object],
}

impl Task<'_, '_> {
    /// How long the asking took, and what came of it.
    fn run(self, mode: Mode) -> io::Result<(Duration, Findings)> {
        let (hits, one) = (Findings::with_numbers("hits"), Some(self.rays.count));
        match mode {
            Mode::Do => self.numbers("hit", Findings::default(), |index, ray| u64::from(index.do_intersect(ray))),
            Mode::Count => self.numbers("count", hits, |index, ray| index.count(ray) as u64),
            Mode::Crossings => {
                let crossed = Findings::with_numbers("crossed");
                self.numbers("crossings", crossed, |index, ray| index.crossings(ray) as u64)
            }
            Mode::Any => self.hits(one, Findings::default(), |i, ray| i.any_intersection(ray), Option::as_slice),
            Mode::First => self.hits(one, Findings::default(), |i, ray| i.first_intersection(ray), Option::as_slice),
            Mode::All => self.hits(None, hits, |index, ray| index.all_intersections(ray), Vec::as_slice),
        }
    }

    /// A number for each ray.
    fn numbers(
        self,
        name: &'static str,
        mut findings: Findings,
        question: impl Fn(&dyn Index, &Ray) -> u64 + Sync,
    ) -> io::Result<(Duration, Findings)> {
        let mut writer = NumberWriter::new(self.output, self.format, name, self.rays.count)?;
        let time = ask(self.streams, self.pool, self.rays, each(self.index, question), |ray, &number| {
            writer.write(findings.rays(), ray, number)?;
            findings.add(number);
            Ok(())
        })?;
        writer.finish()?;
        Ok((time, findings))
    }

    /// The hits of each ray, a slice of what it is answered: so many records in all, or one for each hit.
    fn hits<A: Clone + Default + Send>(
        self,
        records: Option<u64>,
        mut findings: Findings,
        question: impl Fn(&dyn Index, &Ray) -> A + Sync,
        slice: fn(&A) -> &[Hit],
    ) -> io::Result<(Duration, Findings)> {
        let mut writer = HitWriter::with_objects(self.output, self.format, records, self.objects)?;
        let time = ask(self.streams, self.pool, self.rays, each(self.index, question), |ray, answer| {
            let (number, hits) = (findings.rays(), slice(answer));
            findings.add_hits(hits);
            if hits.is_empty() && records.is_some() {
                writer.write(number, ray, None)?;
            }
            hits.iter().try_for_each(|hit| writer.write(number, ray, Some(hit)))
        })?;
        writer.finish()?;
        Ok((time, findings))
    }
}

/// Answers rays one by one.
fn each<A>(index: &dyn Index, question: impl Fn(&dyn Index, &Ray) -> A + Sync) -> impl Fn(&[Ray], &mut [A]) + Sync {
    move |rays, answers| rays.iter().zip(answers).for_each(|(ray, answer)| *answer = question(index, ray))
}
