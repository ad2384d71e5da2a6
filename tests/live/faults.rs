//! A faulty node is reported and does not affect the others.

use std::fs;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::time::Duration;

use sabi_engine::live::{BlockedNode, GraphFaults, LiveEvent, LiveRequest, NodeFault};
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_engine::{Live, OpenGraph};
use sabi_image::{PngData, PngOptions, encode_png};
use sabi_tests::{MeshFile, Quad, device};

use crate::window::{FULL, Window, document, graph, node, options, request};

fn fault(node: &str, sentence: &str) -> NodeFault {
    NodeFault {
        node: node.to_owned(),
        sentence: sentence.to_owned(),
    }
}

fn blocked(node: &str, by: &str) -> BlockedNode {
    BlockedNode {
        node: node.to_owned(),
        blocked_by: by.to_owned(),
    }
}

const HALF_WIRED: &str = r#"
    "blurred": { "kind": "filter/blur" },
    "sharp": { "kind": "adjust/invert", "inputs": { "source": "blurred" } },
    "clouds": { "kind": "noise/simplex" },
    "plain": { "kind": "source/material" },
    "out": { "kind": "output/material", "inputs": { "material": "plain" } }"#;

#[test]
fn a_faulty_node_does_not_affect_the_others() {
    let window = Window::new();
    let all = LiveRequest {
        thumbnails: ["blurred", "sharp", "clouds", "plain"].map(node).to_vec(),
        ..request(1, graph(HALF_WIRED))
    };
    let told = window.answer(all);
    let faults = told.faults().expect("faults");
    let sentence = "input 'source' of node 'blurred' (filter/blur) must be connected to a mask";
    assert_eq!(faults.faults, [fault("blurred", sentence)]);
    assert_eq!(faults.blocked, [blocked("sharp", "blurred")]);
    assert_eq!(told.coarse_and_full(), [true, false]);
    assert_eq!(told.pictured(), ["clouds", "plain"]);
}

#[test]
fn faults_are_reported_only_when_they_change() {
    let window = Window::new();
    let faults = |revision: u64, nodes: &str| window.answer(request(revision, graph(nodes))).faults().cloned();
    assert!(faults(1, HALF_WIRED).is_some());
    assert_eq!(faults(2, HALF_WIRED), None);
    let mended = HALF_WIRED.replace(r#""filter/blur""#, r#""filter/blur", "inputs": { "source": "clouds" }"#);
    assert_eq!(faults(3, &mended), Some(GraphFaults::default()));
}

#[test]
fn shown_results_stay_while_a_node_is_at_fault() {
    let window = Window::new();
    let wired = r#""plain": { "kind": "source/material" },
        "out": { "kind": "output/material", "inputs": { "material": "plain" } }"#;
    window.answer(request(1, graph(wired)));
    let loose = wired.replace(r#", "inputs": { "material": "plain" }"#, "");
    let told = window.answer(request(2, graph(&loose)));
    assert!(told.shown().is_empty());
    assert_eq!(told.faults().map(|faults| faults.faults.len()), Some(1));
    // Nothing is evaluated for results that exist already.
    let back = window.answer(request(3, graph(wired)));
    assert!(back.shown().is_empty() && back.evaluated().is_empty());
}

#[test]
fn a_graph_that_is_at_fault_from_the_start_still_shows_the_model() {
    let window = Window::new();
    let told = window.answer(request(1, graph(r#""out": { "kind": "output/material" }"#)));
    assert_eq!(told.coarse_and_full(), [true, false]);
}

#[test]
fn a_missing_group_file_is_reported_and_the_rest_is_evaluated() {
    let window = Window::new();
    let nodes = r#""i": { "kind": "graph/group", "group": "gone.sabi" }, "clouds": { "kind": "noise/simplex" },
        "after": { "kind": "adjust/invert", "inputs": { "source": "i.mask" } }"#;
    let told = window.answer(LiveRequest {
        thumbnails: ["i", "after", "clouds"].map(node).to_vec(),
        ..request(1, graph(nodes))
    });
    let faults = told.faults().expect("faults");
    let [fault] = faults.faults.as_slice() else {
        panic!("{faults:?}")
    };
    let begins = "node \"i\" needs the group file \"gone.sabi\", which cannot be read: ";
    assert!(fault.node == "i" && fault.sentence.starts_with(begins), "{fault:?}");
    assert_eq!(faults.blocked, [blocked("after", "i")]);
    assert_eq!(told.pictured(), ["clouds"]);
    let is_model = |event: &&sabi_engine::live::LiveEvent| matches!(event, sabi_engine::live::LiveEvent::Model { .. });
    assert_eq!(told.all.iter().filter(is_model).count(), 2);
}

/// Returns the bytes of a picture whose header is complete and whose pixels are not.
fn torn_picture() -> Vec<u8> {
    let codes: Vec<u8> = (0..64 * 64 * 3).map(|at: u32| ((at * at) >> 3) as u8).collect();
    let options = PngOptions {
        channels: 3,
        bits: 8,
        srgb_chunk: true,
    };
    let mut png = encode_png(64, 64, PngData::U8(&codes), options).expect("a picture");
    png.truncate(png.len() / 2);
    png
}

#[test]
fn a_picture_that_cannot_be_decoded_is_the_fault_of_its_node() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("torn.png"), torn_picture()).expect("a picture");
    let nodes = r##""torn": { "kind": "source/image", "params": { "file": "torn.png" } },
        "after": { "kind": "adjust/invert", "inputs": { "source": "torn.mask" } },
        "clouds": { "kind": "noise/simplex" },
        "plain": { "kind": "source/material", "params": { "color": "#112233" } },
        "out": { "kind": "output/material", "inputs": { "material": "plain" } }"##;
    let text = format!(r#"{{ "format": "sabi", "version": 1, "nodes": {{ {nodes} }} }}"#);
    let beside = |revision: u64| LiveRequest {
        graph: Arc::new(OpenGraph {
            path: folder.path().join("live.sabi"),
            ..document(&text)
        })
        .into(),
        thumbnails: ["torn", "after", "clouds"].map(node).to_vec(),
        ..request(revision, document(&text))
    };
    let window = Window::new();
    let told = window.answer(beside(1));
    assert_eq!(told.pictured(), ["clouds"]);
    let faults = told.faults().expect("faults").clone();
    assert_eq!(faults.faults.len(), 1, "{faults:?}");
    assert!(
        faults.faults[0].sentence.starts_with("node 'torn' (source/image): "),
        "{faults:?}"
    );
    assert_eq!(faults.blocked, [blocked("after", "torn")]);
    let again = window.answer(beside(2));
    assert_eq!(again.faults(), None, "it stays at fault");
    fs::remove_file(folder.path().join("torn.png")).expect("no picture");
    let gone = window.answer(beside(3));
    let sentence = &gone.faults().expect("faults").faults[0].sentence;
    assert!(sentence.contains("there is no file"), "{sentence}");
}

#[test]
fn warnings_stay_as_long_as_their_cause() {
    let sheet = MeshFile::new(vec![Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    }]);
    let sheet = sheet.write();
    let window = Window::new();
    let warnings = |revision: u64, nodes: &str| {
        let wished = LiveRequest {
            model: Arc::new(ModelOptions::new(sheet.path(), FULL)),
            thumbnails: vec![node("buried")],
            ..request(revision, graph(nodes))
        };
        let told = window.answer(wished);
        told.faults().map(|faults| faults.warnings.clone())
    };
    let rays = r#""buried": { "kind": "surface/occlusion", "params": { "rays": 2, "odd": 1 } }"#;
    let told = warnings(1, rays).expect("warnings");
    assert!(
        told.iter()
            .any(|warning| warning.sentence.starts_with("The model is open at 4 edges")),
        "{told:?}"
    );
    assert!(
        told.iter()
            .any(|warning| warning.sentence.contains("no parameter 'odd'")),
        "{told:?}"
    );
    assert_eq!(warnings(2, rays), None, "nothing is told twice");
    let told = warnings(3, "").expect("other warnings");
    assert!(
        !told.iter().any(|warning| warning.sentence.contains("open")),
        "{told:?}"
    );
}

#[test]
fn the_files_that_a_graph_depends_on_are_reported_when_they_change() {
    let folder = tempfile::tempdir().expect("a folder");
    let window = Window::new();
    let files = |revision: u64, nodes: &str| {
        let mut graph = graph(nodes);
        graph.path = folder.path().join("graph.sabi");
        let told = window.answer(request(revision, graph));
        let named = told.all.iter().find_map(|event| match event {
            sabi_engine::live::LiveEvent::Files { files, .. } => Some(files.clone()),
            _ => None,
        });
        let names = |files: std::collections::BTreeSet<std::path::PathBuf>| {
            let names = files
                .iter()
                .map(|file| file.strip_prefix(folder.path()).expect("beside the graph").to_owned());
            names.map(|name| name.display().to_string()).collect::<Vec<String>>()
        };
        named.map(names)
    };
    let image = r#""image": { "kind": "source/image", "params": { "file": "maps/rust.png" } }"#;
    assert_eq!(
        files(1, image).as_deref(),
        Some(["maps/rust.png".to_owned()].as_slice())
    );
    assert_eq!(files(2, &image.replace("\"image\":", "\"other\":")), None);
    let group = r#""wear": { "kind": "graph/group", "group": "wear.sabi" }"#;
    assert_eq!(
        files(3, group).as_deref(),
        Some(["wear.sabi".to_owned()].as_slice()),
        "it is not there"
    );
    let inner = image.replace("maps/", "");
    let text = format!(r#"{{ "format": "sabi", "version": 1, "nodes": {{ {inner} }} }}"#);
    fs::create_dir(folder.path().join("lib")).expect("a folder");
    fs::write(folder.path().join("lib/wear.sabi"), text).expect("a group file");
    let group = group.replace("wear.sabi", "lib/wear.sabi");
    let both = ["lib/rust.png", "lib/wear.sabi"].map(str::to_owned);
    assert_eq!(files(4, &group).as_deref(), Some(both.as_slice()));
}

#[test]
fn a_defect_of_the_program_ends_one_answer_and_not_the_evaluation() {
    let has_failed = AtomicBool::new(false);
    let (wake, woken) = channel();
    let live = Live::start(device(), options(), move || {
        assert!(has_failed.swap(true, Ordering::SeqCst), "as this test wants");
        // Sending fails once the test is over, which does not matter.
        let _ = wake.send(());
    });
    let answer = |revision: u64| {
        live.submit(request(revision, graph(HALF_WIRED)));
        let mut told = Vec::new();
        while !told
            .iter()
            .any(|event| matches!(event, LiveEvent::Done { revision: done } if *done == revision))
        {
            woken.recv_timeout(Duration::from_secs(120)).expect("somebody works");
            told.extend(live.take_events());
        }
        told
    };
    let broke_off = |event: &LiveEvent| matches!(event, LiveEvent::Failed { error, .. } if error.to_string().contains("failed, which is a defect of Sabi"));
    assert!(answer(1).iter().any(broke_off));
    let told = answer(2);
    assert!(!told.iter().any(broke_off));
    assert!(told.iter().any(|event| matches!(event, LiveEvent::Looks { .. })));
}

#[test]
fn warnings_about_the_model_are_for_the_requested_size() {
    // A strip that is 2.5 texels wide at the full size, and narrower at the coarse one.
    let wide = 2.5 / FULL as f32;
    let strip = MeshFile::new(vec![
        Quad {
            corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            uvs: [[0.0, 0.5], [0.5, 0.5], [0.5, 0.0], [0.0, 0.0]],
        },
        Quad {
            corners: [[2.0, 0.0, 0.0], [2.1, 0.0, 0.0], [2.1, 1.0, 0.0], [2.0, 1.0, 0.0]],
            uvs: [[0.75, 0.5], [0.75 + wide, 0.5], [0.75 + wide, 0.0], [0.75, 0.0]],
        },
    ]);
    let strip = strip.write();
    let told = |size: u32| {
        let asked = LiveRequest {
            model: Arc::new(ModelOptions::new(strip.path(), size)),
            ..request(1, graph(""))
        };
        let told = Window::new().answer(asked);
        let faults = told.all.iter().filter_map(|event| match event {
            LiveEvent::Faults { faults, .. } => Some(&faults.warnings),
            _ => None,
        });
        let sentences = faults.flatten().map(|warning| warning.sentence.clone());
        sentences
            .filter(|sentence| sentence.contains("thinner"))
            .collect::<Vec<_>>()
    };
    assert_eq!(told(FULL), Vec::<String>::new());
    let sentences = told(FULL / 2);
    assert!(
        sentences.len() == 1 && sentences[0].contains(&format!("at size {}", FULL / 2)),
        "{sentences:?}"
    );
}
