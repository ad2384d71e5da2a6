//! A graph given as text, on a model, evaluated.

use std::path::{Path, PathBuf};
use std::time::Duration;

use sabi_engine::evaluating::EvaluatorOptions;
use sabi_engine::opening::linked_model::{LinkedModel, ModelOptions};
use sabi_engine::phases::NoProgress;
use sabi_engine::source::{SessionPictures, Strokes};
use sabi_engine::{Evaluator, Kinds, OpenGraph};
use sabi_files::TrustedPaths;
use sabi_gpu::{
    CasterChoice, DEFAULT_BUDGET_BYTES, Normals, PlaneData, ResultCache, RunOptions, RunReport, SurfaceTables,
    TextureBudget, read_slot,
};
use sabi_graph::{Document, FlatGraph, Overrides, PortType};
use sabi_nodes::kind::Channel;
use sabi_nodes::link::Plane;
use sabi_plan::{Mode, Plan, Target};

use crate::device::{adapter, device};

const SUBMISSION: Duration = Duration::from_millis(200);

/// A graph on a model.
pub struct OnMesh {
    /// The two, on the device that all tests share.
    pub evaluator: Evaluator,
    /// Tables of the surface as kernels have them, to compute places without kernels.
    pub tables: SurfaceTables,
}

/// Options of an evaluation.
pub struct EvaluationOptions<'c> {
    /// Way to cut the graph into passes.
    pub mode: Mode,
    /// Results of earlier evaluations.
    pub cache: Option<&'c mut ResultCache>,
}

impl EvaluationOptions<'static> {
    /// As a bake does it.
    pub fn baked() -> EvaluationOptions<'static> {
        EvaluationOptions {
            mode: Mode::Bake { fuse: true },
            cache: None,
        }
    }
}

/// A node's result, for all texels of the atlas, page by page and row by row.
pub struct NodeResult {
    /// Type of the result.
    pub ty: PortType,
    /// Planes as they were stored.
    pub planes: Vec<(Plane, PlaneData)>,
    /// For a material with height or slope: tangent-space normals.
    pub normals: Option<PlaneData>,
    /// Report of the run.
    pub report: RunReport,
    /// Plan that was run.
    pub plan: Plan,
}

/// Reads and flattens a graph.
pub fn flat_graph(graph: &str) -> FlatGraph {
    opened(graph)
        .flatten(&Overrides::default())
        .unwrap_or_else(|error| panic!("{error}\n{graph}"))
}

fn opened(graph: &str) -> OpenGraph {
    OpenGraph {
        path: PathBuf::from("test.sabi"),
        text: graph.into(),
        pictures: SessionPictures::default(),
        strokes: Strokes::default(),
        trusted: TrustedPaths::of_file(Path::new("test.sabi")).with_path(&std::env::temp_dir()),
        document: Document::from_json(graph).unwrap_or_else(|error| panic!("{error}\n{graph}")),
    }
}

impl OnMesh {
    /// Warnings of the evaluation so far, as text.
    pub fn warnings(&self) -> Vec<String> {
        self.evaluator.warnings().iter().map(ToString::to_string).collect()
    }

    /// A graph of built-in kinds on a model, with `size` texels for one unit of UV.
    pub fn new(graph: &str, mesh: &Path, size: u32) -> OnMesh {
        OnMesh::with_kinds(graph, Kinds::builtin(), mesh, size)
    }

    /// A graph of these kinds on a model.
    pub fn with_kinds(graph: &str, kinds: Kinds, mesh: &Path, size: u32) -> OnMesh {
        OnMesh::on(graph, kinds, mesh, size, |_| {})
    }

    /// A graph of these kinds on a model whose atlas was tampered with.
    pub fn on(graph: &str, kinds: Kinds, mesh: &Path, size: u32, tamper: impl FnOnce(&mut LinkedModel)) -> OnMesh {
        OnMesh::on_model(graph, kinds, ModelOptions::new(mesh, size), tamper)
    }

    /// A graph of these kinds on a model that is taken in a certain way and tampered with.
    pub fn on_model(graph: &str, kinds: Kinds, model: ModelOptions, tamper: impl FnOnce(&mut LinkedModel)) -> OnMesh {
        OnMesh::of_open(&opened(graph), kinds, model, tamper)
    }

    /// A graph whose paint nodes have these strokes, on a model.
    pub fn painted(graph: &str, strokes: Strokes, mesh: &Path, size: u32) -> OnMesh {
        let open = OpenGraph {
            strokes,
            ..opened(graph)
        };
        OnMesh::of_open(&open, Kinds::builtin(), ModelOptions::new(mesh, size), |_| {})
    }

    fn of_open(open: &OpenGraph, kinds: Kinds, model: ModelOptions, tamper: impl FnOnce(&mut LinkedModel)) -> OnMesh {
        let options = EvaluatorOptions {
            model,
            overrides: Overrides::default(),
            fit: None,
            adapter: adapter(),
            caster: CasterChoice::Auto,
            budget_bytes: DEFAULT_BUDGET_BYTES,
        };
        let mut linked = LinkedModel::open(&options.model, &NoProgress).unwrap_or_else(|error| panic!("{error}"));
        tamper(&mut linked);
        let tables = linked.fitted(open.document.fit).tables(open.document.seed);
        let flat = open
            .flatten(&Overrides::default())
            .unwrap_or_else(|error| panic!("{error}"));
        let evaluator = Evaluator::assemble(open, flat, kinds, linked, device(), &options)
            .unwrap_or_else(|error| panic!("{error}"));
        OnMesh { evaluator, tables }
    }

    /// Puts another graph on the same model; its seed and fit must be those of the first.
    pub fn set_graph(&mut self, graph: &str) {
        self.evaluator.set_flat_graph(flat_graph(graph));
    }

    /// Evaluates `id` or `id.port` as a bake does.
    pub fn evaluate(&mut self, node: &str) -> NodeResult {
        self.evaluate_as(node, EvaluationOptions::baked())
    }

    /// Evaluates `id` or `id.port`.
    pub fn evaluate_as(&mut self, node: &str, asked: EvaluationOptions<'_>) -> NodeResult {
        let target = self.target(node);
        let plan = self.evaluator.plan(&[target], asked.mode);
        let plan = plan.unwrap_or_else(|error| panic!("{node}: {error}"));
        let mut run = self
            .evaluator
            .run(&plan, SUBMISSION, &NoProgress, asked.cache)
            .unwrap_or_else(|error| panic!("{node}: {error}"));
        let result = &plan.results[0];
        let gpu = self.evaluator.gpu();
        let surface = self.evaluator.surface();
        let planes: Vec<(Plane, PlaneData)> = result
            .stored
            .planes()
            .into_iter()
            .zip(&result.slots)
            .map(|(plane, slot)| (plane, read_slot(gpu, surface, &plan, &run, *slot).expect("a result")))
            .collect();
        let slot = |channel| {
            let at = planes
                .iter()
                .position(|(plane, _)| *plane == Plane::Material(channel))?;
            Some(result.slots[at])
        };
        let (height, slope) = (slot(Channel::Height), slot(Channel::Slope));
        let options = RunOptions::new(SUBMISSION, TextureBudget::Textures(DEFAULT_BUDGET_BYTES));
        let has_relief = height.is_some() || slope.is_some();
        let normals = has_relief.then(|| {
            let normals = Normals {
                gpu,
                surface,
                height,
                slope,
                options: &options,
            };
            normals.read(&mut run).expect("normals")
        });
        NodeResult {
            ty: result.stored.ty,
            planes,
            normals,
            report: run.report,
            plan,
        }
    }

    /// Returns the target that `id` or `id.port` names.
    pub fn target(&self, text: &str) -> Target {
        let (id, port) = match text.split_once('.') {
            Some((id, port)) => (id, Some(port.to_owned())),
            None => (text, None),
        };
        let node = self.evaluator.graph().find(id);
        Target {
            node: node.unwrap_or_else(|| panic!("the graph has no node '{id}'")),
            port,
        }
    }
}

impl NodeResult {
    /// Each number of a texel by name, for all texels of the atlas. Texels that nothing covers hold anything.
    pub fn components(&self) -> Vec<(String, Vec<f32>)> {
        let mut components = Vec::new();
        let planes = self.planes.iter().map(|(plane, data)| (names(*plane), data));
        let normals = self.normals.iter().map(|data| (&NORMAL[..], data));
        for (names, data) in planes.chain(normals) {
            for (at, name) in names.iter().enumerate() {
                let values = (0..data.len()).map(|index| data.texel(index)[at]).collect();
                components.push(((*name).to_owned(), values));
            }
        }
        components
    }

    /// One of them.
    pub fn component(&self, name: &str) -> Vec<f32> {
        let mut all = self.components().into_iter();
        let found = all.find(|(own, _)| own == name);
        found
            .unwrap_or_else(|| panic!("the result has no component '{name}'"))
            .1
    }

    /// The stored bytes of all planes: equal bytes mean equal results.
    pub fn bytes(&self) -> Vec<u8> {
        let planes = self.planes.iter().map(|(_, data)| data).chain(&self.normals);
        planes.flat_map(|data| data.bytes().iter().copied()).collect()
    }

    /// Ids of the nodes that ran, in order.
    pub fn ran(&self) -> Vec<String> {
        let steps = self.report.steps.iter();
        steps
            .flat_map(|step| step.nodes.iter().map(|(id, _)| id.clone()))
            .collect()
    }
}

const NORMAL: [&str; 3] = ["normal.x", "normal.y", "normal.z"];

fn names(plane: Plane) -> &'static [&'static str] {
    match plane {
        Plane::Mask => &["mask"],
        Plane::Color => &["color.r", "color.g", "color.b"],
        Plane::Vector => &["vector.x", "vector.y", "vector.z"],
        Plane::Material(Channel::Color) => &["base_color.r", "base_color.g", "base_color.b", "alpha"],
        Plane::Material(Channel::Surface) => &["roughness", "metallic", "occlusion"],
        Plane::Material(Channel::Height) => &["height"],
        Plane::Material(Channel::Slope) => &["slope.x", "slope.y", "slope.z"],
        Plane::Material(Channel::Emission) => &["emission.r", "emission.g", "emission.b"],
        Plane::Material(Channel::Coat) => &["coat", "coat_roughness"],
        Plane::Material(Channel::Anisotropy) => &["anisotropy.x", "anisotropy.y", "anisotropy.z"],
        Plane::Material(Channel::Sheen) => &["sheen.r", "sheen.g", "sheen.b", "sheen_roughness"],
        Plane::Material(Channel::Subsurface) => &["subsurface.r", "subsurface.g", "subsurface.b", "transmission"],
    }
}
