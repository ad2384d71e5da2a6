//! References between the modules of a crate, read from the paths in their files.

use std::collections::{BTreeMap, BTreeSet};

use petgraph::algo::tarjan_scc;
use petgraph::graph::DiGraph;
use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};

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
        let mut paths_of_modules = BTreeMap::new();
        for (path, text) in files {
            let module = module_of(path);
            if module.iter().any(|step| step == "tests") {
                continue;
            }
            let file = syn::parse_file(text).unwrap_or_else(|error| panic!("{path}: {error}"));
            let mut paths = Paths::default();
            paths.visit_file(&file);
            paths_of_modules.insert(module, paths);
        }
        let mut read = Modules {
            named: paths_of_modules
                .keys()
                .map(|module| (module.clone(), Vec::new()))
                .collect(),
            imported: BTreeMap::new(),
        };
        for (module, paths) in paths_of_modules {
            let imported: Vec<ModulePath> = paths
                .imported
                .iter()
                .filter_map(|path| read.absolute(&module, path))
                .collect();
            let named = paths.named.iter().filter_map(|path| read.absolute(&module, path));
            let named = imported.iter().cloned().chain(named).collect();
            let names = imported
                .into_iter()
                .filter_map(|path| Some((path.last()?.clone(), path)));
            read.imported.insert(module.clone(), names.collect());
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
        let mut siblings: BTreeMap<ModulePath, BTreeSet<(String, String)>> = BTreeMap::new();
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
                    parent.insert((one.clone(), other.clone()));
                }
            }
        }
        let mut circles = Vec::new();
        for (parent, edges) in &siblings {
            let names: BTreeSet<&String> = edges.iter().flat_map(|(from, to)| [from, to]).collect();
            let mut graph = DiGraph::new();
            let nodes: BTreeMap<&String, _> = names.into_iter().map(|name| (name, graph.add_node(name))).collect();
            for (from, to) in edges {
                graph.add_edge(nodes[from], nodes[to], ());
            }
            for component in tarjan_scc(&graph).into_iter().filter(|circle| circle.len() > 1) {
                let full = |node| {
                    [parent.as_slice(), std::slice::from_ref(graph[node])]
                        .concat()
                        .join("::")
                };
                let circle: BTreeSet<String> = component.into_iter().map(full).collect();
                circles.push(circle.into_iter().collect());
            }
        }
        circles
    }
}

/// The way to the module that a file of a crate's `src` folder holds.
fn module_of(path: &str) -> ModulePath {
    let without_ending = path.strip_suffix(".rs").unwrap_or(path);
    let mut steps: ModulePath = without_ending.split('/').map(str::to_owned).collect();
    if steps
        .last()
        .is_some_and(|last| matches!(last.as_str(), "lib" | "main" | "mod"))
    {
        steps.pop();
    }
    steps
}

/// Paths in a file, outside of items that exist for tests alone.
#[derive(Default)]
struct Paths {
    /// Those of `use`, whose trees are written out.
    imported: Vec<ModulePath>,
    /// All others of more than one step.
    named: Vec<ModulePath>,
}

impl Visit<'_> for Paths {
    fn visit_item(&mut self, item: &syn::Item) {
        if !is_for_tests(item) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &syn::ItemUse) {
        import(&item.tree, &mut Vec::new(), &mut self.imported);
    }

    fn visit_path(&mut self, path: &syn::Path) {
        if path.segments.len() > 1 {
            let steps = path.segments.iter().map(|segment| segment.ident.to_string());
            self.named.push(steps.collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, invocation: &syn::Macro) {
        name_in_tokens(invocation.tokens.clone(), &mut self.named);
        visit::visit_macro(self, invocation);
    }
}

/// Returns true for an item under `#[cfg(test)]`.
fn is_for_tests(item: &syn::Item) -> bool {
    let attributes = match item {
        syn::Item::Mod(item) => &item.attrs,
        syn::Item::Use(item) => &item.attrs,
        syn::Item::Fn(item) => &item.attrs,
        syn::Item::Impl(item) => &item.attrs,
        syn::Item::Struct(item) => &item.attrs,
        syn::Item::Const(item) => &item.attrs,
        _ => return false,
    };
    attributes.iter().any(|attribute| {
        let is_test = |list: &syn::MetaList| list.path.is_ident("cfg") && list.tokens.to_string() == "test";
        attribute.meta.require_list().is_ok_and(is_test)
    })
}

/// Writes out a tree of `use`.
fn import(tree: &syn::UseTree, before: &mut ModulePath, imported: &mut Vec<ModulePath>) {
    match tree {
        syn::UseTree::Path(path) => {
            before.push(path.ident.to_string());
            import(&path.tree, before, imported);
            before.pop();
        }
        syn::UseTree::Name(syn::UseName { ident }) | syn::UseTree::Rename(syn::UseRename { ident, .. }) => {
            let mut path = before.clone();
            // `self` behind a module means the module.
            if ident != "self" || path.is_empty() {
                path.push(ident.to_string());
            }
            imported.push(path);
        }
        syn::UseTree::Glob(_) => imported.push(before.clone()),
        syn::UseTree::Group(group) => group.items.iter().for_each(|tree| import(tree, before, imported)),
    }
}

/// Paths among the tokens of a macro, which have no grammar.
fn name_in_tokens(tokens: TokenStream, named: &mut Vec<ModulePath>) {
    let mut path = ModulePath::new();
    // Signs since the last word: two of them, both `:`, continue a path.
    let mut colons = 0;
    let mut end = |path: &mut ModulePath| {
        if path.len() > 1 {
            named.push(std::mem::take(path));
        }
        path.clear();
    };
    let mut groups = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Ident(word) => {
                if colons != 2 {
                    end(&mut path);
                }
                path.push(word.to_string());
                colons = 0;
            }
            TokenTree::Punct(sign) if sign.as_char() == ':' => colons += 1,
            TokenTree::Group(group) => {
                end(&mut path);
                groups.push(group.stream());
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => end(&mut path),
        }
    }
    end(&mut path);
    for group in groups {
        name_in_tokens(group, named);
    }
}

#[test]
fn a_circle_is_found_through_imports_macros_and_names_that_are_exported_again() {
    let file = |path: &str, text: &str| (path.to_owned(), text.to_owned());
    let files = [
        file("lib.rs", "mod a; mod b; mod c; pub use b::Deep;"),
        file("a.rs", "use crate::{Deep, c::{self, Plain as Other}};"),
        file("b.rs", "mod deep; pub use deep::Deep;"),
        file("b/deep.rs", "fn f() { assert!(x, \"{}\", (crate::a::g())); }"),
        file(
            "c.rs",
            "// crate::a::g\n#[cfg(test)]\nmod tests { use crate::a::g; }\nconst TEXT: &str = \"crate::a::g\";",
        ),
    ];
    assert_eq!(Modules::read(&files).circles(), [["a", "b"]]);
}
