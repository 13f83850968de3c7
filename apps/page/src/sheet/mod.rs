//! The report of a comparison on one sheet of paper, as a PNG or a PDF file.

mod canvas;
mod picture;

use crate::{Deviations, ObjectDeviations, UpAxis, band_colour, diverging_colour};
use canvas::{Canvas, PIXELS, Page, Pixels, SIZE, Text};
use nalgebra::Vector3;
use p2m_field::deviation::{DeviationStatistics, bands, histogram};
use p2m_mixed::Scene;
use p2m_mixed::statistics::figure::{Count, Figure};
use picture::{Drawing, Picture};

/// The margin around a sheet, and the distance of its parts, in points.
const MARGIN: f64 = 36.0;
const GAP: f64 = 14.0;
/// The distance of lines of text.
const LINE: f64 = 12.5;
const WIDTH: f64 = SIZE[0] - 2.0 * MARGIN;
/// The height of the histogram, and the number of its bins between the limits.
const HISTOGRAM: f64 = 90.0;
const BINS: usize = 60;

const INK: [u8; 3] = [0x1c, 0x23, 0x2b];
const GREY: [u8; 3] = [0x5b, 0x66, 0x73];
const RULE: [u8; 3] = [0xc9, 0xd0, 0xd8];
const BACKGROUND: [u8; 3] = [0xf7, 0xf8, 0xfa];
const UNCOLOURED: [u8; 3] = [0xc0, 0xc6, 0xce];
const PASS: [u8; 3] = [0x1d, 0x7a, 0x36];
const FAIL: [u8; 3] = [0xb3, 0x1b, 0x1b];

/// A report on one sheet: its head, the verdict, the scan on the part from two sides, a histogram, and statistics.
///
/// Text is in Latin-1; other characters are question marks.
#[derive(Debug)]
pub struct Sheet<'a> {
    /// The heading.
    pub title: &'a str,
    /// Lines below the heading, such as the date, with their names.
    pub head: &'a [(String, String)],
    /// The percentage of points within the tolerance that decides whether the scan passes, if that is asked.
    pub required: Option<f64>,
    /// The name of the unit of length.
    pub unit: &'a str,
    /// The axis that points up in the pictures.
    pub up: UpAxis,
    /// The part.
    pub scene: &'a Scene,
    /// The deviations. If the scan has triangles, these are drawn and the part is not.
    pub deviations: Deviations<'a>,
    /// The command and the versions that made the sheet.
    pub about: &'a str,
}

impl Sheet<'_> {
    /// Returns the sheet as a PNG file of 1190 x 1684 pixels.
    ///
    /// # Errors
    /// Errors of the encoder, which do not occur.
    pub fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut pixels = Pixels::new();
        self.draw(&mut pixels);
        pixels.finish()
    }

    /// Returns the sheet as a PDF file of one page of A4.
    #[must_use]
    pub fn pdf(&self) -> Vec<u8> {
        let mut page = Page::new();
        self.draw(&mut page);
        page.finish(self.title)
    }

    fn draw(&self, canvas: &mut impl Canvas) {
        let mut y = MARGIN + 14.0;
        let fits = self.title.chars().count() as f64 * Text::Title.advance() <= WIDTH;
        let kind = if fits { Text::Title } else { Text::Bold };
        canvas.text([MARGIN, y], kind, INK, &clipped(self.title, kind, WIDTH));
        let names = self.head.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
        for (name, value) in self.head {
            y += LINE + 1.0;
            let line = format!("{name:names$}  {value}");
            canvas.text([MARGIN, y], Text::Body, INK, &clipped(&line, Text::Body, WIDTH));
        }
        y += GAP;
        let verdict = self.deviations.verdict(self.required, self.unit);
        let colour = verdict.as_ref().and_then(|v| v.passes).map_or(GREY, |passes| if passes { PASS } else { FAIL });
        canvas.rect([MARGIN, y], [WIDTH, 26.0], colour);
        let line = match &verdict {
            Some(verdict) => [verdict.word().unwrap_or_default(), &verdict.sentence.replace("+-", "\u{b1}")].join("  "),
            None => self.deviations.summary(self.unit),
        };
        let line = clipped(line.trim_start(), Text::Bold, WIDTH - 16.0);
        canvas.text([MARGIN + 8.0, y + 17.0], Text::Bold, [255; 3], &line);
        y += 26.0 + GAP;
        let side = (WIDTH - GAP) / 2.0;
        for (number, front) in [1.0, -1.0].into_iter().enumerate() {
            canvas.picture([MARGIN + number as f64 * (side + GAP), y], &self.picture(side, front));
        }
        y += side + GAP;
        self.draw_histogram(canvas, y);
        y += HISTOGRAM + 2.0 * LINE + GAP;
        let end = self.draw_statistics(canvas, y);
        self.draw_objects(canvas, end + GAP);
        canvas.text([MARGIN, SIZE[1] - MARGIN], Text::Body, GREY, &clipped(self.about, Text::Body, WIDTH));
    }

    /// Returns the colour of a deviation.
    fn colour(&self, value: f64) -> [u8; 3] {
        let Deviations { tolerance, limit, .. } = self.deviations;
        match tolerance.filter(|tolerance| *tolerance > 0.0) {
            _ if value.is_nan() => UNCOLOURED,
            Some(tolerance) => band_colour(value, tolerance, limit),
            None => diverging_colour(value, limit),
        }
    }

    /// Draws the scan and the part from above a corner: the front one for 1, and the opposite one for -1.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the size of a picture")]
    fn picture(&self, side: f64, front: f64) -> Picture {
        let Deviations { scan, values, .. } = self.deviations;
        let (right, away, up) = match self.up {
            UpAxis::Z => (Vector3::x(), Vector3::y(), Vector3::z()),
            UpAxis::Y => (Vector3::x(), -Vector3::z(), Vector3::y()),
        };
        let towards = ((right * 0.6 - away) * front + up * 0.6).normalize();
        let across = up.cross(&towards).normalize();
        let axes = [across, towards.cross(&across), towards];
        let pixels = (side * PIXELS as f64) as usize;
        let points = || scan.positions().iter().chain(self.scene.soup.positions());
        let mut drawing = Drawing::new([pixels; 2], BACKGROUND, points(), axes);
        if scan.triangles().is_empty() {
            drawing.triangles(&self.scene.soup, |_, _| UNCOLOURED);
            if self.scene.soup.triangles().is_empty() {
                drawing.points(self.scene.soup.positions(), 1.0, |_| UNCOLOURED);
            }
            // Points of an even scan nearly touch.
            let size = (1.2 * pixels as f64 / (scan.positions().len() as f64).sqrt()).clamp(1.0, 6.0);
            drawing.points(scan.positions(), size, |i| self.colour(values[i]));
        } else {
            drawing.triangles(scan, |triangle, weights| {
                self.colour((0..3).map(|k| weights[k] * values[triangle[k] as usize]).sum())
            });
        }
        drawing.finish()
    }

    fn draw_histogram(&self, canvas: &mut impl Canvas, y: f64) {
        let Deviations { values, is_signed, limit, tolerance, .. } = self.deviations;
        let low = if is_signed { -limit } else { 0.0 };
        let all = histogram(values, low, limit, BINS);
        let highest = all.iter().map(|bin| bin.count).max().unwrap_or(0).max(1) as f64;
        let width = WIDTH / all.len() as f64;
        for (number, bin) in all.iter().enumerate() {
            let height = HISTOGRAM * bin.count as f64 / highest;
            if bin.count > 0 {
                let middle = match number {
                    0 => f64::MIN,
                    number if number == BINS + 1 => f64::MAX,
                    _ => 0.5 * (bin.low + bin.high),
                };
                let at = [MARGIN + width * number as f64, y + HISTOGRAM - height];
                canvas.rect(at, [width - 0.5, height], self.colour(middle));
            }
        }
        canvas.rect([MARGIN, y + HISTOGRAM], [WIDTH, 0.5], INK);
        // The first bin is left of the low limit.
        let place = |value: f64| MARGIN + width * (1.0 + (value - low) / (limit - low) * BINS as f64);
        let tolerance = tolerance.filter(|tolerance| *tolerance > 0.0 && *tolerance < limit);
        let tolerances = tolerance.into_iter().flat_map(|t| if is_signed { vec![-t, t] } else { vec![t] });
        let marks = tolerances.map(|value| (value, true)).chain([(low, false), (0.0, false), (limit, false)]);
        let mut last: Vec<f64> = Vec::new();
        for (value, is_line) in marks {
            let x = place(value);
            canvas.rect(
                [x, y + if is_line { 0.0 } else { HISTOGRAM }],
                [0.5, HISTOGRAM * f64::from(u8::from(is_line)) + 3.0],
                INK,
            );
            let text = Figure(value).to_string();
            let half = 0.5 * Text::Body.advance() * text.len() as f64;
            // A label that would cover another one is left out.
            if last.iter().all(|other| (other - x).abs() > 2.0 * half + 8.0) {
                let left = (x - half).clamp(MARGIN, MARGIN + WIDTH - 2.0 * half);
                canvas.text([left, y + HISTOGRAM + LINE], Text::Body, INK, &text);
                last.push(x);
            }
        }
        let note = format!("deviation in {}; the outer bars count what is beyond", self.unit);
        let what = if is_signed { note } else { note.replacen("deviation", "distance", 1) };
        canvas.text([MARGIN, y + HISTOGRAM + 2.0 * LINE], Text::Body, GREY, &what);
    }

    /// Draws two columns, of statistics and of bands, and returns where they end.
    fn draw_statistics(&self, canvas: &mut impl Canvas, y: f64) -> f64 {
        let Deviations { statistics, values, tolerance, limit, is_signed, .. } = self.deviations;
        let of_interest = ["mean", "rms", "standard_deviation", "min", "max", "absolute_percentile_95"];
        let mut left = vec![("points".to_owned(), Count(statistics.count as u64).to_string())];
        if statistics.missing > 0 {
            left.push(("without a deviation".to_owned(), Count(statistics.missing as u64).to_string()));
        }
        let named = statistics.named().into_iter().filter(|named| of_interest.contains(&named.key.as_str()));
        left.extend(named.map(|named| (named.label, format!("{} {}", Figure(named.value), self.unit))));
        let mut right = Vec::new();
        if let Some(tolerance) = tolerance {
            let [t, l] = [tolerance, limit.max(tolerance)].map(Figure);
            let counts = bands(values, tolerance, limit);
            let (near, far) = (0.5 * (limit + tolerance), 2.0 * limit + tolerance);
            let bands = [
                (format!("below -{l}"), -far),
                (format!("-{l} to -{t}"), -near),
                (format!("within {t}"), 0.0),
                (format!("{t} to {l}"), near),
                (format!("above {l}"), far),
            ];
            for ((label, middle), count) in bands.into_iter().zip(counts).skip(if is_signed { 0 } else { 2 }).rev() {
                let percent = Figure(100.0 * count as f64 / statistics.count.max(1) as f64);
                let text = format!("{} ({percent} %)", Count(count as u64));
                right.push((label, text, self.colour(middle)));
            }
        }
        let middle = MARGIN + WIDTH * 0.52;
        for (number, (label, value)) in left.iter().enumerate() {
            let y = y + LINE * (number + 1) as f64;
            let line = format!("{label:34} {value}");
            canvas.text([MARGIN, y], Text::Body, INK, &clipped(&line, Text::Body, WIDTH * 0.5));
        }
        for (number, (label, value, colour)) in right.iter().enumerate() {
            let y = y + LINE * (number + 1) as f64;
            canvas.rect([middle, y - 7.0], [8.0, 8.0], *colour);
            let line = format!("{label:22} {value}");
            canvas.text([middle + 13.0, y], Text::Body, INK, &clipped(&line, Text::Body, WIDTH * 0.46));
        }
        y + LINE * left.len().max(right.len()) as f64
    }

    /// Draws the table of objects, as many as fit.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of lines")]
    fn draw_objects(&self, canvas: &mut impl Canvas, y: f64) {
        let lines = ((SIZE[1] - MARGIN - GAP - y) / LINE).max(0.0) as usize;
        let objects = ObjectDeviations::of_scene(self.scene, &self.deviations);
        if objects.is_empty() || lines < 3 {
            return;
        }
        canvas.rect([MARGIN, y - 2.0], [WIDTH, 0.5], RULE);
        let outside = if self.deviations.tolerance.is_some() { "outside" } else { "" };
        let head =
            format!("{:30} {:>10} {:>10} {:>10} {:>10} {:>10}", "object", "points", "mean", "rms", "largest", outside);
        canvas.text([MARGIN, y + LINE], Text::Bold, INK, &head);
        let shown = if objects.len() + 1 > lines { lines - 2 } else { objects.len() };
        for (number, object) in objects[..shown].iter().enumerate() {
            let DeviationStatistics { count, mean, rms, min, max, .. } = object.statistics;
            let name = if object.name.is_empty() { "(without a name)" } else { &object.name };
            let name = clipped(name, Text::Body, 30.0 * Text::Body.advance());
            let largest = if max.abs() >= min.abs() { max } else { min };
            let [mean, rms, largest] = [mean, rms, largest].map(|x| Figure(x).to_string());
            let outside = object
                .outside
                .map(|outside| Count((outside.above + outside.below) as u64).to_string())
                .unwrap_or_default();
            let line = format!(
                "{name:30} {:>10} {mean:>10} {rms:>10} {largest:>10} {outside:>10}",
                Count(count as u64).to_string()
            );
            canvas.text([MARGIN, y + LINE * (number + 2) as f64], Text::Body, INK, &line);
        }
        if shown < objects.len() {
            let more = format!("and {} more", objects.len() - shown);
            canvas.text([MARGIN, y + LINE * (shown + 2) as f64], Text::Body, GREY, &more);
        }
    }
}

/// Returns the beginning of a text that fits into a width, with dots if that is not all of it.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of characters")]
fn clipped(text: &str, kind: Text, width: f64) -> String {
    let most = (width / kind.advance() + 1e-6) as usize;
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(2)).chain("..".chars()).collect()
}
