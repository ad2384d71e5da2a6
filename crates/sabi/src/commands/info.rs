//! `sabi info`: the parameters of a graph that can be set, its outputs, and the files that it reads.

use sabi_engine::graph_info::{
    FileDescription, GraphDescription, GraphOutput, GroupDescription, KnobDescription, VariantDescription,
    describe_graph,
};
use sabi_files::TrustedPaths;

use super::value_text::{accepted_values, value_text};
use crate::arguments::InfoArguments;
use crate::exit::{Exit, Failure};
use crate::printable::Page;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &InfoArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let open = arguments.graph.open(trusted)?;
    let description = describe_graph(&open);
    terminal.warnings(description.warnings.iter().map(String::as_str));
    if arguments.json {
        terminal.json(&description)?;
    } else {
        terminal.page(&page(&description))?;
    }
    Ok(Exit::Done)
}

fn page(graph: &GraphDescription) -> Page {
    let mut page = Page::default();
    let title = if graph.name.is_empty() {
        &graph.graph
    } else {
        &graph.name
    };
    page.line(title);
    if let Some(about) = &graph.about {
        page.lines(about);
    }
    let nodes = graph
        .nodes
        .map_or_else(|| "unknown".to_owned(), |nodes| nodes.to_string());
    let facts = [
        ("graph", graph.graph.clone()),
        ("version", graph.version.to_string()),
        ("nodes", nodes),
        ("fit", value_text(&graph.fit)),
        ("seed", graph.seed.to_string()),
    ];
    page.line("");
    for (name, value) in facts {
        page.line(format_args!("{name:9} {value}"));
    }
    section(&mut page, "Knobs", graph.knobs.iter().map(knob));
    section(&mut page, "Variants", graph.variants.iter().map(variant));
    section(&mut page, "Outputs", graph.outputs.iter().map(output));
    section(&mut page, "Groups", graph.groups.iter().map(group));
    section(&mut page, "Files", graph.files.iter().map(file));
    page
}

/// Greatest width of a cell that widens its column.
const WIDEST: usize = 32;

/// Adds a table with a title, unless it has no rows.
fn section<const CELLS: usize>(page: &mut Page, title: &str, rows: impl Iterator<Item = [String; CELLS]>) {
    let rows: Vec<_> = rows.collect();
    if rows.is_empty() {
        return;
    }
    let width = |column: usize| {
        let lengths = rows.iter().map(|row| row[column].chars().count());
        lengths.filter(|length| *length <= WIDEST).max().unwrap_or(0) // A column of wide cells is not aligned.
    };
    let widths: [usize; CELLS] = std::array::from_fn(width);
    page.line("");
    page.line(title);
    for row in rows {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("  {cell:width$}"));
        page.line(cells.collect::<String>().trim_end());
    }
}

fn knob(knob: &KnobDescription) -> [String; 4] {
    let value = knob.value.as_ref().map_or_else(|| "unknown".to_owned(), value_text);
    let takes = match knob.takes {
        Some(takes) => accepted_values(takes, knob.choices.as_deref(), knob.range.as_ref()),
        None => "unknown".to_owned(),
    };
    let (doc, to) = (knob.doc.replace('\n', " "), knob.to.join(", "));
    [knob.name.clone(), value, takes, format!("{doc} [{to}]")]
}

fn variant(variant: &VariantDescription) -> [String; 2] {
    let values = variant
        .values
        .iter()
        .map(|(knob, value)| format!("{knob}={}", value_text(value)));
    [variant.name.clone(), values.collect::<Vec<_>>().join(" ")]
}

fn output(output: &GraphOutput) -> [String; 3] {
    let what = match (&output.materials, &output.name) {
        (Some(materials), _) => format!("materials {materials}"),
        (None, Some(name)) => format!("map {name}"),
        (None, None) => String::new(),
    };
    [output.node.clone(), output.kind.clone(), what]
}

fn group(group: &GroupDescription) -> [String; 3] {
    let library = group.library.as_ref();
    let library = library.map_or_else(String::new, |file| format!("copy of {file}"));
    [group.name.clone(), group.label.clone(), library]
}

fn file(file: &FileDescription) -> [String; 3] {
    let path = file.written.as_ref().unwrap_or(&file.path);
    let missing = if file.exists { "" } else { "missing" };
    [file.role.to_owned(), path.clone(), missing.to_owned()]
}
