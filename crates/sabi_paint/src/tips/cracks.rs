//! Cracks: a branching one, and the net of dried paint.

use glam::{DVec2, DVec3};

use super::noise::{RandomSequence, noise_2, noise_3, place_in, smooth_step, toward, turned};
use super::spot::Spot;

/// Most straight parts of a branching crack.
const PARTS: usize = 150;
/// Cells of dried paint along a radius.
const CELLS: f64 = 3.3;
/// Minimum distance of a cell's middle from its borders, along each axis.
const LEAST: f64 = 0.14;
const MOST: f64 = 0.86;

/// A straight part of a crack that narrows along its way.
#[derive(Clone, Copy)]
struct CrackSegment {
    from: DVec2,
    way: DVec2,
    halves: [f64; 2],
}

/// Parts of one branch, within a disk.
struct Branch {
    middle: DVec2,
    reach: f64,
    parts: Vec<CrackSegment>,
}

/// Start of a branch that has not grown yet.
struct Bud {
    at: DVec2,
    angle: f64,
    half: f64,
    length: f64,
    order: u32,
}

/// Grows a branch; adds the buds of its own branches.
fn branch(bud: &Bud, dice: &mut RandomSequence, buds: &mut Vec<Bud>) -> Branch {
    let (mut at, mut angle, mut grown) = (bud.at, bud.angle, 0.0);
    let half_at = |grown: f64| bud.half * (1.0 - 0.85 * grown / bud.length).max(0.0);
    let mut parts = Vec::new();
    while grown < bud.length && at.length() < 0.93 {
        let step = dice.between(0.035, 0.1);
        // Jagged, but in the same general direction.
        let kink = angle + dice.between(-0.75, 0.75) * dice.unit().sqrt();
        angle += 0.25 * (bud.angle - angle) + dice.between(-0.22, 0.22);
        let way = step * toward(kink);
        if (at + way).length() > 0.95 {
            break;
        }
        parts.push(CrackSegment {
            from: at,
            way,
            halves: [half_at(grown), half_at(grown + step)],
        });
        at += way;
        grown += step;
        if bud.order < 3 && dice.unit() < [0.42, 0.36, 0.22][bud.order as usize] {
            let side = if dice.unit() < 0.5 { 1.0 } else { -1.0 };
            buds.push(Bud {
                at,
                angle: kink + side * dice.between(0.45, 1.25),
                half: half_at(grown) * dice.between(0.45, 0.75),
                length: (bud.length - 0.5 * grown) * dice.between(0.3, 0.7),
                order: bud.order + 1,
            });
        }
    }
    let places = || parts.iter().flat_map(|part| [part.from, part.from + part.way]);
    let middle = places().sum::<DVec2>() / (2 * parts.len()).max(1) as f64;
    let reach = places().map(|place| place.distance(middle)).fold(0.0, f64::max);
    Branch { middle, reach, parts }
}

/// A crack that branches from the middle outward.
pub(super) fn cracks(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let first = std::f64::consts::TAU * dice.unit();
    let middle = dice.in_disk(0.18);
    let arms = if dice.unit() < 0.4 { 3 } else { 2 };
    let mut buds = Vec::new();
    for arm in 0..arms {
        buds.push(Bud {
            at: middle,
            angle: first + std::f64::consts::TAU * f64::from(arm) / f64::from(arms) + dice.between(-0.45, 0.45),
            half: if arm < 2 { 0.024 } else { 0.016 },
            length: dice.between(0.75, 1.15),
            order: 0,
        });
    }
    let (mut branches, mut count) = (Vec::new(), 0);
    while !buds.is_empty() && count < PARTS {
        let bud = buds.remove(0);
        let grown = branch(&bud, &mut dice, &mut buds);
        count += grown.parts.len();
        branches.push(grown);
    }
    move |spot| {
        let place = 15.0 * spot.q + offset;
        let warp = DVec2::new(noise_2(place, 1), noise_2(place, 2)) - 0.5;
        let q = spot.q + 0.024 * warp;
        let mut most: f64 = 0.0;
        for branch in &branches {
            let reach = branch.reach + 0.03 + spot.texel;
            if q.distance_squared(branch.middle) > reach * reach {
                continue;
            }
            for part in &branch.parts {
                let own = q - part.from;
                let t = (own.dot(part.way) / part.way.length_squared()).clamp(0.0, 1.0);
                let square = (own - t * part.way).length_squared();
                let half = part.halves[0] + t * (part.halves[1] - part.halves[0]);
                let reach = half + spot.texel;
                if square < reach * reach {
                    most = most.max(spot.line(square.sqrt(), half));
                }
            }
        }
        most * spot.fall
    }
}

/// Returns the 27 cells around a place, the nearest first. Along each axis, 0 means the cell of the place, 1 its nearer
/// neighbor, and 2 the neighbor on the other side.
fn neighbors() -> [[usize; 3]; 27] {
    let mut all: [[usize; 3]; 27] = std::array::from_fn(|index| [index % 3, index / 3 % 3, index / 9]);
    all.sort_by_key(|sides| sides.iter().map(|side| side * side).sum::<usize>());
    all
}

/// Net of cracks in dried paint that stays where it is on the model.
pub(super) fn crackle() -> impl Fn(&Spot) -> f64 {
    let neighbors = neighbors();
    move |spot| {
        let place = spot.model * CELLS;
        let rough = noise_3(3.1 * place, 21) - 0.5;
        let cells = turned(place) + 0.2 * rough;
        let home = cells.floor();
        let mut near = [(f64::INFINITY, DVec3::ZERO, 0.0); 2];
        // For each axis: squares of the smallest distances to the middles of cells, and the steps to these cells.
        let sides = (cells - home).to_array().map(|t| {
            let (before, after) = (t + 1.0 - MOST, 1.0 - t + LEAST);
            let sides = [(before * before, -1.0), (after * after, 1.0)];
            if t < 0.5 {
                [(0.0, 0.0), sides[0], sides[1]]
            } else {
                [(0.0, 0.0), sides[1], sides[0]]
            }
        });
        for [i, j, k] in neighbors {
            let [x, y, z] = [sides[0][i], sides[1][j], sides[2][k]];
            if x.0 + y.0 + z.0 > near[1].0 {
                continue;
            }
            let cell = home + DVec3::new(x.1, y.1, z.1);
            let own = place_in(23, cell);
            let way = cell + LEAST + (MOST - LEAST) * own - cells;
            let found = (way.length_squared(), way, own.dot(DVec3::new(7.0, 3.0, 5.0)));
            if found.0 < near[0].0 {
                near = [found, near[0]];
            } else if found.0 < near[1].0 {
                near[1] = found;
            }
        }
        let [first, second] = near;
        // Distance to the wall between the two nearest cells, along the surface.
        let wall = second.1 - first.1;
        let slant = wall.dot(turned(spot.normal));
        let flat = (wall.length_squared() - slant * slant).sqrt().max(1e-9);
        let distance = 0.5 * (second.0 - first.0) / flat / CELLS;
        // The same number on both sides of a crack. Cracks are wide, fine, or not open yet.
        let own = (first.2 + second.2).fract();
        let open = (spot.fall * 1.7 - 0.8 * own).clamp(0.0, 1.0);
        let half = (0.007 + 0.02 * (1.0 - own) * (0.4 + 1.2 * (rough + 0.5))) * open;
        // Edges of the cells curl up.
        let curl = 0.16 * (1.0 - smooth_step(distance, 0.05, 0.05)) * open;
        let line = spot.line(distance, half) * (8.0 * open).min(1.0);
        line.max(curl * spot.fall)
    }
}
