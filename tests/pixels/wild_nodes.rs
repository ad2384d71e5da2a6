//! Nodes of users that compute nonsense: they end, and later nodes are still evaluated.

use sabi_gpu::CasterChoice;
use sabi_tests::{NodeFolder, OnMesh, project};

/// A node that shoots one ray a place, whose mask is whether it hit.
fn shooter(origin: &str, reach: &str, direction: &str) -> String {
    format!(
        "\
//! Shooter
//! Shoots where it is told.
//! @use rays

struct Params {{
    /// How many.
    /// @range 1 4 @default 1
    rays: u32,
    /// What divides to no number.
    /// @range 0 1 @default 0
    nothing: f32,
    /// The same once more, since a driver may take a number divided by itself for 1.
    /// @range 0 1 @default 0
    divisor: f32,
}}

/// The ray.
/// @rays params.rays @finds nearest
fn ray(at: Surface, index: u32, params: Params) -> Ray {{
    let none = params.nothing / params.divisor;
    let endless = 1.0 / (params.nothing * params.divisor);
    return Ray({origin}, {reach}, {direction});
}}

/// Whether it hit.
fn mask(hit: Hit) -> f32 {{
    return select(0.0, 1.0, hit.is_hit);
}}
"
    )
}

const GRAPH: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "wild": { "kind": "own/wild", "params": {} },
    "after": { "kind": "adjust/invert", "inputs": { "source": "wild" } } } }"#;

#[test]
fn rays_that_are_no_numbers_go_nowhere_with_either_caster() {
    for (origin, reach, direction) in [
        ("at.position + vec3f(none, 0.0, f32(index))", "1.0", "at.normal"),
        ("at.position + vec3f(0.0, endless, f32(index))", "1.0", "at.normal"),
        ("at.position + f32(index) * none", "none", "at.normal"),
        ("at.position + f32(index) * none", "-1.0 + none * 0.0", "at.normal"),
        ("at.position", "1.0", "vec3f(none + f32(index))"),
        ("at.position", "1.0", "at.normal * params.nothing * f32(index) * none"),
        ("at.position", "1.0", "vec3f(0.0, endless, f32(index))"),
    ] {
        let text = shooter(origin, reach, direction);
        let kinds = NodeFolder::new(&[("own/wild", &text)]).kinds();
        assert!(kinds.faults.is_empty(), "{:?}", kinds.faults);
        let mut on_mesh = OnMesh::with_kinds(GRAPH, kinds, &project("assets/meshes/figure.glb"), 64);
        for caster in [CasterChoice::Cpu, CasterChoice::Gpu] {
            on_mesh.evaluator.rays.caster = caster;
            let after = on_mesh.evaluate("after").component("mask");
            let hits = on_mesh.owned().filter(|(index, _)| after[*index] != 1.0).count();
            assert_eq!(hits, 0, "{caster}: {origin}, {reach}, {direction}");
        }
    }
}

/// A filter that walks and reads where nothing is.
const WANDERER: &str = "\
//! Wanderer
//! Walks nowhere, and far away.
//! @use surface

struct Params {
    /// What divides to no number.
    /// @range 0 1 @default 0
    nothing: f32,
}

/// What it finds.
/// @input source Where it walks.
fn mask(at: Surface, params: Params, source: texture_2d_array<f32>) -> f32 {
    let none = params.nothing / params.nothing;
    let far = surface_walk(surface_standing(at), at.texel_step * 1e30);
    let lost = surface_walk(surface_standing(at), vec3f(none));
    let neighbor = surface_neighbor(source, at, vec2i(1000000, -1000000)).x;
    let found = surface_sample(source, far).x + surface_sample(source, lost).x + neighbor;
    return select(0.0, 1.0, found > 2.0);
}
";

#[test]
fn a_filter_that_walks_off_ends_and_reads_something() {
    let kinds = NodeFolder::new(&[("own/wild", WANDERER)]).kinds();
    assert!(kinds.faults.is_empty(), "{:?}", kinds.faults);
    let graph = r#"{ "format": "sabi", "version": 1, "nodes": {
        "noise": { "kind": "noise/simplex" },
        "wild": { "kind": "own/wild", "inputs": { "source": "noise" } } } }"#;
    let mut on_mesh = OnMesh::with_kinds(graph, kinds, &project("assets/meshes/figure.glb"), 64);
    let values = on_mesh.evaluate("wild").component("mask");
    assert!(on_mesh.owned().all(|(index, _)| [0.0, 1.0].contains(&values[index])));
}
