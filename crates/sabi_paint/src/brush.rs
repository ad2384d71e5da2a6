//! Brushes: the paint that a stroke leaves.

use glam::{DMat3, DQuat, DVec3};
use serde::{Deserialize, Serialize};

use crate::brush_limits::BrushLimits;
use crate::dynamics::Jitter;
use crate::fade::Fade;
use crate::pen::{PenEffects, PenPose};
use crate::picture::PictureTip;
use crate::tips::Tip;

/// Usual angle at which a side ends, in degrees.
const SIDE_DEGREES: f32 = 30.0;
/// Usual difference of cover at which a similar area ends.
const TOLERANCE: f32 = 0.25;

fn is_usual_side(degrees: &f32) -> bool {
    *degrees == SIDE_DEGREES
}

fn is_usual_tolerance(tolerance: &f32) -> bool {
    *tolerance == TOLERANCE
}

/// Properties of the paint that a stroke leaves. Values that are missing in a file are those of [`Brush::default`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Brush {
    /// Shape of a stamp.
    pub tip: Tip,
    /// Picture that is stamped instead of the tip. The radius is half of its longer side, and the hardness is ignored.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture: Option<PictureTip>,
    /// Radius at full pressure in model units.
    pub radius: f32,
    /// Share of the radius within which the brush has its full strength. From there it fades to the border.
    pub hardness: f32,
    /// Way in which it fades. The usual one is not written to files, for the reason given at [`Brush::turn`].
    #[serde(skip_serializing_if = "Fade::is_usual")]
    pub fade: Fade,
    /// Strength of a single stamp, 0 to 1. Below 1, a stroke builds up where it passes slowly or repeatedly.
    pub flow: f32,
    /// Maximum strength of a whole stroke, 0 to 1.
    pub opacity: f32,
    /// Distance between two stamps, as a share of the radius.
    pub spacing: f32,
    /// Direction that the tip follows. The direction of the stroke is not written to files, so that strokes from before
    /// this choice existed keep their bytes and thus the names of their versions.
    #[serde(skip_serializing_if = "TipDirection::is_along_stroke")]
    pub turn: TipDirection,
    /// Rotation of the tip from that direction, in degrees counter-clockwise as seen from outside.
    pub angle_degrees: f32,
    /// Random differences between stamps.
    pub jitter: Jitter,
    /// Value that the mask receives, 0 to 1.
    pub value: f32,
    /// Color, linear.
    pub color: [f32; 3],
    /// Height that is added, in model units. A negative height carves.
    pub height: f32,
    /// Places that the brush does not change.
    pub limits: BrushLimits,
    /// Angle between triangles at which the side that a fill covers ends, in degrees. 30 is not written to files.
    #[serde(skip_serializing_if = "is_usual_side")]
    pub side_degrees: f32,
    /// Difference of cover at which a fill of a similar area ends, 0 to 1. A quarter is not written to files.
    #[serde(skip_serializing_if = "is_usual_tolerance")]
    pub tolerance: f32,
    /// Copies of the stroke on the other sides of the model.
    pub symmetry: Symmetry,
    /// True if a stroke also paints other pieces of the model that are near and face the same way, for example the next board.
    pub reaches_pieces: bool,
    /// Effects of the pressure of a pen.
    pub pressure: PenEffects,
    /// Effects of the tilt of a pen, from upright on the surface to flat on it. Not written to files if there are none.
    #[serde(skip_serializing_if = "PenEffects::are_none")]
    pub tilt: PenEffects,
}

/// Direction of the x axis of a tip on the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TipDirection {
    /// Along the stroke.
    #[default]
    Stroke,
    /// Down the surface, for tips that hang; along the stroke on a level surface.
    Down,
    /// In the direction in which the pen leans; along the stroke if the pen is upright or its direction is unknown.
    Pen,
}

impl TipDirection {
    /// All directions with their titles.
    pub const ALL: [(TipDirection, &'static str); 3] = [
        (TipDirection::Stroke, "Stroke"),
        (TipDirection::Down, "Down"),
        (TipDirection::Pen, "Pen"),
    ];

    fn is_along_stroke(&self) -> bool {
        *self == TipDirection::Stroke
    }
}

/// Copies of a stroke on the other sides of the model. The planes and the vertical axis go through the middle of the model's box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Symmetry {
    /// For x, y and z: whether the stroke is mirrored across the plane perpendicular to that axis.
    pub mirrors: [bool; 3],
    /// Number of copies around the vertical axis, including the stroke itself; 0 and 1 mean no copies.
    pub turns: u32,
}

impl Symmetry {
    /// Maximum number of copies around the axis.
    pub const TURNS_LIMIT: u32 = 64;

    /// Returns what leads from a stroke to each of its copies, about the middle of the model's box. The stroke itself is left out.
    pub fn copies(&self) -> Vec<SymmetryCopy> {
        let turns = self.turns.max(1);
        let mut copies = Vec::new();
        for turn in 0..turns {
            let angle = std::f64::consts::TAU * f64::from(turn) / f64::from(turns);
            let turned = DQuat::from_rotation_y(angle);
            for mirrors in 0..8_u32 {
                let is_meant = (0..3).all(|axis| mirrors >> axis & 1 == 0 || self.mirrors[axis]);
                if is_meant && (turn, mirrors) != (0, 0) {
                    let signs = [0, 1, 2].map(|axis| if mirrors >> axis & 1 == 1 { -1.0 } else { 1.0 });
                    let signs = DVec3::from(signs);
                    copies.push(SymmetryCopy { signs, turned });
                }
            }
        }
        copies
    }
}

/// Way from a stroke to one of its copies: a mirror, then a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SymmetryCopy {
    /// Sign of each component: -1 where it is mirrored.
    signs: DVec3,
    turned: DQuat,
}

impl SymmetryCopy {
    /// Maps a vector from the middle of the model, or a direction.
    pub fn map(&self, vector: DVec3) -> DVec3 {
        self.turned * (self.signs * vector)
    }

    /// Returns the same as a matrix.
    pub(crate) fn matrix(&self) -> DMat3 {
        DMat3::from_quat(self.turned) * DMat3::from_diagonal(self.signs)
    }

    /// Returns true if the copy is a mirror image.
    pub(crate) fn is_mirrored(&self) -> bool {
        self.signs.element_product() < 0.0
    }
}

impl Default for Brush {
    fn default() -> Brush {
        Brush {
            tip: Tip::Round,
            picture: None,
            radius: 0.05,
            hardness: 0.5,
            fade: Fade::default(),
            flow: 1.0,
            opacity: 1.0,
            spacing: 0.15,
            turn: TipDirection::Stroke,
            angle_degrees: 0.0,
            jitter: Jitter::default(),
            value: 1.0,
            color: [0.5; 3],
            height: 0.0,
            limits: BrushLimits::default(),
            side_degrees: SIDE_DEGREES,
            tolerance: TOLERANCE,
            symmetry: Symmetry::default(),
            reaches_pieces: true,
            pressure: PenEffects::default(),
            tilt: PenEffects::NONE,
        }
    }
}

impl Brush {
    /// Returns the brush with every number in its range. NaN is replaced by the number of the default brush.
    pub fn bounded(&self) -> Brush {
        let usual = Brush::default();
        let within = |value: f32, usual: f32, low: f32, high: f32| {
            if value.is_finite() {
                value.clamp(low, high)
            } else {
                usual
            }
        };
        let share = |value: f32, usual: f32| within(value, usual, 0.0, 1.0);
        Brush {
            tip: self.tip,
            picture: self.picture.clone(),
            radius: within(self.radius, usual.radius, 1e-9, 1e9),
            hardness: share(self.hardness, usual.hardness),
            fade: self.fade,
            flow: share(self.flow, usual.flow),
            opacity: share(self.opacity, usual.opacity),
            spacing: within(self.spacing, usual.spacing, 0.02, 4.0),
            turn: self.turn,
            angle_degrees: within(self.angle_degrees, 0.0, -360.0, 360.0),
            jitter: self.jitter.bounded(),
            value: share(self.value, usual.value),
            color: self.color.map(|value| within(value, 0.0, 0.0, 1.0)),
            height: within(self.height, usual.height, -1e9, 1e9),
            limits: BrushLimits {
                angle_degrees: within(self.limits.angle_degrees, usual.limits.angle_degrees, 0.0, 180.0),
                ..self.limits
            },
            side_degrees: within(self.side_degrees, SIDE_DEGREES, 0.0, 180.0),
            tolerance: share(self.tolerance, TOLERANCE),
            symmetry: Symmetry {
                mirrors: self.symmetry.mirrors,
                turns: self.symmetry.turns.min(Symmetry::TURNS_LIMIT),
            },
            reaches_pieces: self.reaches_pieces,
            pressure: self.pressure.bounded(&usual.pressure),
            tilt: self.tilt.bounded(&usual.tilt),
        }
    }

    /// Returns the factor for a property of the brush that both effects of the pen change, each by its amount.
    fn share_at(&self, pose: &PenPose, amount: impl Fn(&PenEffects) -> f32) -> f64 {
        let by_pressure = self.pressure.share(amount(&self.pressure), pose.pressure);
        let by_tilt = |tilt: f32| self.tilt.share(amount(&self.tilt), tilt);
        // A mouse has no tilt.
        by_pressure * pose.lean.map_or(1.0, |lean| by_tilt(lean.tilt))
    }

    /// Returns the radius for a pose of the pen in model units; at least a fiftieth of the full radius.
    pub(crate) fn radius_at(&self, pose: &PenPose) -> f64 {
        f64::from(self.radius) * self.share_at(pose, |effects| effects.radius).max(0.02)
    }

    /// Returns the strength of a stamp for a pose of the pen, 0 to 1.
    pub(crate) fn strength_at(&self, pose: &PenPose) -> f64 {
        self.share_at(pose, |effects| effects.flow)
    }

    /// Returns the distance of stamps from the way for a pose of the pen, as a share of the radius.
    pub(crate) fn scatter_at(&self, pose: &PenPose) -> f64 {
        f64::from(self.jitter.place) * self.share_at(pose, |effects| effects.scatter)
    }

    /// Returns the share of the radius that has the full strength, for a pose of the pen.
    pub(crate) fn hardness_at(&self, pose: &PenPose) -> f64 {
        f64::from(self.hardness) * self.share_at(pose, |effects| effects.hardness)
    }

    /// Returns the rotation of the tip for a pose of the pen, in degrees counter-clockwise.
    pub(crate) fn turn_at(&self, pose: &PenPose) -> f64 {
        let by_tilt = pose.lean.map_or(0.0, |lean| self.tilt.turn(lean.tilt));
        f64::from(self.angle_degrees) + self.pressure.turn(pose.pressure) + by_tilt
    }

    /// Returns the share of the full strength at a distance from the middle, given in radii. Inside of the hardness it is
    /// that of the hard part (1 except for curves), from 1 on it is 0, and in between it fades.
    pub fn falloff(&self, distance: f64) -> f64 {
        self.falloff_of(distance, f64::from(self.hardness))
    }

    /// Returns the share of [`Brush::falloff`] with another hardness.
    pub(crate) fn falloff_of(&self, distance: f64, hard: f64) -> f64 {
        if distance <= hard {
            return self.fade.at(1.0);
        }
        if distance >= 1.0 {
            return 0.0;
        }
        let t = (1.0 - distance) / (1.0 - hard);
        self.fade.at(t)
    }
}
