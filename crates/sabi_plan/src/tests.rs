//! Plans as text, without a device.

mod cuts;
mod faults;
mod keys;
mod memory;
mod own_slots;
mod passes;
mod random;
mod surveys;
mod symbols;

use std::collections::BTreeMap;
use std::sync::OnceLock;

use sabi_graph::{Document, FlatGraph, FlatRef, Overrides, PortType, flatten};
use sabi_nodes::kind::{Channel, Param};
use sabi_nodes::{Library, SourceFile};

use crate::{
    FileContents, Lengths, LevelWidths, Limits, Mode, Plan, PlanError, Planner, SourceKind, SourcePort, Target,
};

/// Widths of the levels of the surface.
const WIDTHS: LevelWidths = LevelWidths {
    finest: 0.001,
    coarsest: 3,
    widest_points: 0.016,
    point_levels: 2,
};

const FUSED: Mode = Mode::Bake { fuse: true };
const UNFUSED: Mode = Mode::Bake { fuse: false };

fn port(name: &str, ty: PortType, channels: &[Channel]) -> SourcePort {
    SourcePort::material(name, ty, "", channels)
}

fn kind(id: &str, inputs: Vec<SourcePort>, outputs: Vec<SourcePort>) -> SourceKind {
    let name = Param::text("name", "mask", "");
    SourceKind {
        id: id.to_owned(),
        label: String::new(),
        summary: String::new(),
        aliases: Vec::new(),
        params: vec![name],
        inputs,
        outputs,
        content: [0; 32],
    }
}

/// A node whose passes go down by levels and up again, and read each other and its input on all of them.
const STAIRS: &str = "//! Stairs
//! Passes on other levels than what they read.
//! @use surface

struct Params {
    /// How wide the upper steps are.
    /// @length @range 0 1 @default 0.1
    upper_width: f32,
    /// How wide the lowest step is.
    /// @length @range 0 1 @default 0.1
    lower_width: f32,
}

/// Down.
/// @pass 1 @texel params.upper_width / 4
/// @input source What goes down.
fn upper(at: Surface, source: texture_2d_array<f32>) -> f32 {
    return surface_here(source, at).x;
}

/// Further down.
/// @pass 2 @texel params.lower_width / 2 @repeat 3
fn lower(at: Surface, upper: texture_2d_array<f32>, source: texture_2d_array<f32>) -> f32 {
    return surface_here(upper, at).x + surface_here(source, at).x;
}

/// Up again.
/// @pass 3 @texel params.upper_width / 4
fn back(at: Surface, lower: texture_2d_array<f32>, upper: texture_2d_array<f32>) -> f32 {
    return surface_here(lower, at).x + surface_here(upper, at).x;
}

/// All of it.
fn mask(at: Surface, back: texture_2d_array<f32>, lower: texture_2d_array<f32>, params: Params) -> f32 {
    return surface_here(back, at).x + surface_here(lower, at).x + params.upper_width + params.lower_width;
}
";

/// Returns the built-in nodes and the stairs. They are read only once, since random tests need them hundreds of times.
fn library() -> Library {
    let mut library = Library::builtin();
    let stairs = SourceFile {
        path: "test/stairs.wgsl".into(),
        id: "test/stairs".to_owned(),
        text: STAIRS.to_owned(),
    };
    library.replace(stairs).unwrap();
    library
}

static LIBRARY: OnceLock<Library> = OnceLock::new();

/// A planner for tests: the built-in nodes, one source and the two sinks.
struct TestPlanner {
    library: &'static Library,
    sources: BTreeMap<String, SourceKind>,
    sinks: BTreeMap<String, SourceKind>,
    files: FileContents,
    limits: Limits,
}

impl TestPlanner {
    fn new() -> TestPlanner {
        let by_id = |kinds: Vec<SourceKind>| kinds.into_iter().map(|kind| (kind.id.clone(), kind)).collect();
        let material = port("material", PortType::Material, &Channel::ALL);
        TestPlanner {
            library: LIBRARY.get_or_init(library),
            sources: by_id(vec![kind("source/model", Vec::new(), vec![material.clone()])]),
            sinks: by_id(vec![
                kind("output/material", vec![material], Vec::new()),
                kind("output/mask", vec![port("source", PortType::Mask, &[])], Vec::new()),
            ]),
            files: FileContents::new(),
            limits: Limits {
                storage_textures: 8,
                ..Limits::default()
            },
        }
    }

    fn with_planner<T>(&self, graph: &FlatGraph, mode: Mode, work: impl FnOnce(&Planner<'_>) -> T) -> T {
        work(&Planner {
            graph,
            library: self.library,
            sources: &self.sources,
            sinks: &self.sinks,
            files: &self.files,
            lengths: Lengths {
                working_from: &|_| 1.0,
                largest_piece: 1.0,
                extent: &|_| [0.0, 1.0],
            },
            level_widths: WIDTHS,
            surface_key: [7; 32],
            mode,
            most_rays: None,
            limits: self.limits,
        })
    }

    fn plan(&self, graph: &FlatGraph, mode: Mode) -> (Plan, Vec<PlanError>) {
        let is_sink = |kind: &str| kind.starts_with("output/");
        let targets: Vec<Target> = (0..graph.nodes.len())
            .filter(|node| is_sink(&graph.nodes[*node].kind))
            .map(|node| Target { node, port: None })
            .collect();
        self.with_planner(graph, mode, |planner| planner.plan(&targets))
    }

    /// Index of the result that a link names.
    fn output_index(&self, graph: &FlatGraph, from: &FlatRef) -> usize {
        let kind = self.library.kind(&graph.nodes[from.node].kind);
        let named = |port: &String| kind?.outputs.iter().position(|output| output.name == *port);
        from.port.as_ref().and_then(named).unwrap_or(0)
    }
}

fn flat(document: &Document) -> FlatGraph {
    flatten(
        document,
        &Overrides::default(),
        &mut |_| Err("no files here".to_owned()),
    )
    .expect("a sound document")
}

/// Creates a graph from lines of the form `id kind input=node input=node …`. A value that is not the id of a node is a parameter.
fn graph(lines: &str) -> FlatGraph {
    let lines = lines.lines().map(str::trim).filter(|line| !line.is_empty());
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split_whitespace().collect()).collect();
    let is_node = |name: &str| rows.iter().any(|row| name.split('.').next() == Some(row[0]));
    let mut nodes = serde_json::Map::new();
    for row in &rows {
        let mut inputs = serde_json::Map::new();
        let mut params = serde_json::Map::new();
        let mut node = serde_json::json!({ "kind": row[1] });
        for word in &row[2..] {
            match word.split_once('=') {
                None => node["muted"] = serde_json::json!(*word == "muted"),
                Some((name, value)) if is_node(value) => drop(inputs.insert(name.to_owned(), value.into())),
                Some((name, value)) => {
                    let json = serde_json::from_str(value).unwrap_or_else(|_| value.into());
                    params.insert(name.to_owned(), json);
                }
            }
        }
        node["inputs"] = inputs.into();
        node["params"] = params.into();
        nodes.insert(row[0].to_owned(), node);
    }
    let file = serde_json::json!({ "format": "sabi", "version": 1, "name": "test", "nodes": nodes });
    flat(&Document::from_json(&file.to_string()).expect("a sound graph"))
}
