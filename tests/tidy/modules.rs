//! References between the modules of a crate, read from the paths in their files.

use std::collections::{BTreeMap, BTreeSet};

use super::functions::without_texts;

/// The way to a module from its crate's root; the root itself has none.
pub(crate) type ModulePath = Vec<String>;

/// Modules of a crate, and what each of them names.
pub(crate) struct Modules {
    /// Absolute paths that each module's file contains, tests left out.
    named: BTreeMap<ModulePath, Vec<ModulePath>>,
    /// Origins of the names that each module imports or exports again.
    imported: BTreeMap<ModulePath, BTreeMap<String, ModulePath>>,
}

impl Modules {
    /// Reads the files of a crate, given as the path from its `src` folder and the text. Files of tests are left out.
    pub(crate) fn read(files: &[(String, String)]) -> Modules {
        let module_of = |path: &str| -> ModulePath {
            let without_ending = path.strip_suffix(".rs").unwrap_or(path);
            let mut steps: ModulePath = without_ending.split('/').map(str::to_owned).collect();
            if steps
                .last()
                .is_some_and(|last| matches!(last.as_str(), "lib" | "main" | "mod"))
            {
                steps.pop();
            }
            steps
        };
        let modules = files.iter().map(|(path, text)| (module_of(path), text));
        let modules: Vec<_> = modules
            .filter(|(path, _)| !path.iter().any(|step| step == "tests"))
            .collect();
        let mut read = Modules {
            named: modules.iter().map(|(path, _)| (path.clone(), Vec::new())).collect(),
            imported: BTreeMap::new(),
        };
        for (module, text) in modules {
            let tokens = without_tests(&tokens_of(text));
            let mut named = Vec::new();
            for (path, is_import) in paths_of(&tokens) {
                let Some(absolute) = read.absolute(&module, &path) else {
                    continue;
                };
                if let Some(name) = absolute.last().filter(|_| is_import) {
                    let imported = read.imported.entry(module.clone()).or_default();
                    imported.insert(name.clone(), absolute.clone());
                }
                named.push(absolute);
            }
            read.named.insert(module, named);
        }
        read
    }

    /// The path from the crate's root, if it leads into this crate.
    fn absolute(&self, module: &ModulePath, path: &[String]) -> Option<ModulePath> {
        let mut base = module.clone();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" => {
                base.clear();
                rest = &path[1..];
            }
            "self" => rest = &path[1..],
            "super" => {
                while rest.first().is_some_and(|step| step == "super") {
                    base.pop()?;
                    rest = &rest[1..];
                }
            }
            child => {
                base.push(child.to_owned());
                if !self.named.contains_key(&base) {
                    return None;
                }
                base.pop();
            }
        }
        base.extend_from_slice(rest);
        Some(base)
    }

    /// The module that a path leads to, through imports and names that are exported again.
    fn target(&self, path: &[String], depth: usize) -> ModulePath {
        let is_module = |count: &usize| self.named.contains_key(&path[..*count]);
        let count = (0..=path.len()).rev().find(is_module).unwrap_or(0);
        let (module, rest) = path.split_at(count);
        let imported = rest.first().and_then(|name| self.imported.get(module)?.get(name));
        match imported {
            // Imports that lead in a circle are none of Rust.
            Some(from) if depth < 8 && from != path => {
                let onward: ModulePath = from.iter().chain(&rest[1..]).cloned().collect();
                self.target(&onward, depth + 1)
            }
            _ => module.to_vec(),
        }
    }

    /// Circles between modules that have the same parent, where a module stands for all that is inside it: no module may need
    /// another that needs it, whichever of their files say so. What parent and child name of each other does not count.
    pub(crate) fn circles(&self) -> Vec<Vec<String>> {
        let mut siblings: BTreeMap<ModulePath, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
        for (module, named) in &self.named {
            for path in named {
                let target = self.target(path, 0);
                let shared = module
                    .iter()
                    .zip(&target)
                    .take_while(|(one, other)| one == other)
                    .count();
                if let (Some(one), Some(other)) = (module.get(shared), target.get(shared)) {
                    let parent = siblings.entry(module[..shared].to_vec()).or_default();
                    parent.entry(one.clone()).or_default().insert(other.clone());
                }
            }
        }
        let in_parent = |(parent, edges): (&ModulePath, &BTreeMap<String, BTreeSet<String>>)| {
            let full = |name: &String| [parent.as_slice(), std::slice::from_ref(name)].concat().join("::");
            let circles = circles_of(edges);
            circles
                .into_iter()
                .map(|circle| circle.iter().map(full).collect())
                .collect::<Vec<Vec<String>>>()
        };
        siblings.iter().flat_map(in_parent).collect()
    }
}

/// Groups of names that all reach each other.
fn circles_of(edges: &BTreeMap<String, BTreeSet<String>>) -> Vec<Vec<String>> {
    let reached_from = |start: &String| {
        let mut reached = BTreeSet::new();
        let mut open = vec![start];
        while let Some(name) = open.pop() {
            for next in edges.get(name).into_iter().flatten() {
                if reached.insert(next.clone()) {
                    open.push(next);
                }
            }
        }
        reached
    };
    let reached: BTreeMap<&String, BTreeSet<String>> = edges.keys().map(|name| (name, reached_from(name))).collect();
    let mut circles: Vec<Vec<String>> = Vec::new();
    for (name, own) in &reached {
        let is_known = circles.iter().any(|circle| circle.contains(name));
        if own.contains(*name) && !is_known {
            let both_ways = |other: &&String| reached.get(other).is_some_and(|back| back.contains(*name));
            circles.push(own.iter().filter(both_ways).cloned().collect());
        }
    }
    circles
}

/// Words and signs of a Rust file, without comments and texts; `::` and `=>` are one sign each.
pub(crate) fn tokens_of(text: &str) -> Vec<String> {
    let code = without_texts(text);
    let mut tokens = Vec::new();
    let mut rest = code.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = if first.is_alphanumeric() || first == '_' {
            rest.find(|c: char| !c.is_alphanumeric() && c != '_')
                .unwrap_or(rest.len())
        } else if rest.starts_with("::") || rest.starts_with("=>") {
            2
        } else {
            first.len_utf8()
        };
        let (token, after) = rest.split_at(length);
        tokens.push(token.to_owned());
        rest = after.trim_start();
    }
    tokens
}

/// The tokens without items that exist for tests alone.
fn without_tests(tokens: &[String]) -> Vec<String> {
    let marker = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if tokens[at..]
            .iter()
            .zip(marker)
            .filter(|(token, mark)| token == mark)
            .count()
            == marker.len()
        {
            at = end_of_item(tokens, at + marker.len());
        } else {
            kept.push(tokens[at].clone());
            at += 1;
        }
    }
    kept
}

/// Returns the index after an item: after its `;`, or after the brace that closes its first brace.
fn end_of_item(tokens: &[String], start: usize) -> usize {
    let mut depth = 0_usize;
    for (at, token) in tokens.iter().enumerate().skip(start) {
        match token.as_str() {
            ";" if depth == 0 => return at + 1,
            "{" => depth += 1,
            "}" => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    return at + 1;
                }
            }
            _ => {}
        }
    }
    tokens.len()
}

/// All paths of more than one step, and whether a `use` imports them; trees of `use` are written out.
fn paths_of(tokens: &[String]) -> Vec<(ModulePath, bool)> {
    let mut paths = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        // `use<'a>` in a type captures a lifetime and imports nothing.
        if tokens[at] == "use" && tokens.get(at + 1).is_some_and(|next| next != "<") {
            at = read_tree(tokens, at + 1, &[], &mut paths);
            continue;
        }
        let mut end = at;
        while is_word(&tokens[end]) && tokens.get(end + 1).is_some_and(|sign| sign == "::") && end + 2 < tokens.len() {
            end += 2;
        }
        if end > at {
            let steps = tokens[at..=end].iter().step_by(2);
            paths.push((steps.filter(|step| is_word(step)).cloned().collect(), false));
        }
        at = end + 1;
    }
    paths
}

fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Reads one branch of a tree of `use` and returns where it ends.
fn read_tree(tokens: &[String], start: usize, before: &[String], paths: &mut Vec<(ModulePath, bool)>) -> usize {
    let mut path = before.to_vec();
    let mut at = start;
    while let Some(token) = tokens.get(at) {
        match token.as_str() {
            "{" => {
                at += 1;
                while tokens.get(at).is_some_and(|token| token != "}") {
                    // Behind each branch stands its comma.
                    at = match tokens[at].as_str() {
                        "," => at + 1,
                        _ => read_tree(tokens, at, &path, paths).max(at + 1),
                    };
                }
                return at + 1;
            }
            "as" => at += 2,
            "::" => at += 1,
            "*" => at += 1,
            word if !is_word(word) => break,
            word => {
                // `self` behind a module means the module.
                if word != "self" || path.is_empty() {
                    path.push(word.to_owned());
                }
                at += 1;
            }
        }
    }
    paths.push((path, true));
    at
}

#[test]
fn a_circle_is_found_through_imports_and_names_that_are_exported_again() {
    let file = |path: &str, text: &str| (path.to_owned(), text.to_owned());
    let files = [
        file("lib.rs", "mod a; mod b; mod c; pub use b::Deep;"),
        file("a.rs", "use crate::{Deep, c::{self, Plain as Other}};"),
        file("b.rs", "mod deep; pub use deep::Deep;"),
        file("b/deep.rs", "fn f() { let x = crate::a::g(); }"),
        file(
            "c.rs",
            "// crate::a::g\n#[cfg(test)]\nmod tests { use crate::a::g; }\nconst TEXT: &str = \"crate::a::g\";",
        ),
    ];
    assert_eq!(Modules::read(&files).circles(), [["a", "b"]]);
}
