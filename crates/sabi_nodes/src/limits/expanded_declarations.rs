//! Depth and length of declarations, including the declarations that they refer to.

use std::collections::BTreeMap;

use super::array_sizes::ArraySizes;
use super::outline::{Declaration, Outline};

/// Declarations, expanded with everything that they refer to.
pub(super) struct ExpandedDeclarations {
    nodes: Vec<DeclarationNode>,
    expanded: Vec<ExpandedSize>,
    /// Total number of words and signs of all declarations.
    pub(super) total: u64,
    /// Longest declaration.
    pub(super) largest: usize,
}

/// Depth and length of a declaration including the declarations that it refers to.
#[derive(Clone, Copy, Debug, Default)]
struct ExpandedSize {
    depth: usize,
    length: u64,
}

/// All declarations with one name. A declaration inside of a function counts together with all others of its name: for
/// a limit, it does not matter to which of them a word refers.
#[derive(Debug)]
struct DeclarationNode {
    /// The first of these declarations.
    declaration: usize,
    is_function: bool,
    own: ExpandedSize,
    /// Other nodes that it refers to, each with the depth of the reference.
    names: Vec<(usize, usize)>,
}

impl ExpandedDeclarations {
    pub(super) fn of(outline: &Outline<'_>, sizes: &ArraySizes) -> ExpandedDeclarations {
        let nodes = nodes(outline, sizes);
        let expanded = expand(&nodes);
        let lengths = expanded.iter().map(|expanded| expanded.length);
        let total = lengths.clone().fold(0, u64::saturating_add);
        let largest = lengths.enumerate().max_by_key(|(_, length)| *length);
        ExpandedDeclarations {
            largest: largest.map_or(0, |(node, _)| nodes[node].declaration),
            nodes,
            expanded,
            total,
        }
    }

    /// Returns a declaration whose depth exceeds a limit, with its depth. If possible, it is one that refers to no
    /// other such declaration.
    pub(super) fn first_deeper_than(&self, limit: usize) -> Option<(usize, usize)> {
        let is_deep = |node: usize| self.expanded[node].depth > limit;
        let deep = || (0..self.nodes.len()).filter(|node| is_deep(*node));
        let first = deep().find(|node| !self.nodes[*node].names.iter().any(|(named, _)| is_deep(*named)));
        let node = first.or(deep().next())?;
        Some((self.nodes[node].declaration, self.expanded[node].depth))
    }
}

fn nodes(outline: &Outline<'_>, sizes: &ArraySizes) -> Vec<DeclarationNode> {
    let mut nodes: Vec<DeclarationNode> = Vec::new();
    let mut by_name: BTreeMap<&str, usize> = BTreeMap::new();
    let mut node_of = Vec::new();
    for (index, declaration) in outline.declarations.iter().enumerate() {
        let known = by_name.get(declaration.name).filter(|_| !declaration.name.is_empty());
        let node = known.copied().unwrap_or(nodes.len());
        if node == nodes.len() {
            nodes.push(DeclarationNode {
                declaration: index,
                is_function: true,
                own: ExpandedSize::default(),
                names: Vec::new(),
            });
            by_name.insert(declaration.name, node);
        }
        let own = &mut nodes[node];
        own.is_function &= declaration.is_function;
        own.own.depth = own.own.depth.max(declaration.depth);
        own.own.length = own
            .own
            .length
            .saturating_add(declaration.length + sizes.elements(index));
        node_of.push(node);
    }
    by_name.remove("");
    for (declaration, node) in outline.declarations.iter().zip(node_of) {
        nodes[node].names.extend(named(declaration, &by_name));
    }
    nodes
}

fn named<'a>(
    declaration: &'a Declaration<'_>,
    by_name: &'a BTreeMap<&str, usize>,
) -> impl Iterator<Item = (usize, usize)> + 'a {
    let words = declaration.named.iter();
    words.filter_map(|word| Some((*by_name.get(word.name)?, word.depth)))
}

/// Expands each node with the nodes that it refers to. A node that refers to itself through others, which naga refuses, counts once.
fn expand(nodes: &[DeclarationNode]) -> Vec<ExpandedSize> {
    let mut expanded: Vec<Option<ExpandedSize>> = vec![None; nodes.len()];
    let mut is_open = vec![false; nodes.len()];
    for root in 0..nodes.len() {
        // The current path of nodes, each with the number of its references that are done. The path replaces recursion,
        // which could exhaust the stack.
        let mut way = vec![(root, 0)];
        while let Some((node, next)) = way.last_mut() {
            if expanded[*node].is_some() {
                way.pop();
                continue;
            }
            is_open[*node] = true;
            if let Some((named, _)) = nodes[*node].names.get(*next) {
                *next += 1;
                if !is_open[*named] {
                    way.push((*named, 0));
                }
                continue;
            }
            expanded[*node] = Some(with_names(nodes, *node, &expanded));
            way.pop();
        }
    }
    // Every node was expanded as a root.
    expanded.into_iter().map(Option::unwrap_or_default).collect()
}

fn with_names(nodes: &[DeclarationNode], node: usize, expanded: &[Option<ExpandedSize>]) -> ExpandedSize {
    let DeclarationNode { own, names, .. } = &nodes[node];
    let mut all = *own;
    for (named, depth) in names {
        let Some(inner) = expanded[*named] else { continue };
        all.depth = all.depth.max(depth + inner.depth);
        // A function is called, not copied to the place of the call.
        if !nodes[*named].is_function {
            all.length = all.length.saturating_add(inner.length);
        }
    }
    all
}
