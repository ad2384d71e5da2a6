//! Three ways to run a graph (fused, unfused and interactive) give one result, and with a cache nothing runs twice.

use sabi_gpu::ResultCache;
use sabi_plan::Mode;
use sabi_tests::{EvaluationOptions, OnMesh, project, range};

const BAKE: Mode = Mode::Bake { fuse: true };
const UNFUSED: Mode = Mode::Bake { fuse: false };

const EXAMPLES: [&str; 2] = ["weathered-bench", "mossy-figure"];
const SIZE: u32 = 256;

fn example(name: &str) -> OnMesh {
    let graph = std::fs::read_to_string(project(&format!("tests/graphs/{name}.sabi"))).expect("an example graph");
    let mesh = name.split_once('-').expect("an example is called after its model").1;
    OnMesh::new(&graph, &project(&format!("assets/meshes/{mesh}.glb")), SIZE)
}

fn as_mode(mode: Mode) -> EvaluationOptions<'static> {
    EvaluationOptions {
        mode,
        ..EvaluationOptions::baked()
    }
}

/// The largest difference, as a share of what the component can be: 0 to 1, or the heights that there are.
fn largest_difference(on_mesh: &OnMesh, name: &str, one: &[f32], other: &[f32]) -> f64 {
    let whole = match name {
        "height" => range(on_mesh.owned().map(|(index, _)| one[index])),
        _ => 1.0,
    };
    let difference = |index: usize| (f64::from(one[index]) - f64::from(other[index])).abs() / whole;
    on_mesh.covered().map(difference).fold(0.0, f64::max)
}

#[test]
fn fused_unfused_and_interactive_agree_on_the_example_graphs() {
    for name in EXAMPLES {
        let mut on_mesh = example(name);
        let fused = on_mesh.evaluate_as("out", as_mode(BAKE));
        let expected = fused.components();
        assert!(expected.iter().any(|(name, _)| name == "normal.x"), "{name}: no relief");
        for mode in [UNFUSED, Mode::Interactive] {
            let other = on_mesh.evaluate_as("out", as_mode(mode));
            assert!(fused.plan.passes() < other.plan.passes(), "{name}: nothing was fused");
            for ((component, one), (_, other)) in expected.iter().zip(&other.components()) {
                let difference = largest_difference(&on_mesh, component, one, other);
                assert!(
                    difference <= 1.0 / 1024.0,
                    "{name}, {mode:?}: {component} differs by {difference:.6} of its range"
                );
            }
        }
    }
}

const CHAIN: &str = r##"{ "format": "sabi", "version": 1, "nodes": {
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.5, "octaves": 2 } },
    "grains": { "kind": "noise/cells", "params": { "size": 0.5 } },
    "levels": { "kind": "adjust/levels", "inputs": { "source": "clouds" }, "params": { "black": 0.2 } },
    "both": { "kind": "blend/mask", "inputs": { "below": "levels", "above": "grains" } },
    "smooth": { "kind": "filter/smooth", "inputs": { "source": "both" } },
    "base": { "kind": "source/material", "params": { "color": "#806040" } },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "smooth" } } } }"##;

fn run(on_mesh: &mut OnMesh, cache: &mut ResultCache) -> (Vec<String>, Vec<u8>) {
    let asked = EvaluationOptions {
        mode: Mode::Interactive,
        cache: Some(cache),
    };
    let evaluated = on_mesh.evaluate_as("rust", asked);
    let mut ran = evaluated.ran();
    ran.sort();
    (ran, evaluated.bytes())
}

fn cube() -> OnMesh {
    OnMesh::new(CHAIN, &project("assets/meshes/cube.glb"), 64)
}

/// Evaluates the graph with an empty cache.
fn afresh(graph: &str) -> Vec<u8> {
    let mut on_mesh = cube();
    on_mesh.set_graph(graph);
    run(&mut on_mesh, &mut ResultCache::new(1 << 30)).1
}

#[test]
fn a_slider_runs_its_node_and_what_hangs_below_it() {
    let mut on_mesh = cube();
    let mut cache = ResultCache::new(1 << 30);
    let all = ["base", "both", "clouds", "grains", "levels", "rust", "smooth"];
    assert_eq!(run(&mut on_mesh, &mut cache).0, all);
    assert!(run(&mut on_mesh, &mut cache).0.is_empty(), "nothing has changed");

    let moved = CHAIN.replace("\"black\": 0.2", "\"black\": 0.4");
    on_mesh.set_graph(&moved);
    let (ran, bytes) = run(&mut on_mesh, &mut cache);
    assert_eq!(ran, ["both", "levels", "rust", "smooth"]);
    assert_eq!(bytes, afresh(&moved));

    on_mesh.set_graph(CHAIN);
    let (ran, bytes) = run(&mut on_mesh, &mut cache);
    assert!(ran.is_empty(), "what was there before is there still, but {ran:?} ran");
    assert_eq!(bytes, afresh(CHAIN));
}

#[test]
fn another_wire_runs_what_hangs_below_it() {
    let mut on_mesh = cube();
    let mut cache = ResultCache::new(1 << 30);
    run(&mut on_mesh, &mut cache);
    let rewired = CHAIN.replace("\"below\": \"levels\"", "\"below\": \"clouds\"");
    on_mesh.set_graph(&rewired);
    let (ran, bytes) = run(&mut on_mesh, &mut cache);
    assert_eq!(ran, ["both", "rust", "smooth"]);
    assert_eq!(bytes, afresh(&rewired));
}

#[test]
fn a_cache_without_room_changes_no_result() {
    let mut on_mesh = cube();
    let mut cache = ResultCache::new(40_000);
    let first = run(&mut on_mesh, &mut cache).1;
    let (held, allowed) = cache.bytes();
    assert!(held <= allowed, "{held} bytes are held, {allowed} are allowed");
    assert_eq!(run(&mut on_mesh, &mut cache).1, first);
    assert_eq!(first, afresh(CHAIN));
}
