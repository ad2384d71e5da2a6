//! `sabi nodes`: the kinds of nodes.

use std::fmt::Write as _;

use sabi_engine::{Kinds, describe_nodes, nearest};
use serde_json::Value as Json;

use crate::arguments::NodesArguments;
use crate::exit::{Exit, Failure};
use crate::terminal::{Terminal, plain};

pub(crate) fn run(arguments: &NodesArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let kinds = Kinds::beside(arguments.graph.as_deref());
    for fault in &kinds.faults {
        terminal.warning(fault.to_string());
    }
    let nodes = describe_nodes(&kinds);
    match &arguments.id {
        None if arguments.json => terminal.json(&Json::Array(nodes))?,
        None => terminal.data(&table(&nodes))?,
        Some(word) => {
            let found = find(&nodes, word)?;
            match found.as_slice() {
                [node] if arguments.json => terminal.json(node)?,
                [node] => terminal.data(&details(node))?,
                several if arguments.json => terminal.json(&Json::Array(several.to_vec()))?,
                several => terminal.data(&table(several))?,
            }
        }
    }
    Ok(Exit::Done)
}

/// The kind of that id, or all that an artist may mean by a word: in the id, the label or the aliases.
fn find(nodes: &[Json], id: &str) -> Result<Vec<Json>, Failure> {
    if let Some(node) = nodes.iter().find(|node| text(&node["id"]) == id) {
        return Ok(vec![node.clone()]);
    }
    let word = id.to_lowercase();
    let is_meant = |node: &&Json| {
        let names = [&node["id"], &node["label"]].into_iter().chain(list(&node["aliases"]));
        names.map(text).any(|name| name.to_lowercase().contains(&word))
    };
    let meant: Vec<Json> = nodes.iter().filter(is_meant).cloned().collect();
    if !meant.is_empty() {
        return Ok(meant);
    }
    let advice = match nearest(id, nodes.iter().map(|node| text(&node["id"]))) {
        Some(near) => format!("did you mean '{near}'?"),
        None => "'sabi nodes' lists all".to_owned(),
    };
    let why = format!("there is no kind of node '{id}'; {advice}");
    Err(Failure::new(Exit::Usage, why))
}

fn text(json: &Json) -> &str {
    json.as_str().unwrap_or_default()
}

fn list(json: &Json) -> &[Json] {
    json.as_array().map_or(&[], Vec::as_slice)
}

/// Ids and what they do, one kind a line.
fn table(nodes: &[Json]) -> String {
    let width = nodes.iter().map(|node| text(&node["id"]).len()).max().unwrap_or(0);
    let lines = nodes.iter().map(|node| {
        let summary = text(&node["summary"]).replace('\n', " ");
        format!("{:width$}  {summary}\n", text(&node["id"]))
    });
    lines.collect()
}

/// Everything about one kind.
fn details(node: &Json) -> String {
    let mut page = format!("{}\n{}\n", text(&node["id"]), text(&node["summary"]));
    let aliases: Vec<&str> = list(&node["aliases"]).iter().map(text).collect();
    if !aliases.is_empty() {
        let _ = writeln!(page, "Also called {}", aliases.join(", "));
    }
    section(&mut page, "Inputs", list(&node["inputs"]), |input| {
        let must = if input["required"] == true {
            ", must be connected"
        } else {
            ""
        };
        let open = match &input["default"] {
            Json::Null => String::new(),
            default => format!(", else {}", plain(default)),
        };
        format!("{}{must}{open}", text(&input["type"]))
    });
    section(&mut page, "Outputs", list(&node["outputs"]), |output| {
        text(&output["type"]).to_owned()
    });
    section(&mut page, "Parameters", list(&node["params"]), takes);
    page
}

fn section(page: &mut String, title: &str, entries: &[Json], note: impl Fn(&Json) -> String) {
    if entries.is_empty() {
        return;
    }
    let _ = writeln!(page, "\n{title}");
    let width = entries
        .iter()
        .map(|entry| text(&entry["name"]).len())
        .max()
        .unwrap_or(0);
    for entry in entries {
        let doc = text(&entry["doc"]).replace('\n', " ");
        let _ = writeln!(page, "  {:width$}  {doc} [{}]", text(&entry["name"]), note(entry));
    }
}

/// What a parameter takes, in words.
fn takes(param: &Json) -> String {
    let mut words = match param["choices"].as_array() {
        Some(choices) => choices.iter().map(text).collect::<Vec<_>>().join(" | "),
        None => text(&param["takes"]).to_owned(),
    };
    if let [low, high] = list(&param["range"]) {
        let _ = write!(words, " from {} to {}", plain(low), plain(high));
    }
    match plain(&param["default"]) {
        none if none.is_empty() => words,
        default => format!("{words}, default {default}"),
    }
}
