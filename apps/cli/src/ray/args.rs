//! The arguments of `p2m ray`, and the rays that they ask for.

use crate::answers::args::QueryArgs;
use crate::answers::blocks::{BlockSize, QueryStream};
use crate::answers::queries::{Region, random_rays};
use crate::index::backend::{Backend, backends};
use crate::io::input::{self, SceneArgs, point_format, read_rays};
use crate::io::json;
use crate::io::streams::Streams;
use crate::io::usage::{bytes, count, finite_not_negative, number, one_of, positive, usage, whole_number};
use clap::{ArgGroup, ValueEnum};
use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, Ray, RayError};
use p2m_mixed::PointFormat;
use serde_json::{Value, json};
use std::path::PathBuf;

/// The text of the help. Each paragraph is one line, so that it wraps at the width of the terminal.
fn help() -> String {
    format!(
        "\
A ray has an origin and a direction of any length but zero: its points are origin + t direction with the parameter t from \
--min to --max. Whether it intersects a primitive is decided without rounding, so nothing slips through between two \
triangles with a common edge, and every backend gives the same table, but for `any`. A hit on a common edge is one of both \
triangles, and as a crossing it counts once.

The table has the columns ray,ox,oy,oz,dx,dy,dz: the number of the ray from 0, its origin and its direction. With --mode \
intersects, count and crossings it has one more, called hit (0 or 1), count or crossings. With the others it has \
parameter,x,y,z,primitive,side,w0,w1,w2: the parameter t and the point of the hit, the number of the primitive from 0, the \
side of the triangle that is met (front, back, or along for one in its plane, and for segments and points), and the weights \
of the primitive's vertices. With --mode first and any each ray has one line, where the last nine are empty if it \
intersects nothing; with --mode all it has a line for each of its hits, by parameter and then by primitive. Of a scene with named \
objects hits have one column more, object: the name of that of the primitive, empty where it is in none. Numbers are the \
shortest that read back the same. A summary goes to the standard error.

Answers as NPY are an array of NumPy with the fields origin, direction and ray, and hit, count or crossings, or parameter, \
point, barycentric, primitive and side (0 front, 1 back, 2 along); as PLY a cloud of the origins with the directions as \
normals. Where there is no hit, numbers are NaN and -1.

Rays from a CSV file are taken from its columns ox, oy, oz, dx, dy, dz, or else x, y, z, dx, dy, dz, or else x, y, z, nx, ny, \
nz, or else Points:0 to Points:2 and Normals:0 to Normals:2, or else from the first six columns; so the table itself is a \
file of the same rays. XYZ and TXT files have six or more columns separated by blanks. NPY files are arrays of six columns. Of \
PLY files the vertices are the origins, and their normals nx, ny, nz the directions. Numbers that are not finite, and directions that \
are zero, are errors.

{}

The exit code is 0 for success, with or without hits; 1 for what could not be read, written or done; 2 for wrong usage; and \
130 after Ctrl-C.

Examples:
  p2m ray bunny.obj --rays scan.csv --out hits.csv
  p2m ray scene.ply --random 100000 --seed 7 --mode all --out hits.npy --json
  p2m ray part.stl --random 1000 --line --mode crossings > crossings.csv
  p2m ray wires.obj --rays rays.npy --radius 0.01 --max 10 --backend kdop --k 14
  p2m generate torus-knot | p2m ray - --format obj --random 1000 --mode intersects --out hit.ply",
        json::STABILITY
    )
}

/// Find what given or random rays meet of a scene: the first hit, all of them, or their number
#[derive(clap::Args)]
#[command(after_help = help())]
#[command(group = ArgGroup::new("questions").required(true).args(["rays", "random"]))]
pub(crate) struct Args {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,

    /// Cast the rays of this XYZ, TXT, ASC, PTS, CSV, NPY or PLY file; `-` is the standard input
    #[arg(long, value_name = "FILE")]
    rays: Option<PathBuf>,

    /// The format of the rays, if the extension of their file does not name it
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<PointFormat>(PointFormat::NAMES), ignore_case = true, conflicts_with = "random")]
    rays_format: Option<PointFormat>,

    /// Cast N rays from uniformly distributed points in the scaled box of the scene into uniformly distributed
    /// directions of length 1
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
    random: Option<u64>,

    /// Scale the box of the scene about its centre by this factor before filling it.
    ///
    /// Along an axis on which the scene is flat, the box is widened to each side by as much as the factor adds to
    /// its longest side.
    #[arg(long, value_name = "S", default_value_t = 1.05, value_parser = positive, allow_negative_numbers = true, conflicts_with = "rays")]
    box_scale: f64,

    /// Seed of the random rays
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole_number, allow_negative_numbers = true, conflicts_with = "rays")]
    seed: u64,

    /// The answer for each ray
    #[arg(long, value_enum, default_value_t = Mode::First)]
    pub(crate) mode: Mode,

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

    /// The index to search; interception indexes (octree, p2m) answer no rays [default: aabb, or as a saved index does]
    #[arg(long, value_parser = backends(|backend| backend.casts_rays))]
    pub(crate) backend: Option<Backend>,

    /// Keep at most this much of an index in shards in memory, such as 4GB or 500MiB; one shard is kept in any case
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    pub(crate) max_memory: Option<u64>,

    #[command(flatten)]
    pub(crate) query_args: QueryArgs,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Mode {
    /// Whether a ray hits anything
    #[value(alias = "do")]
    Intersects,
    /// The hit that is found first: some hit, which depends on the backend
    Any,
    /// The hit with the least parameter
    First,
    /// All hits
    All,
    /// The number of hits
    Count,
    /// The number of crossings of the surface of the triangles; one on an edge or a vertex counts once
    Crossings,
}

impl Mode {
    /// The name on the command line and in reports.
    fn name(self) -> &'static str {
        match self {
            Self::Intersects => "intersects",
            Self::Any => "any",
            Self::First => "first",
            Self::All => "all",
            Self::Count => "count",
            Self::Crossings => "crossings",
        }
    }
}

impl Args {
    /// Refuses combinations of arguments that contradict each other.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        self.query_args.check(&self.scene, self.rays.as_deref(), "rays")?;
        let along_x = Ray::new(&Point3::<f64>::origin(), &Vector3::x()).and_then(|ray| self.limited(&ray));
        along_x.map_err(|error| usage(format!("{error} (--min, --max)")))?;
        Ok(())
    }

    /// The least and the largest parameter.
    fn range(&self) -> [f64; 2] {
        [if self.line { f64::NEG_INFINITY } else { self.min }, self.max.unwrap_or(f64::INFINITY)]
    }

    /// Returns the ray with the range and the radius of the arguments.
    fn limited(&self, ray: &Ray) -> Result<Ray, RayError> {
        let [min, max] = self.range();
        ray.with_range(min, max)?.with_radius(self.radius)
    }

    /// Returns the part of a report about the rays and their answers.
    pub(crate) fn report(&self, summary: Value) -> Value {
        let source = match &self.rays {
            Some(path) => json!({ "rays": input::name(path) }),
            None => json!({ "random": self.random, "seed": self.seed, "box_scale": self.box_scale }),
        };
        let [min, max] = self.range().map(json::number);
        let mut report = json!({
            "mode": self.mode.name(),
            "range": { "min": min, "max": max },
            "radius": self.radius,
            "source": source,
        });
        if let (Value::Object(report), Value::Object(summary)) = (&mut report, summary) {
            report.extend(summary);
        }
        report
    }
}

/// The rays of the arguments.
pub(crate) type Rays<'a> = QueryStream<Box<dyn Iterator<Item = Ray> + 'a>>;

/// Returns the rays that the arguments ask for. `bounds` is the box of the scene.
pub(crate) fn rays<'a>(streams: &Streams, args: &'a Args, bounds: &Aabb<f64>) -> anyhow::Result<Rays<'a>> {
    let (count, rays): (u64, Box<dyn Iterator<Item = Ray>>) = match &args.rays {
        Some(path) => {
            let rays = read_rays(streams, path, point_format(path, args.rays_format, "--rays-format")?)?;
            (rays.len() as u64, Box::new(rays.into_iter()))
        }
        None => {
            let count = args.random.unwrap_or(0);
            (count, Box::new(random_rays(Region::around(bounds, args.box_scale), count, args.seed)))
        }
    };
    let rays = rays.map(|ray| args.limited(&ray).expect("the limits fit every ray"));
    Ok(QueryStream { name: "rays", count, iter: Box::new(rays), block_size: BlockSize::Adaptive })
}
