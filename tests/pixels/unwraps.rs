//! A result depends on the surface and not on its unwrap: two unwraps of one cube give the same values at the same points.

use sabi_tests::shapes::turned_in;
use sabi_tests::{MadeMesh, MeshFile, OnMesh, Quad, extent, range};

use crate::specimens::for_each;

/// Right, up and out of each face of the cube.
const FACES: [[[f32; 3]; 3]; 6] = [
    [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
];

/// Side of a face in UV: the same in both unwraps, since reaches may be counted in texels.
const SIDE: f32 = 0.2;
const SIZE: u32 = 320;

/// A cube of one unit, its faces turned by these degrees, some mirrored.
fn cube(turns: [(f32, bool); 6]) -> Vec<Quad> {
    let face = |at: usize| {
        let [right, up, out] = FACES[at];
        let (degrees, is_mirrored) = turns[at];
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let center = [0.17 + 0.33 * (at % 3) as f32, 0.25 + 0.5 * (at / 3) as f32];
        let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
        Quad {
            corners: corners.map(|[x, y]| std::array::from_fn(|axis| 0.5 * out[axis] + x * right[axis] + y * up[axis])),
            uvs: corners.map(|[x, y]| {
                let x = if is_mirrored { -x } else { x };
                let turned = [cosine * x - sine * y, -(sine * x + cosine * y)];
                [center[0] + SIDE * turned[0], center[1] + SIDE * turned[1]]
            }),
        }
    };
    (0..6).map(face).collect()
}

/// Weights of points spread over a triangle, from edge to edge.
fn points() -> Vec<[f64; 3]> {
    let steps = 24;
    (0..=steps)
        .flat_map(|i| {
            (0..=steps - i).map(move |j| {
                let [a, b] = [i, j].map(|at| f64::from(at) / f64::from(steps));
                [a, b, 1.0 - a - b]
            })
        })
        .collect()
}

/// Results that jump, so that no two grids of texels agree, each with its reason.
const EXEMPT: [(&str, &str); 32] = [
    ("adjust/coverage", "its border is narrower than a texel"),
    ("adjust/threshold", "its border is narrower than a texel"),
    ("color/split.hue", "hues turn quickly where colors are nearly gray"),
    (
        "color/split.saturation",
        "it has a kink where another component is the least",
    ),
    (
        "filter/denoise",
        "it tells grain from detail by single texels; a closed form holds it",
    ),
    (
        "filter/distance.direction",
        "it turns at once where two sources are equally near",
    ),
    ("filter/distance.id", "it jumps where two sources are equally near"),
    (
        "filter/flow",
        "its water gathers on a coarse level, whose texels lie otherwise on another unwrap",
    ),
    (
        "filter/flow.deposit",
        "its water gathers on a coarse level, whose texels lie otherwise on another unwrap",
    ),
    ("filter/grow", "its border is as narrow as a texel"),
    (
        "filter/warp",
        "a part of a texel in the slope is a texel of the way; a ball's meridians hold it",
    ),
    ("noise/cells.id", "a map of steps"),
    ("noise/chips", "its borders are narrower than a texel, and follow rays"),
    (
        "noise/chips.height",
        "its borders are narrower than a texel, and follow rays",
    ),
    ("noise/chips.id", "a map of steps"),
    ("noise/dots.id", "a map of steps"),
    ("noise/scratches.id", "a map of steps"),
    ("noise/white", "a map of steps"),
    ("noise/white.id", "a map of steps"),
    (
        "noise/wood",
        "its years end and its pores begin within less than a texel",
    ),
    (
        "noise/wood.height",
        "its years end and its pores begin within less than a texel",
    ),
    ("relief/direction", "the cube's normals turn at its edges"),
    ("surface/bent_normal", "the cube's normals turn at its edges"),
    ("surface/bent_normal.mask", "the cube's normals turn at its edges"),
    ("surface/direction", "the cube's normals turn at its edges"),
    ("surface/normal", "the cube's normals turn at its edges"),
    ("surface/rain", "the cube's normals turn at its edges"),
    ("surface/rain.direction", "the cube's normals turn at its edges"),
    ("surface/sunlight", "the cube's normals turn at its edges"),
    ("surface/sunlight.direction", "the cube's normals turn at its edges"),
    (
        "surface/rounded_normal",
        "its slope leans to either side of the cube's edges; a closed form holds it",
    ),
    (
        "surface/rounded_normal.mask",
        "a band of a texel along the cube's edges; a closed form holds it",
    ),
];

/// Marks whose borders are about a texel wide, as thin lines and crisp disks have to be: between its texels, each grid
/// reads another way across a border. The seams' own tests hold them as strictly as any other result.
const MARKS: [&str; 2] = ["noise/dots", "noise/scratches"];
/// Results that move positions by slopes, depend on changes of slopes, rise steeply with a mean over few rays, or select
/// one of several texels. For these a fraction of a texel makes a large difference.
const CHOOSY: [&str; 7] = [
    "filter/median",
    "filter/sharpen",
    "filter/slope_blur",
    "filter/streak",
    "relief/cavity",
    "relief/edges",
    "surface/edges",
];
/// Root mean square of the difference, as a share of the range: of results in general, and of marks. The most that was
/// seen of marks is 3.5 %, of streaks.
const TOLERANCE: f64 = 0.01;
const TOLERANCE_OF_MARKS: f64 = 0.04;
/// Difference of the means of narrow results, as a share of the range.
const TOLERANCE_OF_MEANS: f64 = 0.03;

/// Distance of a point of the cube from the nearest edge of its face.
fn depth(on_mesh: &OnMesh, triangle: u32, weights: [f64; 3]) -> f64 {
    let mesh = &on_mesh.evaluator.linked().model.mesh;
    let corners = mesh.triangles[triangle as usize].map(|corner| mesh.positions[corner as usize]);
    let mut away: [f64; 3] = std::array::from_fn(|axis| {
        let parts = corners.iter().zip(weights);
        parts
            .map(|(corner, weight)| f64::from(corner[axis]) * weight)
            .sum::<f64>()
            .abs()
    });
    away.sort_by(f64::total_cmp);
    0.5 - away[1]
}

/// Differences at equal points: root mean square everywhere, and the largest more than two texels inside of the faces.
/// Over an edge of the cube a smooth function has a kink, of which no two grids of texels see the same.
fn differences([one, other]: [&OnMesh; 2], [first, second]: [&[f32]; 2]) -> [f64; 2] {
    let inside = 2.0 / f64::from(SIDE * SIZE as f32);
    let (mut squares, mut largest, mut count) = (0.0, 0.0_f64, 0.0);
    for triangle in 0..12 {
        for weights in points() {
            let difference = one.bilinear(first, triangle, weights) - other.bilinear(second, triangle, weights);
            squares += difference * difference;
            count += 1.0;
            if depth(one, triangle, weights) > inside {
                largest = largest.max(difference.abs());
            }
        }
    }
    [f64::sqrt(squares / count), largest]
}

/// Two unwraps: one along the axes of the sheet, one across them.
const TURNS: [[(f32, bool); 6]; 2] = [
    [
        (0.0, false),
        (90.0, false),
        (0.0, true),
        (180.0, false),
        (0.0, false),
        (270.0, true),
    ],
    [
        (23.0, true),
        (-41.0, false),
        (77.0, false),
        (12.0, true),
        (-65.0, false),
        (45.0, true),
    ],
];

fn two_unwraps() -> [MadeMesh; 2] {
    TURNS.map(|turns| MeshFile::new(cube(turns)).write())
}

#[test]
fn two_unwraps_give_the_same_at_the_same_points() {
    let meshes = two_unwraps();
    for_each(|specimen| {
        // The borders of patterns are a texel wide and their cells are steps: `patterns` holds them.
        if specimen.is_pattern() || EXEMPT.iter().any(|(name, _)| *name == specimen.name()) {
            return Ok(());
        }
        // A detail of about twenty texels: finer than that, no grid of texels is exact.
        let graph = specimen.coarse.replace("\"size\":0.8", "\"size\":0.3");
        let [mut one, mut other] = meshes.each_ref().map(|mesh| OnMesh::new(&graph, mesh.path(), SIZE));
        let [first, second] = [&mut one, &mut other].map(|on_mesh| on_mesh.evaluate(&specimen.target()).components());
        for ((name, first), (_, second)) in first.iter().zip(&second) {
            // A tangent-space normal is in the frame of its own chart, so unwraps may differ.
            if name.starts_with("normal") {
                continue;
            }
            let [low, high] = extent(one.owned().map(|(index, _)| first[index]));
            // What half floats round.
            let rounding = f64::from(low.abs().max(high.abs())) / 2048.0;
            if specimen.is_narrow() {
                let means = [(&one, first), (&other, second)].map(|(on_mesh, values)| on_mesh.mean(values));
                let difference = (means[0] - means[1]).abs();
                match difference > TOLERANCE_OF_MEANS * range([low, high]) + rounding {
                    true => return Err(format!("the mean of {name} differs by {difference:.5}")),
                    false => continue,
                }
            }
            let [rms, _] = differences([&one, &other], [first, second]);
            let is_mark = MARKS.iter().chain(&CHOOSY).any(|name| *name == specimen.name());
            let tolerance = if is_mark { TOLERANCE_OF_MARKS } else { TOLERANCE };
            if rms > tolerance * range([low, high]) + rounding {
                return Err(format!("{name} differs by {rms:.5}"));
            }
        }
        Ok(())
    });
}

#[test]
fn patterns_are_the_same_on_two_unwraps_but_for_their_borders() {
    let meshes = two_unwraps();
    for_each(|specimen| {
        if !specimen.is_pattern() {
            return Ok(());
        }
        let [mut one, mut other] = meshes
            .each_ref()
            .map(|mesh| OnMesh::new(&specimen.coarse, mesh.path(), SIZE));
        let [first, second] = [&mut one, &mut other].map(|on_mesh| on_mesh.evaluate(&specimen.target()).components());
        for ((name, first), (_, second)) in first.iter().zip(&second) {
            let whole = range(extent(one.owned().map(|(index, _)| first[index])));
            let (mut far, mut count) = (0, 0);
            for triangle in 0..12 {
                for weights in points() {
                    let difference = one.bilinear(first, triangle, weights) - other.bilinear(second, triangle, weights);
                    far += usize::from(difference.abs() > 0.2 * whole);
                    count += 1;
                }
            }
            // Cells are 16 texels and more; a border is read from two texels on both sides.
            if far * 20 > count {
                return Err(format!("{name} differs at {far} of {count} points"));
            }
        }
        Ok(())
    });
}

#[test]
fn smoothing_is_the_same_on_two_unwraps() {
    let graph = r#"{ "format": "sabi", "version": 1, "nodes": {
        "noise": { "kind": "noise/simplex", "params": { "size": 0.2, "octaves": 1 } },
        "smooth": { "kind": "filter/smooth", "inputs": { "source": "noise" }, "params": { "steps": 16 } } } }"#;
    let [mut one, mut other] = two_unwraps().map(|mesh| OnMesh::new(graph, mesh.path(), SIZE));
    let [first, second] = [&mut one, &mut other].map(|on_mesh| on_mesh.evaluate("smooth").component("mask"));
    let before = one.evaluate("noise").component("mask");
    let owned = || one.owned().map(|(index, _)| index);
    let removed = range(owned().map(|index| before[index] - first[index]));
    assert!(removed > 0.2, "only {removed} was smoothed away");
    let whole = range(owned().map(|index| first[index]));
    let [rms, largest] = differences([&one, &other], [&first, &second]).map(|difference| difference / whole);
    assert!(rms < 0.01 && largest < 0.01, "rms {rms}, largest {largest}");
}

#[test]
fn masks_of_rays_are_the_same_on_two_unwraps_within_their_noise() {
    // In a room and on a block. Edges take many rays, since their mask rises steeply with how much of them meets the model,
    // and start from texels twice as wide; depth takes fine texels, since it has kinks at the edges.
    for (kind, params, is_room, size) in [
        ("occlusion", r#""distance": 0.4, "rays": 256"#, true, SIZE / 2),
        (
            "edges",
            r#""width": 0.4, "softness": 1, "rays": 1024"#,
            false,
            SIZE * 3 / 2,
        ),
        ("thickness", r#""distance": 1, "rays": 128"#, false, SIZE),
    ] {
        let graph = format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{
                "rays": {{ "kind": "surface/{kind}", "params": {{ {params} }} }} }} }}"#
        );
        let meshes = TURNS.map(|turns| {
            let quads = cube(turns);
            MeshFile::new(if is_room { turned_in(quads) } else { quads }).write()
        });
        let [mut one, mut other] = meshes.each_ref().map(|mesh| OnMesh::new(&graph, mesh.path(), size));
        let [first, second] = [&mut one, &mut other].map(|on_mesh| on_mesh.evaluate("rays").component("mask"));
        let whole = range(one.owned().map(|(index, _)| first[index]));
        let [rms, _] = differences([&one, &other], [&first, &second]).map(|difference| difference / whole);
        assert!(rms < 0.01, "{kind} differs by {rms} of its range");
    }
}
