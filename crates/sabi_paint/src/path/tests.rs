//! Paths on plates, compared with formulas.

use glam::DVec3;
use sabi_surface::model::Mesh;
use sabi_surface::patch::Site;

use super::*;
use crate::{Area, Brush, SurfaceIndex};

/// Returns a box of side 2 around the origin. Each side has two triangles with corners of their own.
fn cube() -> Mesh {
    let mut mesh = Mesh::default();
    let axes = [
        (DVec3::X, DVec3::Y),
        (DVec3::Y, DVec3::Z),
        (DVec3::Z, DVec3::X),
        (DVec3::Y, DVec3::X),
        (DVec3::Z, DVec3::Y),
        (DVec3::X, DVec3::Z),
    ];
    for (x, y) in axes {
        let normal = x.cross(y);
        let first = mesh.positions.len() as u32;
        for [u, v] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            mesh.positions.push((normal + u * x + v * y).as_vec3().to_array());
            mesh.normals.push(normal.as_vec3().to_array());
            mesh.uvs.push([(0.5 + 0.5 * u) as f32, (0.5 + 0.5 * v) as f32]);
        }
        mesh.triangles
            .extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh.triangle_part = vec![0; 12];
    mesh.triangle_material = vec![0; 12];
    mesh
}

/// Returns a point on the side of the box that faces +z.
fn on_front(surface: &PaintSurface<'_>, x: f64, y: f64) -> StrokePoint {
    let triangle = u32::from(y > x);
    let position = DVec3::new(x, y, 1.0);
    surface.point(Site { triangle, position }, 1.0, false).unwrap()
}

fn with(mesh: &Mesh, test: impl FnOnce(&PaintSurface<'_>)) {
    let index = SurfaceIndex::new(mesh);
    test(&PaintSurface::new(mesh, &index));
}

fn through(knots: Vec<(StrokePoint, Bend)>, is_closed: bool) -> Path {
    let knots = knots.into_iter().map(|(place, bend)| Knot { place, bend });
    Path {
        knots: knots.collect(),
        is_closed,
    }
}

#[test]
fn the_lean_of_a_pen_changes_along_a_path_from_knot_to_knot() {
    with(&cube(), |surface| {
        let leaning = |x: f64, degrees: f32| {
            let place = on_front(surface, x, 0.0);
            let shaft = surface.shaft(place.site, DVec3::Y, degrees);
            (StrokePoint { shaft, ..place }, Bend::Smooth)
        };
        let way = through(vec![leaning(-0.5, 0.0), leaning(0.5, 60.0)], false).way(surface, 0.1);
        let angle = |point: &StrokePoint| point.shaft.unwrap().direction().dot(DVec3::Z).acos().to_degrees();
        assert!((angle(&way[0])).abs() < 0.1 && (angle(&way[way.len() - 1]) - 60.0).abs() < 0.1);
        let middle = way
            .iter()
            .min_by(|a, b| a.site.position.x.abs().total_cmp(&b.site.position.x.abs()));
        assert!((angle(middle.unwrap()) - 30.0).abs() < 1.0);
    });
}

#[test]
fn a_path_stored_as_the_points_of_a_stroke_is_the_same() {
    with(&cube(), |surface| {
        let at = |x, y| on_front(surface, x, y);
        let path = through(
            vec![
                (
                    StrokePoint {
                        starts: true,
                        ..at(0.0, 0.0)
                    },
                    Bend::Smooth,
                ),
                (at(0.5, 0.0), Bend::Corner),
                (at(0.5, 0.5), Bend::Handles([at(0.4, 0.5), at(0.7, 0.5)])),
            ],
            true,
        );
        let (points, form) = path.places();
        assert_eq!(points.len(), 5);
        let mut stroke = Stroke::new(Brush::default(), points);
        assert_eq!(stroke.as_path(), None);
        stroke.path = Some(form);
        assert_eq!(stroke.as_path(), Some(path));
        stroke.points.pop();
        assert_eq!(stroke.as_path(), None);
    });
}

#[test]
fn handles_bend_a_path_as_a_bezier_curve_does() {
    with(&cube(), |surface| {
        let at = |x, y| on_front(surface, x, y);
        let [a, b, c, d] = [at(-0.8, -0.5), at(-0.4, 0.6), at(0.4, 0.6), at(0.8, -0.5)];
        let path = through(vec![(a, Bend::Handles([a, b])), (d, Bend::Handles([c, d]))], false);
        let way = path.way(surface, 0.05);
        let middle = way[way.len() / 2].site.position;
        // The middle of a Bézier curve is (a + 3 b + 3 c + d) / 8.
        assert!(middle.distance(DVec3::new(0.0, 0.325, 1.0)) < 0.03, "{middle}");
        assert!(
            way.windows(2)
                .all(|pair| pair[0].site.position.distance(pair[1].site.position) < 0.07)
        );
    });
}

#[test]
fn a_path_continues_around_a_corner_of_the_model_without_a_gap() {
    with(&cube(), |surface| {
        let beyond = surface.point(
            Site {
                triangle: 3,
                position: DVec3::new(1.0, 0.1, 0.5),
            },
            1.0,
            false,
        );
        let path = through(
            vec![
                (on_front(surface, 0.5, 0.0), Bend::Smooth),
                (beyond.unwrap(), Bend::Smooth),
            ],
            false,
        );
        let way = path.way(surface, 0.02);
        assert!(way.iter().skip(1).all(|point| !point.starts));
        let length: f64 = way
            .windows(2)
            .map(|pair| pair[0].site.position.distance(pair[1].site.position))
            .sum();
        assert!((1.0..1.1).contains(&length), "{length}");
    });
}

#[test]
fn an_edge_path_on_a_box_ends_at_corners_and_a_seam_is_no_material_border() {
    with(&cube(), |surface| {
        let near = DVec3::new(0.2, 0.98, 1.0);
        let edge = Path::along_edges(surface, EdgeKind::Hard, near, 0.1).unwrap();
        let ends: Vec<DVec3> = edge.knots.iter().map(|knot| knot.place.site.position).collect();
        assert_eq!(ends.len(), 2);
        assert!(
            ends.iter()
                .all(|end| end.y == 1.0 && end.z == 1.0 && end.x.abs() == 1.0),
            "{ends:?}"
        );
        assert!(Path::along_edges(surface, EdgeKind::Seam, near, 0.1).is_some());
        assert_eq!(Path::along_edges(surface, EdgeKind::Material, near, 0.1), None);
        assert_eq!(Path::along_edges(surface, EdgeKind::Hard, DVec3::Z, 0.5), None);
    });
}

#[test]
fn the_border_of_a_material_leads_around_it() {
    let mut mesh = cube();
    mesh.triangle_material[0] = 1;
    mesh.triangle_material[1] = 1;
    with(&mesh, |surface| {
        let path = Path::along_edges(surface, EdgeKind::Material, DVec3::new(0.0, 1.0, 1.0), 0.1).unwrap();
        assert!(path.is_closed);
        assert_eq!(path.knots.len(), 4);
        assert!(path.knots.iter().all(|knot| knot.bend == Bend::Corner));
        let way = path.way(surface, 0.1);
        let length: f64 = way
            .windows(2)
            .map(|pair| pair[0].site.position.distance(pair[1].site.position))
            .sum();
        assert!((length - 8.0).abs() < 1e-6, "{length}");
    });
}

#[test]
fn a_stroke_becomes_a_path_of_few_knots_near_it() {
    with(&cube(), |surface| {
        let points: Vec<StrokePoint> = (0..60)
            .map(|index| {
                let x = -0.9 + 1.8 * f64::from(index) / 59.0;
                on_front(surface, x, 0.3 * (4.0 * x).sin())
            })
            .collect();
        let drawn = Stroke {
            area: Area::Ribbon,
            ..Stroke::new(
                Brush {
                    radius: 0.08,
                    ..Brush::default()
                },
                points,
            )
        };
        let path = Path::of_stroke(&drawn).unwrap();
        assert!((4..20).contains(&path.knots.len()), "{}", path.knots.len());
        for place in path.way(surface, 0.02) {
            let place = place.site.position;
            let nearest = drawn.points.iter().map(|point| point.site.position.distance(place));
            assert!(nearest.fold(f64::INFINITY, f64::min) < 0.08);
        }
    });
}

#[test]
fn a_stroke_of_several_runs_and_one_of_too_many_knots_are_no_paths() {
    with(&cube(), |surface| {
        let mut points: Vec<StrokePoint> = (0..4)
            .map(|at| on_front(surface, 0.1 * f64::from(at) - 0.2, 0.0))
            .collect();
        let mut stroke = Stroke::new(Brush::default(), points.clone());
        assert!(Path::of_stroke(&stroke).is_some());
        points[2].starts = true;
        stroke.points = points;
        assert!(Path::of_stroke(&stroke).is_none());
        stroke.points = vec![on_front(surface, 0.0, 0.0); 5000];
        stroke.path = Some(PathForm {
            knots: "s".repeat(5000),
            closed: false,
        });
        assert!(stroke.as_path().is_none());
    });
}

#[test]
fn other_knots_are_kept_if_some_are_lost() {
    with(&cube(), |surface| {
        let at = |x, y| on_front(surface, x, y);
        let path = through(
            vec![
                (at(0.0, 0.0), Bend::Smooth),
                (at(0.5, 0.0), Bend::Handles([at(0.4, 0.0), at(0.6, 0.0)])),
                (at(0.9, 0.0), Bend::Corner),
            ],
            false,
        );
        let (moved, lost) =
            path.moved(|point| (point.site.position.x != 0.4 && point.site.position.x < 0.8).then_some(*point));
        assert_eq!((moved.knots.len(), lost), (2, 1));
        assert_eq!(moved.knots[1].bend, Bend::Smooth);
    });
}

#[test]
fn a_path_over_the_boards_of_a_crate_follows_the_straight_way_seen_from_the_front() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes/crate.glb");
    let options = sabi_surface::load::LoadOptions::default();
    let mesh = sabi_surface::load::load(&file, &options).unwrap().mesh;
    with(&mesh, |surface| {
        let (low, high) =
            surface
                .mesh()
                .positions
                .iter()
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| {
                    (
                        low.min(DVec3::from(at.map(f64::from))),
                        high.max(DVec3::from(at.map(f64::from))),
                    )
                });
        let size = high - low;
        let seen = |x: f64, y: f64| {
            let eye = low + size * DVec3::new(x, y, 0.0) + DVec3::new(0.0, 0.0, 3.0 * size.z);
            let hit = surface.bvh().closest(eye.as_vec3().to_array(), [0.0, 0.0, -1.0], 1e3)?;
            let position = surface.mesh().position(hit.triangle, hit.barycentric.map(f64::from));
            let triangle = hit.triangle;
            surface.point(Site { triangle, position }, 1.0, false)
        };
        let mut compared = 0;
        for step in 0..20 {
            let x = 0.1 + 0.01 * f64::from(step);
            let (Some(from), Some(to)) = (seen(x, 0.7), seen(x + 0.55, 0.45)) else {
                continue;
            };
            compared += 1;
            let path = through(vec![(from, Bend::Smooth), (to, Bend::Smooth)], false);
            let [a, b] = [from, to].map(|point| point.site.position.truncate());
            for place in path.way(surface, 0.02 * size.x) {
                let at = place.site.position.truncate();
                let share = (at - a).dot(b - a) / (b - a).length_squared();
                let beside = at.distance(a.lerp(b, share));
                assert!(
                    beside < 0.06 * size.x && !(place.starts && share > 0.0),
                    "{beside} at {share} of {step}"
                );
            }
        }
        assert!(compared > 12, "{compared}");
    });
}
