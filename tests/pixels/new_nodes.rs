//! Adding a node takes only one file, also at run time.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use sabi_engine::Kinds;
use sabi_engine::session::watch::{Watched, Watcher};
use sabi_tests::{NodeFolder, OnMesh, project};

/// The example of the design, under a name of its own.
const FACING: &str = "\
//! Facing
//! Selects the parts of the surface that face one way.

struct Params {
    /// The way to face, in model space.
    /// @default 0 1 0
    toward: vec3f,
    /// How far from that way the mask still reaches.
    /// @angle @range 0 180 @default 60
    reach: f32,
}

/// How much this place faces that way.
fn mask(at: Surface, params: Params) -> f32 {
    let away = acos(clamp(dot(at.normal, normalize(params.toward)), -1.0, 1.0));
    return 1.0 - smoothstep(0.0, max(params.reach, 1e-4), away);
}
";

const GRAPH: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "up": { "kind": "own/facing", "params": { "toward": [0, 1, 0], "reach": 45 } },
    "down": { "kind": "adjust/invert", "inputs": { "source": "up" } } } }"#;

fn evaluated(kinds: Kinds) -> (OnMesh, Vec<f32>) {
    let mut on_mesh = OnMesh::with_kinds(GRAPH, kinds, &project("assets/meshes/cube.glb"), 64);
    let values = on_mesh.evaluate("down").component("mask");
    (on_mesh, values)
}

/// Returns true if values are `inside` on the top of the cube and `1 - inside` everywhere else.
fn selects_the_top(on_mesh: &OnMesh, values: &[f32], inside: f32) -> bool {
    on_mesh.owned().all(|(index, triangle)| {
        let corner = on_mesh.evaluator.linked().model.mesh.triangles[triangle as usize][0];
        let is_top = on_mesh.evaluator.linked().model.mesh.normals[corner as usize][1] > 0.5;
        values[index] == if is_top { inside } else { 1.0 - inside }
    })
}

#[test]
fn a_node_added_at_run_time_works_like_any_other() {
    let (on_mesh, values) = evaluated(NodeFolder::new(&[("own/facing", FACING)]).kinds());
    assert!(selects_the_top(&on_mesh, &values, 0.0));
}

#[test]
fn a_broken_edit_keeps_the_last_good_version() {
    let folder = NodeFolder::new(&[("own/facing", FACING)]);
    let mut kinds = folder.kinds();
    folder.write("own/facing", &FACING.replace("acos(", "acos(("));
    kinds.add_folder(&folder.path());
    assert_eq!(kinds.faults.len(), 1, "{:?}", kinds.faults);
    let (on_mesh, values) = evaluated(kinds);
    assert!(selects_the_top(&on_mesh, &values, 0.0));
    let warnings = on_mesh.warnings();
    assert!(
        warnings.iter().any(|warning| warning.contains("facing.wgsl")),
        "{warnings:?}"
    );
}

/// A folder of nodes that is watched.
struct WatchedNodes<'f> {
    folder: &'f NodeFolder,
    watcher: Watcher,
    woken: Receiver<()>,
}

impl WatchedNodes<'_> {
    fn new(folder: &NodeFolder) -> WatchedNodes<'_> {
        let (wake, woken) = channel();
        let watcher = Watcher::new(move || {
            // Nobody listens once the test is over.
            let _ = wake.send(());
        });
        let watcher = watcher.expect("a watcher");
        watcher.watch(Watched {
            nodes: vec![folder.path()],
            ..Watched::default()
        });
        while !watcher.is_watching() {
            std::thread::sleep(Duration::from_millis(1));
        }
        WatchedNodes { folder, watcher, woken }
    }

    /// Waits for an expected change and reads it. The time limit is generous, since the system determines the delay.
    fn refresh(&self, kinds: &mut Kinds) {
        self.woken.recv_timeout(Duration::from_secs(60)).expect("a change");
        assert!(self.watcher.changes().nodes, "nothing else is watched");
        kinds.reread(&[self.folder.path()]);
    }
}

#[test]
fn an_edit_is_seen_and_a_broken_one_is_told() {
    let folder = NodeFolder::new(&[("own/facing", FACING)]);
    let mut kinds = folder.kinds();
    let watched = WatchedNodes::new(&folder);
    assert!(watched.watcher.changes().is_empty(), "nothing has changed");

    folder.write(
        "own/facing",
        &FACING.replace("return 1.0 - smoothstep", "return smoothstep"),
    );
    watched.refresh(&mut kinds);
    assert!(kinds.faults.is_empty(), "{:?}", kinds.faults);
    let (on_mesh, values) = evaluated(kinds.clone());
    assert!(selects_the_top(&on_mesh, &values, 1.0));

    folder.write("own/facing", "fn mask() {");
    watched.refresh(&mut kinds);
    assert_eq!(kinds.faults.len(), 1, "{:?}", kinds.faults);
    let (on_mesh, values) = evaluated(kinds.clone());
    assert!(selects_the_top(&on_mesh, &values, 1.0));

    folder.write("own/facing", FACING);
    watched.refresh(&mut kinds);
    assert!(kinds.faults.is_empty(), "{:?}", kinds.faults);
    let (on_mesh, values) = evaluated(kinds);
    assert!(selects_the_top(&on_mesh, &values, 0.0));
}

#[test]
fn an_edit_of_a_library_reaches_the_nodes_that_use_it() {
    let node = FACING.replace("face one way.\n", "face one way.\n//!\n//! @use own\n");
    let node = node.replace("return 1.0 - smoothstep", "return turned_over * smoothstep");
    let library = |factor: &str| format!("/// Which way it is.\nconst turned_over: f32 = {factor};\n");
    let folder = NodeFolder::new(&[("lib/own", &library("1.0")), ("own/facing", &node)]);
    let mut kinds = folder.kinds();
    let watched = WatchedNodes::new(&folder);
    let (on_mesh, values) = evaluated(kinds.clone());
    assert!(selects_the_top(&on_mesh, &values, 1.0));

    folder.write("lib/own", "const turned_over: f32 = ;");
    watched.refresh(&mut kinds);
    assert_eq!(kinds.faults.len(), 1, "{:?}", kinds.faults);
    let (on_mesh, values) = evaluated(kinds.clone());
    assert!(selects_the_top(&on_mesh, &values, 1.0));

    folder.write("lib/own", &library("0.0"));
    watched.refresh(&mut kinds);
    assert!(kinds.faults.is_empty(), "{:?}", kinds.faults);
    let (on_mesh, values) = evaluated(kinds.clone());
    assert!(on_mesh.owned().all(|(index, _)| values[index] == 1.0));

    folder.remove("own/facing");
    watched.refresh(&mut kinds);
    assert!(kinds.library.kind("own/facing").is_none());
}

const NUMBERED: &str = "\
//! Numbered
//! Selects one part of one material.

/// Whether this place is it.
fn mask(at: Surface) -> f32 {
    return select(0.0, 1.0, at.part == 70000u && at.material == 66001u);
}
";

#[test]
fn a_model_may_have_more_parts_and_materials_than_sixteen_bits_count() {
    let graph = r#"{ "format": "sabi", "version": 1, "nodes": { "one": { "kind": "own/numbered" } } }"#;
    let kinds = NodeFolder::new(&[("own/numbered", NUMBERED)]).kinds();
    let mut on_mesh = OnMesh::on(graph, kinds, &project("assets/meshes/cube.glb"), 64, |linked| {
        let mesh = &mut Arc::make_mut(&mut linked.model).mesh;
        mesh.triangle_part.fill(70_000);
        mesh.triangle_material.fill(66_001);
    });
    let values = on_mesh.evaluate("one").component("mask");
    assert!(on_mesh.owned().all(|(index, _)| values[index] == 1.0));
}
