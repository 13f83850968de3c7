//! The reader of text tables, in files of points and rays and in clouds.

use super::row::Row;
use crate::parse::text::{LineReader, Tokens, is_space, parse_number, quote, trim};
use crate::{FileLocation, ReadError, Reason};
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

/// Calls a function for each row of a table. What its records look like, the first of them decides.
pub(crate) fn for_each_row<R: Row<N>, const N: usize>(
    reader: impl BufRead,
    name: &str,
    mut take: impl FnMut(R) -> Result<(), Reason>,
) -> Result<(), ReadError> {
    let mut lines = LineReader::new(reader, 0);
    let mut head = Head::default();
    let mut layout = None;
    let mut count = 0;
    loop {
        let result = match lines.read() {
            Ok(true) => head.record(&mut layout, lines.bytes()).and_then(|row| {
                row.map_or(Ok(()), |row| {
                    count += 1;
                    take(row)
                })
            }),
            Ok(false) => match head.announced.filter(|&announced| announced != count) {
                Some(announced) => Err(Reason::RowCount { announced, found: count }),
                None => return Ok(()),
            },
            Err(error) => Err(Reason::Io(error)),
        };
        result.map_err(|reason| ReadError::new(name, FileLocation::Line(lines.line()), reason))?;
    }
}

/// The content of the lines before the first row.
#[derive(Default)]
struct Head {
    /// The number of rows, if a line has it.
    announced: Option<u64>,
    /// The separator that a line `sep=` names.
    separator: Option<u8>,
    /// Comments that may have the names of the columns.
    comments: Vec<Vec<u8>>,
}

/// The largest number of comments before the first row that may have the names of the columns.
const MAX_COMMENTS: usize = 64;

/// The separator of fields, and the columns of the numbers.
type Layout<const N: usize> = (Separator, [usize; N]);

impl Head {
    /// Returns the row of a line, if it has one. The first row decides the layout.
    fn record<R: Row<N>, const N: usize>(
        &mut self,
        layout: &mut Option<Layout<N>>,
        line: &[u8],
    ) -> Result<Option<R>, Reason> {
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
        let (separator, columns) = match *layout {
            Some(layout) => layout,
            None => {
                let Some((found, is_header)) = self.layout::<R, N>(line)? else { return Ok(None) };
                *layout = Some(found);
                if is_header {
                    return Ok(None);
                }
                found
            }
        };
        match separator {
            Separator::Byte(separator) => {
                // A first field may be empty where tabs separate.
                let fields = split(line, separator).ok_or(Reason::BadRecord)?;
                row(columns.map(|column| fields.get(column).copied())).map(Some)
            }
            Separator::Blanks => {
                let mut fields = [None; N];
                let mut tokens = Tokens::new(line);
                let last = columns.iter().max().map_or(0, |last| last + 1);
                for at in 0..last {
                    let Some(token) = tokens.next() else { break };
                    fields
                        .iter_mut()
                        .zip(columns)
                        .filter(|(_, column)| *column == at)
                        .for_each(|(f, _)| *f = Some(token));
                }
                row(fields).map(Some)
            }
        }
    }

    /// Returns the layout of the records, and whether the first one is a header; `None` for a line before it.
    fn layout<R: Row<N>, const N: usize>(&mut self, line: &[u8]) -> Result<Option<(Layout<N>, bool)>, Reason> {
        let text = trim(line);
        if let [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', separator] = *text {
            self.separator = Some(separator);
            return Ok(None);
        }
        if self.announced.is_none()
            && text.iter().all(u8::is_ascii_digit)
            && let Ok(count) = parse_count(text)
        {
            self.announced = Some(count);
            return Ok(None);
        }
        let separator = self.separator.map_or_else(|| separator(line.trim_ascii_end(), N), Separator::Byte);
        let fields = fields(line, separator)?;
        let is_header = !fields.iter().take(N).any(|field| is_like_number(field));
        if is_header {
            return named_columns::<R, N>(&fields).map(|columns| Some(((separator, columns), true)));
        }
        // A comment names the columns if it names as many as there are.
        for names in &self.comments {
            if let Ok(names) = self::fields(trim(names), separator)
                && names.len() == fields.len()
                && let Some(columns) = coordinates::<R, N>(&names)
            {
                return Ok(Some(((separator, columns), false)));
            }
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
        Ok(Some(((separator, std::array::from_fn(|column| column)), false)))
    }
}

fn parse_count(digits: &[u8]) -> Result<u64, Reason> {
    let bad = || Reason::BadNumber { text: quote(digits) };
    std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok()).ok_or_else(bad)
}

/// Returns what separates the fields of a first record with at least `count` fields.
fn separator(line: &[u8], count: usize) -> Separator {
    // A text after the numbers may have other separators.
    let mut tokens = Tokens::new(line);
    let is_number = |token: Option<&[u8]>| token.is_some_and(|token| parse_number(token).is_ok());
    let has_numbers = (0..count).all(|_| is_number(tokens.next()));
    if let (false, Some(byte)) = (has_numbers, [b';', b','].into_iter().find(|byte| line.contains(byte))) {
        return Separator::Byte(byte);
    }
    // Names have blanks, as in `X [m]`, and numbers have none.
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

/// Returns whether a field starts like a number, such as `1D0` or `0,5`. It is then no name, and causes an error where
/// it is a number in a form that is not supported.
fn is_like_number(field: &[u8]) -> bool {
    matches!(field.first(), Some(b'0'..=b'9' | b'+' | b'-' | b'.')) || parse_number(field).is_ok() // `nan`
}

fn row<R: Row<N>, const N: usize>(fields: [Option<&[u8]>; N]) -> Result<R, Reason> {
    let mut numbers = [0.0; N];
    for (k, field) in fields.into_iter().enumerate() {
        match field {
            None => return Err(R::too_few(k)),
            Some(field) => numbers[k] = parse_number(field)?,
        }
    }
    R::new(numbers)
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

/// Returns the columns with the names of coordinates.
fn coordinates<R: Row<N>, const N: usize>(names: &[&[u8]]) -> Option<[usize; N]> {
    R::COLUMNS.iter().find_map(|expected| {
        let columns = expected.map(|n| names.iter().position(|f| first_word(f).eq_ignore_ascii_case(n.as_bytes())));
        columns.iter().all(Option::is_some).then(|| columns.map(Option::unwrap_or_default))
    })
}

/// Returns the columns of the coordinates among the names of a header.
fn named_columns<R: Row<N>, const N: usize>(names: &[&[u8]]) -> Result<[usize; N], Reason> {
    match coordinates::<R, N>(names) {
        Some(columns) => Ok(columns),
        None if names.len() < N => Err(R::too_few(names.len())),
        None => {
            let names = names.iter().take(MAX_LISTED_COLUMNS).map(|f| quote(f)).collect();
            Err(Reason::UnknownColumns { names, expected: R::EXPECTED_COLUMNS })
        }
    }
}

/// Returns the name of a column without a unit after it.
fn first_word(field: &[u8]) -> &[u8] {
    let end = field.iter().position(|b| b.is_ascii_whitespace() || matches!(b, b'[' | b'('));
    &field[..end.unwrap_or(field.len())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    fn table<R: Row<N>, const N: usize>(text: &str) -> Result<Vec<R>, String> {
        crate::points::read::read(text.as_bytes(), crate::PointFormat::Csv, "q.csv").map_err(|e| e.to_string())
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
        assert_eq!(points("x,y\n").unwrap_err(), "q.csv:1: a point needs 3 coordinates, found 2");
    }

    #[test]
    fn columns_with_other_names_are_no_coordinates() {
        let names = "they may be named qx, qy, qz or x, y, z (or like 'X [m]') or Points:0, Points:1, Points:2";
        for header in ["id,easting,northing,height", "time,x,y", "longitude,latitude,height"] {
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
