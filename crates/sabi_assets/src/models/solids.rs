//! The two plain test bodies: a ball, and a cube whose charts are as awkward as charts get.

use glam::{DVec2, dvec2};

use super::ball::{FACES, ball};
use super::charted_mesh::{ChartedMesh, Corner, ModelPart};
use super::glb::{Material, Model};

/// A ball of one meter across, in six charts.
pub(crate) fn sphere() -> Model {
    Model {
        name: "sphere",
        paint: None,
        materials: vec![Material::plain("sphere", [0.6, 0.6, 0.6])],
        parts: vec![part("sphere", ball(0.5, 24))],
    }
}

/// Degrees, share of the common density, and whether mirrored: every seam of the cube joins two charts that disagree.
const AWKWARD: [(f64, f64, bool); 6] = [
    (17.0, 1.0, false),
    (-31.0, 0.8, true),
    (63.0, 1.25, false),
    (90.0, 0.9, true),
    (-8.5, 1.1, false),
    (45.0, 0.7, false),
];

/// A cube of one meter: the seam torture test. Each face is a chart of its own turn, density and handedness.
pub(crate) fn cube() -> Model {
    let mut shape = ChartedMesh::default();
    for ([right, up, out], (degrees, density, mirrored)) in FACES.into_iter().zip(AWKWARD) {
        let turn = DVec2::from_angle(f64::to_radians(degrees));
        let corner = |x: f64, y: f64| {
            let own = dvec2(if mirrored { -x } else { x }, y) * density;
            Corner {
                position: (out + right * x + up * y) * 0.5,
                sheet: turn.rotate(own) * 0.5,
                normal: Some(out),
            }
        };
        let chart = shape.begin_chart();
        shape.quad(
            chart,
            [
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ],
        );
    }
    Model {
        name: "cube",
        paint: None,
        materials: vec![Material::plain("cube", [0.6, 0.6, 0.6])],
        parts: vec![part("cube", shape)],
    }
}

fn part(name: &str, shape: ChartedMesh) -> ModelPart {
    ModelPart {
        smooth_below: 30.0,
        ..ModelPart::new(name, shape)
    }
}
