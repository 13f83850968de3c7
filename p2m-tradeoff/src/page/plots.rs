//! The plots of a set of queries.

use crate::break_even::default_costs;
use crate::curve::{Curve, Point, SetFigures};
use crate::errors::ErrorQuantiles;
use crate::plot::{Mark, Plot, Series};
use crate::text::{count, error};

/// The width and height of a plot in pixels. Two stand side by side.
pub(super) const SIZE: (u32, u32) = (640, 400);
/// The width of the legend, in pixels.
pub(super) const LEGEND_WIDTH: u32 = 110;

/// Curves that are slower than the fastest one by more than this factor are not drawn, because they would
/// compress the others.
const MAX_DRAWN_TIME_FACTOR: f64 = 30.0;

/// Returns the curves that are drawn, and the names of the others.
pub(super) fn drawn(set: &SetFigures) -> (Vec<&Curve>, Vec<&str>) {
    let nanoseconds = |curve: &Curve| curve.usual().map_or(f64::INFINITY, |default| default.nanoseconds.median);
    let least = set.curves.iter().map(nanoseconds).fold(f64::INFINITY, f64::min);
    let (near, far): (Vec<_>, Vec<_>) =
        set.curves.iter().partition(|curve| nanoseconds(curve) <= MAX_DRAWN_TIME_FACTOR * least);
    (near, far.into_iter().map(|curve| curve.name.as_str()).collect())
}

/// The unit of errors.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Unit {
    /// The unit u M.
    Scaled,
    /// The true distance.
    Relative,
}

/// The names of backends in the order of their colours, which are the same in all plots.
pub(super) struct Colours(pub(super) Vec<String>);

impl Colours {
    fn of(&self, name: &str) -> usize {
        self.0.iter().position(|known| known == name).unwrap_or(self.0.len())
    }

    /// Makes a line with the colour of this backend.
    pub(super) fn line(&self, name: &str, points: Vec<(f64, f64)>) -> Series {
        Series { name: name.to_owned(), mark: Mark::Line, colour: self.of(name), points, notes: Vec::new() }
    }
}

/// The rank of a setting among those of its backend.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Dominance {
    /// The setting is faster than all more accurate ones: it is on the Pareto front.
    Front,
    /// A more accurate setting is as fast.
    Dominated,
}

impl Dominance {
    const ALL: [Self; 2] = [Self::Front, Self::Dominated];

    /// Classifies points that come in order of increasing error. `least` is the least time of all points so far.
    fn classify(point: &Point, least: &mut f64) -> Self {
        if point.nanoseconds.median < *least {
            *least = point.nanoseconds.median;
            Self::Front
        } else {
            Self::Dominated
        }
    }

    fn mark(self) -> Mark {
        match self {
            Self::Front => Mark::Line,
            Self::Dominated => Mark::Dot,
        }
    }
}

/// Plots speed over error, with a point for each setting.
pub(super) fn pareto(set: &SetFigures, colours: &Colours, unit: Unit, of: fn(&ErrorQuantiles) -> f64) -> Plot {
    let x = match unit {
        Unit::Scaled => "error, in u M",
        Unit::Relative => "error, relative to the distance",
    };
    let worst = |point: &Point| match unit {
        Unit::Scaled => of(&point.errors.scaled),
        Unit::Relative => of(&point.errors.relative),
    };
    let series = |curve: &Curve, dominance: Dominance| {
        let mut points: Vec<&Point> = curve.points.iter().collect();
        points.sort_by(|a, b| worst(a).total_cmp(&worst(b)));
        let mut least = f64::INFINITY;
        points.retain(|point| dominance == Dominance::classify(point, &mut least));
        let note = |point: &&Point| {
            format!(
                "{}, {}: {:.0} ns, error {}",
                curve.name,
                point.setting,
                point.nanoseconds.median,
                error(worst(point))
            )
        };
        Series {
            // The name appears once in the legend.
            name: if dominance == Dominance::Front { curve.name.clone() } else { String::new() },
            mark: dominance.mark(),
            notes: points.iter().map(note).collect(),
            ..colours.line(&curve.name, points.iter().map(|point| (worst(point), point.nanoseconds.median)).collect())
        }
    };
    let (curves, _) = drawn(set);
    let series = curves.into_iter().flat_map(|curve| Dominance::ALL.map(|dominance| series(curve, dominance)));
    let series = series.filter(|series| !series.points.is_empty()).collect();
    Plot { x, y: "ns per query", zero: Some("exact"), series, size: SIZE, legend: LEGEND_WIDTH, ..Plot::default() }
}

/// Plots the times of single queries over their rarity.
pub(super) fn latencies(set: &SetFigures, colours: &Colours) -> Plot {
    let series = drawn(set).0.into_iter().filter_map(|curve| {
        let point = curve.usual()?;
        let l = point.latency?;
        let all = [(2.0, l.p50), (10.0, l.p90), (100.0, l.p99), (1000.0, l.p999)];
        let shown = all.into_iter().filter(|(one_in, _)| *one_in <= point.queries as f64);
        let points: Vec<(f64, f64)> = shown.map(|(one_in, ns)| (one_in, ns as f64)).collect();
        let note = |p: &(f64, f64)| format!("{}: one in {:.0} takes more than {:.0} ns", curve.name, p.0, p.1);
        Some(Series { notes: points.iter().map(note).collect(), ..colours.line(&curve.name, points) })
    });
    Plot {
        x: "one query in so many",
        y: "takes longer than so many ns",
        series: series.collect(),
        size: SIZE,
        legend: LEGEND_WIDTH,
        ..Plot::default()
    }
}

/// Plots the total time of building and querying over the number of queries.
pub(super) fn totals(set: &SetFigures, colours: &Colours) -> Plot {
    let series = default_costs(&set.curves).into_iter().map(|(name, cost)| {
        let points: Vec<(f64, f64)> =
            (4..=18).map(|i| 10f64.powf(f64::from(i) / 2.0)).map(|n| (n, cost.total(n))).collect();
        let note = |p: &(f64, f64)| format!("{name}: {} queries in {:.3} s, built", count(p.0), p.1);
        Series { notes: points.iter().map(note).collect(), ..colours.line(name, points) }
    });
    Plot {
        x: "queries",
        y: "seconds, with building",
        series: series.collect(),
        size: SIZE,
        legend: LEGEND_WIDTH,
        ..Plot::default()
    }
}
