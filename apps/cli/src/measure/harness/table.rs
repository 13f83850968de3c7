//! Tables as Markdown text with aligned columns.

use std::fmt;

/// A table of text, which is printed as Markdown with aligned columns.
#[derive(Clone, Debug, Default)]
pub struct Table {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Makes a table with these columns and no rows.
    #[must_use]
    pub fn new(head: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { head: head.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// Adds a row. Missing cells are empty.
    pub fn push(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = || std::iter::once(&self.head).chain(&self.rows);
        let cell = |line: &[String], i: usize| line.get(i).cloned().unwrap_or_default();
        let widths: Vec<usize> = (0..self.head.len())
            .map(|i| lines().map(|line| cell(line, i).chars().count()).fold(3, usize::max))
            .collect();
        for (number, line) in lines().enumerate() {
            for (i, width) in widths.iter().enumerate() {
                // The first column has names, which are aligned to the left.
                match i {
                    0 => write!(f, "| {:<width$} ", cell(line, i))?,
                    _ => write!(f, "| {:>width$} ", cell(line, i))?,
                }
            }
            writeln!(f, "|")?;
            if number == 0 {
                for (i, width) in widths.iter().enumerate() {
                    let end = if i == 0 { "-" } else { ":" };
                    write!(f, "|{}{end}", "-".repeat(width + 1))?;
                }
                writeln!(f, "|")?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_and_missing_cells_empty() {
        let mut table = Table::new(["name", "ns"]);
        table.push(vec!["aabb".into(), "12345".into()]);
        table.push(vec!["a".into()]);
        let expected = "| name |    ns |\n|------|------:|\n| aabb | 12345 |\n| a    |       |\n";
        assert_eq!(table.to_string(), expected);
    }
}
