//! Strokes on the project's own models, compared with formulas.

mod buckets;
mod changes;
mod growing;
mod pens;
mod plates;
mod ribbons;
mod shapes;
mod stamped_pictures;
mod stencils;

use std::path::Path;

use glam::DVec3;
use sabi_surface::atlas::{Atlas, AtlasOptions, EMPTY, GHOST_BIT};
use sabi_surface::bvh::Bvh;
use sabi_surface::load::{LoadOptions, load};
use sabi_surface::model::Mesh;
use sabi_surface::patch::Site;

use super::{Canvas, CanvasLayers, Painter};
use crate::{Action, Area, Brush, CopyOf, PaintSurface, StampPictures, Stroke, StrokePoint, Supplies, SurfaceIndex};

const VALUE: CanvasLayers = CanvasLayers {
    value: true,
    color: false,
    height: false,
    direction: false,
};

fn mesh_of(name: &str) -> Mesh {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../assets/meshes/{name}.glb"));
    load(&file, &LoadOptions::default()).unwrap().mesh
}

fn atlas_of(mesh: &Mesh, size: u32) -> Atlas {
    Atlas::build(mesh, &AtlasOptions::new(size)).unwrap()
}

/// Returns the site at which a ray from outside toward the middle of the model hits it.
fn site_seen_from(mesh: &Mesh, bvh: &Bvh, eye: DVec3, toward: DVec3) -> Option<Site> {
    let direction = (toward - eye).normalize();
    let hit = bvh.closest(eye.as_vec3().to_array(), direction.as_vec3().to_array(), 1e3)?;
    Some(Site {
        triangle: hit.triangle,
        position: mesh.position(hit.triangle, hit.barycentric.map(f64::from)),
    })
}

/// Returns the largest distance of a point of a model from the origin.
fn size_of(mesh: &Mesh) -> f64 {
    let distances = mesh.positions.iter().map(|at| DVec3::from(at.map(f64::from)).length());
    distances.fold(0.0, f64::max)
}

fn painted(surface: &PaintSurface<'_>, atlas: &Atlas, strokes: &[Stroke]) -> Canvas {
    painted_with(surface, atlas, strokes, &StampPictures::new(), VALUE)
}

fn painted_with(
    surface: &PaintSurface<'_>,
    atlas: &Atlas,
    strokes: &[Stroke],
    pictures: &StampPictures,
    layers: CanvasLayers,
) -> Canvas {
    let mut canvas = Canvas::empty(atlas.owners.len(), layers);
    let mut painter = Painter::new(surface, atlas, Supplies::of_pictures(pictures));
    for stroke in strokes {
        painter.paint(&mut canvas, stroke);
    }
    canvas
}

/// Returns the texel of the front of a plate ([`plates::plate`]) at a position between −1 and 1 along both sides.
fn texel_of_plate(atlas: &Atlas, [x, y]: [f64; 2]) -> usize {
    let offset = atlas.charts[atlas.triangle_chart[0] as usize].texel_from_uv;
    let uv = [0.0625 + 0.1875 * (x + 1.0), 0.0625 + 0.1875 * (1.0 - y)];
    let [column, row] = [0, 1].map(|axis| (uv[axis] * f64::from(atlas.size) + f64::from(offset[axis])) as usize);
    row * atlas.page_size[0] as usize + column
}

/// Returns points of a straight way over the front of a plate from one position to another.
fn way_on_plate(surface: &PaintSurface<'_>, from: [f64; 2], to: [f64; 2], events: usize) -> Vec<StrokePoint> {
    let point = |event: usize| {
        let share = event as f64 / (events.max(2) - 1) as f64;
        let [x, y] = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        // The diagonal from lower left to upper right separates the two triangles.
        let triangle = u32::from(y > x);
        let height = f64::from(surface.mesh().positions[0][2]);
        let position = DVec3::new(x, y, height);
        surface.point(Site { triangle, position }, 1.0, event == 0).unwrap()
    };
    (0..events).map(point).collect()
}

/// Returns the covered area in square model units: the sum over owned texels of their area times their cover.
fn covered_area(mesh: &Mesh, atlas: &Atlas, canvas: &Canvas) -> f64 {
    let mut area = 0.0;
    for (texel, owner) in atlas.owners.iter().enumerate() {
        if *owner == EMPTY || owner & GHOST_BIT != 0 {
            continue;
        }
        let corners = mesh.triangles[*owner as usize];
        let [a, b, c] = mesh.corners(*owner);
        let [p, q, r] = corners.map(|vertex| mesh.uvs[vertex as usize].map(|uv| f64::from(uv) * f64::from(atlas.size)));
        let in_space = (b - a).cross(c - a).length();
        let in_texels = ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).abs();
        area += f64::from(canvas.texel(texel).cover) * in_space / in_texels;
    }
    area
}

/// Returns a stroke over a model as a hand draws it: seen from one side, with this many events.
fn drawn(
    surface: &PaintSurface<'_>,
    bvh: &Bvh,
    events: usize,
    eye: DVec3,
    at: impl Fn(f64) -> DVec3,
) -> Vec<StrokePoint> {
    let mut starts = true;
    let seen = (0..events).filter_map(|event| {
        let toward = at(event as f64 / (events - 1) as f64);
        let site = site_seen_from(surface.mesh(), bvh, eye + toward, toward)?;
        let point = surface.point(site, 1.0, starts)?;
        starts = false;
        Some(point)
    });
    seen.collect()
}

#[test]
fn a_disk_on_a_ball_has_the_area_of_a_cap() {
    let mesh = mesh_of("sphere");
    let ball = mesh
        .positions
        .iter()
        .map(|at| DVec3::from(at.map(f64::from)).length())
        .sum::<f64>()
        / mesh.positions.len() as f64;
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    for share in [0.1, 0.3, 0.6] {
        let radius = share * ball;
        let brush = Brush {
            radius: radius as f32,
            hardness: 1.0,
            ..Brush::default()
        };
        let eye = DVec3::new(0.7, 1.3, 2.0) * ball;
        let site = site_seen_from(&mesh, &bvh, 2.0 * eye, DVec3::ZERO).unwrap();
        let point = surface.point(site, 1.0, true).unwrap();
        let area = covered_area(
            &mesh,
            &atlas,
            &painted(&surface, &atlas, &[Stroke::new(brush, vec![point])]),
        );
        let expected = 2.0 * std::f64::consts::PI * ball * ball * (1.0 - share.cos());
        assert!((area / expected - 1.0).abs() < 0.02, "{share}: {area} for {expected}");
    }
}

#[test]
fn thirty_events_a_second_paint_the_same_as_two_hundred_and_forty() {
    let mesh = mesh_of("sphere");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let size = size_of(&mesh);
    // An arc over the front of the model, drawn in one second.
    let path = |t: f64| size * DVec3::new(0.25 * (2.0 * t - 1.0), 0.45 + 0.12 * (3.0 * t).sin(), 0.0);
    let brush = |flow: f32| Brush {
        radius: (0.08 * size) as f32,
        hardness: 0.2,
        flow,
        ..Brush::default()
    };
    for flow in [1.0, 0.2] {
        let of = |events: usize| {
            let points = drawn(&surface, &bvh, events, 4.0 * size * DVec3::Z, path);
            painted(&surface, &atlas, &[Stroke::new(brush(flow), points)])
        };
        let (few, many) = (of(31), of(241));
        let both = few.texels().zip(many.texels());
        let differences = both.map(|(few, many)| f64::from((few.cover - many.cover).abs()));
        let touched = many.texels().filter(|texel| texel.cover > 0.0).count();
        assert!(touched > 500, "{touched}");
        let mean = (differences.map(|difference| difference * difference).sum::<f64>() / touched as f64).sqrt();
        assert!(mean < 1.0 / 255.0, "flow {flow}: {mean}");
    }
}

#[test]
fn a_stroke_is_the_same_at_twice_the_size() {
    let mesh = mesh_of("figure");
    let (index, bvh) = (SurfaceIndex::new(&mesh), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let size = size_of(&mesh);
    let path = |t: f64| size * DVec3::new(0.2 * (2.0 * t - 1.0), 0.5, 0.0);
    let points = drawn(&surface, &bvh, 60, 4.0 * size * DVec3::Z, path);
    let brush = Brush {
        radius: (0.06 * size) as f32,
        ..Brush::default()
    };
    let areas = [256, 512].map(|side| {
        let atlas = atlas_of(&mesh, side);
        covered_area(
            &mesh,
            &atlas,
            &painted(&surface, &atlas, &[Stroke::new(brush.clone(), points.clone())]),
        )
    });
    assert!((areas[0] / areas[1] - 1.0).abs() < 0.01, "{areas:?}");
}

#[test]
fn a_ghost_shows_what_is_painted_on_the_other_side_of_its_seam() {
    let mesh = mesh_of("crate");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let size = size_of(&mesh);
    let path = |t: f64| size * DVec3::new(0.6 * (2.0 * t - 1.0), 0.6 - 0.5 * t, 0.0);
    let points = drawn(&surface, &bvh, 80, size * DVec3::new(2.0, 2.0, 3.0), path);
    let brush = Brush {
        radius: (0.12 * size) as f32,
        hardness: 0.0,
        ..Brush::default()
    };
    let canvas = painted(&surface, &atlas, &[Stroke::new(brush, points)]);
    let [columns, rows] = atlas.page_size.map(|side| side as usize);
    let (mut compared, mut far) = (0, 0);
    for ghost in &atlas.ghosts {
        let [x, y, page] = ghost.texel.map(|number| number as usize);
        let own = canvas.texel((page * rows + y) * columns + x).cover;
        // The texel that contains the point beyond the seam.
        let chart = &atlas.charts[atlas.triangle_chart[ghost.target_triangle as usize] as usize];
        let [target_x, target_y] = ghost.target_texel.map(|place| place.floor() as usize);
        let target = (chart.page as usize * rows + target_y) * columns + target_x;
        let owner = atlas.owners[target];
        if owner == EMPTY || owner & GHOST_BIT != 0 {
            continue;
        }
        compared += usize::from(own > 0.0);
        far += usize::from((own - canvas.texel(target).cover).abs() > 0.15);
    }
    // Around the tip of a corner, two ways are equally long, and the plane is cut along the one that was found later.
    assert!(compared > 100 && 200 * far < compared, "{far} of {compared}");
}

#[test]
fn erasing_removes_paint_and_hidden_strokes_leave_nothing() {
    let mesh = mesh_of("cube");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 128), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let site = site_seen_from(&mesh, &bvh, DVec3::new(0.1, 0.2, 9.0), DVec3::new(0.1, 0.2, 0.0)).unwrap();
    let point = surface.point(site, 1.0, true).unwrap();
    let brush = Brush {
        radius: 0.3,
        value: 0.5,
        ..Brush::default()
    };
    let paint = Stroke::new(brush, vec![point]);
    let mut hidden = paint.clone();
    hidden.is_hidden = true;
    let mut erase = paint.clone();
    erase.action = Action::Erase;
    erase.brush.radius = 1.0;
    erase.brush.hardness = 1.0;
    let only_painted = painted(&surface, &atlas, std::slice::from_ref(&paint));
    let most = |canvas: &Canvas| canvas.texels().map(|texel| texel.value).fold(0.0, f32::max);
    assert_eq!(most(&only_painted), 0.5);
    assert_eq!(most(&painted(&surface, &atlas, &[hidden])), 0.0);
    assert_eq!(most(&painted(&surface, &atlas, &[paint, erase])), 0.0);
}

#[test]
fn opacity_limits_a_whole_stroke_and_flow_a_single_stamp() {
    let mesh = mesh_of("cube");
    let (index, atlas, bvh) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 128), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let at = |t: f64| DVec3::new(0.4 * (2.0 * t - 1.0), 0.0, 0.0);
    // Passes over the same place three times.
    let there_and_back = |t: f64| at((3.0 * t).min(2.0 - (3.0 * t).min(2.0)).abs());
    let points = drawn(&surface, &bvh, 90, DVec3::Z * 9.0, there_and_back);
    let most = |brush: Brush| {
        let canvas = painted(&surface, &atlas, &[Stroke::new(brush, points.clone())]);
        canvas.texels().map(|texel| texel.cover).fold(0.0, f32::max)
    };
    let brush = Brush {
        radius: 0.2,
        opacity: 0.4,
        ..Brush::default()
    };
    assert_eq!(most(brush.clone()), 0.4);
    let faint = most(Brush {
        flow: 0.01,
        ..brush.clone()
    });
    assert!(faint > 0.01 && faint < 0.35, "{faint}");
    assert!((most(Brush { flow: 0.5, ..brush }) - 0.4).abs() < 1e-3);
}

#[test]
fn strokes_keep_their_places_when_triangles_are_renumbered() {
    let mesh = mesh_of("crate");
    let (index, bvh) = (SurfaceIndex::new(&mesh), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let size = size_of(&mesh);
    let path = |t: f64| size * DVec3::new(0.5 * (2.0 * t - 1.0), 0.3, 0.0);
    let points = drawn(&surface, &bvh, 50, 4.0 * size * DVec3::Z, path);
    let brush = Brush {
        radius: (0.1 * size) as f32,
        ..Brush::default()
    };
    let own = Stroke::new(brush, points);
    let mut reversed = mesh.clone();
    reversed.triangles.reverse();
    reversed.triangle_part.reverse();
    reversed.triangle_material.reverse();
    let other_index = SurfaceIndex::new(&reversed);
    let others = PaintSurface::new(&reversed, &other_index);
    let areas = [(&mesh, &surface), (&reversed, &others)].map(|(mesh, surface)| {
        let atlas = atlas_of(mesh, 256);
        covered_area(mesh, &atlas, &painted(surface, &atlas, std::slice::from_ref(&own)))
    });
    assert!((areas[0] / areas[1] - 1.0).abs() < 0.01, "{areas:?}");
    // Points that are moved slightly are found again by nearness; points that are moved far are lost.
    let moved = |by: f32| {
        let mut moved = mesh.clone();
        moved.positions.iter_mut().for_each(|position| position[2] += by);
        let index = SurfaceIndex::new(&moved);
        let surface = PaintSurface::new(&moved, &index);
        let atlas = atlas_of(&moved, 64);
        Painter::new(&surface, &atlas, Supplies::of_pictures(&StampPictures::new()))
            .paint(&mut Canvas::empty(atlas.owners.len(), VALUE), &own)
    };
    assert_eq!(moved(0.02 * size as f32), 0);
    assert_eq!(moved(10.0 * size as f32), own.points.len());
}
