//! Catalog entry of each node of a document. It is the entry of its kind, except that an instance of a group has the entry
//! of the group, and a reroute has the type of the wire that it passes on.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use sabi_graph::{
    Body, Description, Document, ExposedParameter, GROUP_KIND, Graph, GroupInput, Node, NodeId, OutputRef, PortType,
    REROUTE_KIND, SlotRef,
};
use sabi_nodes::kind::{Memory, ParamType, ParamValue, Role};
use sabi_nodes::label_of;

use super::{Catalog, Interface, Knob, Port, placeholder};

/// Maximum nesting of group files. Deeper ones are shown as missing.
const DEEPEST_FILE: usize = 16;
/// Maximum nesting of groups. Deeper ones are shown as missing, and no evaluation accepts them.
const DEEPEST_GROUP: usize = 256;

/// Reads a group file by its path relative to the document that names it.
pub type ReadGroup<'a> = &'a mut dyn FnMut(&str) -> Option<Document>;

/// Catalog entries of the nodes of a document, by the graph that contains them and their id.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Interfaces {
    of_nodes: BTreeMap<Body, BTreeMap<NodeId, Arc<Interface>>>,
    /// Interface for a file that is used as a group.
    of_whole: Option<Arc<Interface>>,
    of_groups: BTreeMap<String, Arc<Interface>>,
}

impl Interfaces {
    /// Builds the entries for all nodes of a document.
    pub fn new(catalog: &Catalog, document: &Document, read: ReadGroup<'_>) -> Interfaces {
        Interfaces::within(catalog, document, read, 0)
    }

    fn within(catalog: &Catalog, document: &Document, read: ReadGroup<'_>, depth: usize) -> Interfaces {
        let mut builder = InterfacesBuilder {
            catalog,
            document,
            read,
            depth,
            interfaces: Interfaces::default(),
            open: BTreeSet::new(),
        };
        for name in document.groups.keys() {
            builder.group(name);
        }
        builder.body(&Body::Main);
        let InterfacesBuilder { mut interfaces, .. } = builder;
        interfaces.refresh_whole(document);
        interfaces
    }

    /// Rebuilds the entry for a file that is used as a group. Its knobs have the values of the main graph.
    pub fn refresh_whole(&mut self, document: &Document) {
        let whole = GroupBody {
            name: &document.name,
            description: &document.description,
            graph: &document.graph,
            inputs: &document.inputs,
            outputs: &document.outputs,
        };
        self.of_whole = Some(Arc::new(whole.entry(self, &Body::Main)));
    }

    /// Returns the entry of a node; `None` if there is no such node.
    pub fn of(&self, body: &Body, node: &str) -> Option<&Arc<Interface>> {
        self.of_nodes.get(body)?.get(node)
    }

    /// Returns the entry for instances of one of the document's own groups.
    pub fn of_group(&self, name: &str) -> Option<&Arc<Interface>> {
        self.of_groups.get(name)
    }

    /// Returns the entry for instances of the document itself, for other files that use it as a group.
    pub fn of_whole(&self) -> Option<&Arc<Interface>> {
        self.of_whole.as_ref()
    }

    /// Returns the type of the wires from an output; `None` if it is unknown.
    pub fn carried(&self, body: &Body, from: &OutputRef) -> Option<PortType> {
        let entry = self.of(body, from.node.as_str())?;
        entry.output(from.port.as_deref())?.ty
    }
}

/// Builder of the entries of a document.
struct InterfacesBuilder<'a, 'r> {
    catalog: &'a Catalog,
    document: &'a Document,
    read: ReadGroup<'r>,
    depth: usize,
    interfaces: Interfaces,
    /// Groups whose entries are being built. A group inside itself has no entry.
    open: BTreeSet<String>,
}

impl InterfacesBuilder<'_, '_> {
    /// Builds the entries of all nodes of one graph.
    fn body(&mut self, body: &Body) {
        let document = self.document;
        let (graph, inputs) = match body {
            Body::Main => (&document.graph, &document.inputs),
            Body::Group(name) => match document.groups.get(name) {
                Some(group) => (&group.graph, &group.inputs),
                None => return,
            },
        };
        let fed: BTreeSet<&SlotRef> = inputs.values().flat_map(|input| &input.to).collect();
        // The topological order lets a reroute find the type of its source.
        for id in graph.topological_order() {
            let Some(node) = graph.node(id.as_str()) else {
                continue;
            };
            let interface = self.interface(body, node, &graph.inputs(id.as_str()), |name| {
                let (node, name) = (id.clone(), name.to_owned());
                fed.contains(&SlotRef { node, name })
            });
            self.interfaces
                .of_nodes
                .entry(body.clone())
                .or_default()
                .insert(id, interface);
        }
    }

    /// Builds the entry for a node with links. `is_fed` returns true if an input of the group leads to that input of the node.
    fn interface(
        &mut self,
        body: &Body,
        node: &Node,
        links: &BTreeMap<&str, &OutputRef>,
        is_fed: impl Fn(&str) -> bool,
    ) -> Arc<Interface> {
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
            return with_param_masks(entry, |name| links.contains_key(name) || is_fed(name));
        }
        let source = links.get("source");
        let carried = source.and_then(|from| self.interfaces.carried(body, from));
        let mut reroute = Interface::clone(entry);
        for port in reroute.inputs.iter_mut().chain(&mut reroute.outputs) {
            port.ty = carried;
        }
        Arc::new(reroute)
    }

    /// Returns the entry for instances of a group, and builds it on first use.
    fn group(&mut self, name: &str) -> Option<Arc<Interface>> {
        if let Some(known) = self.interfaces.of_groups.get(name) {
            return Some(known.clone());
        }
        if self.open.len() == DEEPEST_GROUP || !self.open.insert(name.to_owned()) {
            return None;
        }
        let made = match self.document.groups.get(name) {
            Some(group) => {
                let body = Body::Group(name.to_owned());
                self.body(&body);
                let exposed = GroupBody {
                    name: group.name.as_deref().unwrap_or(name),
                    description: &group.description,
                    graph: &group.graph,
                    inputs: &group.inputs,
                    outputs: &group.outputs,
                };
                Some(Arc::new(exposed.entry(&self.interfaces, &body)))
            }
            None => self.file(name),
        };
        self.open.remove(name);
        if let Some(made) = &made {
            self.interfaces.of_groups.insert(name.to_owned(), made.clone());
        }
        made
    }

    fn file(&mut self, name: &str) -> Option<Arc<Interface>> {
        if self.depth >= DEEPEST_FILE {
            return None;
        }
        let document = (self.read)(name)?;
        // Files that it names are relative to its folder.
        let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
        let read = &mut self.read;
        let mut beside = |inner: &str| match folder.as_str() {
            "" => read(inner),
            folder => read(&format!("{folder}/{inner}")),
        };
        Interfaces::within(self.catalog, &document, &mut beside, self.depth + 1).of_whole
    }
}

/// Returns the entry with inputs for the masks that are linked to parameters of a node.
fn with_param_masks(entry: &Arc<Interface>, is_linked: impl Fn(&str) -> bool) -> Arc<Interface> {
    let masks = entry.param_masks.iter();
    let linked: Vec<Port> = masks.filter(|port| is_linked(&port.name)).cloned().collect();
    if linked.is_empty() {
        return entry.clone();
    }
    let mut with = Interface::clone(entry);
    with.inputs.extend(linked);
    Arc::new(with)
}

/// A graph with the inputs and outputs that it exposes as a group.
struct GroupBody<'a> {
    name: &'a str,
    description: &'a Description,
    graph: &'a Graph,
    inputs: &'a BTreeMap<String, GroupInput>,
    outputs: &'a BTreeMap<String, OutputRef>,
}

impl GroupBody<'_> {
    fn entry(&self, interfaces: &Interfaces, body: &Body) -> Interface {
        let inputs = self.inputs.iter().map(|(name, input)| {
            let targets: Vec<&Port> = input
                .to
                .iter()
                .filter_map(|slot| target_port(interfaces, body, slot))
                .collect();
            Port {
                name: name.clone(),
                label: input.label.clone().unwrap_or_else(|| label_of(name)),
                doc: targets.first().map_or_else(String::new, |port| port.doc.clone()),
                ty: input.ty.or_else(|| targets.iter().find_map(|port| port.ty)),
                is_required: targets.iter().any(|port| port.is_required),
                unconnected: targets.first().and_then(|port| port.unconnected.clone()),
                starts: None,
            }
        });
        let outputs = self.outputs.iter().map(|(name, from)| {
            let inner = interfaces.of(body, from.node.as_str());
            let port = inner.and_then(|entry| entry.output(from.port.as_deref()));
            Port {
                name: name.clone(),
                label: label_of(name),
                doc: port.map_or_else(String::new, |port| port.doc.clone()),
                ty: port.and_then(|port| port.ty),
                is_required: false,
                unconnected: None,
                starts: None,
            }
        });
        let exposed = self.graph.exposed_in_order().into_iter();
        let knobs = exposed.filter_map(|(name, knob)| self.knob(interfaces, body, name, knob));
        let instance = any_group();
        let about = self.description.about.as_deref();
        Interface {
            label: if self.name.is_empty() {
                instance.label
            } else {
                self.name.to_owned()
            },
            summary: about.unwrap_or("A graph used as a node.").to_owned(),
            aliases: self.description.words.clone(),
            inputs: inputs.collect(),
            outputs: outputs.collect(),
            knobs: knobs.chain(self.instance_knobs()).collect(),
            ..instance
        }
    }

    /// Builds an exposed knob, which looks like the first knob that it sets.
    fn knob(&self, interfaces: &Interfaces, body: &Body, name: &str, exposed: &ExposedParameter) -> Option<Knob> {
        let slot = exposed.to.first()?;
        let entry = interfaces.of(body, slot.node.as_str())?;
        let inner = entry.knob(&slot.name)?;
        let set = self.graph.node(slot.node.as_str())?.params.get(&slot.name);
        let default = exposed.default.as_ref().or(set).unwrap_or(&inner.ty.default).clone();
        let inner_type = match exposed.curves.is_empty() {
            true => inner.ty.clone(),
            // The parameters accept other values than the knob, which is a plain number.
            false => ParamType::new(Role::Plain, Memory::F32, &ParamValue::Floats(vec![0.0])),
        };
        Some(Knob {
            name: name.to_owned(),
            label: exposed.label.clone().unwrap_or_else(|| label_of(name)),
            doc: exposed.about.clone().unwrap_or_else(|| inner.doc.clone()),
            ty: ParamType {
                range: exposed.range.or(inner_type.range),
                soft: exposed.range.or(inner_type.soft),
                default,
                ..inner_type
            },
            is_of_input: false,
        })
    }

    /// Lists the knobs of every instance, without those whose names the group has exposed.
    fn instance_knobs(&self) -> Vec<Knob> {
        let mut knobs = vec![seed_knob(), scale_knob(), fit_knob()];
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

/// Returns the entry of group instances without a known group.
pub(super) fn any_group() -> Interface {
    let none = ParamValue::Text("none".to_owned());
    let variant = ParamType::new(Role::Text, Memory::Text, &none);
    let doc = "Variant of the group to start from; its exposed knobs are parameters, too.";
    Interface {
        id: GROUP_KIND.to_owned(),
        version: 1,
        label: "Group".to_owned(),
        summary: "A graph used as a node: \"group\" names a group of the same file, or a graph file beside it."
            .to_owned(),
        description: String::new(),
        aliases: ["subgraph", "instance"].map(str::to_owned).to_vec(),
        inputs: Vec::new(),
        param_masks: Vec::new(),
        outputs: Vec::new(),
        knobs: vec![
            seed_knob(),
            scale_knob(),
            fit_knob(),
            instance_knob("variant", doc, variant),
        ],
        shape: None,
        source: None,
    }
}

fn seed_knob() -> Knob {
    let ty = ParamType::new(Role::Seed, Memory::U32, &ParamValue::Unsigned(0));
    instance_knob("seed", "Gives this instance its own random patterns.", ty)
}

fn scale_knob() -> Knob {
    let ty = ParamType {
        soft: Some([0.25, 4.0]),
        ..ParamType::new(Role::Plain, Memory::F32, &ParamValue::Floats(vec![1.0]))
    };
    instance_knob("scale", "Multiplies all lengths inside the group.", ty)
}

fn fit_knob() -> Knob {
    let words = ["as_made", "piece", "unit", "metres"].map(str::to_owned);
    let ty = ParamType::new(Role::Choice(words.to_vec()), Memory::U32, &ParamValue::Unsigned(0));
    let doc = "Length that counts as 1 inside the group: as the group was made for, the size of each piece of the model, \
               the model's largest side, or a metre.";
    instance_knob("fit", doc, ty)
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

fn target_port<'f>(interfaces: &'f Interfaces, body: &Body, slot: &SlotRef) -> Option<&'f Port> {
    interfaces.of(body, slot.node.as_str())?.input(&slot.name)
}
