//! Stacked bars.

use super::{FONT, LEGEND_ROW_HEIGHT, LEGEND_WIDTH, SIZE, colour, label, legend_text};
use anyhow::{Context, Result};
use plotters::prelude::*;
use std::path::Path;

/// Horizontal stacked bars, one below the other, all in the same unit.
#[derive(Clone, Debug)]
pub(crate) struct Bars {
    /// The name of the axis.
    pub(crate) x: &'static str,
    /// The names of the parts.
    pub(crate) parts: Vec<&'static str>,
    /// The names of the bars, and the sizes of their parts.
    pub(crate) bars: Vec<(String, Vec<f64>)>,
}

impl Bars {
    /// Writes the picture. It panics if a bar has fewer parts than there are names.
    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        std::fs::write(path, self.svg()?).with_context(|| path.display().to_string())
    }

    /// Returns the picture as the text of an SVG file.
    fn svg(&self) -> Result<String> {
        let most = self.bars.iter().map(|bar| bar.1.iter().sum::<f64>()).fold(f64::MIN_POSITIVE, f64::max);
        let count = self.bars.len();
        let mut svg = String::new();
        let area = SVGBackend::with_string(&mut svg, (SIZE.0, 90 + 34 * u32::try_from(count)?)).into_drawing_area();
        area.fill(&WHITE)?;
        let (left, names) = area.split_horizontally(SIZE.0 - LEGEND_WIDTH);
        let mut chart = ChartBuilder::on(&left)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(190)
            .build_cartesian_2d(0.0..most * 1.05, (0..count.saturating_sub(1)).into_segmented())?;
        let name = |at: &SegmentValue<usize>| match at {
            // The axis runs upwards, and bars are listed downwards.
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
            .draw()?;
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
            chart.draw_series(boxes)?;
        }
        for ((part, name), row) in self.parts.iter().enumerate().zip(1..) {
            let y = LEGEND_ROW_HEIGHT * row;
            let mark = Rectangle::new([(6, y - 5), (18, y + 5)], colour(part).filled());
            names.draw(&mark)?;
            names.draw(&legend_text(name, y))?;
        }
        area.present()?;
        drop((chart, names, left, area));
        Ok(svg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
