//! The summary of a page: the best backend and setting for each need, by the results alone.

use crate::break_even::default_costs;
use crate::curve::{Curve, Point, SceneFigures, SetFigures};
use crate::settings::DEFAULT;
use crate::text::error;
use p2m_core::kernel::ERROR_CONSTANT;

/// A requirement that a reader may have.
struct Need {
    /// The heading of its column.
    name: &'static str,
    /// Whether answers are accurate enough.
    is_met: fn(&Point) -> bool,
}

const NEEDS: [Need; 3] = [
    Need { name: "no error but rounding", is_met: |point| is_exact(point) && point.setting == DEFAULT.name },
    Need { name: "up to 1 %", is_met: |point| is_exact(point) || is_within(point, 0.01) },
    Need { name: "up to 10 %", is_met: |point| is_exact(point) || is_within(point, 0.1) },
];

/// The numbers of queries of jobs, and their names.
const JOBS: [(f64, &str); 3] = [(1e4, "10,000 queries, built"), (1e6, "a million, built"), (1e8, "100 million, built")];

/// Returns whether no error is larger than the contract allows: once for the primitive of the answer and once for
/// the nearest one.
fn is_exact(point: &Point) -> bool {
    point.errors.unanswered == 0 && point.errors.scaled.max <= 2.0 * ERROR_CONSTANT
}

fn is_within(point: &Point, relative: f64) -> bool {
    point.errors.unanswered == 0 && point.errors.relative.max <= relative
}

/// Returns the head of the table.
pub(super) fn head() -> Vec<&'static str> {
    let needs = NEEDS.iter().map(|need| need.name);
    ["scene", "queries"].into_iter().chain(needs).chain(JOBS.iter().map(|job| job.1)).collect()
}

/// Returns a row for each set of queries.
pub(super) fn rows(scenes: &[SceneFigures]) -> Vec<Vec<String>> {
    let all = scenes.iter().flat_map(|scene| scene.sets.iter().map(move |set| (scene, set)));
    all.map(|(scene, set)| row(scene, set)).collect()
}

fn row(scene: &SceneFigures, set: &SetFigures) -> Vec<String> {
    let mut row = vec![scene.name.clone(), set.name.clone()];
    row.extend(NEEDS.iter().map(|need| fastest(&set.curves, need.is_met)));
    for (queries, _) in JOBS {
        let exact: Vec<Curve> =
            set.curves.iter().filter(|curve| curve.usual().is_some_and(is_exact)).cloned().collect();
        let costs = default_costs(&exact);
        let best = costs.iter().min_by(|a, b| a.1.total(queries).total_cmp(&b.1.total(queries)));
        row.push(best.map_or("-".to_owned(), |(name, cost)| {
            format!("{name}, {}", crate::text::seconds(cost.total(queries)) + " s")
        }));
    }
    row
}

/// Returns the fastest point that is accurate enough. Of points that are slower by no more than noise, it is the one
/// with the most accurate setting.
fn fastest(curves: &[Curve], is_met: fn(&Point) -> bool) -> String {
    let all =
        || curves.iter().flat_map(|curve| (0..).zip(&curve.points).map(move |(rank, point)| (curve, rank, point)));
    let met = || all().filter(|(_, _, point)| is_met(point));
    let by_time = |a: &Point, b: &Point| a.nanoseconds.median.total_cmp(&b.nanoseconds.median);
    let Some((.., best)) = met().min_by(|a, b| by_time(a.2, b.2)) else { return "-".to_owned() };
    let equally_fast = met().filter(|(_, _, point)| point.nanoseconds.min <= best.nanoseconds.max);
    // Settings are listed from the most accurate one on.
    let chosen = equally_fast.min_by(|a: &(&Curve, usize, &Point), b| a.1.cmp(&b.1).then(by_time(a.2, b.2)));
    chosen.map_or("-".to_owned(), |(curve, _, point)| {
        let setting = if curve.usual() == Some(point) { String::new() } else { format!(" {}", point.setting) };
        let worst =
            if is_exact(point) { String::new() } else { format!(", error {}", error(point.errors.relative.max)) };
        format!("{}{setting}, {:.0} ns{worst}", curve.name, point.nanoseconds.median)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures;

    #[test]
    fn the_best_are_by_what_was_measured() {
        let mut scene = fixtures::scene();
        let rows_of = |scene: &SceneFigures| rows(std::slice::from_ref(scene));
        let row = &rows_of(&scene)[0];
        assert_eq!(row.len(), head().len());
        assert_eq!(row[2..5], ["p2m, 100 ns", "p2m, 100 ns", "p2m, 100 ns"]);
        // Ten thousand queries do not pay for cells, a hundred millions do.
        assert_eq!([&row[5], &row[7]], ["aabb, 0.110 s", "p2m, 15.0 s"]);
        // Without cells, a tenth is worth an epsilon, and a hundredth is not.
        scene.sets[0].curves.pop();
        let row = &rows_of(&scene)[0];
        assert_eq!(row[2..5], ["aabb, 1000 ns", "aabb, 1000 ns", "aabb epsilon 0.1, 500 ns, error 5.0e-2"]);
        // An epsilon that is hardly faster is not.
        let epsilon = scene.sets[0].curves[0].points[1].clone();
        scene.sets[0].curves[0].points[1].nanoseconds.max = 960.0;
        assert_eq!(rows_of(&scene)[0][4], "aabb, 1000 ns");
        scene.sets[0].curves[0].points[1] = epsilon;
        scene.sets[0].curves[0].points[1].errors.unanswered = 1;
        assert_eq!(rows_of(&scene)[0][4], "aabb, 1000 ns");
    }
}
