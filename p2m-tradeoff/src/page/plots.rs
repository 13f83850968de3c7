//! The plots of a set of queries.

use crate::curve::{Curve, Point, SetFigures};
use crate::economy::usual_costs;
use crate::errors::Worst;
use crate::plot::{Mark, Plot, Series};
use crate::text::{count, error};

/// Width and height of a plot of which two stand side by side.
pub(super) const SIZE: (u32, u32) = (640, 400);
/// Room for names beside it.
pub(super) const LEGEND: u32 = 110;

/// A curve that is slower than the fastest by more than this is not drawn: it would leave no room for the others.
const FAR: f64 = 30.0;

/// The curves that are drawn, and the names of others.
pub(super) fn drawn(set: &SetFigures) -> (Vec<&Curve>, Vec<&str>) {
    let nanoseconds = |curve: &Curve| curve.usual().map_or(f64::INFINITY, |usual| usual.nanoseconds.median);
    let least = set.curves.iter().map(nanoseconds).fold(f64::INFINITY, f64::min);
    let (near, far): (Vec<_>, Vec<_>) = set.curves.iter().partition(|curve| nanoseconds(curve) <= FAR * least);
    (near, far.into_iter().map(|curve| curve.name.as_str()).collect())
}

/// What errors are measured in.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Unit {
    /// u M
    Scaled,
    /// The true distance.
    Relative,
}

/// Names of backends, in the order of their colours in all plots.
pub(super) struct Colours(pub(super) Vec<String>);

impl Colours {
    fn of(&self, name: &str) -> usize {
        self.0.iter().position(|known| known == name).unwrap_or(self.0.len())
    }

    /// A line of this colour.
    pub(super) fn line(&self, name: &str, points: Vec<(f64, f64)>) -> Series {
        Series { name: name.to_owned(), mark: Mark::Line, colour: self.of(name), points, notes: Vec::new() }
    }
}

/// Where a setting stands among those of its backend.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Faster than all that are more exact.
    Front,
    /// Not.
    Behind,
}

impl Place {
    const ALL: [Self; 2] = [Self::Front, Self::Behind];

    /// Of one after the other, the most exact one first.
    fn of(point: &Point, least: &mut f64) -> Self {
        if point.nanoseconds.median < *least {
            *least = point.nanoseconds.median;
            Self::Front
        } else {
            Self::Behind
        }
    }

    fn mark(self) -> Mark {
        match self {
            Self::Front => Mark::Line,
            Self::Behind => Mark::Dot,
        }
    }
}

/// Speed over error: a point for each setting.
pub(super) fn pareto(set: &SetFigures, colours: &Colours, unit: Unit, of: fn(&Worst) -> f64) -> Plot {
    let x = match unit {
        Unit::Scaled => "error, in u M",
        Unit::Relative => "error, relative to the distance",
    };
    let worst = |point: &Point| match unit {
        Unit::Scaled => of(&point.errors.scaled),
        Unit::Relative => of(&point.errors.relative),
    };
    let series = |curve: &Curve, place: Place| {
        let mut points: Vec<&Point> = curve.points.iter().collect();
        points.sort_by(|a, b| worst(a).total_cmp(&worst(b)));
        let mut least = f64::INFINITY;
        points.retain(|point| place == Place::of(point, &mut least));
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
            // Named once.
            name: if place == Place::Front { curve.name.clone() } else { String::new() },
            mark: place.mark(),
            notes: points.iter().map(note).collect(),
            ..colours.line(&curve.name, points.iter().map(|point| (worst(point), point.nanoseconds.median)).collect())
        }
    };
    let (curves, _) = drawn(set);
    let series = curves.into_iter().flat_map(|curve| Place::ALL.map(|place| series(curve, place)));
    let series = series.filter(|series| !series.points.is_empty()).collect();
    Plot { x, y: "ns per query", zero: Some("exact"), series, size: SIZE, legend: LEGEND, ..Plot::default() }
}

/// How long single queries take, over how rare they are.
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
        legend: LEGEND,
        ..Plot::default()
    }
}

/// What building and asking take together, over the number of queries.
pub(super) fn totals(set: &SetFigures, colours: &Colours) -> Plot {
    let series = usual_costs(&set.curves).into_iter().map(|(name, cost)| {
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
        legend: LEGEND,
        ..Plot::default()
    }
}
