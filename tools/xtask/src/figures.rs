//! `cargo xtask figures`: the figures of the documents are those of the files in docs/measurements.
//!
//! A file of data is a table of comma-separated values after lines of comments, which name the commit, the date and the
//! command. Its first two columns, which name a row, are text, and the name of a column ends with its unit.
//!
//! A document has figures in two forms, which are comments of Markdown:
//!
//! - `<!-- = dragon_100k octree 1x -->381 ns<!-- . -->` is a value of speed.csv, `= dragon_100k octree/parry3d 1x` how
//!   many times less it is than that of another row. The name of a file may come first: `= python: ..`.
//! - `<!-- table bunny dragon_100k: aabb octree -->` begins a table of these scenes and indexes, which `<!-- end -->`
//!   ends.
//!
//! Any other number with a unit of measurement is an error, except in code, in docs/measurements, and in paragraphs with
//! the comment `<!--cited-->`, or `<!--exact-->` for sizes and limits that are not measured.

use crate::links::has_extension;
use crate::{Outcome, entries, fail_if_any, files_below, read, write};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The folder of data.
const FOLDER: &str = "docs/measurements";
/// Pages whose figures need no data.
const FREE: [&str; 4] = ["docs/measurements", "docs/decisions", "docs/proofs", "docs/SUMMARY.md"];
/// The data of tables, and of figures that name no file.
const SPEED: &str = "speed";
/// The columns of tables after the name of the index.
const COLUMNS: [(&str, &str); 7] = [
    ("build s", "build"),
    ("bytes", "bytes per primitive"),
    ("10x ns", "10x"),
    ("1x ns", "1x"),
    ("near ns", "near"),
    ("surface ns", "surface"),
    ("grid ns", "grid"),
];
/// What speeds are relative to.
const YARDSTICK: &str = "parry3d";
/// Units of measurement, as words after a number.
const UNITS: &str = "ns us µs ms s seconds microseconds minutes bytes kB MB GB % times x queries/s M cent";

/// Comments in paragraphs whose figures need no data.
const MARKS: [&str; 2] = ["<!--cited-->", "<!--exact-->"];

/// Renews the figures of all documents, or checks them with `--check`.
pub(crate) fn run(rest: &[String]) -> Outcome {
    let is_check = rest.iter().any(|word| word == "--check");
    let data = Data::read(Path::new(FOLDER))?;
    let mut wrong = Vec::new();
    let documents = [PathBuf::from("README.md")].into_iter().chain(files_below("docs")?);
    for path in documents.filter(|path| has_extension(path, "md")) {
        let old = read(&path)?;
        let new = data.renew(&old).map_err(|why| format!("{}: {why}", path.display()))?;
        if !FREE.iter().any(|free| path.starts_with(free)) {
            wrong.extend(unknown(&new).into_iter().map(|line| format!("{}:{line}", path.display())));
        }
        if new != old && is_check {
            wrong.push(format!("{}: its figures are not those of the data; run cargo xtask figures", path.display()));
        } else if new != old {
            write(&path, new)?;
        }
    }
    fail_if_any("figures without data", &wrong)
}

/// The files of data.
struct Data(BTreeMap<String, File>);

/// A file of data.
struct File {
    /// The commit and the date.
    age: String,
    columns: Vec<String>,
    /// The values of each row, which its first two columns name.
    rows: Vec<([String; 2], Vec<String>)>,
}

impl File {
    fn parse(text: &str) -> Option<Self> {
        let (comments, mut lines) =
            (text.lines().filter(|l| l.starts_with('#')), text.lines().filter(|l| !l.starts_with('#')));
        let columns = lines.next()?.split(',').skip(2).map(str::to_owned).collect();
        let row = |line: &str| {
            let mut cells = line.split(',').map(str::to_owned);
            Some(([cells.next()?, cells.next()?], cells.collect()))
        };
        let after = |name: &str, line: &str| {
            let (_, rest) = line.split_once(name)?;
            Some(rest.trim_start().split([',', '.', ' ']).next()?.to_owned())
        };
        let comment: Vec<&str> = comments.collect();
        let commit = comment.iter().find_map(|line| after("Commit ", line))?;
        let date =
            comment.iter().find_map(|line| Some(after(&format!("Commit {commit},"), line)?.get(..10)?.to_owned()))?;
        Some(Self { age: format!("{date}, commit {commit}"), columns, rows: lines.map(row).collect::<Option<_>>()? })
    }

    /// Finds a column by its name, with or without the unit.
    fn column(&self, column: &str) -> Option<usize> {
        self.columns.iter().position(|name| {
            name.strip_prefix(column)
                .is_some_and(|unit| unit.is_empty() || unit.starts_with(' ') && !unit[1..].contains(' '))
        })
    }

    fn value(&self, row: [&str; 2], column: &str) -> Option<f64> {
        let (_, values) = self.rows.iter().find(|(names, _)| names[0] == row[0] && names[1] == row[1])?;
        values.get(self.column(column)?)?.parse().ok()
    }

    /// Returns the unit of a column, which is the last word of its name.
    fn unit(&self, column: &str) -> &str {
        self.column(column).and_then(|at| self.columns[at].rsplit(' ').next()).unwrap_or_default()
    }
}

impl Data {
    fn read(folder: &Path) -> Result<Self, String> {
        let mut data = BTreeMap::new();
        for path in entries(folder)?.into_iter().filter(|path| has_extension(path, "csv")) {
            let text = read(&path)?;
            // Records of other commands have no comments.
            if !text.starts_with('#') {
                continue;
            }
            let file =
                File::parse(&text).ok_or_else(|| format!("{} names no commit, or has no rows", path.display()))?;
            data.insert(path.file_stem().unwrap_or_default().to_string_lossy().into_owned(), file);
        }
        Ok(Self(data))
    }

    fn file(&self, name: &str) -> Result<&File, String> {
        self.0.get(name).ok_or_else(|| format!("there is no {FOLDER}/{name}.csv"))
    }

    /// Returns a document with the figures of the data.
    fn renew(&self, document: &str) -> Result<String, String> {
        let (mut new, mut rest) = (String::new(), document);
        while let Some((before, after)) = rest.split_once("<!-- ") {
            let (directive, after) = after.split_once(" -->").ok_or("a comment has no end")?;
            new += &format!("{before}<!-- {directive} -->");
            rest = after;
            let (made, end) = if let Some(figure) = directive.strip_prefix("= ") {
                (self.figure(figure), "<!-- . -->")
            } else if let Some(table) = directive.strip_prefix("table ") {
                (self.table(table).map(|table| format!("\n\n{table}\n\n")), "<!-- end -->")
            } else {
                continue;
            };
            let (_, after) = rest.split_once(end).ok_or_else(|| format!("nothing ends {directive}"))?;
            new += &(made.map_err(|why| format!("{directive}: {why}"))? + end);
            rest = after;
        }
        Ok(new + rest)
    }

    /// Returns a value, a ratio or an age as it is printed.
    fn figure(&self, words: &str) -> Result<String, String> {
        let (file, words) = words.split_once(": ").unwrap_or((SPEED, words));
        let file = self.file(file)?;
        let words: Vec<&str> = words.split(' ').collect();
        let [subject, name, column] = words[..] else {
            return if words == ["age"] { Ok(file.age.clone()) } else { Err("three words are needed".to_owned()) };
        };
        let value =
            |name| file.value([subject, name], column).ok_or_else(|| format!("no value of {subject} {name} {column}"));
        match name.split_once('/') {
            Some((ours, theirs)) => Ok(format!("{} times", digits(value(theirs)? / value(ours)?, 2))),
            None => Ok(in_words(value(name)?, file.unit(column))),
        }
    }

    /// Returns a table of some scenes and indexes, with its age.
    fn table(&self, words: &str) -> Result<String, String> {
        let file = self.file(SPEED)?;
        let (scenes, indexes) = words.split_once(": ").ok_or("scenes, a colon and indexes are needed")?;
        let names: Vec<&str> = COLUMNS.iter().map(|column| column.1).collect();
        let mut lines = vec![
            format!("| scene | index | {} |", names.join(" | ")),
            format!("|---|---|{}", "--:|".repeat(names.len())),
        ];
        for scene in scenes.split(' ') {
            for (i, index) in indexes.split(' ').enumerate() {
                let cell = |column: &str| {
                    let Some(value) = file.value([scene, index], column) else { return "-".to_owned() };
                    let ratio = file
                        .value([scene, YARDSTICK], column)
                        .filter(|_| column.ends_with(" ns") && index != YARDSTICK);
                    let ratio = ratio.map_or(String::new(), |theirs| format!(" ({}x)", digits(theirs / value, 2)));
                    in_words(value, file.unit(column)) + &ratio
                };
                let cells: Vec<String> = COLUMNS.iter().map(|column| cell(column.0)).collect();
                if cells.iter().all(|cell| cell == "-") {
                    return Err(format!("no row of {scene} {index}"));
                }
                lines.push(format!("| {} | {index} | {} |", if i == 0 { scene } else { "" }, cells.join(" | ")));
            }
        }
        Ok(format!("{}\n\nMeasured {}.", lines.join("\n"), file.age))
    }
}

/// Returns a value with its unit, for people.
fn in_words(value: f64, unit: &str) -> String {
    match unit {
        "ns" if value >= 1e6 => format!("{} ms", digits(value * 1e-6, 3)),
        "ns" if value >= 1e4 => format!("{} µs", digits(value * 1e-3, 3)),
        "s" if value < 1.0 => format!("{} ms", digits(value * 1e3, 3)),
        "bytes" => format!("{value:.0}"),
        unit => format!("{} {unit}", digits(value, 3)).trim_end().to_owned(),
    }
}

/// Returns a number with so many significant digits, and all digits before the point.
fn digits(value: f64, count: usize) -> String {
    let after = (0..count).rev().find(|after| value.abs() * 10f64.powf(*after as f64) < 10f64.powf(count as f64));
    format!("{value:.*}", after.unwrap_or(0))
}

/// Returns the figures of a document without data, each with the number of the line where its paragraph ends.
fn unknown(document: &str) -> Vec<String> {
    let (mut found, mut paragraph, mut is_code, mut is_table) = (Vec::new(), String::new(), false, false);
    for (number, line) in document.lines().chain([""]).enumerate() {
        is_code ^= line.trim_start().starts_with("```");
        is_table |= line.starts_with("<!-- table ");
        let is_end = line.contains("<!-- end -->");
        if !line.trim().is_empty() {
            if !is_code && !is_table {
                paragraph = format!("{paragraph} {line}");
            }
        } else if let Some(figure) = figure(&std::mem::take(&mut paragraph)) {
            found.push(format!("{number}: {figure}"));
        }
        is_table &= !is_end;
    }
    found
}

/// Returns the first figure of a paragraph without data, unless the paragraph says that it is cited or exact.
fn figure(paragraph: &str) -> Option<String> {
    if MARKS.iter().any(|mark| paragraph.contains(mark)) {
        return None;
    }
    let text = without(&without(paragraph, "<!-- = ", "<!-- . -->"), "`", "`");
    let words: Vec<&str> = text.split([' ', '(', ')', '|', ',', ';']).filter(|word| !word.is_empty()).collect();
    let is_number = |word: &str| word.starts_with(|c: char| c.is_ascii_digit()) && !word.ends_with(':');
    let is_unit = |word: &str| UNITS.split(' ').any(|unit| unit == word.trim_end_matches(['.', ':', '*']));
    let pair = words.windows(2).find(|pair| is_number(pair[0]) && is_unit(pair[1]));
    let end = |word: &str| word.trim_end_matches('.').to_owned();
    let has_unit = |word: &&&str| is_number(word) && end(word).ends_with(['x', '%']);
    pair.map(|pair| pair.join(" ")).or_else(|| words.iter().find(has_unit).map(|word| (*word).to_owned()))
}

/// Returns a text without all that is between a beginning and an end.
fn without(text: &str, begin: &str, end: &str) -> String {
    let (mut rest, mut out) = (text, String::new());
    while let Some((before, after)) = rest.split_once(begin) {
        let Some((_, after)) = after.split_once(end) else { break };
        out += before;
        rest = after;
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEEDS: &str = "# CPU: x. Commit 1234567, 2026-11-27T10:00Z.\nscene,index,primitives,build s,bytes,10x ns,1x ns,near ns,surface ns,grid ns\na,octree,9,0.25,12.4,381.2,10,20,30,40\na,parry3d,9,0.5,100,3812,100,200,300,400\n";

    fn data() -> Data {
        Data([(SPEED.to_owned(), File::parse(SPEEDS).unwrap())].into())
    }

    #[test]
    fn figures_and_tables_are_those_of_the_data() {
        let document = "Takes <!-- = a octree 10x -->0 ns<!-- . -->, <!-- = a octree/parry3d 10x -->x<!-- . --> the speed.\n\n<!-- table a: octree parry3d -->\nold\n<!-- end -->\nSince <!-- = age --><!-- . -->.\n";
        let new = data().renew(document).unwrap();
        assert!(new.contains("-->381 ns<!-- . -->") && new.contains("-->10 times<!-- . --> the speed"), "{new}");
        assert!(new.contains("| a | octree | 250 ms | 12 | 381 ns (10x) | 10.0 ns (10x) |"), "{new}");
        assert!(new.contains("Since <!-- = age -->2026-11-27, commit 1234567<!-- . -->."), "{new}");
        assert_eq!(data().renew(&new).unwrap(), new);
        assert_eq!(unknown(&new), [""; 0]);
        assert!(data().renew("<!-- = b octree 10x -->1<!-- . -->").is_err());
    }

    #[test]
    fn figures_without_data_are_found() {
        let text = "It takes 12\nns per query.\n\n`12 ns` is code.\n\nAnd 3.5x as fast, in 12%.\n\nFour of 64 points.\n\n12 s <!--cited-->\n";
        assert_eq!(unknown(text), ["2: 12 ns", "6: 3.5x"]);
    }
}
