//! At the borders of charts, where the data jumps, pictures show the values of exported maps, right up to the border.

use std::time::Duration;

use half::f16;
use sabi_engine::baking::Seams;
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_engine::phases::NoProgress;
use sabi_export::{BorderRule, ChartBorders, STEEPER};
use sabi_gpu::{BorderGhost, BorderKind, Borders, Exported, ResultCache, ShownMaps, read_layer, read_slot};
use sabi_image::TransferCurve;
use sabi_plan::Mode as Plans;
use sabi_tests::{BakeOutput, DrawableGraph, MadeMesh, MeshFile, OnMesh, even_light, project};
use sabi_view::{Mode, Viewpoint};

use crate::agreement::{between, stored};
use crate::seen;
use crate::sharing::{SIZE, TEXELS, difference, map, square};

const SUBMISSION: Duration = Duration::from_millis(200);

/// A color by vertex, and a layer on the second chart only.
const GRAPH: &str = r##"{ "format": "sabi", "version": 1, "name": "fields", "nodes": {
    "vertex": { "kind": "source/vertex_color" },
    "second": { "kind": "surface/id", "params": { "by": "chart", "pick": "1" } },
    "base": { "kind": "source/material", "params": { "color": "#c02010", "roughness": 0.2 } },
    "coat": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "second.mask" },
        "params": { "color": "#1040d0", "roughness": 0.9, "height": 0.03 } },
    "out": { "kind": "output/material", "inputs": { "material": "coat" } },
    "out_vertex": { "kind": "output/color", "inputs": { "source": "vertex.color" }, "params": { "name": "vertex" } },
    "out_second": { "kind": "output/mask", "inputs": { "source": "second.mask" }, "params": { "name": "second" } } } }"##;

/// Two squares that share an edge, each a chart with a vertex color; borders of charts lie between texels.
fn two_squares() -> MadeMesh {
    let quads = vec![
        square(-0.9, [[0.1, 0.2], [0.4, 0.8]]),
        square(0.0, [[0.6, 0.2], [0.9, 0.8]]),
    ];
    let colors = [[0.9, 0.1, 0.2, 1.0], [0.1, 0.3, 0.8, 1.0]];
    MeshFile {
        colors: colors.into_iter().flat_map(|color| [color; 4]).collect(),
        ..MeshFile::new(quads)
    }
    .write()
}

#[test]
fn a_picture_shows_the_values_of_exported_maps_up_to_a_border_where_data_jumps() {
    let mesh = two_squares();
    let model = ModelOptions::new(mesh.path(), TEXELS);
    let baked = BakeOutput::of(GRAPH, model, Seams::Erase);
    let mut pictured = DrawableGraph::new(GRAPH, mesh.path(), TEXELS, &even_light(1.0));
    // The tolerance covers a code of 8 bits in the file, which is dithered, and a step of a half float in the picture.
    let color = map(&baked, "base_color.png", TransferCurve::Srgb);
    let apart = difference(&pictured, &color, Mode::BaseColor, sabi_color::srgb_from_linear);
    assert!(apart < 5e-3, "colors are {apart} apart");
    let roughness = map(&baked, "roughness.png", TransferCurve::Linear);
    let apart = difference(&pictured, &roughness, Mode::Roughness, |value| value);
    assert!(apart < 5e-3, "roughness is {apart} apart");
    let normals = map(&baked, "normal.png", TransferCurve::Linear);
    let apart = difference(&pictured, &normals, Mode::Normal, |value| value);
    assert!(apart < 5e-3, "normals are {apart} apart");
    pictured.show_node("vertex.color");
    let vertex = map(&baked, "vertex.png", TransferCurve::Srgb);
    let apart = difference(&pictured, &vertex, Mode::Node, sabi_color::srgb_from_linear);
    assert!(apart < 5e-3, "vertex colors are {apart} apart");
    pictured.show_node("second.mask");
    let second = map(&baked, "second.png", TransferCurve::Linear);
    let apart = difference(&pictured, &second, Mode::Node, |value| value);
    assert!(apart < 5e-3, "a node's own result is {apart} apart");
}

#[test]
fn without_borders_the_neighbor_would_show() {
    let mesh = two_squares();
    let mut pictured = DrawableGraph::new(GRAPH, mesh.path(), TEXELS, &even_light(1.0));
    let evaluated = pictured.on_mesh.evaluate("second.mask");
    let texels = stored(&evaluated.planes[0].1);
    let camera = pictured.camera(Viewpoint::FRONT, SIZE);
    let read = seen(&pictured, &camera, SIZE).map(|(_, picked)| between(&texels, &pictured.on_mesh, &picked)[0]);
    let leaking = read.filter(|value| (0.1..0.9).contains(value)).count();
    assert!(leaking > 20, "{leaking} pixels lie between the two squares");
}

/// A field that jumps at the borders of some charts and continues over others, with every plane that a material stores.
const FIELDS: &str = r##"{ "format": "sabi", "version": 1, "name": "fields", "nodes": {
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.3, "octaves": 3 } },
    "parts": { "kind": "surface/id", "params": { "by": "chart" } },
    "base": { "kind": "source/material", "params": { "color": "#7a4a30", "roughness": 0.4 } },
    "grain": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" },
        "params": { "color": "#3050a0", "roughness": 0.9, "height": 0.02 } },
    "coat": { "kind": "effect/layer", "inputs": { "base": "grain", "mask": "parts.id" },
        "params": { "color": "#30a050", "roughness": 0.1, "metallic": 1.0, "height": 0.01 } },
    "out": { "kind": "output/material", "inputs": { "material": "coat" } } } }"##;

/// The numbers of a texture's texels, as many each as it stores.
fn numbers(bytes: &[u8], is_half: bool) -> Vec<f32> {
    match is_half {
        true => bytes
            .as_chunks::<2>()
            .0
            .iter()
            .map(|half| f16::from_le_bytes(*half).to_f32())
            .collect(),
        false => bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|full| f32::from_le_bytes(*full))
            .collect(),
    }
}

#[test]
fn shown_maps_follow_the_rule_of_exported_ones_bit_by_bit() {
    let mut on_mesh = OnMesh::new(FIELDS, &project("assets/meshes/bench.glb"), 256);
    let target = on_mesh.target("coat");
    let evaluator = &mut on_mesh.evaluator;
    let plan = evaluator.plan(&[target], Plans::Bake { fuse: true }).expect("a plan");
    let mut cache = ResultCache::new(1 << 30);
    let mut run = evaluator
        .run(&plan, SUBMISSION, &NoProgress, Some(&mut cache))
        .expect("a run");
    let (gpu, surface) = (evaluator.gpu(), evaluator.surface());
    let atlas = &evaluator.linked().atlas;
    let rule = ChartBorders::of_atlas(atlas);
    assert!(rule.ghosts().len() > 1000);
    let ghosts = rule.ghosts().iter().map(|ghost| BorderGhost {
        index: ghost.index,
        step: ghost.step,
        own: ghost.own,
    });
    let borders = Borders::upload(gpu, surface, ghosts, STEEPER).expect("borders");
    let exported = Exported {
        borders: Some(&borders),
        ..Exported::default()
    };
    let changes = Exported {
        changes_results: true,
        ..exported
    };
    let result = &plan.results[0];
    let planes = result.stored.planes();
    assert!(planes.len() >= 3, "{planes:?}");
    for (plane, slot) in planes.into_iter().zip(result.slots.clone()) {
        let before = read_slot(gpu, surface, &plan, &run, slot).expect("a plane");
        let mut shown_of = |exported: Exported<'_>| {
            let shown = ShownMaps { gpu, surface, exported }.plane(&mut run, slot, plane, Some(&mut cache));
            shown.expect("a map")
        };
        let shown = shown_of(exported);
        assert_eq!(shown_of(exported), shown, "a cache keeps the copy");
        assert_eq!(
            read_slot(gpu, surface, &plan, &run, slot).expect("a plane"),
            before,
            "the result stays as it is"
        );
        let read = |texture: &_| {
            let mut bytes = Vec::new();
            for page in 0..atlas.pages {
                read_layer(gpu, texture, page, 0, &mut bytes).expect("a page");
            }
            bytes
        };
        let bytes = read(&shown);
        // Only the format of four half floats has 8 bytes a texel.
        let is_half = before.bytes().len() == 8 * before.len();
        let own = numbers(before.bytes(), is_half);
        let components = own.len() / before.len();
        let kind = BorderKind::of(plane);
        let ring = if kind.keeps_first_ring {
            BorderRule::Meet
        } else {
            BorderRule::AtJumps
        };
        let mut expected = own.clone();
        for first in (0..components).step_by(kind.together) {
            let parts = first..components.min(first + kind.together);
            rule.repeat_values(ring, components, parts, &mut expected);
        }
        let shown = numbers(&bytes, is_half);
        let changed = |ghost: &sabi_export::BorderGhost| {
            let texel = ghost.pixel as usize * components..(ghost.pixel as usize + 1) * components;
            expected[texel.clone()] != own[texel]
        };
        let changed = rule.ghosts().iter().filter(|ghost| changed(ghost)).count();
        let kept = rule.ghosts().len() - changed;
        assert!(
            changed > 50 && kept > 50,
            "{plane:?}: {changed} ghosts are changed, {kept} are kept"
        );
        // Compared as bits: texels without a chart may hold any value, even NaN.
        let differing = expected
            .iter()
            .zip(&shown)
            .filter(|(one, other)| one.to_bits() != other.to_bits())
            .count();
        assert_eq!(differing, 0, "{plane:?}");
        let changing = ShownMaps {
            gpu,
            surface,
            exported: changes,
        };
        let changed = changing.plane(&mut run, slot, plane, None).expect("a map");
        assert_eq!(changed, run.texture(slot).expect("the result"), "it is changed itself");
        assert!(read(&changed) == bytes, "{plane:?}");
    }
}
