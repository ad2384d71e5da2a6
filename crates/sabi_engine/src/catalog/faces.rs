//! What each node of a document shows: the kind's face, but a group's own one for its instances, and of reroutes the type of
//! what they pass on.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use sabi_graph::{
    Body, Document, Exposed, GROUP_KIND, Graph, GroupInput, Node, NodeId, OutputRef, PortType, REROUTE_KIND, SlotRef,
};
use sabi_nodes::kind::{Memory, ParamType, ParamValue, Role};

use super::{Catalog, Entry, Knob, Port, label_of, placeholder};

/// Group files inside group files beyond this are shown as if they were not there.
const DEEPEST_FILE: usize = 16;
/// Groups inside groups beyond this are, too; no evaluation takes them.
const DEEPEST_GROUP: usize = 256;

/// Reads a group file by its path relative to the document that names it.
pub type ReadGroup<'a> = &'a mut dyn FnMut(&str) -> Option<Document>;

/// What the nodes of a document show, by the graph they are in and their id.
#[derive(Clone, Debug, Default)]
pub struct Faces {
    of_nodes: BTreeMap<Body, BTreeMap<NodeId, Arc<Entry>>>,
    /// Of a file that is used as a group.
    of_whole: Option<Arc<Entry>>,
    of_groups: BTreeMap<String, Arc<Entry>>,
}

impl Faces {
    /// What is shown of a document's nodes.
    pub fn new(catalog: &Catalog, document: &Document, read: ReadGroup<'_>) -> Faces {
        Faces::within(catalog, document, read, 0)
    }

    fn within(catalog: &Catalog, document: &Document, read: ReadGroup<'_>, depth: usize) -> Faces {
        let mut making = Making {
            catalog,
            document,
            read,
            depth,
            faces: Faces::default(),
            open: BTreeSet::new(),
        };
        for name in document.groups.keys() {
            making.group(name);
        }
        making.body(&Body::Main);
        let Making { mut faces, .. } = making;
        let whole = Published {
            name: &document.name,
            graph: &document.graph,
            inputs: &document.inputs,
            outputs: &document.outputs,
        };
        faces.of_whole = Some(Arc::new(whole.entry(&faces, &Body::Main)));
        faces
    }

    /// What a node shows; none where there is no such node.
    pub fn of(&self, body: &Body, node: &str) -> Option<&Arc<Entry>> {
        self.of_nodes.get(body)?.get(node)
    }

    /// What an instance of one of the document's own groups shows.
    pub fn of_group(&self, name: &str) -> Option<&Arc<Entry>> {
        self.of_groups.get(name)
    }

    /// What an instance of the document itself shows, when another file uses it as a group.
    pub fn of_whole(&self) -> Option<&Arc<Entry>> {
        self.of_whole.as_ref()
    }

    /// What is carried by a wire from there.
    pub fn carried(&self, body: &Body, from: &OutputRef) -> Option<PortType> {
        let entry = self.of(body, from.node.as_str())?;
        entry.output(from.port.as_deref())?.ty
    }
}

/// A document whose faces are being made.
struct Making<'a, 'r> {
    catalog: &'a Catalog,
    document: &'a Document,
    read: ReadGroup<'r>,
    depth: usize,
    faces: Faces,
    /// Groups that are being made: one that is inside itself shows nothing.
    open: BTreeSet<String>,
}

impl Making<'_, '_> {
    /// Makes the faces of all nodes of one graph.
    fn body(&mut self, body: &Body) {
        let document = self.document;
        let graph = match body {
            Body::Main => &document.graph,
            Body::Group(name) => match document.groups.get(name) {
                Some(group) => &group.graph,
                None => return,
            },
        };
        // Sources first, so that a reroute finds what it reads.
        for id in graph.topological_order() {
            let Some(node) = graph.node(id.as_str()) else {
                continue;
            };
            let face = self.face(body, node);
            self.faces.of_nodes.entry(body.clone()).or_default().insert(id, face);
        }
    }

    fn face(&mut self, body: &Body, node: &Node) -> Arc<Entry> {
        let catalog = self.catalog;
        let kind = node.kind.as_str();
        if kind == GROUP_KIND {
            let found = node.group.as_deref().and_then(|name| self.group(name));
            return found.unwrap_or_else(|| Arc::new(placeholder(kind)));
        }
        let Some(entry) = catalog.entry(kind) else {
            return Arc::new(placeholder(kind));
        };
        if kind != REROUTE_KIND {
            return entry.clone();
        }
        let carried = node
            .inputs
            .get("source")
            .and_then(|from| self.faces.carried(body, from));
        let mut bent = Entry::clone(entry);
        for port in bent.inputs.iter_mut().chain(&mut bent.outputs) {
            port.ty = carried;
        }
        Arc::new(bent)
    }

    /// What instances of a group show.
    fn group(&mut self, name: &str) -> Option<Arc<Entry>> {
        if let Some(known) = self.faces.of_groups.get(name) {
            return Some(known.clone());
        }
        if self.open.len() == DEEPEST_GROUP || !self.open.insert(name.to_owned()) {
            return None;
        }
        let made = match self.document.groups.get(name) {
            Some(group) => {
                let body = Body::Group(name.to_owned());
                self.body(&body);
                let published = Published {
                    name: group.name.as_deref().unwrap_or(name),
                    graph: &group.graph,
                    inputs: &group.inputs,
                    outputs: &group.outputs,
                };
                Some(Arc::new(published.entry(&self.faces, &body)))
            }
            None => self.file(name),
        };
        self.open.remove(name);
        if let Some(made) = &made {
            self.faces.of_groups.insert(name.to_owned(), made.clone());
        }
        made
    }

    fn file(&mut self, name: &str) -> Option<Arc<Entry>> {
        if self.depth >= DEEPEST_FILE {
            return None;
        }
        let document = (self.read)(name)?;
        // Files that it names lie beside it.
        let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
        let read = &mut self.read;
        let mut beside = |inner: &str| match folder.as_str() {
            "" => read(inner),
            folder => read(&format!("{folder}/{inner}")),
        };
        Faces::within(self.catalog, &document, &mut beside, self.depth + 1).of_whole
    }
}

/// A graph with what it shows to those who use it as a group.
struct Published<'a> {
    name: &'a str,
    graph: &'a Graph,
    inputs: &'a BTreeMap<String, GroupInput>,
    outputs: &'a BTreeMap<String, OutputRef>,
}

impl Published<'_> {
    fn entry(&self, faces: &Faces, body: &Body) -> Entry {
        let inputs = self.inputs.iter().map(|(name, input)| {
            let fed: Vec<&Port> = input.to.iter().filter_map(|slot| fed_port(faces, body, slot)).collect();
            Port {
                name: name.clone(),
                label: input.label.clone().unwrap_or_else(|| label_of(name)),
                doc: fed.first().map_or_else(String::new, |port| port.doc.clone()),
                ty: input.ty.or_else(|| fed.iter().find_map(|port| port.ty)),
                is_required: fed.iter().any(|port| port.is_required),
                unconnected: fed.first().and_then(|port| port.unconnected.clone()),
            }
        });
        let outputs = self.outputs.iter().map(|(name, from)| {
            let inner = faces.of(body, from.node.as_str());
            let port = inner.and_then(|entry| entry.output(from.port.as_deref()));
            Port {
                name: name.clone(),
                label: label_of(name),
                doc: port.map_or_else(String::new, |port| port.doc.clone()),
                ty: port.and_then(|port| port.ty),
                is_required: false,
                unconnected: None,
            }
        });
        let exposed = self.graph.panel().into_iter();
        let knobs = exposed.filter_map(|(name, knob)| self.knob(faces, body, name, knob));
        let instance = any_group();
        Entry {
            label: if self.name.is_empty() {
                instance.label
            } else {
                self.name.to_owned()
            },
            summary: "A graph in the graph.".to_owned(),
            aliases: Vec::new(),
            inputs: inputs.collect(),
            outputs: outputs.collect(),
            knobs: knobs.chain(self.instance_knobs()).collect(),
            ..instance
        }
    }

    /// An exposed knob looks like the first knob that it turns.
    fn knob(&self, faces: &Faces, body: &Body, name: &str, exposed: &Exposed) -> Option<Knob> {
        let slot = exposed.to.first()?;
        let entry = faces.of(body, slot.node.as_str())?;
        let inner = entry.knob(&slot.name)?;
        let set = self.graph.node(slot.node.as_str())?.params.get(&slot.name);
        let default = exposed.default.as_ref().or(set).unwrap_or(&inner.ty.default).clone();
        Some(Knob {
            name: name.to_owned(),
            label: exposed.label.clone().unwrap_or_else(|| label_of(name)),
            ty: ParamType {
                range: exposed.range.or(inner.ty.range),
                soft: exposed.range.or(inner.ty.soft),
                default,
                ..inner.ty.clone()
            },
            is_of_input: false,
            ..inner.clone()
        })
    }

    /// Knobs of every instance, without those whose names the group has published: they mean the published ones.
    fn instance_knobs(&self) -> Vec<Knob> {
        let mut knobs = vec![seed_knob(), scale_knob()];
        if !self.graph.variants().is_empty() {
            let words = std::iter::once("none".to_owned()).chain(self.graph.variants().keys().cloned());
            let variants = Role::Choice(words.collect());
            let ty = ParamType::new(variants, Memory::U32, &ParamValue::Unsigned(0));
            knobs.push(instance_knob("variant", "Variant of the group to start from.", ty));
        }
        knobs.retain(|knob| !self.graph.exposed().contains_key(&knob.name));
        knobs
    }
}

/// The kind of group instances, whatever group they are of.
pub(super) fn any_group() -> Entry {
    let none = ParamValue::Text("none".to_owned());
    let variant = ParamType::new(Role::Text, Memory::Text, &none);
    let doc = "Variant of the group to start from; its exposed knobs are parameters too.";
    Entry {
        id: GROUP_KIND.to_owned(),
        version: 1,
        label: "Group".to_owned(),
        summary: "A graph in the graph: \"group\" names one of the file's groups, or a graph file beside it."
            .to_owned(),
        description: String::new(),
        aliases: ["subgraph", "instance"].map(str::to_owned).to_vec(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        knobs: vec![seed_knob(), scale_knob(), instance_knob("variant", doc, variant)],
        shape: None,
        source: None,
    }
}

fn seed_knob() -> Knob {
    let ty = ParamType::new(Role::Seed, Memory::U32, &ParamValue::Unsigned(0));
    instance_knob("seed", "Gives this instance patterns of its own.", ty)
}

fn scale_knob() -> Knob {
    let ty = ParamType {
        soft: Some([0.25, 4.0]),
        ..ParamType::new(Role::Plain, Memory::F32, &ParamValue::Floats(vec![1.0]))
    };
    instance_knob("scale", "Multiplies all lengths inside.", ty)
}

fn instance_knob(name: &str, doc: &str, ty: ParamType) -> Knob {
    Knob {
        name: name.to_owned(),
        label: label_of(name),
        doc: doc.to_owned(),
        ty,
        is_of_input: false,
    }
}

fn fed_port<'f>(faces: &'f Faces, body: &Body, slot: &SlotRef) -> Option<&'f Port> {
    faces.of(body, slot.node.as_str())?.input(&slot.name)
}
