//! The third example of the k-DOP tree's manual: writes the volumes of a tree as polytopes, with the manual's own
//! directions.
//!
//! Some levels of nodes and all leaves become PLY files of polygons in the temporary folder, or in the folder that is
//! given after the mesh. The levels are given after the folder; the default is the root and its children.
//!
//! `cargo run --release --example kdop_polytopes -- mesh.obj folder 0 1 3`

use anyhow::Context;
use nalgebra::Vector3;
use p2m::kdop::Directions;
use p2m::kdop::{Polytope, write_polytopes_ply};
use p2m::{KdopOptions, KdopTree};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "scenes/knot_and_cables.obj".to_owned());
    let folder = arguments.next().map_or_else(std::env::temp_dir, PathBuf::from);
    let level = |text: String| {
        text.parse().ok().with_context(|| format!("'{text}' is not a level: they are whole numbers from 0"))
    };
    let mut levels: Vec<usize> = arguments.map(level).collect::<anyhow::Result<_>>()?;
    if levels.is_empty() {
        levels = vec![0, 1];
    }
    let scene = p2m::scene::read_scene(name.as_ref())?.soup;
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    // The directions are the axes and four others. They need not be unit vectors, and their opposites are added.
    let directions = Directions::<14>::new(&[
        Vector3::x(),
        Vector3::y(),
        Vector3::z(),
        Vector3::new(1.0, 2.0, 1.0),
        Vector3::new(-2.0, 1.0, 1.0),
        Vector3::new(-1.0, -2.0, 1.0),
        Vector3::new(1.0, -2.0, 1.0),
    ])?;
    let tree = KdopTree::<f64, _, 14>::build_with(&scene, &KdopOptions::new(directions))?;
    let parts: Vec<_> = tree.tree().parts().collect();
    println!("number of polytopes: {}", parts.len());
    let write = |name: &str, polytopes: &[(Polytope, usize)]| -> std::io::Result<()> {
        let path = folder.join(name);
        let mut out = BufWriter::new(File::create(&path)?);
        write_polytopes_ply(&mut out, polytopes, "level")?;
        out.flush()?;
        println!("{}: {} polytopes", path.display(), polytopes.len());
        Ok(())
    };
    let polytope = |volume| Polytope::new(volume, &directions);
    for level in levels {
        let of_level = parts.iter().filter(|part| part.depth == level);
        let polytopes: Vec<_> = of_level.map(|part| (polytope(&part.volume), level)).collect();
        write(&format!("polytopes-level-{level}.ply"), &polytopes)?;
    }
    let leaves = parts.iter().filter(|part| tree.tree().primitives(part).is_some());
    let leaves: Vec<_> = leaves.map(|part| (polytope(&part.volume), part.depth)).collect();
    write("polytopes-leaves.ply", &leaves)?;
    Ok(())
}
