//! Catalog of the node kinds as artists see them: names, ports and knobs, independent of the implementation of a kind.

pub mod check;
pub mod description;
pub mod diagnosis;
mod interfaces;
mod knob;
pub mod node_file;
mod picture;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::sync::Arc;

use sabi_graph::{GROUP_KIND, PortType, REROUTE_KIND, Value};
use sabi_nodes::kind::{Input, InputDefault, Kind, Output, Param, Role, Shape};
use sabi_nodes::label_of;
use sabi_plan::{SourceKind, SourcePort};

pub use interfaces::{Interfaces, ReadGroup};
pub use knob::Knob;
pub(crate) use picture::first_square;
pub use picture::{has_picture, picture_of, small_picture};

use crate::opening::kinds::Kinds;

/// A kind of node, or one group instance, as an artist sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface {
    /// Identifier as in graph files, `category/name`.
    pub id: String,
    /// Version of the algorithm.
    pub version: u32,
    /// Name shown to artists.
    pub label: String,
    /// One sentence.
    pub summary: String,
    /// Description after the summary, Markdown; may be empty.
    pub description: String,
    /// Other words that an artist may search for.
    pub aliases: Vec<String>,
    /// Inputs in order.
    pub inputs: Vec<Port>,
    /// Inputs for masks that multiply parameters at each place, in the order of the parameters. An input of a node includes
    /// one of them only if a wire or an input of the group leads to it.
    pub param_masks: Vec<Port>,
    /// Outputs in order. A wire that names no output reads the first one.
    pub outputs: Vec<Port>,
    /// Knobs in order. Those of inputs that are not connected come last.
    pub knobs: Vec<Knob>,
    /// Access pattern to its inputs, for a kind in a WGSL file.
    pub shape: Option<Shape>,
    /// Text of its WGSL file; `None` for other kinds.
    pub source: Option<Arc<str>>,
}

/// An input or output of a node.
#[derive(Clone, Debug, PartialEq)]
pub struct Port {
    /// Name in graph files.
    pub name: String,
    /// Name shown to artists.
    pub label: String,
    /// Description of its purpose, for artists.
    pub doc: String,
    /// Type of its wires; `None` if any type fits, for example in a reroute to which nothing is connected.
    pub ty: Option<PortType>,
    /// True if the node has no result unless this is connected.
    pub is_required: bool,
    /// Value of an input's knob, or a description of the default, while nothing is connected.
    pub unconnected: Option<Value>,
    /// Parameter of an input, with the value that it receives when a wire is connected by hand, unless it already has a value.
    pub starts: Option<(String, Value)>,
}

impl Port {
    /// Returns true if a wire of type `from` may end at this port. `None` is an unknown type, which fits any port.
    pub fn accepts(&self, from: Option<PortType>) -> bool {
        match (self.ty, from) {
            (Some(ty), Some(from)) => ty.accepts(from),
            _ => true,
        }
    }
}

impl Interface {
    /// Returns the part of the id before the slash, by which menus group nodes.
    pub fn category(&self) -> &str {
        self.id
            .split_once('/')
            .map_or(self.id.as_str(), |(category, _)| category)
    }

    /// Returns the input with a name, including inputs for masks that multiply parameters.
    pub fn input(&self, name: &str) -> Option<&Port> {
        self.inputs
            .iter()
            .chain(&self.param_masks)
            .find(|port| port.name == name)
    }

    /// Returns the input for the mask that multiplies a parameter, if the parameter accepts one.
    pub fn param_mask(&self, name: &str) -> Option<&Port> {
        self.param_masks.iter().find(|port| port.name == name)
    }

    /// Lists the inputs without those for masks that multiply parameters.
    pub fn plain_inputs(&self) -> impl Iterator<Item = &Port> {
        self.inputs.iter().filter(|port| self.param_mask(&port.name).is_none())
    }

    /// Returns the output with a name, or the first output without one.
    pub fn output(&self, name: Option<&str>) -> Option<&Port> {
        match name {
            Some(name) => self.outputs.iter().find(|port| port.name == name),
            None => self.outputs.first(),
        }
    }

    /// Returns the knob with a name.
    pub fn knob(&self, name: &str) -> Option<&Knob> {
        self.knobs.iter().find(|knob| knob.name == name)
    }

    /// Returns the first plain input that accepts a wire of a type. An exact match is preferred to a conversion.
    pub fn input_for(&self, carries: Option<PortType>) -> Option<&Port> {
        let exact = self.plain_inputs().find(|port| port.ty == carries);
        exact.or_else(|| self.plain_inputs().find(|port| port.accepts(carries)))
    }

    /// Returns the first output that an input accepts. An exact match is preferred to a conversion.
    pub fn output_for(&self, input: &Port) -> Option<&Port> {
        let exact = self.outputs.iter().find(|port| port.ty == input.ty);
        exact.or_else(|| self.outputs.iter().find(|port| input.accepts(port.ty)))
    }
}

/// All node kinds by id.
#[derive(Clone, Debug, Default)]
pub struct Catalog {
    entries: BTreeMap<String, Arc<Interface>>,
}

impl Catalog {
    /// Builds the catalog of all kinds.
    pub fn new(kinds: &Kinds) -> Catalog {
        let of_files = kinds.library.kinds().map(entry_of_kind);
        let of_rust = kinds.sources.values().chain(kinds.sinks.values()).map(entry_of_source);
        let all = of_files.chain(of_rust).chain([reroute(), interfaces::any_group()]);
        Catalog {
            entries: all.map(|entry| (entry.id.clone(), Arc::new(entry))).collect(),
        }
    }

    /// Lists the kinds that can be added to a graph by their id, sorted by id; groups are added by name instead.
    pub fn entries(&self) -> impl Iterator<Item = &Arc<Interface>> {
        self.entries.values().filter(|entry| entry.id != GROUP_KIND)
    }

    /// Lists all kinds sorted by id, groups included.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Interface> {
        self.entries.values().map(Arc::as_ref)
    }

    /// Returns the kind with an id, which may have a version.
    pub fn entry(&self, kind: &str) -> Option<&Arc<Interface>> {
        let plain = kind.split_once('@').map_or(kind, |(plain, _)| plain);
        self.entries.get(plain)
    }
}

fn entry_of_kind(kind: &Kind) -> Interface {
    let shown = kind
        .params
        .iter()
        .filter(|param| !matches!(param.ty.role, Role::Extent { .. }));
    let of_inputs = kind.inputs.iter().filter_map(Knob::of_input);
    let inputs = kind.inputs.iter().map(|input| Port {
        name: input.name.clone(),
        label: input.label.clone(),
        doc: input.doc.clone(),
        ty: Some(input.ty),
        is_required: input.default == InputDefault::Required,
        unconnected: unconnected(input),
        starts: input.starts.clone(),
    });
    Interface {
        id: kind.id.clone(),
        version: kind.version,
        label: kind.label.clone(),
        summary: kind.summary.clone(),
        description: kind.description.clone(),
        aliases: kind.aliases.clone(),
        inputs: inputs.collect(),
        param_masks: kind
            .params
            .iter()
            .filter(|param| param.takes_mask)
            .map(param_mask)
            .collect(),
        outputs: kind.outputs.iter().map(port_of_output).collect(),
        knobs: shown.map(Knob::of_param).chain(of_inputs).collect(),
        shape: Some(kind.shape),
        source: Some(kind.source.clone()),
    }
}

fn unconnected(input: &Input) -> Option<Value> {
    match &input.default {
        InputDefault::Required => None,
        InputDefault::Knob(_) => input.knob().map(|ty| ty.default),
        InputDefault::Expression(expression) => Some(expression.as_str().into()),
        InputDefault::PlainMaterial => Some("a plain gray material".into()),
    }
}

/// Returns the input for a mask that multiplies a parameter.
fn param_mask(param: &Param) -> Port {
    Port {
        name: param.name.clone(),
        label: param.label.clone(),
        doc: format!("Multiplies the parameter at each place. {}", param.doc),
        ty: Some(PortType::Mask),
        is_required: false,
        unconnected: None,
        starts: None,
    }
}

fn port_of_output(output: &Output) -> Port {
    Port {
        name: output.name.clone(),
        label: label_of(&output.name),
        doc: output.doc.clone(),
        ty: Some(output.ty),
        is_required: false,
        unconnected: None,
        starts: None,
    }
}

fn entry_of_source(kind: &SourceKind) -> Interface {
    let port = |port: &SourcePort, is_required: bool| Port {
        name: port.name.clone(),
        label: label_of(&port.name),
        doc: port.doc.clone(),
        ty: Some(port.ty),
        is_required,
        unconnected: port.unconnected.as_deref().map(Value::from),
        starts: None,
    };
    Interface {
        id: kind.id.clone(),
        version: 1,
        label: kind.label.clone(),
        summary: kind.summary.clone(),
        description: String::new(),
        aliases: kind.aliases.clone(),
        inputs: kind
            .inputs
            .iter()
            .map(|input| port(input, input.unconnected.is_none()))
            .collect(),
        param_masks: Vec::new(),
        outputs: kind.outputs.iter().map(|output| port(output, false)).collect(),
        knobs: kind.params.iter().map(Knob::of_param).collect(),
        shape: None,
        source: None,
    }
}

/// Returns the entry of reroutes.
fn reroute() -> Interface {
    let port = |doc: &str| Port {
        name: "source".to_owned(),
        label: "Source".to_owned(),
        doc: doc.to_owned(),
        ty: None,
        is_required: false,
        unconnected: None,
        starts: None,
    };
    Interface {
        id: REROUTE_KIND.to_owned(),
        version: 1,
        label: "Reroute".to_owned(),
        summary: "A bend in a wire; passes its input on unchanged.".to_owned(),
        description: String::new(),
        aliases: ["bend", "dot", "knot", "anchor point", "portal"]
            .map(str::to_owned)
            .to_vec(),
        inputs: vec![port("Anything.")],
        param_masks: Vec::new(),
        outputs: vec![port("The same.")],
        knobs: Vec::new(),
        shape: None,
        source: None,
    }
}

/// Returns an entry for a node of an unknown kind, which is kept and shown and has no outputs.
pub(crate) fn placeholder(kind: &str) -> Interface {
    let is_group = kind == GROUP_KIND;
    Interface {
        id: kind.to_owned(),
        version: 1,
        label: if is_group { "Group".to_owned() } else { kind.to_owned() },
        summary: match is_group {
            true => "The group that this node names does not exist.".to_owned(),
            false => "This kind is not known; the node is kept unchanged.".to_owned(),
        },
        description: String::new(),
        aliases: Vec::new(),
        inputs: Vec::new(),
        param_masks: Vec::new(),
        outputs: Vec::new(),
        knobs: Vec::new(),
        shape: None,
        source: None,
    }
}
