//! `p2m generate`: generates scenes.

use crate::io::usage::{finite, one_of, whole_number};
use crate::io::{Progress, Streams, Unit, is_standard, json};
use crate::scene::convert::Target;
use crate::scene::modify::{self, Modifiers};
use clap::{Args as ClapArgs, Subcommand, value_parser};
use p2m_mixed::generate::{
    CableBundle, Cone, Cylinder, IcoSphere, Kind, KnotAndCables, MixedSizes, SkewedGear, Sphere, TorusKnot,
};
use p2m_mixed::{Format, Scene};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Generate a scene, the same on every machine
#[derive(ClapArgs)]
#[command(after_help = help())]
pub(crate) struct Args {
    #[command(subcommand)]
    kind: Command,
}

fn help() -> String {
    format!(
        "\
Each kind of scene has its own options, and all kinds can be transformed (see p2m generate KIND --help). Without \
--out, the scene goes to the standard output as OBJ. {}

Examples:
  p2m generate knot-and-cables --out knot_and_cables.obj
  p2m generate skewed-gear --rotate-x 45 --rotate-y 45 --out gear.ply
  p2m generate ico-sphere --subdivide 2 --displace 0.1 | p2m info - --format obj",
        modify::ORDER
    )
}

/// The file that the scene is written to, and the changes before that.
#[derive(ClapArgs, Serialize)]
struct Destination {
    /// Write the scene to this file; `-` is the standard output
    #[arg(long, value_name = "FILE", default_value = "-")]
    out: PathBuf,

    /// The format [default: by the file extension; OBJ on the standard output]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<Format>(Format::NAMES), ignore_case = true)]
    #[serde(skip)]
    to: Option<Format>,

    /// Print the summary as JSON; needs --out FILE
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    modifiers: Modifiers,
}

#[derive(Subcommand, Serialize)]
#[serde(untagged)]
enum Command {
    /// A torus knot of triangles with cables of segments around it
    #[command(after_help = "Examples:\n  p2m generate knot-and-cables --rings 600 --sides 24 --out fine.obj")]
    KnotAndCables {
        /// Rings of vertices along the knot
        #[arg(long, default_value_t = KnotAndCables::default().rings, value_parser = value_parser!(u32).range(3..))]
        rings: u32,
        /// Vertices of each ring
        #[arg(long, default_value_t = KnotAndCables::default().sides, value_parser = value_parser!(u32).range(3..))]
        sides: u32,
        /// Cables
        #[arg(long, default_value_t = KnotAndCables::default().cables)]
        cables: u32,
        /// Segments of each cable
        #[arg(long, default_value_t = KnotAndCables::default().cable_segments, value_parser = value_parser!(u32).range(1..))]
        cable_segments: u32,
        #[command(flatten)]
        destination: Destination,
    },

    /// A closed tube of triangles along a torus knot
    #[command(after_help = "Examples:\n  p2m generate torus-knot --p 3 --q 5 --tube-radius 0.2 --out knot.ply")]
    TorusKnot {
        /// Turns around the axis of the torus
        #[arg(long, default_value_t = TorusKnot::default().p)]
        p: u32,
        /// Turns around the tube of the torus; no common divisor with P
        #[arg(long, default_value_t = TorusKnot::default().q)]
        q: u32,
        /// Rings of vertices along the knot
        #[arg(long, default_value_t = TorusKnot::default().rings, value_parser = value_parser!(u32).range(3..))]
        rings: u32,
        /// Vertices of each ring
        #[arg(long, default_value_t = TorusKnot::default().sides, value_parser = value_parser!(u32).range(3..))]
        sides: u32,
        /// The radius of the tube, where those of the torus are 2 and 0.8
        #[arg(long, value_name = "R", default_value_t = TorusKnot::default().tube_radius, value_parser = finite, allow_negative_numbers = true)]
        tube_radius: f64,
        #[command(flatten)]
        destination: Destination,
    },

    /// A helical gear around the z axis, of thin triangles alone
    #[command(after_help = "Examples:\n  p2m generate skewed-gear --rotate-x 45 --rotate-y 45 --out gear.ply")]
    SkewedGear {
        /// Teeth
        #[arg(long, default_value_t = SkewedGear::default().teeth, value_parser = value_parser!(u32).range(3..))]
        teeth: u32,
        /// Points of the outline for each tooth: the more, the thinner the triangles
        #[arg(long, default_value_t = SkewedGear::default().points, value_parser = value_parser!(u32).range(4..))]
        points: u32,
        #[command(flatten)]
        destination: Destination,
    },

    /// The unit sphere by latitude and longitude, its triangles thin at the poles
    #[command(after_help = "Examples:\n  p2m generate sphere --meridians 360 --bands 180 --out sphere.stl")]
    Sphere {
        /// Vertices of each parallel
        #[arg(long, default_value_t = Sphere::default().meridians, value_parser = value_parser!(u32).range(3..))]
        meridians: u32,
        /// Bands between the parallels, those at the poles included
        #[arg(long, default_value_t = Sphere::default().bands, value_parser = value_parser!(u32).range(2..))]
        bands: u32,
        #[command(flatten)]
        destination: Destination,
    },

    /// The unit sphere as a subdivided icosahedron, its triangles alike
    #[command(after_help = "Examples:\n  p2m generate ico-sphere --frequency 100 --out sphere.ply")]
    IcoSphere {
        /// Into how many parts each edge of the icosahedron is cut
        #[arg(long, default_value_t = IcoSphere::default().frequency, value_parser = value_parser!(u32).range(1..))]
        frequency: u32,
        #[command(flatten)]
        destination: Destination,
    },

    /// A closed cone of radius 1 from z = -1 to its apex at z = 1
    #[command(after_help = "Examples:\n  p2m generate cone --sides 6 --bands 1 --cap-bands 1 --out pyramid.off")]
    Cone {
        /// Vertices around
        #[arg(long, default_value_t = Cone::default().sides, value_parser = value_parser!(u32).range(3..))]
        sides: u32,
        /// Bands of the slope
        #[arg(long, default_value_t = Cone::default().bands, value_parser = value_parser!(u32).range(1..))]
        bands: u32,
        /// Rings of triangles of the base
        #[arg(long, default_value_t = Cone::default().cap_bands, value_parser = value_parser!(u32).range(1..))]
        cap_bands: u32,
        #[command(flatten)]
        destination: Destination,
    },

    /// A closed cylinder of radius 1 from z = -1 to z = 1
    #[command(after_help = "Examples:\n  p2m generate cylinder --scale 10 --translate 0 0 5 --out can.obj")]
    Cylinder {
        /// Vertices around
        #[arg(long, default_value_t = Cylinder::default().sides, value_parser = value_parser!(u32).range(3..))]
        sides: u32,
        /// Bands of the wall
        #[arg(long, default_value_t = Cylinder::default().bands, value_parser = value_parser!(u32).range(1..))]
        bands: u32,
        /// Rings of triangles of each cap
        #[arg(long, default_value_t = Cylinder::default().cap_bands, value_parser = value_parser!(u32).range(1..))]
        cap_bands: u32,
        #[command(flatten)]
        destination: Destination,
    },

    /// Twisted strands of segments along a knot
    #[command(after_help = "Examples:\n  p2m generate cable-bundle --strands 19 --twists 12 --out bundle.obj")]
    CableBundle {
        /// Strands
        #[arg(long, default_value_t = CableBundle::default().strands, value_parser = value_parser!(u32).range(1..))]
        strands: u32,
        /// Segments of each strand
        #[arg(long, default_value_t = CableBundle::default().segments, value_parser = value_parser!(u32).range(1..))]
        segments: u32,
        /// How often the bundle turns about itself
        #[arg(long, value_name = "T", default_value_t = CableBundle::default().twists, value_parser = finite, allow_negative_numbers = true)]
        twists: f64,
        /// The radius of the bundle, where the knot's torus has radii 2 and 0.8
        #[arg(long, value_name = "R", default_value_t = CableBundle::default().radius, value_parser = finite, allow_negative_numbers = true)]
        radius: f64,
        #[command(flatten)]
        destination: Destination,
    },

    /// Random triangles, segments and points with sizes over orders of magnitude
    #[command(
        after_help = "Examples:\n  p2m generate mixed-sizes --triangles 100000 --decades 9 --seed 7 --out mixed.ply"
    )]
    MixedSizes {
        /// Triangles
        #[arg(long, default_value_t = MixedSizes::default().triangles)]
        triangles: u32,
        /// Segments
        #[arg(long, default_value_t = MixedSizes::default().segments)]
        segments: u32,
        /// Points
        #[arg(long, default_value_t = MixedSizes::default().points)]
        points: u32,
        /// The largest size is 10^D times the least one
        #[arg(long, value_name = "D", default_value_t = MixedSizes::default().decades, value_parser = finite, allow_negative_numbers = true)]
        decades: f64,
        /// Another seed makes another scene
        #[arg(long, value_name = "K", default_value_t = MixedSizes::default().seed, value_parser = whole_number, allow_negative_numbers = true)]
        seed: u64,
        #[command(flatten)]
        destination: Destination,
    },
}

impl Command {
    /// Returns the kind of scene with its options, and the target of the scene.
    fn parts(&self) -> (Kind, &Destination) {
        match *self {
            Self::KnotAndCables { rings, sides, cables, cable_segments, ref destination } => {
                (Kind::KnotAndCables(KnotAndCables { rings, sides, cables, cable_segments }), destination)
            }
            Self::TorusKnot { p, q, rings, sides, tube_radius, ref destination } => {
                (Kind::TorusKnot(TorusKnot { p, q, rings, sides, tube_radius }), destination)
            }
            Self::SkewedGear { teeth, points, ref destination } => {
                (Kind::SkewedGear(SkewedGear { teeth, points }), destination)
            }
            Self::Sphere { meridians, bands, ref destination } => {
                (Kind::Sphere(Sphere { meridians, bands }), destination)
            }
            Self::IcoSphere { frequency, ref destination } => (Kind::IcoSphere(IcoSphere { frequency }), destination),
            Self::Cone { sides, bands, cap_bands, ref destination } => {
                (Kind::Cone(Cone { sides, bands, cap_bands }), destination)
            }
            Self::Cylinder { sides, bands, cap_bands, ref destination } => {
                (Kind::Cylinder(Cylinder { sides, bands, cap_bands }), destination)
            }
            Self::CableBundle { strands, segments, twists, radius, ref destination } => {
                (Kind::CableBundle(CableBundle { strands, segments, twists, radius }), destination)
            }
            Self::MixedSizes { triangles, segments, points, decades, seed, ref destination } => {
                (Kind::MixedSizes(MixedSizes { triangles, segments, points, decades, seed }), destination)
            }
        }
    }

    /// Returns the options of the kind as a report has them.
    fn json(&self) -> Value {
        let mut options = json!(self);
        if let Value::Object(options) = &mut options {
            options.shift_remove("destination");
        }
        options
    }
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let (kind, destination) = args.kind.parts();
    let target = Target::new(streams, &destination.out, destination.to, Some(Format::Obj))?;
    target.check_report(destination.json)?;
    let progress = Progress::start(streams, "making the scene", None, Unit::None);
    let soup = kind.generate().map_err(modify::refused)?;
    drop(progress);
    let scene = destination.modifiers.apply(streams, Scene::from(soup))?;
    let written = target.write(streams, &scene)?;
    if destination.json {
        let report = json!({
            "kind": kind.name(),
            "options": args.kind.json(),
            "changes": destination.modifiers.json(),
            "out": written.json(),
        });
        return json::print_report(streams, "generate", [report]);
    }
    if !is_standard(&destination.out) {
        streams.print_summary(format_args!("made     {}\n{}", kind.description(), written.text()));
    }
    Ok(())
}
