//! The column with the names of objects in tables.

use crate::scene::{Object, object_of};
use p2m_core::PrimitiveId;
use std::io::{self, Write};

/// The objects of a scene. If there are none, tables have no column of names.
#[derive(Debug, Default)]
pub(super) struct Names(Vec<Object>);

impl Names {
    pub(super) fn new(objects: &[Object]) -> Self {
        Self(objects.to_vec())
    }

    /// Returns the header of a table with these columns, followed by the column of names.
    pub(super) fn header(&self, columns: &str) -> String {
        if self.0.is_empty() { columns.to_owned() } else { format!("{columns},object") }
    }

    /// Ends the line of an answer with the name of the object that the primitive belongs to.
    pub(super) fn end_line(&self, out: &mut dyn Write, primitive: Option<PrimitiveId>) -> io::Result<()> {
        if self.0.is_empty() {
            return writeln!(out);
        }
        match primitive.and_then(|id| object_of(&self.0, id)) {
            None => writeln!(out, ","),
            Some(object) => writeln!(out, ",{}", field(&object.name)),
        }
    }
}

/// Returns a name as a field of a table, on one line and in quotes if that is necessary.
fn field(name: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let is_plain = !name.contains(['"', ',', ';']) && name.trim() == name;
    if is_plain { name } else { format!("\"{}\"", name.replace('"', "\"\"")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_any_characters_are_one_field() {
        for (name, expected) in [
            ("tube", "tube"),
            ("left arm", "left arm"),
            ("a,b", "\"a,b\""),
            ("5'11\" bolt", "\"5'11\"\" bolt\""),
            ("two\nlines\r", "\"two lines \""),
            ("é;\u{7}", "\"é; \""),
        ] {
            assert_eq!(field(name), expected);
        }
    }
}
