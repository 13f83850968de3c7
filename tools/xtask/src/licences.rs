//! Checks the licences of all dependencies against the list in deny.toml, where cargo-deny need not be installed.

use crate::{Outcome, output};
use std::fs;

/// Checks that each package of the lock file can be used under licences that deny.toml allows.
pub(crate) fn check() -> Outcome {
    let configuration = fs::read_to_string("deny.toml").map_err(|error| format!("deny.toml: {error}"))?;
    let allowed = allowed_licences(&configuration);
    if allowed.is_empty() {
        return Err("deny.toml allows no licence".to_owned());
    }
    let metadata = output("cargo", &["metadata", "--locked", "--format-version", "1"])?;
    // The metadata has for each package its name, version, id and licence, in this order and only once.
    let parts: Vec<&str> = metadata.split("\"license\":").collect();
    let mut refused = Vec::new();
    for pair in parts.windows(2) {
        let name = pair[0].rsplit("\"name\":\"").next().and_then(|rest| rest.split('"').next()).unwrap_or("?");
        let licence = pair[1].strip_prefix('"').and_then(|rest| rest.split('"').next());
        if !licence.is_some_and(|expression| is_allowed(expression, &allowed)) {
            refused.push(format!("{name} ({})", licence.unwrap_or("no licence")));
        }
    }
    if parts.len() < 2 {
        return Err("the metadata of the workspace has no licences".to_owned());
    }
    if !refused.is_empty() {
        return Err(format!("deny.toml does not allow the licences of these packages: {}", refused.join(", ")));
    }
    println!("deny.toml allows the licences of all {} packages", parts.len() - 1);
    Ok(())
}

/// Returns the licences in the list `allow` of a configuration, which has one on each line.
fn allowed_licences(configuration: &str) -> Vec<&str> {
    let lines = configuration.lines().skip_while(|line| *line != "allow = [").skip(1);
    let lines = lines.take_while(|line| *line != "]");
    lines.filter_map(|line| line.trim().strip_prefix('"')?.split('"').next()).collect()
}

/// Whether a licence expression can be met by allowed licences alone. A slash is an old form of `OR`.
fn is_allowed(expression: &str, allowed: &[&str]) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let mut words = spaced.split_whitespace().peekable();
    // An expression that cannot be read to its end allows nothing.
    alternatives(&mut words, allowed).unwrap_or(false) && words.next().is_none()
}

type Words<'a> = std::iter::Peekable<std::str::SplitWhitespace<'a>>;

/// Reads terms that `OR` joins, of which one has to be allowed.
fn alternatives(words: &mut Words<'_>, allowed: &[&str]) -> Option<bool> {
    let mut any = conjunction(words, allowed)?;
    while words.next_if_eq(&"OR").is_some() {
        any |= conjunction(words, allowed)?;
    }
    Some(any)
}

/// Reads terms that `AND` joins, all of which have to be allowed.
fn conjunction(words: &mut Words<'_>, allowed: &[&str]) -> Option<bool> {
    let mut all = term(words, allowed)?;
    while words.next_if_eq(&"AND").is_some() {
        all &= term(words, allowed)?;
    }
    Some(all)
}

/// Reads a licence, perhaps with an exception, or an expression in parentheses.
fn term(words: &mut Words<'_>, allowed: &[&str]) -> Option<bool> {
    let licence = words.next()?;
    if licence == "(" {
        let inner = alternatives(words, allowed)?;
        return (words.next()? == ")").then_some(inner);
    }
    if words.next_if_eq(&"WITH").is_some() {
        let exception = words.next()?;
        return Some(allowed.contains(&format!("{licence} WITH {exception}").as_str()));
    }
    Some(allowed.contains(&licence))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_are_met_by_allowed_licences() {
        let allowed = ["MIT", "Unicode-3.0", "GPL-2.0 WITH Classpath-exception-2.0"];
        for expression in [
            "MIT",
            "MIT/Apache-2.0",
            "LGPL-2.1-or-later OR Apache-2.0 OR MIT",
            "(MIT OR Apache-2.0) AND Unicode-3.0",
            "GPL-2.0 WITH Classpath-exception-2.0",
        ] {
            assert!(is_allowed(expression, &allowed), "{expression}");
        }
        for expression in [
            "",
            "GPL-3.0",
            "MIT AND GPL-3.0",
            "MIT OR",
            "(MIT",
            "MIT MIT",
            "MIT WITH Classpath-exception-2.0",
            "MIT AND (GPL-3.0 OR Apache-2.0)",
        ] {
            assert!(!is_allowed(expression, &allowed), "{expression}");
        }
    }

    #[test]
    fn the_list_of_the_configuration_is_found() {
        let configuration = "[licenses]\nallow = [\n    \"MIT\",\n    # A reason.\n    \"Zlib\",\n]\n[bans]\n\"no\"\n";
        assert_eq!(allowed_licences(configuration), ["MIT", "Zlib"]);
    }
}
