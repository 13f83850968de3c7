//! Plots as SVG files.

mod bars;

use anyhow::{Context, Result, bail};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;
use std::path::Path;

pub(crate) use bars::Bars;

/// How the points of a series are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
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
pub(crate) struct Series {
    /// The name in the legend. A series without a name is not in the legend.
    pub(crate) name: String,
    /// The style of its points.
    pub(crate) mark: Mark,
    /// The number of its colour. A backend has the same colour in all plots.
    pub(crate) colour: usize,
    /// The points (x, y).
    pub(crate) points: Vec<(f64, f64)>,
}

/// A plot of series over two logarithmic axes.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    /// The name of the x axis.
    pub(crate) x: &'static str,
    /// The name of the y axis.
    pub(crate) y: &'static str,
    /// The series that are drawn.
    pub(crate) series: Vec<Series>,
}

/// The width and height of plots, in pixels.
const SIZE: (u32, u32) = (860, 440);
/// The width of the legend at the right, in pixels. It is part of the width of the plot.
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

impl Plot {
    /// Writes the plot. Points that a logarithmic axis cannot show are left out.
    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        std::fs::write(path, self.svg()?).with_context(|| path.display().to_string())
    }

    /// Returns the plot as the text of an SVG file.
    fn svg(&self) -> Result<String> {
        let ranges = [0, 1].map(|axis| self.range(axis));
        let (Some(x), Some(y)) = (&ranges[0], &ranges[1]) else { bail!("a plot without points") };
        let mut svg = String::new();
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let (left, names) = area.split_horizontally(SIZE.0 - LEGEND_WIDTH);
        let mut chart = ChartBuilder::on(&left)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(x.clone().log_scale(), y.clone().log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .x_desc(self.x)
            .y_desc(self.y)
            .x_label_formatter(&|value| tick(*value))
            .y_label_formatter(&|value| tick(*value))
            .label_style(FONT)
            .draw()?;
        for series in &self.series {
            let colour = colour(series.colour);
            let points: Vec<(f64, f64)> = shown(series).collect();
            let dots = points.iter().map(|p| Circle::new(*p, 3, colour.filled()));
            let drawn = match series.mark {
                Mark::Line => {
                    chart.draw_series(dots)?;
                    chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))
                }
                Mark::Dashes => {
                    let line = points.iter().copied();
                    chart.draw_series(DashedLineSeries::new(line, 6, 4, colour.stroke_width(1)))
                }
                Mark::Dot => chart.draw_series(dots),
                Mark::Cross => chart.draw_series(points.iter().map(|p| Cross::new(*p, 6, colour.stroke_width(2)))),
            };
            drawn?;
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
            names.draw(&mark)?;
            names.draw(&legend_text(&series.name, y))?;
        }
        area.present()?;
        drop((chart, names, left, area));
        Ok(svg)
    }

    /// Returns the range of an axis, or `None` if no point can be shown.
    fn range(&self, axis: usize) -> Option<Range<f64>> {
        let values = || self.series.iter().flat_map(shown).map(|p| [p.0, p.1][axis]);
        let (least, most) = (values().reduce(f64::min)?, values().reduce(f64::max)?);
        // The axis begins at a power of ten, because plotters has no ticks in an incomplete decade at the lower end.
        Some(0.999 * 10f64.powf(least.log10().floor())..most * AXIS_END_FACTOR)
    }
}

/// Returns the points that logarithmic axes can show.
fn shown(series: &Series) -> impl Iterator<Item = (f64, f64)> + '_ {
    let fits = |value: f64| value.is_finite() && value > 0.0;
    series.points.iter().copied().filter(move |p| fits(p.0) && fits(p.1))
}

/// Returns the label of a tick, which is empty where there is no room for one.
fn tick(value: f64) -> String {
    if is_round(value) { label(value) } else { String::new() }
}

/// Returns whether a number begins with 1, 2 or 5. Other ticks of a logarithmic axis have no room for labels.
fn is_round(value: f64) -> bool {
    let digits = value / 10f64.powf(value.log10().floor());
    // Ticks have rounding errors, by which a logarithm may be below a whole number.
    [1.0, 2.0, 5.0, 10.0].iter().any(|round| (digits / round - 1.0).abs() < 0.01)
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

    #[test]
    fn plots_have_their_series_and_axes() {
        let marks = [Mark::Line, Mark::Dashes, Mark::Dot, Mark::Cross];
        let series = marks.iter().enumerate().map(|(i, mark)| Series {
            name: format!("series {i}"),
            mark: *mark,
            colour: i,
            points: vec![(1.0, 2.0 + i as f64), (100.0, 30.0), (0.0, 1.0), (f64::NAN, 1.0)],
        });
        let plot = Plot { x: "faces", y: "seconds", series: series.collect() };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plot.svg");
        plot.write(&path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        for word in ["<svg", "</svg>", "faces", "seconds", "series 0", "series 3"] {
            assert!(text.contains(word), "{word}");
        }
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        // Two points of the two series with dots, and the name of one.
        assert_eq!(text.matches("<circle").count(), 2 * 2 + 1);
        let nothing = Plot { series: Vec::new(), ..plot.clone() };
        assert!(nothing.write(&folder.path().join("nothing.svg")).is_err());
        assert!(plot.write(&folder.path().join("no/plot.svg")).is_err());
    }

    #[test]
    fn some_ticks_of_a_decade_have_names() {
        let named: Vec<i32> = (1..=20).filter(|i| is_round(f64::from(*i) * 100.0)).collect();
        assert_eq!(named, [1, 2, 5, 10, 20]);
        assert!((-20..20).all(|i| is_round(10f64.powi(i))));
    }

    #[test]
    fn labels_are_short() {
        let shown = [0.0, 0.05, 0.5, 12.0, 1500.0, 25_000.0, 1_400_000.0, 1e15].map(label);
        assert_eq!(shown, ["0", "5e-2", "0.5", "12", "1500", "25k", "1.4M", "1e15"]);
    }
}
