//! Charts that share a place on the maps are each shown with the values that are exported for them.

use std::time::Duration;

use glam::Vec2;
use sabi_engine::Kinds;
use sabi_engine::baking::Seams;
use sabi_engine::opening::linked_model::{LinkedModel, ModelOptions, Overlap};
use sabi_engine::phases::NoProgress;
use sabi_export::{NONE, SetLayout, layouts};
use sabi_gpu::{Exported, Shares, ShownMaps, read_layer, read_slot};
use sabi_image::{LinearPicture, TransferCurve, decode};
use sabi_plan::Mode as Plans;
use sabi_tests::{BakeOutput, DrawableGraph, MadeMesh, MeshFile, NodeResult, OnMesh, Quad, even_light, project};
use sabi_view::{Mode, Shot, Viewpoint};

use crate::seen;

pub(crate) const SIZE: [u32; 2] = [160, 80];
pub(crate) const TEXELS: u32 = 128;
const SUBMISSION: Duration = Duration::from_millis(200);

/// Another color and height at each place in space.
const GRAPH: &str = r##"{ "format": "sabi", "version": 1, "name": "clouds", "nodes": {
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.3, "octaves": 2 } },
    "base": { "kind": "source/material", "params": { "color": "#7a4a30", "roughness": 0.4 } },
    "coat": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" },
        "params": { "color": "#3050a0", "roughness": 0.9, "height": 0.05 } },
    "out": { "kind": "output/material", "inputs": { "material": "coat" } },
    "mask": { "kind": "output/mask", "inputs": { "source": "clouds" }, "params": { "name": "clouds" } } } }"##;

/// A square that faces the eye, `left` of the y axis or right of it, whose UVs reach from one place of the map to
/// another.
pub(crate) fn square(left: f32, [from, to]: [[f32; 2]; 2]) -> Quad {
    let right = left + 0.9;
    Quad {
        corners: [[left, 0.0, 0.0], [right, 0.0, 0.0], [right, 0.9, 0.0], [left, 0.9, 0.0]],
        uvs: [[from[0], to[1]], to, [to[0], from[1]], from],
    }
}

/// Two squares side by side, the second one mirrored, with a place on the map that both of them fill.
fn mirrored(low: f32, high: f32) -> MadeMesh {
    let first = square(-1.0, [[low, low], [high, high]]);
    let second = square(0.1, [[high, low], [low, high]]);
    MeshFile::new(vec![first, second]).write()
}

fn taken(mesh: &MadeMesh, overlap: Overlap) -> ModelOptions {
    ModelOptions {
        overlap,
        ..ModelOptions::new(mesh.path(), TEXELS)
    }
}

fn pictured(mesh: &MadeMesh, overlap: Overlap) -> DrawableGraph {
    let on_mesh = OnMesh::on_model(GRAPH, Kinds::builtin(), taken(mesh, overlap), |_| {});
    DrawableGraph::of(on_mesh, &even_light(1.0))
}

/// A map as an engine reads it at a place, texels from the upper left corner: repeating, between four pixels.
fn read(map: &LinearPicture, texel: [f32; 2]) -> glam::Vec4 {
    let at = Vec2::from(texel) - 0.5;
    let (corner, weight) = (at.floor(), at - at.floor());
    let value = |step: [i32; 2]| {
        let [x, y] = [corner.x as i32 + step[0], corner.y as i32 + step[1]].map(|at| at.rem_euclid(TEXELS as i32));
        glam::Vec4::from(map.rgba[(y as u32 * TEXELS + x as u32) as usize])
    };
    let top = value([0, 0]).lerp(value([1, 0]), weight.x);
    let bottom = value([0, 1]).lerp(value([1, 1]), weight.x);
    top.lerp(bottom, weight.y)
}

/// Largest difference between a mode of the picture and the values that an engine reads from a map, in parts of the
/// range 0 to 1, at all pixels of the model, up to its very border.
pub(crate) fn difference(
    pictured: &DrawableGraph,
    map: &LinearPicture,
    mode: Mode,
    encode: impl Fn(f32) -> f32,
) -> f32 {
    let camera = pictured.camera(Viewpoint::FRONT, SIZE);
    let shot = Shot {
        mode,
        ..Shot::new(camera)
    };
    let shown = pictured.light(&shot, SIZE);
    let (mut most, mut compared) = (0.0_f32, [0, 0]);
    for (pixel, picked) in seen(pictured, &camera, SIZE) {
        let expected = read(map, picked.map_texel).to_array();
        for (shown, expected) in shown[pixel].iter().zip(expected).take(3) {
            most = most.max((shown - encode(expected)).abs());
        }
        compared[picked.chart as usize] += 1;
    }
    assert!(
        compared.iter().all(|count| *count > 1000),
        "{compared:?} pixels were compared"
    );
    most
}

pub(crate) fn map(baked: &BakeOutput, name: &str, curve: TransferCurve) -> LinearPicture {
    decode(name, &baked.map(name)).expect("a map").linear_rgba(curve)
}

#[test]
fn charts_that_share_a_place_are_shown_as_the_exported_map_has_it() {
    let mesh = mirrored(0.25, 0.75);
    for overlap in [Overlap::First, Overlap::Merge] {
        let baked = BakeOutput::of(GRAPH, taken(&mesh, overlap), Seams::Erase);
        let mut pictured = pictured(&mesh, overlap);
        // The tolerance covers a code of 8 bits in the file, which is dithered, and a step of a half float in the
        // picture.
        let color = map(&baked, "base_color.png", TransferCurve::Srgb);
        let apart = difference(&pictured, &color, Mode::BaseColor, sabi_color::srgb_from_linear);
        assert!(apart < 5e-3, "{overlap:?}: colors are {apart} apart");
        let roughness = map(&baked, "roughness.png", TransferCurve::Linear);
        let apart = difference(&pictured, &roughness, Mode::Roughness, |value| value);
        assert!(apart < 5e-3, "{overlap:?}: roughness is {apart} apart");
        let normals = map(&baked, "normal.png", TransferCurve::Linear);
        let apart = difference(&pictured, &normals, Mode::Normal, |value| value);
        assert!(apart < 2e-3, "{overlap:?}: normals are {apart} apart");
        pictured.show_node("clouds");
        let clouds = map(&baked, "clouds.png", TransferCurve::Linear);
        let apart = difference(&pictured, &clouds, Mode::Node, |value| value);
        assert!(apart < 5e-3, "{overlap:?}: a node's own result is {apart} apart");
    }
}

#[test]
fn both_halves_look_alike_even_at_the_border_of_the_map() {
    // With 0 to 1 the squares fill the map, so that it has no values beyond them.
    for [low, high] in [[0.25, 0.75], [0.0, 1.0]] {
        let mesh = mirrored(low, high);
        let pictured = pictured(&mesh, Overlap::First);
        let camera = pictured.camera(Viewpoint::FRONT, SIZE);
        for mode in [Mode::BaseColor, Mode::Normal, Mode::Height] {
            let shot = Shot {
                mode,
                ..Shot::new(camera)
            };
            let [width, height] = SIZE.map(|side| side as usize);
            let shown = pictured.light(&shot, SIZE);
            let mut range = [f32::INFINITY, f32::NEG_INFINITY];
            let mut most = 0.0_f32;
            for pixel in 0..width * height {
                let (x, y) = (pixel % width, pixel / width);
                let [here, there] = [shown[pixel], shown[y * width + width - 1 - x]];
                range = [range[0].min(here[0]), range[1].max(here[0])];
                most = here.iter().zip(there).map(|(a, b)| (a - b).abs()).fold(most, f32::max);
            }
            assert!(range[1] - range[0] > 0.1, "{mode:?} shows nothing");
            assert!(most < 2e-3, "{mode:?} at {low}: halves are {most} apart");
        }
    }
}

#[test]
fn shown_maps_are_copies_and_results_stay_unchanged() {
    let mesh = mirrored(0.25, 0.75);
    let mut on_mesh = OnMesh::on_model(GRAPH, Kinds::builtin(), taken(&mesh, Overlap::Merge), |_| {});
    let target = on_mesh.target("coat");
    let evaluator = &mut on_mesh.evaluator;
    let plan = evaluator.plan(&[target], Plans::Bake { fuse: true });
    let plan = plan.expect("a plan");
    let mut run = evaluator.run(&plan, SUBMISSION, &NoProgress, None).expect("a run");
    let (gpu, surface) = (evaluator.gpu(), evaluator.surface());
    let shares = Shares::upload(gpu, evaluator.surface(), evaluator.linked().shared_texels().groups()).expect("shares");
    // The planes include one of each format that planes have.
    let exported = Exported {
        shares: Some(&shares),
        ..Exported::default()
    };
    let planes = plan.results[0].stored.planes().into_iter();
    for (plane, slot) in planes.zip(plan.results[0].slots.clone()) {
        let before = read_slot(gpu, surface, &plan, &run, slot).expect("a plane");
        let sharing = ShownMaps { gpu, surface, exported };
        let shown = sharing.plane(&mut run, slot, plane, None).expect("a copy");
        let after = read_slot(gpu, surface, &plan, &run, slot).expect("a plane");
        assert_eq!(before, after);
        let mut bytes = Vec::new();
        read_layer(gpu, &shown, 0, 0, &mut bytes).expect("a layer");
        assert_ne!(bytes, after.bytes()[..bytes.len()]);
        let plain = ShownMaps {
            exported: Exported::default(),
            ..sharing
        };
        let same = plain.plane(&mut run, slot, plane, None).expect("the texture");
        assert_eq!(
            same,
            run.texture(slot).expect("the texture"),
            "nothing is copied where nothing is shared"
        );
    }
}

#[test]
fn models_whose_charts_have_places_of_their_own_share_nothing() {
    for mesh in ["bench", "cube"] {
        let mesh = project(&format!("assets/meshes/{mesh}.glb"));
        for overlap in [Overlap::First, Overlap::Merge] {
            let model = ModelOptions {
                overlap,
                ..ModelOptions::new(&mesh, 64)
            };
            let linked = LinkedModel::open(&model, &NoProgress).expect("a model");
            assert!(linked.shared_texels().is_empty(), "{}", mesh.display());
        }
    }
}

/// A graph of point nodes, one with rays, and one whose clouds a filter and a survey read.
const READERS: &str = r##"{ "format": "sabi", "version": 1, "name": "readers", "nodes": {
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.3, "octaves": 2 } },
    "base": { "kind": "source/material", "params": { "color": "#7a4a30", "roughness": 0.4 } },
    "coat": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" },
        "params": { "color": "#3050a0", "roughness": 0.9, "height": 0.05 } },
    "shade": { "kind": "surface/occlusion", "params": { "distance": 0.05, "rays": 4 } },
    "dirt": { "kind": "effect/layer", "inputs": { "base": "coat", "mask": "shade" }, "params": { "height": 0.01 } },
    "soft": { "kind": "filter/blur", "inputs": { "source": "clouds" }, "params": { "radius": 0.05 } },
    "half": { "kind": "adjust/coverage", "inputs": { "source": "soft" }, "params": { "amount": 0.5 } },
    "out": { "kind": "output/material", "inputs": { "material": "dirt" } } } }"##;

/// Three boxes side by side, each side of which fills the map.
fn stacked_boxes() -> MadeMesh {
    let mut quads = Vec::new();
    for left in [0.0, 2.0, 4.0] {
        for axis in 0..3_usize {
            for side in [0.0, 1.0_f32] {
                // Counter-clockwise seen from outside.
                let turns = if side == 1.0 {
                    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
                } else {
                    [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]
                };
                let corner = |[along, across]: [f32; 2]| {
                    let mut at = [0.0; 3];
                    at[axis] = side;
                    at[(axis + 1) % 3] = along;
                    at[(axis + 2) % 3] = across;
                    [at[0] + left, at[1], at[2]]
                };
                quads.push(Quad {
                    corners: turns.map(corner),
                    uvs: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
                });
            }
        }
    }
    MeshFile::new(quads).write()
}

/// The numbers of a result, and of normals, at the texels that the maps take, as bits.
fn exported(on_mesh: &OnMesh, result: &NodeResult, overlap: Overlap) -> Vec<u32> {
    let atlas = &on_mesh.evaluator.linked().atlas;
    let mut bits = Vec::new();
    for layout in layouts(atlas) {
        let layout = if overlap == Overlap::Merge {
            SetLayout::merged(atlas, layout.key)
        } else {
            layout
        };
        let pixels = (0..layout.source.len()).filter(|pixel| layout.source[*pixel] != NONE);
        let texels: Vec<usize> = pixels.flat_map(|pixel| layout.sources(pixel)).collect();
        for plane in result.planes.iter().map(|(_, plane)| plane).chain(&result.normals) {
            bits.extend(texels.iter().flat_map(|texel| plane.texel(*texel).map(f32::to_bits)));
        }
    }
    bits
}

#[test]
fn only_the_exported_one_of_stacked_charts_is_evaluated_with_the_same_values() {
    // Least factor by which fewer texels are evaluated if only shown charts are. Occlusion also needs the texels on the
    // other side of seams.
    let cases = [("coat", 12), ("dirt", 2), ("soft", 1), ("half", 1)];
    for mesh in [stacked_boxes(), mirrored(0.25, 0.75), mirrored(0.0, 1.0)] {
        for overlap in [Overlap::First, Overlap::Merge] {
            for (node, spared) in cases {
                let evaluate = |alone: bool| {
                    let mut on_mesh = OnMesh::on_model(READERS, Kinds::builtin(), taken(&mesh, overlap), |_| {});
                    if alone {
                        on_mesh.evaluator.evaluate_shown_alone();
                    }
                    let result = on_mesh.evaluate(node);
                    (
                        result.report.texels,
                        exported(&on_mesh, &result, overlap),
                        on_mesh.evaluator.linked().atlas.charts.len(),
                    )
                };
                let [(whole, expected, charts), (alone, values, _)] = [false, true].map(evaluate);
                assert!(expected == values, "{node}, {overlap:?}: other values are exported");
                assert!(alone <= whole);
                if overlap == Overlap::First && charts == 18 {
                    assert!(
                        alone * spared <= whole,
                        "{node}: {alone} of {whole} texels are evaluated"
                    );
                }
            }
        }
    }
}
