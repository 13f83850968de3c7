//! Plots as SVG files.

use anyhow::{Context, Result, anyhow};
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;
use std::path::Path;

/// How the points of a series are drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    /// With a line through them.
    Line,
    /// With a broken line, for what is greatest where a mean is drawn with a line.
    Dashes,
    /// Alone.
    Dot,
    /// As crosses: cited.
    Cross,
}

/// Points of one name.
pub(super) struct Series {
    pub(super) name: String,
    pub(super) mark: Mark,
    /// Which colour, by number: the same contender has the same one in all plots.
    pub(super) colour: usize,
    pub(super) points: Vec<(f64, f64)>,
}

/// A plot of series over one axis.
pub(super) struct Plot {
    pub(super) x: &'static str,
    pub(super) y: &'static str,
    /// Whether an axis is logarithmic.
    pub(super) logarithmic: [bool; 2],
    pub(super) series: Vec<Series>,
}

const SIZE: (u32, u32) = (860, 440);
/// Room for names at the right, and for each of them.
const LEGEND: u32 = 150;
const ROW: i32 = 20;
const FONT: (&str, u32) = ("sans-serif", 14);
/// Room above the highest point.
const ROOM: f64 = 1.15;

/// Distinct for most people who see colours otherwise, too \[Okabe2008\].
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
    pub(super) fn write(&self, path: &Path) -> Result<()> {
        let [x, y] = [0, 1].map(|axis| self.range(axis));
        let (x, y) = (x.context("a plot without points")?, y.context("a plot without points")?);
        match self.logarithmic {
            [true, true] => self.draw(path, x.log_scale(), y.log_scale()),
            [true, false] => self.draw(path, x.log_scale(), y),
            [false, true] => self.draw(path, x, y.log_scale()),
            [false, false] => self.draw(path, x, y),
        }
    }

    fn shown(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.series.iter().flat_map(|series| self.points(series))
    }

    fn points<'a>(&'a self, series: &'a Series) -> impl Iterator<Item = (f64, f64)> + 'a {
        let fits = |value: f64, logarithmic: bool| value.is_finite() && (value > 0.0 || !logarithmic);
        series.points.iter().copied().filter(move |p| fits(p.0, self.logarithmic[0]) && fits(p.1, self.logarithmic[1]))
    }

    fn range(&self, axis: usize) -> Option<Range<f64>> {
        let values = || self.shown().map(move |p| [p.0, p.1][axis]);
        let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        if least > most {
            return None;
        }
        // From a power of ten: plotters has no ticks in a part of a decade at the lower end.
        let decade = || 0.999 * 10f64.powf(least.log10().floor());
        Some(if self.logarithmic[axis] { decade()..most * ROOM } else { 0.0..most.max(f64::MIN_POSITIVE) * ROOM })
    }

    fn draw<X, Y>(&self, path: &Path, x: X, y: Y) -> Result<()>
    where
        X: AsRangedCoord<Value = f64, CoordDescType: ValueFormatter<f64> + Ranged<ValueType = f64>>,
        Y: AsRangedCoord<Value = f64, CoordDescType: ValueFormatter<f64> + Ranged<ValueType = f64>>,
    {
        let failed = |error: &dyn std::fmt::Display| anyhow!("{}: {error}", path.display());
        let area = SVGBackend::new(path, SIZE).into_drawing_area();
        area.fill(&WHITE).map_err(|e| failed(&e))?;
        let (left, names) = area.split_horizontally(SIZE.0 - LEGEND);
        let mut chart = ChartBuilder::on(&left)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(x, y)
            .map_err(|e| failed(&e))?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .x_desc(self.x)
            .y_desc(self.y)
            .x_label_formatter(&|value| label(*value))
            .y_label_formatter(&|value| label(*value))
            .label_style(FONT)
            .draw()
            .map_err(|e| failed(&e))?;
        for series in &self.series {
            let colour = colour(series.colour);
            let points: Vec<(f64, f64)> = self.points(series).collect();
            let dots = points.iter().map(|p| Circle::new(*p, 3, colour.filled()));
            let drawn = match series.mark {
                Mark::Line => {
                    chart.draw_series(dots).map_err(|e| failed(&e))?;
                    chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))
                }
                Mark::Dashes => {
                    let line = points.iter().copied();
                    chart.draw_series(DashedLineSeries::new(line, 6, 4, colour.stroke_width(1)))
                }
                Mark::Dot => chart.draw_series(dots),
                Mark::Cross => chart.draw_series(points.iter().map(|p| Cross::new(*p, 6, colour.stroke_width(2)))),
            };
            drawn.map_err(|e| failed(&e))?;
        }
        for (row, series) in (1..).zip(&self.series) {
            let (colour, y) = (colour(series.colour), ROW * row);
            let line = |width: u32| PathElement::new(vec![(4, y), (22, y)], colour.stroke_width(width)).into_dyn();
            let mark = match series.mark {
                Mark::Line => line(3),
                Mark::Dashes => line(1),
                Mark::Dot => Circle::new((13, y), 3, colour.filled()).into_dyn(),
                Mark::Cross => Cross::new((13, y), 5, colour.stroke_width(2)).into_dyn(),
            };
            names.draw(&mark).map_err(|e| failed(&e))?;
            names.draw(&name_at(&series.name, y)).map_err(|e| failed(&e))?;
        }
        area.present().map_err(|e| failed(&e))
    }
}

/// The name of a series in its row.
fn name_at(name: &str, y: i32) -> Text<'static, (i32, i32), String> {
    let style = FONT.into_text_style(&SIZE).pos(Pos::new(HPos::Left, VPos::Center));
    Text::new(name.to_owned(), (28, y), style)
}

/// Bars of parts, one below the other, all with the same unit.
pub(super) struct Bars {
    pub(super) x: &'static str,
    /// What the parts are called.
    pub(super) parts: Vec<&'static str>,
    /// A bar's name and the sizes of its parts.
    pub(super) bars: Vec<(String, Vec<f64>)>,
}

impl Bars {
    /// Writes the picture.
    pub(super) fn write(&self, path: &Path) -> Result<()> {
        let failed = |error: &dyn std::fmt::Display| anyhow!("{}: {error}", path.display());
        let most = self.bars.iter().map(|bar| bar.1.iter().sum::<f64>()).fold(f64::MIN_POSITIVE, f64::max);
        let count = self.bars.len();
        let area = SVGBackend::new(path, (SIZE.0, 90 + 34 * u32::try_from(count)?)).into_drawing_area();
        area.fill(&WHITE).map_err(|e| failed(&e))?;
        let (left, names) = area.split_horizontally(SIZE.0 - LEGEND);
        let mut chart = ChartBuilder::on(&left)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(190)
            .build_cartesian_2d(0.0..most * 1.05, (0..count.saturating_sub(1)).into_segmented())
            .map_err(|e| failed(&e))?;
        let name = |at: &SegmentValue<usize>| match at {
            // From below.
            SegmentValue::CenterOf(i) => self.bars.iter().rev().nth(*i).map_or(String::new(), |bar| bar.0.clone()),
            _ => String::new(),
        };
        chart
            .configure_mesh()
            .disable_y_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .x_desc(self.x)
            .y_labels(count)
            .y_label_formatter(&name)
            .x_label_formatter(&|value| label(*value))
            .label_style(FONT)
            .draw()
            .map_err(|e| failed(&e))?;
        for part in 0..self.parts.len() {
            let colour = colour(part);
            let boxes = self.bars.iter().enumerate().map(|(i, (_, sizes))| {
                let from: f64 = sizes[..part].iter().sum();
                let row = count - 1 - i;
                let end = if i == 0 { SegmentValue::Last } else { SegmentValue::Exact(row + 1) };
                let ends = [(from, SegmentValue::Exact(row)), (from + sizes[part], end)];
                let mut bar = Rectangle::new(ends, colour.filled());
                bar.set_margin(6, 6, 0, 0);
                bar
            });
            chart.draw_series(boxes).map_err(|e| failed(&e))?;
        }
        for ((part, name), row) in self.parts.iter().enumerate().zip(1..) {
            let y = ROW * row;
            let mark = Rectangle::new([(6, y - 5), (18, y + 5)], colour(part).filled());
            names.draw(&mark).map_err(|e| failed(&e))?;
            names.draw(&name_at(name, y)).map_err(|e| failed(&e))?;
        }
        area.present().map_err(|e| failed(&e))
    }
}

/// A number at an axis, short.
fn label(value: f64) -> String {
    let short = |x: f64, unit: &str| format!("{}{unit}", (x * 100.0).round() / 100.0);
    match value.abs() {
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
        });
        Plot { x: "faces", y: "seconds", logarithmic, series: series.collect() }
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
    fn bars_have_names_and_parts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bars.svg");
        let bars = vec![("camel".to_owned(), vec![1.0, 2.0]), ("lucy".to_owned(), vec![3.0, 0.5])];
        Bars { x: "ns", parts: vec!["locate", "list"], bars }.write(&path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        for word in ["camel", "lucy", "locate", "list"] {
            assert!(text.contains(word), "{word}: {text}");
        }
        // Bars of each part, as wide as their numbers.
        let widths = |part: usize| -> Vec<f64> {
            let RGBColor(r, g, b) = colour(part);
            let filled = format!("fill=\"#{r:02X}{g:02X}{b:02X}\"");
            let bars = text.split("<rect").filter(|rect| rect.contains(&filled));
            let width = |rect: &str| rect.split("width=\"").nth(1).and_then(|w| w.split('"').next()?.parse().ok());
            bars.filter_map(width).collect()
        };
        let (first, second) = (widths(0), widths(1));
        assert_eq!((first.len(), second.len()), (3, 3), "two bars and a name: {text}");
        assert!((second[0] / first[0] - 2.0).abs() < 0.02 && (first[1] / first[0] - 3.0).abs() < 0.03, "{first:?}");
        assert!((first[1] / second[1] - 6.0).abs() < 0.1, "{second:?}");
    }

    #[test]
    fn labels_are_short() {
        let shown = [0.0, 0.05, 0.5, 12.0, 1500.0, 25_000.0, 1_400_000.0].map(label);
        assert_eq!(shown, ["0", "5e-2", "0.5", "12", "1500", "25k", "1.4M"]);
    }
}
