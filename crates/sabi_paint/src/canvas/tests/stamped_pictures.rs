//! Decals, pictures as tips, and limits of a brush.

use std::sync::Arc;

use sabi_image::{DeclaredColorSpace, Picture, PictureRemarks, Pixels};

use sabi_surface::patch::weights_at;

use super::plates::plate;
use super::*;
use crate::{BrushLimits, Eye, PictureName, PicturePart, PictureTip, StampPicture};

pub(super) const COLORED: CanvasLayers = CanvasLayers { color: true, ..VALUE };

/// Returns a picture of four by two pixels, the left half red and the right half blue.
pub(super) fn flag() -> (PictureTip, StampPictures) {
    let row = [
        [255, 0, 0, 255],
        [255, 0, 0, 255],
        [0, 0, 255, 255],
        [0, 0, 255, 255_u8],
    ];
    let picture = Picture {
        width: 4,
        height: 2,
        channels: 4,
        pixels: Pixels::U8([row, row].as_flattened().as_flattened().to_vec()),
        color_space: DeclaredColorSpace::Srgb,
        remarks: PictureRemarks::default(),
    };
    let name = PictureName::of(b"flag", "png").unwrap();
    let tip = PictureTip {
        picture: name.clone(),
        part: PicturePart::Colors,
    };
    (
        tip,
        StampPictures::from([(name, Arc::new(StampPicture::new(&picture)))]),
    )
}

/// Returns a decal of the flag, half a unit to both sides, in the middle of the front of a plate.
fn decal(surface: &PaintSurface<'_>, picture: PictureTip, angle_degrees: f32) -> Stroke {
    let brush = Brush {
        picture: Some(picture),
        radius: 0.5,
        angle_degrees,
        ..Brush::default()
    };
    Stroke {
        area: Area::Decal,
        ..Stroke::new(brush, way_on_plate(surface, [0.0, 0.0], [0.0, 0.0], 1))
    }
}

/// Returns covers and colors of a canvas at positions of the front.
fn seen(atlas: &Atlas, canvas: &Canvas, places: [[f64; 2]; 4]) -> [(f32, [f32; 3]); 4] {
    places.map(|place| {
        let texel = texel_of_plate(atlas, place);
        (canvas.texel(texel).cover, canvas.texel(texel).color)
    })
}

const RED: (f32, [f32; 3]) = (1.0, [1.0, 0.0, 0.0]);
const BLUE: (f32, [f32; 3]) = (1.0, [0.0, 0.0, 1.0]);
const CLEAR: (f32, [f32; 3]) = (0.0, [0.0; 3]);

#[test]
fn a_decal_is_upright_and_not_mirrored_and_has_its_own_colors() {
    let mesh = plate(0.01);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let (tip, pictures) = flag();
    let canvas = |angle: f32| {
        let decal = [decal(&surface, tip.clone(), angle)];
        painted_with(&surface, &atlas, &decal, &pictures, COLORED)
    };
    let upright = seen(
        &atlas,
        &canvas(0.0),
        [[-0.3, 0.1], [0.3, -0.1], [0.0, 0.35], [0.6, 0.0]],
    );
    assert_eq!(upright, [RED, BLUE, CLEAR, CLEAR]);
    let turned = seen(
        &atlas,
        &canvas(90.0),
        [[0.1, -0.3], [-0.1, 0.3], [0.35, 0.0], [0.0, 0.6]],
    );
    assert_eq!(turned, [RED, BLUE, CLEAR, CLEAR], "counter-clockwise");
}

#[test]
fn a_decal_on_a_mirrored_side_is_not_mirrored() {
    let mesh = plate(0.01);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let (tip, pictures) = flag();
    let mut mirrored = decal(&surface, tip, 0.0);
    mirrored.brush.radius = 0.3;
    mirrored.brush.symmetry.mirrors[0] = true;
    mirrored.points = way_on_plate(&surface, [0.6, 0.0], [0.6, 0.0], 1);
    let canvas = painted_with(&surface, &atlas, &[mirrored], &pictures, COLORED);
    let found = seen(&atlas, &canvas, [[0.45, 0.0], [0.75, 0.0], [-0.75, 0.0], [-0.45, 0.0]]);
    assert_eq!(found, [RED, BLUE, RED, BLUE]);
}

#[test]
fn a_decal_can_be_read_from_the_side_on_which_it_was_laid() {
    let mesh = plate(0.01);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let (tip, pictures) = flag();
    let across = [[-0.3, 0.1], [0.3, -0.1], [0.0, 0.35], [0.6, 0.0]];
    // Counter-clockwise as seen from either side, so that red comes to lie below.
    let upright = [[0.1, -0.3], [-0.1, 0.3], [0.35, 0.0], [0.0, 0.6]];
    for (eye, turn, places, expected) in [
        (
            Some(Eye::Place([0.0, 0.0, 5.0])),
            0.0,
            across,
            [RED, BLUE, CLEAR, CLEAR],
        ),
        (
            Some(Eye::Place([0.0, 0.0, -5.0])),
            0.0,
            across,
            [BLUE, RED, CLEAR, CLEAR],
        ),
        (
            Some(Eye::Toward([0.0, 0.0, -1.0])),
            0.0,
            across,
            [BLUE, RED, CLEAR, CLEAR],
        ),
        (None, 0.0, across, [RED, BLUE, CLEAR, CLEAR]),
        (
            Some(Eye::Place([0.0, 0.0, 5.0])),
            90.0,
            upright,
            [RED, BLUE, CLEAR, CLEAR],
        ),
        (
            Some(Eye::Place([0.0, 0.0, -5.0])),
            90.0,
            upright,
            [RED, BLUE, CLEAR, CLEAR],
        ),
    ] {
        let mut stroke = decal(&surface, tip.clone(), turn);
        stroke.eye = eye;
        let canvas = painted_with(&surface, &atlas, &[stroke], &pictures, COLORED);
        assert_eq!(seen(&atlas, &canvas, places), expected, "{eye:?} {turn}");
    }
}

/// A label is as large as its picture wherever it lies. What the unfolding puts in two places makes it larger.
#[test]
fn a_label_leaves_no_pieces_beside_it_on_a_bent_surface() {
    let mesh = mesh_of("figure");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 1024), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let size = size_of(&mesh);
    let radius = 0.12 * size;
    let mut shares = Vec::new();
    for step in 0..36 {
        let turn = f64::from(step) * 0.7;
        let toward = DVec3::new(0.0, size * (f64::from(step) / 18.0 - 1.0) * 0.8, 0.0);
        let eye = toward + 9.0 * size * DVec3::new(turn.sin(), 0.0, turn.cos());
        let Some(site) = site_seen_from(&mesh, &bvh, eye, toward) else {
            continue;
        };
        let brush = Brush {
            tip: crate::Tip::Square,
            hardness: 1.0,
            radius: radius as f32,
            ..Brush::default()
        };
        let label = Stroke {
            area: Area::Label,
            ..Stroke::new(brush, vec![surface.point(site, 1.0, true).unwrap()])
        };
        let canvas = painted(&surface, &atlas, &[label]);
        shares.push(covered_area(&mesh, &atlas, &canvas) / (2.0 * radius).powi(2));
    }
    let most = shares.iter().copied().fold(0.0, f64::max);
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    // Some of the labels reach beyond an edge of the model.
    assert!(
        most < 1.12 && mean > 0.9,
        "{most} of its area, {mean} in the mean: {shares:.2?}"
    );
}

#[test]
fn a_decal_is_projected_straight_over_the_joints_of_boards() {
    // Boards of the crate are at different depths, and each is a separate piece.
    let mesh = mesh_of("crate");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 1024), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let size = size_of(&mesh);
    let site = site_seen_from(&mesh, &bvh, DVec3::new(0.1, 0.3, 9.0), DVec3::new(0.1, 0.3, 0.0)).unwrap();
    let brush = Brush {
        tip: crate::Tip::Square,
        hardness: 1.0,
        radius: (0.2 * size) as f32,
        ..Brush::default()
    };
    let stroke = Stroke {
        area: Area::Decal,
        ..Stroke::new(brush, vec![surface.point(site, 1.0, true).unwrap()])
    };
    let canvas = painted(&surface, &atlas, &[stroke]);
    let pieces: std::collections::BTreeSet<u32> = (0..atlas.owners.len())
        .filter(|texel| atlas.owners[*texel] < mesh.triangles.len() as u32 && canvas.texel(*texel).cover == 1.0)
        .map(|texel| index.pieces[atlas.owners[texel] as usize])
        .collect();
    assert!(pieces.len() > 2, "{pieces:?}");
    // The area as seen from the front is that of the square, whatever surface it is on.
    let seen: f64 = (0..400)
        .filter(|at| {
            let place = DVec3::new(f64::from(at % 20) - 9.5, f64::from(at / 20) - 9.5, 0.0) * 0.024 * size;
            let eye = site.position + place + DVec3::new(0.0, 0.0, 4.0 * size);
            let hit = site_seen_from(&mesh, &bvh, eye, eye - DVec3::Z);
            let inside = place.x.abs() < 0.19 * size && place.y.abs() < 0.19 * size;
            let outside = place.x.abs() > 0.21 * size || place.y.abs() > 0.21 * size;
            let cover = hit.map(|hit| cover_at(&atlas, &mesh, &canvas, hit));
            cover.is_some_and(|cover| inside && cover < 0.5 || outside && cover > 0.5)
        })
        .count() as f64;
    assert!(
        seen < 8.0,
        "{seen} of 400 places are painted otherwise than the square says"
    );
}

#[test]
fn a_label_goes_around_an_edge_where_a_decal_ends() {
    let mesh = plate(0.4);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let area = |area: Area| {
        let brush = Brush {
            tip: crate::Tip::Square,
            hardness: 1.0,
            radius: 0.3,
            ..Brush::default()
        };
        let stroke = Stroke {
            area,
            ..Stroke::new(brush, way_on_plate(&surface, [0.9, 0.0], [0.9, 0.0], 1))
        };
        covered_area(&mesh, &atlas, &painted(&surface, &atlas, &[stroke]))
    };
    assert!((area(Area::Label) - 0.36).abs() < 0.01, "{}", area(Area::Label));
    assert!((area(Area::Decal) - 0.24).abs() < 0.01, "{}", area(Area::Decal));
}

/// Cover of the texel under a site.
fn cover_at(atlas: &Atlas, mesh: &Mesh, canvas: &Canvas, site: Site) -> f32 {
    let weights = weights_at(mesh.corners(site.triangle), site.position).unwrap();
    let chart = &atlas.charts[atlas.triangle_chart[site.triangle as usize] as usize];
    let corners = mesh.triangles[site.triangle as usize].map(|vertex| mesh.uvs[vertex as usize].map(f64::from));
    let [column, row] = [0, 1].map(|axis| {
        let uv = corners[0][axis]
            + weights.x * (corners[1][axis] - corners[0][axis])
            + weights.y * (corners[2][axis] - corners[0][axis]);
        (uv * f64::from(atlas.size) + f64::from(chart.texel_from_uv[axis])) as usize
    });
    let [columns, rows] = atlas.page_size.map(|side| side as usize);
    canvas
        .texel((chart.page as usize * rows + row) * columns + column)
        .cover
}

#[test]
fn a_stroke_without_its_picture_leaves_nothing() {
    let mesh = plate(0.01);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 64));
    let surface = PaintSurface::new(&mesh, &index);
    let decal = [decal(&surface, flag().0, 0.0)];
    let canvas = painted_with(&surface, &atlas, &decal, &StampPictures::new(), COLORED);
    assert!(canvas.texels().all(|texel| texel.cover == 0.0));
}

#[test]
fn stamps_of_a_picture_have_its_colors_or_the_color_of_the_brush() {
    let mesh = plate(0.01);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let (tip, pictures) = flag();
    let color = |part: PicturePart| {
        let brush = Brush {
            picture: Some(PictureTip { part, ..tip.clone() }),
            radius: 0.3,
            spacing: 0.3,
            color: [0.0, 1.0, 0.0],
            ..Brush::default()
        };
        let stroke = [Stroke::new(brush, way_on_plate(&surface, [-0.5, 0.2], [0.5, 0.2], 12))];
        let canvas = painted_with(&surface, &atlas, &stroke, &pictures, COLORED);
        let texel = texel_of_plate(&atlas, [0.62, 0.2]);
        (canvas.texel(texel).cover, canvas.texel(texel).color)
    };
    assert_eq!(color(PicturePart::Colors), BLUE);
    assert_eq!(color(PicturePart::Alpha), (1.0, [0.0, 1.0, 0.0]));
}

/// Returns the area that a hard disk at the edge of a thick plate covers with these limits, seen from an eye.
fn limited_area(limits: BrushLimits, eye: Option<Eye>) -> f64 {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512));
    let surface = PaintSurface::new(&mesh, &index);
    let brush = Brush {
        radius: 0.5,
        hardness: 1.0,
        limits,
        ..Brush::default()
    };
    let stroke = Stroke {
        eye,
        ..Stroke::new(brush, way_on_plate(&surface, [0.8, -0.1], [0.8, -0.1], 1))
    };
    covered_area(&mesh, &atlas, &painted(&surface, &atlas, &[stroke]))
}

/// Returns the area of the part of a disk of radius 0.5 that is beyond a line at 0.2 from its middle.
fn segment() -> f64 {
    let (radius, line): (f64, f64) = (0.5, 0.2);
    radius * radius * (line / radius).acos() - line * (radius * radius - line * line).sqrt()
}

#[test]
fn limits_of_angle_front_and_sight_protect_the_other_sides() {
    let disk = std::f64::consts::PI * 0.25;
    let front = disk - segment();
    let above = Some(Eye::Toward([0.0, 0.0, 1.0]));
    let limits = BrushLimits::default();
    let cases = [
        ("none", limits, above, disk),
        (
            "angle",
            BrushLimits {
                angle_degrees: 60.0,
                ..limits
            },
            None,
            front,
        ),
        (
            "front",
            BrushLimits {
                front_only: true,
                ..limits
            },
            above,
            front,
        ),
        (
            "seen",
            BrushLimits {
                seen_only: true,
                ..limits
            },
            above,
            front,
        ),
        (
            "in the 2D view",
            BrushLimits {
                seen_only: true,
                front_only: true,
                ..limits
            },
            None,
            disk,
        ),
    ];
    for (name, limits, eye, expected) in cases {
        let area = limited_area(limits, eye);
        assert!((area / expected - 1.0).abs() < 0.015, "{name}: {area} for {expected}");
    }
}

#[test]
fn a_stroke_does_not_paint_places_that_are_hidden_from_the_artist() {
    let mut mesh = plate(0.01);
    // A second plate above the right half of the first. Only its upper side matters here.
    let lid = plate(0.01);
    let first = mesh.positions.len() as u32;
    mesh.positions
        .extend(lid.positions.iter().map(|[x, y, z]| [x + 1.0, *y, z + 0.5]));
    mesh.normals.extend(&lid.normals);
    mesh.tangents.extend(&lid.tangents);
    mesh.uvs.extend(lid.uvs.iter().map(|[u, v]| [u + 1.0, *v]));
    mesh.triangles
        .extend(lid.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
    mesh.triangle_part.extend(&lid.triangle_part);
    mesh.triangle_material.extend(&lid.triangle_material);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let brush = Brush {
        radius: 0.2,
        hardness: 1.0,
        limits: BrushLimits {
            seen_only: true,
            ..BrushLimits::default()
        },
        ..Brush::default()
    };
    let stroke = Stroke {
        eye: Some(Eye::Place([0.0, 0.0, 40.0])),
        ..Stroke::new(brush, way_on_plate(&surface, [-0.6, 0.1], [0.6, 0.1], 20))
    };
    let canvas = painted(&surface, &atlas, &[stroke]);
    let cover = |x: f64| canvas.texel(texel_of_plate(&atlas, [x, 0.1])).cover;
    assert_eq!([cover(-0.5), cover(-0.1), cover(0.1), cover(0.5)], [1.0, 1.0, 0.0, 0.0]);
}
