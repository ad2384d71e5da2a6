//! Models, nodes and the machine described as data, for `sabi mesh`, `nodes` and `doctor`.

use sabi_nodes::kind::{InputDefault, Kind, Param, Role, Shape};
use sabi_plan::SourceKind;
use serde_json::{Value as Json, json};

use crate::opening::kinds::Kinds;
use crate::opening::linked_model::LinkedModel;
use crate::opening::overlap::Sharing;
use crate::warning::Warning;

/// A model and its atlas.
pub fn describe_mesh(linked: &LinkedModel) -> Json {
    let (mesh, report) = (&linked.model.mesh, &linked.atlas.report);
    let [width, height] = linked.atlas.page_size;
    let sharing = Sharing::of(linked);
    let warnings: Vec<String> = linked.warnings().iter().map(Warning::to_string).collect();
    json!({
        "triangles": mesh.triangles.len(),
        "vertices": mesh.positions.len(),
        "parts": linked.model.parts,
        "pieces": linked.pieces.boxes.len(),
        "materials": sabi_export::set_names(&linked.model),
        "unwrapped": describe_unwrapping(linked),
        "vertex_colors": !mesh.colors.is_empty(),
        "largest_side": short(linked.largest_side as f32),
        "size": linked.atlas.size,
        "pages": linked.atlas.pages,
        "page_size": [width, height],
        "charts": linked.atlas.charts.len(),
        "coverage": short(report.coverage),
        "overlap": sharing.json(linked),
        "overlapping_charts": report.overlapping_charts.len(),
        "stacked_charts": report.stacked_charts,
        "mirrored_charts": report.mirrored_charts,
        "moved_charts": report.moved_charts,
        "thin_charts": report.thin_charts,
        "degenerate_triangles": report.degenerate_triangles,
        "degenerate_uv_triangles": report.degenerate_uv_triangles,
        "nonmanifold_edges": report.nonmanifold_edges,
        "border_edges": report.border_edges,
        "ghost_texels": linked.atlas.ghosts.len(),
        "unlinked_ghosts": report.unlinked_ghosts,
        "warnings": warnings,
    })
}

/// How a model was unwrapped; null if it was not.
pub(crate) fn describe_unwrapping(linked: &LinkedModel) -> Json {
    let Some(unwrapping) = &linked.unwrapped else {
        return Json::Null;
    };
    let report = &unwrapping.report;
    let [pieces, distinct] = report.pieces;
    json!({
        "uv_set": unwrapping.uv_set,
        "pieces": pieces,
        "distinct_pieces": distinct,
        "charts": report.charts,
        "coverage": short(report.coverage),
        "stretch": short(report.stretch),
        "worst_stretch": short(report.worst_stretch),
        "gap_texels": short(report.gap_at(linked.atlas.size)),
    })
}

/// All node kinds, sorted by id.
pub fn describe_nodes(kinds: &Kinds) -> Vec<Json> {
    let mut nodes: Vec<Json> = kinds.library.kinds().map(describe_kind).collect();
    nodes.extend(kinds.sources.values().chain(kinds.sinks.values()).map(describe_source));
    nodes.extend(describe_structure());
    nodes.sort_by(|a, b| a["id"].as_str().cmp(&b["id"].as_str()));
    nodes
}

/// Kinds that give a graph its structure and are gone before it is planned.
fn describe_structure() -> [Json; 2] {
    let port = |name: &str, doc: &str| json!([{ "name": name, "type": "any", "doc": doc }]);
    let whole = |name: &str, takes: &str, doc: &str, default: Json| json!({ "name": name, "label": name, "doc": doc, "takes": takes, "default": default });
    [
        json!({
            "id": "graph/group", "version": 1, "label": "Group", "aliases": ["subgraph", "instance"],
            "summary": "A graph in the graph: \"group\" names one of the file's groups, or a graph file beside it.",
            "inputs": [], "outputs": [],
            "params": [
                whole("seed", "seed", "Gives this instance patterns of its own.", json!(0)),
                whole("scale", "number", "Multiplies all lengths inside.", json!(1)),
                whole("variant", "text", "Variant of the group to start from; its exposed knobs are parameters too.", json!("none")),
            ],
        }),
        json!({
            "id": "graph/reroute", "version": 1, "label": "Reroute", "aliases": ["bend", "dot"],
            "summary": "A bend in a wire; passes on whatever comes in.",
            "inputs": port("source", "Anything."), "outputs": port("source", "The same."), "params": [],
        }),
    ]
}

/// What stands in while nothing is connected; null where something must be.
fn describe_input_default(default: &InputDefault) -> Json {
    match default {
        InputDefault::Required => Json::Null,
        InputDefault::Knob(numbers) if numbers.len() == 1 => json!(short(numbers[0])),
        InputDefault::Knob(numbers) => numbers.iter().map(|number| short(*number)).collect(),
        InputDefault::Expression(expression) => json!(expression),
        InputDefault::PlainMaterial => json!("a plain gray material"),
    }
}

fn describe_kind(kind: &Kind) -> Json {
    let shown = kind
        .params
        .iter()
        .filter(|param| !matches!(param.ty.role, Role::Extent { .. }));
    json!({
        "id": kind.id,
        "version": kind.version,
        "label": kind.label,
        "summary": kind.summary,
        "description": kind.description,
        "aliases": kind.aliases,
        "shape": match kind.shape {
            Shape::Point => "point",
            Shape::Field => "field",
            Shape::Ray => "ray",
            Shape::Survey => "survey",
        },
        "inputs": kind.inputs.iter().map(|input| json!({
            "name": input.name,
            "type": input.ty.to_string(),
            "doc": input.doc,
            "required": input.default == InputDefault::Required,
            "default": describe_input_default(&input.default),
        })).collect::<Vec<_>>(),
        "outputs": kind.outputs.iter().map(|output| json!({
            "name": output.name,
            "type": output.ty.to_string(),
            "doc": output.doc,
        })).collect::<Vec<_>>(),
        "params": shown.map(describe_param).collect::<Vec<_>>(),
    })
}

fn describe_param(param: &Param) -> Json {
    let role = match &param.ty.role {
        Role::Plain | Role::Extent { .. } => "number",
        Role::Toggle => "toggle",
        Role::Choice(_) => "choice",
        Role::Color => "color",
        Role::Length => "length",
        Role::Angle => "angle",
        Role::Seed => "seed",
        Role::Stops => "stops",
        Role::Text => "text",
        Role::File => "file",
        Role::Curve => "curve",
    };
    let mut shown = json!({
        "name": param.name, "label": param.label, "doc": param.doc, "takes": role, "default": param.ty.default,
    });
    if let Role::Choice(words) = &param.ty.role {
        shown["choices"] = json!(words);
    }
    if let Some([low, high]) = param.ty.range {
        shown["range"] = json!([low, high]);
    }
    if let Some([low, high]) = param.ty.soft {
        shown["soft"] = json!([low, high]);
    }
    shown
}

fn describe_source(kind: &SourceKind) -> Json {
    let port =
        |port: &sabi_plan::SourcePort| json!({ "name": port.name, "type": port.ty.to_string(), "doc": port.doc });
    json!({
        "id": kind.id,
        "version": 1,
        "label": kind.label,
        "summary": kind.summary,
        "aliases": kind.aliases,
        "inputs": kind.inputs.iter().map(port).collect::<Vec<_>>(),
        "outputs": kind.outputs.iter().map(port).collect::<Vec<_>>(),
        "params": kind.params.iter().map(describe_param).collect::<Vec<_>>(),
    })
}

/// A float as short as it can be written.
fn short(number: f32) -> Json {
    number
        .to_string()
        .parse::<f64>()
        .map_or(Json::Null, |exact| json!(exact))
}

/// What Sabi finds on this machine: adapters, the cache, node files with faults.
pub fn diagnose() -> Json {
    let adapters: Vec<Json> = sabi_gpu::adapters()
        .into_iter()
        .map(|adapter| {
            json!({
                "name": adapter.name,
                "kind": adapter.kind.to_string(),
                "driver": adapter.driver,
                "backend": adapter.backend,
            })
        })
        .collect();
    let opened = sabi_gpu::Gpu::open(&sabi_gpu::AdapterChoice::Auto);
    let kinds = Kinds::beside(None);
    json!({
        "sabi": env!("CARGO_PKG_VERSION"),
        "adapters": adapters,
        "usable": opened.is_ok(),
        "problem": opened.err().map(|error| error.to_string()),
        "cache": crate::default_cache_dir().map(|folder| folder.display().to_string()),
        "nodes": kinds.library.kinds().count() + kinds.sources.len() + kinds.sinks.len(),
        "faults": kinds.faults.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}
