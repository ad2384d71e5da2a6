//! Extents of a material's values, computed before it is drawn, compared with its texels.

use std::path::Path;
use std::time::Duration;

use sabi_engine::phases::NoProgress;
use sabi_gpu::{DEFAULT_BUDGET_BYTES, RunOptions, TextureBudget, ValueExtent, read_slot, texture_extents};
use sabi_plan::Mode;
use sabi_surface::atlas::GHOST_BIT;
use sabi_tests::{OnMesh, extent, project};

const SUBMISSION: Duration = Duration::from_millis(200);

/// Extent of a component of a plane of a node's result: computed on the device, and from the values that are read back.
fn extents(nodes: &str, node: &str, plane: usize, component: u32, mesh: &Path) -> [ValueExtent; 2] {
    let graph = format!(r#"{{ "format": "sabi", "version": 1, "nodes": {{ {nodes} }} }}"#);
    let mut on_mesh = OnMesh::new(&graph, mesh, 96);
    let target = on_mesh.target(node);
    let evaluator = &mut on_mesh.evaluator;
    let plan = evaluator.plan(&[target], Mode::Bake { fuse: true }).expect("a plan");
    let run = evaluator.run(&plan, SUBMISSION, &NoProgress, None).expect("a run");
    let slot = plan.results[0].slots[plane];
    let (gpu, surface) = (evaluator.gpu(), evaluator.surface());
    let texture = run.texture(slot).expect("a result");
    let options = RunOptions::new(SUBMISSION, TextureBudget::Textures(DEFAULT_BUDGET_BYTES));
    let found = texture_extents(gpu, surface, &[(&texture, component)], &options).expect("extents");
    let data = read_slot(gpu, surface, &plan, &run, slot).expect("a result");
    let owners = evaluator.linked().atlas.owners.iter().enumerate();
    let owned = owners.filter(|(_, owner)| **owner & GHOST_BIT == 0);
    let values: Vec<f32> = owned.map(|(index, _)| data.texel(index)[component as usize]).collect();
    let numbers = values.iter().copied().filter(|value| !value.is_nan());
    let read = ValueExtent {
        not_numbers: values.iter().filter(|value| value.is_nan()).count() as u32,
        range: Some(extent(numbers)).filter(|[low, high]| low <= high),
    };
    [found[0], read]
}

#[test]
fn extents_on_the_device_are_those_of_the_values_that_are_read_back() {
    let clouds = r#""clouds": { "kind": "noise/simplex" }"#;
    let below = format!(
        r#"{clouds}, "low": {{ "kind": "adjust/remap", "inputs": {{ "source": "clouds" }},
             "params": {{ "to_low": -3.5, "to_high": -0.25 }} }}"#
    );
    let layer = format!(
        r#"{clouds}, "base": {{ "kind": "source/material" }},
           "layer": {{ "kind": "effect/layer", "inputs": {{ "base": "base", "mask": "clouds", "height_map": "clouds" }},
             "params": {{ "height": 0.02, "alpha": 0.3, "alpha_on": true }} }}"#
    );
    let cube = project("assets/meshes/cube.glb");
    let figure = project("assets/meshes/figure.glb");
    for mesh in [&cube, &figure] {
        for (nodes, node, plane, component) in [
            (clouds, "clouds", 0, 0),
            (below.as_str(), "low", 0, 0),
            (layer.as_str(), "layer", 0, 3),
            (layer.as_str(), "layer", 2, 0),
        ] {
            let [found, read] = extents(nodes, node, plane, component, mesh);
            assert_eq!(found, read, "{node}, plane {plane} on {}", mesh.display());
            let [low, high] = found.range.expect("a range");
            assert!(low < high, "{node}, plane {plane}: {low} to {high}");
        }
    }
}
