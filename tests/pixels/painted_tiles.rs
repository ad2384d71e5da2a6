//! Strokes that are continued: only the tiles that they change are computed again, and results are those of a fresh evaluation.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use sabi_engine::phases::NoProgress;
use sabi_engine::source::Strokes;
use sabi_gpu::{
    DEFAULT_BUDGET_BYTES, Exported, MaterialSlots, ResultCache, RunOptions, Shares, ShownMaps, TextureBudget,
    read_slot, read_texels, result_extents,
};
use sabi_nodes::kind::Channel;
use sabi_nodes::link::Plane;
use sabi_paint::{Action, Brush, PaintSurface, Step, Stroke, StrokePoint, SurfaceIndex};
use sabi_plan::{Mode, PlannedResult, SlotRef};
use sabi_surface::load::{LoadOptions, load};
use sabi_surface::patch::Site;
use sabi_tests::{OnMesh, project};
use serde_json::json;

const SUBMISSION: Duration = Duration::from_millis(200);
const GRAPH: &str = "test.sabi";
/// Bytes of the caches of results.
const CACHE: u64 = 1 << 30;

/// A painted mask over clouds, in a layer with a height.
fn graph(versions: &str, radius: f64) -> String {
    json!({ "format": "sabi", "version": 1, "nodes": {
        "clouds": { "kind": "noise/simplex" },
        "brush": { "kind": "source/paint", "params": { "strokes": versions }, "inputs": { "base": "clouds" } },
        "more": { "kind": "adjust/levels", "params": { "gamma": 1.0 + radius }, "inputs": { "source": "brush" } },
        "base": { "kind": "source/material" },
        "layer": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "more", "height_map": "brush" },
                   "params": { "height": 0.02 } },
        "soft": { "kind": "filter/blur", "inputs": { "source": "brush" } },
    } })
    .to_string()
}

/// Draws strokes on a model one place after another, as a hand does, each instead of the part before, and then takes them back; calls
/// `each` with the strokes, the versions that a node has to name, and a number, after each change.
fn draw(path: &Path, mut each: impl FnMut(&Strokes, &str, usize)) {
    let mesh = load(path, &LoadOptions::default()).expect("a model").mesh;
    let index = SurfaceIndex::new(&mesh);
    let surface = PaintSurface::new(&mesh, &index);
    let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
    let strokes = Strokes::default();
    let point = |triangle: u32| {
        let position = mesh.position(triangle, [1.0 / 3.0; 3]);
        let starts = triangle.is_multiple_of(3);
        surface
            .point(Site { triangle, position }, 1.0, starts)
            .expect("a point")
    };
    let mut number = 0;
    let mut call = |versions: &str| {
        each(&strokes, versions, number);
        number += 1;
    };
    let mut whole = vec![String::new()];
    call("");
    for (number, action) in [Action::Paint, Action::Erase, Action::Paint].into_iter().enumerate() {
        let before = whole.last().expect("a version").clone();
        let points: Vec<StrokePoint> = (0..4).map(|at| point((37 * number as u32 + 11 * at) % 400)).collect();
        let mut versions = String::new();
        for count in 1..=points.len() {
            let brush = Brush {
                radius: 0.06,
                height: 0.01,
                ..Brush::default()
            };
            let stroke = Stroke {
                action,
                ..Stroke::new(brush, points[..count].to_vec())
            };
            versions = strokes.after(Path::new(GRAPH), &stem, &before, &Step::Add(Arc::new(stroke)));
            call(&versions);
        }
        strokes.settle();
        whole.push(versions);
    }
    for versions in whole.iter().rev().skip(1).chain(&whole) {
        call(versions);
    }
}

fn slots(result: &PlannedResult) -> MaterialSlots {
    let slot = |channel: Channel| -> Option<SlotRef> {
        let at = result
            .stored
            .planes()
            .iter()
            .position(|plane| *plane == Plane::Material(channel))?;
        Some(result.slots[at])
    };
    MaterialSlots {
        color: slot(Channel::Color),
        surface: slot(Channel::Surface),
        height: slot(Channel::Height),
        ..MaterialSlots::default()
    }
}

/// Makes every seventh covered texel show the mean of itself and of a distant one, as where charts overlap.
fn shares(on_mesh: &OnMesh) -> Shares {
    let covered: Vec<u32> = on_mesh.covered().map(|index| index as u32).collect();
    let (some, others) = covered.split_at(covered.len() / 2);
    let groups: Vec<[u32; 2]> = some
        .iter()
        .zip(others)
        .step_by(7)
        .map(|(some, other)| [*some, *other])
        .collect();
    let groups = groups.iter().map(|group| [&group[..], &group[..1]]);
    Shares::upload(on_mesh.evaluator.gpu(), on_mesh.evaluator.surface(), groups).expect("shares")
}

/// Evaluates the layer. Returns its planes, its normals and the extent of its heights as bytes, and how many steps ran in part.
fn evaluated(on_mesh: &mut OnMesh, mut cache: Option<&mut ResultCache>, node: &str) -> (Vec<Vec<u8>>, usize) {
    let target = on_mesh.target(node);
    let shares = shares(on_mesh);
    let evaluator = &mut on_mesh.evaluator;
    let plan = evaluator.plan(&[target], Mode::Interactive).expect("a plan");
    let mut run = evaluator
        .run(&plan, SUBMISSION, &NoProgress, cache.as_deref_mut())
        .expect("a run");
    let (gpu, surface) = (evaluator.gpu(), evaluator.surface());
    let result = &plan.results[0];
    let read = |slot: &SlotRef| {
        read_slot(gpu, surface, &plan, &run, *slot)
            .expect("a result")
            .bytes()
            .to_vec()
    };
    let mut all: Vec<Vec<u8>> = result.slots.iter().map(read).collect();
    let options = RunOptions::new(SUBMISSION, TextureBudget::Textures(DEFAULT_BUDGET_BYTES));
    let slots = slots(result);
    if let Some(height) = slots.height {
        let extents =
            result_extents(gpu, surface, &run, &[(height, 0)], &options, cache.as_deref_mut()).expect("extents");
        all.push(format!("{extents:?}").into_bytes());
        for shares in [None, Some(&shares)] {
            let exported = Exported {
                shares,
                ..Exported::default()
            };
            let maps = ShownMaps { gpu, surface, exported }
                .material(&mut run, slots, &options, cache.as_deref_mut())
                .expect("maps");
            for map in [maps.normal, maps.color] {
                let map = read_texels(gpu, &map.expect("a map")).expect("a map");
                all.push(map.bytes().to_vec());
            }
        }
    }
    (all, run.report.steps_in_part)
}

#[test]
fn a_stroke_that_goes_on_gives_the_same_as_a_fresh_evaluation_and_computes_its_tiles_alone() {
    for model in ["crate", "barrel"] {
        let path = project(&format!("assets/meshes/{model}.glb"));
        let mut cache = ResultCache::new(CACHE);
        let mut kept = None;
        draw(&path, |strokes, versions, at| {
            let text = graph(versions, 0.0);
            let kept = kept.get_or_insert_with(|| OnMesh::painted(&text, strokes.clone(), &path, 256));
            kept.set_graph(&text);
            let (own, in_part) = evaluated(kept, Some(&mut cache), "layer");
            let mut fresh = OnMesh::painted(&text, strokes.clone(), &path, 256);
            let (expected, _) = evaluated(&mut fresh, None, "layer");
            assert!(own == expected, "{model}: step {at} differs");
            if (2..12).contains(&at) {
                assert!(in_part >= 3, "{model}: step {at}: {in_part} steps in part");
            }
        });
    }
}

#[test]
fn a_coarser_evaluation_that_misses_some_moves_of_the_brush_catches_up() {
    let path = project("assets/meshes/crate.glb");
    let mut sizes = [256, 96].map(|size| (size, ResultCache::new(CACHE), None));
    draw(&path, |strokes, versions, at| {
        let text = graph(versions, 0.0);
        for (size, cache, kept) in &mut sizes {
            if *size < 100 && !at.is_multiple_of(3) {
                continue;
            }
            let kept = kept.get_or_insert_with(|| OnMesh::painted(&text, strokes.clone(), &path, *size));
            kept.set_graph(&text);
            let (own, _) = evaluated(kept, Some(cache), "layer");
            let mut fresh = OnMesh::painted(&text, strokes.clone(), &path, *size);
            assert!(
                own == evaluated(&mut fresh, None, "layer").0,
                "{size}: step {at} differs"
            );
        }
    });
}

#[test]
fn an_evaluation_shows_the_strokes_that_it_began_with_however_far_the_brush_is_by_then() {
    let path = project("assets/meshes/crate.glb");
    let mut last = None;
    draw(&path, |strokes, versions, at| {
        if at == 3 {
            last = Some((strokes.clone(), versions.to_owned()));
        }
        let Some((strokes, versions)) = last.clone().filter(|_| at == 3) else {
            return;
        };
        let text = graph(&versions, 0.0);
        let mut on_mesh = OnMesh::painted(&text, strokes.clone(), &path, 128);
        let expected = on_mesh.evaluate("brush").bytes();
        let mut late = OnMesh::painted(&text, strokes.clone(), &path, 128);
        let plan = late
            .evaluator
            .plan(&[late.target("brush")], Mode::Interactive)
            .expect("a plan");
        for step in 0..600 {
            let brush = Brush {
                radius: 0.01 + 1e-5 * step as f32,
                ..Brush::default()
            };
            let other = Step::Add(Arc::new(Stroke::new(brush, Vec::new())));
            strokes.after(Path::new(GRAPH), "crate", "", &other);
        }
        let run = late.evaluator.run(&plan, SUBMISSION, &NoProgress, None).expect("a run");
        let slot = plan.results[0].slots[0];
        let (gpu, surface) = (late.evaluator.gpu(), late.evaluator.surface());
        let found = read_slot(gpu, surface, &plan, &run, slot).expect("a result");
        assert!(found.bytes() == expected);
    });
    assert!(last.is_some());
}

#[test]
fn a_filter_behind_a_stroke_and_a_changed_parameter_are_computed_everywhere() {
    let path = project("assets/meshes/crate.glb");
    let mut cache = ResultCache::new(CACHE);
    let mut kept = None;
    draw(&path, |strokes, versions, at| {
        let text = graph(versions, 0.1 * (at % 3) as f64);
        let kept = kept.get_or_insert_with(|| OnMesh::painted(&text, strokes.clone(), &path, 128));
        for node in ["soft", "layer"] {
            kept.set_graph(&text);
            let (own, _) = evaluated(kept, Some(&mut cache), node);
            let mut fresh = OnMesh::painted(&text, strokes.clone(), &path, 128);
            assert!(own == evaluated(&mut fresh, None, node).0, "{node}: step {at} differs");
        }
    });
}
