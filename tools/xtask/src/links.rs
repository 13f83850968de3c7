//! The links of the documents: where they are in a text, and whether they lead anywhere.

use crate::{Outcome, command, fail_if_any, output, read};
use std::collections::HashMap;
use std::fs;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

/// The address under which the repository shows its files and folders.
pub(crate) const REPOSITORY_FILES: &str = "https://github.com/p2m-rs/p2m/blob/main/";

/// Checks that every relative link and every link to a file of the repository leads to a file, and to a heading of it
/// if it names one. Also checks that the site has every document, and the tests every page of the guide.
pub(crate) fn check() -> Outcome {
    fail_if_any("dead links", &faults(Path::new("."))?)
}

/// Returns what is wrong with the links of the repository.
fn faults(root: &Path) -> Result<Vec<String>, String> {
    let files = list_files(root)?;
    let mut checker = Checker { root, headings: HashMap::new(), faults: Vec::new() };
    for file in &files {
        let text = read(file)?;
        let name = file.strip_prefix(root).unwrap_or(file);
        if has_extension(file, "md") {
            for range in destinations(&text) {
                checker.check(name, &text[range]);
            }
        }
        for address in text.split(REPOSITORY_FILES).skip(1) {
            let end = address.find(|c: char| c.is_whitespace() || ")>\"'`{".contains(c)).unwrap_or(address.len());
            checker.check_file(name, Path::new(address[..end].trim_end_matches(['.', ',', ';', ':'])));
        }
        // The changelog may name documents of the past.
        if name != Path::new("CHANGELOG.md") {
            for document in mentioned_documents(&text) {
                checker.check_file(name, Path::new(document));
            }
        }
    }
    let mut faults = checker.faults;
    let summary = read(root.join("docs/SUMMARY.md"))?;
    let facade = read(root.join("src/lib.rs"))?;
    for file in files.iter().filter(|file| has_extension(file, "md")) {
        let Ok(page) = file.strip_prefix(root.join("docs")) else { continue };
        let page = page.to_string_lossy().replace('\\', "/");
        if page != "SUMMARY.md" && !summary.contains(&format!("({page})")) {
            faults.push(format!("docs/SUMMARY.md does not list {page}"));
        }
        if page.starts_with("guide/") && !facade.contains(&format!("include_str!(\"../docs/{page}\")")) {
            faults.push(format!("src/lib.rs does not test the examples of docs/{page}"));
        }
    }
    Ok(faults)
}

/// Returns the files of the repository that can have links, without inputs that once failed.
fn list_files(root: &Path) -> Result<Vec<PathBuf>, String> {
    let listed = output(command("git ls-files --cached --others --exclude-standard").current_dir(root))?;
    let files = listed.lines().map(|path| root.join(path)).filter(|path| path.is_file() && !path.is_symlink());
    let has_links = |path: &PathBuf| ["md", "rs", "toml", "py"].iter().any(|extension| has_extension(path, extension));
    Ok(files.filter(|path| has_links(path) && !path.components().any(|part| part.as_os_str() == "crashes")).collect())
}

pub(crate) fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found == extension)
}

/// The state of a check.
struct Checker<'a> {
    root: &'a Path,
    /// The anchors of the documents that were linked so far.
    headings: HashMap<PathBuf, Vec<String>>,
    faults: Vec<String>,
}

impl Checker<'_> {
    /// Checks a link of a document. Links to other sites are not followed.
    fn check(&mut self, document: &Path, destination: &str) {
        if destination.contains("://") || destination.starts_with("mailto:") {
            return;
        }
        let path = destination.split('#').next().unwrap_or_default();
        let folder = document.parent().unwrap_or(Path::new(""));
        let target = if path.is_empty() { document.to_owned() } else { normalised(&folder.join(path)) };
        let in_docs = |path: &Path| path.starts_with("docs");
        if self.root.join(&target).is_dir() && in_docs(document) && in_docs(&target) {
            self.faults.push(format!("{}: {destination}: the site needs a page of that folder", document.display()));
        }
        self.check_file(document, Path::new(&format!("{}{}", target.display(), &destination[path.len()..])));
    }

    /// Checks a path that is relative to the root, with an anchor or without one.
    fn check_file(&mut self, document: &Path, path: &Path) {
        let path = path.to_string_lossy();
        let (file, anchor) = path.split_once('#').unwrap_or((&path, ""));
        if !self.root.join(file).exists() {
            self.faults.push(format!("{}: there is no {file}", document.display()));
        } else if !anchor.is_empty() && !self.anchors(Path::new(file)).iter().any(|found| found == anchor) {
            self.faults.push(format!("{}: {path}: there is no heading of that name", document.display()));
        }
    }

    fn anchors(&mut self, document: &Path) -> &[String] {
        let file = self.root.join(document);
        self.headings
            .entry(document.to_owned())
            .or_insert_with(|| fs::read_to_string(file).map_or_else(|_| Vec::new(), |text| anchors(&text)))
    }
}

/// Returns a relative path without `.` and, where possible, without `..`.
pub(crate) fn normalised(path: &Path) -> PathBuf {
    let mut parts = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if parts.file_name().is_some() => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts
}

/// Returns where the destinations of links and pictures are in a text of Markdown, code excluded.
pub(crate) fn destinations(text: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    for (start, line) in prose(text) {
        let mut is_code = false;
        for (i, c) in line.char_indices() {
            if c == '`' {
                is_code = !is_code;
            }
            if is_code || !line[i..].starts_with("](") {
                continue;
            }
            let begin = i + 2;
            if let Some(length) = line[begin..].find([')', ' ']) {
                found.push(start + begin..start + begin + length);
            }
        }
        // A reference: `[name]: destination`.
        if let Some((name, rest)) = line.split_once("]: ")
            && name.starts_with('[')
            && !rest.trim().contains(' ')
        {
            let begin = start + name.len() + 3;
            found.push(begin..begin + rest.trim_end().len());
        }
    }
    found
}

/// Returns the lines outside of fenced code, and where they begin.
fn prose(text: &str) -> Vec<(usize, &str)> {
    let (mut start, mut is_code, mut lines) = (0, false, Vec::new());
    for line in text.split_inclusive('\n') {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        } else if !is_code {
            lines.push((start, line));
        }
        start += line.len();
    }
    lines
}

/// Returns the anchors of the headings of a document, as GitHub and mdBook make them.
fn anchors(text: &str) -> Vec<String> {
    let mut anchors: Vec<String> = Vec::new();
    for (_, line) in prose(text) {
        let heading = line.trim_start_matches('#');
        if heading.len() == line.len() || !heading.starts_with(' ') {
            continue;
        }
        let heading = heading.trim().to_lowercase();
        let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let anchor: String = kept.map(|c| if c == ' ' { '-' } else { c }).collect();
        let number = anchors.iter().filter(|known| **known == anchor).count();
        anchors.push(if number == 0 { anchor } else { format!("{anchor}-{number}") });
    }
    anchors
}

/// Returns the documents that a text mentions by their path from the root, such as `docs/README.md`.
fn mentioned_documents(text: &str) -> impl Iterator<Item = &str> {
    text.match_indices("docs/").filter_map(move |(start, _)| {
        let is_part = text[..start].ends_with(|c: char| c.is_alphanumeric() || "/.-_(".contains(c));
        let rest = &text[start..];
        let end = rest.find(|c: char| !c.is_alphanumeric() && !"/-_.".contains(c)).unwrap_or(rest.len());
        let path = rest[..end].trim_end_matches('.');
        (!is_part && path.ends_with(".md")).then_some(path)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_link_is_dead() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        assert_eq!(faults(&root).unwrap(), Vec::<String>::new());
    }

    #[test]
    fn links_are_found_outside_of_code() {
        let text = "[a](b.md#c) `[x](y)` ![d](e.svg)\n```\n[f](g)\n```\n[h]: i.md\n";
        let found: Vec<&str> = destinations(text).into_iter().map(|range| &text[range]).collect();
        assert_eq!(found, ["b.md#c", "e.svg", "i.md"]);
    }

    #[test]
    fn anchors_are_those_of_github() {
        assert_eq!(anchors("# A `b`, c: D\n```\n# no\n```\n## e\n## e\n"), ["a-b-c-d", "e", "e-1"]);
    }

    #[test]
    fn dead_links_are_faults() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut checker = Checker { root: &root, headings: HashMap::new(), faults: Vec::new() };
        let document = Path::new("docs/README.md");
        for link in ["nothing.md", "../README.md#nothing", "proofs"] {
            checker.check(document, link);
        }
        assert_eq!(checker.faults.len(), 3, "{:?}", checker.faults);
        checker.check(document, "../README.md#licence");
        assert_eq!(checker.faults.len(), 3, "{:?}", checker.faults);
    }
}
