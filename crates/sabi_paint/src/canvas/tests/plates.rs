//! Thin walls.

use super::*;
use crate::Eye;

/// Returns a plate as thin as a sheet: two squares back to back, joined at their edges by narrow sides. The texture
/// coordinates of the sides are next to each other on whole texels.
pub(super) fn plate(thickness: f32) -> Mesh {
    let mut mesh = Mesh {
        uv_set: Some(0),
        is_one_sheet: true,
        ..Mesh::default()
    };
    let half = 0.5 * thickness;
    let [a, b, c, d] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut quad = |corners: [[f32; 3]; 4], normal: [f32; 3], place: [f32; 4]| {
        let first = mesh.positions.len() as u32;
        let [x, y, w, h] = place;
        mesh.positions.extend(corners);
        mesh.normals.extend([normal; 4]);
        mesh.tangents.extend([[1.0, 0.0, 0.0, 1.0]; 4]);
        mesh.uvs.extend([[x, y + h], [x + w, y + h], [x + w, y], [x, y]]);
        mesh.triangles
            .extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        mesh.triangle_part.extend([0; 2]);
        mesh.triangle_material.extend([0; 2]);
    };
    let at = |(x, y): (f32, f32), z: f32| [x, y, z];
    quad(
        [at(a, half), at(b, half), at(c, half), at(d, half)],
        [0.0, 0.0, 1.0],
        [0.0625, 0.0625, 0.375, 0.375],
    );
    quad(
        [at(b, -half), at(a, -half), at(d, -half), at(c, -half)],
        [0.0, 0.0, -1.0],
        [0.5625, 0.0625, 0.375, 0.375],
    );
    for (index, (from, to)) in [(a, b), (b, c), (c, d), (d, a)].into_iter().enumerate() {
        let normal = [to.1 - from.1, from.0 - to.0, 0.0].map(|value: f32| 0.5 * value);
        let row = 0.5 + 0.125 * index as f32;
        quad(
            [at(from, -half), at(to, -half), at(to, half), at(from, half)],
            normal,
            [0.0625, row, 0.375, 0.0625],
        );
    }
    mesh
}

/// Returns a canvas with a hard disk of radius 0.5 around a position of the upper side.
fn stamped(surface: &PaintSurface<'_>, atlas: &Atlas, position: DVec3) -> Canvas {
    let point = surface.point(Site { triangle: 0, position }, 1.0, true).unwrap();
    let brush = Brush {
        radius: 0.5,
        hardness: 1.0,
        ..Brush::default()
    };
    painted(surface, atlas, &[Stroke::new(brush, vec![point])])
}

#[test]
fn the_other_side_of_a_thin_wall_is_not_painted() {
    let mesh = plate(0.01);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let canvas = stamped(&surface, &atlas, DVec3::new(0.2, -0.3, 0.005));
    let side = |triangles: std::ops::Range<u32>| {
        let owned = atlas.owners.iter().zip(canvas.texels());
        owned
            .filter(|(owner, texel)| triangles.contains(owner) && texel.cover > 0.0)
            .count()
    };
    assert!(side(0..2) > 1000, "{}", side(0..2));
    assert_eq!(side(2..4), 0);
}

#[test]
fn a_stroke_continues_around_the_edge_of_a_wall_by_its_length() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512));
    let surface = PaintSurface::new(&mesh, &index);
    // The position is 0.2 from the right edge, so the stamp covers 0.1 of the side and 0.2 of the back.
    let canvas = stamped(&surface, &atlas, DVec3::new(0.8, -0.1, 0.05));
    let area = covered_area(&mesh, &atlas, &canvas);
    let disk = std::f64::consts::PI * 0.25;
    assert!((area / disk - 1.0).abs() < 0.01, "{area} for {disk}");
}

#[test]
fn the_inside_of_an_outline_is_filled_as_seen_and_nothing_behind_it() {
    let mesh = plate(0.2);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let corners = [[-0.5, -0.4], [0.5, -0.4], [0.5, 0.4], [-0.5, 0.4]];
    let points: Vec<StrokePoint> = corners
        .windows(2)
        .flat_map(|side| way_on_plate(&surface, side[0], side[1], 9))
        .collect();
    for eye in [
        None,
        Some(Eye::Toward([0.0, 0.0, 1.0])),
        Some(Eye::Place([2.0, 1.0, 3.0])),
    ] {
        let stroke = Stroke {
            area: Area::Inside,
            eye,
            ..Stroke::new(Brush::default(), points.clone())
        };
        let canvas = painted(&surface, &atlas, &[stroke]);
        let area = covered_area(&mesh, &atlas, &canvas);
        assert!((area - 0.8).abs() < 0.01, "{eye:?}: {area}");
        assert_eq!(canvas.texel(texel_of_plate(&atlas, [0.45, 0.35])).cover, 1.0);
        assert_eq!(canvas.texel(texel_of_plate(&atlas, [0.55, 0.0])).cover, 0.0);
    }
    let line = Stroke {
        area: Area::Inside,
        ..Stroke::new(Brush::default(), points[..2].to_vec())
    };
    let nothing = painted(&surface, &atlas, &[line]);
    assert!(nothing.texels().all(|texel| texel.cover == 0.0));
}

#[test]
fn a_stroke_seen_at_eighty_degrees_has_no_hole_and_its_full_width() {
    let mesh = plate(0.01);
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let tilt = 80_f64.to_radians();
    let eye = 40.0 * DVec3::new(tilt.sin(), 0.0, tilt.cos());
    // Few events, as far apart on the surface as those of a fast hand that moves toward the eye.
    let points = drawn(&surface, &bvh, 7, eye, |t| DVec3::new(1.2 * t - 0.6, 0.0, 0.0));
    assert_eq!(points.len(), 7);
    let brush = Brush {
        radius: 0.1,
        hardness: 1.0,
        ..Brush::default()
    };
    for flow in [1.0, 0.95] {
        let brush = Brush { flow, ..brush.clone() };
        let canvas = painted(&surface, &atlas, &[Stroke::new(brush, points.clone())]);
        let hole = (0..=120).find(|step| {
            let x = 0.01 * f64::from(*step) - 0.6;
            canvas.texel(texel_of_plate(&atlas, [x, 0.0])).cover < 0.94
        });
        assert_eq!(hole, None, "flow {flow}");
        let area = covered_area(&mesh, &atlas, &canvas);
        let line = 1.2 * 0.2 + std::f64::consts::PI * 0.01;
        assert!((area / line - 1.0).abs() < 0.03, "flow {flow}: {area} for {line}");
    }
}

#[test]
fn nothing_is_painted_farther_away_than_the_brush_reaches_on_a_barrel_of_boards_and_hoops() {
    let mesh = mesh_of("barrel");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 1024), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let (middle, size) = (index.middle(), size_of(&mesh));
    let brush = Brush {
        radius: 0.06,
        hardness: 1.0,
        ..Brush::default()
    };
    for step in 0..24 {
        let height = middle.y - 0.35 + 0.03 * f64::from(step);
        let toward = DVec3::new(middle.x, height, middle.z);
        let eye = toward + 3.0 * size * DVec3::new(0.3, 0.0, 1.0).normalize();
        let site = site_seen_from(&mesh, &bvh, eye, toward).unwrap();
        let stroke = Stroke::new(brush.clone(), vec![surface.point(site, 1.0, true).unwrap()]);
        let canvas = painted(&surface, &atlas, &[stroke]);
        for (texel, owner) in atlas.owners.iter().enumerate() {
            if *owner == EMPTY || owner & GHOST_BIT != 0 || canvas.texel(texel).cover == 0.0 {
                continue;
            }
            let place = place_of_texel(&mesh, &atlas, texel, *owner);
            let distance = place.distance(site.position);
            // Pieces at an angle are rotated to be flat, so the distance may be slightly larger than the radius.
            assert!(distance < 1.3 * 0.06, "{distance} at height {height}");
        }
    }
}

/// Returns the position of the middle of a texel that a triangle owns.
fn place_of_texel(mesh: &Mesh, atlas: &Atlas, texel: usize, owner: u32) -> DVec3 {
    let columns = atlas.page_size[0] as usize;
    let offset = atlas.charts[atlas.triangle_chart[owner as usize] as usize].texel_from_uv;
    let at = [texel % columns, texel / columns % atlas.page_size[1] as usize];
    let at = [0, 1].map(|axis| (at[axis] as f64 + 0.5 - f64::from(offset[axis])) / f64::from(atlas.size));
    let [a, b, c] = mesh.triangles[owner as usize].map(|vertex| mesh.uvs[vertex as usize].map(f64::from));
    let (ab, ac, way) = (
        [b[0] - a[0], b[1] - a[1]],
        [c[0] - a[0], c[1] - a[1]],
        [at[0] - a[0], at[1] - a[1]],
    );
    let cross = |one: [f64; 2], other: [f64; 2]| one[0] * other[1] - one[1] * other[0];
    let area = cross(ab, ac);
    let [second, third] = [cross(way, ac) / area, cross(ab, way) / area];
    mesh.position(owner, [1.0 - second - third, second, third])
}

#[test]
fn light_pressure_gives_a_softer_stroke_if_pressure_changes_the_hardness() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512));
    let surface = PaintSurface::new(&mesh, &index);
    let cover = |pressure: f32, tip: crate::Tip, at: f64| {
        let mut brush = Brush {
            tip,
            radius: 0.4,
            hardness: 0.8,
            ..Brush::default()
        };
        (brush.pressure.flow, brush.pressure.hardness) = (0.0, 1.0);
        let mut points = way_on_plate(&surface, [0.0, 0.0], [0.0, 0.0], 1);
        points[0].pressure = pressure;
        let expected = brush.falloff_of(at / 0.4, f64::from(0.8 * pressure));
        let canvas = painted(&surface, &atlas, &[Stroke::new(brush, points)]);
        (
            f64::from(canvas.texel(texel_of_plate(&atlas, [at, 0.0])).cover),
            expected,
        )
    };
    for tip in [crate::Tip::Round, crate::Tip::Square] {
        for pressure in [1.0, 0.5, 0.0] {
            let (found, expected) = cover(pressure, tip, 0.25);
            // The middle of the texel may be up to half a texel away from the position.
            assert!(
                (found - expected).abs() < 0.05,
                "{tip:?} {pressure}: {found} for {expected}"
            );
        }
    }
}
