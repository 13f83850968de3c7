//! The documents as a site of mdBook.

use crate::links::{self, REPOSITORY_FILES, destinations, normalised};
use crate::python::text;
use crate::{Outcome, absolute_target_folder, output, read, run};
use std::fs;
use std::path::{Path, PathBuf};

const MDBOOK_VERSION: &str = "0.4.52";

/// Checks all links, and builds the site below `target/book`.
pub(crate) fn build() -> Outcome {
    links::check()?;
    let target = absolute_target_folder()?;
    let (source, book) = (target.join("book-source"), target.join("book"));
    for folder in [&source, &book] {
        if folder.exists() {
            fs::remove_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        }
    }
    copy(Path::new("docs"), &source)?;
    let mdbook = find_mdbook(&target)?;
    run(&mdbook, &["build", &text(&source)?, "--dest-dir", &text(&book)?], &[])?;
    let faults = faults_of_pages(&book)?;
    if !faults.is_empty() {
        return Err(format!("dead links of the site\n  {}", faults.join("\n  ")));
    }
    println!("\n== {}", book.join("index.html").display());
    Ok(())
}

/// Returns the program mdBook: that of the path if it has the right version, else one that is installed.
fn find_mdbook(target: &Path) -> Result<String, String> {
    let folder = target.join("mdbook");
    let installed = text(&folder.join("bin").join(format!("mdbook{}", std::env::consts::EXE_SUFFIX)))?;
    for program in ["mdbook", &installed] {
        if output(program, &["--version"]).is_ok_and(|version| version.trim().ends_with(MDBOOK_VERSION)) {
            return Ok(program.to_owned());
        }
    }
    let install = ["install", "mdbook", "--locked", "--version", MDBOOK_VERSION, "--root", &text(&folder)?];
    run("cargo", &[&install[..], &["--no-default-features", "--features", "search"]].concat(), &[])?;
    Ok(installed)
}

/// Copies the documents. Links that leave them lead to the repository in the copy, and links to a README to the index
/// that mdBook makes of it.
fn copy(from: &Path, to: &Path) -> Outcome {
    fs::create_dir_all(to).map_err(|error| format!("{}: {error}", to.display()))?;
    let entries = fs::read_dir(from).map_err(|error| format!("{}: {error}", from.display()))?;
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        let copied = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copy(&path, &copied)?;
        } else if path.extension().is_some_and(|extension| extension == "md") {
            let document = on_site(&path, read(&path)?);
            fs::write(&copied, document).map_err(|error| format!("{}: {error}", copied.display()))?;
        } else {
            fs::copy(&path, &copied).map_err(|error| format!("{}: {error}", path.display()))?;
        }
    }
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
fn faults_of_pages(folder: &Path) -> Result<Vec<String>, String> {
    let mut faults = Vec::new();
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        if path.is_dir() {
            faults.extend(faults_of_pages(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "html") && !path.ends_with("404.html") {
            let page = read(&path)?;
            let links = page.split(" href=\"").chain(page.split(" src=\"")).skip(1);
            for link in links.filter_map(|rest| rest.split('"').next()) {
                let file = link.split('#').next().unwrap_or_default();
                let is_elsewhere = link.contains(['<', '\n']) || link.contains("://") || file.is_empty();
                if !is_elsewhere && !exists_from(folder, file) {
                    faults.push(format!("{}: {link}", path.display()));
                }
            }
        }
    }
    Ok(faults)
}

fn exists_from(folder: &Path, file: &str) -> bool {
    let path: PathBuf = folder.join(file);
    path.is_file() || path.join("index.html").is_file()
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
