//! Fills the placeholders of a page.

use anyhow::{Result, bail};

/// Replaces each `{{name}}` of the page by its value. A placeholder without a value, or a value without a placeholder,
/// is an error.
pub(super) fn filled(page: &str, values: &[(&str, String)]) -> Result<String> {
    let mut out = page.to_owned();
    for (name, value) in values {
        let mark = format!("{{{{{name}}}}}");
        if !out.contains(&mark) {
            bail!("the page has no {mark}");
        }
        out = out.replace(&mark, value.trim_end());
    }
    match out.find("{{") {
        Some(at) => bail!("nothing stands for {}", out[at..].lines().next().unwrap_or_default()),
        None => Ok(out),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_has_a_value_and_a_place() {
        let value = |name: &'static str| (name, format!("[{name}]\n"));
        let page = "a {{one}} and {{two}}, {{one}}.";
        assert_eq!(filled(page, &[value("one"), value("two")]).unwrap(), "a [one] and [two], [one].");
        assert!(filled(page, &[value("one")]).unwrap_err().to_string().contains("{{two}}"));
        assert!(filled(page, &[value("one"), value("two"), value("three")]).is_err());
    }
}
