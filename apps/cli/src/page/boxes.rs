//! `p2m boxes`: draws the boxes of the AABB tree, or the polytopes of the k-DOP tree, level by level.

use crate::index::kdop_faces;
use crate::io::{Output, Progress, SceneArgs, Streams, ThreadArgs, Unit, json, shown};
use crate::page::drawing::{Panel, View, box_edges, write_picture_ply, write_svg};
use crate::page::tree_levels::TreeLevels;
use crate::page::up_axis::up_axes;
use anyhow::{Context, bail};
use nalgebra::Point3;
use p2m_backends::{KdopDirections, KdopVisitor};
use p2m_bvh::{AabbTree, PacketTree, SplitOptions, TreeNode, Volume};
use p2m_core::Soup;
use p2m_kdop::{KdopTree, Polytope};
use p2m_mixed::statistics::figure::Count;
use p2m_page::UpAxis;
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;

const HELP: &str = "\
Each panel shows one level of the tree: its nodes, and the leaves of all higher levels. The last panel shows all \
leaves. In a PLY file, the vertex property 'panel' has the number of the panel. Dots are vertices of the scene, at \
most 4000.

Examples:
  p2m boxes bunny.obj --out boxes.svg
  p2m boxes scene.ply --levels 5 --view top --out boxes.svg
  p2m boxes scene.ply --k 14 --levels 2 --out polytopes.svg
  p2m boxes scene.ply --levels 12 --out boxes.ply";

/// Draw the levels of an AABB tree or a k-DOP tree as SVG or PLY
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// Write the picture to this file (.svg or .ply)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// The number of levels to draw, from the root
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u8).range(0..=64))]
    levels: u8,

    /// Draw a k-DOP tree whose polytopes have this many faces
    #[arg(long, value_name = "K", value_parser = kdop_faces(), ignore_case = true, allow_negative_numbers = true)]
    k: Option<KdopDirections>,

    /// The view of an SVG picture
    #[arg(long, value_enum, default_value_t = View::Isometric)]
    view: View,

    /// The axis that points up in an SVG picture
    #[arg(long, value_parser = up_axes(), default_value = "z")]
    up: UpAxis,

    #[command(flatten)]
    threads: ThreadArgs,

    /// Print the levels as JSON
    #[arg(long)]
    json: bool,
}

/// The largest number of vertices that a picture shows.
const MAX_DOTS: usize = 4000;

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let is_ply = match args.out.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("svg") => false,
        Some("ply") => true,
        _ => bail!("{}: the name of a picture ends in .svg or .ply", args.out.display()),
    };
    Output::refuse_inputs(&args.out, &[&args.scene.path])?;
    let format = args.scene.format()?;
    let session = args.threads.start(streams)?;
    let scene = args.scene.read(&session, format)?.scene;
    let progress = Progress::start(streams, "building", None, Unit::None);
    let levels = usize::from(args.levels);
    let drawn = session.pool.install(|| match args.k {
        None => AabbTree::new(&*scene.soup)
            .map(|tree| panels(tree.tree(), levels, ["box", "boxes"], |bounds| box_edges(bounds).collect()))
            .map(|panels| (panels, None)),
        Some(directions) => directions
            .build(&*scene.soup, SplitOptions::default(), PolytopePanels { levels })
            .map(|(panels, directions)| (panels, Some(directions))),
    });
    let (drawn, directions) = drawn.with_context(|| args.scene.name())?;
    let reason = directions.as_ref().and_then(|directions| directions.reason.as_ref());
    drop(progress);
    let (drawn, mut panels): (Vec<DrawnLevel>, Vec<Panel>) = drawn.into_iter().unzip();
    let mut output = Output::open(streams, Some(&args.out))?;
    let written = if is_ply {
        write_picture_ply(&panels, &mut output)
    } else {
        let mut dots = dots(&scene.soup);
        if args.up == UpAxis::Y {
            let points = panels.iter_mut().flat_map(|panel| &mut panel.lines).flatten().chain(&mut dots);
            points.for_each(|p| *p = Point3::new(p.x, -p.z, p.y));
        }
        write_svg(&panels, &dots, args.view, &mut output)
    };
    written.with_context(|| output.cannot_write())?;
    output.finish()?;
    if args.json {
        let report = json!({
            "scene": { "file": args.scene.name(), "format": format.name() },
            "out": { "file": shown(&args.out) },
            "faces": directions.as_ref().map(|directions| directions.faces),
            "directions_reason": reason,
            "panels": drawn,
        });
        return json::print_report(streams, "boxes", [report]);
    }
    panels.iter().for_each(|panel| streams.print_summary(format_args!("{}\n", panel.title)));
    if let Some(reason) = reason {
        streams.print_summary(format_args!("k-DOPs: {reason}\n"));
    }
    Ok(())
}

/// The content of a panel, as reports have it.
#[derive(Serialize)]
struct DrawnLevel {
    /// The level, or `None` for the leaves.
    level: Option<usize>,
    /// The number of boxes or polytopes.
    boxes: usize,
}

/// Draws the panels of a k-DOP tree.
struct PolytopePanels {
    levels: usize,
}

impl KdopVisitor<&Soup<f64>> for PolytopePanels {
    type Output = Vec<(DrawnLevel, Panel)>;
    fn visit<const K: usize>(self, tree: KdopTree<f64, &Soup<f64>, K>) -> Self::Output {
        let edges = |kdop: &_| Polytope::new(kdop, tree.directions()).edges().collect();
        panels(tree.tree(), self.levels, ["polytope", "polytopes"], edges)
    }
}

/// Returns a panel for each of the first levels, and one for the leaves.
fn panels<V: Volume>(
    tree: &PacketTree<V>,
    levels: usize,
    [one, many]: [&str; 2],
    edges: impl Fn(&V) -> Vec<[Point3<f64>; 2]>,
) -> Vec<(DrawnLevel, Panel)> {
    let tree_levels = TreeLevels::new(tree);
    let panel = |level: Option<usize>, shown: Vec<&TreeNode<V>>| {
        let title = level.map_or("leaves".to_owned(), |level| format!("level {level}"));
        let noun = if shown.len() == 1 { one } else { many };
        let panel = Panel {
            title: format!("{title}: {} {noun}", Count(shown.len() as u64)),
            lines: shown.iter().flat_map(|node| edges(&node.volume)).collect(),
        };
        (DrawnLevel { level, boxes: shown.len() }, panel)
    };
    let drawn = levels.min(tree_levels.count());
    let mut panels: Vec<_> = (0..drawn).map(|level| panel(Some(level), tree_levels.level(level))).collect();
    panels.push(panel(None, tree_levels.leaves()));
    panels
}

/// Returns vertices of the primitives, evenly spaced in the order of the scene.
fn dots(soup: &Soup<f64>) -> Vec<Point3<f64>> {
    let used: Vec<u32> = soup.elements().flat_map(|e| e.indices().to_vec()).collect();
    let step = used.len().div_ceil(MAX_DOTS).max(1);
    used.iter().step_by(step).map(|&i| soup.positions()[i as usize]).collect()
}
