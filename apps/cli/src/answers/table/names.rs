//! The column with the names of objects in tables.

use p2m_core::PrimitiveId;
use p2m_mixed::Object;
use p2m_mixed::engine::object_number;

/// The objects of a scene. If there are none, tables have no column of names.
pub(super) struct Names<'a>(pub(super) &'a [Object]);

impl Names<'_> {
    /// Returns the header of a table with these columns, followed by the column of names.
    pub(super) fn header(&self, columns: &str) -> String {
        if self.0.is_empty() { columns.to_owned() } else { format!("{columns},object") }
    }

    /// Writes the name of the object that the primitive belongs to, if there is one.
    pub(super) fn write(&self, out: &mut Vec<u8>, primitive: Option<PrimitiveId>) {
        if let Some(number) = primitive.and_then(|id| self.number(id)) {
            out.extend(field(&self.0[number].name).as_bytes());
        }
    }

    /// Returns the number of the object that the primitive belongs to.
    pub(super) fn number(&self, primitive: PrimitiveId) -> Option<usize> {
        object_number(self.0, primitive)
    }

    /// Ends the line of a table, with a column of names if there are objects.
    pub(super) fn end_line(&self, out: &mut Vec<u8>, primitive: Option<PrimitiveId>) {
        if !self.0.is_empty() {
            out.push(b',');
            self.write(out, primitive);
        }
        out.push(b'\n');
    }
}

/// Returns a name as a field of a table, on one line and in quotes if that is necessary.
pub(super) fn field(name: &str) -> String {
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
