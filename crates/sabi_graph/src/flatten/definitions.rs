//! Graphs that a document uses: its own, its groups that have instances, and group files.

use std::collections::BTreeMap;

use petgraph::stable_graph::NodeIndex;

use super::FlattenError;
use crate::document::{Document, Fit, GroupInput};
use crate::order;
use crate::problem::{hint, quoted};
use crate::validate::is_group_file;
use crate::{GROUP_KIND, Graph, NodeId, OutputRef};

/// Reads a group file by its path relative to the document.
pub(super) type ReadFile<'a> = &'a mut dyn FnMut(&str) -> Result<Document, String>;

/// Maximum number of group files. The limit ends recursion through folders that contain symbolic links to themselves.
const FILE_LIMIT: usize = 1000;

/// Address of a graph: a file (0 is the document), and a group in it or its main graph.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Address {
    file: usize,
    group: Option<String>,
}

/// The graphs in use. Number 0 is the document's main graph.
pub(super) struct Definitions<'a> {
    document: &'a Document,
    /// Fit of the document, or the override.
    fit: Fit,
    /// Group files with their paths. File `n` of an [`Address`] is at index `n - 1` here.
    files: Vec<(String, Document)>,
    addresses: Vec<Address>,
    /// The graph that each instance uses, by the graph that contains the instance and by the id of the instance.
    pub(super) instances: BTreeMap<(usize, NodeId), usize>,
}

/// One graph in use.
pub(super) struct Definition<'a> {
    pub(super) graph: &'a Graph,
    pub(super) inputs: &'a BTreeMap<String, GroupInput>,
    pub(super) outputs: &'a BTreeMap<String, OutputRef>,
    /// Fit of its lengths.
    pub(super) fit: Fit,
    /// Group file that defines it; `None` for the document.
    pub(super) file: Option<&'a str>,
}

impl<'a> Definitions<'a> {
    /// Collects all graphs that the document reaches.
    pub(super) fn collect(document: &'a Document, fit: Option<Fit>, read: ReadFile<'_>) -> Result<Self, FlattenError> {
        let mut all = Definitions {
            document,
            fit: fit.unwrap_or(document.fit),
            files: Vec::new(),
            addresses: vec![Address { file: 0, group: None }],
            instances: BTreeMap::new(),
        };
        let mut number_of = BTreeMap::from([(all.addresses[0].clone(), 0)]);
        let mut file_of = BTreeMap::new();
        let mut uses = Vec::new();
        while uses.len() < all.addresses.len() {
            let user = uses.len();
            let mut used = Vec::new();
            for (id, name) in all.groups_named_in(user) {
                let address = all.address(user, &id, &name, &mut file_of, read)?;
                let number = *number_of.entry(address.clone()).or_insert(all.addresses.len());
                if number == all.addresses.len() {
                    all.addresses.push(address);
                }
                all.instances.insert((user, id), number);
                used.push(number);
            }
            uses.push(used);
        }
        all.refuse_recursion(&uses)?;
        Ok(all)
    }

    /// One graph by its number.
    pub(super) fn get(&self, number: usize) -> Definition<'_> {
        let address = &self.addresses[number];
        let document = self.file(address.file);
        let file = address.file.checked_sub(1).map(|index| self.files[index].0.as_str());
        let fit = if address.file == 0 { self.fit } else { document.fit };
        match &address.group {
            Some(name) => {
                // An address exists only for a group that exists.
                let group = &document.groups[name];
                Definition {
                    graph: &group.graph,
                    inputs: &group.inputs,
                    outputs: &group.outputs,
                    fit: group.fit.unwrap_or(fit),
                    file,
                }
            }
            None => Definition {
                graph: &document.graph,
                inputs: &document.inputs,
                outputs: &document.outputs,
                fit,
                file,
            },
        }
    }

    /// Number of graphs.
    pub(super) fn len(&self) -> usize {
        self.addresses.len()
    }

    fn file(&self, number: usize) -> &Document {
        match number.checked_sub(1) {
            None => self.document,
            Some(index) => &self.files[index].1,
        }
    }

    /// Instances in a graph, each with the name of its group.
    fn groups_named_in(&self, number: usize) -> Vec<(NodeId, String)> {
        let named = |(id, node): (&NodeId, &crate::Node)| {
            let group = node.group.as_ref().filter(|_| node.kind == GROUP_KIND)?;
            Some((id.clone(), group.clone()))
        };
        self.get(number).graph.nodes().filter_map(named).collect()
    }

    /// Returns the graph that `name` refers to in an instance of graph `user`. A group file is read when it is first named.
    fn address(
        &mut self,
        user: usize,
        id: &NodeId,
        name: &str,
        file_of: &mut BTreeMap<String, usize>,
        read: &mut dyn FnMut(&str) -> Result<Document, String>,
    ) -> Result<Address, FlattenError> {
        let from = self.addresses[user].file;
        let document = self.file(from);
        if document.groups.contains_key(name) {
            let group = Some(name.to_owned());
            return Ok(Address { file: from, group });
        }
        if !is_group_file(name) {
            return Err(FlattenError::NoSuchGroup {
                instance: self.label(user, id),
                name: quoted(name),
                hint: hint(name, document.groups.keys().map(String::as_str)),
            });
        }
        let base = from.checked_sub(1).map_or("", |index| self.files[index].0.as_str());
        let path = resolve(base, name);
        if let Some(&file) = file_of.get(&path) {
            return Ok(Address { file, group: None });
        }
        if self.files.len() == FILE_LIMIT {
            return Err(FlattenError::TooManyFiles { limit: FILE_LIMIT });
        }
        let document = read(&path).map_err(|why| FlattenError::GroupFile {
            instance: self.label(user, id),
            file: quoted(&path),
            why,
        })?;
        self.files.push((path.clone(), document));
        file_of.insert(path, self.files.len());
        Ok(Address {
            file: self.files.len(),
            group: None,
        })
    }

    /// A node for messages, with the graph it is in.
    fn label(&self, number: usize, id: &NodeId) -> String {
        match number {
            0 => quoted(id.as_str()),
            _ => format!("{} in group {}", quoted(id.as_str()), quoted(&self.name(number))),
        }
    }

    /// A graph's name for messages.
    fn name(&self, number: usize) -> String {
        let Address { file, group } = &self.addresses[number];
        let path = file.checked_sub(1).map(|index| self.files[index].0.as_str());
        match (path, group) {
            (None, None) => "the graph".to_owned(),
            (None, Some(group)) => group.clone(),
            (Some(path), None) => path.to_owned(),
            (Some(path), Some(group)) => format!("{path}: {group}"),
        }
    }

    fn refuse_recursion(&self, uses: &[Vec<usize>]) -> Result<(), FlattenError> {
        let uses = uses.iter().enumerate();
        let uses = uses.flat_map(|(user, used)| used.iter().map(move |used| [user, *used]));
        let names: Vec<String> = (0..self.len()).map(|number| self.name(number)).collect();
        let name = |at: NodeIndex| names[at.index()].as_str();
        let Some(circle) = order::cycle(&order::net(self.len(), uses), name) else {
            return Ok(());
        };
        let mut chain: Vec<&str> = circle.into_iter().map(name).collect();
        chain.push(chain[0]);
        Err(FlattenError::Recursion {
            chain: chain.join(" → "),
        })
    }
}

/// Resolves a path written in `file` relative to the folder of `file`. Absolute paths are unchanged.
pub(super) fn resolve(file: &str, path: &str) -> String {
    let path = path.replace('\\', "/");
    let has_drive = path.as_bytes().get(1) == Some(&b':');
    let (root, folder) = match path.strip_prefix('/') {
        Some(_) => ("/", ""),
        None if has_drive => ("", ""),
        None => (
            if file.starts_with('/') { "/" } else { "" },
            file.rsplit_once('/').map_or("", |(folder, _)| folder),
        ),
    };
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(path.split('/')) {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => {
                parts.pop();
            }
            _ => parts.push(part),
        }
    }
    format!("{root}{}", parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::resolve;

    #[test]
    fn a_path_is_relative_to_the_file_that_contains_it() {
        for (file, path, found) in [
            ("", "rust.sabi", "rust.sabi"),
            ("lib/rust.sabi", "noise.sabi", "lib/noise.sabi"),
            ("lib/rust.sabi", "../noise.sabi", "noise.sabi"),
            ("lib/rust.sabi", "../../a/./noise.sabi", "../a/noise.sabi"),
            ("lib/rust.sabi", "/a/noise.sabi", "/a/noise.sabi"),
            ("/lib/rust.sabi", "noise.sabi", "/lib/noise.sabi"),
            ("lib/rust.sabi", "C:\\a\\noise.sabi", "C:/a/noise.sabi"),
        ] {
            assert_eq!(resolve(file, path), found);
        }
    }
}
