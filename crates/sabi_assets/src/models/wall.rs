//! The corner of two brick walls on a stone plinth, under a molded cornice. 1.2 m high and wide.

use glam::{DQuat, DVec2, DVec3, dvec2, dvec3};

use super::bar::{Bar, bar, block, miter};
use super::charted_mesh::{self, ChartedMesh, ModelPart};
use super::fixings::chance;
use super::glb::{Material, Model};
use super::outline::{OutlineCorner, offset, rounded};
use super::sweep::{Station, SweepEnds, sweep};

const BRICK: usize = 0;
const MORTAR: usize = 1;
const STONE: usize = 2;

/// A brick and the joint beside it; two thicknesses with a joint are a length, so that the bond closes at the corner.
const LENGTH: f64 = 0.32;
const HEIGHT: f64 = 0.095;
const THICK: f64 = 0.155;
const JOINT: f64 = 0.01;
/// Rows of bricks, and where the lowest stands.
const COURSES: usize = 9;
const FOOT: f64 = 0.13;
/// From the outer corner to a wall's end: three bricks and a half.
const REACH: f64 = 3.5 * (LENGTH + JOINT) - JOINT;

/// The corner.
pub(crate) fn wall() -> Model {
    let top = FOOT + COURSES as f64 * (HEIGHT + JOINT);
    let parts = vec![
        part("plinth", STONE, plan_solid(0.03, 0.0, FOOT - 0.004, 0.012)),
        part("mortar", MORTAR, plan_solid(-0.009, FOOT - 0.02, top + 0.01, 0.0)),
        part("bricks_front", BRICK, bricks(0)),
        part("bricks_left", BRICK, bricks(1)),
        cornice_front(top - 0.002),
        cornice_left(top - 0.002),
    ];
    Model {
        name: "wall",
        paint: Some(damp),
        materials: vec![
            Material::plain("brick", [0.42, 0.17, 0.11]),
            Material::plain("mortar", [0.5, 0.47, 0.42]),
            Material::plain("stone", [0.55, 0.51, 0.44]),
        ],
        parts,
    }
}

/// The damp that rises from the ground, painted by hand as it were: darker and a little green.
fn damp(place: DVec3) -> [f64; 3] {
    let dry = (place.y / 0.45).clamp(0.0, 1.0);
    let wet = (1.0 - dry * dry * (3.0 - 2.0 * dry)) * (1.0 - 0.4 * (place.x * 9.0).sin().abs());
    [1.0 - 0.55 * wet, 1.0 - 0.42 * wet, 1.0 - 0.6 * wet]
}

/// The model's middle is over the origin.
const SHIFT: DVec3 = dvec3(-REACH / 2.0, 0.0, REACH / 2.0);

fn part(name: &str, material: usize, shape: ChartedMesh) -> ModelPart {
    charted_mesh::part(name, material, SHIFT, DQuat::IDENTITY, shape)
}

/// The walls' plan drawn upward, made larger or smaller all around.
fn plan_solid(by: f64, from: f64, to: f64, edge: f64) -> ChartedMesh {
    // Seen from above: x to the right, −z up the page.
    let plan = [
        dvec2(0.0, 0.0),
        dvec2(REACH, 0.0),
        dvec2(REACH, THICK),
        dvec2(THICK, THICK),
        dvec2(THICK, REACH),
        dvec2(0.0, REACH),
    ];
    let turns: Vec<OutlineCorner> = offset(&plan, by)
        .into_iter()
        .map(|at| OutlineCorner {
            at,
            radius: edge,
            seam: true,
        })
        .collect();
    let outline = rounded(&turns, 2, true);
    let station = |y: f64| Station {
        center: DVec3::Y * y,
        side: DVec3::X,
        up: DVec3::NEG_Z,
    };
    let ends = SweepEnds {
        radius: edge * 0.9,
        segments: 2,
    };
    sweep(&outline, &[station(from), station(to)], ends)
}

/// The bricks of the front wall (0) or the left one (1): each laid by hand.
fn bricks(wall: usize) -> ChartedMesh {
    let mut shape = ChartedMesh::default();
    for course in 0..COURSES {
        // The walls take turns in having the corner.
        let has_corner = course % 2 == wall;
        let mut from = if has_corner { 0.0 } else { THICK + JOINT };
        let mut number = 0;
        while from < REACH - 0.01 {
            let length = LENGTH.min(REACH - from);
            let lot = (wall * 1000 + course * 20 + number * 5) as u32;
            let along = from + length / 2.0;
            let y = FOOT + JOINT / 2.0 + HEIGHT / 2.0 + course as f64 * (HEIGHT + JOINT);
            let (at, facing) = if wall == 0 {
                (dvec3(along, y, -THICK / 2.0), 0.0)
            } else {
                (dvec3(THICK / 2.0, y, -along), 90.0)
            };
            let loose = DQuat::from_rotation_y((facing + 0.7 * chance(lot)).to_radians())
                * DQuat::from_rotation_z((0.35 * chance(lot + 1)).to_radians());
            let out = loose * DVec3::Z * (0.003 * chance(lot + 2));
            let brick = Bar::of(length - 0.002 - 0.002 * chance(lot + 3).abs());
            let height = HEIGHT - 0.002 * chance(lot + 4).abs();
            shape.append(block(THICK, height, 0.006, &brick), loose, at + out);
            from += length + JOINT;
            number += 1;
        }
    }
    shape
}

/// The cornice's section about the middle of the wall: a hollow molding below a slab that sheds water to both sides.
fn molding() -> super::outline::Outline {
    let half = THICK / 2.0;
    let side = [
        (half + 0.004, 0.0, 0.004),
        (half + 0.006, 0.022, 0.002),
        (half + 0.014, 0.024, 0.002),
        (half + 0.02, 0.052, 0.022),
        (half + 0.052, 0.062, 0.003),
        (half + 0.054, 0.112, 0.006),
    ];
    let turn = |at: DVec2, radius: f64, seam: bool| OutlineCorner { at, radius, seam };
    let mut turns = vec![turn(DVec2::ZERO, 0.0, true)];
    turns.extend(side.iter().map(|&(x, y, radius)| turn(dvec2(x, y), radius, false)));
    turns.push(turn(dvec2(0.0, 0.13), 0.0, true));
    turns.extend(
        side.iter()
            .rev()
            .map(|&(x, y, radius)| turn(dvec2(-x, y), radius, false)),
    );
    rounded(&turns, 3, true)
}

/// Half the joint at the miter, so that the two stones do not share their edges.
const MITER_GAP: f64 = 0.0006;
const CORNICE_ENDS: SweepEnds = SweepEnds {
    radius: 0.0016,
    segments: 1,
};

/// From the miter at the corner to beyond the front wall's end.
fn cornice_front(y: f64) -> ModelPart {
    let (from, to) = (THICK / 2.0 + MITER_GAP, REACH + 0.04);
    let along = Bar {
        cuts: [miter(-1.0, -1.0), DVec3::X],
        ..Bar::of(to - from)
    };
    ModelPart {
        translation: SHIFT + dvec3((from + to) / 2.0, y, -THICK / 2.0),
        ..part("cornice_front", STONE, bar(&molding(), &along, CORNICE_ENDS))
    }
}

/// The same along the left wall; its x runs toward the front.
fn cornice_left(y: f64) -> ModelPart {
    let (from, to) = (THICK / 2.0 + MITER_GAP, REACH + 0.04);
    let along = Bar {
        cuts: [DVec3::NEG_X, miter(1.0, -1.0)],
        ..Bar::of(to - from)
    };
    ModelPart {
        translation: SHIFT + dvec3(THICK / 2.0, y, -(from + to) / 2.0),
        rotation: DQuat::from_rotation_y(-90f64.to_radians()),
        ..part("cornice_left", STONE, bar(&molding(), &along, CORNICE_ENDS))
    }
}
