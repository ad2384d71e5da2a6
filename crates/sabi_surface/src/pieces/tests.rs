use glam::{DMat3, DVec3, Vec3, dvec3};

use super::tightest::piece_box;
use super::{PieceBox, Pieces};
use crate::model::Mesh;

/// A triangle and its part.
type Loose = (u32, [DVec3; 3]);
type Soup = Vec<Loose>;

/// Creates a mesh from separate triangles. Every corner is a vertex of its own, as with hard edges.
fn mesh(triangles: &[Loose]) -> Mesh {
    let mut mesh = Mesh::default();
    for (part, corners) in triangles {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(corners.map(|corner| corner.as_vec3().to_array()));
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.triangle_part.push(*part);
    }
    mesh
}

/// Both triangles of a face, counter-clockwise.
fn quad([a, b, c, d]: [DVec3; 4]) -> [[DVec3; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Creates a box from one corner to the other, with each face divided into `cuts` strips.
fn solid(low: DVec3, high: DVec3, cuts: usize) -> Vec<[DVec3; 3]> {
    let size = high - low;
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let side = |at: usize| DVec3::AXES[(axis + at) % 3] * size[(axis + at) % 3];
        let (out, first, second) = (side(0), side(1), side(2));
        for cut in 0..cuts {
            let [from, to] = [cut, cut + 1].map(|cut| first * (cut as f64 / cuts as f64));
            let strip = [from, to, to + second, from + second];
            triangles.extend(quad(strip.map(|corner| low + out + corner)));
            let [a, b, c, d] = strip.map(|corner| low + corner);
            triangles.extend(quad([a, d, c, b]));
        }
    }
    triangles
}

fn of_part(part: u32, triangles: Vec<[DVec3; 3]>) -> Soup {
    triangles.into_iter().map(|corners| (part, corners)).collect()
}

fn turned(triangles: Vec<[DVec3; 3]>, turn: DMat3) -> Vec<[DVec3; 3]> {
    triangles
        .into_iter()
        .map(|corners| corners.map(|corner| turn * corner))
        .collect()
}

fn pieces(triangles: Vec<[DVec3; 3]>) -> Pieces {
    Pieces::of(&mesh(&of_part(0, triangles)))
}

const BOARD: DVec3 = dvec3(1.0, 0.1, 0.025);

/// A turn by some degrees about two axes.
fn turn(about_z: f64, about_x: f64) -> DMat3 {
    DMat3::from_rotation_x(about_x.to_radians()) * DMat3::from_rotation_z(about_z.to_radians())
}

/// A ball of triangles around the origin.
fn ball(rings: usize) -> Vec<[DVec3; 3]> {
    let at = |ring: usize, step: usize| {
        let (down, around) = (
            std::f64::consts::PI * ring as f64 / rings as f64,
            std::f64::consts::TAU * (step % (2 * rings)) as f64 / (2 * rings) as f64,
        );
        dvec3(down.sin() * around.cos(), down.cos(), down.sin() * around.sin())
    };
    let steps = (0..rings).flat_map(|ring| (0..2 * rings).map(move |step| (ring, step)));
    steps
        .flat_map(|(ring, step)| {
            quad([
                at(ring, step),
                at(ring, step + 1),
                at(ring + 1, step + 1),
                at(ring + 1, step),
            ])
        })
        .collect()
}

/// Name, triangles, and the axes and side lengths of the box.
type BoxCase = (&'static str, Vec<[DVec3; 3]>, [DVec3; 3], DVec3);

fn cases() -> Vec<BoxCase> {
    let upright = DMat3::IDENTITY;
    let board = |turn: DMat3| turned(solid(-BOARD / 2.0, BOARD / 2.0, 1), turn);
    let [x, y, z] = DVec3::AXES;
    let flat = |turn: DMat3| {
        let corners = [[-2.0, -0.5], [2.0, -0.5], [2.0, 0.5], [-2.0, 0.5]].map(|[x, y]| turn * dvec3(x, y, 0.0));
        quad(corners).to_vec()
    };
    let square_bar = dvec3(1.0, 0.1, 0.1);
    vec![
        ("cube", solid(-DVec3::ONE, DVec3::ONE, 1), [x, y, z], DVec3::splat(2.0)),
        ("ball", ball(12), [x, y, z], DVec3::splat(2.0)),
        ("board", board(upright), [x, y, z], BOARD),
        (
            "board along y",
            solid(DVec3::ZERO, dvec3(0.1, 1.0, 0.025), 1),
            [y, x, -z],
            BOARD,
        ),
        (
            "board along z",
            solid(DVec3::ZERO, dvec3(0.025, 0.1, 1.0), 1),
            [z, y, -x],
            BOARD,
        ),
        ("board at 37°", board(turn(37.0, 0.0)), turn(37.0, 0.0).to_cols(), BOARD),
        // The first of the second axis' equal components decides its sign, so it points down.
        (
            "board at 45°",
            board(turn(45.0, 0.0)),
            [turn(45.0, 0.0) * x, turn(45.0, 0.0) * -y, -z],
            BOARD,
        ),
        (
            "board at 37° and 20°",
            board(turn(37.0, 20.0)),
            turn(37.0, 20.0).to_cols(),
            BOARD,
        ),
        (
            "square bar at 30° and 20°",
            turned(solid(-square_bar, square_bar, 1), turn(30.0, 20.0)),
            turn(30.0, 20.0).to_cols(),
            2.0 * square_bar,
        ),
        ("flat", flat(upright), [x, y, z], dvec3(4.0, 1.0, 0.0)),
        (
            "flat at 20° and 30°",
            flat(turn(20.0, 30.0)),
            turn(20.0, 30.0).to_cols(),
            dvec3(4.0, 1.0, 0.0),
        ),
    ]
}

#[test]
fn the_box_is_oriented_like_the_piece() {
    // Tolerances are those of positions in f32.
    for (name, triangles, axes, size) in cases() {
        let found = pieces(triangles);
        assert_eq!(found.boxes.len(), 1, "{name}");
        let around = found.boxes[0];
        let near = |a: Vec3, b: DVec3| (a.as_dvec3() - b).length() < 1e-5;
        // A ball made of triangles is slightly smaller than an exact ball.
        let size_slack = if name == "ball" { 0.02 } else { 1e-5 };
        let off = (Vec3::from(around.size).as_dvec3() - size).length();
        assert!(off < size_slack, "{name}: {:?}, not {size}", around.size);
        for (at, axis) in axes.into_iter().enumerate() {
            assert!(
                near(around.axes[at].into(), axis),
                "{name}: {:?}, not {axes:?}",
                around.axes
            );
        }
    }
}

trait Columns {
    fn to_cols(self) -> [DVec3; 3];
}

impl Columns for DMat3 {
    fn to_cols(self) -> [DVec3; 3] {
        [self.x_axis, self.y_axis, self.z_axis]
    }
}

/// Returns the box around all triangles, whether they are connected or not.
fn around(triangles: Vec<[DVec3; 3]>) -> PieceBox {
    let mesh = mesh(&of_part(0, triangles));
    let all: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
    piece_box(&mesh, &all)
}

#[test]
fn a_box_does_not_depend_on_the_triangulation() {
    let at = turn(33.0, 12.0);
    let board = |cuts| around(turned(solid(DVec3::ZERO, BOARD, cuts), at));
    let (coarse, fine) = (board(1), board(9));
    for axis in 0..3 {
        let [a, b] = [coarse, fine].map(|around| Vec3::from(around.axes[axis]));
        assert!((a - b).length() < 1e-5, "{:?} and {:?}", coarse.axes, fine.axes);
    }
    assert!((Vec3::from(coarse.center) - Vec3::from(fine.center)).length() < 1e-6);
}

#[test]
fn a_block_on_a_corner_does_not_rotate_the_box_of_a_board() {
    // The principal axes of such a board are skewed, but its sides are not.
    let mut triangles = solid(DVec3::ZERO, BOARD, 1);
    triangles.extend(solid(dvec3(0.7, 0.05, 0.025), dvec3(1.0, 0.1, 0.08), 1));
    let at = turn(25.0, 40.0);
    let off = (Vec3::from(around(turned(triangles, at)).axes[0]).as_dvec3() - at.x_axis).length();
    assert!(off < 1e-5, "the longest axis leaves the board by {off}");
}

#[test]
fn a_single_triangle_has_a_box_and_its_longest_side_is_the_first_axis() {
    let found = pieces(vec![[DVec3::ZERO, dvec3(3.0, 0.0, 0.0), dvec3(0.0, 1.0, 0.0)]]);
    assert_eq!(found.boxes.len(), 1);
    let around = found.boxes[0];
    assert!(around.size[0] >= around.size[1] && around.size[2] == 0.0, "{around:?}");
    let nothing = pieces(vec![[DVec3::ONE; 3]]);
    assert_eq!(nothing.boxes[0].size, [0.0; 3]);
    assert_eq!(nothing.boxes[0].center, [1.0; 3]);
}

#[test]
fn connected_triangles_are_one_piece_and_touching_solids_are_not() {
    let block = |x: f64, part: u32| of_part(part, solid(dvec3(x, 0.0, 0.0), dvec3(x + 1.0, 1.0, 0.5), 1));
    let sheet = |over: bool| {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| dvec3(x, y, 0.0));
        let [a, b, c, d] = corners;
        of_part(0, quad(if over { corners } else { [a, d, c, b] }).to_vec())
    };
    let join = |many: Vec<Soup>| many.concat();
    let line = vec![(0, [DVec3::ZERO, dvec3(1.0, 0.0, 0.0), DVec3::ZERO])];
    let cases: Vec<(&str, Soup, usize)> = vec![
        ("one", block(0.0, 0), 1),
        ("two apart", join(vec![block(0.0, 0), block(2.0, 0)]), 2),
        (
            "two that share a whole face in space",
            join(vec![block(0.0, 0), block(1.0, 0)]),
            2,
        ),
        (
            "three in a row",
            join(vec![block(0.0, 0), block(1.0, 0), block(2.0, 0)]),
            3,
        ),
        (
            "two parts that share a face",
            join(vec![block(0.0, 0), block(1.0, 1)]),
            2,
        ),
        (
            "two that share an edge only",
            join(vec![
                block(0.0, 0),
                of_part(0, solid(dvec3(1.0, 1.0, 0.0), dvec3(2.0, 2.0, 0.5), 1)),
            ]),
            2,
        ),
        ("a sheet with two sides", join(vec![sheet(true), sheet(false)]), 1),
        ("a triangle that is a line", join(vec![block(0.0, 0), line]), 1),
    ];
    for (name, triangles, count) in cases {
        let found = Pieces::of(&mesh(&triangles));
        assert_eq!(found.boxes.len(), count, "{name}");
        for (piece, (part, _)) in found.triangle_piece.iter().zip(&triangles) {
            assert_eq!(found.boxes[*piece as usize].part, *part, "{name}");
        }
    }
}

/// Creates wedges around one edge, each with `layers` triangles on each of its faces.
fn fan(wedges: u32, layers: u32) -> Vec<[DVec3; 3]> {
    let place = |at: u32| {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(at) / f64::from(2 * wedges)).sin_cos();
        dvec3(cosine, sine, 0.5)
    };
    let face = |at: u32| match at % 2 {
        0 => [DVec3::Z, DVec3::ZERO, place(at)],
        _ => [DVec3::ZERO, DVec3::Z, place(at)],
    };
    (0..2 * wedges)
        .flat_map(|at| std::iter::repeat_n(face(at), layers as usize))
        .collect()
}

#[test]
fn wedges_around_an_edge_stay_separate_however_many_triangles_share_it() {
    // The solid of each wedge is between an even face and the next odd one. Comparing all pairs would take minutes for the last case.
    for (wedges, layers) in [(2, 1), (3, 1), (500, 1), (500, 100)] {
        let pieces = pieces(fan(wedges, layers));
        assert_eq!(pieces.boxes.len(), wedges as usize, "{wedges} wedges, {layers} layers");
        for (triangle, &piece) in pieces.triangle_piece.iter().enumerate() {
            assert_eq!(
                piece,
                triangle as u32 / (2 * layers),
                "triangle {triangle} of {wedges} wedges"
            );
        }
    }
}
