//! Errors of the device layer, cancellation, budgets and caches.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on may stop")]

#[path = "device/bands.rs"]
mod bands;
#[path = "device/cached_results.rs"]
mod cached_results;
#[path = "device/kept_results.rs"]
mod kept_results;
#[path = "device/shown.rs"]
mod shown;
#[path = "device/slices.rs"]
mod slices;

use std::cell::Cell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use sabi_gpu::{
    AdapterChoice, DEFAULT_BUDGET_BYTES, Gpu, GpuError, GpuSurface, Measures, PlaneData, RayScene, ResultCache, Run,
    RunOptions, SourceFill, SurfaceTables, Surfaces, TextureBudget, TileSet, read_slot, run_plan,
};
use sabi_graph::{Document, FlatGraph, Overrides, PortType, flatten};
use sabi_nodes::Library;
use sabi_nodes::kind::Param;
use sabi_nodes::link::Plane;
use sabi_plan::{
    FileContents, Lengths, LevelWidths, Mode, Plan, Planner, SourceKind, SourcePort, SourceStep, SourceValues, Target,
};
use sabi_surface::atlas::{Atlas, AtlasOptions};
use sabi_surface::model::Mesh;
use sabi_surface::pieces::Pieces;

const INSTALL: &str = "these tests need a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";

/// The software adapter, or the one that `SABI_ADAPTER` names.
fn adapter() -> AdapterChoice {
    match std::env::var("SABI_ADAPTER") {
        Ok(name) => AdapterChoice::Named(name),
        Err(_) => AdapterChoice::Cpu,
    }
}

fn gpu() -> Arc<Gpu> {
    static SHARED: OnceLock<Arc<Gpu>> = OnceLock::new();
    SHARED
        .get_or_init(|| Arc::new(Gpu::open(&adapter()).expect(INSTALL)))
        .clone()
}

/// Returns a square of side 1 in the plane z = 0 whose UVs fill most of the unit square.
fn square() -> Mesh {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    Mesh {
        positions: corners.map(|[x, y]| [x, y, 0.0]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4],
        uvs: corners.map(|[x, y]: [f32; 2]| [0.1 + 0.8 * x, 0.9 - 0.8 * y]).to_vec(),
        colors: Vec::new(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        triangle_material: vec![0; 2],
        triangle_part: vec![0; 2],
        ..Mesh::default()
    }
}

struct NoSources;

impl SourceFill for NoSources {
    fn plane(
        &mut self,
        step: &SourceStep,
        _output: &str,
        _plane: Plane,
        _inputs: &[Option<PlaneData>],
        _tiles: Option<&TileSet>,
    ) -> Result<Vec<u8>, String> {
        Err(format!("nobody fills '{}'", step.id))
    }

    fn scene(&mut self) -> Result<RayScene<'_>, String> {
        Err("there is nothing to follow rays through".to_owned())
    }
}

struct Bench {
    gpu: Arc<Gpu>,
    surface: GpuSurface,
    library: Library,
}

impl Bench {
    fn new(size: u32) -> Bench {
        let gpu = gpu();
        let mesh = square();
        let atlas = Atlas::build(&mesh, &AtlasOptions::new(size)).unwrap();
        let tables = SurfaceTables::new(&mesh, &Pieces::of(&mesh), &atlas, 1.0, 0);
        let surface = GpuSurface::upload(&gpu, &atlas, &tables, Measures::single_level(0.01)).unwrap();
        Bench {
            gpu,
            surface,
            library: Library::builtin(),
        }
    }

    fn plan(&self, nodes: &str, mode: Mode) -> Plan {
        let graph = graph(nodes);
        let sinks = sinks();
        let planner = Planner {
            graph: &graph,
            library: &self.library,
            sources: &BTreeMap::new(),
            sinks: &sinks,
            files: &FileContents::new(),
            lengths: Lengths {
                working_from: &|_| 1.0,
                largest_piece: 1.0,
                extent: &|_| [0.0, 1.0],
            },
            level_widths: LevelWidths::of_texels(0.01, 0),
            surface_key: [0; 32],
            mode,
            most_rays: None,
            limits: self.gpu.limits(),
        };
        let out = graph.find("out").unwrap();
        let (plan, errors) = planner.plan(&[Target { node: out, port: None }]);
        assert_eq!(errors, []);
        plan
    }

    /// Returns the plan of the chain, preceded by a source with this many masks.
    fn plan_with_source(&self, masks: usize) -> Plan {
        let mut plan = self.plan(CHAIN, FUSED);
        let slot = plan.results[0].slots[0];
        let step = SourceStep {
            node: 0,
            id: "lost".into(),
            kind: "source/image".into(),
            values: SourceValues::default(),
            reads: Vec::new(),
            writes: vec![("mask".into(), vec![(Plane::Mask, slot); masks])],
            keys: vec![[0; 32]],
        };
        plan.steps.insert(0, sabi_plan::Step::Source(step));
        plan
    }

    fn run(&self, plan: &Plan, options: &RunOptions<'_>, cache: Option<&mut ResultCache>) -> Result<Run, GpuError> {
        run_plan(
            &self.gpu,
            Surfaces::only(&self.surface),
            &self.library,
            plan,
            options,
            &mut NoSources,
            cache,
        )
    }

    fn bytes(&self, plan: &Plan, run: &Run) -> Vec<u8> {
        let slot = plan.results[0].slots[0];
        read_slot(&self.gpu, &self.surface, plan, run, slot)
            .unwrap()
            .bytes()
            .to_vec()
    }
}

fn graph(nodes: &str) -> FlatGraph {
    let text = format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ {nodes},
            "out": {{ "kind": "output/mask", "inputs": {{ "source": "last" }} }} }} }}"#
    );
    let document = Document::from_json(&text).unwrap_or_else(|error| panic!("{error}"));
    flatten(&document, &Overrides::default(), &mut |_| Err(String::new())).unwrap()
}

fn sinks() -> BTreeMap<String, SourceKind> {
    let kind = SourceKind {
        id: "output/mask".into(),
        label: String::new(),
        summary: String::new(),
        aliases: Vec::new(),
        params: vec![Param::text("name", "mask", "")],
        inputs: vec![SourcePort::new("source", PortType::Mask, "")],
        outputs: Vec::new(),
        content: [0; 32],
    };
    BTreeMap::from([(kind.id.clone(), kind)])
}

fn options<'a>() -> RunOptions<'a> {
    RunOptions::new(Duration::from_millis(25), TextureBudget::Textures(DEFAULT_BUDGET_BYTES))
}

const FUSED: Mode = Mode::Bake { fuse: true };
const CHAIN: &str = r#"
    "clouds": { "kind": "noise/simplex" },
    "cut": { "kind": "adjust/threshold", "inputs": { "source": "clouds" } },
    "last": { "kind": "adjust/invert", "inputs": { "source": "cut" } }"#;

#[test]
fn an_error_for_a_missing_adapter_names_it_and_the_adapters_found() {
    let own = gpu().summary().name.clone();
    let error = Gpu::open(&AdapterChoice::Named("Voodoo 2".into()))
        .err()
        .unwrap()
        .to_string();
    assert!(
        error.starts_with("no adapter matches 'Voodoo 2'; there are: "),
        "{error}"
    );
    assert!(error.contains(&own), "{error}");
}

#[test]
fn the_same_plan_gives_the_same_bytes_however_it_is_divided_into_kernels() {
    let bench = Bench::new(128);
    let plan = bench.plan(CHAIN, FUSED);
    let whole = bench.run(&plan, &options(), None).unwrap();
    let tiny = RunOptions {
        submission: Duration::from_nanos(1),
        ..options()
    };
    let sliced = bench.run(&plan, &tiny, None).unwrap();
    assert_eq!(bench.bytes(&plan, &whole), bench.bytes(&plan, &sliced));
}

#[test]
fn a_budget_that_is_too_small_is_an_error() {
    let bench = Bench::new(128);
    let plan = bench.plan(CHAIN, Mode::Bake { fuse: false });
    let small = RunOptions {
        budget: TextureBudget::Textures(1000),
        ..options()
    };
    let error = bench.run(&plan, &small, None).err().unwrap();
    assert!(matches!(error, GpuError::OverBudget { .. }));
    assert!(error.to_string().ends_with("more than the budget of 0 MiB"), "{error}");
    let small = RunOptions {
        budget: TextureBudget::Process(1000),
        ..options()
    };
    let error = bench.run(&plan, &small, None).err().unwrap();
    assert!(matches!(error, GpuError::OverMemory { left_mib: 0, .. }));
    assert!(
        error
            .to_string()
            .ends_with("the memory of the process; 0 MiB of it are left"),
        "{error}"
    );
}

#[test]
fn maps_of_owners_and_leaps_are_included_in_the_budget_and_in_the_peak() {
    let bench = Bench::new(128);
    let plan = bench.plan(CHAIN, FUSED);
    let all = bench.run(&plan, &options(), None).unwrap().report.pool.peak_bytes;
    let planes = all - bench.surface.texture_bytes();
    assert_eq!(bench.surface.texture_bytes(), 5 * bench.surface.texels());
    assert!(planes > 0 && planes.is_multiple_of(4 * bench.surface.texels()));
    let limited = |bytes| {
        let limited = RunOptions {
            budget: TextureBudget::Textures(bytes),
            ..options()
        };
        bench.run(&plan, &limited, None).err()
    };
    assert_eq!(limited(all), None);
    assert!(matches!(limited(all - 1), Some(GpuError::OverBudget { .. })));
}

/// Masks of one component, and a repeated filter of vectors.
const MIXED: &str = r#"
    "clouds": { "kind": "noise/simplex" },
    "soft": { "kind": "filter/blur", "inputs": { "source": "clouds" }, "params": { "radius": 0.03 } },
    "cut": { "kind": "adjust/threshold", "inputs": { "source": "soft" } },
    "softer": { "kind": "filter/blur", "inputs": { "source": "cut" }, "params": { "radius": 0.04 } },
    "last": { "kind": "blend/mask", "inputs": { "below": "softer", "above": "clouds" } }"#;

#[test]
fn a_run_holds_no_more_textures_than_are_needed_at_once() {
    let bench = Bench::new(64);
    for plan in [
        bench.plan(MIXED, Mode::Bake { fuse: false }),
        bench.plan(MIXED, Mode::Bake { fuse: false }).with_own_slots(),
    ] {
        let run = bench.run(&plan, &options(), None).unwrap();
        // During a blur: clouds and the blurred vectors, the flow along u and v, and two states of the heat, one of which is the start.
        let texel_bytes = 4 + 4 + 4 * 16;
        let expected = bench.surface.texture_bytes() + texel_bytes * bench.surface.texels();
        assert_eq!(run.report.pool.peak_bytes, expected, "{plan}");
        let limited = RunOptions {
            budget: TextureBudget::Textures(expected),
            ..options()
        };
        let within = bench.run(&plan, &limited, None).unwrap();
        assert_eq!(bench.bytes(&plan, &run), bench.bytes(&plan, &within));
    }
}

#[test]
fn kernels_of_points_write_over_what_they_read_last_and_give_the_same() {
    let bench = Bench::new(256);
    let atlas = Atlas::build(&square(), &AtlasOptions::new(256)).unwrap();
    let unfused = bench.plan(CHAIN, Mode::Bake { fuse: false });
    for plan in [unfused.clone().with_own_slots(), unfused] {
        let [beside, over] = [u64::MAX, 0].map(|writes_over_from| {
            let options = RunOptions {
                writes_over_from,
                ..options()
            };
            let run = bench.run(&plan, &options, None).unwrap();
            let plane = read_slot(&bench.gpu, &bench.surface, &plan, &run, plan.results[0].slots[0]).unwrap();
            (run.report.pool.peak_bytes, plane)
        });
        let covered = (0..atlas.owners.len()).filter(|texel| atlas.owners[*texel] != sabi_surface::atlas::EMPTY);
        let differing = covered.filter(|texel| beside.1.texel(*texel) != over.1.texel(*texel));
        assert_eq!(differing.count(), 0);
        // A second mask is replaced by a band.
        assert!(
            over.0 + 3 * bench.surface.texels() < beside.0,
            "{} {}",
            over.0,
            beside.0
        );
    }
}

#[test]
fn kernels_that_are_forgotten_change_no_result_and_are_compiled_again() {
    let bench = Bench::new(64);
    let plan = bench.plan(MIXED, FUSED);
    let forgetful = RunOptions {
        forgets_kernels: true,
        ..options()
    };
    let first = bench.run(&plan, &forgetful, None).unwrap();
    let again = bench.run(&plan, &options(), None).unwrap();
    assert_eq!(bench.bytes(&plan, &first), bench.bytes(&plan, &again));
}

#[test]
fn an_error_of_a_kernel_that_cannot_be_compiled_names_all_its_nodes() {
    let error = GpuError::Kernel {
        nodes: "rust, own".into(),
        reason: "expected ';'".into(),
    };
    assert_eq!(
        error.to_string(),
        "the kernel of rust, own cannot be compiled: expected ';'. If one of these nodes is your own, look there first"
    );
}

#[test]
fn a_run_stops_when_it_is_canceled() {
    let bench = Bench::new(64);
    let plan = bench.plan(CHAIN, FUSED);
    let canceled = RunOptions {
        is_canceled: &|| true,
        ..options()
    };
    assert_eq!(bench.run(&plan, &canceled, None).err(), Some(GpuError::Canceled));
}

#[test]
fn interactive_and_fused_results_agree() {
    let bench = Bench::new(64);
    let fused = bench.plan(CHAIN, FUSED);
    let single = bench.plan(CHAIN, Mode::Interactive);
    let of_fused = bench.run(&fused, &options(), None).unwrap();
    let of_single = bench.run(&single, &options(), None).unwrap();
    let (a, b) = (bench.bytes(&fused, &of_fused), bench.bytes(&single, &of_single));
    let number = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let worst = a
        .chunks(4)
        .zip(b.chunks(4))
        .map(|(a, b)| (number(a) - number(b)).abs())
        .fold(0.0, f32::max);
    assert!(worst <= 1.0 / 1024.0, "{worst}");
}

#[test]
fn the_error_of_a_source_that_fails_has_the_sources_own_text() {
    let bench = Bench::new(64);
    let plan = bench.plan_with_source(1);
    let error = bench.run(&plan, &options(), None).err().unwrap();
    assert_eq!(error.to_string(), "nobody fills 'lost'");
}

/// Source that returns this many bytes for every plane, and counts the planes.
struct Counted {
    bytes: usize,
    asked: Rc<Cell<usize>>,
}

impl SourceFill for Counted {
    fn plane(
        &mut self,
        _step: &SourceStep,
        _output: &str,
        _plane: Plane,
        _inputs: &[Option<PlaneData>],
        _tiles: Option<&TileSet>,
    ) -> Result<Vec<u8>, String> {
        self.asked.set(self.asked.get() + 1);
        Ok(vec![0; self.bytes])
    }

    fn scene(&mut self) -> Result<RayScene<'_>, String> {
        Err("there is nothing to follow rays through".to_owned())
    }
}

#[test]
fn a_source_of_many_planes_can_be_canceled_between_planes() {
    let bench = Bench::new(64);
    let plan = bench.plan_with_source(5);
    let asked = Rc::new(Cell::new(0));
    let mut source = Counted {
        bytes: 4 * bench.surface.texels() as usize,
        asked: asked.clone(),
    };
    let after_two = RunOptions {
        is_canceled: &|| asked.get() == 2,
        ..options()
    };
    let run = |options: &RunOptions<'_>, source: &mut Counted| {
        let run = run_plan(
            &bench.gpu,
            Surfaces::only(&bench.surface),
            &bench.library,
            &plan,
            options,
            source,
            None,
        );
        run.err()
    };
    assert_eq!(run(&after_two, &mut source), Some(GpuError::Canceled));
    assert_eq!(asked.get(), 2);
    asked.set(0);
    assert_eq!(run(&options(), &mut source), None);
    assert_eq!(asked.get(), 5);
}

#[test]
fn a_source_that_returns_too_few_bytes_is_an_error_and_no_panic() {
    let bench = Bench::new(64);
    let plan = bench.plan_with_source(1);
    let mut source = Counted {
        bytes: 12,
        asked: Rc::default(),
    };
    let run = run_plan(
        &bench.gpu,
        Surfaces::only(&bench.surface),
        &bench.library,
        &plan,
        &options(),
        &mut source,
        None,
    );
    let error = run.err().unwrap().to_string();
    assert!(error.starts_with("node 'lost' gave 12 bytes for 'mask'"), "{error}");
}
