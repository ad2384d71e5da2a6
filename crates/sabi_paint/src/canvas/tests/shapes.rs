//! Tips, symmetry and fills.

use super::plates::plate;
use super::*;
use crate::{Jitter, Symmetry, Tip, TipDirection, stamp_swatch, swatch};

/// Returns, for each triangle, true if a texel of it has a cover of more than a half.
fn painted_triangles(atlas: &Atlas, canvas: &Canvas) -> Vec<bool> {
    let mut painted = vec![false; atlas.triangle_chart.len()];
    for (owner, texel) in atlas.owners.iter().zip(canvas.texels()) {
        if *owner != EMPTY && owner & GHOST_BIT == 0 && texel.cover > 0.5 {
            painted[*owner as usize] = true;
        }
    }
    painted
}

#[test]
fn a_symmetric_model_gets_a_symmetric_mask() {
    let mesh = mesh_of("sphere");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let size = mesh.positions.iter().map(|at| at[1].abs()).fold(0.0, f32::max);
    let path = |t: f64| f64::from(size) * DVec3::new(0.2 + 0.3 * t, 0.1 + 0.4 * t, 0.0);
    let points = drawn(&surface, &bvh, 40, 4.0 * f64::from(size) * DVec3::Z, path);
    let with = |symmetry: Symmetry| {
        let brush = Brush {
            radius: 0.12 * size,
            symmetry,
            ..Brush::default()
        };
        let canvas = painted(&surface, &atlas, &[Stroke::new(brush, points.clone())]);
        covered_area(&mesh, &atlas, &canvas)
    };
    let single = with(Symmetry::default());
    let mirrored = with(Symmetry {
        mirrors: [true, true, false],
        turns: 0,
    });
    let turned = with(Symmetry {
        mirrors: [false; 3],
        turns: 5,
    });
    assert!((mirrored / single - 4.0).abs() < 0.02, "{mirrored} of {single}");
    assert!((turned / single - 5.0).abs() < 0.03, "{turned} of {single}");
}

#[test]
fn a_fill_covers_exactly_the_area_that_contains_the_touched_point() {
    let mesh = mesh_of("crate");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let site = site_seen_from(&mesh, &bvh, DVec3::new(0.1, 0.3, 9.0), DVec3::new(0.1, 0.3, 0.0)).unwrap();
    let own = site.triangle as usize;
    let point = surface.point(site, 1.0, true).unwrap();
    let fill = |area: Area| {
        let mut fill = Stroke::new(Brush::default(), vec![point]);
        fill.area = area;
        painted_triangles(&atlas, &painted(&surface, &atlas, &[fill]))
    };
    // Triangles that are smaller than a texel own no texel.
    let mut owns = vec![false; atlas.triangle_chart.len()];
    for owner in atlas
        .owners
        .iter()
        .filter(|owner| **owner != EMPTY && **owner & GHOST_BIT == 0)
    {
        owns[*owner as usize] = true;
    }
    let expected = |is_in: &dyn Fn(usize) -> bool| (0..owns.len()).map(|t| owns[t] && is_in(t)).collect::<Vec<bool>>();
    assert_eq!(fill(Area::All), expected(&|_| true));
    assert_eq!(
        fill(Area::Part),
        expected(&|t| mesh.triangle_part[t] == mesh.triangle_part[own])
    );
    assert_eq!(
        fill(Area::Material),
        expected(&|t| mesh.triangle_material[t] == mesh.triangle_material[own])
    );
    assert_eq!(
        fill(Area::Chart),
        expected(&|t| atlas.triangle_chart[t] == atlas.triangle_chart[own])
    );
    assert_eq!(fill(Area::Piece), expected(&|t| index.pieces[t] == index.pieces[own]));
    let normal = |t: usize| surface.connected().normal(t as u32);
    let side = fill(Area::Side);
    assert!(side[own] && side.iter().filter(|is| **is).count() < fill(Area::Piece).iter().filter(|is| **is).count());
    assert!(
        side.iter()
            .enumerate()
            .all(|(t, is)| !is || normal(t).dot(normal(own)) > 0.0)
    );
}

#[test]
fn every_tip_paints_within_its_radius_and_the_same_each_time() {
    let mesh = mesh_of("cube");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let way = |t: f64| DVec3::new(0.2 * t - 0.1, 0.05, 0.0);
    let points = drawn(&surface, &bvh, 20, 9.0 * DVec3::Z, way);
    let height = points[0].site.position.z;
    for (tip, name) in Tip::ALL {
        let brush = Brush {
            tip,
            radius: 0.1,
            angle_degrees: 30.0,
            jitter: Jitter {
                place: 0.3,
                size: 0.5,
                angle_degrees: 90.0,
                flow: 0.2,
                ..Jitter::default()
            },
            ..Brush::default()
        };
        let once = || painted(&surface, &atlas, &[Stroke::new(brush.clone(), points.clone())]);
        let canvas = once();
        assert_eq!(canvas, once(), "{name}");
        let area = covered_area(&mesh, &atlas, &canvas);
        assert!(area > 1e-3 && area < 0.1, "{name}: {area}");
        for (texel, owner) in atlas.owners.iter().enumerate() {
            if *owner == EMPTY || owner & GHOST_BIT != 0 || canvas.texel(texel).cover == 0.0 {
                continue;
            }
            let corners = surface.connected().corners(*owner);
            assert!(
                corners.iter().any(|corner| (corner.z - height).abs() < 1e-6),
                "{name} stays on its side"
            );
        }
    }
}

#[test]
fn a_gradient_fades_evenly_between_its_ends_and_is_constant_beyond_them() {
    let mesh = mesh_of("cube");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 128), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let at = |x: f64| site_seen_from(&mesh, &bvh, DVec3::new(x, 0.1, 9.0), DVec3::new(x, 0.1, 0.0)).unwrap();
    let ends = [at(-0.2), at(0.3)].map(|site| surface.point(site, 1.0, false).unwrap());
    let mut gradient = Stroke::new(Brush::default(), ends.to_vec());
    gradient.area = Area::Gradient;
    let canvas = painted(&surface, &atlas, &[gradient]);
    for (texel, owner) in atlas.owners.iter().enumerate() {
        if *owner == EMPTY || owner & GHOST_BIT != 0 {
            continue;
        }
        let corners = mesh.triangles[*owner as usize];
        let [p, q, r] = corners.map(|vertex| mesh.uvs[vertex as usize].map(|uv| f64::from(uv) * f64::from(atlas.size)));
        let chart = &atlas.charts[atlas.triangle_chart[*owner as usize] as usize];
        let [width, height] = atlas.page_size.map(|side| side as usize);
        let place = [(texel % width) as f64 + 0.5, (texel / width % height) as f64 + 0.5];
        let place: [f64; 2] = std::array::from_fn(|axis| place[axis] - f64::from(chart.texel_from_uv[axis]));
        let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let of_q = ((place[0] - p[0]) * (r[1] - p[1]) - (place[1] - p[1]) * (r[0] - p[0])) / area;
        let of_r = ((q[0] - p[0]) * (place[1] - p[1]) - (q[1] - p[1]) * (place[0] - p[0])) / area;
        let x = |corner: usize| f64::from(mesh.positions[corners[corner] as usize][0]);
        let x = x(0) + of_q * (x(1) - x(0)) + of_r * (x(2) - x(0));
        let expected = (1.0 - (x + 0.2) / 0.5).clamp(0.0, 1.0);
        assert!(
            (f64::from(canvas.texel(texel).cover) - expected).abs() < 1e-5,
            "{x}: {}",
            canvas.texel(texel).cover
        );
    }
}

/// Returns the mean position of the paint of a stroke of leaks.
fn hangs(mesh: &Mesh, surface: &PaintSurface<'_>, atlas: &Atlas, way: [Site; 2], turn: TipDirection) -> DVec3 {
    let points = [surface.point(way[0], 1.0, true), surface.point(way[1], 1.0, false)];
    let brush = Brush {
        radius: 0.2,
        spacing: 0.3,
        turn,
        ..Brush::default().with_tip(Tip::Leaks)
    };
    let brush = Brush {
        jitter: Jitter::default(),
        ..brush
    };
    let stroke = Stroke::new(brush, points.into_iter().flatten().collect());
    let canvas = painted(surface, atlas, &[stroke]);
    let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
    for (texel, owner) in atlas.owners.iter().enumerate() {
        if *owner == EMPTY || owner & GHOST_BIT != 0 || canvas.texel(texel).cover == 0.0 {
            continue;
        }
        let middle = mesh.corners(*owner).into_iter().sum::<DVec3>() / 3.0;
        sum += f64::from(canvas.texel(texel).cover) * middle;
        weight += f64::from(canvas.texel(texel).cover);
    }
    sum / weight
}

#[test]
fn a_hanging_tip_points_down_a_wall_and_along_the_stroke_on_level_ground() {
    // The triangles are small, so that their middles show where the paint is.
    let mesh = mesh_of("sphere");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let size = size_of(&mesh);
    let site = |x: f64, y: f64, z: f64| {
        let toward = DVec3::new(x, y, z).normalize();
        site_seen_from(&mesh, &bvh, 9.0 * size * toward, DVec3::ZERO).unwrap()
    };
    // Stamps of leaks have more paint at their upper end.
    let wall = [site(0.0, 0.0, 1.0), site(0.08, 0.0, 1.0)];
    let moved = |way: [Site; 2], turn: TipDirection| {
        hangs(&mesh, &surface, &atlas, way, turn) - way[0].position.midpoint(way[1].position)
    };
    let down = moved(wall, TipDirection::Down);
    assert!(down.y > 0.02 && down.x.abs() < 0.5 * down.y, "{down}");
    let along = moved(wall, TipDirection::Stroke);
    assert!(along.x < -0.02 && along.y.abs() < -0.5 * along.x, "{along}");
    let mesh = mesh_of("cube");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 128), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let on_top = |turn: TipDirection| {
        let points = drawn(&surface, &bvh, 9, 9.0 * DVec3::Y, |t| DVec3::new(0.3 * t, 0.0, 0.1));
        let brush = Brush {
            turn,
            ..Brush::default().with_tip(Tip::Leaks)
        };
        painted(&surface, &atlas, &[Stroke::new(brush, points)])
    };
    assert_eq!(on_top(TipDirection::Down), on_top(TipDirection::Stroke));
}

#[test]
fn a_swatch_shows_all_paint_within_its_borders_for_any_radius() {
    let none = StampPictures::new();
    for (tip, name) in Tip::ALL {
        let brush = Brush::default().with_tip(tip);
        let (width, height) = (96, 32);
        let picture = swatch(&brush, &none, [width, height]);
        assert_eq!(picture.len(), width * height);
        assert!(
            picture.iter().all(|pixel| (0.0..=1.0).contains(&pixel.strength)),
            "{name}"
        );
        let columns = (0..width).filter(|x| (0..height).any(|y| picture[y * width + x].strength > 0.02));
        assert!(columns.count() > width / 4, "{name} fills the width");
        assert!(
            picture[..width].iter().all(|pixel| pixel.strength < 0.25),
            "{name} stays inside"
        );
        let large = Brush {
            radius: 7.0,
            ..brush.clone()
        };
        assert_eq!(swatch(&large, &none, [width, height]), picture, "{name}");
        let stamp = stamp_swatch(&brush, &none, 48);
        assert_eq!(stamp.len(), 48 * 48);
        assert!(stamp.iter().any(|pixel| pixel.strength > 0.3), "{name}");
    }
    assert_eq!(swatch(&Brush::default(), &none, [0, 1]).len(), 1);
}

#[test]
fn strokes_are_moved_to_another_place_and_turned_there() {
    let mesh = plate(0.02);
    let index = SurfaceIndex::new(&mesh);
    let surface = PaintSurface::new(&mesh, &index);
    let points = way_on_plate(&surface, [0.0, 0.0], [0.4, 0.0], 5);
    let stroke = Stroke::new(
        Brush {
            radius: 0.05,
            ..Brush::default()
        },
        points.clone(),
    );
    let to = way_on_plate(&surface, [-0.3, -0.2], [-0.3, -0.2], 1)[0];
    let (carried, lost) = crate::carried(&surface, &stroke, [&points[0], &to], 90.0);
    let ends = [0, 4].map(|end: usize| carried.points[end].site.position);
    let expected = [DVec3::new(-0.3, -0.2, 0.01), DVec3::new(-0.3, 0.2, 0.01)];
    for (end, expected) in ends.into_iter().zip(expected) {
        assert!(end.distance(expected) < 1e-6, "{end} {expected}");
    }
    assert_eq!((lost, carried.points.len(), carried.points[1].starts), (0, 5, false));
    // Points that would be too far beyond the border are lost.
    let border = way_on_plate(&surface, [0.95, 0.0], [0.95, 0.0], 1)[0];
    let (carried, lost) = crate::carried(&surface, &stroke, [&points[0], &border], 0.0);
    assert!(lost > 0 && carried.points.len() + lost == 5, "{lost}");
}
