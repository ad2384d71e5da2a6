//! An owl of smooth solids melted together: the organic model. A ball is shrunk onto it, so its charts stay six.

use glam::{DQuat, DVec2, DVec3, dvec3};

use super::ball::Skin;
use super::charted_mesh::{ChartedMesh, Corner, ModelPart};
use super::glb::{Material, Model};

/// Height of the figure without its ears, in meters; the solids below are for a height of 1.
const SCALE: f64 = 0.4;
/// Inside the chest, where the ball is centered before it shrinks.
const HEART: DVec3 = dvec3(0.0, 0.45, 0.0);
/// Quads along the edge of a chart.
pub(crate) const STEPS: usize = 44;
/// Number of relaxation steps of the charts.
const UNROLL_ROUNDS: usize = 300;

/// An ellipsoid and how softly it melts into what stands before it.
struct Lump {
    center: DVec3,
    radii: DVec3,
    turn: DQuat,
    melt: f64,
}

impl Lump {
    /// Approximate signed distance (Quílez' bound for ellipsoids).
    fn distance(&self, point: DVec3) -> f64 {
        let own = self.turn.inverse() * (point - self.center);
        let near = (own / self.radii).length();
        let steep = (own / (self.radii * self.radii)).length();
        near * (near - 1.0) / steep.max(1e-9)
    }
}

/// Smooth minimum with a blend of width `melt` (cubic).
fn melted(a: f64, b: f64, melt: f64) -> f64 {
    let h = (melt - (a - b).abs()).max(0.0) / melt;
    a.min(b) - h * h * h * melt / 6.0
}

/// Center, radii, turn about x and z in degrees, melt.
type EllipsoidRow = ([f64; 3], [f64; 3], [f64; 2], f64);

/// Body, belly, head, tail and beak, in the order in which they melt together with what comes between.
const MIDDLE: [EllipsoidRow; 5] = [
    ([0.0, 0.36, 0.0], [0.27, 0.38, 0.235], [0.0, 0.0], 0.1),
    ([0.0, 0.34, 0.07], [0.2, 0.28, 0.2], [0.0, 0.0], 0.05),
    ([0.0, 0.745, 0.02], [0.25, 0.19, 0.2], [0.0, 0.0], 0.1),
    ([0.0, 0.1, -0.2], [0.12, 0.2, 0.075], [30.0, 0.0], 0.12),
    ([0.0, 0.72, 0.215], [0.04, 0.07, 0.06], [-14.0, 0.0], 0.035),
];
/// Wing, foot, ear, eye ring and eye of the right side; the left side is its mirror.
const SIDE: [EllipsoidRow; 5] = [
    ([0.235, 0.4, -0.03], [0.085, 0.26, 0.175], [8.0, 4.0], 0.045),
    ([0.12, 0.03, 0.16], [0.095, 0.075, 0.13], [0.0, 0.0], 0.11),
    ([0.165, 0.905, 0.02], [0.07, 0.13, 0.055], [0.0, -26.0], 0.08),
    ([0.108, 0.775, 0.165], [0.115, 0.112, 0.055], [-8.0, 0.0], 0.03),
    ([0.104, 0.785, 0.19], [0.062, 0.062, 0.062], [0.0, 0.0], 0.025),
];

fn lumps() -> Vec<Lump> {
    let lump = |&(center, radii, degrees, melt): &EllipsoidRow, side: f64| Lump {
        center: DVec3::from(center) * dvec3(side, 1.0, 1.0),
        radii: radii.into(),
        turn: DQuat::from_rotation_x(degrees[0].to_radians())
            * DQuat::from_rotation_z((degrees[1] * side).to_radians()),
        melt,
    };
    let sides = [-1.0, 1.0]
        .into_iter()
        .flat_map(|side| SIDE.iter().map(move |row| lump(row, side)));
    MIDDLE[..4]
        .iter()
        .map(|row| lump(row, 1.0))
        .chain(sides)
        .chain([lump(&MIDDLE[4], 1.0)])
        .collect()
}

/// Signed distance to the owl that stands on y = 0, roughly; `softness` multiplies how far its lumps melt.
fn owl(lumps: &[Lump], softness: f64, point: DVec3) -> f64 {
    let body = lumps.iter().fold(f64::INFINITY, |so_far, lump| {
        let distance = lump.distance(point);
        if so_far.is_finite() {
            melted(so_far, distance, lump.melt * softness)
        } else {
            distance
        }
    });
    // The floor cuts with a soft edge: a smooth maximum is the smooth minimum of the opposites.
    -melted(-body, point.y, 0.04)
}

/// Half the edge of the little cube that slopes are measured on.
const NEAR: f64 = 1e-4;

/// A step straight onto the surface (Newton's, along the slope of the distance).
fn onto(lumps: &[Lump], softness: f64, point: DVec3) -> DVec3 {
    // Four corners of a cube give value and slope at once.
    let corners = [
        dvec3(1.0, -1.0, -1.0),
        dvec3(-1.0, -1.0, 1.0),
        dvec3(-1.0, 1.0, -1.0),
        dvec3(1.0, 1.0, 1.0),
    ];
    let mut value = 0.0;
    let mut slope = DVec3::ZERO;
    for corner in corners {
        let distance = owl(lumps, softness, point + corner * NEAR);
        value += distance / 4.0;
        slope += corner * distance / (4.0 * NEAR);
    }
    point - slope * (value / slope.length_squared().max(0.1)).clamp(-0.05, 0.05)
}

/// Returns the distance from the heart to the outermost surface in a direction.
fn outermost(lumps: &[Lump], softness: f64, direction: DVec3) -> f64 {
    let mut reach = 1.0;
    for _ in 0..100 {
        let distance = owl(lumps, softness, HEART + direction * reach);
        if distance < 1e-4 {
            break;
        }
        reach -= 0.5 * distance;
    }
    reach
}

/// The seated owl.
pub(crate) fn figure() -> Model {
    let shape = scaled(skin(&lumps())).shape(UNROLL_ROUNDS);
    model("figure", shape)
}

/// Pieces of a quad's side that make more than a million triangles.
pub(crate) const MILLION_PIECES: usize = 7;

/// The same owl of more than a million triangles.
pub(crate) fn million() -> Model {
    model("figure-million", subdivided(MILLION_PIECES))
}

/// Every quad cut into `pieces`² and brought onto the owl again; texture coordinates stay where they were.
pub(crate) fn subdivided(pieces: usize) -> ChartedMesh {
    let lumps = lumps();
    let skin = skin(&lumps);
    let sheets = scaled(skin.clone()).sheets(UNROLL_ROUNDS);
    let mut shape = ChartedMesh::default();
    for (rows, sheet) in skin.faces.iter().zip(&sheets) {
        let corner = |x: usize, y: usize| {
            let (i, j) = ((x / pieces).min(STEPS - 1), (y / pieces).min(STEPS - 1));
            let (s, t) = (
                (x - i * pieces) as f64 / pieces as f64,
                (y - j * pieces) as f64 / pieces as f64,
            );
            let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
            let quad = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
            let mut position = DVec3::ZERO;
            let mut own = DVec2::ZERO;
            for ((i, j), weight) in quad.into_iter().zip(weights) {
                position += skin.points[rows[j][i]] * weight;
                own += sheet[j][i] * weight;
            }
            for _ in 0..3 {
                position = onto(&lumps, 1.0, position);
            }
            Corner {
                position: position * SCALE,
                sheet: own,
                normal: None,
            }
        };
        let steps = STEPS * pieces;
        let corners: Vec<Vec<Corner>> = (0..=steps)
            .map(|y| (0..=steps).map(|x| corner(x, y)).collect())
            .collect();
        shape.grid(&corners);
    }
    shape
}

fn scaled(mut skin: Skin) -> Skin {
    skin.points.iter_mut().for_each(|point| *point *= SCALE);
    skin
}

fn model(name: &'static str, shape: ChartedMesh) -> Model {
    let part = ModelPart {
        smooth_below: 180.0,
        ..ModelPart::new("owl", shape)
    };
    Model {
        name,
        paint: None,
        materials: vec![Material::plain("figure", [0.55, 0.5, 0.45])],
        parts: vec![part],
    }
}

/// A ball around a blurred owl, which then comes into focus; for a height of 1.
fn skin(lumps: &[Lump]) -> Skin {
    let blurred = 5.0;
    let rounds = 110;
    let mut skin = Skin::new(STEPS);
    for point in &mut skin.points {
        let direction = (*point * dvec3(0.5, 1.0, 0.5)).normalize_or_zero();
        *point = HEART + direction * outermost(lumps, blurred, direction);
    }
    // Points slide along the surface toward the middle of their neighbors, so that they lie evenly.
    for round in 0..rounds {
        let softness = (blurred - 0.06 * f64::from(round)).max(1.0);
        let before = skin.points.clone();
        for (point, beside) in skin.points.iter_mut().zip(&skin.beside) {
            // A far neighbor pulls harder, so that what sticks out is not left with a few long quads.
            let (sum, weights) = beside.iter().fold((DVec3::ZERO, 0.0), |(sum, weights), &number| {
                let pull = before[number].distance(*point);
                (sum + before[number] * pull, weights + pull)
            });
            *point = onto(lumps, softness, point.lerp(sum / weights.max(1e-12), 0.4));
        }
    }
    for point in &mut skin.points {
        for _ in 0..4 {
            *point = onto(lumps, 1.0, *point);
        }
    }
    skin
}
