//! Rewrites relative paths of a document that moves to another folder.

use std::collections::{BTreeMap, BTreeSet};

use crate::document::{GroupDef, Preview};
use crate::graph::ExposedParameter;
use crate::validate::is_group_file;
use crate::{Body, Document, Edit, GROUP_KIND, Graph, Node, SlotRef, Value};

/// Change of paths when a file moves to another folder.
#[derive(Clone, Copy)]
pub struct Relocation<'a> {
    /// Returns whether a parameter of a kind holds the path of a file. Arguments are the kind without its version, and the
    /// name of the parameter.
    pub is_file: &'a dyn Fn(&str, &str) -> bool,
    /// Converts a path relative to the old folder to one relative to the new folder.
    pub moved: &'a dyn Fn(&str) -> String,
}

impl Document {
    /// Returns a copy of this document for another folder: its paths to the model, images and group files are rewritten to
    /// lead to the same files.
    pub fn relocated(&self, relocation: Relocation<'_>) -> Document {
        let paths = PathRewriter {
            relocation,
            states: vec![self],
        };
        let mut moved = self.clone();
        paths.preview(moved.preview.as_mut());
        paths.graph(&Body::Main, &mut moved.graph);
        for (name, group) in &mut moved.groups {
            paths.group(name, group);
        }
        moved
    }
}

/// Rewrites the paths in documents and edits. Whether a parameter is a path follows from the kind of its node, which is
/// looked up in `states`.
pub(crate) struct PathRewriter<'a> {
    pub(crate) relocation: Relocation<'a>,
    pub(crate) states: Vec<&'a Document>,
}

impl PathRewriter<'_> {
    /// Rewrites the paths that an edit adds to the document.
    pub(crate) fn edit(&self, edit: &mut Edit) {
        match edit {
            Edit::AddNode { node, .. } => self.node(node),
            Edit::SetParam {
                body,
                node,
                param,
                value: Some(value),
            } => {
                let slot = SlotRef {
                    node: node.clone(),
                    name: param.clone(),
                };
                self.value(value, self.is_file(body, &slot));
            }
            Edit::Expose { body, knob, .. } => self.knob(body, knob),
            Edit::SetVariant {
                body,
                values: Some(values),
                ..
            } => self.variant(body, values),
            Edit::AddGroup { name, group } | Edit::SetGroup { name, group } => self.group(name, group),
            Edit::SetPreview { preview } => self.preview(preview.as_mut()),
            Edit::Replace { document } => **document = document.relocated(self.relocation),
            Edit::Batch(edits) => edits.iter_mut().for_each(|edit| self.edit(edit)),
            _ => {}
        }
    }

    fn preview(&self, preview: Option<&mut Preview>) {
        let Some(preview) = preview else { return };
        // A model that comes with the program is no file.
        let mesh = match preview.builtin_mesh() {
            Some(_) => None,
            None => preview.mesh.as_mut(),
        };
        for path in [mesh, preview.textures.as_mut()].into_iter().flatten() {
            *path = (self.relocation.moved)(path);
        }
    }

    fn group(&self, name: &str, group: &mut GroupDef) {
        self.graph(&Body::Group(name.to_owned()), &mut group.graph);
    }

    fn graph(&self, body: &Body, graph: &mut Graph) {
        for (_, node) in graph.net.node_weights_mut() {
            self.node(node);
        }
        for knob in graph.exposed.values_mut() {
            self.knob(body, knob);
        }
        for values in graph.variants.values_mut() {
            self.variant(body, values);
        }
    }

    fn node(&self, node: &mut Node) {
        let Node {
            kind, group, params, ..
        } = node;
        for (param, value) in params {
            self.value(
                value,
                self.names_file(kind, group.as_deref(), param, &mut BTreeSet::new()),
            );
        }
        if let Some(name) = group
            && is_group_file(name)
            && !self.states.iter().any(|state| state.groups.contains_key(name))
        {
            *name = (self.relocation.moved)(name);
        }
    }

    fn knob(&self, body: &Body, knob: &mut ExposedParameter) {
        let is_file = knob.to.iter().any(|slot| self.is_file(body, slot));
        if let Some(value) = &mut knob.default {
            self.value(value, is_file);
        }
    }

    fn variant(&self, body: &Body, values: &mut BTreeMap<String, Value>) {
        for (name, value) in values {
            let graphs = self.states.iter().filter_map(|state| state.body(body).ok());
            let mut knobs = graphs.filter_map(|graph| graph.exposed().get(name));
            let is_file = knobs.any(|knob| knob.to.iter().any(|slot| self.is_file(body, slot)));
            self.value(value, is_file);
        }
    }

    fn value(&self, value: &mut Value, is_file: bool) {
        if let Value::Text(path) = value
            && is_file
        {
            *path = (self.relocation.moved)(path);
        }
    }

    fn is_file(&self, body: &Body, slot: &SlotRef) -> bool {
        self.leads_to_file(body, slot, &mut BTreeSet::new())
    }

    fn leads_to_file(&self, body: &Body, slot: &SlotRef, seen: &mut BTreeSet<(String, String)>) -> bool {
        let graphs = self.states.iter().filter_map(|state| state.body(body).ok());
        let mut nodes = graphs.filter_map(|graph| graph.node(slot.node.as_str()));
        nodes.any(|node| self.names_file(&node.kind, node.group.as_deref(), &slot.name, seen))
    }

    /// Returns true if a parameter is a path. A parameter of an instance is a path if it sets a path inside the group.
    /// Paths inside a group file are relative to that file, which does not move.
    fn names_file(&self, kind: &str, group: Option<&str>, param: &str, seen: &mut BTreeSet<(String, String)>) -> bool {
        if kind != GROUP_KIND {
            let plain = kind.split_once('@').map_or(kind, |(plain, _)| plain);
            return (self.relocation.is_file)(plain, param);
        }
        let Some(group) = group else { return false };
        if !seen.insert((group.to_owned(), param.to_owned())) {
            return false;
        }
        let body = Body::Group(group.to_owned());
        let graphs = self.states.iter().filter_map(|state| state.body(&body).ok());
        let knobs = graphs.filter_map(|graph| graph.exposed().get(param));
        let slots: Vec<&SlotRef> = knobs.flat_map(|knob| &knob.to).collect();
        slots.into_iter().any(|slot| self.leads_to_file(&body, slot, seen))
    }
}

/// Returns true if an edit may add a path to the document.
pub(crate) fn may_bring_paths(edit: &Edit) -> bool {
    match edit {
        Edit::SetParam { value, .. } => matches!(value, Some(Value::Text(_))),
        Edit::AddNode { node, .. } => {
            node.group.is_some() || node.params.values().any(|value| matches!(value, Value::Text(_)))
        }
        Edit::Expose { knob, .. } => matches!(knob.default, Some(Value::Text(_))),
        Edit::SetVariant { .. }
        | Edit::AddGroup { .. }
        | Edit::SetGroup { .. }
        | Edit::SetPreview { .. }
        | Edit::Replace { .. } => true,
        Edit::Batch(edits) => edits.iter().any(may_bring_paths),
        _ => false,
    }
}
