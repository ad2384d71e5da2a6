//! No node depends on seams, and no seam is visible: read from both sides, a result agrees along every seam as well as
//! neighboring texels inside a chart.

use sabi_engine::Kinds;
use sabi_surface::atlas::Ghost;
use sabi_tests::{OnMesh, extent, range};

use crate::specimens::{for_each, on_own_mesh, own_mesh, specimens};

/// Kinds whose result itself jumps at the edges of the cube, each with its reason. They are tested on the ball.
const JUMPS_ON_THE_CUBE: [(&str, &str); 10] = [
    (
        "noise/anisotropic",
        "its fibers lie in the surface, which turns at the cube's edges",
    ),
    ("surface/rain", "the cube's normals turn at its edges"),
    (
        "relief/cavity",
        "a relief has a kink over each edge of the cube, a groove less than a texel wide",
    ),
    (
        "relief/edges",
        "a relief has a kink over each edge of the cube, a ridge less than a texel wide",
    ),
    ("relief/direction", "the cube's normals turn at its edges"),
    ("surface/bent_normal", "the cube's normals turn at its edges"),
    ("surface/direction", "the cube's normals turn at its edges"),
    ("surface/normal", "the cube's normals turn at its edges"),
    ("surface/sunlight", "the cube's normals turn at its edges"),
    (
        "surface/rounded_normal",
        "its slope leans to either side of each edge of the cube",
    ),
];

/// Kinds whose result itself is discontinuous at the poles of the ball, where its seams end, each with its reason. They are
/// tested on the cube.
const BREAKS_ON_THE_BALL: [(&str, &str); 1] = [(
    "noise/ripples",
    "its stripes run along a direction, which stands upright at the poles",
)];

/// Number of places that are compared on each seam.
const SAMPLES: u32 = 16;

/// Largest and root mean square difference.
fn spread(differences: impl Iterator<Item = f64>) -> [f64; 2] {
    let (mut largest, mut sum, mut count) = (0.0_f64, 0.0, 0_u32);
    for difference in differences {
        largest = largest.max(difference.abs());
        sum += difference * difference;
        count += 1;
    }
    [largest, (sum / f64::from(count.max(1))).sqrt()]
}

/// Tests one component: along seams, and between neighbors inside of charts.
fn hold(on_mesh: &OnMesh, name: &str, values: &[f32]) -> Result<(), String> {
    let inside = spread(
        on_mesh
            .neighbors()
            .into_iter()
            .map(|(one, other)| f64::from(values[one]) - f64::from(values[other])),
    );
    let seams = on_mesh.seams();
    assert!(!seams.is_empty(), "the model has no seams");
    let along = spread(seams.iter().flat_map(|seam| {
        (0..SAMPLES).map(move |sample| {
            let along = (f64::from(sample) + 0.5) / f64::from(SAMPLES);
            let side = |side: usize| on_mesh.bilinear(values, seam.triangles[side], seam.weights(side, along));
            side(0) - side(1)
        })
    }));
    // What half floats round.
    let [low, high] = extent(on_mesh.owned().map(|(index, _)| values[index]));
    let rounding = (range([low, high]) / 1024.0).max(f64::from(low.abs().max(high.abs())) / 2048.0);
    for (what, at) in [("largest", 0), ("root mean square", 1)] {
        if along[at] > inside[at] + rounding {
            return Err(format!(
                "the {what} difference of {name} is {:.5} over seams and {:.5} between neighbors",
                along[at], inside[at]
            ));
        }
    }
    Ok(())
}

fn hold_all(on_mesh: &mut OnMesh, target: &str) -> Result<(), String> {
    let components = on_mesh.evaluate(target).components();
    components
        .iter()
        // A tangent-space normal is in the frame of its own chart, so both sides may differ.
        .filter(|(name, _)| !name.starts_with("normal"))
        .try_for_each(|(name, values)| hold(on_mesh, name, values))
}

#[test]
fn no_node_shows_the_seams_of_turned_and_mirrored_charts() {
    for_each(|specimen| {
        // Patterns begin anew on every side but the next upright one: `patterns` holds them.
        if specimen.is_pattern() || JUMPS_ON_THE_CUBE.iter().any(|(kind, _)| *kind == specimen.kind) {
            return Ok(());
        }
        hold_all(&mut on_own_mesh(&specimen.coarse, "cube", 64), &specimen.target())
    });
}

#[test]
fn no_node_shows_the_seams_of_a_ball() {
    for_each(|specimen| {
        if specimen.is_pattern() || BREAKS_ON_THE_BALL.iter().any(|(kind, _)| *kind == specimen.kind) {
            return Ok(());
        }
        hold_all(&mut on_own_mesh(&specimen.coarse, "sphere", 128), &specimen.target())
    });
}

/// Returns the cube with wrong links: each ghost has the link of another one.
fn torn(graph: &str) -> OnMesh {
    OnMesh::on(graph, Kinds::builtin(), &own_mesh("cube"), 64, |linked| {
        let ghosts = &mut linked.atlas.ghosts;
        let links: Vec<Ghost> = ghosts.clone();
        for (ghost, link) in ghosts.iter_mut().zip(links.iter().cycle().skip(101)) {
            ghost.target_triangle = link.target_triangle;
            ghost.target_texel = link.target_texel;
            ghost.read_triangle = link.read_triangle;
            ghost.read_texel = link.read_texel;
        }
    })
}

#[test]
fn links_that_lead_to_the_wrong_places_are_seen() {
    let seen = ["noise/simplex", "filter/smooth", "surface/position", "effect/layer"];
    let all = specimens();
    for specimen in all.iter().filter(|specimen| seen.contains(&specimen.kind.as_str())) {
        let held = hold_all(&mut torn(&specimen.coarse), &specimen.target());
        assert!(
            held.is_err(),
            "{} shows no seam where every one is torn",
            specimen.name()
        );
    }
}
