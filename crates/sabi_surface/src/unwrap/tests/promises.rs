//! Guarantees of every unwrapped mesh.

use super::shapes::*;
use crate::atlas::{Atlas, AtlasOptions, Owner};
use crate::model::{Mesh, TextureUvs};
use crate::unwrap::{GAP, UnwrapError, UnwrappedMesh, area, components, flatten, pack, unwrap, unwrap_cached};

/// The size that gaps are counted at.
const SIZE: u32 = 1024;

fn unwrapped(mesh: &Mesh, size: u32) -> (UnwrappedMesh, Atlas) {
    let found = unwrap(mesh).unwrap();
    let atlas = Atlas::build(&found.mesh, &AtlasOptions::new(size)).unwrap();
    (found, atlas)
}

fn shapes() -> [(&'static str, Mesh); 5] {
    let mut two = cube();
    join(&mut two, &ball(12), [3.0, 0.0, 0.0], 1);
    [
        ("cube", cube()),
        ("ball", ball(24)),
        ("torus", torus()),
        ("strip", strip()),
        ("two materials", two),
    ]
}

fn area_in_space(mesh: &Mesh, triangle: usize) -> f64 {
    area::area(mesh, triangle as u32)
}

/// Twice the signed area in UV; negative is not mirrored, since v grows downward.
fn turned(mesh: &Mesh, triangle: usize) -> f64 {
    let [a, b, c] = mesh.triangles[triangle].map(|vertex| mesh.uvs[vertex as usize].map(f64::from));
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[test]
fn every_triangle_with_area_has_its_share_of_the_sheet_and_is_not_mirrored() {
    for (name, mesh) in shapes() {
        let (found, atlas) = unwrapped(&mesh, SIZE);
        assert_eq!(found.mesh.triangles.len(), mesh.triangles.len());
        assert_eq!(atlas.report.mirrored_charts, 0, "{name}");
        let total: f64 = (0..mesh.triangles.len())
            .map(|triangle| area_in_space(&mesh, triangle))
            .sum();
        let on_sheet: f64 = (0..mesh.triangles.len())
            .map(|triangle| -turned(&found.mesh, triangle) / 2.0)
            .sum();
        for triangle in 0..mesh.triangles.len() {
            let area = area_in_space(&mesh, triangle);
            if area > 0.0 {
                let share = (-turned(&found.mesh, triangle) / 2.0 / on_sheet) / (area / total);
                // The solver limits the growth and shrinkage of a triangle to a factor of 4.
                assert!(
                    (0.25..4.0).contains(&share),
                    "{name}: triangle {triangle} has {share} of its share"
                );
            }
        }
        assert!(
            (0.3..1.0).contains(&on_sheet),
            "{name}: {on_sheet} of the sheet is used"
        );
        assert!((on_sheet - f64::from(found.report.coverage)).abs() < 1e-3, "{name}");
        assert!(found.report.stretch < 1.2, "{name}: {}", found.report.stretch);
    }
}

#[test]
fn no_two_triangles_overlap_and_charts_keep_their_distance() {
    for (name, mesh) in shapes() {
        let (found, atlas) = unwrapped(&mesh, SIZE);
        // A chart that overlapped itself would have been split; charts that overlap each other are counted.
        let with_texels = atlas.charts.iter().filter(|chart| chart.texels > 0).count();
        assert_eq!(with_texels, found.report.charts as usize, "{name}");
        assert_eq!(atlas.report.overlap_texels, 0, "{name}");
        assert_eq!(atlas.page_size, [SIZE, SIZE], "{name}: the layout is kept as it is");
        let chart_at = |x: i64, y: i64| {
            let [x, y] = [u32::try_from(x).ok()?, u32::try_from(y).ok()?];
            match atlas.owner(x, y, 0) {
                Owner::Triangle(triangle) => Some(atlas.triangle_chart[triangle as usize]),
                _ => None,
            }
        };
        let reach = i64::from(GAP);
        for y in 0..i64::from(SIZE) {
            for x in 0..i64::from(SIZE) {
                let Some(own) = chart_at(x, y) else { continue };
                for (dx, dy) in (0..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy))) {
                    let other = chart_at(x + dx, y + dy);
                    assert!(
                        other.is_none_or(|other| other == own),
                        "{name}: two charts near ({x}, {y})"
                    );
                }
            }
        }
    }
}

#[test]
fn vertices_are_split_with_all_their_attributes() {
    let mut mesh = torus();
    let count = mesh.positions.len();
    mesh.colors = (0..count).map(|vertex| [vertex as f32, 0.5, 0.25, 1.0]).collect();
    mesh.uvs = (0..count).map(|vertex| [vertex as f32 * 0.001, 0.5]).collect();
    mesh.uv_set = Some(1);
    mesh.texture_uvs = vec![TextureUvs {
        set: 3,
        uvs: (0..count).map(|vertex| [0.25, vertex as f32]).collect(),
        tangents: Vec::new(),
    }];
    let (found, _) = unwrapped(&mesh, SIZE);
    let new = &found.mesh;
    assert!(new.positions.len() > count && new.is_one_sheet && new.uv_set.is_none());
    assert_eq!(
        new.texture_uvs.iter().map(|other| other.set).collect::<Vec<_>>(),
        [1, 3]
    );
    let (own, other) = (new.set(1).unwrap(), new.set(3).unwrap());
    for (vertex, &source) in found.source_vertex.iter().enumerate() {
        let source = source as usize;
        assert_eq!(new.positions[vertex], mesh.positions[source]);
        assert_eq!(new.normals[vertex], mesh.normals[source]);
        assert_eq!(new.colors[vertex], mesh.colors[source]);
        assert_eq!(
            (own.0[vertex], own.1[vertex]),
            (mesh.uvs[source], mesh.tangents[source])
        );
        assert_eq!(other.0[vertex], mesh.texture_uvs[0].uvs[source]);
    }
    for (corners, old) in new.triangles.iter().zip(&mesh.triangles) {
        assert_eq!(corners.map(|vertex| found.source_vertex[vertex as usize]), *old);
    }
}

#[test]
fn one_thread_and_two_give_the_same_bytes() {
    let mut mesh = torus();
    join(&mut mesh, &ball(20), [4.0, 0.0, 0.0], 0);
    join(&mut mesh, &cube(), [8.0, 0.0, 0.0], 1);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| unwrap(&mesh).unwrap())
    };
    assert_eq!(with(1), with(2));
}

#[test]
fn copies_of_a_piece_are_flattened_once_and_have_the_same_layout() {
    let mut mesh = ball(10);
    for copy in 1..4 {
        join(&mut mesh, &ball(10), [3.0 * copy as f32, 0.1, 0.0], copy);
    }
    let mut larger = ball(10);
    larger.positions.iter_mut().flatten().for_each(|value| *value *= 2.0);
    join(&mut mesh, &larger, [0.0, 9.0, 0.0], 0);
    join(&mut mesh, &torus(), [0.0, -9.0, 0.0], 0);
    let (found, _) = unwrapped(&mesh, SIZE);
    assert_eq!(found.report.pieces, [6, 2]);
    let count = ball(10).triangles.len();
    for copy in 1..5 {
        let scale = if copy == 4 { 4.0 } else { 1.0 };
        for triangle in 0..count {
            let (first, other) = (
                turned(&found.mesh, triangle),
                turned(&found.mesh, copy * count + triangle),
            );
            // Coordinates are single precision numbers on a sheet of size 1.
            assert!(
                (first * scale - other).abs() < 1e-6,
                "triangle {triangle} of copy {copy}: {first} and {other}"
            );
        }
    }
}

#[test]
fn broken_triangles_do_not_affect_the_others() {
    let mut mesh = cube();
    let first = mesh.positions.len() as u32;
    // A line, a point, the same triangle three times, and one thinner than the precision of its positions.
    mesh.positions.extend([
        [2.0, 0.0, 0.0],
        [3.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [3.0, 1.0, 0.0],
        [3.0, 1e-12, 0.0],
    ]);
    mesh.normals.extend([[0.0, 0.0, 1.0]; 5]);
    mesh.tangents.extend([[1.0, 0.0, 0.0, 1.0]; 5]);
    let broken = [[0, 1, 2], [0, 0, 0], [0, 1, 3], [0, 1, 3], [1, 0, 3], [0, 4, 2]];
    mesh.triangles
        .extend(broken.map(|corners| corners.map(|corner| first + corner)));
    mesh.triangle_material.extend([0; 6]);
    mesh.triangle_part.extend([0; 6]);
    let (found, atlas) = unwrapped(&mesh, SIZE);
    assert_eq!(atlas.report.overlap_texels, 0);
    assert!(
        found
            .mesh
            .uvs
            .as_flattened()
            .iter()
            .all(|value| (0.0..=1.0).contains(value))
    );
    let with_area = |triangle: &usize| area_in_space(&mesh, *triangle) > 0.0;
    assert_eq!((0..mesh.triangles.len()).filter(with_area).count(), 15);
    for triangle in (0..mesh.triangles.len()).filter(with_area) {
        assert!(turned(&found.mesh, triangle) < 0.0, "triangle {triangle}");
    }
}

#[test]
fn the_reason_why_a_mesh_cannot_be_unwrapped_is_a_sentence() {
    let said = |mesh: &Mesh| unwrap(mesh).unwrap_err().to_string();
    assert!(said(&Mesh::default()).starts_with("the model has no triangles"));
    let line = mesh(vec![[0.0; 3], [1.0; 3], [2.0; 3]], vec![[0, 1, 2]]);
    assert!(said(&line).starts_with("no triangle of the model has an area"));
    let mut lost = cube();
    lost.triangles[3] = [0, 1, 99];
    assert_eq!(
        said(&lost),
        "the mesh is damaged: a triangle names vertex 99 of 24; export the model again"
    );
    let mut endless = cube();
    endless.positions[0][1] = f32::NAN;
    assert!(said(&endless).contains("a position is no number"));
}

/// So many single triangles, packed at sizes of a first and a last.
fn packed(triangles: u32, sizes: [u32; 2]) -> Result<crate::unwrap::UnwrapLayout, UnwrapError> {
    let alone = mesh(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]);
    let mut many = alone.clone();
    for at in 1..triangles {
        join(&mut many, &alone, [2.0 * at as f32, 0.0, 0.0], 0);
    }
    pack::pack(
        &many,
        &flatten::flatten(&many, &components::components(&many)).charts,
        sizes,
    )
}

#[test]
fn very_many_charts_still_fit_with_narrower_gaps() {
    let report = packed(400, [32, 1024]).unwrap().report;
    assert!(report.gap < GAP as f32 && report.coverage > 0.01, "{report:?}");
    assert_eq!(
        report.warnings,
        [
            "400 charts are too many for gaps of 4 texels at size 32; theirs are 1 wide there, so a larger size would help"
        ]
    );
}

#[test]
fn more_charts_than_fit_on_a_sheet_are_refused_with_their_number() {
    assert_eq!(
        packed(400, [32, 64]).unwrap_err().to_string(),
        "the model falls into 400 pieces that can be laid flat, and one sheet has no room for so many; join its triangles, \
         reduce it or split it in your modeling program"
    );
}

#[test]
fn a_triangle_that_shrinks_to_a_point_on_the_sheet_is_reported() {
    // The height of the last triangle is a ten millionth of its length: too thin for the solver, but not without area.
    let places = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.5, -1e-7, 0.0]];
    let thin = mesh(places, vec![[0, 1, 2], [1, 0, 3]]);
    assert!(area_in_space(&thin, 1) > 0.0);
    let found = unwrap(&thin).unwrap();
    assert_eq!(turned(&found.mesh, 1), 0.0);
    assert_eq!(
        found.report.warnings,
        ["1 triangle is too thin to have a place on the sheet"]
    );
}

#[test]
fn a_piece_that_the_solver_refuses_is_divided_into_triangles_and_reported() {
    let mut tiny = torus();
    // The inverses of these lengths are infinite.
    tiny.positions.iter_mut().flatten().for_each(|value| *value *= 1e-40);
    let found = unwrap(&tiny).unwrap();
    assert_eq!(found.report.charts as usize, tiny.triangles.len());
    let [warning] = &found.report.warnings[..] else {
        panic!("{:?}", found.report.warnings)
    };
    let told = "1 piece could not be laid flat as a whole, so each triangle there is a chart of its own: ";
    assert!(warning.len() > told.len() && warning.starts_with(told), "{warning}");
}

#[test]
fn a_sheet_is_read_back_from_disk_unchanged() {
    let folder = tempfile::tempdir().unwrap();
    let (built, from_disk) = unwrap_cached(Some(folder.path()), &torus()).unwrap();
    assert!(!from_disk);
    let (read, from_disk) = unwrap_cached(Some(folder.path()), &torus()).unwrap();
    assert!(from_disk);
    assert_eq!(built, read);
    assert_eq!(built, unwrap(&torus()).unwrap());
    let mut files = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let file = files.next().unwrap();
    std::fs::write(&file, b"sabi sheet\r\n").unwrap();
    assert_eq!(unwrap_cached(Some(folder.path()), &torus()).unwrap().0, built);
}
