//! A shipping crate: boards between battens, a brace on each side, iron nails. 0.7 m wide.

use std::f64::consts::FRAC_PI_2;

use glam::{DMat3, DQuat, DVec3, dvec3};

use super::bar::{Bar, timber};
use super::charted_mesh::{ChartedMesh, ModelPart, part};
use super::fixings::{chance, head, lying_along, standing_on};
use super::glb::{Material, Model};

const WOOD: usize = 0;
const IRON: usize = 1;

/// Outer width and depth, and height without lid and skids.
const WIDTH: f64 = 0.7;
const HEIGHT: f64 = 0.56;
/// Thickness of a board and of a batten, and a batten's width.
const BOARD: f64 = 0.018;
const BATTEN: f64 = 0.024;
const BROAD: f64 = 0.075;
/// Height of the skids below the bottom.
const SKID: f64 = 0.045;

/// Parts and nails while the crate is built.
#[derive(Default)]
struct CrateParts {
    parts: Vec<ModelPart>,
    nails: ChartedMesh,
}

impl CrateParts {
    fn part(&mut self, name: String, translation: DVec3, rotation: DQuat, shape: ChartedMesh) {
        self.parts.push(part(name, WOOD, translation, rotation, shape));
    }

    fn nail(&mut self, at: DVec3, out: DVec3) {
        self.nails.append(head(0.0065, 0.0032, 8), standing_on(out), at);
    }
}

/// The crate.
pub(crate) fn crate_box() -> Model {
    let mut work = CrateParts::default();
    for (number, name) in ["front", "right", "back", "left"].into_iter().enumerate() {
        side(&mut work, name, number);
    }
    bottom(&mut work);
    lid(&mut work);
    let CrateParts { mut parts, nails } = work;
    parts.push(ModelPart {
        material: IRON,
        ..ModelPart::new("nails", nails)
    });
    Model {
        name: "crate",
        paint: None,
        materials: vec![Material::plain("wood", [0.5, 0.36, 0.22]), Material::iron()],
        parts,
    }
}

/// Upright: x to y.
fn upright() -> DQuat {
    DQuat::from_mat3(&DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z))
}

/// One side in the plane of x and y, facing z, then turned into place: four boards, a frame of battens, a brace.
fn side(work: &mut CrateParts, name: &str, number: usize) {
    let turn = DQuat::from_rotation_y(FRAC_PI_2 * number as f64);
    let is_narrow = number % 2 == 1;
    let inner = WIDTH - 2.0 * BATTEN - if is_narrow { 2.0 * BOARD } else { 0.0 };
    let outer = if is_narrow { WIDTH - 2.0 * BATTEN } else { WIDTH };
    let (board_z, batten_z) = (WIDTH / 2.0 - BATTEN - BOARD / 2.0, WIDTH / 2.0 - BATTEN / 2.0);
    let place = |at: DVec3| turn * (at + DVec3::Y * SKID);
    let broad = inner / 4.0;
    for i in 0..4 {
        let lot = (number * 40 + i * 4) as u32;
        let x = (i as f64 - 1.5) * broad;
        let lean = DQuat::from_rotation_z((0.25 * chance(lot)).to_radians());
        let along = Bar::of(HEIGHT - 0.004 - 0.004 * chance(lot + 1).abs());
        let shape = timber(BOARD, broad - 0.004, 0.003, &along);
        let at = dvec3(x, HEIGHT / 2.0, board_z + 0.0015 * chance(lot + 2));
        work.part(format!("{name}_board_{i}"), place(at), turn * lean * upright(), shape);
    }
    for (end, y) in [("bottom", BROAD / 2.0), ("top", HEIGHT - BROAD / 2.0)] {
        let shape = timber(BATTEN, BROAD, 0.004, &Bar::of(outer - 0.002));
        work.part(
            format!("{name}_batten_{end}"),
            place(dvec3(0.0, y, batten_z)),
            turn,
            shape,
        );
        for i in 0..4 {
            let lot = (number * 90 + i * 2) as u32 + if end == "top" { 45 } else { 0 };
            let at = dvec3(
                (f64::from(i as u32) - 1.5) * broad + 0.012 * chance(lot),
                y + 0.018 * chance(lot + 1),
                WIDTH / 2.0,
            );
            work.nail(place(at), turn * DVec3::Z);
        }
    }
    let between = HEIGHT - 2.0 * BROAD;
    let stile_x = outer / 2.0 - BROAD / 2.0;
    for (end, x) in [("left", -stile_x), ("right", stile_x)] {
        let shape = timber(BATTEN - 0.002, BROAD, 0.004, &Bar::of(between - 0.002));
        let at = dvec3(x, HEIGHT / 2.0, batten_z - 0.001);
        work.part(format!("{name}_stile_{end}"), place(at), turn * upright(), shape);
    }
    // From the lower left corner of the frame to the upper right one, cut level where it meets the battens.
    let reach = dvec3(2.0 * (stile_x - BROAD), between, 0.0);
    let direction = reach.normalize_or_zero();
    let own = lying_along(direction);
    let level = own.inverse() * DVec3::Y;
    let along = Bar {
        cuts: [-level, level],
        ..Bar::of(reach.length() - 0.003)
    };
    let shape = timber(BATTEN - 0.004, BROAD * 0.9, 0.004, &along);
    let at = dvec3(0.0, HEIGHT / 2.0, batten_z - 0.002);
    work.part(format!("{name}_brace"), place(at), turn * own, shape);
}

/// Boards between the sides, and two skids below.
fn bottom(work: &mut CrateParts) {
    let inner = WIDTH - 2.0 * BATTEN - 2.0 * BOARD;
    let broad = inner / 4.0;
    for i in 0..4 {
        let z = (f64::from(i) - 1.5) * broad;
        let shape = timber(broad - 0.004, BOARD, 0.003, &Bar::of(inner - 0.004));
        work.part(
            format!("bottom_board_{i}"),
            dvec3(0.0, SKID + BOARD / 2.0, z),
            DQuat::IDENTITY,
            shape,
        );
    }
    for (name, x) in [("left", -0.22), ("right", 0.22)] {
        let shape = timber(0.08, SKID - 0.002, 0.006, &Bar::of(WIDTH - 0.02));
        let turn = lying_along(DVec3::Z);
        work.part(format!("skid_{name}"), dvec3(x, SKID / 2.0 - 0.001, 0.0), turn, shape);
    }
}

/// Five boards along x, the last one pried loose, and two battens across them.
fn lid(work: &mut CrateParts) {
    let top = SKID + HEIGHT;
    let broad = WIDTH / 5.0;
    for i in 0..5 {
        let lot = 300 + i as u32 * 3;
        let z = (f64::from(i) - 2.0) * broad;
        let shape = timber(broad - 0.005, BOARD, 0.003, &Bar::of(WIDTH + 0.008 * chance(lot)));
        let at = dvec3(0.004 * chance(lot + 1), top + BOARD / 2.0 + 0.001, z);
        let askew = if i == 4 { 1.6 } else { 0.2 * chance(lot + 2) };
        let turn = DQuat::from_rotation_y(askew.to_radians());
        work.part(format!("lid_board_{i}"), at, turn, shape);
    }
    for (name, x) in [("left", -0.24), ("right", 0.24)] {
        let y = top + BOARD + BATTEN / 2.0;
        let shape = timber(BROAD, BATTEN, 0.004, &Bar::of(WIDTH - 0.03));
        work.part(
            format!("lid_batten_{name}"),
            dvec3(x, y, 0.0),
            lying_along(DVec3::Z),
            shape,
        );
        for i in 0..5 {
            let lot = 400 + i as u32 * 2 + if x > 0.0 { 20 } else { 0 };
            let at = dvec3(
                x + 0.015 * chance(lot),
                y + BATTEN / 2.0,
                (f64::from(i) - 2.0) * broad * 0.95 + 0.01 * chance(lot + 1),
            );
            work.nail(at, DVec3::Y);
        }
    }
}
