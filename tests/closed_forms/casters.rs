//! The two casters, which follow the same rays on the processor and in a kernel, compared with each other.

use sabi_engine::Kinds;
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_gpu::{CasterChoice, Hits, ResultCache};
use sabi_plan::Mode;
use sabi_tests::{EvaluationOptions, MeshFile, OnMesh, Quad, project};

/// Maximum share of texels that may differ: if a ray passes an edge within rounding, either answer is right.
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
        on_mesh.evaluator.rays.caster = caster;
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
fn both_casters_handle_one_triangle_and_a_triangle_without_area() {
    let one = Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        uvs: [[0.1, 0.9], [0.9, 0.9], [0.9, 0.1], [0.1, 0.1]],
    };
    let flat = Quad {
        corners: [[0.5; 3]; 4],
        uvs: [[0.95; 2]; 4],
    };
    for quads in [vec![one], vec![one, flat]] {
        let made = MeshFile::new(quads).write();
        let mut on_mesh = OnMesh::new(&graph("curvature", r#""radius": 0.3"#), made.path(), 64);
        for caster in [CasterChoice::Cpu, CasterChoice::Gpu] {
            on_mesh.evaluator.rays.caster = caster;
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

#[test]
fn hits_of_longer_rays_give_the_results_of_shorter_rays() {
    let path = project("assets/meshes/figure.glb");
    let mut on_mesh = OnMesh::new(&graph("occlusion", ""), &path, 128);
    let mut cache = ResultCache::new(1 << 30);
    let owned: Vec<usize> = on_mesh.owned().map(|(index, _)| index).collect();
    for (kind, length, settings) in [
        (
            "occlusion",
            "distance",
            [r#""falloff": "none""#, r#""falloff": "linear""#],
        ),
        ("thickness", "distance", [r#""seed": 3"#, r#""seed": 4"#]),
        ("edges", "width", [r#""angle": 20"#, r#""angle": 60"#]),
        ("cavity", "width", [r#""softness": 0.1"#, r#""smooth_groups": false"#]),
        ("rounded_normal", "radius", [r#""rays": 8"#, r#""rays": 9"#]),
    ] {
        for (setting, length_now) in settings.into_iter().zip([0.02, 0.05]) {
            on_mesh.set_graph(&graph(kind, &format!(r#""{length}": {length_now}, {setting}"#)));
            let shot = on_mesh.evaluate("rays").components();
            on_mesh.evaluator.rays.hits = Hits::Cached;
            let asked = EvaluationOptions {
                mode: Mode::Interactive,
                cache: Some(&mut cache),
            };
            let remembered = on_mesh.evaluate_as("rays", asked).components();
            on_mesh.evaluator.rays.hits = Hits::Cast;
            for ((name, shot), (_, remembered)) in shot.iter().zip(&remembered) {
                let apart = owned.iter().filter(|&&at| (shot[at] - remembered[at]).abs() > 1e-3);
                let share = apart.count() as f64 / owned.len() as f64;
                assert!(share <= OUTLIERS, "{kind} {setting}, {name}: {share}");
            }
        }
    }
}

#[test]
fn shorter_rays_reuse_the_hits_of_longer_ones() {
    let path = project("assets/meshes/figure.glb");
    let mut on_mesh = OnMesh::new(&graph("edges", ""), &path, 128);
    on_mesh.evaluator.rays.hits = Hits::Cached;
    let mut cache = ResultCache::new(1 << 30);
    let mut held = |params: &str| {
        on_mesh.set_graph(&graph("edges", params));
        let asked = EvaluationOptions {
            mode: Mode::Interactive,
            cache: Some(&mut cache),
        };
        on_mesh.evaluate_as("rays", asked);
        cache.bytes().0
    };
    // The cache keeps only hits here, no results of nodes.
    let first = held(r#""width": 0.02"#);
    assert!(first > 0);
    for same in [r#""width": 0.1"#, r#""width": 0.001, "angle": 70"#, r#""softness": 1"#] {
        assert_eq!(held(same), first, "{same}");
    }
    let [other_rays, longer] = [r#""rays": 8"#, r#""width": 3"#].map(&mut held);
    assert!(
        other_rays > first && longer > other_rays,
        "{first}, {other_rays}, {longer}"
    );
}

#[test]
fn rays_are_shot_once_for_a_model_and_its_knobs_however_often_it_is_opened() {
    let cache = tempfile::tempdir().unwrap();
    let path = project("assets/meshes/figure.glb");
    let evaluate = |params: &str| {
        let model = ModelOptions {
            cache_dir: Some(cache.path().to_owned()),
            ..ModelOptions::new(&path, 64)
        };
        let mut on_mesh = OnMesh::on_model(&graph("thickness", params), Kinds::builtin(), model, |_| {});
        let evaluated = on_mesh.evaluate("rays");
        (!evaluated.report.found_on_disk.is_empty(), evaluated.bytes())
    };
    let (was_found, first) = evaluate("");
    assert!(!was_found);
    assert_eq!(evaluate(""), (true, first.clone()));
    assert!(!evaluate(r#""distance": 0.2"#).0 && !evaluate(r#""seed": 1"#).0);
    // A truncated file is not used as a result.
    for file in std::fs::read_dir(cache.path().join("rays")).unwrap() {
        let path = file.unwrap().path();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    }
    assert_eq!(evaluate(""), (false, first.clone()));
    assert_eq!(evaluate(""), (true, first));
}

#[test]
fn a_first_picture_of_a_few_rays_has_the_same_mean_and_is_not_kept() {
    let path = project("assets/meshes/figure.glb");
    let mut on_mesh = OnMesh::new(&graph("occlusion", r#""rays": 64, "distance": 0.3"#), &path, 128);
    let mut cache = ResultCache::new(1 << 30);
    let mut picture = |most_rays| {
        on_mesh.evaluator.rays.most_rays = most_rays;
        let asked = EvaluationOptions {
            mode: Mode::Interactive,
            cache: Some(&mut cache),
        };
        let evaluated = on_mesh.evaluate_as("rays", asked);
        let values = evaluated.component("mask");
        let owned: Vec<f32> = on_mesh.owned().map(|(index, _)| values[index]).collect();
        (evaluated.ran().len(), owned)
    };
    let (first, grainy) = picture(Some(2));
    let (then, fine) = picture(None);
    assert_eq!(
        (first, then),
        (2, 2),
        "rays and what is made of their means, each time: the second picture is not taken for the first"
    );
    assert_ne!(grainy, fine);
    let mean = |values: &[f32]| values.iter().map(|value| f64::from(*value)).sum::<f64>() / values.len() as f64;
    // Two rays for each place: four standard deviations of a half, divided by the root of their number.
    let chance = 4.0 * 0.5 / (2.0 * grainy.len() as f64).sqrt();
    assert!((mean(&grainy) - mean(&fine)).abs() < chance);
}
