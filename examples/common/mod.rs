//! Functions that several examples use.

use anyhow::Context;
use std::fs::File;
use std::io::BufWriter;

/// Writes a picture, three bytes a pixel, row by row from the top, and prints its name.
pub(crate) fn write_png(name: &str, [width, height]: [u32; 2], colours: &[u8]) -> anyhow::Result<()> {
    let file = File::create(name).with_context(|| format!("{name}: cannot be written"))?;
    let mut encoder = png::Encoder::new(BufWriter::new(file), width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(colours)?;
    println!("{name}");
    Ok(())
}
