//! The two files of a sheet: a picture in pixels, and a page with text that can be searched.

use super::picture::Picture;
use crate::packed::compress;
use flate2::Compression;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};

/// The size of a sheet in points, of which an inch has 72: A4, upright.
pub(super) const SIZE: [f64; 2] = [595.0, 842.0];
/// The number of pixels of a point, along each side.
pub(super) const PIXELS: usize = 2;

/// A size of text.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Text {
    Body,
    Bold,
    Title,
}

impl Text {
    /// Returns the width of a character in points, which is 0.6 of the size of the font in both files.
    pub(super) fn advance(self) -> f64 {
        if self == Self::Title { 7.2 } else { 5.4 }
    }
}

/// A sheet that is being drawn. Positions and sizes are in points, from the upper left corner.
pub(super) trait Canvas {
    /// Fills a rectangle, which is given by its upper left corner and its size.
    fn rect(&mut self, at: [f64; 2], size: [f64; 2], colour: [u8; 3]);
    /// Writes characters of Latin-1. `at` is the left end of their base line.
    fn text(&mut self, at: [f64; 2], kind: Text, colour: [u8; 3], text: &str);
    /// Shows a picture whose pixels are those of the sheet.
    fn picture(&mut self, at: [f64; 2], picture: &Picture);
}

/// Returns the characters as bytes of Latin-1, with a question mark for what it lacks.
fn latin(text: &str) -> impl Iterator<Item = u8> + '_ {
    text.chars().map(|c| match u8::try_from(c) {
        Ok(byte) if byte >= 0xa0 || (0x20..0x7f).contains(&byte) => byte,
        _ => b'?',
    })
}

/// A sheet as a picture.
pub(super) struct Pixels {
    bytes: Vec<u8>,
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the size of a sheet")]
impl Pixels {
    const WIDTH: usize = SIZE[0] as usize * PIXELS;
    const HEIGHT: usize = SIZE[1] as usize * PIXELS;

    pub(super) fn new() -> Self {
        Self { bytes: vec![255; 3 * Self::WIDTH * Self::HEIGHT] }
    }

    /// Returns the file.
    pub(super) fn finish(self) -> Result<Vec<u8>, png::EncodingError> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, Self::WIDTH as u32, Self::HEIGHT as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header()?.write_image_data(&self.bytes)?;
        Ok(file)
    }

    /// Mixes a colour into a pixel.
    #[allow(clippy::cast_possible_truncation, reason = "a mean of two bytes")]
    fn mix(&mut self, [x, y]: [usize; 2], colour: [u8; 3], opacity: u8) {
        if x < Self::WIDTH && y < Self::HEIGHT {
            let at = 3 * (y * Self::WIDTH + x);
            for (byte, colour) in self.bytes[at..at + 3].iter_mut().zip(colour) {
                let [old, new, opacity] = [*byte, colour, opacity].map(u32::from);
                *byte = ((old * (255 - opacity) + new * opacity) / 255) as u8;
            }
        }
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "negative positions are outside")]
fn pixel(x: f64) -> usize {
    (x * PIXELS as f64).round() as usize
}

impl Canvas for Pixels {
    fn rect(&mut self, at: [f64; 2], size: [f64; 2], colour: [u8; 3]) {
        let [columns, rows] = [0, 1].map(|k| {
            let first = pixel(at[k]);
            // Thin lines are a pixel wide.
            first..pixel(at[k] + size[k]).max(first + 1)
        });
        for row in rows {
            columns.clone().for_each(|column| self.mix([column, row], colour, 255));
        }
    }

    fn text(&mut self, [x, y]: [f64; 2], kind: Text, colour: [u8; 3], text: &str) {
        let (height, weight) = match kind {
            Text::Body => (RasterHeight::Size24, FontWeight::Regular),
            Text::Bold => (RasterHeight::Size24, FontWeight::Bold),
            Text::Title => (RasterHeight::Size32, FontWeight::Bold),
        };
        // The base line is above the lower end of a raster by a fifth of its height.
        let top = pixel(y).saturating_sub(height.val() * 4 / 5);
        for (number, byte) in latin(text).enumerate() {
            let left = pixel(x + kind.advance() * number as f64);
            let raster = get_raster(byte.into(), weight, height);
            for (row, line) in raster.iter().flat_map(|raster| raster.rows().enumerate()) {
                for (column, opacity) in line.iter().enumerate() {
                    self.mix([left + column, top + row], colour, *opacity);
                }
            }
        }
    }

    fn picture(&mut self, at: [f64; 2], picture: &Picture) {
        let [left, top] = at.map(pixel);
        for (i, colour) in picture.bytes.as_chunks().0.iter().enumerate() {
            self.mix([left + i % picture.size[0], top + i / picture.size[0]], *colour, 255);
        }
    }
}

/// A sheet as a page of a PDF file, with the fonts that every reader of such files has.
pub(super) struct Page {
    pdf: Pdf,
    content: Content,
    pictures: Vec<Ref>,
}

/// The fonts: their names on the page, in the file, and as readers know them.
const FONTS: [(Name<'static>, Ref, Name<'static>); 2] =
    [(Name(b"F1"), Ref::new(4), Name(b"Courier")), (Name(b"F2"), Ref::new(5), Name(b"Courier-Bold"))];
const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(6);
const INFO: Ref = Ref::new(7);
const FIRST_PICTURE: i32 = 8;

impl Page {
    pub(super) fn new() -> Self {
        Self { pdf: Pdf::new(), content: Content::new(), pictures: Vec::new() }
    }

    /// Returns the file.
    pub(super) fn finish(mut self, title: &str) -> Vec<u8> {
        self.pdf.catalog(CATALOG).pages(PAGES);
        self.pdf.pages(PAGES).kids([PAGE]).count(1);
        let mut page = self.pdf.page(PAGE);
        page.media_box(Rect::new(0.0, 0.0, single(SIZE[0]), single(SIZE[1]))).parent(PAGES).contents(CONTENT);
        let mut resources = page.resources();
        let mut fonts = resources.fonts();
        for (name, font, _) in FONTS {
            fonts.pair(name, font);
        }
        fonts.finish();
        let mut objects = resources.x_objects();
        for (number, picture) in self.pictures.iter().enumerate() {
            objects.pair(Name(format!("P{number}").as_bytes()), *picture);
        }
        objects.finish();
        resources.finish();
        page.finish();
        for (_, font, base) in FONTS {
            self.pdf.type1_font(font).base_font(base).encoding_predefined(Name(b"WinAnsiEncoding"));
        }
        self.pdf.stream(CONTENT, &compress(&self.content.finish(), Compression::default())).filter(Filter::FlateDecode);
        self.pdf.document_info(INFO).title(TextStr(title));
        self.pdf.finish()
    }

    fn fill(&mut self, colour: [u8; 3]) {
        let [r, g, b] = colour.map(|x| f32::from(x) / 255.0);
        self.content.set_fill_rgb(r, g, b);
    }
}

/// Coordinates of a file are in f32.
#[allow(clippy::cast_possible_truncation, reason = "positions on a sheet")]
fn single(x: f64) -> f32 {
    x as f32
}

impl Canvas for Page {
    fn rect(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], colour: [u8; 3]) {
        self.fill(colour);
        self.content.rect(single(x), single(SIZE[1] - y - height), single(width), single(height)).fill_nonzero();
    }

    fn text(&mut self, [x, y]: [f64; 2], kind: Text, colour: [u8; 3], text: &str) {
        self.fill(colour);
        let (font, ..) = FONTS[usize::from(kind != Text::Body)];
        let text: Vec<u8> = latin(text).collect();
        self.content.begin_text().set_font(font, single(kind.advance() / 0.6));
        self.content.next_line(single(x), single(SIZE[1] - y)).show(Str(&text)).end_text();
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "at most the size of a sheet")]
    fn picture(&mut self, [x, y]: [f64; 2], picture: &Picture) {
        let id = Ref::new(FIRST_PICTURE + self.pictures.len() as i32);
        let bytes = compress(&picture.bytes, Compression::default());
        let mut object = self.pdf.image_xobject(id, &bytes);
        object.filter(Filter::FlateDecode);
        object.width(picture.size[0] as i32).height(picture.size[1] as i32);
        object.color_space().device_rgb();
        object.bits_per_component(8);
        object.finish();
        let [width, height] = picture.size.map(|x| single(x as f64 / PIXELS as f64));
        self.content.save_state().transform([width, 0.0, 0.0, height, single(x), single(SIZE[1] - y) - height]);
        self.content.x_object(Name(format!("P{}", self.pictures.len()).as_bytes())).restore_state();
        self.pictures.push(id);
    }
}
