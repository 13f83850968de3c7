//! Templates of pages: HTML files with names in double braces, which are replaced by texts.
//!
//! All pages of the project are made of a template, [`STYLE`], a script, and data as JSON that the script reads.

use serde::Serialize;

/// The style that all pages share, for the placeholder of a style element.
pub const STYLE: &str = include_str!("style.css");

/// Replaces each `{{name}}` of a template by the text of that name. The texts are not searched for names, so those that
/// look like a placeholder stay as they are. Time and memory are linear in the length of the result.
///
/// # Panics
/// If the template has a name without a text.
#[must_use]
pub fn fill(template: &str, texts: &[(&str, &str)]) -> String {
    let mut page = String::with_capacity(template.len() + texts.iter().map(|text| text.1.len()).sum::<usize>());
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, after) = after.split_once("}}").expect("a placeholder ends");
        let text = texts.iter().find(|text| text.0 == name);
        page.push_str(before);
        page.push_str(text.unwrap_or_else(|| panic!("no text for {name}")).1);
        rest = after;
    }
    page.push_str(rest);
    page
}

/// Escapes text for use between tags and in attributes.
#[must_use]
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns a value as JSON that can stand in a script element.
///
/// # Errors
/// The errors of [`serde_json::to_string`].
pub fn script_data(value: &impl Serialize) -> serde_json::Result<String> {
    // A script element ends at the first `</script`, even within a string.
    Ok(serde_json::to_string(value)?.replace('<', "\\u003c"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_that_look_like_placeholders_stay() {
        assert_eq!(fill("<{{a}}>{{b}}{{a}}.", &[("a", "{{b}}"), ("b", "1}}")]), "<{{b}}>1}}{{b}}.");
    }

    #[test]
    #[should_panic(expected = "no text for b")]
    fn a_name_without_a_text_is_an_error() {
        let _ = fill("{{a}}{{b}}", &[("a", "")]);
    }

    #[test]
    fn no_text_ends_an_element() {
        assert_eq!(escape("a < \"b\" & c > d"), "a &lt; &quot;b&quot; &amp; c &gt; d");
        assert_eq!(script_data(&["</script>"]).unwrap(), "[\"\\u003c/script>\"]");
    }
}
