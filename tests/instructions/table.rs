//! The table in `tests/instructions.csv`: rows of figures, and their comparison with measured ones.

use crate::tasks::COUNTERS;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The fraction by which the instructions of a query may exceed the table. The same code takes up to 0.4 % more or
/// fewer at another address of the stack, and up to 0.2 % after a change of unrelated functions.
const TOLERANCE: f64 = 0.02;
/// The columns of figures.
pub(crate) const COLUMNS: [&str; 5] = ["nodes", "packets", "primitives", "portable", "avx2"];
/// Whether counters have to be exactly equal. If the portable instruction set has fused multiply-add, the last bits of
/// bounds differ from the machine of the table, and counters may differ.
const IS_EXACT: bool = cfg!(all(target_arch = "x86_64", not(target_feature = "fma")));
/// The command that rewrites the table.
pub(crate) const RENEWAL: &str = "P2M_BLESS=1 cargo test --test instructions";

/// A row of the table: the figures of a query by column, some of which may be unknown.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// The scene, the backend and the query set.
    pub(crate) names: [String; 3],
    pub(crate) figures: [Option<f64>; COLUMNS.len()],
}

impl Row {
    fn has_names_of(&self, other: &Self) -> bool {
        self.names == other.names
    }
}

/// Formats a figure as it is in the table.
fn formatted(figure: Option<f64>, column: usize) -> String {
    let decimals = if column < COUNTERS { 3 } else { 0 };
    figure.map_or_else(|| "-".to_owned(), |x| format!("{x:.decimals$}"))
}

/// The table in the repository.
pub(crate) struct Table {
    /// The compiler and the target for which the table has instructions.
    pub(crate) compiler: String,
    pub(crate) rows: Vec<Row>,
}

const COMPILER: &str = "# Instructions are those of ";

impl Table {
    fn path() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/instructions.csv")
    }

    pub(crate) fn read() -> Self {
        let text = fs::read_to_string(Self::path()).unwrap_or_default();
        let compiler = text.lines().find_map(|line| line.strip_prefix(COMPILER)).unwrap_or_default().to_owned();
        let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
        let row = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), 3 + COLUMNS.len(), "a row of tests/instructions.csv: {line}");
            let figure = |column: usize| match cells[3 + column] {
                "-" => None,
                figure => Some(figure.parse().expect("a number in tests/instructions.csv")),
            };
            Row { names: [0, 1, 2].map(|i| cells[i].to_owned()), figures: std::array::from_fn(figure) }
        };
        Self { compiler, rows: lines.map(row).collect() }
    }

    pub(crate) fn write(&self) {
        let mut text = format!(
            "# The work of a query, written by {RENEWAL}\n\
             {COMPILER}{}\nscene,backend,set,{}\n",
            self.compiler,
            COLUMNS.join(",")
        );
        for row in &self.rows {
            let figures: Vec<String> = (0..).zip(row.figures).map(|(column, x)| formatted(x, column)).collect();
            writeln!(text, "{},{}", row.names.join(","), figures.join(",")).expect("memory");
        }
        fs::write(Self::path(), text).expect("a checkout to write to");
    }
}

/// The change of a figure from the table, beyond the tolerance.
enum Change {
    None,
    Less,
    More,
}

impl Change {
    /// Classifies the change of a figure in a column.
    fn of(column: usize, before: f64, now: f64) -> Self {
        let tolerance = if column < COUNTERS && IS_EXACT { 0.0 } else { TOLERANCE * before };
        if now > before + tolerance {
            Self::More
        } else if now < before - tolerance {
            Self::Less
        } else {
            Self::None
        }
    }
}

fn percent(before: f64, now: f64) -> f64 {
    (now - before) / before * 100.0
}

/// Prints all figures in columns, with their differences from the table in percent.
pub(crate) fn print_rows(rows: &[Row], table: &Table) {
    let heads = COLUMNS.map(|name| format!("{name:>10}{:10}", "")).join("");
    println!("{:<16} {:<13} {:<8}{}", "scene", "backend", "set", heads.trim_end());
    for row in rows {
        let before = table.rows.iter().find(|before| before.has_names_of(row));
        let cell = |column: usize| {
            let change = before.and_then(|before| before.figures[column]).zip(row.figures[column]);
            let change = change.filter(|(before, now)| before != now);
            let change = change.map(|(before, now)| format!(" {:>+7.2} %", percent(before, now)));
            format!("{:>10}{:10}", formatted(row.figures[column], column), change.unwrap_or_default())
        };
        let ([scene, backend, set], cells) =
            (&row.names, std::array::from_fn::<_, { COLUMNS.len() }, _>(cell).join(""));
        println!("{scene:<16} {backend:<13} {set:<8}{}", cells.trim_end());
    }
}

/// Compares the rows with the table, and returns messages about worse figures and about better ones.
pub(crate) fn compare(rows: &[Row], table: &Table) -> (Vec<String>, Vec<String>) {
    let (mut wrong, mut better) = (Vec::new(), Vec::new());
    let absent = |list: &[Row], row: &Row| !list.iter().any(|other| other.has_names_of(row));
    wrong.extend(
        rows.iter()
            .filter(|row| absent(&table.rows, row))
            .map(|row| format!("{}: not in the table", row.names.join(", "))),
    );
    wrong.extend(
        table
            .rows
            .iter()
            .filter(|row| absent(rows, row))
            .map(|row| format!("{}: in the table alone", row.names.join(", "))),
    );
    for row in rows {
        let Some(before) = table.rows.iter().find(|before| before.has_names_of(row)) else { continue };
        for (column, name) in COLUMNS.into_iter().enumerate() {
            let (Some(before), Some(now)) = (before.figures[column], row.figures[column]) else { continue };
            let kind = if column < COUNTERS { "" } else { " instructions" };
            let message = format!(
                "{}: {} {}{kind} a query, {} in the table, {:+.2} %",
                row.names.join(", "),
                formatted(Some(now), column),
                name,
                formatted(Some(before), column),
                percent(before, now)
            );
            match Change::of(column, before, now) {
                Change::None => {}
                Change::Less if column >= COUNTERS => better.push(message),
                Change::Less | Change::More => wrong.push(message),
            }
        }
    }
    (wrong, better)
}
