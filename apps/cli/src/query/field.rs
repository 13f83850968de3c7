//! `p2m field`: distances from a scene on a grid or an octree.

use crate::answers::IndexSummary;
use crate::index::{IndexArgs, PreparedIndex, SignReport, SignRule, SignedIndex};
use crate::io::input::{has_extension, or_option};
use crate::io::usage::{finite, not_negative, one_of, positive, usage};
use crate::io::{Output, Progress, SceneFile, Session, Streams, Unit, is_standard, json, shown};
use crate::page::picture::write_png;
use crate::query::field_summary::{ComputedField, FieldSummary};
use crate::scene::convert::Target;
use anyhow::{Context, anyhow};
use nalgebra::Point3;
use p2m_backends::AnyIndex;
use p2m_core::{Aabb, PrimitiveSet, Soup};
use p2m_field::FieldFormat;
use p2m_field::grid_candidates::{CandidateLists, MAX_COORDINATE};
use p2m_field::{
    FieldOptions, Grid, OffsetSurface, RefineOptions, distances, distances_by_lists, offset_grid, offset_surface,
    refined, signed_distances, signed_distances_by_lists, slice, write_cells, write_field,
};
use p2m_mixed::statistics::Statistics;
use p2m_mixed::statistics::figure::Figure;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Instant;

const HELP: &str = "\
The grid covers the scaled box of the scene with the same spacing along all axes; the ends of the longest side are \
grid points. Values are rounded to f32. Unless you name a backend, fine grids are computed from candidate lists for \
blocks of the grid, which is faster and gives the same values; an AABB tree decides signs.

NPY files have an array field[i, j, k] with x, y and z. VTI files are images of VTK, with origin and spacing. RAW \
files have the values only, little-endian, x fastest. With --refine, the file is NPY: an array of cells with the \
fields origin, size and values (at the corners, x fastest).

With --signed, distances are negative where the winding number of the surface exceeds a half in magnitude. That \
works for surfaces with holes and overlapping shells. Closed surfaces with inconsistent orientations use the rule \
parity: a point is inside if a ray crosses the surface an odd number of times. Distances are NaN where rounding \
leaves the sign of an open surface undecided.

--iso writes a surface instead of the field: the points at this distance from the scene, inside for negative distances \
with --signed, as a closed triangle mesh. The grid covers it by itself. The report has the largest \
errors at vertices and at the middles of triangles.

Examples:
  p2m field bunny.obj --resolution 256 --signed --out bunny.vti --slice bunny.png
  p2m field scan.ply --resolution 512 --band 0.02 --out band.npy
  p2m field part.stl --iso 2 --signed --resolution 128 --out offset.ply
  p2m field part.stl --refine 0.001 --signed --out cells.npy --json";

/// Compute a distance field on a grid or an octree
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    index_args: IndexArgs,

    /// The number of grid points along the longest side
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=1 << 12), allow_negative_numbers = true)]
    resolution: u32,

    /// Scale the box of the scene about its centre by this factor
    #[arg(long, value_name = "S", default_value_t = 1.2, value_parser = positive, allow_negative_numbers = true)]
    box_scale: f64,

    /// Compute signed distances, negative inside; the scene must have triangles only
    #[arg(long, value_name = "RULE", num_args = 0..=1, require_equals = true, default_missing_value = "auto", value_enum)]
    signed: Option<SignRule>,

    /// Compute distances up to W only; farther points get W
    #[arg(long, value_name = "W", value_parser = not_negative, allow_negative_numbers = true, conflicts_with = "refine")]
    band: Option<f64>,

    /// Compute an octree instead, refined near the surface to this error of interpolation
    #[arg(long, value_name = "ERROR", value_parser = positive, allow_negative_numbers = true, conflicts_with_all = ["resolution", "slice", "out_format"])]
    refine: Option<f64>,

    /// The largest depth of the octree
    #[arg(long, value_name = "D", default_value_t = 8, value_parser = clap::value_parser!(u32).range(0..=16), requires = "refine", allow_negative_numbers = true)]
    depth: u32,

    /// Write the closed surface at this distance from the scene
    #[arg(long, value_name = "DISTANCE", value_parser = finite, allow_negative_numbers = true, conflicts_with_all = ["box_scale", "band", "refine", "out_format", "slice"])]
    iso: Option<f64>,

    /// Write the field to this file
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// The format of the field [default: by the file extension]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<FieldFormat>(FieldFormat::NAMES), ignore_case = true)]
    out_format: Option<FieldFormat>,

    /// Write a PNG picture of the middle layer, across z
    #[arg(long, value_name = "FILE")]
    slice: Option<PathBuf>,

    /// Print the summary as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let scene_args = &args.index_args.scene;
    let out_format = args.check(streams)?;
    let target = args.iso.map(|_| Target::by_extension(streams, &args.out)).transpose()?;
    let format = scene_args.format()?;
    let session = args.index_args.threads.start(streams)?;
    let file = scene_args.read(&session, format)?;
    let soup = &file.scene.soup;
    let grid = match args.iso {
        Some(distance) => offset_grid(&soup.aabb(), distance, args.resolution as usize),
        None => Grid::around(&soup.aabb(), args.resolution as usize, args.box_scale),
    };
    let grid = grid.with_context(|| file.name.clone())?;
    // The files are opened before the work, which would be lost if a name were wrong.
    let output = target.is_none().then(|| Output::open(streams, Some(&args.out))).transpose()?;
    let picture = args.slice.as_ref().map(|path| Output::open(streams, Some(path))).transpose()?;

    let start = Instant::now();
    let has_lists = args.index_args.is_unspecified() && args.refine.is_none();
    let lists = if has_lists { candidate_lists(&session, soup, &grid) } else { None };
    let prepared = args.prepare(&session, &file, &grid, lists.is_some())?;
    let index = prepared.as_ref().map(|prepared| &*prepared.built.index);
    let backend = match &prepared {
        Some(prepared) if lists.is_none() => prepared.backend.name,
        _ => LISTS_NAME,
    };
    let signed = args.signed.zip(index).map(|(rule, index)| rule.prepare_signed(streams, index, soup)).transpose();
    let source = DistanceSource { lists, index, signed: signed.with_context(|| file.name.clone())? };
    let build_time = start.elapsed();

    let start = Instant::now();
    let field = args.compute(&session, &source, &grid)?;
    let field_time = start.elapsed();
    let bytes = output.map_or(Ok(0), |mut output| -> anyhow::Result<u64> {
        match &field {
            ComputedField::Cells(cells) => write_cells(cells, &mut output),
            ComputedField::Grid(values) => write_field(&grid, values, out_format, &mut output),
        }
        .with_context(|| output.cannot_write())?;
        let bytes = output.bytes();
        output.finish().map(|()| bytes)
    })?;
    let surface = match (&target, &field, args.iso) {
        (Some(target), ComputedField::Grid(values), Some(distance)) => {
            let _progress = Progress::start(streams, "making the surface", None, Unit::None);
            let surface = session
                .pool
                .install(|| offset_surface(&grid, values, distance, &|point: &Point3<f64>| source.closest(point)));
            let surface = surface.with_context(|| file.name.clone())?;
            args.check_surface(streams, &grid, distance, &surface)?;
            Some(write_surface(streams, target, &grid, distance, &surface)?)
        }
        _ => None,
    };
    if let (Some(picture), ComputedField::Grid(values)) = (picture, &field) {
        draw_slice(&grid, values, picture)?;
    }

    let index = IndexSummary::new(&file, backend, prepared.as_ref(), build_time);
    let threads = if args.refine.is_some() { 1 } else { session.pool.current_num_threads() };
    let signs = source.signed.as_ref().map(SignReport::new);
    let report = FieldSummary { grid: &grid, field: &field, signs, threads, field_time };
    if args.json {
        let field_file = || json!({ "file": shown(&args.out), "format": out_format.name(), "bytes": bytes });
        let (surface, out) = surface.map_or_else(|| (Value::Null, field_file()), |(surface, out, _)| (surface, out));
        let end = json!({ "seconds": index.seconds("field", field_time), "surface": surface, "out": out });
        return json::print_report(streams, "field", [index.json(), report.json(), end]);
    }
    let field_text = || format!("written  {}, {bytes} bytes\n", args.out.display());
    let written = surface.map_or_else(field_text, |(_, _, text)| text);
    streams.print_summary(format_args!("{}{}{written}", index.text(None), report.text()));
    Ok(())
}

/// Writes and measures a surface. Returns the parts of a report about the surface and about its file, and lines for
/// people.
fn write_surface(
    streams: &Streams,
    target: &Target<'_>,
    grid: &Grid,
    distance: f64,
    surface: &OffsetSurface,
) -> anyhow::Result<(Value, Value, String)> {
    let OffsetSurface { soup, vertex_error, triangle_error, .. } = surface;
    let is_closed = Statistics::of(soup).edges.is_closed();
    let written = target.write(streams, &soup.clone().into())?;
    let report = json!({
        "distance": distance,
        "closed": is_closed,
        "vertex_error": json::number(*vertex_error),
        "triangle_error": json::number(*triangle_error),
    });
    let closed = if is_closed { "closed" } else { "not closed" };
    let (vertices, [triangles, distance]) = (error_of_vertices(surface, grid), [*triangle_error, distance].map(Figure));
    let text = format!(
        "surface  {closed}; vertices are within {vertices}, centroids within {triangles} of {distance}\n{}",
        written.text()
    );
    Ok((report, written.json(), text))
}

impl Args {
    /// Refuses arguments that cannot be met before any work, and returns the format of the field.
    fn check(&self, streams: &Streams) -> anyhow::Result<FieldFormat> {
        let scene = &self.index_args.scene;
        Output::refuse_report(self.json, &self.out, "the field has to go to a file")?;
        if let Some(distance) = self.iso {
            if self.resolution < MIN_ISO_RESOLUTION {
                return Err(usage(format!("--iso needs a --resolution of at least {MIN_ISO_RESOLUTION}")));
            }
            if distance <= 0.0 && self.signed.is_none() {
                return Err(usage(format!(
                    "--iso {distance}: distances without signs are never below 0: add --signed, or choose a distance \
                     above 0"
                )));
            }
        }
        let out_format = self.format()?;
        Output::refuse_inputs(&self.out, &[&scene.path])?;
        Output::refuse_terminal(streams, &self.out, out_format.name())?;
        if let Some(slice) = &self.slice {
            Output::refuse_inputs(slice, &[&scene.path])?;
            if slice == &self.out || is_standard(slice) {
                return Err(usage("--slice needs a file of its own"));
            }
            if !has_extension(slice, &["png"]) {
                return Err(usage(format!(
                    "--slice {}: the picture is a PNG file, so its name ends in .png",
                    slice.display()
                )));
            }
        }
        Ok(out_format)
    }

    /// Refuses a surface that is empty, and warns of one that may lack parts or has vertices elsewhere.
    fn check_surface(
        &self,
        streams: &Streams,
        grid: &Grid,
        distance: f64,
        surface: &OffsetSurface,
    ) -> anyhow::Result<()> {
        let (scene, spacing) = (self.index_args.scene.name(), grid.spacing());
        if surface.soup.is_empty() {
            return Err(anyhow!(
                "{scene}: there is no surface at {distance}: no point of the grid, or all of it, is nearer to the scene: \
                 try a higher --resolution"
            ));
        }
        // Without signs, what is nearer is a layer on both sides of the surface. A cell fits into a thinner one.
        if self.signed.is_none() && 2.0 * distance < spacing * 3f64.sqrt() {
            streams.print_summary(format_args!(
                "warning  {scene}: cells of {} are too large for a distance of {distance}, so parts of the surface may be \
                 missing: try a higher --resolution\n",
                Figure(spacing)
            ));
        }
        if surface.vertex_error > spacing {
            streams.print_summary(format_args!(
                "warning  {scene}: vertices are up to {} from where they should be: the side of points changes away from \
                 the surface, as it does at holes\n",
                error_of_vertices(surface, grid)
            ));
        }
        Ok(())
    }

    /// Returns the format of the field: the given one, or else that of the extension.
    fn format(&self) -> anyhow::Result<FieldFormat> {
        match self.out_format {
            Some(format) => Ok(format),
            // A surface has the format of a scene.
            None if self.iso.is_some() => Ok(FieldFormat::Raw),
            None if self.refine.is_some() => match FieldFormat::from_path(&self.out) {
                Ok(FieldFormat::Vti | FieldFormat::Raw) => {
                    Err(usage("--refine writes cells as NPY: choose another name"))
                }
                _ => Ok(FieldFormat::Npy),
            },
            None => FieldFormat::from_path(&self.out).map_err(|e| or_option(&e, "--out-format")),
        }
    }

    /// Loads or builds the index that distances are computed by, or that decides signs and moves vertices beside lists.
    fn prepare(
        &self,
        session: &Session<'_>,
        file: &SceneFile,
        grid: &Grid,
        has_lists: bool,
    ) -> anyhow::Result<Option<PreparedIndex>> {
        let chosen = match has_lists {
            true if self.signed.is_none() && self.iso.is_none() => return Ok(None),
            true => file.backend().into(),
            // Cells are cut by single queries.
            false if self.refine.is_some() => self.index_args.choice(session, file)?,
            false => self.index_args.choice_for(grid.len() as u64, session, file)?,
        };
        file.prepare(session, chosen).map(Some)
    }

    /// Computes the distances.
    fn compute(
        &self,
        session: &Session<'_>,
        source: &DistanceSource<'_>,
        grid: &Grid,
    ) -> anyhow::Result<ComputedField> {
        if let Some(error) = self.refine {
            let _progress = Progress::start(session.streams, "cutting cells", None, Unit::None);
            let bounds = Aabb { min: grid.origin(), max: grid.point(grid.counts().map(|n| n - 1)) };
            let distance = |point: &Point3<f64>| source.closest(point).map_or(f64::NAN, |found| found.0);
            let options = RefineOptions::new(error).with_depth(self.depth);
            return Ok(ComputedField::Cells(session.pool.install(|| refined(&bounds, &distance, &options))));
        }
        let progress =
            Progress::start(session.streams, "filling the grid", Some(grid.len() as u64), Unit::Items("points"));
        let options = self.band.map_or_else(FieldOptions::default, |band| FieldOptions::default().with_band(band));
        let count = |points: usize| progress.add(points as u64);
        let values = session.pool.install(|| match (&source.lists, &source.signed, source.index) {
            (Some(lists), Some(signed), _) => signed_distances_by_lists(lists, signed, grid, &options, &count),
            (Some(lists), None, _) => distances_by_lists(lists, grid, &options, &count),
            (None, Some(signed), _) => signed_distances(signed, grid, &options, &count),
            (None, None, Some(index)) => distances(index, grid, &options, &count),
            (None, None, None) => unreachable!("without lists there is an index"),
        })?;
        Ok(ComputedField::Grid(values))
    }
}

/// Draws the layer in the middle of a grid.
fn draw_slice(grid: &Grid, values: &[f32], mut picture: Output<'_>) -> anyhow::Result<()> {
    let (size, pixels) = slice(grid, values, 2, grid.counts()[2] / 2);
    let size = size.map(u32::try_from);
    let [Ok(width), Ok(height)] = size else { return Err(anyhow!("the slice is too large for a picture")) };
    write_png(&mut picture, [width, height], &pixels)?;
    picture.finish()
}

/// The least resolution of a grid around a surface, which has two layers of points on either side.
const MIN_ISO_RESOLUTION: u32 = 8;

/// Returns the largest error of vertices. One beyond the grid has no meaning as a length.
fn error_of_vertices(surface: &OffsetSurface, grid: &Grid) -> String {
    let size = (grid.point(grid.counts().map(|n| n - 1)) - grid.origin()).norm();
    if surface.vertex_error > size {
        "an unbounded length".to_owned()
    } else {
        Figure(surface.vertex_error).to_string()
    }
}

/// The source of distances: lists or an index. An index beside lists decides signs and moves vertices.
struct DistanceSource<'a> {
    lists: Option<CandidateLists<'a, Soup<f64>>>,
    index: Option<&'a dyn AnyIndex>,
    signed: Option<SignedIndex<'a>>,
}

impl DistanceSource<'_> {
    /// Returns the distance of a point by the index, signed if there are signs, and its closest point; none if the
    /// distance is undefined.
    fn closest(&self, point: &Point3<f64>) -> Option<(f64, Point3<f64>)> {
        let Some(signed) = &self.signed else {
            return self.index?.closest_point(point).map(|answer| (answer.distance, answer.point));
        };
        let answer = signed.closest_point(point)?;
        Some((answer.distance()?, answer.closest.point))
    }
}

/// The name of lists in reports, in place of that of a backend.
const LISTS_NAME: &str = "lists";

/// Returns lists of candidates, unless the grid is too coarse for them to pay, coordinates are out of their range, or
/// memory is short.
fn candidate_lists<'a>(
    session: &Session<'_>,
    soup: &'a Soup<f64>,
    grid: &Grid,
) -> Option<CandidateLists<'a, Soup<f64>>> {
    let last = grid.point(grid.counts().map(|n| n - 1));
    if grid.len() < soup.len() {
        return None;
    }
    let is_in_range = |point: &Point3<f64>| point.iter().all(|x| x.abs() <= MAX_COORDINATE);
    let is_in_range = is_in_range(&grid.origin()) && is_in_range(&last);
    let _progress = Progress::start(session.streams, "sorting primitives", None, Unit::None);
    session.pool.install(|| CandidateLists::new(soup)).filter(|_| is_in_range)
}
