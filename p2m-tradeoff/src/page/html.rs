//! A writer of HTML that closes every tag and escapes every text.

use crate::plot::escaped;

/// The largest number of bytes of a cell that stays on one line.
const MAX_ONE_LINE_BYTES: usize = 40;

/// A page or a part of a page.
#[derive(Default)]
pub(super) struct Html {
    out: String,
}

impl Html {
    /// Writes an element with text.
    pub(super) fn text(&mut self, tag: &str, text: &str) {
        self.within(tag, "", |html| html.out.push_str(&escaped(text)));
    }

    /// Writes an element around the content that `write` writes. Attributes are not escaped.
    pub(super) fn within(&mut self, tag: &str, attributes: &str, write: impl FnOnce(&mut Self)) {
        let space = if attributes.is_empty() { "" } else { " " };
        self.out.push_str(&format!("<{tag}{space}{attributes}>"));
        write(self);
        // A line break after these elements would be a space within a sentence.
        let end = if tag == "code" || tag == "a" { "" } else { "\n" };
        self.out.push_str(&format!("</{tag}>{end}"));
    }

    /// Writes a paragraph. Parts in backticks become code.
    pub(super) fn paragraph(&mut self, text: &str) {
        self.within("p", "", |html| html.words(text));
    }

    /// Writes a list of terms with their meanings.
    pub(super) fn terms<'a>(&mut self, terms: impl IntoIterator<Item = (&'a str, &'a str)>) {
        self.within("dl", "", |html| {
            for (name, meaning) in terms {
                html.text("dt", name);
                html.within("dd", "", |html| html.words(meaning));
            }
        });
    }

    /// Writes text without an element. Parts in backticks become code.
    pub(super) fn words(&mut self, text: &str) {
        for (i, part) in text.split('`').enumerate() {
            if i % 2 == 1 {
                self.text("code", part);
            } else {
                self.out.push_str(&escaped(part));
            }
        }
    }

    /// Writes a table. The first `names` columns are names, and all others are figures.
    pub(super) fn table(&mut self, head: &[&str], names: usize, rows: &[Vec<String>]) {
        let class = |i: usize| if i < names { "class=\"name\"" } else { "" };
        self.within("div", "class=\"wide\"", |html| {
            html.within("table", "", |html| {
                html.within("thead", "", |html| {
                    html.within("tr", "", |html| {
                        for (i, name) in head.iter().enumerate() {
                            html.within("th", class(i), |html| html.out.push_str(&escaped(name)));
                        }
                    });
                });
                html.within("tbody", "", |html| {
                    for row in rows {
                        html.within("tr", "", |html| {
                            for (i, cell) in row.iter().enumerate() {
                                // Long cells have words, and may have several lines.
                                let class = if cell.len() > MAX_ONE_LINE_BYTES { "class=\"long\"" } else { class(i) };
                                html.within("td", class, |html| html.out.push_str(&escaped(cell)));
                            }
                        });
                    }
                });
            });
        });
    }

    /// Writes a picture with its caption.
    pub(super) fn figure(&mut self, svg: &str, caption: &str) {
        self.within("figure", "", |html| {
            html.out.push_str(&inlined(svg));
            html.text("figcaption", caption);
        });
    }

    /// Writes style or markup without escaping it.
    pub(super) fn raw(&mut self, text: &str) {
        self.out.push_str(text);
    }

    /// Returns the page.
    pub(super) fn finish(self) -> String {
        self.out
    }
}

/// Prepares a picture for a page: removes the name space, default attributes and invisible elements.
fn inlined(svg: &str) -> String {
    let visible = svg.lines().filter(|line| !line.contains(" opacity=\"0\"")).map(|line| line.to_owned() + "\n");
    let defaults = [
        " xmlns=\"http://www.w3.org/2000/svg\"",
        " opacity=\"1\"",
        " stroke-width=\"1\"",
        " font-family=\"sans-serif\"",
        " fill=\"#000000\"",
    ];
    defaults.iter().fold(visible.collect(), |svg: String, words| svg.replace(words, ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_lose_nothing_that_is_seen() {
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\">\n<line opacity=\"0\" x1=\"3\"/>\n<text opacity=\"1\">\na\n</text>\n</svg>\n";
        assert_eq!(inlined(svg), "<svg>\n<text>\na\n</text>\n</svg>\n");
    }

    #[test]
    fn texts_are_escaped_and_tags_closed() {
        let mut html = Html::default();
        html.paragraph("a < b & `c > d`");
        html.table(&["x", "\"y\""], 1, &[vec!["<1>".to_owned(), "2".to_owned()]]);
        let text = html.finish();
        assert!(text.starts_with("<p>a &lt; b &amp; <code>c &gt; d</code></p>"), "{text}");
        for cell in ["<td class=\"name\">&lt;1&gt;</td>", "<th>&quot;y&quot;</th>"] {
            assert!(text.contains(cell), "{text}");
        }
    }
}
