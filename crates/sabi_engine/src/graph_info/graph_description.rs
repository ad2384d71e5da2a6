//! Descriptions of graphs for `sabi info`: knobs, outputs, and files; docs/report.md lists the keys.

use std::collections::BTreeMap;

use sabi_graph::{Body, Document, ExposedParameter, Fit, FlatGraph, Overrides, SlotRef, Value, format_version};
use schemars::JsonSchema;
use serde::Serialize;

use super::graph_files::{FileDescription, GraphFiles};
use crate::baking::made_of::recorded_fit::FitText;
use crate::catalog::{Catalog, Interfaces};
use crate::evaluating::outputs::{missing_output, outputs};
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::source::map_output;
use sabi_nodes::kind::Role;
use sabi_nodes::label_of;

/// A graph.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct GraphDescription {
    /// Path of the graph as it was given.
    pub graph: String,
    /// Display name; may be empty.
    pub name: String,
    /// Description for artists, as a sentence or two.
    pub about: Option<String>,
    /// Words that it is found by.
    pub words: Vec<String>,
    /// Version of the file format that the file is written in.
    pub version: u32,
    /// Length on the model that counts as 1: `unit`, `metres`, `piece`, or a number of meters.
    #[schemars(with = "FitText")]
    pub fit: Value,
    /// Seed of the document.
    pub seed: u32,
    /// Number of nodes after groups are inlined; `None` if they cannot be.
    pub nodes: Option<usize>,
    /// Exposed knobs in the order in which they are shown.
    pub knobs: Vec<KnobDescription>,
    /// Variants by name.
    pub variants: Vec<VariantDescription>,
    /// Outputs that are not muted, by id.
    pub outputs: Vec<GraphOutput>,
    /// Groups that the file defines, by name.
    pub groups: Vec<GroupDescription>,
    /// Files that it uses besides its own, by role and path.
    pub files: Vec<FileDescription>,
    /// Sentences about things that are missing, or probably not intended.
    pub warnings: Vec<String>,
}

/// An exposed knob of a graph.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct KnobDescription {
    /// Name in graph files and on the command line.
    pub name: String,
    /// Name shown to artists.
    pub label: String,
    /// Description of its effect, for artists.
    pub doc: String,
    /// Title of the section that contains it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub section: Option<String>,
    /// Parameters that it sets, `node.param`.
    pub to: Vec<String>,
    /// Type of its values, as for a parameter of a node; `None` if the node or its kind is not known.
    pub takes: Option<&'static str>,
    /// Unit of its numbers: `degrees`, or `fit` for lengths. A length of 1 is the length that the fit names.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// Default value of the first parameter.
    #[schemars(with = "Option<serde_json::Value>")]
    pub default: Option<Value>,
    /// Value in this graph, without a variant.
    #[schemars(with = "Option<serde_json::Value>")]
    pub value: Option<Value>,
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
}

/// A variant of a graph.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct VariantDescription {
    /// Its name.
    pub name: String,
    /// Values that it sets, by knob.
    #[schemars(with = "BTreeMap<String, serde_json::Value>")]
    pub values: BTreeMap<String, Value>,
}

/// An output of a graph.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct GraphOutput {
    /// Id of the node.
    pub node: String,
    /// `output/material`, `output/mask`, `output/color` or `output/vector`.
    pub kind: String,
    /// Materials of the model that receive the result, separated by commas; `*` for all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub materials: Option<String>,
    /// Name of the map of a mask.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// A group that a graph file defines.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct GroupDescription {
    /// Name in the file.
    pub name: String,
    /// Name shown to artists.
    pub label: String,
    /// Library file that it is a copy of.
    pub library: Option<String>,
}

/// Describes a graph. Missing or faulty parts are left out and named in a warning.
pub fn describe_graph(open: &OpenGraph) -> GraphDescription {
    let kinds = Kinds::beside(Some(&open.path), &open.trusted);
    let document = &open.document;
    let mut warnings: Vec<String> = kinds.left_out().into_iter().collect();
    let files = GraphFiles::of(open, &kinds);
    let flat = open.flatten(&Overrides::default());
    match &flat {
        Ok(flat) => warnings.extend(missing_output(flat).map(|why| open.with_path(why))),
        // The warnings about files include group files that cannot be opened.
        Err(_) if files.lacks_groups => {}
        Err(error) => warnings.extend(error.messages.iter().cloned()),
    }
    let flat = flat.ok();
    warnings.extend(files.warnings);
    warnings.extend(open.unknown_keys());
    GraphDescription {
        graph: open.path.display().to_string(),
        name: document.name.clone(),
        about: document.description.about.clone(),
        words: document.description.words.clone(),
        // The text has been read already, so it has a version.
        version: format_version(&open.text).unwrap_or_default(),
        fit: fit(document.fit),
        seed: document.seed,
        nodes: flat.as_ref().map(|flat| flat.nodes.len()),
        knobs: knobs(open, &kinds),
        variants: variants(document),
        outputs: flat
            .as_ref()
            .map_or_else(Vec::new, |flat| described_outputs(flat, &kinds)),
        groups: groups(document),
        files: files.files,
        warnings,
    }
}

fn fit(fit: Fit) -> Value {
    match fit {
        Fit::Unit => "unit".into(),
        Fit::Metres => "metres".into(),
        Fit::Piece => "piece".into(),
        Fit::Length(length) => Value::Number(length),
    }
}

fn variants(document: &Document) -> Vec<VariantDescription> {
    let variants = document.graph.variants().iter();
    variants
        .map(|(name, values)| VariantDescription {
            name: name.clone(),
            values: values.clone(),
        })
        .collect()
}

fn groups(document: &Document) -> Vec<GroupDescription> {
    let groups = document.groups.iter();
    groups
        .map(|(name, group)| GroupDescription {
            name: name.clone(),
            label: group.name.clone().unwrap_or_else(|| name.clone()),
            library: group.library.as_ref().map(|library| library.file.clone()),
        })
        .collect()
}

fn knobs(open: &OpenGraph, kinds: &Kinds) -> Vec<KnobDescription> {
    let mut group_file = |name: &str| Some(open.open_group(name).ok()?.document);
    let interfaces = Interfaces::new(&Catalog::new(kinds), &open.document, &mut group_file);
    let exposed = open.document.graph.exposed_in_order().into_iter();
    exposed
        .map(|(name, exposed)| KnobDescription::of(name, exposed, &open.document, &interfaces))
        .collect()
}

impl KnobDescription {
    fn of(name: &str, exposed: &ExposedParameter, document: &Document, interfaces: &Interfaces) -> KnobDescription {
        // The knob is taken from the interface that this graph has as a node, where the default is the value that the
        // graph sets.
        let knob = interfaces.of_whole().and_then(|whole| whole.knob(name));
        let ty = knob.map(|knob| &knob.ty);
        let first = exposed.to.first();
        let set = || {
            let node = document.graph.node(first?.node.as_str())?;
            node.params.get(&first?.name).cloned()
        };
        let value = ty.map(|ty| ty.default.clone());
        let value = value.or_else(|| exposed.default.clone()).or_else(set);
        // The parameters accept other values than a knob with curves.
        let of_param = || default_of_param(interfaces, first?);
        let default = match exposed.curves.is_empty() {
            true => of_param(),
            false => exposed.default.clone(),
        };
        let ends = |ends: Option<[f64; 2]>| ends.map(|ends| ends.map(Value::Number));
        KnobDescription {
            name: name.to_owned(),
            label: knob.map_or_else(|| label_of(name), |knob| knob.label.clone()),
            doc: knob.map_or_else(String::new, |knob| knob.doc.clone()),
            section: exposed.section.clone(),
            to: exposed.to.iter().map(ToString::to_string).collect(),
            takes: ty.map(|ty| ty.role.name()),
            unit: ty.and_then(|ty| unit(&ty.role)),
            default,
            value,
            choices: ty.and_then(|ty| Some(ty.role.choices()?.to_vec())),
            range: ends(ty.map_or(exposed.range, |ty| ty.range)),
            soft: ends(ty.and_then(|ty| ty.soft)),
        }
    }
}

fn default_of_param(interfaces: &Interfaces, slot: &SlotRef) -> Option<Value> {
    let entry = interfaces.of(&Body::Main, slot.node.as_str())?;
    Some(entry.knob(&slot.name)?.ty.default.clone())
}

fn unit(role: &Role) -> Option<&'static str> {
    match role {
        Role::Angle => Some("degrees"),
        Role::Length => Some("fit"),
        _ => None,
    }
}

fn described_outputs(flat: &FlatGraph, kinds: &Kinds) -> Vec<GraphOutput> {
    let described = |index: usize| {
        let node = &flat.nodes[index];
        let map = map_output(node);
        let materials = || {
            let default = kinds.param_type(&node.kind, "materials").map(|ty| ty.default);
            let value = node.params.get("materials").cloned().or(default);
            value.and_then(|value| value.as_text().map(str::to_owned))
        };
        GraphOutput {
            node: node.id.clone(),
            kind: node.kind.clone(),
            materials: if map.is_some() { None } else { materials() },
            name: map.and_then(|map| map.output_name().map(str::to_owned)),
        }
    };
    outputs(flat).into_iter().map(described).collect()
}
