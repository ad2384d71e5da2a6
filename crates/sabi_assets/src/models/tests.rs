//! The models are what an artist would call clean, and the committed files are these models.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::charted_mesh::{ModelPart, Triangle, place_key};
use super::glb::{Model, encode, index};
use super::pack::{GAP_PX, SHEET_PX, pack};
use super::{MAKERS, figure};

/// Made once: the figure takes a while.
static MODELS: LazyLock<Vec<Model>> = LazyLock::new(|| MAKERS.iter().map(|(_, make)| make()).collect());
/// No file takes more, but the figure, whose charts are fine.
const MOST_BYTES: usize = 400 * 1024;

fn triangles(model: &Model) -> impl Iterator<Item = &Triangle> {
    model.parts.iter().flat_map(|part| &part.shape.triangles)
}

/// Twice the signed area on the sheet, in square meters.
fn sheet_cross(triangle: &Triangle) -> f64 {
    let [a, b, c] = triangle.corners.map(|corner| corner.sheet);
    (b - a).perp_dot(c - a)
}

/// Texels a meter of every triangle with its area, on the sheet's own scale, ascending.
fn densities(model: &Model) -> Vec<(f64, f64)> {
    let mut all: Vec<(f64, f64)> = triangles(model)
        .map(|triangle| (triangle.cross().length(), sheet_cross(triangle).abs()))
        .map(|(area, sheet)| ((sheet / area).sqrt(), area))
        .collect();
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    all
}

/// The density below which a share of the area lies.
fn density_at(densities: &[(f64, f64)], share: f64) -> f64 {
    let total: f64 = densities.iter().map(|(_, area)| area).sum();
    let mut sum = 0.0;
    for (density, area) in densities {
        sum += area;
        if sum >= total * share {
            return *density;
        }
    }
    f64::INFINITY
}

#[test]
fn the_committed_models_are_what_the_code_writes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes");
    let mut total = 0;
    for model in &*MODELS {
        let file = folder.join(format!("{}.glb", model.name));
        let committed = fs::read(&file).unwrap_or_default();
        let written = encode(model);
        total += written.len();
        let most = if model.name == "figure" { 540_000 } else { MOST_BYTES };
        assert!(
            written.len() <= most,
            "{}.glb takes {} bytes",
            model.name,
            written.len()
        );
        assert!(
            committed == written,
            "{}.glb differs from what the code writes: run `cargo xtask assets`.",
            model.name
        );
    }
    assert!(
        total < 3_500_000,
        "The models take {total} bytes; keep them below 3.5 MB."
    );
}

#[test]
fn a_file_is_one_document_and_one_buffer_of_the_sizes_it_says() {
    for model in &*MODELS {
        let file = encode(model);
        let number = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&file[..4], number(4), number(8)), (&b"glTF"[..], 2, file.len()));
        let document: serde_json::Value = serde_json::from_slice(&file[20..20 + number(12)]).unwrap();
        let buffer = 20 + number(12);
        assert_eq!(&file[buffer + 4..buffer + 8], b"BIN\0");
        assert_eq!(document["buffers"][0]["byteLength"], number(buffer));
        assert_eq!(buffer + 8 + number(buffer), file.len());
        assert_eq!(document["meshes"].as_array().unwrap().len(), model.parts.len());
    }
}

#[test]
fn every_part_is_closed_and_faces_outward() {
    for model in &*MODELS {
        for part in &model.parts {
            let mut edges: BTreeMap<[[i64; 3]; 2], i32> = BTreeMap::new();
            let mut volume = 0.0;
            for triangle in &part.shape.triangles {
                let places = triangle.corners.map(|corner| corner.position);
                volume += places[0].dot(places[1].cross(places[2]));
                let keys = places.map(place_key);
                for i in 0..3 {
                    *edges.entry([keys[i], keys[(i + 1) % 3]]).or_default() += 1;
                }
            }
            assert!(volume > 0.0, "{} is turned inside out", part.name);
            for ([one, other], count) in &edges {
                assert_eq!(
                    (*count, edges.get(&[*other, *one])),
                    (1, Some(&1)),
                    "{} is open at {one:?}",
                    part.name
                );
            }
        }
    }
}

/// At a shared edge, a program that welds vertices by position would find more than two faces.
#[test]
fn no_two_parts_share_an_edge() {
    for model in &*MODELS {
        let mut owners: BTreeMap<[[i64; 3]; 2], &str> = BTreeMap::new();
        for part in &model.parts {
            for triangle in &part.shape.triangles {
                let place = |i: usize| part.translation + part.rotation * triangle.corners[i % 3].position;
                for i in 0..3 {
                    // To a hundredth of a millimeter, as a loader may weld.
                    let key = |i: usize| place_key(place(i) / 100.0);
                    let mut edge = [key(i), key(i + 1)];
                    edge.sort_unstable();
                    let owner = *owners.entry(edge).or_insert(&part.name);
                    assert_eq!(owner, part.name, "{}: two parts share an edge", model.name);
                }
            }
        }
    }
}

#[test]
fn normals_have_unit_length_and_face_with_their_triangles() {
    for model in &*MODELS {
        for (part, indexed) in model.parts.iter().zip(index(model)) {
            for triangle in indexed.indices.as_chunks::<3>().0 {
                let [a, b, c] = triangle.map(|i| glam::Vec3::from(indexed.positions[i as usize]));
                let face = (b - a).cross(c - a).normalize_or_zero();
                for i in triangle {
                    let normal = glam::Vec3::from(indexed.normals[*i as usize]);
                    assert!((normal.length() - 1.0).abs() < 1e-5, "{}: normal {normal}", part.name);
                    assert!(
                        normal.dot(face) > 0.2,
                        "{}: normal {normal} on a face toward {face}",
                        part.name
                    );
                }
            }
        }
    }
}

#[test]
fn charts_keep_their_gap_from_each_other_and_from_the_border() {
    for model in &*MODELS {
        let places = pack(&model.parts);
        let mut boxes: Vec<(DVec2, DVec2)> = Vec::new();
        for (part, places) in model.parts.iter().zip(&places) {
            let first = boxes.len();
            boxes.resize(first + places.len(), (DVec2::INFINITY, DVec2::NEG_INFINITY));
            for triangle in &part.shape.triangles {
                for corner in triangle.corners {
                    let [u, v] = places[triangle.chart].uv_from_sheet(corner.sheet);
                    let px = dvec2(f64::from(u), f64::from(v)) * f64::from(SHEET_PX);
                    let (low, high) = &mut boxes[first + triangle.chart];
                    (*low, *high) = (low.min(px), high.max(px));
                }
            }
        }
        let gap = f64::from(GAP_PX) - 0.01;
        for (i, (low, high)) in boxes.iter().enumerate() {
            assert!(
                low.min_element() >= gap && high.max_element() <= f64::from(SHEET_PX) - gap,
                "{}",
                model.name
            );
            for (other_low, other_high) in &boxes[..i] {
                let apart = (*low - *other_high).max(*other_low - *high).max_element();
                assert!(apart >= gap, "{}: two charts are {apart} texels apart", model.name);
            }
        }
    }
}

#[test]
fn no_texel_belongs_to_two_triangles() {
    for model in &*MODELS {
        let size = SHEET_PX as usize;
        let mut taken = vec![false; size * size];
        for indexed in index(model) {
            for triangle in indexed.indices.as_chunks::<3>().0 {
                let corners = triangle.map(|i| DVec2::from(indexed.uvs[i as usize].map(f64::from)) * size as f64);
                for texel in texels_inside(corners, size) {
                    assert!(!taken[texel], "{}: charts overlap at texel {texel}", model.name);
                    taken[texel] = true;
                }
            }
        }
    }
}

/// Texels whose center lies well inside a triangle.
fn texels_inside(corners: [DVec2; 3], size: usize) -> Vec<usize> {
    let [a, b, c] = corners;
    let area = (b - a).perp_dot(c - a);
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let mut texels = Vec::new();
    for y in low.y as usize..=high.y as usize {
        for x in low.x as usize..=high.x as usize {
            let p = dvec2(x as f64 + 0.5, y as f64 + 0.5);
            let sides = [
                (b - a).perp_dot(p - a),
                (c - b).perp_dot(p - b),
                (a - c).perp_dot(p - c),
            ];
            if sides.iter().all(|side| side * area.signum() > 1e-3) {
                texels.push(y * size + x);
            }
        }
    }
    texels
}

#[test]
fn texels_are_spread_evenly() {
    for model in &*MODELS {
        let tolerance = match model.name {
            // Uneven on purpose.
            "cube" => 1.8,
            // No smooth body lies flat without stretch.
            "figure" | "chair" => 1.35,
            // A bend is longer outside than inside.
            "chain" => 1.3,
            "sphere" => 1.1,
            _ => 1.06,
        };
        let densities = densities(model);
        let middle = density_at(&densities, 0.5);
        let (low, high) = (density_at(&densities, 0.02), density_at(&densities, 0.98));
        assert!(
            middle / low <= tolerance && high / middle <= tolerance,
            "{}: 96 % of the area has {low} to {high} around {middle}",
            model.name
        );
    }
}

#[test]
fn only_the_cube_has_mirrored_charts() {
    for model in &*MODELS {
        let mirrored = triangles(model).filter(|triangle| sheet_cross(triangle) <= 0.0).count();
        assert_eq!(mirrored, if model.name == "cube" { 4 } else { 0 }, "{}", model.name);
    }
}

/// Lowest and highest coordinates of a model.
fn bounds(model: &Model) -> (DVec3, DVec3) {
    let places = model.parts.iter().flat_map(|part| {
        let corners = part.shape.triangles.iter().flat_map(|triangle| triangle.corners);
        corners.map(|corner| part.translation + part.rotation * corner.position)
    });
    places.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), place| {
        (low.min(place), high.max(place))
    })
}

#[test]
fn props_stand_on_the_ground_and_have_the_size_of_their_kind() {
    for model in &*MODELS {
        let size = match model.name {
            "bench" => dvec3(1.6, 0.92, 0.66),
            "chair" => dvec3(0.45, 0.93, 0.52),
            "table" => dvec3(1.4, 0.755, 0.79),
            "crate" => dvec3(0.71, 0.645, 0.71),
            "barrel" => dvec3(0.68, 0.9, 0.68),
            "chain" => dvec3(0.974, 0.416, 0.11),
            "column" => dvec3(0.48, 2.5, 0.48),
            "wall" => dvec3(1.24, 1.2, 1.24),
            _ => continue,
        };
        let (low, high) = bounds(model);
        assert!(low.y.abs() < 0.002, "{} begins at {}", model.name, low.y);
        assert!(
            (high - low - size).abs().max_element() < 0.03,
            "{} measures {}",
            model.name,
            high - low
        );
    }
}

#[test]
fn parts_have_names_of_their_own_and_materials_that_exist() {
    for model in &*MODELS {
        let names: BTreeSet<&str> = model.parts.iter().map(|part| part.name.as_str()).collect();
        assert_eq!(names.len(), model.parts.len(), "{}", model.name);
        for (number, material) in model.materials.iter().enumerate() {
            assert!(
                model.parts.iter().any(|part| part.material == number),
                "nothing of {} is made of {}",
                model.name,
                material.name
            );
        }
        assert!(model.parts.iter().all(|part| part.material < model.materials.len()));
    }
}

/// Links of a chain come within a millimeter of their neighbors and do not cut into them.
#[test]
fn each_link_hangs_in_the_next() {
    let chain = MODELS.iter().find(|model| model.name == "chain").unwrap();
    let points = |part: &ModelPart| -> Vec<DVec3> {
        let corners = part.shape.triangles.iter().flat_map(|triangle| triangle.corners);
        corners
            .map(|corner| part.translation + part.rotation * corner.position)
            .collect()
    };
    let links: Vec<Vec<DVec3>> = chain
        .parts
        .iter()
        .filter(|part| part.name.starts_with("link"))
        .map(points)
        .collect();
    assert_eq!(links.len(), 11);
    for pair in links.windows(2) {
        let near = |one: &DVec3| {
            pair[1]
                .iter()
                .map(|other| one.distance(*other))
                .fold(f64::INFINITY, f64::min)
        };
        let gap = pair[0].iter().map(near).fold(f64::INFINITY, f64::min);
        // Between corners of facets, half an edge further apart than the surfaces.
        assert!(gap < 0.004, "the nearest corners are {gap} m apart");
    }
}

#[test]
fn a_subdivided_figure_is_closed_and_keeps_to_its_charts() {
    let shape = figure::subdivided(2);
    assert_eq!(shape.triangles.len(), 6 * (2 * figure::STEPS).pow(2) * 2);
    let mut edges: BTreeMap<[[i64; 3]; 2], i32> = BTreeMap::new();
    for triangle in &shape.triangles {
        let keys = triangle.corners.map(|corner| place_key(corner.position));
        for i in 0..3 {
            *edges.entry([keys[i], keys[(i + 1) % 3]]).or_default() += 1;
        }
        assert!(sheet_cross(triangle) > 0.0, "a triangle is turned over on its chart");
    }
    let is_open = |[one, other]: &[[i64; 3]; 2]| edges.get(&[*other, *one]) != Some(&1);
    assert!(!edges.keys().any(is_open), "it is open");
    let pieces_for_a_million = (2..).find(|pieces| 6 * (figure::STEPS * pieces).pow(2) * 2 >= 1_000_000);
    assert_eq!(pieces_for_a_million, Some(figure::MILLION_PIECES));
}
