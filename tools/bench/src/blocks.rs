//! Blocks of documents, whose text is made by a command and printed or written into a document.
//!
//! The block `lists` of the command `paper` is in a document between the lines `<!-- p2m-bench paper lists -->` and
//! `<!-- end -->`. The text around the blocks is written by hand.

use anyhow::{Context, Result};
use std::path::Path;

/// The line that ends a block.
const END: &str = "<!-- end -->";

/// The blocks of a command.
pub(crate) struct Blocks<const N: usize> {
    /// The name of the command.
    pub(crate) command: &'static str,
    /// The names of the blocks, in the order in which they are printed.
    pub(crate) names: [&'static str; N],
}

impl<const N: usize> Blocks<N> {
    /// Checks that the document has all blocks, before anything is measured.
    pub(crate) fn check(&self, document: Option<&Path>) -> Result<()> {
        document.map_or(Ok(()), |path| self.read_and_replace(path, &[const { String::new() }; N]).map(|_| ()))
    }

    /// Replaces the blocks in a document, or prints them if there is no document.
    pub(crate) fn publish(&self, document: Option<&Path>, contents: &[String; N]) -> Result<()> {
        match document {
            Some(path) => {
                let text = self.read_and_replace(path, contents)?;
                std::fs::write(path, text).with_context(|| path.display().to_string())
            }
            None => {
                for (name, content) in self.names.iter().zip(contents) {
                    println!("{}\n\n{}\n\n{END}\n", self.begin(name), content.trim_end());
                }
                Ok(())
            }
        }
    }

    fn read_and_replace(&self, path: &Path, contents: &[String; N]) -> Result<String> {
        let replaced = std::fs::read_to_string(path).map_err(Into::into).and_then(|text| self.replace(text, contents));
        replaced.with_context(|| path.display().to_string())
    }

    /// Returns a document with these contents of its blocks.
    fn replace(&self, mut document: String, contents: &[String; N]) -> Result<String> {
        for (name, content) in self.names.iter().zip(contents) {
            let begin = self.begin(name);
            let (before, rest) = document.split_once(&begin).with_context(|| format!("there is no line {begin}"))?;
            let (_, after) = rest.split_once(END).with_context(|| format!("nothing ends {begin}"))?;
            document = format!("{before}{begin}\n\n{}\n\n{END}{after}", content.trim_end());
        }
        Ok(document)
    }

    /// Returns the line that begins a block.
    fn begin(&self, name: &str) -> String {
        format!("<!-- p2m-bench {} {name} -->", self.command)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_replaced_and_the_text_around_them_stays() {
        let lists = Blocks { command: "paper", names: ["lists"] };
        let document = "Text.\n\n<!-- p2m-bench paper lists -->\n\nold\n\n<!-- end -->\n\nMore.\n";
        let replaced = lists.replace(document.to_owned(), &["new\n".to_owned()]).unwrap();
        assert_eq!(replaced, document.replace("old", "new"));
        assert!(lists.replace("<!-- p2m-bench paper lists -->".to_owned(), &[String::new()]).is_err());
        let two = Blocks { command: "paper", names: ["lists", "other"] };
        let error = two.replace(replaced, &[const { String::new() }; 2]).unwrap_err();
        assert!(error.to_string().contains("<!-- p2m-bench paper other -->"), "{error}");
    }
}
