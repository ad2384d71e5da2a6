//! The two casters, each the other's oracle: the same rays followed by the processor and by a kernel.

use sabi_engine::CasterChoice;
use sabi_tests::{MeshFile, OnMesh, Quad, project};

/// Most texels that may differ: where a ray passes an edge within rounding, either answer is right.
const OUTLIERS: f64 = 0.002;

fn graph(kind: &str, params: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{
            "rays": {{ "kind": "surface/{kind}", "params": {{ {params} }} }} }} }}"#
    )
}

/// Share of owned texels at which the casters differ.
fn differing(on_mesh: &mut OnMesh, component: &str) -> f64 {
    let mut by = |caster| {
        on_mesh.workpiece.caster = caster;
        on_mesh.evaluate("rays").component(component)
    };
    let [processor, device] = [by(CasterChoice::Cpu), by(CasterChoice::Gpu)];
    let owned: Vec<usize> = on_mesh.owned().map(|(index, _)| index).collect();
    let apart = owned.iter().filter(|&&at| (processor[at] - device[at]).abs() > 1e-4);
    apart.count() as f64 / owned.len() as f64
}

#[test]
fn both_casters_hit_the_same() {
    for mesh in ["figure", "chain"] {
        let path = project(&format!("assets/meshes/{mesh}.glb"));
        let mut on_mesh = OnMesh::new(&graph("occlusion", ""), &path, 256);
        for (kind, params, component) in [
            ("occlusion", r#""distance": 0.05"#, "mask"),
            ("occlusion", r#""distance": 1"#, "mask"),
            ("thickness", r#""distance": 0.5, "rays": 4"#, "mask"),
            ("curvature", r#""radius": 0.1, "rays": 8"#, "mask"),
            (
                "occlusion",
                r#""distance": 0.3, "falloff": "linear", "rays": 3"#,
                "mask",
            ),
        ] {
            on_mesh.set_graph(&graph(kind, params));
            let share = differing(&mut on_mesh, component);
            assert!(share <= OUTLIERS, "{mesh}: {kind} {params}: {share}");
        }
    }
}

#[test]
fn one_triangle_and_one_without_area_are_no_matter_to_either() {
    let one = Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        uvs: [[0.1, 0.9], [0.9, 0.9], [0.9, 0.1], [0.1, 0.1]],
    };
    let flat = Quad {
        corners: [[0.5; 3]; 4],
        uvs: [[0.95; 2]; 4],
    };
    for quads in [vec![one.clone()], vec![one, flat]] {
        let made = MeshFile::new(quads).write();
        let mut on_mesh = OnMesh::new(&graph("curvature", r#""radius": 0.3"#), made.path(), 64);
        for caster in [CasterChoice::Cpu, CasterChoice::Gpu] {
            on_mesh.workpiece.caster = caster;
            let bend = on_mesh.evaluate("rays").component("mask");
            eprintln!(
                "{caster} {:?}",
                on_mesh
                    .owned()
                    .filter(|(i, _)| bend[*i] != 0.0)
                    .map(|(i, _)| (i, bend[i], on_mesh.position(i)))
                    .collect::<Vec<_>>()
            );
            let bent = on_mesh.owned().find(|(index, _)| bend[*index] != 0.0);
            assert_eq!(bent, None, "a plane does not bend, {caster}");
        }
    }
}
