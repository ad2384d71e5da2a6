//! Models that are not valid solids. Rays and filters on them end, give numbers, and warn of the properties on which they cannot rely.

use glam::DVec3;
use sabi_nodes::Library;
use sabi_nodes::kind::{Kind, Role, Shape};
use sabi_tests::shapes::{PatchDivision, PatchUvs, cube, on_sheet, patch, turned_in};
use sabi_tests::{MadeMesh, MeshFile, OnMesh, Quad};
use serde_json::{Value, json};

use crate::specimens::specimens;

const OPEN: &str = "The model is open at ";
const INSIDE_OUT: &str = "The model is inside out: ";
const UNCLEAR: &str = "More than two faces meet at ";
const FLAT: &str = "The model has no inside: ";
const THROUGH: &str = "The model intersects itself at ";

/// A flat face of one unit, moved; `right` and `up` as seen from outside.
fn sheet(corner: DVec3, right: DVec3, up: DVec3, place: PatchUvs) -> Vec<Quad> {
    patch(|s, t| corner + right * s + up * t, place, PatchDivision::even(1))
}

/// A cube moved, on its own half of the sheet.
fn moved_cube(by: DVec3, half: usize) -> Vec<Quad> {
    let mut quads = cube(PatchDivision::even(1));
    for quad in &mut quads {
        quad.corners = quad
            .corners
            .map(|corner| (DVec3::from(corner.map(f64::from)) + by).as_vec3().to_array());
        quad.uvs = quad.uvs.map(|[u, v]| [0.5 * (u + half as f32), v]);
    }
    quads
}

/// Faces without area, of three kinds: a point, a line, and a corner on the line between two others.
fn faces_without_area() -> Vec<Quad> {
    let mut quads = cube(PatchDivision::even(2));
    let uvs = quads[0].uvs;
    let [a, b] = [[0.5, 0.5, 0.5], [0.5, -0.5, 0.5]];
    for corners in [[a; 4], [a, b, b, a], [a, [0.5, 0.0, 0.5], b, a]] {
        quads.push(Quad { corners, uvs });
    }
    // One with an area, and none on the sheet.
    quads.push(Quad {
        uvs: [[0.99, 0.99]; 4],
        ..quads[0]
    });
    quads
}

/// A band that runs along an eight, through itself in the middle.
fn eight() -> Vec<Quad> {
    let at = |s: f64, t: f64| {
        let turn = std::f64::consts::TAU * (s + 0.01);
        DVec3::new(turn.sin(), t, (2.0 * turn).sin())
    };
    patch(at, on_sheet(0, 1), PatchDivision::even(10))
}

/// Returns models by name, with the expected warnings.
fn models() -> Vec<(&'static str, Vec<Quad>, &'static [&'static str])> {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let corner = -0.5 * (x + y);
    let flat = sheet(corner, x, y, on_sheet(0, 4));
    let mut behind = turned_in(sheet(corner, x, y, on_sheet(1, 4)));
    let two_sided = [flat.clone(), behind.clone()].concat();
    // Its diagonal as that of the face before it: what meets there has no order.
    behind[0].corners.rotate_left(1);
    behind[0].uvs.rotate_left(1);
    let doubled = [flat.clone(), behind].concat();
    let fin = [
        flat.clone(),
        sheet(0.5 * (x - y), x, y, on_sheet(1, 4)),
        sheet(0.5 * (x - y), z, y, on_sheet(2, 4)),
    ]
    .concat();
    let crossing = [moved_cube(DVec3::ZERO, 0), moved_cube(DVec3::new(0.3, 0.4, 0.2), 1)].concat();
    let mut box_without_lid = cube(PatchDivision::even(1));
    box_without_lid.remove(2);
    vec![
        ("an open sheet", flat, &[OPEN]),
        ("a box without a lid", box_without_lid, &[OPEN]),
        ("a fin", fin, &[OPEN, UNCLEAR]),
        (
            "a cube inside out",
            turned_in(cube(PatchDivision::even(1))),
            &[INSIDE_OUT],
        ),
        ("two cubes through each other", crossing, &[]),
        ("a band through itself", eight(), &[OPEN, THROUGH]),
        ("a sheet seen from both sides", two_sided, &[FLAT]),
        ("a sheet doubled", doubled, &[FLAT, UNCLEAR]),
        ("faces without area", faces_without_area(), &[OPEN, UNCLEAR]),
    ]
}

/// Returns the graph with all lengths of its node at the upper end of their range.
fn with_far_lengths(graph: &str, kind: &Kind) -> String {
    let mut graph: Value = serde_json::from_str(graph).expect("a graph");
    for param in kind.params.iter().filter(|param| param.ty.role == Role::Length) {
        if let (Some([_, most]), 1) = (param.ty.range, param.ty.components()) {
            graph["nodes"]["node"]["params"][&param.name] = json!(most);
        }
    }
    graph.to_string()
}

#[test]
fn rays_and_filters_give_numbers_on_every_model_and_say_what_is_wrong_with_it() {
    let library = Library::builtin();
    let mut complaints = Vec::new();
    for (name, quads, expected) in models() {
        let made: MadeMesh = MeshFile::new(quads).write();
        let mut on_mesh = OnMesh::new(&specimens()[0].connected, made.path(), 32);
        for specimen in specimens() {
            let kind = library.kind(&specimen.kind).expect("a built-in kind");
            if kind.shape == Shape::Point || !specimen.is_first {
                continue;
            }
            let far = with_far_lengths(&specimen.connected, kind);
            // A length beyond the model's size reaches the whole model, so the worst models are enough.
            let is_worst = expected.contains(&UNCLEAR);
            for graph in [specimen.connected.clone()].into_iter().chain(is_worst.then_some(far)) {
                on_mesh.set_graph(&graph);
                let evaluated = on_mesh.evaluate(&specimen.target());
                for (component, values) in evaluated.components() {
                    if on_mesh.covered().any(|index| !values[index].is_finite()) {
                        complaints.push(format!(
                            "{name}: {} has a {component} that is no number",
                            specimen.name()
                        ));
                    }
                }
            }
        }
        let told = on_mesh.warnings();
        for start in [OPEN, INSIDE_OUT, UNCLEAR, FLAT] {
            let is_told = told.iter().any(|sentence| sentence.starts_with(start));
            if is_told != expected.contains(&start) {
                complaints.push(format!("{name}: whether it says '{start}…' is {is_told}: {told:?}"));
            }
        }
    }
    assert!(complaints.is_empty(), "\n{}\n", complaints.join("\n"));
}
