//! `sabi nodes`: the kinds of nodes.

use sabi_engine::Kinds;
use sabi_engine::catalog::description::{InputDescription, NodeDescription, ParamDescription, describe_nodes};
use sabi_files::TrustedPaths;
use sabi_graph::nearest;

use super::value_text::{accepted_values, value_text};
use crate::arguments::NodesArguments;
use crate::exit::{Exit, Failure};
use crate::printable::Page;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &NodesArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let kinds = Kinds::beside(arguments.graph.as_deref(), trusted);
    terminal.warnings(kinds.faults.iter().map(ToString::to_string));
    let nodes = describe_nodes(&kinds);
    let found = match &arguments.id {
        None => nodes.iter().collect(),
        Some(word) => find(&nodes, word)?,
    };
    match (found.as_slice(), &arguments.id) {
        ([node], Some(_)) if arguments.json => terminal.json(node)?,
        ([node], Some(_)) => terminal.page(&details(node))?,
        (several, _) if arguments.json => terminal.json(&several)?,
        (several, _) => terminal.page(&table(several))?,
    }
    Ok(Exit::Done)
}

/// Returns the kind with this id, or all kinds with the word in their id, label or aliases.
fn find<'n>(nodes: &'n [NodeDescription], id: &str) -> Result<Vec<&'n NodeDescription>, Failure> {
    if let Some(node) = nodes.iter().find(|node| node.id == id) {
        return Ok(vec![node]);
    }
    let word = id.to_lowercase();
    let has_word = |node: &&NodeDescription| {
        let mut names = [&node.id, &node.label].into_iter().chain(&node.aliases);
        names.any(|name| name.to_lowercase().contains(&word))
    };
    let found: Vec<&NodeDescription> = nodes.iter().filter(has_word).collect();
    if !found.is_empty() {
        return Ok(found);
    }
    let advice = match nearest(id, nodes.iter().map(|node| node.id.as_str())) {
        Some(near) => format!("did you mean '{near}'?"),
        None => "'sabi nodes' lists all".to_owned(),
    };
    let why = format!("there is no kind of node '{id}'; {advice}");
    Err(Failure::new(Exit::Usage, why))
}

/// Returns ids and summaries, one kind per line.
fn table(nodes: &[&NodeDescription]) -> Page {
    let width = nodes.iter().map(|node| node.id.len()).max().unwrap_or(0); // An empty table has no width.
    let lines = nodes.iter().map(|node| {
        let summary = node.summary.replace('\n', " ");
        format!("{:width$}  {summary}", node.id)
    });
    lines.collect()
}

/// Returns a full description of one kind.
fn details(node: &NodeDescription) -> Page {
    let mut page: Page = [&node.id].into_iter().collect();
    page.lines(&node.summary);
    if !node.aliases.is_empty() {
        page.line(format_args!("Also called {}", node.aliases.join(", ")));
    }
    let inputs = node.inputs.iter();
    section(
        &mut page,
        "Inputs",
        inputs.map(|input| (&input.name, &input.doc, accepted_type(input))),
    );
    let outputs = node.outputs.iter();
    section(
        &mut page,
        "Outputs",
        outputs.map(|output| (&output.name, &output.doc, output.ty.clone())),
    );
    let params = node.params.iter();
    section(
        &mut page,
        "Parameters",
        params.map(|param| (&param.name, &param.doc, values_and_default(param))),
    );
    page
}

/// Adds names, each on a line with its purpose and a note.
fn section<'e>(page: &mut Page, title: &str, entries: impl Iterator<Item = (&'e String, &'e String, String)>) {
    let entries: Vec<_> = entries.collect();
    let Some(width) = entries.iter().map(|(name, ..)| name.len()).max() else {
        return;
    };
    page.line("");
    page.line(title);
    for (name, doc, note) in entries {
        page.line(format_args!("  {name:width$}  {} [{note}]", doc.replace('\n', " ")));
    }
}

/// Describes the type that an input accepts, and its default while nothing is connected.
fn accepted_type(input: &InputDescription) -> String {
    let must = if input.required { ", must be connected" } else { "" };
    let open = match &input.default {
        Some(default) => format!(", else {}", value_text(default)),
        None => String::new(),
    };
    format!("{}{must}{open}", input.ty)
}

/// Describes the values that a parameter accepts and its default, in words.
fn values_and_default(param: &ParamDescription) -> String {
    let words = accepted_values(param.takes, param.choices.as_deref(), param.range.as_ref());
    match value_text(&param.default) {
        none if none.is_empty() => words,
        default => format!("{words}, default {default}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_names_its_node_and_everything_that_can_be_set() {
        let nodes = describe_nodes(&Kinds::builtin());
        assert!(nodes.len() > 50, "the nodes that come with the program");
        for node in &nodes {
            let found = find(&nodes, &node.id).expect("the node");
            assert_eq!(found, [node]);
            let page = details(node);
            let page = page.text();
            assert!(page.starts_with(&format!("{}\n", node.id)), "{page}");
            let inputs = node.inputs.iter().map(|input| &input.name);
            let outputs = node.outputs.iter().map(|output| &output.name);
            let params = node.params.iter().map(|param| &param.name);
            for name in inputs.chain(outputs).chain(params) {
                let line = page.lines().find(|line| line.trim_start().starts_with(name.as_str()));
                assert!(line.is_some(), "{name} in\n{page}");
            }
        }
    }
}
