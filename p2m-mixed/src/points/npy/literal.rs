//! Parser of the Python literals that describe an array.

use std::fmt;

/// The deepest nesting of a literal. Descriptions of arrays are less nested.
const MAX_DEPTH: usize = 16;

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value<'a> {
    /// The bytes between quotes. Escape sequences are kept, because the names that are searched for have none.
    Text(&'a [u8]),
    /// A natural number. Numbers beyond the range do not occur in descriptions.
    Integer(u64),
    Boolean(bool),
    Tuple(Vec<Value<'a>>),
    List(Vec<Value<'a>>),
    Dictionary(Vec<(Value<'a>, Value<'a>)>),
}

impl fmt::Display for Value<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |f: &mut fmt::Formatter<'_>, items: &[Value<'_>]| {
            for (i, item) in items.iter().enumerate() {
                write!(f, "{}{item}", if i > 0 { ", " } else { "" })?;
            }
            Ok(())
        };
        match self {
            Self::Text(text) => write!(f, "'{}'", crate::parse::text::quote(text)),
            Self::Integer(n) => write!(f, "{n}"),
            Self::Boolean(b) => f.write_str(if *b { "True" } else { "False" }),
            Self::Tuple(items) => {
                f.write_str("(")?;
                list(f, items)?;
                f.write_str(if items.len() == 1 { ",)" } else { ")" })
            }
            Self::List(items) => {
                f.write_str("[")?;
                list(f, items)?;
                f.write_str("]")
            }
            Self::Dictionary(_) => f.write_str("{..}"),
        }
    }
}

/// Parses a literal. The error is the rest of the text from where parsing failed.
pub(super) fn parse(text: &[u8]) -> Result<Value<'_>, &[u8]> {
    let mut parser = Parser { rest: text };
    match parser.value(0) {
        Some(value) if parser.peek().is_none() => Ok(value),
        _ => Err(parser.rest),
    }
}

struct Parser<'a> {
    rest: &'a [u8],
}

impl<'a> Parser<'a> {
    /// Returns the next byte after white space.
    fn peek(&mut self) -> Option<u8> {
        self.rest = self.rest.trim_ascii_start();
        self.rest.first().copied()
    }

    fn accept(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        if found {
            self.rest = &self.rest[1..];
        }
        found
    }

    fn value(&mut self, depth: usize) -> Option<Value<'a>> {
        if depth > MAX_DEPTH {
            return None;
        }
        let value = |parser: &mut Self| parser.value(depth + 1);
        let entry = |parser: &mut Self| {
            let key = value(parser)?;
            parser.accept(b':').then(|| value(parser)).flatten().map(|value| (key, value))
        };
        match self.peek()? {
            quote @ (b'\'' | b'"') => self.text(quote),
            b'0'..=b'9' => self.integer(),
            b'(' => {
                let (mut items, has_comma) = self.items(*b"()", value)?;
                if items.len() == 1 && !has_comma { items.pop() } else { Some(Value::Tuple(items)) }
            }
            b'[' => Some(Value::List(self.items(*b"[]", value)?.0)),
            b'{' => Some(Value::Dictionary(self.items(*b"{}", entry)?.0)),
            _ => [("True", true), ("False", false)].into_iter().find_map(|(word, value)| {
                self.rest = self.rest.strip_prefix(word.as_bytes())?;
                Some(Value::Boolean(value))
            }),
        }
    }

    fn text(&mut self, quote: u8) -> Option<Value<'a>> {
        let inner = &self.rest[1..];
        let mut is_escaped = false;
        let end = inner.iter().position(|&b| {
            let ends = b == quote && !is_escaped;
            is_escaped = b == b'\\' && !is_escaped;
            ends
        })?;
        self.rest = &inner[end + 1..];
        Some(Value::Text(&inner[..end]))
    }

    fn integer(&mut self) -> Option<Value<'a>> {
        let digits = self.rest.iter().take_while(|b| b.is_ascii_digit()).count();
        let (number, rest) = self.rest.split_at(digits);
        let number = std::str::from_utf8(number).ok()?.parse().ok()?;
        self.rest = rest.strip_prefix(b"L").unwrap_or(rest); // Python 2 writes a suffix `L`
        Some(Value::Integer(number))
    }

    /// Parses a tuple, or a value in parentheses.
    /// Parses items between brackets, and returns them and whether a comma follows the last one.
    fn items<T>(&mut self, [open, close]: [u8; 2], item: impl Fn(&mut Self) -> Option<T>) -> Option<(Vec<T>, bool)> {
        self.accept(open);
        let mut items = Vec::new();
        let mut has_comma = false;
        while !self.accept(close) {
            if !items.is_empty() && !has_comma {
                return None;
            }
            items.push(item(self)?);
            has_comma = self.accept(b',');
        }
        Some((items, has_comma))
    }
}
