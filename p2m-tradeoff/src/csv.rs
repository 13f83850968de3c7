//! Comma-separated values, the format of records.

/// Joins fields to a line of a comma-separated file. Fields are quoted where necessary.
#[must_use]
pub fn csv_line(fields: &[String]) -> String {
    let quoted = |field: &String| {
        if field.contains([',', '"', '\n']) { format!("\"{}\"", field.replace('"', "\"\"")) } else { field.clone() }
    };
    fields.iter().map(quoted).collect::<Vec<_>>().join(",")
}

/// Parses a comma-separated text into records of unquoted fields. Returns `None` if a quote does not end, or ends
/// within a field.
#[must_use]
pub fn csv_records(text: &str) -> Option<Vec<Vec<String>>> {
    let mut records = Vec::new();
    let mut record = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let (field, after) = match rest.strip_prefix('"') {
            Some(quoted) => quoted_field(quoted)?,
            None => {
                let end = rest.find([',', '\n']).unwrap_or(rest.len());
                (rest[..end].trim_end_matches('\r').to_owned(), &rest[end..])
            }
        };
        record.push(field);
        rest = match after.strip_prefix(',') {
            // A comma at the very end is followed by an empty field.
            Some("") => {
                record.push(String::new());
                ""
            }
            Some(more) => more,
            None => {
                records.push(std::mem::take(&mut record));
                let after = after.strip_prefix('\r').unwrap_or(after);
                if after.is_empty() { "" } else { after.strip_prefix('\n')? }
            }
        };
    }
    if !record.is_empty() {
        records.push(record);
    }
    Some(records)
}

/// Returns a field without its quotes, and the text after it. `text` begins after the opening quote.
fn quoted_field(text: &str) -> Option<(String, &str)> {
    let mut field = String::new();
    let mut rest = text;
    loop {
        let end = rest.find('"')?;
        field.push_str(&rest[..end]);
        rest = &rest[end + 1..];
        match rest.strip_prefix('"') {
            Some(more) => {
                field.push('"');
                rest = more;
            }
            None => return Some((field, rest)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strings(fields: &[&str]) -> Vec<String> {
        fields.iter().map(|field| (*field).to_owned()).collect()
    }

    #[test]
    fn fields_with_commas_and_quotes_are_quoted() {
        assert_eq!(csv_line(&strings(&["a", "b,c", "d\"e"])), "a,\"b,c\",\"d\"\"e\"");
    }

    #[test]
    fn what_is_written_is_read_back() {
        let lines = [strings(&["a", "b,c", "d\"e", ""]), strings(&["", "1\n2", "\"", "x"])];
        let text: String = lines.iter().map(|fields| csv_line(fields) + "\n").collect();
        assert_eq!(csv_records(&text).unwrap(), lines);
        assert_eq!(csv_records("a,b\r\n\"c\",\r\nd,").unwrap(), [["a", "b"], ["c", ""], ["d", ""]]);
        assert!(csv_records("").unwrap().is_empty());
        for broken in ["\"a", "\"a\"b,c"] {
            assert!(csv_records(broken).is_none(), "{broken}");
        }
    }
}
