//! Import circles: files that import each other, directly or through others. Imports of tests, and those that only a
//! checker of types reads, are none. A module may use what stands in the file of a module around it.

use super::source::{PYTHON, RUST, Source, Use, WEB, uses};
use std::collections::{BTreeMap, BTreeSet};

/// The files that each file imports.
type Arrows = BTreeMap<String, BTreeSet<String>>;

/// Returns the circles of files: the arrows of each one, as lines.
pub(super) fn circles(sources: &[Source]) -> BTreeSet<String> {
    let mut arrows = rust_arrows(sources);
    let files: BTreeSet<&str> = sources.iter().map(|source| source.path.as_str()).collect();
    for source in sources {
        let imported = match source.language {
            WEB => web_imports(source),
            PYTHON => python_imports(source),
            _ => continue,
        };
        arrows.entry(source.path.clone()).or_default().extend(imported.into_iter().filter(|to| files.contains(&**to)));
    }
    let reached: BTreeMap<&str, BTreeSet<&str>> = arrows.keys().map(|file| (&**file, reached(file, &arrows))).collect();
    let circles = reached.iter().filter(|(file, others)| others.contains(*file)).map(|(file, others)| {
        let returns = |other: &&&str| reached.get(*other).is_some_and(|back| back.contains(file));
        let circle: Vec<&str> = others.iter().filter(returns).copied().collect();
        let all = circle.iter().flat_map(|from| arrows[*from].iter().map(move |to| (from, to)));
        let inner = all.filter(|(_, to)| circle.contains(&to.as_str())).map(|(from, to)| format!("  {from} -> {to}"));
        inner.collect::<Vec<_>>().join("\n")
    });
    circles.collect()
}

/// Returns the files that can be reached from one.
fn reached<'a>(file: &'a str, arrows: &'a Arrows) -> BTreeSet<&'a str> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![file]);
    while let Some(next) = open.pop() {
        let new = arrows.get(next).into_iter().flatten().filter(|to| seen.insert(to.as_str()));
        open.extend(new.map(String::as_str));
    }
    seen
}

/// A module of Rust. Its key is its path without the extension, or its folder if it is the file of that.
struct Module<'a> {
    file: &'a str,
    /// The names of the items that the file declares.
    items: BTreeSet<&'a str>,
    /// The names that it imports, with keys as paths.
    uses: Vec<Use>,
    /// The keys of what its code names by a path.
    paths: BTreeSet<String>,
    /// The words of its code.
    words: BTreeSet<String>,
}

fn key_of(path: &str) -> Option<&str> {
    let key = path.strip_suffix(".rs").filter(|_| path.starts_with("src/") || path.contains("/src/"))?;
    Some(["/mod", "/lib", "/main"].iter().find_map(|name| key.strip_suffix(name)).unwrap_or(key))
}

fn rust_arrows(sources: &[Source]) -> Arrows {
    let files = sources.iter().filter(|source| source.language == RUST);
    let files: BTreeMap<&str, &Source> = files.filter_map(|source| Some((key_of(&source.path)?, source))).collect();
    let modules: BTreeMap<&str, Module<'_>> =
        files.iter().map(|(key, source)| (*key, Module::new(key, source, &files))).collect();
    let mut arrows = Arrows::new();
    for (key, module) in &modules {
        // A module that is imported counts where something of it is named, and a name that is passed on where it is used.
        let is_used = |used: &&Use| {
            !modules.contains_key(&*used.path) && (!used.is_exported || module.words.contains(&used.name))
        };
        let named = module.uses.iter().filter(is_used).map(|used| &used.path).chain(&module.paths);
        let defined = named.filter_map(|path| definition(path, &modules, 8));
        let is_around =
            |whole: &str| key.strip_prefix(whole).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        let outside = defined.filter(|to| !is_around(to)).map(|to| modules[&*to].file.to_owned());
        arrows.entry(module.file.to_owned()).or_default().extend(outside);
    }
    arrows
}

/// Returns the key of the module that defines what a key names, if it is one of the crate.
fn definition(path: &str, modules: &BTreeMap<&str, Module<'_>>, hops: u32) -> Option<String> {
    let mut key = path;
    while !modules.contains_key(key) {
        key = key.rsplit_once('/')?.0;
    }
    let module = &modules[key];
    let rest = path[key.len()..].trim_start_matches('/');
    let (name, tail) = rest.split_once('/').unwrap_or((rest, ""));
    if module.items.contains(name) || hops == 0 {
        return Some(key.to_owned());
    }
    if let Some(used) = module.uses.iter().find(|used| used.name == name) {
        return definition(&joined(&used.path, tail), modules, hops - 1);
    }
    let mut globs = module.uses.iter().filter_map(|used| used.path.strip_suffix("/*"));
    let has_name = |glob: &&str| modules.get(glob).is_some_and(|module| module.items.contains(name));
    Some(globs.find(has_name).unwrap_or(key).to_owned())
}

impl<'a> Module<'a> {
    fn new(key: &str, source: &'a Source, files: &BTreeMap<&str, &Source>) -> Self {
        const KINDS: [&str; 9] = ["fn", "struct", "enum", "trait", "type", "const", "static", "mod", "macro_rules!"];
        let (imports, body) = uses(&source.code);
        let root = key.find("/src/").map_or("src", |at| &key[..at + "/src".len()]);
        let root = if key.ends_with("/src") { key } else { root };
        let absolute = |path: &str, imported: &[Use]| {
            let (first, rest) = path.split_once("::").unwrap_or((path, ""));
            let child = format!("{key}/{first}");
            let base = match first {
                "crate" => root,
                "self" => key,
                "super" => folder(key),
                _ if files.contains_key(&*child) => &child,
                _ => &imported.iter().find(|import| import.name == first)?.path,
            };
            Some(joined(base, &rest.replace("super::", "../").replace("::", "/")))
        };
        let uses = imports.into_iter().filter_map(|used| Some(Use { path: absolute(&used.path, &[])?, ..used }));
        let uses: Vec<Use> = uses.collect();
        // Items of a file begin in the first column.
        let items = source.code.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_lowercase()));
        let items = items.filter_map(|line| {
            let mut words = line.split(|c: char| !(is_of_name(c) || c == '!')).filter(|word| !word.is_empty());
            words.find(|word| KINDS.contains(word))?;
            words.find(|word| !KINDS.contains(word))
        });
        let words = || body.split(|c| !(is_of_name(c) || c == ':')).filter(|word| !word.is_empty());
        let paths = words().filter(|word| word.contains("::"));
        Self {
            file: &source.path,
            items: items.collect(),
            paths: paths.filter_map(|path| absolute(path.trim_matches(':'), &uses)).collect(),
            words: words().filter_map(|word| Some(word.split(':').next()?.to_owned())).collect(),
            uses,
        }
    }
}

fn is_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Returns the path that a relative path names from a folder.
fn joined(folder: &str, relative: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(relative.split('/')) {
        match part {
            "." | "" => {}
            ".." => drop(parts.pop()),
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

fn folder(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// Returns the files that a script may import. Imports of types are none.
fn web_imports(source: &Source) -> Vec<String> {
    let is_quote = |c: char| c == '"' || c == '\'';
    let statements = source.code.split(';').map(str::trim_start);
    let imports = statements.filter_map(|statement| {
        let rest = statement.strip_prefix("import ").or_else(|| statement.strip_prefix("export "))?;
        let from = rest.split_once("from ").map_or(rest, |(_, from)| from);
        from.strip_prefix(is_quote)?.split(is_quote).next().filter(|_| !rest.starts_with("type "))
    });
    let paths = imports.map(|relative| joined(folder(&source.path), relative));
    // Scripts in TypeScript name the files that are compiled from them.
    paths.flat_map(|path| [path.replace(".js", ".ts"), path]).collect()
}

/// Returns the files of its package that a file of Python may import. Imports for checkers of types are none.
fn python_imports(source: &Source) -> Vec<String> {
    let mut is_for_types = false;
    let imports = source.code.lines().filter(|line| !line.trim().is_empty()).filter_map(|line| {
        is_for_types = line.starts_with("if TYPE_CHECKING") || is_for_types && line.starts_with(' ');
        line.trim().strip_prefix("from .").filter(|_| !is_for_types)?.split_once(" import ")
    });
    let modules = imports.flat_map(|(from, names)| {
        let module = from.trim_start_matches('.');
        let up = "../".repeat(from.len() - module.len());
        let base = joined(folder(&source.path), &format!("{up}{}", module.replace('.', "/")));
        // The names of a module of the package may be modules as well.
        let names: Vec<&str> = if module.is_empty() { names.split(", ").collect() } else { vec![""] };
        names.into_iter().map(|name| joined(&base, name)).collect::<Vec<_>>()
    });
    modules.flat_map(|module| [format!("{module}.py"), format!("{module}/__init__.py")]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<String> {
        let sources: Vec<Source> = files.iter().filter_map(|(path, text)| Source::new(path, text)).collect();
        circles(&sources).into_iter().collect()
    }

    #[test]
    fn names_are_followed_to_the_file_that_defines_them() {
        let root = ("a/src/lib.rs", "mod b;\nmod c;\npub use b::B;\npub use c::C as D;");
        let one = ("a/src/b/mod.rs", "use crate::{D, Other};\npub struct B(D);");
        let other =
            ("a/src/c.rs", "/// [`B`](crate::B)\npub struct C;\n#[cfg(test)]\nmod tests {\n    use crate::B;\n}");
        assert!(found(&[root, one, other]).is_empty(), "a comment, tests and what is passed on are no imports");
        for import in
            ["use crate::B;", "use crate::b;\nfn f() -> b::B {}", "fn f(b: &super::B) {}", "use crate::b::{B as E};"]
        {
            let other = ("a/src/c.rs", format!("{import}\npub struct C;"));
            let circle = found(&[root, one, (other.0, &other.1)]);
            assert_eq!(circle, ["  a/src/b/mod.rs -> a/src/c.rs\n  a/src/c.rs -> a/src/b/mod.rs"], "{import}");
        }
    }

    #[test]
    fn a_module_may_use_the_modules_around_it() {
        let root = ("src/a/mod.rs", "mod b;\nuse b::inner;\npub(crate) const LIMIT: u32 = 1;");
        assert!(found(&[root, ("src/a/b.rs", "use super::LIMIT;\npub(super) fn inner() {}")]).is_empty());
    }

    #[test]
    fn circles_of_scripts_and_of_python() {
        let scripts =
            [("a/x.js", "import {\n  y,\n} from './z/y.js';"), ("a/z/y.js", "export { x } from \"../x.js\";")];
        assert_eq!(found(&scripts), ["  a/x.js -> a/z/y.js\n  a/z/y.js -> a/x.js"]);
        let types = [("a/x.ts", "import { y } from './y.js';"), ("a/y.ts", "import type { X } from './x.js';")];
        assert!(found(&types).is_empty());
        let python = [("p/_a.py", "from ._b import (\n    b,\n)"), ("p/_b.py", "from . import _c, _a")];
        assert_eq!(found(&python), ["  p/_a.py -> p/_b.py\n  p/_b.py -> p/_a.py"]);
        let types = [python[0], ("p/_b.py", "if TYPE_CHECKING:\n    from ._a import A")];
        assert!(found(&types).is_empty());
    }
}
