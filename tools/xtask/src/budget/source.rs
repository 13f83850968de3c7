//! Source files without comments: how many lines of code and of tests they have, and the names that they make public.

/// A language, with what its comments and strings begin with. Languages with one name are counted together.
struct Language {
    name: &'static str,
    extensions: &'static str,
    line_comment: &'static str,
    block_comment: [&'static str; 2],
    quotes: &'static str,
}

pub(super) const RUST: &str = "Rust";
pub(super) const PYTHON: &str = "Python";
pub(super) const WEB: &str = "web";
const C: &str = "C";
const SLASHES: [&str; 2] = ["/*", "*/"];

const LANGUAGES: [Language; 6] = [
    Language { name: RUST, extensions: "rs", line_comment: "//", block_comment: SLASHES, quotes: "\"" },
    Language { name: PYTHON, extensions: "py", line_comment: "#", block_comment: ["", ""], quotes: "\"'" },
    Language { name: WEB, extensions: "js mjs ts", line_comment: "//", block_comment: SLASHES, quotes: "\"'`" },
    Language { name: WEB, extensions: "css", line_comment: "", block_comment: SLASHES, quotes: "\"'" },
    Language { name: WEB, extensions: "html", line_comment: "", block_comment: ["<!--", "-->"], quotes: "" },
    Language { name: C, extensions: "c h cpp hpp cu cuh", line_comment: "//", block_comment: SLASHES, quotes: "\"'" },
];

/// Files that a program writes.
const GENERATED: [&str; 2] = ["apps/page/assets/viewer.js", "bindings/c/include/p2m.h"];

/// A file whose language is known.
pub(super) struct Source {
    pub(super) path: String,
    pub(super) language: &'static str,
    /// The text without comments and tests, and without most characters of strings that are neither letters nor digits.
    pub(super) code: String,
    /// The number of lines of tests.
    pub(super) tests: usize,
}

impl Source {
    /// Returns a file, or `None` if its language is not known or a program has written it.
    pub(super) fn new(path: &str, text: &str) -> Option<Self> {
        let (name, extension) = path.rsplit('/').next()?.rsplit_once('.')?;
        let language = LANGUAGES.iter().find(|language| language.extensions.split(' ').any(|e| e == extension))?;
        if GENERATED.contains(&path) {
            return None;
        }
        let all = language.without_comments(text);
        let is_test_folder = |folder| ["test", "tests"].contains(&folder);
        let is_test = path.split('/').chain([name]).any(is_test_folder) || name.starts_with("test_");
        let code = if is_test || name.ends_with(".test") { String::new() } else { without_tests(&all) };
        Some(Self { path: path.to_owned(), language: language.name, tests: lines(&all) - lines(&code), code })
    }

    /// Returns the number of lines of code.
    pub(super) fn lines(&self) -> usize {
        lines(&self.code)
    }

    /// Returns how many names a file of Rust declares as public or re-exports from another crate of p2m. The lint
    /// `unreachable_pub` ensures that what is `pub` can be reached.
    pub(super) fn public_names(&self) -> usize {
        const KINDS: [&str; 9] = ["fn", "struct", "enum", "trait", "type", "const", "static", "mod", "union"];
        const MODIFIERS: [&str; 4] = ["unsafe", "extern", "async", "\"C\""];
        let declared = self.code.lines().filter_map(|line| line.trim_start().strip_prefix("pub "));
        let declared = declared.filter_map(|rest| rest.split(' ').find(|word| !MODIFIERS.contains(word)));
        let exported = uses(&self.code).0.into_iter().filter(|used| used.is_exported && used.path.starts_with("p2m"));
        declared.filter(|word| KINDS.contains(word)).count() + exported.count()
    }
}

fn lines(text: &str) -> usize {
    text.lines().filter(|line| !line.trim().is_empty()).count()
}

impl Language {
    fn without_comments(&self, text: &str) -> String {
        let (mut out, mut rest) = (String::with_capacity(text.len()), text);
        let starts = |rest: &str, open: &str| !open.is_empty() && rest.starts_with(open);
        let [open, close] = self.block_comment;
        while let Some(first) = rest.chars().next() {
            let (length, is_comment) = if starts(rest, self.line_comment) {
                (rest.find('\n').unwrap_or(rest.len()), true)
            } else if starts(rest, open) {
                (end(rest, open.len(), close), true)
            } else if let Some(length) = self.string_length(rest, &out) {
                // A text in three quotes that is a statement of its own documents something.
                let is_statement = out.rsplit('\n').next().is_none_or(|line| line.trim().is_empty());
                (length, self.name == PYTHON && length >= 6 && rest[1..].starts_with(first) && is_statement)
            } else {
                out.push(first);
                rest = &rest[first.len_utf8()..];
                continue;
            };
            let kept = |c: char| if c.is_whitespace() || c.is_alphanumeric() || "./-\"'".contains(c) { c } else { '_' };
            out.extend(rest[..length].chars().filter(|c| !is_comment || *c == '\n').map(kept));
            rest = &rest[length..];
        }
        out
    }

    /// Returns the length of the string that a text starts with, if it starts with one. `before` is what stands before.
    fn string_length(&self, text: &str, before: &str) -> Option<usize> {
        let first = text.chars().next()?;
        let is_rust = self.name == RUST;
        if is_rust && first == 'r' && !before.ends_with(|c: char| c != 'b' && (c.is_alphanumeric() || c == '_')) {
            let hashes = text[1..].bytes().take_while(|byte| *byte == b'#').count();
            let close = format!("\"{}", "#".repeat(hashes));
            return text[1 + hashes..].starts_with('"').then(|| end(text, hashes + 2, &close));
        }
        if is_rust && first == '\'' {
            // What is no character is a lifetime.
            let second = text[1..].chars().next()?;
            let is_character = text[1 + second.len_utf8()..].starts_with('\'');
            return (second == '\\' || is_character).then(|| end(text, if second == '\\' { 3 } else { 2 }, "'"));
        }
        if !self.quotes.contains(first) {
            return None;
        }
        if self.name == PYTHON && text[1..].starts_with(&text[..1].repeat(2)) {
            return Some(end(text, 3, &text[..3]));
        }
        let mut is_escaped = false;
        let is_end = |(_, c): &(usize, char)| {
            let ends = !is_escaped && (*c == first || *c == '\n' && !is_rust && first != '`');
            is_escaped = !is_escaped && *c == '\\';
            ends
        };
        Some(text.char_indices().skip(1).find(is_end).map_or(text.len(), |(at, _)| at + 1))
    }
}

/// Returns the end of the first `close` in a text after a number of bytes.
fn end(text: &str, from: usize, close: &str) -> usize {
    text.get(from..).and_then(|rest| rest.find(close)).map_or(text.len(), |at| from + at + close.len())
}

/// Returns code without the items that are compiled for tests alone.
fn without_tests(code: &str) -> String {
    let mut parts = code.split("#[cfg(test)]");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let mut depth = 0;
        let ends_item = |(_, c): &(usize, char)| {
            depth += i32::from("([{".contains(*c)) - i32::from(")]}".contains(*c));
            depth == 0 && (*c == ';' || *c == '}')
        };
        out.push_str(&part[part.char_indices().find(ends_item).map_or(part.len(), |(at, _)| at + 1)..]);
    }
    out
}

/// A name that a file of Rust imports.
pub(super) struct Use {
    /// The path as the file writes it.
    pub(super) path: String,
    /// The name in the file, or `*` for all names of the path.
    pub(super) name: String,
    /// Whether others can take the name from the file.
    pub(super) is_exported: bool,
}

/// Returns what code of Rust imports, and the code without the imports.
pub(super) fn uses(code: &str) -> (Vec<Use>, String) {
    let (mut found, mut rest) = (Vec::new(), String::new());
    for statement in code.split_inclusive(';') {
        let line = statement.rfind("use ").map_or(0, |at| statement[..at].rfind('\n').map_or(0, |line| line + 1));
        let (before, last) = statement.split_at(line);
        match last.trim().trim_end_matches(';').split_once("use ") {
            Some((visibility, tree)) if visibility.is_empty() || visibility.starts_with("pub") => {
                rest.push_str(before);
                leaves(tree, "", !visibility.is_empty(), &mut found);
            }
            _ => rest.push_str(statement),
        }
    }
    (found, rest)
}

/// Adds the names of a tree of imports.
fn leaves(tree: &str, prefix: &str, is_exported: bool, found: &mut Vec<Use>) {
    let tree = tree.trim();
    if let Some((head, inner)) = tree.strip_suffix('}').and_then(|tree| tree.split_once('{')) {
        let mut depth = 0;
        let is_comma = |c: char| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            depth == 0 && c == ','
        };
        for part in inner.split(is_comma).filter(|part| !part.trim().is_empty()) {
            leaves(part, &format!("{prefix}{head}"), is_exported, found);
        }
        return;
    }
    let (path, alias) = tree.split_once(" as ").unwrap_or((tree, ""));
    let path = format!("{prefix}{path}").trim_end_matches("::self").to_owned();
    let name = if alias.is_empty() { path.rsplit("::").next().unwrap_or_default() } else { alias };
    found.push(Use { name: name.to_owned(), path, is_exported });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the lines of code and of tests.
    fn counts(path: &str, text: &str) -> [usize; 2] {
        let source = Source::new(path, text).unwrap();
        [source.lines(), source.tests]
    }

    #[test]
    fn lines_without_comments_and_blanks() {
        let rust = "//! a\n\nfn f<'a>() -> char {\n    /* b\n    c */\n    \"// {\n     d\";\n    '\"' // e\n}\n";
        assert_eq!(counts("a.rs", rust), [5, 0]);
        assert_eq!(counts("a.rs", "let a = r#\"\n// \"{\n\"#;\n// b"), [3, 0]);
        assert_eq!(
            counts("a.py", "def f():\n    \"\"\"A\n\n    b.\"\"\"\n    # c\n    return \"\"\"#\n\"\"\"\n"),
            [3, 0]
        );
        assert_eq!(counts("a.ts", "const a = `// ${b}\n  c`; // d\n/* e */ f('/*');"), [3, 0]);
        assert_eq!(counts("a.css", "/* a */\np {\n  b: c;\n}"), [3, 0]);
        assert_eq!(counts("a.html", "<!-- a\nb -->\n<p>//</p>"), [1, 0]);
    }

    #[test]
    fn tests_are_no_code() {
        let text =
            "fn a() {}\n#[cfg(test)]\nmod tests {\n    const A: &str = \"}\";\n}\nfn b() {}\n#[cfg(test)]\nmod c;\n";
        assert_eq!(counts("a.rs", text), [2, 6]);
        for path in ["a/tests.rs", "a/tests/b.rs", "a/test/b.mjs", "a/b.test.ts", "a/test_b.py"] {
            assert_eq!(counts(path, "a\nb"), [0, 2], "{path}");
        }
        assert!(Source::new("bindings/c/include/p2m.h", "int a;").is_none() && Source::new("a.md", "b").is_none());
    }

    #[test]
    fn public_names_are_declared_or_from_another_crate() {
        let names = |text: &str| Source::new("a.rs", text).unwrap().public_names();
        assert_eq!(names("pub struct A {\n    pub b: u8,\n}\nimpl A {\n    pub const fn c() {}\n    fn d() {}\n}"), 2);
        assert_eq!(names("pub unsafe extern \"C\" fn a() {}\npub(crate) fn b() {}\npub use b::B;"), 1);
        assert_eq!(names("pub use p2m_core::{A, b::{self, C as D}};\n#[cfg(test)]\npub fn e() {}"), 3);
    }
}
