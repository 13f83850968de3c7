//! Readers of text tables: XYZ and CSV.

use super::row::Row;
use crate::parse::text::{LineReader, Tokens, parse_finite, parse_number, quote};
use crate::{FileLocation, ReadError, Reason};
use std::io::BufRead;

pub(super) fn read_xyz<R: Row<N>, const N: usize>(reader: impl BufRead, name: &str) -> Result<Vec<R>, ReadError> {
    let mut lines = LineReader::new(reader, 0);
    let mut rows = Vec::new();
    loop {
        match lines.read() {
            Ok(true) => {}
            Ok(false) => return Ok(rows),
            Err(e) => return Err(ReadError::new(name, FileLocation::Line(lines.line()), Reason::Io(e))),
        }
        let mut tokens = Tokens::new(lines.bytes());
        let Some(first) = tokens.next() else { continue };
        if first.starts_with(b"#") || first.starts_with(b"//") {
            continue;
        }
        let mut fields = [Some(first); N];
        fields[1..].fill_with(|| tokens.next());
        match row(fields) {
            Ok(row) => rows.push(row),
            Err(reason) => {
                let reason = match reason {
                    Reason::BadNumber { text } if text.contains([',', ';']) => Reason::SeparatorInNumber { text },
                    other => other,
                };
                return Err(ReadError::new(name, FileLocation::Line(lines.line()), reason));
            }
        }
    }
}

fn row<R: Row<N>, const N: usize>(fields: [Option<&[u8]>; N]) -> Result<R, Reason> {
    let mut numbers = [0.0; N];
    for (k, field) in fields.into_iter().enumerate() {
        match field {
            None => return Err(R::too_few(k)),
            Some(field) => numbers[k] = parse_finite(field)?,
        }
    }
    R::new(numbers)
}

pub(super) fn read_csv<R: Row<N>, const N: usize>(reader: impl BufRead, name: &str) -> Result<Vec<R>, ReadError> {
    let mut lines = LineReader::new(reader, 0);
    let mut format = None;
    let mut rows = Vec::new();
    loop {
        let fail = |line, reason| Err(ReadError::new(name, FileLocation::Line(line), reason));
        match lines.read() {
            Ok(true) => {}
            Ok(false) => return Ok(rows),
            Err(e) => return fail(lines.line(), Reason::Io(e)),
        }
        let line = lines.bytes().trim_ascii();
        if line.is_empty() || line.starts_with(b"#") {
            continue;
        }
        let (delimiter, columns) = match format {
            Some(format) => format,
            None => {
                let delimiter = if line.contains(&b';') { b';' } else { b',' };
                let Some(fields) = split(line, delimiter) else { return fail(lines.line(), Reason::BadRecord) };
                let (columns, is_header) = match header::<R, N>(&fields) {
                    Ok(header) => header,
                    Err(reason) => return fail(lines.line(), reason),
                };
                format = Some((delimiter, columns));
                if is_header {
                    continue;
                }
                (delimiter, columns)
            }
        };
        let Some(fields) = split(line, delimiter) else { return fail(lines.line(), Reason::BadRecord) };
        match row(columns.map(|c| fields.get(c).copied())) {
            Ok(row) => rows.push(row),
            Err(reason) => return fail(lines.line(), reason),
        }
    }
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
        started |= !b.is_ascii_whitespace();
        false
    });
    for field in ends {
        let field = field.trim_ascii();
        let inner = field.strip_prefix(b"\"").and_then(|f| f.strip_suffix(b"\""));
        fields.push(inner.map_or(field, <[u8]>::trim_ascii));
    }
    (!quoted).then_some(fields)
}

/// Returns the columns of the coordinates, and whether the first record is a header.
fn header<R: Row<N>, const N: usize>(fields: &[&[u8]]) -> Result<([usize; N], bool), Reason> {
    for names in R::COLUMNS {
        let columns = names.map(|n| fields.iter().position(|f| first_word(f).eq_ignore_ascii_case(n.as_bytes())));
        if columns.iter().all(Option::is_some) {
            return Ok((columns.map(Option::unwrap_or_default), true));
        }
    }
    // A field that starts like a number, such as `1D0` or `0,5`, is not a name. It is a number in a form that is not
    // supported, so the record is read as data and causes an error.
    let like_number = |field: &[u8]| {
        matches!(field.first(), Some(b'0'..=b'9' | b'+' | b'-' | b'.')) || parse_number(field).is_ok() // `nan`
    };
    let is_header = !fields.iter().take(N).any(|f| like_number(f));
    if is_header && fields.len() > N {
        let names = fields.iter().take(MAX_LISTED_COLUMNS).map(|f| quote(f)).collect();
        return Err(Reason::UnknownColumns { names, expected: R::EXPECTED_COLUMNS });
    }
    if is_header && fields.len() < N {
        return Err(R::too_few(fields.len()));
    }
    Ok((std::array::from_fn(|column| column), is_header))
}

/// The largest number of columns that a message lists.
const MAX_LISTED_COLUMNS: usize = 16;

/// Returns the name of a column without a unit after it.
fn first_word(field: &[u8]) -> &[u8] {
    let end = field.iter().position(|b| b.is_ascii_whitespace() || matches!(b, b'[' | b'('));
    &field[..end.unwrap_or(field.len())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    fn xyz(text: &str) -> Result<Vec<[f64; 3]>, String> {
        let points: Vec<Point3<f64>> = read_xyz(text.as_bytes(), "q.xyz").map_err(|e| e.to_string())?;
        Ok(points.into_iter().map(|p| p.coords.into()).collect())
    }

    fn csv(text: &str) -> Result<Vec<[f64; 3]>, String> {
        let points: Vec<Point3<f64>> = read_csv(text.as_bytes(), "q.csv").map_err(|e| e.to_string())?;
        Ok(points.into_iter().map(|p| p.coords.into()).collect())
    }

    #[test]
    fn xyz_takes_three_columns_of_every_line_with_data() {
        let text = "\u{feff}# head\n1 2 3\r\n\n  // more\n\t-4e-1\t5 6 7 8 colour\n0 0 1e300";
        assert_eq!(xyz(text).unwrap(), [[1.0, 2.0, 3.0], [-0.4, 5.0, 6.0], [0.0, 0.0, 1e300]]);
        assert_eq!(xyz("").unwrap(), [] as [[f64; 3]; 0]);
    }

    #[test]
    fn xyz_errors_have_the_line() {
        assert_eq!(xyz("1 2 3\n\n1 2\n").unwrap_err(), "q.xyz:3: a point needs 3 coordinates, found 2");
        assert_eq!(xyz("1 2 x\n").unwrap_err(), "q.xyz:1: 'x' is not a number that fits here");
        assert_eq!(xyz("1 2 3\n1 nan 3").unwrap_err(), "q.xyz:2: coordinate 'nan' is not finite");
        assert_eq!(xyz("1 2 3\n1 2 1e999").unwrap_err(), "q.xyz:2: coordinate '1e999' is not finite");
    }

    #[test]
    fn csv_finds_its_separator_and_columns() {
        let expected = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
        for text in [
            "1,2,3\n4,5,6\n",
            "1;2;3;name, with comma\n4;5;6",
            "\u{feff}X,Y,Z\r\n1,2,3\r\n\r\n4,5,6\r\n",
            "# made by hand\n\nname,Qz,qy,QX,x,y,z\na,3,2,1,9,9,9\n\"b, or \"\"c\"\"\",6,5,4,9,9,9\n",
            "longitude,latitude,height\n1,2,3\n4,5,6,7\n",
            "\"1\", \"2\", \"3\"\n  \n# between\n4 ,5 ,6\n",
        ] {
            assert_eq!(csv(text).unwrap(), expected, "{text}");
        }
        assert_eq!(csv("x,y,z\n").unwrap(), [] as [[f64; 3]; 0]);
        assert_eq!(csv("").unwrap(), [] as [[f64; 3]; 0]);
    }

    #[test]
    fn csv_errors_have_the_line() {
        assert_eq!(csv("x,y,z\n1,2,3\n1,2\n").unwrap_err(), "q.csv:3: a point needs 3 coordinates, found 2");
        assert_eq!(csv("1,2,3\n\n# so\n1,b,3\n").unwrap_err(), "q.csv:4: 'b' is not a number that fits here");
        assert_eq!(csv("1,2,b\n").unwrap_err(), "q.csv:1: 'b' is not a number that fits here");
        assert_eq!(csv("x,y,z\n1,,3\n").unwrap_err(), "q.csv:2: '' is not a number that fits here");
        assert_eq!(csv("1,2,3,\"a\"\"\n").unwrap_err(), "q.csv:1: a quote is not closed on this line");
        assert_eq!(csv("1,2,3,\"a\n").unwrap_err(), "q.csv:1: a quote is not closed on this line");
        assert_eq!(csv("nan,nan,nan\n").unwrap_err(), "q.csv:1: coordinate 'nan' is not finite");
        assert_eq!(csv("1,2,3\n-inf,0,0\n").unwrap_err(), "q.csv:2: coordinate '-inf' is not finite");
    }

    #[test]
    fn csv_names_of_columns() {
        for header in
            ["id,X [m],Y [m],Z [m]", "t;x(mm);y(mm);z(mm)", "a,Points:0,Points:1,Points:2", "\"no, so\",x,Y,z"]
        {
            let row = if header.contains(';') { "9;1;2;3" } else { "9,1,2,3" };
            assert_eq!(csv(&format!("{header}\n{row}\n")).unwrap(), [[1.0, 2.0, 3.0]], "{header}");
        }
        assert_eq!(
            csv("id,easting,northing,height\n1,2,3,4\n").unwrap_err(),
            "q.csv:1: no coordinates among the columns id, easting, northing, height; they may be named qx, qy, qz or x, \
            y, z (or like 'X [m]') or Points:0, Points:1, Points:2"
        );
        assert_eq!(csv("x,y\n").unwrap_err(), "q.csv:1: a point needs 3 coordinates, found 2");
    }

    #[test]
    fn csv_numbers_in_other_forms_are_no_header() {
        assert_eq!(csv("1D0,2D0,3D0\n1,2,3\n").unwrap_err(), "q.csv:1: '1D0' is not a number that fits here");
        assert_eq!(csv("\n1,5;2,5;3,5\n").unwrap_err(), "q.csv:2: '1,5' is not a number that fits here");
        assert_eq!(csv("a,b,-x\n").unwrap_err(), "q.csv:1: 'a' is not a number that fits here");
    }

    #[test]
    fn csv_quotes_open_at_the_start_of_a_field() {
        assert_eq!(csv("1,2,3,5'11\"\n4,5,6,\"a\"\"b,c\"\n").unwrap(), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!(csv("name,x,y,z\n6\",1,2,3\n \"a,b\" ,4,5,6\n").unwrap(), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    }

    #[test]
    fn lines_may_end_in_a_return_alone() {
        let expected = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
        assert_eq!(xyz("1 2 3\r4 5 6\r").unwrap(), expected);
        assert_eq!(csv("x,y,z\r1,2,3\r4,5,6").unwrap(), expected);
        assert_eq!(xyz("1 2 3\r\r4 5\r").unwrap_err(), "q.xyz:3: a point needs 3 coordinates, found 2");
    }

    #[test]
    fn xyz_with_commas_suggests_csv() {
        for text in ["1,2,3\n", "1, 2, 3\n", "1;2;3\n"] {
            assert!(xyz(text).unwrap_err().contains("should be named .csv"), "{text}");
        }
    }
}
