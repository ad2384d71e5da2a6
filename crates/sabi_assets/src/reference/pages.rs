//! The text of the node reference, made of what `sabi nodes --json` says and of nothing else.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde_json::Value;

/// The pages as (path below docs/nodes, text): an index and one page a node. `exists` answers for paths from the
/// project's root, so that nothing is linked that is not there.
pub(crate) fn pages(nodes: &[Value], exists: &dyn Fn(&str) -> bool) -> Vec<(String, String)> {
    let mut pages = vec![("README.md".to_owned(), index(nodes, exists))];
    pages.extend(
        nodes
            .iter()
            .map(|node| (format!("{}.md", text(&node["id"])), page(node, exists))),
    );
    pages
}

/// The results of a node that can be seen, each with the path of its picture below docs/nodes.
pub(crate) fn pictures_of(node: &Value) -> Vec<(&Value, String)> {
    let id = text(&node["id"]);
    let is_seen = |output: &&Value| matches!(text(&output["type"]), "mask" | "color" | "vector" | "material");
    let outputs = list(&node["outputs"]).iter().filter(is_seen).enumerate();
    outputs
        .map(|(number, output)| {
            let port = if number == 0 {
                String::new()
            } else {
                format!(".{}", text(&output["name"]))
            };
            (output, format!("{id}{port}.png"))
        })
        .collect()
}

fn text(value: &Value) -> &str {
    // Texts that are optional, such as labels and descriptions, are null.
    value.as_str().unwrap_or_default()
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Text that stands in one cell of a table.
fn cell(words: &str) -> String {
    words.replace('|', "\\|").replace('\n', " ")
}

/// A value as it stands in a graph file.
fn code(value: &Value) -> String {
    match value {
        Value::String(word) => format!("`{word}`"),
        Value::Null => String::new(),
        other => format!("`{}`", plain(other)),
    }
}

/// Numbers without a point where they are whole, lists with room to breathe.
fn plain(value: &Value) -> String {
    match (value, value.as_f64()) {
        (Value::Array(entries), _) => format!("[{}]", entries.iter().map(plain).collect::<Vec<_>>().join(", ")),
        // Display of an f64 is the shortest that reads back as itself, and has no ".0".
        (_, Some(number)) => number.to_string(),
        _ => value.to_string(),
    }
}

/// The first picture of a node that is there.
fn first_picture(node: &Value, exists: &dyn Fn(&str) -> bool) -> Option<String> {
    let names = pictures_of(node).into_iter().map(|(_, name)| name);
    names.into_iter().find(|name| exists(&format!("docs/nodes/{name}")))
}

fn index(nodes: &[Value], exists: &dyn Fn(&str) -> bool) -> String {
    let mut categories: BTreeMap<&str, Vec<&Value>> = BTreeMap::new();
    for node in nodes {
        let id = text(&node["id"]);
        let category = id.split_once('/').map_or(id, |(category, _)| category);
        categories.entry(category).or_default().push(node);
    }
    let mut page = String::from(
        "# Nodes\n\nEverything a graph can be made of. Written by `cargo xtask reference` from the nodes themselves: \
         to change a page,\nchange its node.\n\n\
         Lengths count the model's largest side as 1, unless the graph's scale says otherwise. Angles are degrees. \
         Masks are 0 to 1.\nIn the pictures, random values are shown as colors, and heights as relief in clay.\n\n\
         A parameter that takes a mask can be linked like an input: the mask multiplies it at each place, and the result stays in \
         its range.\n\n",
    );
    let links: Vec<String> = categories
        .keys()
        .map(|category| format!("[{category}](#{category})"))
        .collect();
    let _ = writeln!(page, "{}", links.join(" · "));
    for (category, nodes) in &categories {
        let _ = write!(page, "\n## {category}\n\n| | Node | |\n|---|---|---|\n");
        for node in nodes {
            let id = text(&node["id"]);
            let picture = first_picture(node, exists).map_or(String::new(), |name| {
                format!("[<img src=\"{name}\" width=\"96\" alt=\"\">]({id}.md)")
            });
            let (label, summary) = (text(&node["label"]), cell(text(&node["summary"])));
            let _ = writeln!(page, "| {picture} | [{label}]({id}.md)<br>`{id}` | {summary} |");
        }
    }
    page
}

fn page(node: &Value, exists: &dyn Fn(&str) -> bool) -> String {
    let id = text(&node["id"]);
    let mut page = format!("# {}\n\n`{id}`", text(&node["label"]));
    let aliases: Vec<&str> = list(&node["aliases"]).iter().map(text).collect();
    if !aliases.is_empty() {
        let _ = write!(page, " · also found as {}", aliases.join(", "));
    }
    let _ = write!(page, "\n\n{}\n", text(&node["summary"]));
    let description = text(&node["description"]).trim();
    if !description.is_empty() {
        let _ = write!(page, "\n{description}\n");
    }
    pictures(&mut page, node, exists);
    inputs(&mut page, list(&node["inputs"]));
    knobs(&mut page, list(&node["params"]));
    outputs(&mut page, list(&node["outputs"]));
    page.push_str("\n## More\n\n");
    let _ = writeln!(page, "{}", kind_of_node(node));
    if let Some(source) = source_of(id, exists) {
        let name = source.rsplit('/').next().unwrap_or(&source);
        let _ = writeln!(page, "Its source is [{name}](../../../{source}).");
    }
    page.push_str("[All nodes](../README.md).\n");
    page
}

fn pictures(page: &mut String, node: &Value, exists: &dyn Fn(&str) -> bool) {
    let all = pictures_of(node);
    let shown: Vec<&(&Value, String)> = all
        .iter()
        .filter(|(_, name)| exists(&format!("docs/nodes/{name}")))
        .collect();
    if shown.is_empty() {
        return;
    }
    page.push('\n');
    for (output, name) in shown {
        let file = name.rsplit('/').next().unwrap_or(name);
        let port = text(&output["name"]);
        let _ = writeln!(
            page,
            "<img src=\"{file}\" width=\"288\" alt=\"{port}\" title=\"{port}\">"
        );
    }
}

fn inputs(page: &mut String, inputs: &[Value]) {
    if inputs.is_empty() {
        return;
    }
    page.push_str("\n## Inputs\n\n| Input | Takes | What it does | Unconnected |\n|---|---|---|---|\n");
    for input in inputs {
        let open = if input["required"] == true {
            "must be connected".to_owned()
        } else {
            code(&input["default"])
        };
        let (name, takes, doc) = (text(&input["name"]), text(&input["type"]), cell(text(&input["doc"])));
        let _ = writeln!(page, "| `{name}` | {takes} | {doc} | {open} |");
    }
}

fn knobs(page: &mut String, params: &[Value]) {
    if params.is_empty() {
        return;
    }
    page.push_str("\n## Knobs\n\n| Knob | Takes | What it does | Default |\n|---|---|---|---|\n");
    for param in params {
        let (name, label, doc) = (text(&param["name"]), text(&param["label"]), cell(text(&param["doc"])));
        let label = if label.is_empty() {
            String::new()
        } else {
            format!("{label}<br>")
        };
        let _ = writeln!(
            page,
            "| {label}`{name}` | {} | {doc} | {} |",
            takes(param),
            code(&param["default"])
        );
    }
}

/// Describes the values of a knob in words: its unit, its range, the ends of its slider.
fn takes(param: &Value) -> String {
    if let Some(choices) = param["choices"].as_array() {
        let words: Vec<String> = choices.iter().map(code).collect();
        return words.join(", ");
    }
    let mut words = match text(&param["takes"]) {
        "length" => "length".to_owned(),
        "angle" => "degrees".to_owned(),
        "stops" => "positions and colors".to_owned(),
        other => other.to_owned(),
    };
    if let [low, high] = list(&param["range"]) {
        let _ = write!(words, ", {} to {}", plain(low), plain(high));
    }
    if let [low, high] = list(&param["soft"]) {
        let _ = write!(words, "; slider {} to {}", plain(low), plain(high));
    }
    if param["takes_mask"] == true {
        words += "; takes a mask";
    }
    words
}

fn outputs(page: &mut String, outputs: &[Value]) {
    if outputs.is_empty() {
        return;
    }
    page.push_str("\n## Results\n\n| Result | Gives | What it is |\n|---|---|---|\n");
    for output in outputs {
        let (name, gives, doc) = (text(&output["name"]), text(&output["type"]), cell(text(&output["doc"])));
        let _ = writeln!(page, "| `{name}` | {gives} | {doc} |");
    }
}

/// Describes how the node works on the surface, for artists.
fn kind_of_node(node: &Value) -> &'static str {
    match text(&node["shape"]) {
        "point" => "Computes each place by itself and is fused with its neighbors in the graph, so it costs little.",
        "field" => "Reads its input around each place, over every UV seam, so the input is computed first.",
        "ray" => "Traces rays over the model, which takes long; the results are cached on disk.",
        "survey" => "Reads the distribution of values over the whole surface, so the input is computed first.",
        _ if list(&node["outputs"]).is_empty() && text(&node["id"]).starts_with("output/") => {
            "Ends a graph: its input is exported."
        }
        _ if text(&node["id"]).starts_with("graph/") => {
            "Structures the graph and is resolved before the evaluation, so it costs nothing."
        }
        _ => "Brings data into the graph.",
    }
}

/// The file a node is written in, from the project's root.
fn source_of(id: &str, exists: &dyn Fn(&str) -> bool) -> Option<String> {
    let (category, name) = id.split_once('/')?;
    let engine = "crates/sabi_engine/src/source";
    let places = [
        format!("shaders/nodes/{id}.wgsl"),
        format!("{engine}/{category}_{name}.rs"),
        format!("{engine}/{name}.rs"),
    ];
    places.into_iter().find(|path| exists(path))
}
