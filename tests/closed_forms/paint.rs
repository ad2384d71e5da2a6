//! Strokes of paint nodes, through the whole engine.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use sabi_engine::source::Strokes;
use sabi_paint::{Action, Brush, CopyOf, PaintSurface, Step, Stroke, StrokePoint, SurfaceIndex};
use sabi_surface::load::{LoadOptions, load};
use sabi_surface::patch::Site;
use sabi_tests::{MadeMesh, MeshFile, OnMesh, Quad};
use serde_json::json;

/// Path of the graph of a test; the file does not exist.
const GRAPH: &str = "test.sabi";
/// Radius of the brushes, model units.
const RADIUS: f32 = 0.2;

/// Two squares of side 1 that meet at a right angle in one edge; their charts lie apart, the second one turned by a right angle
/// where `turned`.
fn fold(turned: bool) -> MadeMesh {
    let mut uvs = [[0.95, 0.95], [0.95, 0.55], [0.55, 0.55], [0.55, 0.95]];
    if turned {
        uvs.rotate_left(1);
    }
    let quads = vec![
        Quad {
            corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            uvs: [[0.05, 0.45], [0.45, 0.45], [0.45, 0.05], [0.05, 0.05]],
        },
        Quad {
            corners: [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
            uvs,
        },
    ];
    MeshFile::new(quads).write()
}

/// The points of a stroke through places of the first square.
fn points(path: &Path, places: &[[f64; 2]]) -> Vec<StrokePoint> {
    let mesh = load(path, &LoadOptions::default()).expect("a model").mesh;
    let index = SurfaceIndex::new(&mesh);
    let surface = PaintSurface::new(&mesh, &index);
    let point = |(index, [x, y]): (usize, &[f64; 2])| {
        let position = DVec3::new(*x, *y, 0.0);
        let inside = |triangle: &u32| {
            let [a, b, c] = surface.connected().corners(*triangle);
            let normal = surface.connected().normal(*triangle);
            let edges = [(a, b), (b, c), (c, a)];
            normal.z > 0.5
                && edges
                    .iter()
                    .all(|(a, b)| normal.cross(*b - *a).dot(position - *a) >= -1e-9)
        };
        let triangle = (0..4).find(inside).expect("a triangle of the first square");
        surface
            .point(Site { triangle, position }, 1.0, index == 0)
            .expect("a point")
    };
    places.iter().enumerate().map(point).collect()
}

fn brush() -> Brush {
    Brush {
        radius: RADIUS,
        hardness: 0.0,
        ..Brush::default()
    }
}

fn stroke(points: Vec<StrokePoint>, brush: Brush, action: Action) -> Step {
    Step::Add(Arc::new(Stroke {
        action,
        ..Stroke::new(brush, points)
    }))
}

/// Strokes on a model, and the versions that a node has to name.
fn strokes(path: &Path, steps: &[Step]) -> (Strokes, String) {
    let strokes = Strokes::default();
    let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
    let graph = Path::new(GRAPH);
    let versions = steps.iter().fold(String::new(), |versions, step| {
        strokes.after(graph, &stem, &versions, step)
    });
    (strokes, versions)
}

fn graph(versions: &str, empty: f64) -> String {
    json!({ "format": "sabi", "version": 1, "fit": "metres", "nodes": {
        "paint": { "kind": "source/paint", "params": { "strokes": versions, "empty": empty } },
        "under": { "kind": "source/paint", "params": { "empty": 0.25 } },
        "over": { "kind": "source/paint", "params": { "strokes": versions }, "inputs": { "base": "under.mask" } },
    } })
    .to_string()
}

/// Distance along the fold from a place of the first square to any place.
fn along_fold(from: [f64; 2], to: DVec3) -> f64 {
    let unrolled = if to.z > 0.0 { -to.z } else { to.y };
    (to.x - from[0]).hypot(unrolled - from[1])
}

#[test]
fn a_stroke_fades_by_the_distance_along_the_surface_over_a_seam() {
    let made = fold(false);
    let from = [0.5, 0.08];
    let (strokes, versions) = strokes(
        made.path(),
        &[stroke(points(made.path(), &[from]), brush(), Action::Paint)],
    );
    let mut on_mesh = OnMesh::painted(&graph(&versions, 0.0), strokes, made.path(), 256);
    let mask = on_mesh.evaluate("paint.mask").component("mask");
    let mut sides = [0; 2];
    for index in on_mesh.covered() {
        let place = on_mesh.position(index).expect("a place");
        let expected = brush().falloff(along_fold(from, place) / f64::from(RADIUS));
        assert!(
            (f64::from(mask[index]) - expected).abs() < 1e-4,
            "{place}: {} for {expected}",
            mask[index]
        );
        sides[usize::from(place.z > 0.0)] += usize::from(expected > 0.0);
    }
    assert!(sides[0] > 500 && sides[1] > 200, "{sides:?}");
    assert!(on_mesh.warnings().is_empty());
}

#[test]
fn a_stroke_lies_at_the_same_place_on_another_unwrap_and_at_another_size() {
    let way = [[0.2, 0.5], [0.5, 0.1], [0.8, 0.4]];
    let mut shown: Vec<Vec<(DVec3, f32)>> = Vec::new();
    for (turned, size) in [(false, 256), (true, 256), (false, 512)] {
        let made = fold(turned);
        let (strokes, versions) = strokes(
            made.path(),
            &[stroke(points(made.path(), &way), brush(), Action::Paint)],
        );
        let mut on_mesh = OnMesh::painted(&graph(&versions, 0.0), strokes, made.path(), size);
        let mask = on_mesh.evaluate("paint.mask").component("mask");
        let texels = on_mesh
            .covered()
            .filter_map(|index| Some((on_mesh.position(index)?, mask[index])));
        shown.push(texels.collect());
    }
    // The nearest texel of each other layout holds nearly the same.
    let texel = 1.0 / (0.4 * 256.0);
    for other in &shown[1..] {
        let mut squares = 0.0;
        let mut compared: f64 = 0.0;
        for (place, value) in shown[0].iter().step_by(37) {
            let near = other
                .iter()
                .min_by(|a, b| a.0.distance(*place).total_cmp(&b.0.distance(*place)))
                .expect("texels");
            assert!(near.0.distance(*place) < 2.0 * texel);
            squares += f64::from(near.1 - value).powi(2);
            compared += 1.0;
        }
        let rms = (squares / compared).sqrt();
        assert!(rms < 0.02, "{rms}");
    }
}

#[test]
fn paint_lies_over_the_base_and_an_eraser_uncovers_it() {
    let made = fold(false);
    let spot = points(made.path(), &[[0.5, 0.5]]);
    let hard = Brush {
        hardness: 1.0,
        value: 0.75,
        height: 0.125,
        color: [0.5, 0.25, 0.125],
        ..brush()
    };
    let small = Brush {
        radius: 0.5 * RADIUS,
        ..hard.clone()
    };
    let steps = [
        stroke(spot.clone(), hard, Action::Paint),
        stroke(spot, small, Action::Erase),
    ];
    let (strokes, versions) = strokes(made.path(), &steps);
    let mut on_mesh = OnMesh::painted(&graph(&versions, 0.5), strokes, made.path(), 256);
    let [paint, over] = ["paint.mask", "over.mask"].map(|node| on_mesh.evaluate(node).component("mask"));
    let height = on_mesh.evaluate("paint.height").component("mask");
    let red = on_mesh.evaluate("paint.color").component("color.r");
    let mut rings = [0; 3];
    for index in on_mesh.covered() {
        let place = on_mesh.position(index).expect("a place");
        let away = along_fold([0.5, 0.5], place) / f64::from(RADIUS);
        // Not where a border is a texel wide.
        let expected = match away {
            away if away < 0.4 => [0.5, 0.25, 0.0, 0.0],
            away if away > 0.6 && away < 0.9 => [0.75, 0.75, 0.125, 0.5],
            away if away > 1.1 => [0.5, 0.25, 0.0, 0.0],
            _ => continue,
        };
        rings[usize::from(away > 0.5) + usize::from(away > 1.0)] += 1;
        let is = [paint[index], over[index], height[index], red[index]];
        for (is, expected) in is.into_iter().zip(expected) {
            assert!((is - expected).abs() < 2e-3, "{place}: {is} for {expected}");
        }
    }
    assert!(rings.iter().all(|count| *count > 200), "{rings:?}");
}

#[test]
fn the_direction_is_that_of_the_hand() {
    let made = fold(false);
    let way = points(made.path(), &[[0.2, 0.5], [0.8, 0.5]]);
    let hard = Brush {
        hardness: 1.0,
        ..brush()
    };
    let (strokes, versions) = strokes(made.path(), &[stroke(way, hard, Action::Paint)]);
    let mut on_mesh = OnMesh::painted(&graph(&versions, 0.0), strokes, made.path(), 128);
    let direction = on_mesh.evaluate("paint.direction");
    let [x, y] = ["vector.x", "vector.y"].map(|name| direction.component(name));
    let painted: Vec<usize> = on_mesh.covered().filter(|index| x[*index].abs() > 0.5).collect();
    assert!(painted.len() > 300, "{}", painted.len());
    let cover = on_mesh.evaluate("paint.mask").component("mask");
    assert!(
        painted
            .iter()
            .all(|index| (x[*index] - cover[*index]).abs() < 1e-3 && y[*index].abs() < 1e-3)
    );
}

#[test]
fn a_node_without_its_strokes_reports_this_and_gives_an_empty_result() {
    let made = fold(false);
    let known = points(made.path(), &[[0.5, 0.5]]);
    let (elsewhere, versions) = {
        let strokes = Strokes::default();
        let versions = strokes.after(Path::new(GRAPH), "barrel", "", &stroke(known, brush(), Action::Paint));
        (strokes, versions)
    };
    let folder = PathBuf::from(GRAPH).with_extension("paint");
    let cases = [
        (
            Strokes::default(),
            format!(
                "is empty: its strokes are not in {}; put that folder beside the graph again",
                folder.display()
            ),
        ),
        (
            elsewhere,
            format!(
                "is empty on '{}': it was painted on barrel",
                made.path().file_stem().unwrap().display()
            ),
        ),
    ];
    for (strokes, expected) in cases {
        let mut on_mesh = OnMesh::painted(&graph(&versions, 0.5), strokes, made.path(), 32);
        let mask = on_mesh.evaluate("paint.mask").component("mask");
        assert!(on_mesh.covered().all(|index| mask[index] == 0.5));
        assert_eq!(on_mesh.warnings(), [format!("node 'paint' (source/paint) {expected}")]);
    }
}

#[test]
fn a_stroke_that_copies_another_node_shows_that_nodes_result_where_it_was_painted() {
    let made = fold(false);
    let copy = Stroke {
        action: Action::Clone,
        copy_of: CopyOf::Input,
        ..Stroke::new(
            Brush {
                hardness: 1.0,
                ..brush()
            },
            points(made.path(), &[[0.5, 0.1]]),
        )
    };
    let (strokes, versions) = strokes(made.path(), &[Step::Add(Arc::new(copy))]);
    let with = |from: serde_json::Value| {
        let nodes = json!({
            "clouds": { "kind": "noise/simplex" },
            "paint": { "kind": "source/paint", "params": { "strokes": versions }, "inputs": from },
        });
        json!({ "format": "sabi", "version": 1, "fit": "metres", "nodes": nodes }).to_string()
    };
    let mut on_mesh = OnMesh::painted(&with(json!({ "from": "clouds" })), strokes.clone(), made.path(), 128);
    let [mask, clouds] = ["paint.mask", "clouds"].map(|port| on_mesh.evaluate(port).component("mask"));
    let mut texels = [0; 2];
    for index in on_mesh.covered() {
        let distance = along_fold([0.5, 0.1], on_mesh.position(index).expect("a place")) / f64::from(RADIUS);
        // Half floats hold colors.
        let (is_known, expected) = (
            !(0.95..1.05).contains(&distance),
            if distance < 1.0 { clouds[index] } else { 0.0 },
        );
        assert!(
            !is_known || (mask[index] - expected).abs() < 1e-3,
            "{distance}: {} for {expected}",
            mask[index]
        );
        texels[usize::from(distance < 1.0)] += usize::from(is_known);
    }
    assert!(texels.iter().all(|count| *count > 200), "{texels:?}");
    let mut alone = OnMesh::painted(&with(json!({})), strokes, made.path(), 32);
    let mask = alone.evaluate("paint.mask").component("mask");
    assert!(alone.covered().all(|index| mask[index] == 0.0));
    let said = alone.warnings();
    assert!(
        said.len() == 1 && said[0].contains("nothing is connected to From"),
        "{said:?}"
    );
}
