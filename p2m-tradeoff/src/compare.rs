//! Compares two records: times that changed, and errors that changed.

use crate::error::RecordError;
use crate::record::Line;
use crate::table::Table;
use std::fmt;

/// A point that two records have.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Scene, set, backend and setting.
    pub key: [String; 4],
    /// The median of the second over that of the first: below 1 is faster.
    pub ratio: f64,
    /// The smallest and the largest ratio of a round of the second to one of the first.
    pub range: [f64; 2],
    /// Whether both have the same number of queries. They are then the same queries, and only then errors are compared.
    /// A slow backend gets as many queries as fit into its time.
    pub same_queries: bool,
    /// The errors that differ: their name, and their values in the first and in the second record.
    pub errors: Vec<(&'static str, String, String)>,
}

impl Change {
    /// Returns whether every round of one record is faster than every round of the other, which is beyond noise.
    #[must_use]
    pub fn is_significant(&self) -> bool {
        self.range[0] > 1.0 || self.range[1] < 1.0
    }
}

/// The comparison of two records.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The points that both records have.
    pub changes: Vec<Change>,
    /// The numbers of points of the first and of the second record alone.
    pub alone: [usize; 2],
    /// The number of points of both records that are not compared, because the size of the scene or the seed differs.
    pub other_jobs: usize,
    /// The processor, compiler, flags and commit, as far as they differ.
    pub origins: Vec<(&'static str, String, String)>,
}

/// Compares two records.
///
/// # Errors
/// [`RecordError::Foreign`] if they have no point in common.
pub fn compare(first: &[Line], second: &[Line]) -> Result<Comparison, RecordError> {
    let mut comparison =
        Comparison { changes: Vec::new(), alone: [0; 2], other_jobs: 0, origins: origins(first, second) };
    for a in first {
        match second.iter().find(|b| b.key == a.key) {
            None => comparison.alone[0] += 1,
            Some(b) if b.job != a.job => comparison.other_jobs += 1,
            Some(b) => comparison.changes.push(change(a, b)),
        }
    }
    comparison.alone[1] = second.iter().filter(|b| first.iter().all(|a| a.key != b.key)).count();
    if comparison.changes.is_empty() { Err(RecordError::Foreign) } else { Ok(comparison) }
}

fn change(a: &Line, b: &Line) -> Change {
    let ([a_median, a_min, a_max], [b_median, b_min, b_max]) = (a.nanoseconds, b.nanoseconds);
    let pairs = a.errors.iter().zip(&b.errors);
    let same_queries = a.queries == b.queries;
    let errors =
        pairs.filter(|(a, b)| same_queries && a.1 != b.1).map(|(a, b)| (a.0, a.1.clone(), b.1.clone())).collect();
    Change {
        key: a.key.clone(),
        ratio: b_median / a_median,
        range: [b_min / a_max, b_max / a_min],
        same_queries,
        errors,
    }
}

/// Returns the origins of the first lines, as far as they differ.
fn origins(first: &[Line], second: &[Line]) -> Vec<(&'static str, String, String)> {
    let (Some(a), Some(b)) = (first.first(), second.first()) else { return Vec::new() };
    let names = ["processor", "compiler", "flags", "commit"];
    let all = names.iter().zip(a.origin.iter().zip(&b.origin));
    all.filter(|(_, (a, b))| a != b).map(|(name, (a, b))| (*name, a.clone(), b.clone())).collect()
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, a, b) in &self.origins {
            writeln!(f, "{name}: `{a}`, then `{b}`")?;
        }
        writeln!(
            f,
            "\nTime per query of the second record over that of the first: ratio of medians, with the least and the most that a \
             round of one can be of a round of the other. Marked where all rounds of one are faster than all of the other.\n"
        )?;
        let mut table = Table::new(["scene", "set", "backend", "setting", "ratio", "least", "most", "", "errors"]);
        for change in &self.changes {
            let mut row = change.key.to_vec();
            row.extend([change.ratio, change.range[0], change.range[1]].map(|ratio| format!("{ratio:.3}")));
            let mark = match change.is_significant() {
                false => "",
                true if change.ratio < 1.0 => "faster",
                true => "SLOWER",
            };
            row.push(mark.to_owned());
            let errors = change.errors.iter().map(|(name, a, b)| format!("{name} {} -> {}", or_none(a), or_none(b)));
            row.push(errors.collect::<Vec<_>>().join("; "));
            table.push(row);
        }
        writeln!(f, "{table}")?;
        let significant = self.changes.iter().filter(|change| change.is_significant()).count();
        let changed = self.changes.iter().filter(|change| !change.errors.is_empty()).count();
        writeln!(f, "{} compared, {significant} beyond noise, {changed} with other errors.", self.changes.len())?;
        let others = self.changes.iter().filter(|change| !change.same_queries).count();
        if others > 0 {
            writeln!(f, "{others} with other numbers of queries, whose errors are not compared.")?;
        }
        let [a, b] = self.alone;
        if a + b + self.other_jobs > 0 {
            let others = self.other_jobs;
            writeln!(
                f,
                "{a} in the first alone, {b} in the second alone, {others} of other scenes or seeds not compared."
            )?;
        }
        Ok(())
    }
}

fn or_none(value: &str) -> &str {
    if value.is_empty() { "none" } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::SceneFigures;
    use crate::fixtures;
    use crate::record::{read_record, record};

    fn lines(scene: SceneFigures) -> Vec<Line> {
        read_record(&record(&fixtures::provenance(), &[scene], 1, 25.0)).unwrap()
    }

    #[test]
    fn the_same_record_has_no_changes() {
        let same = compare(&lines(fixtures::scene()), &lines(fixtures::scene())).unwrap();
        assert_eq!((same.changes.len(), same.alone, same.other_jobs, same.origins.len()), (3, [0, 0], 0, 0));
        assert!(same.changes.iter().all(|c| c.ratio == 1.0 && !c.is_significant() && c.errors.is_empty()));
    }

    #[test]
    fn changes_beyond_the_spread_are_marked_and_others_are_not() {
        let mut scene = fixtures::scene();
        let points = &mut scene.sets[0].curves[0].points;
        points[0] = fixtures::point("default", 1000.5 * 1.1, 0.0, 0.1);
        points[1] = fixtures::point("epsilon 0.1", 500.0 * 1.3, 0.05, 0.1);
        scene.sets[0].curves[1].points[0] = fixtures::point("default", 100.25 * 0.7, 1e-16, 5.0);
        let comparison = compare(&lines(fixtures::scene()), &lines(scene)).unwrap();
        let marks: Vec<bool> = comparison.changes.iter().map(Change::is_significant).collect();
        assert_eq!(marks, [false, true, true]);
        assert!((comparison.changes[1].ratio - 1.3).abs() < 1e-12);
        let text = comparison.to_string();
        assert_eq!(
            (text.matches("SLOWER").count(), text.matches(" faster ").count()),
            (1, 1 + text.matches("are faster than").count()),
            "{text}"
        );
    }

    #[test]
    fn other_errors_other_machines_and_other_jobs_are_told() {
        let mut scene = fixtures::scene();
        scene.sets[0].curves[0].points[1].errors.bounds_above_truth = 3;
        scene.sets[0].curves[0].points[0].setting = "new".to_owned();
        scene.sets[0].curves[1].points[0].queries = 99;
        scene.sets[0].curves[1].points[0].errors.broken = 1;
        let mut second = lines(scene);
        second[0].origin[3] = "def".to_owned();
        let comparison = compare(&lines(fixtures::scene()), &second).unwrap();
        assert_eq!((comparison.changes.len(), comparison.alone, comparison.other_jobs), (2, [1, 1], 0));
        assert!(comparison.changes[0].same_queries && !comparison.changes[1].same_queries);
        assert!(comparison.changes[1].errors.is_empty());
        assert_eq!(comparison.changes[0].errors, [("bounds_above_truth", "0".to_owned(), "3".to_owned())]);
        assert_eq!(comparison.origins, [("commit", "abc".to_owned(), "def".to_owned())]);
        second[1].job[0] = "4".to_owned();
        assert_eq!(compare(&lines(fixtures::scene()), &second).unwrap().other_jobs, 1);
        let text = comparison.to_string();
        assert!(text.contains("1 with other numbers of queries"), "{text}");
        assert!(text.contains("bounds_above_truth 0 -> 3") && text.contains("`abc`, then `def`"), "{text}");
    }

    #[test]
    fn records_of_other_things_are_refused() {
        let other = SceneFigures { name: "another".to_owned(), ..fixtures::scene() };
        assert_eq!(compare(&lines(fixtures::scene()), &lines(other)), Err(RecordError::Foreign));
    }
}
