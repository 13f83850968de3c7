//! The reader of text tables, in files of points and rays and in clouds.

use super::PointColumns;
use super::row::Row;
use crate::parse::text::{LineReader, Tokens, is_space, parse_number, quote, trim};
use crate::{FileLocation, ReadError, Reason, Unit};
use std::io::BufRead;

/// The largest number of columns that a message lists.
const MAX_LISTED_COLUMNS: usize = 16;

/// The separator of the fields of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    /// A single byte, such as a comma.
    Byte(u8),
    /// Any number of blanks and tabs.
    Blanks,
}

/// The unit of a table, and whether its points are planar.
#[derive(Default)]
pub(crate) struct TableNotes {
    /// The unit in the name of the first coordinate, as in `X [mm]`.
    pub(crate) unit: Option<Unit>,
    /// Whether points have two coordinates.
    pub(crate) is_flat: bool,
}

/// Calls a function for each row of a table, with its id. The first record determines the layout of all records.
pub(crate) fn for_each_row<R: Row<N>, const N: usize>(
    reader: impl BufRead,
    name: &str,
    chosen: &PointColumns,
    mut take: impl FnMut(R, Option<&[u8]>) -> Result<(), Reason>,
) -> Result<TableNotes, ReadError> {
    let mut lines = LineReader::new(reader, 0);
    let mut head = Head { chosen, announced: None, separator: None, comments: Vec::new() };
    let mut layout = None;
    let mut count = 0;
    loop {
        let result = match lines.read() {
            Ok(true) => head.record(&mut layout, count, lines.bytes()).and_then(|row| {
                row.map_or(Ok(()), |(row, id)| {
                    count += 1;
                    take(row, id)
                })
            }),
            Ok(false) => match head.announced.filter(|&announced| announced != count) {
                Some(announced) => Err(Reason::RowCount { announced, found: count }),
                None => {
                    let notes = |layout: Layout<N>| TableNotes { unit: layout.unit, is_flat: layout.is_flat() };
                    return Ok(layout.map(notes).unwrap_or_default());
                }
            },
            Err(error) => Err(Reason::Io(error)),
        };
        result.map_err(|reason| ReadError::new(name, FileLocation::Line(lines.line()), reason))?;
    }
}

/// A row, and its id if there are ids.
type RowAndId<'a, R> = (R, Option<&'a [u8]>);

/// The lines before the first row, and the columns that the caller chose.
struct Head<'a> {
    chosen: &'a PointColumns,
    /// The number of rows, if a line announces it. A file of several scans has such a line before each scan.
    announced: Option<u64>,
    /// The separator that a line `sep=` names.
    separator: Option<u8>,
    /// Comments that may have the names of the columns.
    comments: Vec<Vec<u8>>,
}

/// The largest number of comments before the first row that may have the names of the columns.
const MAX_COMMENTS: usize = 64;

/// The positions of the numbers and the id in a record.
#[derive(Clone, Copy)]
struct Layout<const N: usize> {
    separator: Separator,
    /// The column of each number. A number without a column is 0.
    columns: [Option<usize>; N],
    /// The column of the id.
    id: Option<usize>,
    /// Whether the columns have no names.
    is_unnamed: bool,
    unit: Option<Unit>,
}

impl<const N: usize> Layout<N> {
    fn is_flat(&self) -> bool {
        self.columns.contains(&None)
    }

    /// Parses a record into a row and its id.
    fn row<'a, R: Row<N>>(&self, line: &'a [u8]) -> Result<RowAndId<'a, R>, Reason> {
        let (mut fields, mut id) = ([None; N], None);
        let mut place = |at: usize, field: &'a [u8]| {
            fields.iter_mut().zip(self.columns).filter(|(_, c)| *c == Some(at)).for_each(|(f, _)| *f = Some(field));
            id = if self.id == Some(at) { Some(field) } else { id };
        };
        // In a table of two columns, a third number would be a height that is silently ignored.
        let is_exact = self.is_unnamed && self.is_flat();
        let count = match self.separator {
            Separator::Byte(separator) => {
                // With a separator such as a tab, the first field may be empty.
                let all = split(line, separator).ok_or(Reason::BadRecord)?;
                all.iter().enumerate().for_each(|(at, field)| place(at, field));
                all.len()
            }
            Separator::Blanks => {
                let mut tokens = Tokens::new(line);
                let last = self.columns.iter().chain([&self.id]).flatten().max().map_or(0, |last| last + 1);
                let wanted = last + usize::from(is_exact);
                (0..wanted).map_while(|at| tokens.next().map(|token| place(at, token))).count()
            }
        };
        if is_exact && count > 2 {
            return Err(Reason::ColumnCount { found: count });
        }
        let mut numbers = [0.0; N];
        for (k, (number, field)) in numbers.iter_mut().zip(fields).enumerate() {
            match field {
                Some(field) => *number = parse_number(field)?,
                None if self.columns[k].is_some() => return Err(R::too_few(k)),
                None => {}
            }
        }
        Ok((R::new(numbers)?, self.id.map(|_| id.unwrap_or_default())))
    }
}

impl Head<'_> {
    /// Parses a line into a row and its id, if it has a row. The first row determines the layout.
    fn record<'a, R: Row<N>, const N: usize>(
        &mut self,
        layout: &mut Option<Layout<N>>,
        count: u64,
        line: &'a [u8],
    ) -> Result<Option<RowAndId<'a, R>>, Reason> {
        let text = trim(line);
        let comment = text.strip_prefix(b"#").or_else(|| text.strip_prefix(b"//"));
        if text.is_empty() || comment.is_some() {
            if let (Some(names), None) = (comment, layout.as_ref())
                && self.comments.len() < MAX_COMMENTS
            {
                self.comments.push(names.to_vec());
            }
            return Ok(None);
        }
        if (layout.is_none() && self.announced.is_none() || self.announced.is_some_and(|n| n == count && n > 0))
            && text.iter().all(u8::is_ascii_digit)
            && let Ok(more) = parse_count(text)
        {
            self.announced = Some(count.saturating_add(more));
            return Ok(None);
        }
        if layout.is_none() {
            let Some((found, is_header)) = self.layout::<R, N>(line)? else { return Ok(None) };
            *layout = Some(found);
            if is_header {
                return Ok(None);
            }
        }
        layout.map(|layout| layout.row(line)).transpose()
    }

    /// Determines the layout of the records from the first one. Returns it with whether that record is a header, or
    /// `None` if the line comes before the records.
    ///
    /// The first of these rules that applies decides: columns that the caller chose, by name or number; the names in
    /// the first record, if none of its first fields looks like a number; the names in a comment with as many words;
    /// and otherwise the first columns of the table.
    fn layout<R: Row<N>, const N: usize>(&mut self, line: &[u8]) -> Result<Option<(Layout<N>, bool)>, Reason> {
        let text = trim(line);
        if let [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', separator] = *text {
            self.separator = Some(separator);
            return Ok(None);
        }
        let separator = self.separator.map_or_else(|| separator(line.trim_ascii_end(), N), Separator::Byte);
        let fields = fields(line, separator)?;
        let chosen = &self.chosen.coordinates;
        let numbered = chosen.iter().map(|name| column_number(name)).collect::<Option<Vec<_>>>();
        let is_header = match &numbered {
            Some(columns) if !columns.is_empty() => {
                !columns.iter().filter_map(|at| fields.get(*at)).any(|field| is_like_number(field))
            }
            _ => !fields.iter().take(N).any(|field| is_like_number(field)),
        };
        // A comment has the names of the columns if it has as many words as there are columns.
        let comments = self.comments.iter().filter_map(|names| self::fields(trim(names), separator).ok());
        let names = if is_header { Some(fields.clone()) } else { None };
        let mut candidates = names.into_iter().chain(comments.filter(|names| names.len() == fields.len()));
        let layout = |columns: [Option<usize>; N], names: &[&[u8]], is_unnamed: bool| -> Result<_, Reason> {
            let is_id = |name: &&[u8]| first_word(name).eq_ignore_ascii_case(b"id");
            let id = match &self.chosen.id {
                Some(id) => Some(column(id, names)?),
                None => names.iter().position(is_id).filter(|_| !is_unnamed),
            };
            let unit = columns[0].filter(|_| !is_unnamed).and_then(|at| unit(names[at]));
            Ok(Layout { separator, columns, id, is_unnamed, unit })
        };
        if !chosen.is_empty() {
            if chosen.len() != N && (R::FLAT.is_empty() || chosen.len() + 1 != N) {
                return Err(R::too_few(chosen.len()));
            }
            let (names, is_unnamed) = candidates.next().map_or((fields.clone(), true), |names| (names, false));
            let mut columns = [None; N];
            for (at, name) in columns.iter_mut().zip(chosen) {
                *at = Some(column(name, &names)?);
            }
            let mut layout = layout(columns, &names, is_unnamed)?;
            layout.is_unnamed = false; // The caller names them.
            return Ok(Some((layout, is_header)));
        }
        if is_header {
            let columns = named_columns::<R, N>(&fields)?;
            return Ok(Some((layout(columns, &fields, false)?, true)));
        }
        if let Some((columns, names)) = candidates.find_map(|names| Some((coordinates::<R, N>(&names, &[])?, names))) {
            return Ok(Some((layout(columns, &names, false)?, false)));
        }
        // Surveyors write a number before the coordinates, and a code after them.
        let is_number = |field: &&[u8]| parse_number(field).is_ok();
        if fields.len() > N + 1
            && fields[0].iter().all(u8::is_ascii_digit)
            && fields[..=N].iter().all(is_number)
            && !is_number(&fields[N + 1])
        {
            return Err(Reason::UnnamedColumns { found: fields.len() });
        }
        let is_flat = !R::FLAT.is_empty() && fields.len() == 2;
        let columns = std::array::from_fn(|column| (!is_flat || column < 2).then_some(column));
        Ok(Some((layout(columns, &fields, true)?, false)))
    }
}

/// Parses the number of a column, counted from 1, and returns its index from 0.
fn column_number(name: &str) -> Option<usize> {
    name.parse::<usize>().ok()?.checked_sub(1)
}

/// Returns the index of a column, given by its name or its number from 1.
fn column(name: &str, names: &[&[u8]]) -> Result<usize, Reason> {
    let is_named = |field: &&[u8]| {
        field.eq_ignore_ascii_case(name.as_bytes()) || first_word(field).eq_ignore_ascii_case(name.as_bytes())
    };
    let found = column_number(name).filter(|at| *at < names.len()).or_else(|| names.iter().position(is_named));
    found.ok_or_else(|| Reason::NoSuchColumn { name: name.to_owned(), names: listed(names) })
}

/// Returns the unit in brackets in the name of a column, as in `X [mm]`.
fn unit(name: &[u8]) -> Option<Unit> {
    let (_, rest) = std::str::from_utf8(name).ok()?.split_once(['[', '('])?;
    Unit::named(rest.split([']', ')']).next()?.trim())
}

/// Returns the names of columns as a message lists them.
fn listed(names: &[&[u8]]) -> Vec<String> {
    names.iter().take(MAX_LISTED_COLUMNS).map(|name| quote(name)).collect()
}

fn parse_count(digits: &[u8]) -> Result<u64, Reason> {
    let bad = || Reason::BadNumber { text: quote(digits) };
    std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok()).ok_or_else(bad)
}

/// Guesses the separator of the fields of a first record, which has at least `count` fields.
fn separator(line: &[u8], count: usize) -> Separator {
    // If the record starts with numbers between blanks, other separators can only be in a text after them.
    let mut tokens = Tokens::new(line);
    let is_number = |token: Option<&[u8]>| token.is_some_and(|token| parse_number(token).is_ok());
    let has_numbers = (0..count).all(|_| is_number(tokens.next()));
    if let (false, Some(byte)) = (has_numbers, [b';', b','].into_iter().find(|byte| line.contains(byte))) {
        return Separator::Byte(byte);
    }
    // Names may have blanks, as in `X [m]`, but numbers have none. A field of several numbers means that tabs only
    // align.
    let is_mixed = |field: &[u8]| field.is_empty() || (is_like_number(field) && field.contains(&b' '));
    let has_tabs = line.contains(&b'\t') && !line.split(|&b| b == b'\t').any(|field| is_mixed(trim(field)));
    if has_tabs { Separator::Byte(b'\t') } else { Separator::Blanks }
}

/// Returns the fields of a record.
fn fields(text: &[u8], separator: Separator) -> Result<Vec<&[u8]>, Reason> {
    match separator {
        Separator::Byte(separator) => split(text, separator).ok_or(Reason::BadRecord),
        Separator::Blanks => {
            let mut tokens = Tokens::new(text);
            Ok(std::iter::from_fn(|| tokens.next()).collect())
        }
    }
}

/// Returns whether a field starts like a number, such as `1D0` or `0,5`. Such a field is not a name. If the field is
/// used, a number in an unsupported form is then an error.
fn is_like_number(field: &[u8]) -> bool {
    matches!(field.first(), Some(b'0'..=b'9' | b'+' | b'-' | b'.')) || parse_number(field).is_ok() // `nan`
}

/// Splits a record into fields, without blanks and quotes around them. Returns `None` if a quote is not closed.
///
/// A quote opens only at the start of a field; elsewhere it is a character like any other, as in `5'11"`. A quote that
/// is doubled inside of quotes stays doubled, because numbers and names of columns have none.
fn split(line: &[u8], delimiter: u8) -> Option<Vec<&[u8]>> {
    let mut fields = Vec::new();
    let (mut quoted, mut started) = (false, false);
    let ends = line.split(|&b| {
        if quoted {
            // The field counts as not started after a closing quote, so the second of two quotes opens it again.
            (quoted, started) = (b != b'"', b != b'"' && started);
            return false;
        }
        if b == delimiter {
            started = false;
            return true;
        }
        quoted = b == b'"' && !started;
        started |= !is_space(b);
        false
    });
    for field in ends {
        let field = trim(field);
        let inner = field.strip_prefix(b"\"").and_then(|f| f.strip_suffix(b"\""));
        fields.push(inner.map_or(field, trim));
    }
    (!quoted).then_some(fields)
}

/// Returns the columns named like all coordinates, or else like the two coordinates of an entry of `flat`.
fn coordinates<R: Row<N>, const N: usize>(names: &[&[u8]], flat: &[[&'static str; 2]]) -> Option<[Option<usize>; N]> {
    let find = |n: &str| names.iter().position(|f| first_word(f).eq_ignore_ascii_case(n.as_bytes()));
    let all = R::COLUMNS.iter().map(|names| &names[..]).chain(flat.iter().map(|names| &names[..]));
    let mut found = all.map(|expected| expected.iter().map(|name| find(name)).collect::<Vec<_>>());
    let columns = found.find(|columns| columns.iter().all(Option::is_some))?;
    Some(std::array::from_fn(|k| columns.get(k).copied().flatten()))
}

/// Returns the columns of the coordinates by the names in a header.
fn named_columns<R: Row<N>, const N: usize>(names: &[&[u8]]) -> Result<[Option<usize>; N], Reason> {
    match coordinates::<R, N>(names, R::FLAT) {
        Some(columns) => Ok(columns),
        None if names.len() < N => Err(R::too_few(names.len())),
        None => Err(Reason::UnknownColumns { names: listed(names), expected: R::EXPECTED_COLUMNS }),
    }
}

/// Returns the name of a column without the unit that follows it.
fn first_word(field: &[u8]) -> &[u8] {
    let end = field.iter().position(|b| b.is_ascii_whitespace() || matches!(b, b'[' | b'('));
    &field[..end.unwrap_or(field.len())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PointTable;
    use nalgebra::Point3;

    fn table<R: Row<N>, const N: usize>(text: &str) -> Result<Vec<R>, String> {
        let columns = PointColumns::default();
        let read = crate::points::read::read(text.as_bytes(), crate::PointFormat::Csv, "q.csv", &columns);
        Ok(read.map_err(|e| e.to_string())?.rows)
    }

    /// Reads the points in chosen columns, with their ids.
    fn chosen(text: &str, coordinates: &[&str], id: Option<&str>) -> Result<(PointTable, Vec<String>), String> {
        let columns = PointColumns {
            coordinates: coordinates.iter().map(|&name| name.to_owned()).collect(),
            id: id.map(str::to_owned),
        };
        let read = crate::read_point_table_from(text.as_bytes(), crate::PointFormat::Csv, "q.csv", &columns);
        let table = read.map_err(|e| e.to_string())?;
        let ids = table.ids.iter().flat_map(|ids| (0..ids.len()).map(|i| ids.get(i).unwrap().to_owned())).collect();
        Ok((table, ids))
    }

    fn points(text: &str) -> Result<Vec<[f64; 3]>, String> {
        Ok(table::<Point3<f64>, 3>(text)?.into_iter().map(|p| p.coords.into()).collect())
    }

    const TWO: [[f64; 3]; 2] = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];

    #[test]
    fn blanks_separate_the_columns_of_every_line_with_data() {
        let text = "\u{feff}# head\n1 2 3\r\n\n  // more\n\t-4e-1\t5 6 7 8 colour\n0 0 1e300";
        assert_eq!(points(text).unwrap(), [[1.0, 2.0, 3.0], [-0.4, 5.0, 6.0], [0.0, 0.0, 1e300]]);
        assert_eq!(points("").unwrap(), [] as [[f64; 3]; 0]);
    }

    #[test]
    fn the_first_record_decides_the_separator() {
        for text in [
            "1,2,3\n4,5,6\n",
            "1;2;3;name, with comma\n4;5;6",
            "1 2 3 name, with comma\n4 5 6",
            "1\t2\t3\n4\t5\t6\n",
            "\t1 2\t3\n4 5 6\n",
            "sep=;\nx;y;z\n1;2;3\n4;5;6\n",
            "\u{feff}X,Y,Z\r\n1,2,3\r\n\r\n4,5,6\r\n",
            "X Y Z R G B\n1 2 3 9 9 9\n4 5 6 9 9 9\n",
            "id\tX [m]\tY [m]\tZ [m]\n9\t1\t2\t3\n\t4\t5\t6\n",
            "# made by hand\n\nname,Qz,qy,QX,x,y,z\na,3,2,1,9,9,9\n\"b, or \"\"c\"\"\",6,5,4,9,9,9\n",
            "\"1\", \"2\", \"3\"\n  \n# between\n4 ,5 ,6\n",
        ] {
            assert_eq!(points(text).unwrap(), TWO, "{text}");
        }
        assert_eq!(points("x,y,z\n").unwrap(), [] as [[f64; 3]; 0]);
        // An empty cell of a table with tabs does not move those after it.
        assert_eq!(points("x\ty\tz\n1\t\t3\t7\n").unwrap_err(), "q.csv:2: '' is not a number that fits here");
    }

    #[test]
    fn a_number_before_the_rows_is_their_count() {
        for text in ["2\n1 2 3 255\n4 5 6 0\n", "//X;Y;Z\n2\n1;2;3\n4;5;6\n", "2\nx,y,z\n1,2,3\n4,5,6\n"] {
            assert_eq!(points(text).unwrap(), TWO, "{text}");
        }
        let error = points("3\n1 2 3\n4 5 6\n").unwrap_err();
        assert_eq!(error, "q.csv:4: the first line announces 3 rows, but there are 2");
        assert_eq!(points("5\n6\n").unwrap_err(), "q.csv:2: a point needs 3 coordinates, found 1");
    }

    #[test]
    fn comments_may_name_the_columns() {
        for text in ["# time x y z\n9 1 2 3\n9 4 5 6\n", "//Z;Y;X\n3;2;1\n6;5;4\n", "#x y z\n# a b c\n1 2 3\n4 5 6"] {
            assert_eq!(points(text).unwrap(), TWO, "{text}");
        }
        // Other comments name nothing.
        assert_eq!(points("# the x y z of it\n1 2 3 9\n4 5 6 9\n").unwrap(), TWO);
    }

    #[test]
    fn errors_have_the_line() {
        assert_eq!(points("1 2 3\n\n1 2\n").unwrap_err(), "q.csv:3: a point needs 3 coordinates, found 2");
        assert_eq!(points("1 2 x\n").unwrap_err(), "q.csv:1: 'x' is not a number that fits here");
        assert_eq!(points("x,y,z\n1,2,3\n1,2\n").unwrap_err(), "q.csv:3: a point needs 3 coordinates, found 2");
        assert_eq!(points("1,2,3\n\n# so\n1,b,3\n").unwrap_err(), "q.csv:4: 'b' is not a number that fits here");
        assert_eq!(points("1,2,b\n").unwrap_err(), "q.csv:1: 'b' is not a number that fits here");
        assert_eq!(points("x,y,z\n1,,3\n").unwrap_err(), "q.csv:2: '' is not a number that fits here");
        assert_eq!(points("1,2,3,\"a\"\"\n").unwrap_err(), "q.csv:1: a quote is not closed on this line");
        assert_eq!(points("1,2,3,\"a\n").unwrap_err(), "q.csv:1: a quote is not closed on this line");
    }

    #[test]
    fn points_need_not_be_finite_and_rays_do() {
        for text in [
            "1 2 3\nnan nan -inf\n4 5 1e999\n",
            "1,2,3\nnan,nan,-inf\n4,5,1e999\n",
            "x;y;z\n1;2;3\nNaN;nan;-inf\n4;5;inf",
        ] {
            let points = points(text).unwrap();
            assert_eq!((points[0], points[1][2], points[2][2]), (TWO[0], f64::NEG_INFINITY, f64::INFINITY), "{text}");
            assert!(points[1][..2].iter().all(|x| x.is_nan()), "{text}");
        }
        assert!(table::<p2m_core::Ray, 6>("0 0 nan 1 0 0\n").unwrap_err().starts_with("q.csv:1: "));
    }

    #[test]
    fn names_of_columns() {
        for header in
            ["id,X [m],Y [m],Z [m]", "t;x(mm);y(mm);z(mm)", "a,Points:0,Points:1,Points:2", "\"no, so\",x,Y,z"]
        {
            let row = if header.contains(';') { "9;1;2;3" } else { "9,1,2,3" };
            assert_eq!(points(&format!("{header}\n{row}\n")).unwrap(), [[1.0, 2.0, 3.0]], "{header}");
        }
        assert_eq!(points("x\n").unwrap_err(), "q.csv:1: a point needs 3 coordinates, found 1");
        assert_eq!(points("id,Easting,Northing,Height\n9,1,2,3\n").unwrap(), [[1.0, 2.0, 3.0]]);
    }

    #[test]
    fn two_coordinates_mean_that_z_is_zero() {
        for text in ["1 2\n4 5\n", "1;2\n4;5\n", "y,x\n2,1\n5,4\n", "id\tx\ty\na\t1\t2\nb\t4\t5\n"] {
            let (table, _) = chosen(text, &[], None).unwrap();
            assert!(table.is_flat, "{text}");
            assert_eq!(table.points, [Point3::new(1.0, 2.0, 0.0), Point3::new(4.0, 5.0, 0.0)], "{text}");
        }
        assert!(!chosen("1 2 3\n", &[], None).unwrap().0.is_flat);
        // A height that only later rows have is not ignored, and one that is missing is not 0.
        assert_eq!(points("1 2\n1 2 3\n").unwrap_err(), "q.csv:2: the first row has 2 columns, but this one has 3");
        assert_eq!(points("x,y,z\n1,2\n").unwrap_err(), "q.csv:2: a point needs 3 coordinates, found 2");
        assert_eq!(table::<p2m_core::Ray, 6>("0 0\n").unwrap_err(), "q.csv:1: a ray needs 6 coordinates, found 2");
    }

    #[test]
    fn ids_come_with_the_points() {
        let text = "id,x,y,z\nA 1,1,2,3\n\"b,c\",4,5,6\n,7,8,9\n";
        assert_eq!(chosen(text, &[], None).unwrap().1, ["A 1", "b,c", ""]);
        assert_eq!(chosen("1 2 3 n7\n4 5 6\n", &[], Some("4")).unwrap().1, ["n7", ""]);
        assert_eq!(chosen("# id x y z\n7 1 2 3\n", &[], None).unwrap().1, ["7"]);
        assert!(chosen("1 2 3 4\n", &[], None).unwrap().0.ids.is_none());
    }

    #[test]
    fn columns_can_be_chosen() {
        let text = "nr,lon,lat,alt (ft),code\nP7,10,20,30,X\n";
        let (table, ids) = chosen(text, &["LON", "lat", "4"], Some("nr")).unwrap();
        assert_eq!((table.points.as_slice(), ids), (&[Point3::new(10.0, 20.0, 30.0)][..], vec!["P7".to_owned()]));
        assert!(chosen(text, &["lon", "lat"], None).unwrap().0.is_flat);
        let (table, ids) = chosen("P7 1 2 3\nP8 4 5 6\n", &["2", "3", "4"], Some("1")).unwrap();
        assert_eq!((table.points.len(), ids), (2, vec!["P7".to_owned(), "P8".to_owned()]));
        let error = chosen(text, &["lon", "lat", "height"], None).unwrap_err();
        assert_eq!(error, "q.csv:1: there is no column 'height' among nr, lon, lat, alt (ft), code");
        assert_eq!(chosen("1 2\n", &["1", "2", "3"], None).unwrap_err(), "q.csv:1: there is no column '3' among 1, 2");
        assert_eq!(chosen(text, &["lon"], None).unwrap_err(), "q.csv:1: a point needs 3 coordinates, found 1");
    }

    #[test]
    fn names_of_columns_have_the_unit() {
        let unit = |text: &str| chosen(text, &[], None).unwrap().0.unit;
        assert_eq!(unit("X [mm],Y [mm],Z [mm]\n1,2,3\n"), Some(Unit::Millimetre));
        assert_eq!((unit("x(ft) y z\n1 2 3\n"), unit("x,y,z\n")), (Some(Unit::Foot), None));
    }

    #[test]
    fn files_of_several_scans_count_each() {
        assert_eq!(points("1\n1 2 3\n1\n4 5 6\n").unwrap(), TWO);
        let error = points("1\n1 2 3\n2\n4 5 6\n").unwrap_err();
        assert_eq!(error, "q.csv:5: the first line announces 3 rows, but there are 2");
    }

    #[test]
    fn columns_with_other_names_are_no_coordinates() {
        let names = "they may be named qx, qy, qz or x, y[, z] (or like 'X [m]') or Points:0 to Points:2 or easting, \
                     northing[, height]";
        for header in ["id,east,north,height", "time,x,r,phi", "longitude,latitude,height"] {
            let listed = header.replace(',', ", ");
            let expected = format!("q.csv:1: no coordinates among the columns {listed}; {names}");
            assert_eq!(points(&format!("{header}\n10,0.5,0.25,1\n")).unwrap_err(), expected);
            assert_eq!(points(&format!("{}\n10 0.5 0.25 1\n", header.replace(',', " "))).unwrap_err(), expected);
        }
        let error = table::<p2m_core::Ray, 6>("t,ox,oy,oz,dx,dy\n1,2,3,4,5,6\n").unwrap_err();
        assert!(error.starts_with("q.csv:1: no coordinates among the columns t, ox"), "{error}");
    }

    #[test]
    fn a_number_of_the_point_is_no_coordinate() {
        for text in ["17,4,5,6,POLE\n", "17 4.5 5 6 POLE\n", "17\t4\t5\t6\tPOLE\n"] {
            assert!(points(text).unwrap_err().starts_with("q.csv:1: the first of the 5 columns may be the number"));
        }
        // Coordinates with an intensity and a label, which have names or a fraction, are none.
        for text in ["x,y,z,i,label\n1,2,3,6,POLE\n", "1.0,2,3,6,POLE\n", "1,2,3,6\n", "1,2,3,POLE\n"] {
            assert_eq!(points(text).unwrap(), [TWO[0]], "{text}");
        }
    }

    #[test]
    fn numbers_in_other_forms_are_no_header() {
        assert_eq!(points("1D0,2D0,3D0\n1,2,3\n").unwrap_err(), "q.csv:1: '1D0' is not a number that fits here");
        assert_eq!(points("\n1,5;2,5;3,5\n").unwrap_err(), "q.csv:2: '1,5' is not a number that fits here");
        assert_eq!(points("1,5 2,5 3,5\n").unwrap_err(), "q.csv:1: '5 2' is not a number that fits here");
        assert_eq!(points("a,b,-x\n").unwrap_err(), "q.csv:1: 'a' is not a number that fits here");
    }

    #[test]
    fn quotes_open_at_the_start_of_a_field() {
        assert_eq!(points("1,2,3,5'11\"\n4,5,6,\"a\"\"b,c\"\n").unwrap(), TWO);
        assert_eq!(points("name,x,y,z\n6\",1,2,3\n \"a,b\" ,4,5,6\n").unwrap(), TWO);
    }

    #[test]
    fn lines_may_end_in_a_return_alone() {
        assert_eq!(points("1 2 3\r4 5 6\r").unwrap(), TWO);
        assert_eq!(points("x,y,z\r1,2,3\r4,5,6").unwrap(), TWO);
        assert_eq!(points("1 2 3\r\r4 5\r").unwrap_err(), "q.csv:3: a point needs 3 coordinates, found 2");
    }
}
