//! Plots as SVG, in files or as text.

mod bars;

use crate::error::PlotError;
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fmt::Write;
use std::ops::Range;
use std::path::Path;

pub use bars::Bars;

/// How the points of a series are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Dots with a line through them.
    Line,
    /// A dashed line, for maxima beside means.
    Dashes,
    /// Dots without a line.
    Dot,
    /// Crosses, for cited figures.
    Cross,
}

/// A named series of points.
#[derive(Clone, Debug)]
pub struct Series {
    /// The name in the legend. A series without a name is not in the legend.
    pub name: String,
    /// The style of its points.
    pub mark: Mark,
    /// The number of its colour. A backend has the same colour in all plots.
    pub colour: usize,
    /// The points (x, y).
    pub points: Vec<(f64, f64)>,
    /// The notes that appear when the mouse rests on a point. There may be fewer notes than points.
    pub notes: Vec<String>,
}

/// A plot of series over one axis.
#[derive(Clone, Debug)]
pub struct Plot {
    /// The name of the x axis.
    pub x: &'static str,
    /// The name of the y axis.
    pub y: &'static str,
    /// Whether the x and the y axis are logarithmic.
    pub logarithmic: [bool; 2],
    /// The label of zeros on a logarithmic x axis, where they lie on a line of their own at its lower end. Without a
    /// label they are left out.
    pub zero: Option<&'static str>,
    /// The series that are drawn.
    pub series: Vec<Series>,
    /// The width and height in pixels.
    pub size: (u32, u32),
    /// The width of the legend at the right, in pixels. It is part of the width of the plot.
    pub legend: u32,
}

impl Default for Plot {
    fn default() -> Self {
        Self {
            x: "",
            y: "",
            logarithmic: [true, true],
            zero: None,
            series: Vec::new(),
            size: SIZE,
            legend: LEGEND_WIDTH,
        }
    }
}

/// The default width and height of plots, in pixels.
const SIZE: (u32, u32) = (860, 440);
/// The default width of the legend, in pixels.
const LEGEND_WIDTH: u32 = 150;
/// The height of a row of the legend, in pixels.
const LEGEND_ROW_HEIGHT: i32 = 20;
/// The font and its size in pixels.
const FONT: (&str, u32) = ("sans-serif", 14);
/// The end of an axis relative to its largest value.
const AXIS_END_FACTOR: f64 = 1.15;

/// Colours that most people with colour-vision deficiencies can distinguish as well \[Okabe2008\].
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(120, 120, 120),
];

fn colour(number: usize) -> RGBColor {
    COLOURS[number % COLOURS.len()]
}

/// Converts an error of the drawing library.
fn failed(error: impl std::fmt::Display) -> PlotError {
    PlotError::Draw(error.to_string())
}

impl Plot {
    /// Writes the plot. Points that a logarithmic axis cannot show are left out.
    ///
    /// # Errors
    /// [`PlotError`]
    pub fn write(&self, path: &Path) -> Result<(), PlotError> {
        std::fs::write(path, self.svg()?).map_err(|error| PlotError::Write { path: path.to_owned(), error })
    }

    /// Returns the plot as the text of an SVG file.
    ///
    /// # Errors
    /// [`PlotError::Empty`], and [`PlotError::Draw`].
    pub fn svg(&self) -> Result<String, PlotError> {
        let [x, y] = [0, 1].map(|axis| self.range(axis));
        let (x, y) = (x.ok_or(PlotError::Empty)?, y.ok_or(PlotError::Empty)?);
        match self.logarithmic {
            [true, true] => self.draw(x.log_scale(), y.log_scale()),
            [true, false] => self.draw(x.log_scale(), y),
            [false, true] => self.draw(x, y.log_scale()),
            [false, false] => self.draw(x, y),
        }
    }

    fn shown(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.series.iter().flat_map(|series| self.points(series).map(|(_, point)| point))
    }

    /// Returns the points that can be shown, with their indices in the series.
    fn points<'a>(&'a self, series: &'a Series) -> impl Iterator<Item = (usize, (f64, f64))> + 'a {
        let floor = self.floor();
        let fits = |value: f64, logarithmic: bool| value.is_finite() && (value > 0.0 || !logarithmic);
        let points = series
            .points
            .iter()
            .map(move |&(x, y)| (if x.abs() > 0.0 || x.is_nan() { x } else { floor.unwrap_or(x) }, y));
        points.enumerate().filter(move |(_, p)| fits(p.0, self.logarithmic[0]) && fits(p.1, self.logarithmic[1]))
    }

    /// Returns the position of zeros on the x axis: the power of ten below the decade of the least point.
    fn floor(&self) -> Option<f64> {
        let all = || self.series.iter().flat_map(|series| &series.points).map(|point| point.0);
        if self.zero.is_none() || !self.logarithmic[0] || all().all(|x| x.abs() > 0.0 || x.is_nan()) {
            return None;
        }
        let least = all().filter(|x| x.is_finite() && *x > 0.0).fold(f64::INFINITY, f64::min);
        Some(if least < f64::INFINITY { 10f64.powf(least.log10().floor() - 1.0) } else { 1.0 })
    }

    fn range(&self, axis: usize) -> Option<Range<f64>> {
        let values = || self.shown().map(move |p| [p.0, p.1][axis]);
        let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        if least > most {
            return None;
        }
        // The axis begins at a power of ten, because plotters has no ticks in an incomplete decade at the lower end.
        // Beyond the line of zeros it has half a decade more.
        let below = if axis == 0 && self.floor().is_some() { 0.5 } else { 0.999 };
        let decade = || below * 10f64.powf(least.log10().floor());
        Some(if self.logarithmic[axis] {
            decade()..most * AXIS_END_FACTOR
        } else {
            0.0..most.max(f64::MIN_POSITIVE) * AXIS_END_FACTOR
        })
    }

    fn draw<X, Y>(&self, x: X, y: Y) -> Result<String, PlotError>
    where
        X: AsRangedCoord<Value = f64, CoordDescType: ValueFormatter<f64> + Ranged<ValueType = f64>>,
        Y: AsRangedCoord<Value = f64, CoordDescType: ValueFormatter<f64> + Ranged<ValueType = f64>>,
    {
        let mut svg = String::new();
        let mut notes = String::new();
        let area = SVGBackend::with_string(&mut svg, self.size).into_drawing_area();
        area.fill(&WHITE).map_err(failed)?;
        let (left, names) = area.split_horizontally(self.size.0.saturating_sub(self.legend));
        let bottom = self.range(1).map_or(0.0, |range| range.start);
        let mut chart = ChartBuilder::on(&left)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(x, y)
            .map_err(failed)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .x_desc(self.x)
            .y_desc(self.y)
            .x_label_formatter(&|value| self.x_label(*value))
            .y_label_formatter(&|value| self.tick(1, *value))
            .label_style(FONT)
            .draw()
            .map_err(failed)?;
        if let Some(floor) = self.floor() {
            // The line reaches from end to end of the plot, whose ends are known in pixels only.
            let (from, to) = (chart.backend_coord(&(floor, bottom)), chart.plotting_area().get_y_axis_pixel_range());
            let line = PathElement::new(vec![(from.0, to.start), (from.0, to.end)], colour(7).stroke_width(1));
            area.draw(&line).map_err(failed)?;
        }
        for series in &self.series {
            let colour = colour(series.colour);
            let points: Vec<(f64, f64)> = self.points(series).map(|(_, point)| point).collect();
            let dots = points.iter().map(|p| Circle::new(*p, 3, colour.filled()));
            let drawn = match series.mark {
                Mark::Line => {
                    chart.draw_series(dots).map_err(failed)?;
                    chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))
                }
                Mark::Dashes => {
                    let line = points.iter().copied();
                    chart.draw_series(DashedLineSeries::new(line, 6, 4, colour.stroke_width(1)))
                }
                Mark::Dot => chart.draw_series(dots),
                Mark::Cross => chart.draw_series(points.iter().map(|p| Cross::new(*p, 6, colour.stroke_width(2)))),
            };
            drawn.map_err(failed)?;
            for (index, point) in self.points(series) {
                if let Some(note) = series.notes.get(index) {
                    let (x, y) = chart.backend_coord(&point);
                    // plotters has no titles, so an invisible circle with a title lies above the point.
                    let _ = writeln!(
                        notes,
                        "<circle cx=\"{x}\" cy=\"{y}\" r=\"7\" fill-opacity=\"0\"><title>{}</title></circle>",
                        escaped(note)
                    );
                }
            }
        }
        for (row, series) in (1..).zip(self.series.iter().filter(|series| !series.name.is_empty())) {
            let (colour, y) = (colour(series.colour), LEGEND_ROW_HEIGHT * row);
            let line = |width: u32| PathElement::new(vec![(4, y), (22, y)], colour.stroke_width(width)).into_dyn();
            let mark = match series.mark {
                Mark::Line => line(3),
                Mark::Dashes => line(1),
                Mark::Dot => Circle::new((13, y), 3, colour.filled()).into_dyn(),
                Mark::Cross => Cross::new((13, y), 5, colour.stroke_width(2)).into_dyn(),
            };
            names.draw(&mark).map_err(failed)?;
            names.draw(&legend_text(&series.name, y)).map_err(failed)?;
        }
        area.present().map_err(failed)?;
        drop((chart, names, left, area));
        let end = svg.rfind("</svg>").unwrap_or(svg.len());
        svg.insert_str(end, &notes);
        Ok(svg)
    }

    /// Returns the label of a tick; empty for ticks of a logarithmic axis that have no room for one.
    fn tick(&self, axis: usize, value: f64) -> String {
        if self.logarithmic[axis] && !is_round(value) { String::new() } else { label(value) }
    }

    /// Returns the label of a tick of the x axis.
    fn x_label(&self, value: f64) -> String {
        match (self.zero, self.floor()) {
            // Ticks are powers of ten up to rounding errors, so the tick of zeros is the only one below
            // twice its position.
            (Some(name), Some(floor)) if value < 2.0 * floor => name.to_owned(),
            _ => self.tick(0, value),
        }
    }
}

/// Returns whether a number begins with 1, 2 or 5. Other ticks of a logarithmic axis have no room for labels.
fn is_round(value: f64) -> bool {
    let digits = value / 10f64.powf(value.log10().floor());
    // Ticks have rounding errors, by which a logarithm may be below a whole number.
    [1.0, 2.0, 5.0, 10.0].iter().any(|round| (digits / round - 1.0).abs() < 0.01)
}

/// Escapes text for use between tags.
#[must_use]
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns the name of a series in its row of the legend.
fn legend_text(name: &str, y: i32) -> Text<'static, (i32, i32), String> {
    let style = FONT.into_text_style(&SIZE).pos(Pos::new(HPos::Left, VPos::Center));
    Text::new(name.to_owned(), (28, y), style)
}

/// Formats a number briefly, for an axis.
fn label(value: f64) -> String {
    let short = |x: f64, unit: &str| format!("{}{unit}", (x * 100.0).round() / 100.0);
    match value.abs() {
        x if x >= 1e9 => format!("{value:.0e}"),
        x if x >= 1e6 => short(value / 1e6, "M"),
        x if x >= 1e4 => short(value / 1e3, "k"),
        x if x >= 0.1 || x == 0.0 => short(value, ""),
        _ => format!("{value:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(logarithmic: [bool; 2]) -> Plot {
        let marks = [Mark::Line, Mark::Dashes, Mark::Dot, Mark::Cross];
        let series = marks.iter().enumerate().map(|(i, mark)| Series {
            name: format!("series {i}"),
            mark: *mark,
            colour: i,
            points: vec![(1.0, 2.0 + i as f64), (100.0, 30.0), (0.0, 1.0), (f64::NAN, 1.0)],
            notes: Vec::new(),
        });
        Plot { x: "faces", y: "seconds", logarithmic, series: series.collect(), ..Plot::default() }
    }

    #[test]
    fn plots_have_their_series_and_axes() {
        let folder = tempfile::tempdir().unwrap();
        for logarithmic in [[true, true], [true, false], [false, true], [false, false]] {
            let path = folder.path().join("plot.svg");
            plot(logarithmic).write(&path).unwrap();
            let text = std::fs::read_to_string(&path).unwrap();
            for word in ["<svg", "</svg>", "faces", "seconds", "series 0", "series 3"] {
                assert!(text.contains(word), "{word}");
            }
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
            // Three points of the two series with dots, two where zero cannot be shown, and the name of one.
            let shown = if logarithmic[0] { 2 } else { 3 };
            assert_eq!(text.matches("<circle").count(), 2 * shown + 1);
        }
        let nothing = Plot { series: Vec::new(), ..plot([true, true]) };
        assert!(nothing.write(&folder.path().join("nothing.svg")).is_err());
        assert!(plot([true, true]).write(&folder.path().join("no/plot.svg")).is_err());
    }

    #[test]
    fn zeros_lie_on_a_line_of_their_own_below_all_others() {
        let at = |zero| Plot { zero, ..plot([true, true]) };
        assert_eq!([at(None).floor(), at(Some("exact")).floor()], [None, Some(0.1)]);
        let svg = at(Some("exact")).svg().unwrap();
        assert!(svg.contains("exact"), "{svg}");
        // Nothing is left out but NaN, of the two series with dots; and the name of one.
        assert_eq!(svg.matches("<circle").count(), 2 * 3 + 1);
        let mut positive = at(Some("exact"));
        positive.series.iter_mut().for_each(|series| series.points.retain(|point| point.0 > 0.0));
        assert!(positive.floor().is_none() && !positive.svg().unwrap().contains("exact"));
        let mut zeros = at(Some("exact"));
        zeros.series.iter_mut().for_each(|series| series.points.retain(|point| point.0 == 0.0));
        assert_eq!(zeros.floor(), Some(1.0));
        assert!(zeros.svg().unwrap().contains("exact"));
    }

    #[test]
    fn some_ticks_of_a_decade_have_names() {
        let named: Vec<i32> = (1..=20).filter(|i| is_round(f64::from(*i) * 100.0)).collect();
        assert_eq!(named, [1, 2, 5, 10, 20]);
        assert!((-20..20).all(|i| is_round(10f64.powi(i))));
    }

    #[test]
    fn notes_are_at_their_points_and_escaped() {
        let mut plot = plot([true, true]);
        let svg = plot.svg().unwrap();
        // The last one is of a point that is not shown.
        plot.series[2].notes = ["a < b", "two", "three"].map(str::to_owned).to_vec();
        let noted = plot.svg().unwrap();
        assert_eq!(noted.matches("<title>").count(), 2);
        assert!(noted.contains("<title>a &lt; b</title>") && noted.trim_end().ends_with("</svg>"));
        // Each lies on the dot of its point.
        for circle in noted.split("<circle ").filter(|circle| circle.contains("<title>")) {
            let place = circle.split(" r=").next().unwrap();
            assert!(svg.contains(&format!("<circle {place} r=\"3\"")), "{place}");
        }
    }

    #[test]
    fn labels_are_short() {
        let shown = [0.0, 0.05, 0.5, 12.0, 1500.0, 25_000.0, 1_400_000.0, 1e15].map(label);
        assert_eq!(shown, ["0", "5e-2", "0.5", "12", "1500", "25k", "1.4M", "1e15"]);
    }
}
