//! The report of a bake, and the check of a folder.

use std::collections::BTreeMap;

use sabi_export::{Channel, EngineMemory, LookChange, Treatment, UnmappedChannels};
use sabi_gpu::{AdapterChoice, CasterChoice};
use sabi_graph::Value;

use super::keys::{documented, written};
use super::{constant, decoded_uvs, document, output, overlap, text, unwrapped};
use crate::baking::made_of::{InputRecord, ModelRecipe, Recipe, SetRecipe};
use crate::baking::recorded::{Finding, FindingKind, Verification};
use crate::baking::report::{BakeAdapter, BakedMesh, Conventions, CopiedFileReport, ModelCopyReport};
use crate::baking::{BakeReport, Seams};
use crate::opening::linked_model::Overlap;
use crate::phases::PhaseTimes;
use crate::program::Build;
use sabi_export::CopyOptions;
use sabi_graph::Fit;
use sabi_surface::atlas::Udim;
use sabi_surface::load::Up;

fn build() -> Build {
    Build {
        version: text(),
        system: text(),
        blake3: Some(text()),
    }
}

fn recipe() -> Recipe {
    Recipe {
        graph: text(),
        document: Some(text()),
        model: ModelRecipe {
            file: text(),
            uv: 0,
            up: Up::Y,
            scale: 1.0,
            scene: None,
            smooth_degrees: None,
            parts: vec![text()],
            without: vec![text()],
            turn_faces: Some(true),
            textures: Some(text()),
            overlap: Overlap::Auto,
            udim: Udim::Auto,
        },
        variant: None,
        seed: None,
        set: vec![SetRecipe {
            name: text(),
            value: Value::Number(0.5),
        }],
        fit: Some(Fit::Unit),
        paint: true,
        size: 64,
        presets: vec![text()],
        names: None,
        channels: vec![text()],
        mesh_maps: vec![text()],
        material: None,
        all_maps: false,
        padding: None,
        seams: Seams::Erase,
        copy: Some(CopyOptions::default()),
        adapter: AdapterChoice::Auto,
        caster: CasterChoice::Auto,
        fuse: true,
    }
}

fn model_copy() -> ModelCopyReport {
    let file = || CopiedFileReport {
        path: text(),
        blake3: text(),
    };
    ModelCopyReport {
        copy: file(),
        files: vec![file()],
        changes: vec![LookChange {
            material: text(),
            property: text(),
            change: Treatment::Removed,
        }],
    }
}

#[test]
fn the_report_of_a_bake_has_the_documented_keys() {
    let report = BakeReport {
        version: 2,
        sabi: "0.1.0",
        build: build(),
        recipe: recipe(),
        inputs: vec![InputRecord {
            path: text(),
            bytes: Some(1),
            blake3: Some(text()),
        }],
        conventions: Conventions {
            tangents: "mikktspace",
            normal_y: BTreeMap::from([("PRESET".to_owned(), "+")]),
            primaries: "bt709",
            height: "model units",
        },
        graph: text(),
        mesh: BakedMesh {
            file: text(),
            triangles: 1,
            charts: 1,
            coverage: 0.5,
            bounds: [[0.0; 3]; 2],
            overlap: overlap(),
            unwrapped: unwrapped(),
            decoded_uvs: decoded_uvs(),
            smooth_degrees: None,
            parts_left_out: vec![text()],
            turned_faces: 1,
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
        evaluated_texels: 1,
        peak_texture_bytes: 1,
        up_to_date: false,
        atlas_cached: true,
        rays_cached: vec![text()],
        results_cached: vec![text()],
        maps_cached: vec![text()],
        unwrapping_cached: Some(true),
        times: PhaseTimes::default(),
        nodes_ms: BTreeMap::from([("NODE".to_owned(), 1.0)]),
        outputs: vec![output()],
        engine: EngineMemory::of(&[output()]),
        constants: vec![constant()],
        documents: vec![document()],
        left_out: vec![UnmappedChannels {
            preset: text(),
            material: text(),
            channels: vec![Channel::Sheen],
        }],
        warnings: vec![text().into()],
        model: Some(model_copy()),
        files: vec![text()],
    };
    assert_eq!(written(&report), documented("Report of a bake"));
}

#[test]
fn a_verified_folder_has_the_documented_keys() {
    let verification = Verification {
        folder: text(),
        bakes: 1,
        files: 1,
        findings: vec![Finding {
            kind: FindingKind::Stale,
            path: text(),
            message: text(),
        }],
        error: Some(text()),
    };
    assert_eq!(written(&[verification]), documented("Verified folders"));
}
