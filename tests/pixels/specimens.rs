//! Every built-in kind in its own graph, with each result separately.

use sabi_graph::PortType;
use sabi_nodes::Library;
use sabi_nodes::kind::{Input, InputDefault, Kind, ParamValue, Reads, Role};
use sabi_tests::{OnMesh, project};
use serde_json::{Map, Value, json};

/// One result of one kind.
pub(crate) struct Specimen {
    /// Id of the kind.
    pub(crate) kind: String,
    /// The result's port.
    pub(crate) port: String,
    /// Type of the result.
    pub(crate) ty: PortType,
    /// True if it is the kind's first result.
    pub(crate) is_first: bool,
    /// A graph with everything connected that can be. The node is called `node`.
    pub(crate) connected: String,
    /// A graph with only the required inputs connected.
    pub(crate) alone: String,
    /// As `connected`, with a kind's lengths so large that the coarsest maps here carry them.
    pub(crate) coarse: String,
}

impl Specimen {
    /// Returns whether it is a result of a pattern: steps with borders a texel wide, which begin anew on sides that do not
    /// meet at an upright corner.
    pub(crate) fn is_pattern(&self) -> bool {
        self.kind.starts_with("pattern/")
    }

    /// The node and its port, as targets are written.
    pub(crate) fn target(&self) -> String {
        format!("node.{}", self.port)
    }

    /// Name in messages and files: the kind, and the port where it is not the first.
    pub(crate) fn name(&self) -> String {
        if self.is_first {
            self.kind.clone()
        } else {
            format!("{}.{}", self.kind, self.port)
        }
    }
}

/// Every result of every built-in kind.
pub(crate) fn specimens() -> Vec<Specimen> {
    let library = Library::builtin();
    let of_kind = |kind: &Kind| {
        let graphs = [(true, 1.0), (false, 1.0), (true, 8.0)].map(|(is_full, size)| graph(kind, is_full, size));
        let [connected, alone, coarse] = graphs;
        let outputs = kind.outputs.iter().enumerate();
        outputs
            .map(|(at, output)| Specimen {
                kind: kind.id.clone(),
                port: output.name.clone(),
                ty: output.ty,
                is_first: at == 0,
                connected: connected.clone(),
                alone: alone.clone(),
                coarse: coarse.clone(),
            })
            .collect::<Vec<_>>()
    };
    let all: Vec<Specimen> = library.kinds().flat_map(of_kind).collect();
    assert!(all.len() >= 15, "only {} results were found", all.len());
    all
}

/// A model of the project.
pub(crate) fn own_mesh(name: &str) -> std::path::PathBuf {
    project(&format!("assets/meshes/{name}.glb"))
}

/// The project's own model, at a size, with the graph of a specimen on it.
pub(crate) fn on_own_mesh(graph: &str, mesh: &str, size: u32) -> OnMesh {
    OnMesh::new(graph, &own_mesh(mesh), size)
}

/// Calls `check` for every specimen. The test fails with all complaints together.
pub(crate) fn for_each(mut check: impl FnMut(&Specimen) -> Result<(), String>) {
    let complaints: Vec<String> = specimens()
        .iter()
        .filter_map(|specimen| Some(format!("{}: {}", specimen.name(), check(specimen).err()?)))
        .collect();
    assert!(complaints.is_empty(), "\n{}\n", complaints.join("\n"));
}

/// Kinds whose borders, fibers or runs are about as narrow as a texel, or whose pattern grows from single texels, each with its
/// reason: a small map or another unwrap has the same pattern, and agrees texel by texel in the mean only.
pub(crate) const NARROW: [(&str, &str); 14] = [
    ("color/temper", "its bands of color are narrow where the heat is steep"),
    (
        "effect/coat",
        "the teeth of its border and its rim are narrower than a texel",
    ),
    ("filter/flow", "its runs begin at single texels of a coarse level"),
    (
        "filter/plume",
        "its billows are carried on from texel to texel of a coarse level",
    ),
    (
        "filter/react",
        "its pattern grows from single texels, and each decides where the next one goes",
    ),
    ("noise/anisotropic", "its fibers are narrower than a texel across"),
    (
        "noise/colonies",
        "the borders of its colonies are narrower than a texel",
    ),
    ("noise/cracks", "its finer cracks are narrower than a texel"),
    (
        "noise/flow",
        "its folds are narrower than a texel where they are pressed together",
    ),
    ("noise/ripples", "its stripes are few texels wide, and fork"),
    (
        "noise/spots",
        "the borders of its smallest spots are narrower than a texel",
    ),
    (
        "relief/fill",
        "what settles moves from texel to texel of a coarse level",
    ),
    ("relief/fracture", "its faces meet in lines"),
    ("scatter/stamp", "its outlines are crisp"),
];

impl Specimen {
    /// Returns true if it is of one of the [`NARROW`] kinds.
    pub(crate) fn is_narrow(&self) -> bool {
        NARROW.iter().any(|(kind, _)| *kind == self.kind)
    }
}

/// Rays of kinds that shoot some: enough that their noise is no larger than what the tests look for.
const RAYS: u32 = 128;
/// Lengths of a pattern, which grow together.
const SIZES: [&str; 18] = [
    "rise",
    "reach",
    "rim",
    "ragged",
    "curl_width",
    "old_width",
    "smooth_edges",
    "size",
    "spacing",
    "length",
    "width",
    "rings",
    "radius",
    "distance",
    "row_height",
    "joint",
    "bevel",
    "diameter",
];

fn graph(kind: &Kind, is_full: bool, size: f64) -> String {
    let mut nodes = Map::new();
    let mut inputs = Map::new();
    for (seed, input) in (1..).zip(&kind.inputs) {
        let must = input.default == InputDefault::Required;
        // What stands for `at.position` is better than anything a test could connect.
        let can = !matches!(input.default, InputDefault::Expression(_));
        if must || (is_full && can) {
            let id = format!("into_{}", input.name);
            connect(&mut nodes, &id, input, seed);
            let from = match input.ty {
                PortType::Vector => format!("{id}.position"),
                _ => id,
            };
            inputs.insert(input.name.clone(), json!(from));
        }
    }
    let mut params = Map::new();
    let sized = kind
        .params
        .iter()
        .filter(|param| SIZES.contains(&param.name.as_str()) && param.ty.role == Role::Length);
    for param in sized {
        if let ParamValue::Floats(default) = &param.default
            && size != 1.0
        {
            // Threads cross in every cell: a weave has twice as many borders as other patterns.
            let more = if kind.id == "pattern/weave" { 2.0 } else { 1.0 };
            params.insert(param.name.clone(), json!(f64::from(default[0]) * size * more));
        }
    }
    if let (Some(rays), true) = (&kind.rays, size != 1.0) {
        params.insert(kind.params[rays.count].name.clone(), json!(RAYS));
    }
    nodes.insert(
        "node".to_owned(),
        json!({ "kind": kind.id, "inputs": inputs, "params": params }),
    );
    document(nodes)
}

/// A graph file of these nodes.
pub(crate) fn document(nodes: Map<String, Value>) -> String {
    json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string()
}

/// A soft noise that every size here carries.
fn noise(seed: u32) -> Value {
    json!({ "kind": "noise/simplex", "params": { "size": 0.8, "octaves": 2, "seed": seed } })
}

fn connect(nodes: &mut Map<String, Value>, id: &str, input: &Input, seed: u32) {
    let noise_id = format!("{id}_noise");
    match input.ty {
        // A relief is lower than it is wide.
        PortType::Mask if input.name == "height" && input.reads == Reads::Field => {
            let even = json!({ "kind": "noise/simplex", "params": { "size": 1.2, "octaves": 1, "seed": seed } });
            nodes.insert(noise_id.clone(), even);
            let params = json!({ "low": 0.0, "high": 0.1 });
            nodes.insert(
                id.to_owned(),
                json!({ "kind": "adjust/levels", "inputs": { "source": noise_id }, "params": params }),
            );
        }
        PortType::Mask => {
            nodes.insert(id.to_owned(), noise(seed));
        }
        PortType::Color => {
            nodes.insert(noise_id.clone(), noise(seed));
            let stops = json!([[0.1, "#20304a"], [0.9, "#e0b070"]]);
            nodes.insert(
                id.to_owned(),
                json!({ "kind": "color/gradient", "inputs": { "source": noise_id }, "params": { "stops": stops } }),
            );
        }
        PortType::Vector => {
            nodes.insert(id.to_owned(), json!({ "kind": "surface/position" }));
        }
        PortType::Material => {
            nodes.insert(noise_id.clone(), noise(seed));
            let params = json!({
                "color": format!("#{:02x}8040", 60 * seed % 256), "roughness": 0.3, "metallic": 1, "height": 0.04,
                "emission_on": true, "emission": "#402010",
            });
            nodes.insert(
                id.to_owned(),
                json!({ "kind": "effect/layer", "inputs": { "mask": noise_id }, "params": params }),
            );
        }
    }
}
