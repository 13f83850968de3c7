//! Lines of comma-separated files.

/// Joins fields to a line of a comma-separated file. Fields are quoted where necessary.
#[must_use]
pub fn csv_line(fields: &[String]) -> String {
    let quoted = |field: &String| {
        if field.contains([',', '"', '\n']) { format!("\"{}\"", field.replace('"', "\"\"")) } else { field.clone() }
    };
    fields.iter().map(quoted).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_with_commas_and_quotes_are_quoted() {
        let fields = ["a", "b,c", "d\"e", "1\n2", ""].map(str::to_owned);
        let line = csv_line(&fields);
        assert_eq!(line, "a,\"b,c\",\"d\"\"e\",\"1\n2\",");
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
        assert_eq!(reader.records().next().unwrap().unwrap(), fields.to_vec());
    }
}
