//! Any mesh is unwrapped and laid out, or refused.

use sabi_surface::atlas::{Atlas, AtlasOptions, EMPTY, Owner, Udim};
use sabi_surface::model::Mesh;
use sabi_surface::pieces::Pieces;
use sabi_surface::points::SurfacePoints;
use sabi_surface::seams::seams;
use sabi_surface::unwrap::unwrap;

/// Most triangles of a mesh, and of one that is unwrapped, which takes longer.
const MOST_TRIANGLES: usize = 256;
const MOST_UNWRAPPED: usize = 64;
/// Numbers that break arithmetic.
const ODD: [f32; 16] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    1e-45,
    -0.0,
    1e20,
    -1e20,
    1e-20,
    16_777_216.0,
    1e6,
    -1e6,
    0.999_999_94,
    1.000_000_1,
];

pub fn survives(bytes: &[u8]) {
    let mesh = mesh(&mut bytes.iter().copied());
    let options = AtlasOptions {
        page_limit: 1024,
        udim: [Udim::Auto, Udim::On, Udim::Off][bytes.len() % 3],
        ..AtlasOptions::new(if bytes.len().is_multiple_of(2) { 16 } else { 32 })
    };
    is_laid_out(&mesh, &options);
    if mesh.triangles.len() > MOST_UNWRAPPED {
        return;
    }
    match unwrap(&mesh) {
        Ok(unwrapped) => {
            let inside = |uv: &[f32; 2]| uv.iter().all(|x| (0.0..=1.0).contains(x));
            assert!(unwrapped.mesh.uvs.iter().all(inside), "a corner lies beside the sheet");
            assert_eq!(unwrapped.mesh.triangles.len(), mesh.triangles.len());
            is_laid_out(&unwrapped.mesh, &options);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Builds the atlas and all that is built from it.
fn is_laid_out(mesh: &Mesh, options: &AtlasOptions) {
    let Ok(atlas) = Atlas::build(mesh, options) else {
        return;
    };
    let [width, height] = atlas.page_size;
    for (place, value) in atlas.owners.iter().enumerate().filter(|(_, value)| **value != EMPTY) {
        let (row, x) = (place as u32 / width, place as u32 % width);
        match atlas.owner(x, row % height, row / height) {
            Owner::Triangle(triangle) => assert!((triangle as usize) < mesh.triangles.len()),
            Owner::Ghost(ghost) => assert!((ghost as usize) < atlas.ghosts.len()),
            Owner::Empty => panic!("{value} is no owner"),
        }
    }
    for ghost in &atlas.ghosts {
        let numbers = ghost.target_texel.iter().chain(ghost.read_texel.iter());
        let numbers = numbers.chain(ghost.target_from_own.as_flattened());
        assert!(numbers.into_iter().all(|value| value.is_finite()), "{ghost:?}");
        let triangles = [ghost.target_triangle, ghost.read_triangle];
        assert!(
            triangles
                .iter()
                .all(|triangle| (*triangle as usize) < mesh.triangles.len())
        );
    }
    assert!(atlas.report.coverage.is_finite());
    // A level may be too small; it is no other fault.
    let _ = atlas.level(mesh, 1);
    let _ = seams(mesh, &atlas);
    let _ = Pieces::of(mesh);
    let points = SurfacePoints::spread(mesh, &atlas, mesh.area().sqrt() / 30.0);
    assert_eq!(points.point_of_texel.len(), atlas.owners.len());
    // No rays are cast: obvhs asserts in debug builds that its hierarchy is shallow, which it is not where very many triangles lie in one
    // place; others miss some of those.
}

/// A mesh of few vertices and triangles, and many copies of it beside each other.
fn mesh(bytes: &mut impl Iterator<Item = u8>) -> Mesh {
    let mut next = || usize::from(bytes.next().unwrap_or_default());
    let (vertices, triangles, copies) = (1 + next() % 64, next() % 128, 1 + next() * 16);
    let (shares_place, wild) = (next() % 4 == 0, next());
    let mut one = Mesh::default();
    for _ in 0..vertices {
        one.positions.push([0; 3].map(|_: u8| number(next(), wild)));
        one.uvs.push([0; 2].map(|_: u8| number(next(), wild >> 4)));
    }
    for _ in 0..triangles {
        let corners = [0; 3].map(|_: u8| next() % vertices);
        one.triangles.push(corners.map(|corner| corner as u32));
        let look = next() as u32;
        one.triangle_material.push(look % 3);
        one.triangle_part.push(look / 3 % 3);
    }
    let mut mesh = Mesh::default();
    for copy in 0..copies.min(MOST_TRIANGLES / triangles.max(1)).max(1) {
        let away = if shares_place { 0.0 } else { copy as f32 * 0.25 };
        let first = mesh.positions.len() as u32;
        mesh.positions
            .extend(one.positions.iter().map(|[x, y, z]| [x + away, *y, *z]));
        mesh.uvs.extend(one.uvs.iter().map(|[u, v]| [u + away, *v]));
        let moved = one.triangles.iter().map(|corners| corners.map(|corner| corner + first));
        mesh.triangles.extend(moved);
        mesh.triangle_material.extend_from_slice(&one.triangle_material);
        mesh.triangle_part.extend_from_slice(&one.triangle_part);
    }
    mesh.normals = vec![[0.0, 0.0, 1.0]; mesh.positions.len()];
    mesh.tangents = vec![[1.0, 0.0, 0.0, 1.0]; mesh.positions.len()];
    mesh.uv_set = Some(0);
    mesh
}

/// Small numbers, and odd ones where the mesh is wild.
fn number(byte: usize, wild: usize) -> f32 {
    match wild.is_multiple_of(16) && byte >= 240 {
        true => ODD[byte - 240],
        false => byte as f32 / 64.0 - 1.0,
    }
}
