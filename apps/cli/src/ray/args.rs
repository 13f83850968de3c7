//! The arguments of `p2m ray`, and the rays that they ask for.

use crate::answers::{BlockSize, QueryArgs, QueryStream, Region, random_rays};
use crate::index::{Backend, backends};
use crate::io::input::{ray_format, read_rays};
use crate::io::usage::{bytes, count, finite_not_negative, number, one_of, positive, usage, whole_number};
use crate::io::{SceneArgs, Streams, input, json};
use clap::builder::PossibleValue;
use clap::{ArgGroup, ValueEnum};
use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, Ray, RayError};
use p2m_mixed::PointFormat;
use serde_json::{Value, json};
use std::path::PathBuf;

const HELP: &str = "\
The points of a ray are origin + t direction, for parameters t from --min to --max, both included. Whether a ray \
intersects a primitive is decided without rounding: no ray slips through between two triangles with a common edge, \
and all backends give the same table, except with --mode any. A hit on a common edge counts for both triangles, and \
once as a crossing.

The table has the columns ray,ox,oy,oz,dx,dy,dz: the number of the ray, its origin and its direction. The modes \
intersects, count and crossings add one column. The others add parameter,x,y,z,primitive,side,w0,w1,w2: the \
parameter and the point of the hit, the number of the primitive, the side of the triangle (front, back, or along for \
a ray in its plane and for segments and points), and the weights of its vertices. In the modes first and any, each \
ray has one row, whose last nine cells are empty without a hit. In the mode all, each hit has a row, sorted by \
parameter and then by primitive. A scene with named objects has the column object. The summary goes to the standard \
error.

NPY files have an array with the fields origin, direction, ray, and hit, count or crossings, or parameter, point, \
barycentric, primitive and side (0 front, 1 back, 2 along). PLY files have a cloud of the origins, with the \
directions as normals. Where there is no hit, numbers are NaN and -1.

CSV files need the columns ox, oy, oz, dx, dy, dz, or x, y, z with dx, dy, dz or nx, ny, nz, or Points:0 to Points:2 \
and Normals:0 to Normals:2; otherwise the first six columns are used. So the table of hits is itself a file of rays. \
XYZ and TXT files have at least six columns, separated by blanks. NPY files have arrays of six columns. PLY files \
give their vertices and normals. Numbers that are not finite and directions of length 0 are errors.

Examples:
  p2m ray bunny.obj --rays scan.csv --out hits.csv
  p2m ray scene.ply --random 100000 --seed 7 --mode all --out hits.npy --json
  p2m ray part.stl --random 1000 --line --mode crossings > crossings.csv
  p2m ray wires.obj --rays rays.npy --radius 0.01 --max 10 --backend kdop --k 14
  p2m generate torus-knot | p2m ray - --format obj --random 1000 --mode intersects --out hit.ply";

/// Find the hits of rays with a scene: the first, all, or their number
#[derive(clap::Args)]
#[command(after_help = HELP)]
#[command(group = ArgGroup::new("questions").required(true).args(["rays", "random"]))]
pub(crate) struct Args {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,

    /// Read the rays from a file: XYZ, TXT, ASC, PTS, CSV, NPY or PLY
    #[arg(long, value_name = "FILE")]
    rays: Option<PathBuf>,

    /// The format of the rays [default: by the file extension]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<PointFormat>(PointFormat::NAMES), ignore_case = true, conflicts_with = "random")]
    rays_format: Option<PointFormat>,

    /// Cast N rays from random points in the box of the scene in random directions
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
    random: Option<u64>,

    /// Scale the box of the scene about its centre by this factor
    ///
    /// The box of a flat scene also grows along its thin axis, by as much as along its longest one.
    #[arg(long, value_name = "S", default_value_t = 1.05, value_parser = positive, allow_negative_numbers = true, conflicts_with = "rays")]
    box_scale: f64,

    /// The seed of the random rays
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole_number, allow_negative_numbers = true, conflicts_with = "rays")]
    seed: u64,

    /// What to find for each ray
    #[arg(long, value_enum, default_value_t = Mode::First)]
    pub(crate) mode: Mode,

    /// Extend each ray backwards to a line
    #[arg(long, conflicts_with = "min")]
    line: bool,

    /// The smallest parameter, in lengths of the direction
    #[arg(long, value_name = "T", default_value_t = 0.0, value_parser = number, allow_hyphen_values = true)]
    min: f64,

    /// The largest parameter [default: none]
    #[arg(long, value_name = "T", value_parser = number, allow_hyphen_values = true)]
    max: Option<f64>,

    /// The radius of segments and points, in the unit of the scene
    #[arg(long, value_name = "R", default_value_t = 0.0, value_parser = finite_not_negative, allow_negative_numbers = true)]
    radius: f64,

    /// The index to search [default: the saved index, or aabb]
    #[arg(long, value_parser = backends(|backend| backend.casts_rays))]
    pub(crate) backend: Option<Backend>,

    /// Keep at most this much of an index in shards in memory, such as 4GB
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
    /// Any hit, which depends on the backend
    Any,
    /// The hit with the smallest parameter
    First,
    /// All hits
    All,
    /// The number of hits
    Count,
    /// The number of crossings of the surface of the triangles; one on an edge or a vertex counts once
    Crossings,
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
        let report = json!({
            "mode": self.mode.to_possible_value().as_ref().map(PossibleValue::get_name),
            "range": { "min": min, "max": max },
            "radius": self.radius,
            "source": source,
        });
        json::joined([report, summary])
    }
}

/// The rays of the arguments.
pub(crate) type Rays<'a> = QueryStream<Box<dyn Iterator<Item = Ray> + 'a>>;

/// Returns the rays that the arguments ask for. `bounds` is the box of the scene.
pub(crate) fn rays<'a>(streams: &Streams, args: &'a Args, bounds: &Aabb<f64>) -> anyhow::Result<Rays<'a>> {
    let (count, rays): (u64, Box<dyn Iterator<Item = Ray>>) = match &args.rays {
        Some(path) => {
            let rays = read_rays(streams, path, ray_format(path, args.rays_format, "--rays-format")?)?;
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
