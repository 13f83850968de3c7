//! Tokens of a text as a stream.

use crate::Reason;
use crate::parse::blocks::Source;
use crate::parse::text::{LineReader, is_space};
use std::io::BufRead;

/// Reads the tokens of a text, whatever lines they are on.
pub(crate) struct Tokenizer<R> {
    pub(crate) lines: LineReader<R>,
    /// The end of the last token in the current line.
    at: usize,
    /// Whether `#` starts a comment.
    has_comments: bool,
}

impl<R: BufRead> Tokenizer<R> {
    pub(crate) fn new(lines: LineReader<R>) -> Self {
        Self { lines, at: 0, has_comments: false }
    }

    pub(crate) fn with_comments(lines: LineReader<R>) -> Self {
        Self { has_comments: true, ..Self::new(lines) }
    }

    /// Returns the number of the line that the last token is on.
    pub(crate) fn line(&self) -> u64 {
        self.lines.line()
    }

    /// Returns the next token, on this line or a later one.
    pub(crate) fn next(&mut self) -> Result<&[u8], Reason> {
        loop {
            if let Some(token) = self.find() {
                return Ok(&self.lines.bytes()[token]);
            }
            self.at = 0;
            if !self.lines.read().map_err(Reason::Io)? {
                return Err(Reason::UnexpectedEnd);
            }
            if self.has_comments {
                self.lines.end_at_comment();
            }
        }
    }

    /// Returns the next token on this line.
    pub(crate) fn next_on_line(&mut self) -> Option<&[u8]> {
        self.find().map(|token| &self.lines.bytes()[token])
    }

    fn find(&mut self) -> Option<std::ops::Range<usize>> {
        let bytes = self.lines.bytes();
        let start = self.at + bytes[self.at..].iter().take_while(|&&b| is_space(b)).count();
        let end = start + bytes[start..].iter().take_while(|&&b| !is_space(b)).count();
        self.at = end;
        (start < end).then_some(start..end)
    }

    /// Skips the rest of the text and returns its number of tokens.
    pub(crate) fn skip_rest(&mut self) -> Result<u64, Reason> {
        let mut rest = 0;
        loop {
            match self.next() {
                Ok(_) => rest += 1,
                Err(Reason::UnexpectedEnd) => return Ok(rest),
                Err(reason) => return Err(reason),
            }
        }
    }

    /// Returns the rest of this line.
    pub(crate) fn rest_of_line(&mut self) -> &[u8] {
        let start = std::mem::replace(&mut self.at, self.lines.bytes().len());
        &self.lines.bytes()[start..]
    }
}

impl<R: BufRead> Tokenizer<Source<R>> {
    /// Returns the reader and the number of lines before its position, for reading blocks of lines, if no token is left
    /// on the current line.
    pub(crate) fn blocks(&mut self) -> Option<(&mut Source<R>, u64)> {
        if !self.lines.bytes()[self.at..].iter().all(|&b| is_space(b)) {
            return None;
        }
        self.at = self.lines.bytes().len();
        Some(self.lines.blocks())
    }
}
