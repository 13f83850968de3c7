//! Lines, tokens and numbers of text files.
//!
//! A token is a run of bytes without white space. Everything is read as bytes, because names and comments need not be
//! UTF-8.

use crate::Reason;
use crate::parse::blocks::Source;
use crate::parse::bytes::fill_buffer;
use memchr::{memchr2, memchr2_iter, memrchr2};
use std::io::{self, BufRead};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The largest number of bytes of a line, see [`set_max_line_bytes`].
static MAX_LINE_BYTES: AtomicUsize = AtomicUsize::new(1 << 26);

/// Sets the largest number of bytes of a line, or of a statement of several lines, in the text files that this process
/// reads from now on. The default of 64 MiB keeps a file without line ends from filling the memory.
pub fn set_max_line_bytes(bytes: usize) {
    MAX_LINE_BYTES.store(bytes, Ordering::Relaxed);
}

/// The length in bytes above which a quoted text is shortened.
const MAX_QUOTED_BYTES: usize = 40;

/// Returns `bytes` as a message quotes them: short, printable and on one line.
pub(crate) fn quote(bytes: &[u8]) -> String {
    if bytes.len() > MAX_QUOTED_BYTES {
        format!("{}..", bytes[..MAX_QUOTED_BYTES].escape_ascii())
    } else {
        bytes.escape_ascii().to_string()
    }
}

/// Parses a number, which may be NaN or infinite. A number beyond the range of f64 becomes infinite.
pub(crate) fn parse_number(token: &[u8]) -> Result<f64, Reason> {
    fast_float2::parse(token).map_err(|_| Reason::BadNumber { text: quote(token) })
}

/// Parses the number at the start of `text`, which ends at a blank or at the end of the text, and returns it with the
/// bytes after it.
pub(crate) fn parse_number_at_start(text: &[u8]) -> Option<(f64, &[u8])> {
    let (number, length) = fast_float2::parse_partial(text).ok()?;
    let rest = &text[length..];
    rest.first().is_none_or(|&b| is_space(b)).then_some((number, rest))
}

/// Parses a finite number.
pub(crate) fn parse_finite(token: &[u8]) -> Result<f64, Reason> {
    parse_number(token).and_then(|x| if x.is_finite() { Ok(x) } else { Err(Reason::NonFinite { text: quote(token) }) })
}

/// Parses a decimal integer with an optional sign. An integer beyond the range of i64 saturates, which is harmless
/// because no index is that large.
pub(crate) fn parse_integer(token: &[u8]) -> Result<i64, Reason> {
    let (negative, digits) = match token {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, token),
    };
    let (mut value, mut is_decimal) = (0, !digits.is_empty());
    for digit in digits {
        is_decimal &= digit.is_ascii_digit();
        let digit = i64::from(digit & 0xf);
        // Eighteen digits do not overflow.
        value =
            if digits.len() <= 18 { 10 * value + digit } else { i64::saturating_mul(value, 10).saturating_add(digit) };
    }
    match (is_decimal, negative) {
        (false, _) => Err(Reason::BadNumber { text: quote(token) }),
        (true, false) => Ok(value),
        (true, true) => Ok(-value),
    }
}

/// Returns the text without white space around it.
pub(crate) fn trim(bytes: &[u8]) -> &[u8] {
    let start = bytes.iter().position(|&b| !is_space(b)).unwrap_or(bytes.len());
    let end = bytes.iter().rposition(|&b| !is_space(b)).map_or(start, |last| last + 1);
    &bytes[start..end]
}

pub(crate) fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c)
}

/// Returns the line of `bytes` that begins at `start`, without its end, and the start of the next one.
pub(crate) fn line_end(bytes: &[u8], start: usize) -> (&[u8], usize) {
    let end = memchr2(b'\n', b'\r', &bytes[start..]).map_or(bytes.len(), |length| start + length);
    let is_pair = bytes[end..].starts_with(b"\r\n");
    (&bytes[start..end], (end + 1 + usize::from(is_pair)).min(bytes.len()))
}

/// Counts the lines of a text that ends with a line end.
pub(crate) fn count_lines(bytes: &[u8]) -> u64 {
    let is_end = |&at: &usize| bytes[at] == b'\n' || bytes.get(at + 1) != Some(&b'\n');
    memchr2_iter(b'\n', b'\r', bytes).filter(is_end).count() as u64
}

/// Returns the length of the part of `bytes` up to its last line end, or 0. A `\r` at the end of `bytes` does not
/// count, because a `
/// ` may follow.
pub(crate) fn last_line_end(bytes: &[u8]) -> usize {
    // A `\n` may follow a `\r`.
    let certain = bytes.strip_suffix(b"\r").unwrap_or(bytes);
    memrchr2(b'\n', b'\r', certain).map_or(0, |at| at + 1)
}

/// Reads bytes up to and including the first one that `find` finds, but at most `max_count`. Appends them to `buffer`
/// and returns their number.
pub(crate) fn read_until(
    reader: &mut impl BufRead,
    find: impl Fn(&[u8]) -> Option<usize>,
    max_count: usize,
    buffer: &mut Vec<u8>,
) -> io::Result<usize> {
    let mut read = 0;
    while read < max_count {
        let bytes = fill_buffer(reader)?;
        let bytes = &bytes[..bytes.len().min(max_count - read)];
        let end = find(bytes);
        let take = end.map_or(bytes.len(), |end| end + 1);
        buffer.extend_from_slice(&bytes[..take]);
        reader.consume(take);
        read += take;
        if end.is_some() || take == 0 {
            break;
        }
    }
    Ok(read)
}

/// Iterates over the tokens of a statement, which may extend over several lines.
pub(crate) struct Tokens<'a> {
    bytes: &'a [u8],
    /// The start of the last token.
    start: usize,
    /// The end of the last token.
    end: usize,
}

impl<'a> Tokens<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, start: 0, end: 0 }
    }

    #[inline]
    pub(crate) fn next(&mut self) -> Option<&'a [u8]> {
        let mut start = self.end;
        while start < self.bytes.len() && is_space(self.bytes[start]) {
            start += 1;
        }
        let mut end = start;
        while end < self.bytes.len() && !is_space(self.bytes[end]) {
            end += 1;
        }
        (self.start, self.end) = (start, end);
        (start < end).then(|| &self.bytes[start..end])
    }

    /// Returns the bytes after the last token.
    pub(crate) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.end..]
    }

    /// Ends the statement at the start of a comment.
    pub(crate) fn end_at_comment(&mut self) {
        if let Some(at) = self.bytes[self.end..].iter().position(|&b| b == b'#') {
            self.bytes = &self.bytes[..self.end + at];
        }
    }

    /// Returns the line of the last token, counted from the first line of the statement.
    pub(crate) fn line_offset(&self) -> u64 {
        self.bytes[..self.start].iter().filter(|&&b| b == b'\n').count() as u64
    }
}

/// Reads a text line by line into one buffer. A line ends at `\n`, `\r\n` or, as on old Macs, `\r`.
pub(crate) struct LineReader<R> {
    reader: R,
    buffer: Vec<u8>,
    /// The number of the first line in `buffer`, counted from 1.
    line: u64,
    /// The number of the next line.
    next: u64,
    /// Whether the last line ended at `\r`, so that a following `\n` belongs to the same line end.
    after_return: bool,
    /// The number of bytes that were read.
    read: u64,
}

impl<R: BufRead> LineReader<R> {
    /// `lines_before` is the number of lines that were read from `reader` before.
    pub(crate) fn new(reader: R, lines_before: u64) -> Self {
        Self { reader, buffer: Vec::new(), line: lines_before, next: lines_before + 1, after_return: false, read: 0 }
    }

    /// Returns the number of the first line of the statement that was read last.
    pub(crate) fn line(&self) -> u64 {
        self.line
    }

    /// Returns the statement that was read last.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.buffer
    }

    /// Returns the reader, positioned after the line that was read last, and the number of bytes before that position.
    pub(crate) fn into_reader(mut self) -> io::Result<(R, u64)> {
        self.end_line()?;
        Ok((self.reader, self.read))
    }

    /// Reads the next line and returns `false` at the end of the text.
    pub(crate) fn read(&mut self) -> std::io::Result<bool> {
        self.buffer.clear();
        self.line = self.next;
        self.append()
    }

    /// Ends the line at the start of a comment.
    pub(crate) fn end_at_comment(&mut self) {
        if let Some(at) = self.buffer.iter().position(|&b| b == b'#') {
            self.buffer.truncate(at);
        }
    }

    /// Reads the next statement of a text in which a backslash at the end of a line continues the statement.
    ///
    /// The lines of a statement are joined by a newline. A backslash does not continue a comment, because a comment may
    /// end with a path name that ends in a backslash.
    pub(crate) fn read_continued(&mut self) -> std::io::Result<bool> {
        if !self.read()? {
            return Ok(false);
        }
        let mut start = 0;
        while self.buffer.last() == Some(&b'\\') && !self.buffer[start..].contains(&b'#') {
            self.buffer.pop();
            self.buffer.push(b'\n');
            start = self.buffer.len();
            if !self.append()? {
                break;
            }
        }
        Ok(true)
    }

    /// Skips the second byte of a line end. This is done before the next line is read rather than after `\r`, so that a
    /// line of an interactive input can be used before the next one arrives.
    fn end_line(&mut self) -> io::Result<()> {
        if std::mem::take(&mut self.after_return) && fill_buffer(&mut self.reader)?.first() == Some(&b'\n') {
            self.reader.consume(1);
            self.read += 1;
        }
        Ok(())
    }

    /// Appends the next line without its end.
    fn append(&mut self) -> std::io::Result<bool> {
        self.end_line()?;
        let start = self.buffer.len();
        let limit = MAX_LINE_BYTES.load(Ordering::Relaxed);
        let is_end = |bytes: &[u8]| memchr2(b'\n', b'\r', bytes);
        match read_until(&mut self.reader, is_end, limit.saturating_sub(start).saturating_add(1), &mut self.buffer)? {
            0 => return Ok(false),
            read => self.read += read as u64,
        }
        if self.buffer.len() > limit && is_end(&self.buffer[start..]).is_none() {
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("a line has more than {limit} bytes")));
        }
        if self.next == 1 && self.buffer.starts_with(b"\xef\xbb\xbf") {
            self.buffer.drain(..3); // the byte order mark of UTF-8
        }
        self.next += 1;
        if let Some(end @ (b'\n' | b'\r')) = self.buffer[start..].last() {
            self.after_return = *end == b'\r';
            self.buffer.pop();
        }
        Ok(true)
    }
}

impl<R: BufRead> LineReader<Source<R>> {
    /// Returns the reader and the number of lines before its position, for reading blocks of lines.
    pub(crate) fn blocks(&mut self) -> (&mut Source<R>, u64) {
        if let Err(error) = self.end_line() {
            self.reader.return_error(error);
        }
        (&mut self.reader, self.next - 1)
    }

    /// Notes that lines were read from [`Self::blocks`].
    pub(crate) fn skip_lines(&mut self, lines: u64, bytes: u64) {
        self.next += lines;
        self.read += bytes;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    #[test]
    fn words_know_their_line_across_continuations() {
        let mut lines = LineReader::new("\u{feff}a b\\\r\n c\\\nd # e\\\nf\\".as_bytes(), 0);
        assert!(lines.read_continued().unwrap());
        let mut tokens = Tokens::new(lines.bytes());
        tokens.end_at_comment();
        let mut seen = Vec::new();
        while let Some(token) = tokens.next() {
            seen.push((token.to_vec(), lines.line() + tokens.line_offset()));
        }
        assert_eq!(seen, [(b"a".to_vec(), 1), (b"b".to_vec(), 1), (b"c".to_vec(), 2), (b"d".to_vec(), 3)]);
        assert!(lines.read_continued().unwrap());
        assert_eq!((lines.bytes(), lines.line()), (&b"f\n"[..], 4));
        assert!(!lines.read_continued().unwrap());
    }

    #[test]
    fn lines_end_in_three_ways() {
        let text = "a\r\nb\rc\nd\r\re\r\n\nf\r";
        let expected = ["a", "b", "c", "d", "", "e", "", "f"];
        // A buffer of one byte never holds both `\r` and `\n`.
        for capacity in [1, 2, 100] {
            let mut lines = LineReader::new(std::io::BufReader::with_capacity(capacity, text.as_bytes()), 0);
            let mut seen = Vec::new();
            while lines.read().unwrap() {
                seen.push(String::from_utf8(lines.bytes().to_vec()).unwrap());
                assert_eq!(lines.line(), seen.len() as u64);
            }
            assert_eq!(seen, expected);
        }
    }

    #[test]
    fn integers_have_a_sign_at_most_and_saturate() {
        assert_eq!(parse_integer(b"-12").unwrap(), -12);
        assert_eq!(parse_integer(b"+7").unwrap(), 7);
        assert_eq!(parse_integer(b"99999999999999999999").unwrap(), i64::MAX);
        for bad in [&b""[..], b"-", b"1.0", b"0x1", b"--1", b"1e3"] {
            assert!(matches!(parse_integer(bad), Err(Reason::BadNumber { .. })), "{bad:?}");
        }
    }

    #[test]
    fn numbers_are_those_of_the_standard_library() {
        let mut rng = p2m_testkit::rng("numbers of text", 0);
        for _ in 0..200_000 {
            let length = rng.random_range(0..12);
            let mut token: Vec<u8> =
                (0..length).map(|_| b"0123456789+-.eEinfatyNI_x "[rng.random_range(0..26)]).collect();
            if rng.random_bool(0.5) {
                token = format!("{}{:?}", ["", "-", "+"][rng.random_range(0..3)], f64::from_bits(rng.random())).into();
            }
            if rng.random_bool(0.1) {
                token = ["inf", "NaN", "Infinity", "+inf", "-nan"][rng.random_range(0..5)].into();
            }
            let expected = std::str::from_utf8(&token).ok().and_then(|s| s.parse::<f64>().ok());
            let found = parse_number(&token).ok();
            assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits), "{}", quote(&token));
            // Only a token is followed by a blank.
            if !token.contains(&b' ') {
                let line = [&token[..], b" 7"].concat();
                let at_start = parse_number_at_start(&line);
                assert_eq!(at_start.map(|(x, _)| x.to_bits()), expected.map(f64::to_bits), "{}", quote(&token));
                assert!(at_start.is_none_or(|(_, rest)| rest == b" 7"));
            }
        }
    }

    #[test]
    fn numbers_that_are_not_finite_and_invalid_numbers_have_different_errors() {
        assert_eq!(parse_finite(b"-1.5e3").unwrap(), -1500.0);
        for bad in ["nan", "inf", "-Infinity", "1e999"] {
            assert!(matches!(parse_finite(bad.as_bytes()), Err(Reason::NonFinite { .. })), "{bad}");
        }
        for bad in [&b""[..], b"x", b"1,5", b"1.#QNAN", b"\xff"] {
            assert!(matches!(parse_finite(bad), Err(Reason::BadNumber { .. })), "{bad:?}");
        }
    }
}
