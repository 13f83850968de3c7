//! The documents as a site of mdBook.

use crate::links::{self, REPOSITORY_FILES, destinations, has_extension, normalised};
use crate::{Outcome, copy, fail_if_any, files_below, make_empty_folder, read, start, target, tools, write};
use std::path::Path;
use std::process::Command;

const MDBOOK_VERSION: &str = "0.4.52";

/// Checks all links, and builds the site below `target/book`.
pub(crate) fn build() -> Outcome {
    links::check()?;
    let (source, book) = (target("book-source"), target("book"));
    make_empty_folder(&source)?;
    make_empty_folder(&book)?;
    // Links that leave the documents lead to the repository in the copy, and links to a README to the index that mdBook
    // makes of it.
    for path in files_below("docs")? {
        let copied = source.join(path.strip_prefix("docs").unwrap_or(&path));
        copy(&path, &copied)?;
        if has_extension(&path, "md") {
            write(&copied, on_site(&path, read(&path)?))?;
        }
    }
    let mdbook = tools::program("mdbook", MDBOOK_VERSION, "--no-default-features --features search", true)?;
    start(Command::new(mdbook).arg("build").arg(&source).arg("--dest-dir").arg(&book))?;
    fail_if_any("dead links of the site", &faults_of_pages(&book)?)?;
    println!("\n== {}", book.join("index.html").display());
    Ok(())
}

/// Returns the text of a document with the links that it has on the site.
fn on_site(path: &Path, mut text: String) -> String {
    // The summary names files, of which mdBook makes pages.
    if path.ends_with("SUMMARY.md") {
        return text;
    }
    for range in destinations(&text).into_iter().rev() {
        let destination = &text[range.clone()];
        if destination.contains("://") || destination.starts_with('#') {
            continue;
        }
        let (file, anchor) =
            destination.split_once('#').map_or((destination, ""), |(file, _)| (file, &destination[file.len()..]));
        let target = normalised(&path.parent().unwrap_or(Path::new("")).join(file));
        if !target.starts_with("docs") {
            let target = target.to_string_lossy().replace('\\', "/");
            text.replace_range(range, &format!("{REPOSITORY_FILES}{target}{anchor}"));
        } else if let Some(folder) = file.strip_suffix("README.md") {
            text.replace_range(range, &format!("{folder}index.md{anchor}"));
        }
    }
    text
}

/// Returns the relative links of pages that lead to no file of the site.
fn faults_of_pages(book: &Path) -> Result<Vec<String>, String> {
    let mut faults = Vec::new();
    for path in files_below(book)?.iter().filter(|path| has_extension(path, "html") && !path.ends_with("404.html")) {
        let page = read(path)?;
        let links = page.split(" href=\"").chain(page.split(" src=\"")).skip(1);
        for link in links.filter_map(|rest| rest.split('"').next()) {
            let file = link.split('#').next().unwrap_or_default();
            let is_elsewhere = link.contains(['<', '\n']) || link.contains("://") || file.is_empty();
            let target = path.with_file_name(file);
            if !is_elsewhere && !target.is_file() && !target.join("index.html").is_file() {
                faults.push(format!("{}: {link}", path.display()));
            }
        }
    }
    Ok(faults)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_that_leave_the_documents_lead_to_the_repository() {
        let text = "[a](../ARCHITECTURE.md#dependencies) [c](README.md) [d](fields.md#e)".to_owned();
        let there = "https://github.com/p2m-rs/p2m/blob/main/ARCHITECTURE.md#dependencies";
        assert_eq!(on_site(Path::new("docs/p2m.md"), text), format!("[a]({there}) [c](index.md) [d](fields.md#e)"));
    }
}
