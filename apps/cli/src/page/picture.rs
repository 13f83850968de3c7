//! Pictures in PNG files.

use crate::io::Output;
use anyhow::Context;

/// Writes a picture. `bytes` has red, green and blue of each pixel, row by row.
pub(crate) fn write_png(output: &mut Output<'_>, [width, height]: [u32; 2], bytes: &[u8]) -> anyhow::Result<()> {
    let cannot_write = output.cannot_write();
    let mut encoder = png::Encoder::new(output, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(bytes)).with_context(|| cannot_write)
}
