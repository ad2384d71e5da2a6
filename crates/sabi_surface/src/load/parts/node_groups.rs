//! Parts of a file with the nodes above them, whose names count as well: programs sort levels of detail and hulls into groups.

use crate::load::text::part_name;

/// A node that may have parts below it.
pub(in crate::load) struct NodeGroup {
    /// Empty for a node without a name.
    pub(super) name: String,
    /// Node above it, which stands before it in the list.
    pub(super) above: Option<usize>,
    /// True if it is a part itself: then only what its name means counts for those below it.
    pub(super) is_part: bool,
}

/// Nodes of a file, each behind the one above it.
#[derive(Default)]
pub(in crate::load) struct NodeGroups(Vec<NodeGroup>);

/// A part by its name, and the node above it.
#[derive(Clone, Copy, Debug)]
pub(in crate::load) struct NamedPart<'n> {
    pub(in crate::load) name: &'n str,
    pub(in crate::load) group: Option<usize>,
}

impl NodeGroups {
    /// Adds a node and returns its number.
    pub(in crate::load) fn add(&mut self, name: &str, above: Option<usize>, is_part: bool) -> usize {
        self.0.push(NodeGroup {
            name: part_name(name),
            above,
            is_part,
        });
        self.0.len() - 1
    }

    pub(super) fn all(&self) -> &[NodeGroup] {
        &self.0
    }

    /// Returns for each node the value that `of` gives, or else the value of the node above it.
    pub(super) fn inherited<T: Clone>(&self, of: impl Fn(usize, &NodeGroup) -> Option<T>) -> Vec<Option<T>> {
        let mut found: Vec<Option<T>> = Vec::with_capacity(self.0.len());
        for (number, group) in self.0.iter().enumerate() {
            let above = || group.above.and_then(|above| found[above].clone());
            found.push(of(number, group).or_else(above));
        }
        found
    }

    /// Number of the parts below each node.
    pub(super) fn counts(&self, parts: &[NamedPart]) -> Vec<usize> {
        let mut counts = vec![0; self.0.len()];
        for group in parts.iter().filter_map(|part| part.group) {
            counts[group] += 1;
        }
        for (number, group) in self.0.iter().enumerate().rev() {
            if let Some(above) = group.above {
                counts[above] += counts[number];
            }
        }
        counts
    }
}
