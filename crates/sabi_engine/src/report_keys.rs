//! docs/report.md names exactly the keys of the JSON that Sabi writes.

mod bake_reports;
mod keys;

use std::collections::BTreeMap;
use std::path::Path;

use keys::{documented, written};
use sabi_export::preset::DocumentFormat;
use sabi_export::{Channel, ConstantRecord, DocumentRecord, DocumentedMaterial, EngineFormat, OutputRecord};

use crate::baking::preset_description::{PresetDescription, PresetDocument, PresetFileDescription};
use crate::catalog::check::{CheckReport, CheckedGraph};
use crate::catalog::description::{InputDescription, NodeDescription, OutputDescription, ParamDescription};
use crate::catalog::diagnosis::{AdapterDescription, Diagnosis};
use crate::graph_info::{
    FileDescription, GraphDescription, GraphOutput, GroupDescription, KnobDescription, VariantDescription,
};
use crate::opening::mesh_report::{DecodedUvs, MeshReport, UnwrappingReport};
use crate::opening::overlap::{MaterialOverlap, OverlapReport, SetReport};
use crate::packing::{PackReport, PackedFile, UnpackReport};

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
        preset: text(),
        channel: text(),
        components: vec![text()],
        material: text(),
        width: 1,
        height: 1,
        bits: 16,
        color_space: "linear",
        udim: Some(1001),
        range: Some([0.0, 1.0]),
        scale: Some(2.0),
        engine_format: EngineFormat::Bc7,
        engine_bytes: 1,
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
        value: sabi_export::ConstantValue::Triple([0.5; 3]),
        srgb: Some(text()),
    }
}

fn document() -> DocumentRecord {
    DocumentRecord {
        path: text(),
        preset: text(),
        format: DocumentFormat::Usda,
        materials: vec![DocumentedMaterial {
            material: text(),
            names: vec![text()],
            left_out: vec![Channel::Height],
        }],
        blake3: text(),
    }
}

#[test]
fn the_description_of_a_model_has_the_documented_keys() {
    let report = MeshReport {
        triangles: 1,
        vertices: 1,
        parts: vec![text()],
        parts_left_out: vec![text()],
        pieces: 1,
        materials: vec![text()],
        unwrapped: unwrapped(),
        decoded_uvs: decoded_uvs(),
        smooth_degrees: None,
        turned_faces: 1,
        inside_out_faces: 1,
        vertex_colors: true,
        largest_side: 1.0,
        size: 64,
        pages: 1,
        page_size: [64; 2],
        charts: 1,
        coverage: 0.5,
        overlap: overlap(),
        sets: vec![SetReport {
            udim: Some(1001),
            ..SetReport::default()
        }],
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
    assert_eq!(written(&[graph]), documented("Checked graphs"));
}

#[test]
fn the_description_of_a_graph_has_the_documented_keys() {
    let graph = GraphDescription {
        graph: text(),
        name: text(),
        about: Some(text()),
        words: vec![text()],
        version: 1,
        fit: text().into(),
        seed: 0,
        nodes: Some(1),
        knobs: vec![KnobDescription {
            name: text(),
            label: text(),
            doc: text(),
            section: Some(text()),
            to: vec![text()],
            takes: Some("length"),
            unit: Some("fit"),
            default: Some(text().into()),
            value: Some(text().into()),
            choices: Some(vec![text()]),
            range: Some([0.0, 1.0].map(Into::into)),
            soft: Some([0.0, 1.0].map(Into::into)),
        }],
        variants: vec![VariantDescription {
            name: text(),
            values: BTreeMap::from([("KNOB".to_owned(), text().into())]),
        }],
        outputs: vec![GraphOutput {
            node: text(),
            kind: text(),
            materials: Some(text()),
            name: Some(text()),
        }],
        groups: vec![GroupDescription {
            name: text(),
            label: text(),
            library: Some(text()),
        }],
        files: vec![FileDescription {
            role: "picture",
            path: text(),
            written: Some(text()),
            exists: true,
        }],
        warnings: vec![text()],
    };
    assert_eq!(written(&graph), documented("Graph"));
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

#[test]
fn the_description_of_a_preset_has_the_documented_keys() {
    let description = PresetDescription {
        name: text(),
        about: text(),
        normal_y: "+",
        names: text(),
        files: vec![PresetFileDescription {
            map: Some(text()),
            outputs: Some("masks"),
            ending: "png",
            bits: 8,
            components: vec![text()],
            color_space: "linear",
            dither: true,
            normalize: true,
            engine_format: "BC7",
            size: Some(text()),
            when: text(),
        }],
        documents: vec![PresetDocument {
            format: "usda",
            ending: "usda",
            about: "text",
        }],
        left_out: vec![text()],
    };
    assert_eq!(written(&description), documented("Presets"));
}
