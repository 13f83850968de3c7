//! `p2m sample`: random points on and around a scene.

use crate::index::{BackendChoice, SignRule, backend_choices};
use crate::io::input::has_extension;
use crate::io::usage::{count, finite_not_negative, positive, usage};
use crate::io::{Output, Progress, SceneArgs, Streams, ThreadArgs, Unit, is_standard, json, shown};
use anyhow::{Context, anyhow};
use nalgebra::Point3;
use p2m_backends::{QueryRegion, Workload};
use p2m_core::batch::BatchOptions;
use p2m_core::{Aabb, PrimitiveSet, QueryOptions, npy_header};
use p2m_field::sample::{SurfaceSampler, in_box};
use p2m_mixed::Scene;
use p2m_mixed::statistics::figure::Count;
use serde_json::json;
use std::io::{self, Write};
use std::path::PathBuf;
use zip::write::{SimpleFileOptions, StreamWriter, ZipWriter};

const HELP: &str = "\
With --surface the file has points of the surface, evenly distributed by area, and the primitive of each. With --near \
and --uniform it has points with their signed distances, negative inside: first points of the surface that are moved by \
noise, then points that are evenly distributed in the box of the scene, enlarged by a tenth.

The points depend on the scene and these options alone: they are the same bits on every machine. The file is an NPZ \
file with the arrays points, and primitives or distances, as p2m.sample_surface and p2m.sample_sdf in Python return them.

Examples:
  p2m sample part.ply --near 1e6 --uniform 1e6 --out samples.npz
  p2m sample part.ply --near 500000 --sigma 0.01 --sigma 0.1 --f32 --out near.npz
  p2m sample part.ply --surface 100000 --seed 3 --out points.npz";

/// Choose random points on and around a scene, with signed distances
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// Choose N points of the surface
    #[arg(long, value_name = "N", value_parser = count, conflicts_with_all = ["near", "uniform"], required_unless_present_any = ["near", "uniform"])]
    surface: Option<u64>,

    /// Choose N points near the surface, with their signed distances
    #[arg(long, value_name = "N", value_parser = count)]
    near: Option<u64>,

    /// Choose N points in the box, with their signed distances
    #[arg(long, value_name = "N", value_parser = count)]
    uniform: Option<u64>,

    /// Standard deviation of the noise in each coordinate; of several, each is that of every second, third, .. point
    /// [default: the diagonal / 100]
    #[arg(long, value_name = "LENGTH", value_parser = finite_not_negative, allow_negative_numbers = true, requires = "near")]
    sigma: Vec<f64>,

    /// Size of the box of uniform points, relative to that of the scene
    #[arg(long, value_name = "F", value_parser = positive, default_value_t = 1.1, allow_negative_numbers = true)]
    box_scale: f64,

    /// Seed of the points
    #[arg(long, value_name = "K", default_value_t = 0, allow_negative_numbers = true)]
    seed: u64,

    /// Which points are inside
    #[arg(long, value_name = "RULE", value_enum, default_value = "auto")]
    sign: SignRule,

    /// Write numbers of 32 bits; distances are those of the rounded points
    #[arg(long)]
    f32: bool,

    /// The NPZ file
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// The index to search [default: the saved index, or auto]
    #[arg(long, value_parser = backend_choices())]
    backend: Option<BackendChoice>,

    #[command(flatten)]
    threads: ThreadArgs,

    /// Report as one JSON object on the standard output
    #[arg(long)]
    json: bool,
}

/// The memory that a sample takes: three coordinates and a number, as they are computed and as they are written.
const SAMPLE_BYTES: usize = 64;

/// The number of points that are answered at a time.
const BLOCK: usize = 1 << 22;

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    if !is_standard(&args.out) && !has_extension(&args.out, &["npz"]) {
        return Err(usage(format!(
            "{}: samples are written as NPZ files: choose a name that ends in .npz",
            shown(&args.out)
        )));
    }
    Output::refuse_report(args.json, &args.out, "the samples have to go to a file")?;
    Output::refuse_terminal(streams, &args.out, "an NPZ file")?;
    Output::refuse_inputs(&args.out, &[&args.scene.path])?;
    let [surface, near, uniform] = [args.surface, args.near, args.uniform].map(|n| usize::try_from(n.unwrap_or(0)));
    let (surface, near, uniform) = (surface?, near?, uniform?);
    let total = surface.saturating_add(near).saturating_add(uniform);
    if Vec::<[u8; SAMPLE_BYTES]>::new().try_reserve_exact(total).is_err() {
        return Err(anyhow!("there is no memory for {total} samples"));
    }
    let format = args.scene.format()?;
    let session = args.threads.start(streams)?;
    let file = args.scene.read(&session, format)?;
    let output = Output::open(streams, Some(&args.out))?;
    let sampler = SurfaceSampler::new(&*file.scene.soup).ok_or_else(|| {
        anyhow!("{}: the scene is empty, or no area or length of it is finite and above 0", file.name)
    })?;

    let mut arrays: Vec<(&str, Array)> = Vec::new();
    if args.surface.is_some() {
        let samples = session.pool.install(|| sampler.surface(args.seed, surface));
        arrays.push(("points", Array::points(&samples.points, args.f32)));
        let primitives = samples.primitives.iter().flat_map(|id| i64::from(id.number()).to_le_bytes());
        arrays
            .push(("primitives", Array { kind: "'<i8'", shape: format!("({surface},)"), bytes: primitives.collect() }));
    } else {
        let mut points = session.pool.install(|| points(args, &file.scene, &sampler, near, uniform));
        if args.f32 {
            #[allow(clippy::cast_possible_truncation, reason = "the user asked for it")]
            points.iter_mut().for_each(|point| *point = point.map(|x| f64::from(x as f32)));
        }
        let workload = Workload::new(points.len() as u64, QueryRegion::Like(&points)).with_needs_index(true);
        let chosen = file.choose(&session, args.backend, &workload)?;
        let index = file.prepare(&session, chosen)?.built.index;
        let signed = args.sign.prepare(streams, &*index, &file.scene.soup);
        let signed = signed.map_err(|error| anyhow!("{}: {error}", file.name))?;
        if let Some(note) = signed.note().filter(|_| args.sign == SignRule::Auto) {
            streams.print_summary(format_args!("warning  {}: {note}\n", file.name));
        }
        let progress = Progress::start(streams, "computing distances", Some(points.len() as u64), Unit::None);
        let mut distances = vec![f64::NAN; points.len()];
        for (block, out) in points.chunks(BLOCK).zip(distances.chunks_mut(BLOCK)) {
            let (options, batch) = (QueryOptions::default(), BatchOptions::default());
            session.pool.install(|| signed.distances_into(&*index, block, &options, &batch, out));
            progress.add(block.len() as u64);
        }
        drop(progress);
        arrays.push(("points", Array::points(&points, args.f32)));
        arrays.push(("distances", Array::numbers(distances.into_iter(), args.f32)));
    }
    let cannot_write = output.cannot_write();
    let output = write(output, &arrays).with_context(|| cannot_write)?;
    let bytes = output.bytes();
    output.finish()?;
    if args.json {
        let report = json!({
            "scene": { "file": file.name, "format": format.name() },
            "surface": surface,
            "near": near,
            "uniform": uniform,
            "seed": args.seed,
            "out": { "file": shown(&args.out), "format": "npz", "bytes": bytes },
        });
        return json::print_report(streams, "sample", [report]);
    }
    let (total, bytes) = (Count(total as u64), Count(bytes));
    streams.print_summary(format_args!("written  {}: {total} samples, {bytes} bytes\n", shown(&args.out)));
    Ok(())
}

/// Returns the points near the surface, and then those in the box.
fn points(
    args: &Args,
    scene: &Scene,
    sampler: &SurfaceSampler<impl PrimitiveSet<f64> + Sync>,
    near: usize,
    uniform: usize,
) -> Vec<Point3<f64>> {
    let bounds = scene.soup.aabb();
    let usual = [(bounds.max - bounds.min).norm() / 100.0];
    let sigmas = if args.sigma.is_empty() { &usual[..] } else { &args.sigma };
    let mut points = sampler.near(args.seed, near, sigmas).points;
    let (middle, half) = (nalgebra::center(&bounds.min, &bounds.max), (bounds.max - bounds.min) / 2.0 * args.box_scale);
    points.extend(in_box(&Aabb { min: middle - half, max: middle + half }, args.seed, uniform));
    points
}

/// An array of an NPZ file.
struct Array {
    kind: &'static str,
    shape: String,
    bytes: Vec<u8>,
}

impl Array {
    fn points(points: &[Point3<f64>], is_f32: bool) -> Self {
        let shape = format!("({}, 3)", points.len());
        Self { shape, ..Self::numbers(points.iter().flat_map(|point| [point.x, point.y, point.z]), is_f32) }
    }

    fn numbers(numbers: impl Iterator<Item = f64>, is_f32: bool) -> Self {
        let mut bytes = Vec::new();
        let mut count = 0u64;
        for number in numbers {
            count += 1;
            #[allow(clippy::cast_possible_truncation, reason = "the user asked for it")]
            if is_f32 { bytes.extend((number as f32).to_le_bytes()) } else { bytes.extend(number.to_le_bytes()) }
        }
        Self { kind: if is_f32 { "'<f4'" } else { "'<f8'" }, shape: format!("({count},)"), bytes }
    }
}

/// Writes arrays as an NPZ file.
fn write<W: Write>(output: W, arrays: &[(&str, Array)]) -> io::Result<W> {
    let mut file: ZipWriter<StreamWriter<W>> = ZipWriter::new_stream(output);
    for (name, array) in arrays {
        // Files of 4 GB and more have other headers.
        let options = SimpleFileOptions::default()
            .compression_method(zip::CompressionMethod::Stored)
            .large_file(array.bytes.len() as u64 >= u64::from(u32::MAX) - 1024);
        file.start_file(format!("{name}.npy"), options)?;
        file.write_all(&npy_header(array.kind, &array.shape, false))?;
        file.write_all(&array.bytes)?;
    }
    Ok(file.finish()?.into_inner())
}
