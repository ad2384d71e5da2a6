//! docs/report.md names exactly the keys of the JSON that Sabi writes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use sabi_export::{Channel, ConstantRecord, LookChange, OutputRecord, Treatment};
use serde::Serialize;
use serde_json::Value as Json;

use crate::catalog::check::{CheckReport, CheckedGraph};
use crate::catalog::diagnosis::{AdapterDescription, Diagnosis};
use crate::opening::mesh_report::{DecodedUvs, MeshReport, UnwrappingReport};
use crate::opening::overlap::{MaterialOverlap, OverlapReport};
use crate::{
    BakeAdapter, BakeReport, BakedMesh, CopiedFileReport, InputDescription, ModelCopyReport, NodeDescription,
    OutputDescription, PackReport, PackedFile, ParamDescription, PhaseTimes, UnpackReport,
};

const DOCUMENT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/report.md"));

/// Keys in the tables of a section, such as `mesh.overlap.materials[].texels`.
fn documented(section: &str) -> BTreeSet<String> {
    let title = format!("\n## {section}\n");
    let (_, after) = DOCUMENT.split_once(&title).expect("a section of that title");
    let section = after.split("\n## ").next().expect("the text up to the next section");
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
    rows.filter_map(|row| Some(row.split_once('`')?.0.to_owned())).collect()
}

/// Keys of a document and of all objects in it.
fn written(document: &impl Serialize) -> BTreeSet<String> {
    let mut keys = BTreeSet::new();
    collect("", &serde_json::to_value(document).expect("plain data"), &mut keys);
    keys
}

fn collect(path: &str, json: &Json, keys: &mut BTreeSet<String>) {
    match json {
        Json::Object(members) => {
            for (key, value) in members {
                let path = if path.is_empty() {
                    key.clone()
                } else {
                    format!("{path}.{key}")
                };
                collect(&path, value, keys);
                keys.insert(path);
            }
        }
        Json::Array(items) => items.iter().for_each(|item| collect(&format!("{path}[]"), item, keys)),
        _ => {}
    }
}

fn text() -> String {
    "text".to_owned()
}

fn overlap() -> OverlapReport {
    OverlapReport {
        materials: vec![MaterialOverlap::default()],
        ..OverlapReport::default()
    }
}

fn unwrapped() -> Option<UnwrappingReport> {
    Some(UnwrappingReport {
        uv_set: 1,
        pieces: 2,
        distinct_pieces: 1,
        charts: 3,
        coverage: 0.5,
        stretch: 1.0,
        worst_stretch: 2.0,
        gap_texels: 4.0,
    })
}

fn output() -> OutputRecord {
    OutputRecord {
        path: text(),
        channel: Channel::Height,
        material: text(),
        width: 1,
        height: 1,
        bits: 16,
        color_space: "linear",
        udim: Some(1001),
        range: Some([0.0, 1.0]),
        blake3: text(),
    }
}

fn decoded_uvs() -> Vec<DecodedUvs> {
    vec![DecodedUvs {
        material: text(),
        scale: [1.0; 2],
        offset: [0.0; 2],
    }]
}

fn constant() -> ConstantRecord {
    ConstantRecord {
        channel: Channel::BaseColor,
        material: text(),
        udim: Some(1001),
        value: sabi_export::Value::Triple([0.5; 3]),
        srgb: Some(text()),
    }
}

#[test]
fn the_report_of_a_bake_has_the_documented_keys() {
    let file = || CopiedFileReport {
        path: text(),
        blake3: text(),
    };
    let report = BakeReport {
        sabi: "0.1.0",
        graph: text(),
        mesh: BakedMesh {
            file: text(),
            triangles: 1,
            charts: 1,
            coverage: 0.5,
            overlap: overlap(),
            unwrapped: unwrapped(),
            decoded_uvs: decoded_uvs(),
            smooth_degrees: None,
        },
        adapter: BakeAdapter {
            name: text(),
            kind: text(),
        },
        size: 64,
        nodes: 1,
        passes: 1,
        finish_passes: 1,
        fused: vec![vec![text()]],
        peak_texture_bytes: 1,
        atlas_cached: true,
        rays_cached: vec![text()],
        unwrapping_cached: Some(true),
        times: PhaseTimes::default(),
        nodes_ms: BTreeMap::from([("NODE".to_owned(), 1.0)]),
        outputs: vec![output()],
        constants: vec![constant()],
        warnings: vec![text().into()],
        model: Some(ModelCopyReport {
            copy: file(),
            files: vec![file()],
            changes: vec![LookChange {
                material: text(),
                property: text(),
                change: Treatment::Removed,
            }],
        }),
        files: vec![text()],
    };
    assert_eq!(written(&report), documented("Report of a bake"));
}

#[test]
fn the_description_of_a_model_has_the_documented_keys() {
    let report = MeshReport {
        triangles: 1,
        vertices: 1,
        parts: vec![text()],
        pieces: 1,
        materials: vec![text()],
        unwrapped: unwrapped(),
        decoded_uvs: decoded_uvs(),
        smooth_degrees: None,
        vertex_colors: true,
        largest_side: 1.0,
        size: 64,
        pages: 1,
        page_size: [64; 2],
        charts: 1,
        coverage: 0.5,
        overlap: overlap(),
        overlapping_charts: 1,
        stacked_charts: 1,
        mirrored_charts: 1,
        moved_charts: 1,
        thin_charts: 1,
        degenerate_triangles: 1,
        degenerate_uv_triangles: 1,
        nonmanifold_edges: 1,
        border_edges: 1,
        ghost_texels: 1,
        unlinked_ghosts: 1,
        warnings: vec![text().into()],
    };
    assert_eq!(written(&report), documented("Model"));
}

#[test]
fn the_description_of_a_node_has_the_documented_keys() {
    let node = NodeDescription {
        id: text(),
        version: 1,
        label: text(),
        summary: text(),
        description: text(),
        aliases: vec![text()],
        shape: Some("point"),
        inputs: vec![InputDescription {
            name: text(),
            label: text(),
            ty: text(),
            doc: text(),
            required: true,
            default: None,
        }],
        outputs: vec![OutputDescription {
            name: text(),
            label: text(),
            ty: text(),
            doc: text(),
        }],
        params: vec![ParamDescription {
            name: text(),
            label: text(),
            doc: text(),
            takes: "choice",
            default: text().into(),
            choices: Some(vec![text()]),
            range: Some([0.0, 1.0].map(Into::into)),
            soft: Some([0.0, 1.0].map(Into::into)),
            takes_mask: true,
        }],
    };
    assert_eq!(written(&[node]), documented("Nodes"));
}

#[test]
fn a_checked_graph_has_the_documented_keys() {
    let report = CheckReport {
        nodes: 1,
        passes: 1,
        errors: vec![text()],
        warnings: vec![text()],
    };
    let graph = CheckedGraph::new(Path::new("rust.sabi"), report);
    assert_eq!(written(&[graph]), documented("Graphs"));
}

#[test]
fn the_diagnosis_of_a_machine_has_the_documented_keys() {
    let adapter = AdapterDescription {
        name: text(),
        kind: text(),
        driver: text(),
        backend: text(),
    };
    let diagnosis = Diagnosis {
        sabi: "0.1.0",
        adapters: vec![adapter],
        usable: true,
        problem: Some(text()),
        cache: Some(text()),
        nodes: 1,
        faults: vec![text()],
    };
    assert_eq!(written(&diagnosis), documented("Machine"));
}

#[test]
fn a_packed_and_an_unpacked_graph_have_the_documented_keys() {
    let file = PackedFile {
        name: text(),
        bytes: 1,
        from: Some(text()),
    };
    let packed = PackReport {
        archive: text(),
        graph: text(),
        model: Some(text()),
        files: vec![file],
        missing: vec![text()],
        warnings: vec![text()],
    };
    assert_eq!(written(&packed), documented("Packed graph"));
    let unpacked = UnpackReport {
        folder: text(),
        graph: text(),
        model: Some(text()),
        files: vec![text()],
    };
    assert_eq!(written(&unpacked), documented("Unpacked graph"));
}
