//! Tests that displaced meshes stay closed, keep to the budget and follow the heights.

mod hard_edges;

use std::path::Path;

use glam::Vec3;

use super::*;
use crate::atlas::{AtlasOptions, Owner};
use crate::load::{LoadOptions, load};

fn asset(name: &str) -> (Mesh, Atlas) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../assets/meshes")
        .join(name);
    with_atlas(load(&path, &LoadOptions::default()).unwrap().mesh)
}

fn with_atlas(mesh: Mesh) -> (Mesh, Atlas) {
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(256)).unwrap();
    (mesh, atlas)
}

/// Creates triangles that each have their own vertices, material and place on the map.
fn loose(triangles: &[[[f32; 3]; 3]]) -> (Mesh, Atlas) {
    let mut mesh = Mesh::default();
    for (number, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(Vec3::from);
        let (first, u) = (3 * number as u32, 0.2 * number as f32);
        mesh.positions.extend(corners);
        mesh.normals
            .extend([(b - a).cross(c - a).normalize_or(Vec3::Y).to_array(); 3]);
        mesh.tangents.extend([[1.0, 0.0, 0.0, 1.0]; 3]);
        mesh.uvs.extend([[u, 0.1], [u + 0.15, 0.1], [u, 0.25]]);
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.triangle_material.push(0);
        mesh.triangle_part.push(0);
    }
    with_atlas(mesh)
}

fn options(edge_length: f32, triangle_budget: usize) -> DisplaceOptions {
    DisplaceOptions {
        edge_length,
        triangle_budget,
    }
}

/// A hash of the arguments as a number from 0 to 1.
fn noise(seed: &[u32]) -> f32 {
    let mix = |state: u32, part: &u32| (state ^ part).wrapping_mul(0x9e37_79b1).rotate_left(15) ^ 0x85eb_ca6b;
    let state = seed.iter().fold(1, mix).wrapping_mul(0xc2b2_ae35);
    (state >> 8) as f32 / (1 << 24) as f32
}

type Bits = [u32; 3];

fn bits(at: [f32; 3]) -> Bits {
    at.map(|value| (value + 0.0).to_bits())
}

/// Counts directed edges without an opposite edge, by the bits of their ends.
fn open_edges(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> usize {
    let edges = |is_turned: bool| {
        let mut edges: Vec<[Bits; 2]> = triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|edge| edge.map(|vertex| bits(positions[vertex as usize])))
            .filter(|[from, to]| from != to)
            .map(|[from, to]| if is_turned { [to, from] } else { [from, to] })
            .collect();
        edges.sort_unstable();
        edges
    };
    let (edges, turned) = (edges(false), edges(true));
    edges
        .iter()
        .zip(&turned)
        .filter(|(edge, turned)| edge != turned)
        .count()
}

#[test]
fn closed_meshes_stay_exactly_closed_whatever_heights_the_charts_have() {
    for (name, edge_length) in [("cube.glb", 0.07), ("sphere.glb", 0.02), ("figure.glb", 0.004)] {
        let (mesh, atlas) = asset(name);
        assert_eq!(open_edges(&mesh.positions, &mesh.triangles), 0, "{name} is closed");
        assert!(atlas.charts.len() > 1, "{name} has seams");
        let options = options(edge_length, 300_000);
        let of_chart = |chart: u32, _: [f32; 2]| Some(noise(&[chart]) * 0.1);
        let rough = |chart: u32, [x, y]: [f32; 2]| Some(noise(&[chart, x.to_bits(), y.to_bits()]) * 0.1);
        let sunk = |chart: u32, texel: [f32; 2]| rough(chart, texel).map(|height| -height);
        for made in [
            displaced(&mesh, &atlas, &options, of_chart),
            displaced(&mesh, &atlas, &options, rough),
            displaced(&mesh, &atlas, &options, sunk),
        ] {
            assert!(made.triangles.len() > 2 * mesh.triangles.len(), "{name} was cut");
            assert_eq!(open_edges(&made.positions, &made.triangles), 0, "{name}");
        }
    }
}

#[test]
fn without_heights_the_surface_does_not_move() {
    let (mesh, atlas) = asset("figure.glb");
    let made = displaced(&mesh, &atlas, &options(0.02, 300_000), |_, _| Some(0.0));
    let mut first = 0;
    for (number, corners) in mesh.triangles.iter().enumerate() {
        let parts = made.triangle_from[first..]
            .iter()
            .take_while(|&&from| from == number as u32);
        let vertex = made.triangles[first..first + parts.count()]
            .iter()
            .flatten()
            .min()
            .unwrap();
        for (corner, &original) in corners.iter().enumerate() {
            let (at, original) = (*vertex as usize + corner, original as usize);
            assert_eq!(made.positions[at], mesh.positions[original]);
            assert_eq!(made.normals[at], mesh.normals[original]);
            assert_eq!(made.uvs[at], mesh.uvs[original]);
            assert_eq!(made.texels[at], atlas.triangle_texels[number][corner]);
        }
        first += made.triangle_from[first..]
            .iter()
            .take_while(|&&from| from == number as u32)
            .count();
    }
    assert_eq!(first, made.triangles.len());
    let area_of = |positions: &[[f32; 3]], triangles: &[[u32; 3]]| {
        Mesh {
            positions: positions.to_vec(),
            triangles: triangles.to_vec(),
            ..Mesh::default()
        }
        .area()
    };
    let (was, is) = (mesh.area(), area_of(&made.positions, &made.triangles));
    assert!((was - is).abs() < 1e-5 * was);
}

#[test]
fn a_constant_height_enlarges_the_radius_of_a_sphere_by_it() {
    let (mesh, atlas) = asset("sphere.glb");
    let options = options(0.05, 100_000);
    let plain = displaced(&mesh, &atlas, &options, |_, _| Some(0.0));
    let lifted = displaced(&mesh, &atlas, &options, |_, _| Some(0.1));
    for (plain, lifted) in plain.positions.iter().zip(&lifted.positions) {
        let [plain, lifted] = [plain, lifted].map(|at| Vec3::from(*at).length());
        assert!((lifted - plain - 0.1).abs() < 2e-4, "{plain} {lifted}");
    }
}

#[test]
fn a_flat_face_rises_along_its_normal_even_beside_a_hard_edge() {
    let (mesh, atlas) = asset("cube.glb");
    let made = displaced(&mesh, &atlas, &options(0.1, 100_000), |_, _| Some(0.05));
    let half = mesh
        .positions
        .iter()
        .flatten()
        .fold(0.0, |most: f32, at| most.max(at.abs()));
    let risen = made.positions.iter().filter(|at| {
        let largest = at.map(f32::abs).into_iter().fold(0.0, f32::max);
        (largest - half - 0.05).abs() < 1e-6
    });
    assert!(
        risen.count() * 3 > made.positions.len() * 2,
        "all but the vertices on edges"
    );
}

#[test]
fn no_edge_is_longer_than_requested_unless_the_budget_is_too_small() {
    let (mesh, atlas) = asset("figure.glb");
    let longest = |made: &DisplacedMesh| {
        let edges = made.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        edges.fold(0.0, |most: f32, edge| {
            let [from, to] = edge.map(|vertex| Vec3::from(made.positions[vertex as usize]));
            most.max(from.distance(to))
        })
    };
    let flat = |_, _| Some(0.0);
    let fine = displaced(&mesh, &atlas, &options(0.02, 2_000_000), flat);
    assert!(longest(&fine) <= 0.02 && fine.note.is_none());
    for budget in [5_000, 20_000, 77_777].map(|budget| budget + mesh.triangles.len()) {
        let coarse = displaced(&mesh, &atlas, &options(1e-3, budget), flat);
        assert!(coarse.triangles.len() <= budget && coarse.triangles.len() > budget / 4);
        assert!(longest(&coarse) <= coarse.edge_length * 1.00001);
        let note = coarse.note.unwrap();
        assert_eq!(
            note,
            format!(
                "the displaced model is coarser than asked for: its edges are up to {} units long and not 0.001, since \
                 shorter ones would take more than {budget} triangles",
                coarse.edge_length
            )
        );
        let finest = displaced(&mesh, &atlas, &options(0.0, budget), flat);
        assert!(
            finest.triangles.len() <= budget && finest.note.is_none(),
            "nothing was asked for"
        );
    }
    let kept = displaced(&mesh, &atlas, &options(1e-3, 10), flat);
    assert_eq!(kept.triangles.len(), mesh.triangles.len());
    assert!(kept.note.unwrap().contains("its budget of 10 leaves none"));
}

/// A unit square of two triangles facing +Z, u along x and v against y.
fn square() -> (Mesh, Atlas) {
    with_atlas(Mesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4],
        uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        triangle_material: vec![0; 2],
        triangle_part: vec![0; 2],
        ..Mesh::default()
    })
}

/// Heights on all texels, by their place in the unit square of the only chart.
fn plane_of(atlas: &Atlas, height: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    let [x0, y0] = atlas.charts[0].texel_from_uv.map(|offset| offset as f32);
    let size = atlas.size as f32;
    let rows = (0..atlas.page_size[1]).flat_map(|y| (0..atlas.page_size[0]).map(move |x| (x, y)));
    rows.map(|(x, y)| height((x as f32 + 0.5 - x0) / size, (y as f32 + 0.5 - y0) / size))
        .collect()
}

#[test]
fn a_displaced_plane_follows_a_wave_within_the_resolution() {
    let (mesh, atlas) = square();
    let waves = 12.0f32;
    let wave = |u: f32, _: f32| 0.1 * (waves * u).sin();
    let heights = plane_of(&atlas, wave);
    let plane = HeightPlane::new(&atlas, &heights);
    assert!((texel_length(&mesh, &atlas) - 1.0 / 256.0).abs() < 1e-7);
    let made = displaced(&mesh, &atlas, &options(0.02, 100_000), |chart, texel| {
        plane.at(chart, texel)
    });
    let bend = 0.1 * waves * waves / 8.0;
    for &[x, _, z] in &made.positions {
        assert!((z - wave(x, 0.0)).abs() < bend / (256.0 * 256.0) + 1e-6);
    }
    for corners in &made.triangles {
        let [a, b, c] = corners.map(|corner| Vec3::from(made.positions[corner as usize]));
        let middle = (a + b + c) / 3.0;
        let most = bend * (0.02f32 * 0.02 + 1.0 / (256.0 * 256.0)) + 1e-6;
        assert!((middle.z - wave(middle.x, 0.0)).abs() < most);
    }
}

#[test]
fn heights_are_interpolated_and_never_read_from_another_chart() {
    let (_, atlas) = square();
    let slope = plane_of(&atlas, |u, v| 3.0 * u - v);
    let plane = HeightPlane::new(&atlas, &slope);
    let [x0, y0] = atlas.charts[0].texel_from_uv.map(|offset| offset as f32);
    for [u, v] in [[0.0, 0.0], [1.0, 1.0], [0.3131, 0.777], [0.5, 0.0]] {
        let height = plane.at(0, [u * 256.0 + x0, v * 256.0 + y0]).unwrap();
        assert!((height - (3.0 * u - v)).abs() < 1e-4, "{u} {v}: {height}");
    }
    assert_eq!(plane.at(1, [x0, y0]), None, "there is no such chart");
    assert_eq!(plane.at(0, [-5.0, 1e9]), None, "there is no such texel");
    assert_eq!(plane.at(0, [f32::NAN; 2]), None);
    let (_, atlas) = asset("cube.glb");
    let own = |chart: u32, owner: Owner| match owner {
        Owner::Empty => false,
        Owner::Triangle(triangle) => atlas.triangle_chart[triangle as usize] == chart,
        Owner::Ghost(ghost) => atlas.ghosts[ghost as usize].chart == chart,
    };
    for chart in 0..atlas.charts.len() as u32 {
        let [width, height] = atlas.page_size;
        let texels = (0..height * atlas.pages).flat_map(|row| (0..width).map(move |x| [x, row % height, row / height]));
        let heights: Vec<f32> = texels
            .map(|[x, y, page]| if own(chart, atlas.owner(x, y, page)) { 2.0 } else { 1e9 })
            .collect();
        let plane = HeightPlane::new(&atlas, &heights);
        for (triangle, corners) in atlas.triangle_texels.iter().enumerate() {
            if atlas.triangle_chart[triangle] == chart {
                assert!(corners.iter().all(|&texel| plane.at(chart, texel) == Some(2.0)));
            }
        }
    }
}

#[test]
fn heights_that_are_not_finite_count_as_zero() {
    let (mesh, atlas) = square();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let made = displaced(&mesh, &atlas, &options(0.3, 1000), |_, _| Some(bad));
        assert!(made.positions.iter().all(|at| at[2] == 0.0));
        let heights = plane_of(&atlas, |_, _| bad);
        let plane = HeightPlane::new(&atlas, &heights);
        assert_eq!(plane.at(0, atlas.triangle_texels[0][0]), Some(0.0));
    }
    let unknown = displaced(&mesh, &atlas, &options(0.3, 1000), |_, _| None);
    assert!(unknown.positions.iter().all(|at| at[2] == 0.0));
    let huge = displaced(&mesh, &atlas, &options(0.3, 1000), |_, _| Some(f32::MAX));
    assert!(huge.positions.iter().flatten().all(|value| value.is_finite()));
}

#[test]
fn sheets_that_share_an_edge_move_together_there() {
    let (bottom, top) = ([0.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let (mesh, atlas) = loose(&[
        [bottom, [1.0, 0.5, 0.1], top],
        [top, [-1.0, 0.4, 0.2], bottom],
        [bottom, [0.1, 0.6, 1.0], top],
        [bottom, top, bottom],
    ]);
    let made = displaced(&mesh, &atlas, &options(0.1, 10_000), |chart, _| {
        Some(0.1 + 0.1 * chart as f32)
    });
    let plain = displaced(&mesh, &atlas, &options(0.1, 10_000), |_, _| Some(0.0));
    assert_eq!(made.triangles, plain.triangles);
    let on_edge = |sheet: u32| {
        let mut found: Vec<(Bits, Bits)> = made
            .triangles
            .iter()
            .zip(&made.triangle_from)
            .filter(|(_, from)| **from == sheet)
            .flat_map(|(corners, _)| corners)
            .map(|&vertex| (plain.positions[vertex as usize], made.positions[vertex as usize]))
            .filter(|(was, _)| was[0] == 0.0 && was[2] == 0.0)
            .map(|(was, is)| (bits(was), bits(is)))
            .collect();
        found.sort_unstable();
        found.dedup();
        found
    };
    assert_eq!(on_edge(0).len(), 17, "sixteen parts of a sixteenth each");
    for sheet in 1..4 {
        assert_eq!(on_edge(sheet), on_edge(0), "the last has no area");
    }
}

#[test]
fn coincident_surfaces_with_opposite_normals_are_not_displaced() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let (mesh, atlas) = loose(&[corners, [corners[0], corners[2], corners[1]]]);
    let made = displaced(&mesh, &atlas, &options(0.6, 10_000), |_, _| Some(0.1));
    assert!(made.triangles.len() > 2 && made.positions.iter().all(|at| at[2] == 0.0));
}

#[test]
fn the_same_mesh_gives_the_same_bits_with_any_number_of_threads() {
    let (mesh, atlas) = asset("figure.glb");
    let make = || displaced(&mesh, &atlas, &options(0.0, 50_000), |chart, _| Some(noise(&[chart])));
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let crowd = rayon::ThreadPoolBuilder::new().num_threads(7).build().unwrap();
    assert_eq!(alone.install(make), crowd.install(make));
}

#[test]
fn an_empty_mesh_is_displaced_to_an_empty_mesh() {
    let (_, atlas) = square();
    let made = displaced(&Mesh::default(), &atlas, &DisplaceOptions::default(), |_, _| None);
    assert!(made.triangles.is_empty() && made.note.is_none());
    assert_eq!(texel_length(&Mesh::default(), &atlas), 0.0);
}
