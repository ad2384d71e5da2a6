use glam::{DVec2, DVec3};

use super::{ConnectedMesh, PlacedTriangle, Site, Unfolder, walk};
use crate::atlas::topology::Topology;
use crate::model::Mesh;

/// Creates a cube of side 2 around the origin, with two triangles on each side and shared corners.
fn cube() -> Mesh {
    let corner = |bits: u32| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let sides = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles: Vec<[u32; 3]> = sides
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
        .collect();
    Mesh {
        positions: (0..8).map(corner).collect(),
        normals: vec![[0.0, 0.0, 1.0]; 8],
        triangle_material: vec![0; triangles.len()],
        triangle_part: vec![0; triangles.len()],
        triangles,
        ..Mesh::default()
    }
}

/// Creates a ball of radius 1 with `4 × 4^halvings × 2` triangles: an octahedron whose triangles are repeatedly divided into four.
fn ball(halvings: u32) -> Mesh {
    let mut triangles: Vec<[DVec3; 3]> = Vec::new();
    for signs in 0..8_u32 {
        let [x, y, z] = [0, 1, 2].map(|axis| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 });
        let [a, b, c] = [DVec3::X * x, DVec3::Y * y, DVec3::Z * z];
        triangles.push(if x * y * z > 0.0 { [a, b, c] } else { [a, c, b] });
    }
    for _ in 0..halvings {
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [d, e, f] = [a + b, b + c, c + a].map(DVec3::normalize);
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    let positions: Vec<[f32; 3]> = triangles.iter().flatten().map(|at| at.as_vec3().to_array()).collect();
    let count = triangles.len() as u32;
    Mesh {
        normals: positions.clone(),
        positions,
        triangles: (0..count)
            .map(|triangle| [0, 1, 2].map(|corner| 3 * triangle + corner))
            .collect(),
        triangle_material: vec![0; count as usize],
        triangle_part: vec![0; count as usize],
        ..Mesh::default()
    }
}

/// Place of a position of the surface in the plane of a patch.
fn place_of(surface: ConnectedMesh<'_>, patch: &[PlacedTriangle], site: Site) -> DVec2 {
    let placed = patch.iter().find(|placed| placed.triangle == site.triangle).unwrap();
    placed.place_of(surface.corners(site.triangle), site.position).unwrap()
}

fn on(mesh: &Mesh, topology: &Topology, position: DVec3) -> Site {
    let surface = ConnectedMesh { mesh, topology };
    let nearest = |triangle: &u32| {
        let [a, b, c] = surface.corners(*triangle);
        let normal = surface.normal(*triangle);
        let off = normal.dot(position - a).abs();
        let edges = [(a, b), (b, c), (c, a)];
        let inside = edges.map(|(a, b)| normal.cross(b - a).dot(position - a));
        off - inside.into_iter().fold(0.0, f64::min)
    };
    let triangle = (0..mesh.triangles.len() as u32)
        .min_by(|a, b| nearest(a).total_cmp(&nearest(b)))
        .unwrap();
    Site { triangle, position }
}

#[test]
fn lengths_over_the_edges_of_a_cube_equal_those_of_the_unrolled_cube() {
    let mesh = cube();
    let topology = Topology::new(&mesh);
    let surface = ConnectedMesh {
        mesh: &mesh,
        topology: &topology,
    };
    let start = on(&mesh, &topology, DVec3::new(1.0, 0.3, 0.2));
    let mut patch = Vec::new();
    Unfolder::new(12).unfold(surface, start, DVec3::Y, 2.5, &mut patch);
    // Up the side x = 1, then over the top y = 1: 0.7 up, then 1.2 inward, and 0.3 sideways.
    let end = on(&mesh, &topology, DVec3::new(-0.2, 1.0, 0.5));
    let place = place_of(surface, &patch, end);
    assert!(
        (place.x - 1.9).abs() < 1e-9 && (place.y.abs() - 0.3).abs() < 1e-9,
        "{place}"
    );
}

#[test]
fn lengths_on_a_ball_equal_those_of_great_circles() {
    let mesh = ball(5);
    let topology = Topology::new(&mesh);
    let surface = ConnectedMesh {
        mesh: &mesh,
        topology: &topology,
    };
    let start = on(&mesh, &topology, DVec3::new(0.3, 0.8, 0.52).normalize());
    let mut patch = Vec::new();
    Unfolder::new(mesh.triangles.len()).unfold(surface, start, DVec3::X, 0.6, &mut patch);
    for placed in &patch {
        let middle = surface.corners(placed.triangle).iter().sum::<DVec3>() / 3.0;
        let place = placed.corners.iter().sum::<DVec2>() / 3.0;
        let arc = middle.normalize().angle_between(start.position);
        assert!(
            (place.length() - arc).abs() < 0.02 * arc + 2e-3,
            "{arc} {}",
            place.length()
        );
    }
    assert!(patch.len() > 600, "{}", patch.len());
}

#[test]
fn the_distance_to_the_other_side_of_a_thin_plate_goes_around_its_edge() {
    let mut mesh = cube();
    for position in &mut mesh.positions {
        position[2] *= 0.01;
    }
    let topology = Topology::new(&mesh);
    let surface = ConnectedMesh {
        mesh: &mesh,
        topology: &topology,
    };
    let start = on(&mesh, &topology, DVec3::new(0.0, 0.0, 0.01));
    let mut patch = Vec::new();
    Unfolder::new(12).unfold(surface, start, DVec3::X, 0.9, &mut patch);
    assert_eq!(patch.len(), 2, "only the side that the site is on");
}

#[test]
fn a_walk_goes_around_a_corner_and_stops_at_the_nearest_point() {
    let mesh = cube();
    let topology = Topology::new(&mesh);
    let surface = ConnectedMesh {
        mesh: &mesh,
        topology: &topology,
    };
    let start = on(&mesh, &topology, DVec3::new(1.0, 0.9, 0.1));
    let end = walk(surface, start, DVec3::new(0.7, 1.0, 0.1));
    assert!(end.position.distance(DVec3::new(0.7, 1.0, 0.1)) < 1e-9, "{end:?}");
    // In front of the middle of a side: the start is the nearest point already.
    let outside = walk(surface, start, DVec3::new(5.0, 0.9, 0.1));
    assert!(outside.position.distance(start.position) < 1e-9);
}

#[test]
fn a_walk_ends_at_a_border() {
    let mut mesh = cube();
    mesh.triangles.truncate(2);
    mesh.triangle_part.truncate(2);
    mesh.triangle_material.truncate(2);
    let topology = Topology::new(&mesh);
    let surface = ConnectedMesh {
        mesh: &mesh,
        topology: &topology,
    };
    let start = on(&mesh, &topology, DVec3::new(-1.0, 0.0, 0.3));
    let end = walk(surface, start, DVec3::new(-1.0, 4.0, 0.3));
    assert!(end.position.distance(DVec3::new(-1.0, 1.0, 0.3)) < 1e-9, "{end:?}");
}
