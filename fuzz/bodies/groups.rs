//! Any graph with any group files around it opens or is refused, and nothing above its folder counts.

use std::fs;
use std::path::Path;

use sabi_engine::OpenGraph;
use sabi_engine::graph_info::describe_graph;
use sabi_graph::Overrides;

use crate::graph::plan;
use crate::parts::files;

/// Files of a project, in the order of an input.
const PROJECT: [&str; 6] = [
    "graph.sabi",
    "a.sabi",
    "b.sabi",
    "below/c.sabi",
    "below/d.sabi",
    "below/below/e.sabi",
];
/// A group above the folder of the project.
const OUTSIDE: &str = "outside.sabi";
/// Two contents of it.
const SECRETS: [&str; 2] = ["noise/simplex", "pattern/cells"];

pub fn survives(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let project = folder.path().join("project");
    fs::create_dir_all(project.join("below/below")).expect("a new folder");
    for (name, content) in PROJECT.iter().zip(files(bytes, PROJECT.len())) {
        fs::write(project.join(name), content).expect("a new file");
    }
    let opened = SECRETS.map(|kind| {
        fs::write(folder.path().join(OUTSIDE), secret(kind)).expect("a new file");
        opened(&project.join(PROJECT[0]))
    });
    assert_eq!(opened[0], opened[1], "a file outside of the project was read");
}

/// A group file with a node of this kind.
fn secret(kind: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "name": "outside", "outputs": {{ "mask": "in" }},
        "nodes": {{ "in": {{ "kind": "{kind}" }} }} }}"#
    )
}

/// What is seen of a graph, as text.
fn opened(path: &Path) -> String {
    let open = match OpenGraph::open(path) {
        Ok(open) => open,
        Err(error) => return error.to_string(),
    };
    let described = format!("{:?}", describe_graph(&open));
    match open.flatten(&Overrides::default()) {
        Ok(flat) => {
            plan(&flat);
            format!("{described}\n{flat:?}")
        }
        Err(error) => {
            assert!(!error.to_string().is_empty(), "a refusal has a reason");
            format!("{described}\n{error}")
        }
    }
}
