//! Parts common to documents and groups: nodes, links, knobs, variants, frames and ports.

use std::collections::{BTreeMap, BTreeSet};

use super::fields::{Fields, text, value};
use crate::document::GroupInput;
use crate::file_error::ReadError;
use crate::format;
use crate::graph::{ExposedParameter, Frame};
use crate::id_text::check_port_name;
use crate::json::{Json, Member, Tree};
use crate::name::{NOT_IN_KNOBS, check_name};
use crate::problem::Problem;
use crate::validate;
use crate::{Graph, KnobCurve, Node, NodeDisplay, NodeId, NodeRows, Note, OutputRef, PortType, SlotRef, Value};

/// Width of a note whose file does not give one, in canvas points.
const NOTE_WIDTH: f64 = 240.0;

pub(super) struct BodyContent {
    pub(super) graph: Graph,
    pub(super) inputs: BTreeMap<String, GroupInput>,
    pub(super) outputs: BTreeMap<String, OutputRef>,
}

/// A link and its offset in the text.
struct ReadLink {
    at: usize,
    reader: NodeId,
    input: String,
    from: OutputRef,
}

pub(super) fn read_body(fields: &mut Fields, group_names: &BTreeSet<String>) -> Result<BodyContent, ReadError> {
    let mut graph = Graph::default();
    read_nodes(&mut graph, fields, group_names)?;
    for member in fields.map("exposed")? {
        check_name("knob", &member.key, NOT_IN_KNOBS).map_err(at(member.key_at))?;
        let knob = read_exposed(&graph, member.value, &member.key)?;
        graph.exposed.insert(member.key, knob);
    }
    for member in fields.map("variants")? {
        check_name("variant", &member.key, "").map_err(at(member.key_at))?;
        let values = read_variant(&graph, member.value, &member.key)?;
        graph.variants.insert(member.key, values);
    }
    for member in fields.map("frames")? {
        check_name("frame", &member.key, "").map_err(at(member.key_at))?;
        graph.frames.insert(member.key, read_frame(member.value)?);
    }
    for member in fields.map("notes")? {
        check_name("note", &member.key, "").map_err(at(member.key_at))?;
        graph.notes.insert(member.key, read_note(member.value)?);
    }
    let inputs = read_inputs(&graph, fields.map("inputs")?)?;
    let outputs = read_outputs(&graph, fields.map("outputs")?)?;
    Ok(BodyContent { graph, inputs, outputs })
}

/// Returns a function that adds an offset in the text to a problem.
fn at(at: usize) -> impl Fn(Problem) -> ReadError {
    move |problem| ReadError::new(at, problem)
}

fn read_nodes(graph: &mut Graph, fields: &mut Fields, group_names: &BTreeSet<String>) -> Result<(), ReadError> {
    let mut links = Vec::new();
    let nodes = fields.need("nodes", "a graph has \"nodes\": {}, even when there are none")?;
    for member in super::fields::members(nodes, "nodes")? {
        let id: NodeId = member.key.parse().map_err(at(member.key_at))?;
        let node = read_node(&id, member.value, group_names, &mut links).map_err(|error| error.in_node(id.as_str()))?;
        graph.insert(id, node).map_err(at(member.key_at))?;
    }
    for link in &links {
        graph
            .link(&link.reader, link.input.clone(), link.from.clone())
            .map_err(|problem| link_error(link, problem))?;
    }
    graph.check_order().map_err(|problem| {
        let closes = |link: &&ReadLink| match &problem {
            Problem::Cycle { nodes } => nodes.first() == Some(&link.reader) && nodes.last() == Some(&link.from.node),
            _ => false,
        };
        match links.iter().find(closes) {
            Some(link) => link_error(link, problem),
            None => ReadError::new(0, problem),
        }
    })
}

fn link_error(link: &ReadLink, problem: Problem) -> ReadError {
    ReadError::new(link.at, problem)
        .in_node(link.reader.as_str())
        .in_port(&link.input)
}

/// Reads a node without its links, which are appended to `links`.
fn read_node(id: &NodeId, json: Json, groups: &BTreeSet<String>, links: &mut Vec<ReadLink>) -> Result<Node, ReadError> {
    let begin = json.at;
    let mut fields = Fields::of(json, "nodes", &format::NODE)?;
    let kind_json = fields
        .take("kind")
        .ok_or_else(|| ReadError::new(begin, Problem::NoKind))?;
    let kind_at = kind_json.at;
    let kind = text(kind_json, "kind")?;
    let group_json = fields.take("group");
    let group_at = group_json.as_ref().map_or(kind_at, |json| json.at);
    let group = group_json.map(|json| text(json, "group")).transpose()?;
    let pos = fields.pair("pos")?.unwrap_or([0.0; 2]);
    let node = Node {
        kind,
        params: read_params(fields.map("params")?)?,
        pos: pos.map(|x| x as f32),
        muted: fields.flag("muted")?,
        display: read_display(&mut fields)?,
        label: fields.text("label")?,
        group,
        extra: BTreeMap::new(),
    };
    validate::kind_and_group(&node, |name| groups.contains(name), groups.iter().map(String::as_str))
        .map_err(at(group_at))?;
    for member in fields.map("inputs")? {
        let in_port = |error: ReadError| error.in_port(&member.key);
        check_port_name(&member.key).map_err(at(member.key_at))?;
        let from_at = member.value.at;
        let from = text(member.value, &member.key).map_err(in_port)?;
        links.push(ReadLink {
            at: from_at,
            reader: id.clone(),
            from: from.parse().map_err(at(from_at)).map_err(in_port)?,
            input: member.key,
        });
    }
    Ok(Node {
        extra: fields.extra()?,
        ..node
    })
}

fn read_params(members: Vec<Member>) -> Result<BTreeMap<String, Value>, ReadError> {
    let kept = |member: Member| {
        let value = value(member.value, &member.key)?;
        Ok((member.key, value))
    };
    members.into_iter().map(kept).collect()
}

/// Reads texts of the form `node.name`. The nodes must exist.
fn read_slots(graph: &Graph, fields: &mut Fields) -> Result<Vec<SlotRef>, ReadError> {
    let mut slots = Vec::new();
    for (begin, text) in fields.texts("to")? {
        let slot: SlotRef = text.parse().map_err(at(begin))?;
        graph.find(slot.node.as_str()).map_err(at(begin))?;
        slots.push(slot);
    }
    Ok(slots)
}

fn read_exposed(graph: &Graph, json: Json, name: &str) -> Result<ExposedParameter, ReadError> {
    let begin = json.at;
    let mut fields = Fields::of(json, "exposed", &format::EXPOSED)?;
    let knob = ExposedParameter {
        to: read_slots(graph, &mut fields)?,
        curves: read_curves(fields.map("curves")?)?,
        label: fields.text("label")?,
        about: fields.text("about")?,
        section: fields.text("section")?,
        order: fields.whole("order")?,
        range: fields.pair("range")?,
        default: fields.take("default").map(|json| value(json, "default")).transpose()?,
        extra: fields.extra()?,
    };
    validate::knob(graph, name, &knob).map_err(at(begin))?;
    Ok(knob)
}

fn read_curves(members: Vec<Member>) -> Result<BTreeMap<SlotRef, KnobCurve>, ReadError> {
    let read = |member: Member| {
        let slot = member.key.parse().map_err(at(member.key_at))?;
        let begin = member.value.at;
        let points = value(member.value, &member.key)?;
        let bad = || {
            ReadError::new(
                begin,
                Problem::BadCurve {
                    slot: member.key.clone(),
                },
            )
        };
        let curve = points
            .as_list()
            .and_then(|points| KnobCurve::new(points.iter().map(pair).collect::<Option<_>>()?));
        Ok((slot, curve.ok_or_else(bad)?))
    };
    members.into_iter().map(read).collect()
}

fn pair(point: &Value) -> Option<[f64; 2]> {
    match point.as_list()? {
        [knob, value] => Some([knob.as_number()?, value.as_number()?]),
        _ => None,
    }
}

fn read_variant(graph: &Graph, json: Json, name: &str) -> Result<BTreeMap<String, Value>, ReadError> {
    let mut values = BTreeMap::new();
    for member in super::fields::members(json, name)? {
        validate::variant_sets(graph, name, &member.key).map_err(at(member.key_at))?;
        values.insert(member.key.clone(), value(member.value, &member.key)?);
    }
    Ok(values)
}

fn read_display(fields: &mut Fields) -> Result<NodeDisplay, ReadError> {
    let rows = match fields.take("rows") {
        None => NodeRows::All,
        Some(json) => {
            let named = |(_, name): &&(NodeRows, &str)| matches!(&json.tree, Tree::Text(text) if text == name);
            let found = NodeRows::NAMES.iter().find(named).map(|(rows, _)| *rows);
            found.ok_or_else(|| ReadError::expected(&json, "rows", "\"all\", \"wired\" or \"none\""))?
        }
    };
    Ok(NodeDisplay {
        rows,
        has_named_wires: fields.flag("named_wires")?,
    })
}

fn read_note(json: Json) -> Result<Note, ReadError> {
    let mut fields = Fields::of(json, "notes", &format::NOTE)?;
    let text = fields.need("text", "a note has a text")?;
    Ok(Note {
        text: super::fields::text(text, "text")?,
        pos: fields.pair("pos")?.unwrap_or([0.0; 2]).map(|x| x as f32),
        width: fields.number("width")?.unwrap_or(NOTE_WIDTH) as f32,
        color: fields.text("color")?,
        extra: fields.extra()?,
    })
}

fn read_frame(json: Json) -> Result<Frame, ReadError> {
    let mut fields = Fields::of(json, "frames", &format::FRAME)?;
    let parsed = |(begin, id): (usize, String)| id.parse().map_err(at(begin));
    Ok(Frame {
        title: fields.text("title")?,
        color: fields.text("color")?,
        nodes: fields
            .texts("nodes")?
            .into_iter()
            .map(parsed)
            .collect::<Result<_, _>>()?,
        extra: fields.extra()?,
    })
}

fn read_inputs(graph: &Graph, members: Vec<Member>) -> Result<BTreeMap<String, GroupInput>, ReadError> {
    let mut inputs = BTreeMap::new();
    let mut fed = validate::FedInputs::new();
    for member in members {
        check_port_name(&member.key).map_err(at(member.key_at))?;
        let mut fields = Fields::of(member.value, &member.key, &format::INPUT)?;
        let input = GroupInput {
            to: read_slots(graph, &mut fields)?,
            ty: fields.take("type").map(read_type).transpose()?,
            label: fields.text("label")?,
            extra: fields.extra()?,
        };
        validate::group_input(graph, &mut fed, &member.key, &input).map_err(at(member.key_at))?;
        inputs.insert(member.key, input);
    }
    Ok(inputs)
}

fn read_type(json: Json) -> Result<PortType, ReadError> {
    let word = text(json.clone(), "type")?;
    let named = PortType::ALL.into_iter().find(|ty| ty.to_string() == word);
    named.ok_or_else(|| ReadError::expected(&json, "type", "\"mask\", \"color\", \"vector\" or \"material\""))
}

fn read_outputs(graph: &Graph, members: Vec<Member>) -> Result<BTreeMap<String, OutputRef>, ReadError> {
    let mut outputs = BTreeMap::new();
    for member in members {
        check_port_name(&member.key).map_err(at(member.key_at))?;
        let begin = member.value.at;
        let from: OutputRef = text(member.value, &member.key)?.parse().map_err(at(begin))?;
        graph.find(from.node.as_str()).map_err(at(begin))?;
        outputs.insert(member.key, from);
    }
    Ok(outputs)
}
