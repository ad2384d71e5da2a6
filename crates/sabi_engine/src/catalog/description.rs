//! Descriptions of node kinds for `sabi nodes --json` and the reference; docs/report.md lists the keys.

use sabi_graph::{PortType, Value};
use schemars::JsonSchema;
use serde::Serialize;

use super::{Catalog, Interface, Knob, Port};
use crate::opening::kinds::Kinds;

/// A kind of node.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct NodeDescription {
    /// Identifier as in graph files, `category/name`.
    pub id: String,
    /// Version of the algorithm.
    pub version: u32,
    /// Name shown to artists.
    pub label: String,
    /// One sentence.
    pub summary: String,
    /// Markdown; may be empty.
    pub description: String,
    /// Other words that an artist may search for.
    pub aliases: Vec<String>,
    /// Access pattern of a node written in WGSL to its inputs: `point`, `field`, `ray` or `survey`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<&'static str>,
    /// Inputs in order.
    pub inputs: Vec<InputDescription>,
    /// Outputs in order. A wire that names no output reads the first one.
    pub outputs: Vec<OutputDescription>,
    /// Parameters in order, without those that are defaults of inputs.
    pub params: Vec<ParamDescription>,
}

/// An input of a kind.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct InputDescription {
    /// Name in graph files.
    pub name: String,
    /// Name shown to artists.
    pub label: String,
    /// `mask`, `color`, `vector`, `material`, or `any`.
    #[serde(rename = "type")]
    pub ty: String,
    /// Description of its effect, for artists.
    pub doc: String,
    /// True if the node has no result unless this is connected.
    pub required: bool,
    /// Value of the knob, or a description of the default, while nothing is connected.
    #[schemars(with = "Option<serde_json::Value>")]
    pub default: Option<Value>,
}

/// An output of a kind.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OutputDescription {
    /// Name in graph files.
    pub name: String,
    /// Name shown to artists.
    pub label: String,
    /// `mask`, `color`, `vector`, `material`, or `any`.
    #[serde(rename = "type")]
    pub ty: String,
    /// Description of the result, for artists.
    pub doc: String,
}

/// A parameter of a kind.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ParamDescription {
    /// Name in graph files.
    pub name: String,
    /// Name shown to artists.
    pub label: String,
    /// Description of its effect, for artists.
    pub doc: String,
    /// Sort of values: `number`, `toggle`, `choice`, `color`, `length`, `angle`, `seed`, `stops`, `curve`, `text` or `file`.
    pub takes: &'static str,
    /// Default value in the form of a graph file.
    #[schemars(with = "serde_json::Value")]
    pub default: Value,
    /// Words of a choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub choices: Option<Vec<String>>,
    /// Lowest and highest number taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f64; 2]>")]
    pub range: Option<[Value; 2]>,
    /// Ends of the slider.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f64; 2]>")]
    pub soft: Option<[Value; 2]>,
    /// True if a mask can be linked to it like to an input. The mask multiplies it at each place.
    pub takes_mask: bool,
}

/// All node kinds, sorted by id.
pub fn describe_nodes(kinds: &Kinds) -> Vec<NodeDescription> {
    Catalog::new(kinds).all().map(NodeDescription::of).collect()
}

impl NodeDescription {
    fn of(entry: &Interface) -> NodeDescription {
        let params = entry.knobs.iter().filter(|knob| !knob.is_of_input);
        NodeDescription {
            id: entry.id.clone(),
            version: entry.version,
            label: entry.label.clone(),
            summary: entry.summary.clone(),
            description: entry.description.clone(),
            aliases: entry.aliases.clone(),
            shape: entry.shape.map(sabi_nodes::kind::Shape::name),
            inputs: entry.inputs.iter().map(InputDescription::of).collect(),
            outputs: entry.outputs.iter().map(OutputDescription::of).collect(),
            params: params.map(|knob| ParamDescription::of(entry, knob)).collect(),
        }
    }
}

impl InputDescription {
    fn of(port: &Port) -> InputDescription {
        InputDescription {
            name: port.name.clone(),
            label: port.label.clone(),
            ty: type_name(port.ty),
            doc: port.doc.clone(),
            required: port.is_required,
            default: port.unconnected.clone(),
        }
    }
}

impl OutputDescription {
    fn of(port: &Port) -> OutputDescription {
        OutputDescription {
            name: port.name.clone(),
            label: port.label.clone(),
            ty: type_name(port.ty),
            doc: port.doc.clone(),
        }
    }
}

impl ParamDescription {
    fn of(entry: &Interface, knob: &Knob) -> ParamDescription {
        let ty = &knob.ty;
        let ends = |ends: Option<[f64; 2]>| ends.map(|ends| ends.map(Value::Number));
        ParamDescription {
            name: knob.name.clone(),
            label: knob.label.clone(),
            doc: knob.doc.clone(),
            takes: ty.role.name(),
            default: ty.default.clone(),
            choices: ty.role.choices().map(<[String]>::to_vec),
            range: ends(ty.range),
            soft: ends(ty.soft),
            takes_mask: entry.param_masks.iter().any(|port| port.name == knob.name),
        }
    }
}

fn type_name(ty: Option<PortType>) -> String {
    ty.map_or_else(|| "any".to_owned(), |ty| ty.to_string())
}
