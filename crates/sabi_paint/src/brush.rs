//! A brush: what a stroke leaves where it passes.

use serde::{Deserialize, Serialize};

use crate::dynamics::Jitter;
use crate::fade::Fade;
use crate::limits::Limits;
use crate::pen::{PenEffects, Pose};
use crate::picture::PictureTip;
use crate::tips::Tip;

/// Usual angle at which a side ends, degrees.
const SIDE_DEGREES: f32 = 30.0;
/// Usual difference of cover at which a similar area ends.
const TOLERANCE: f32 = 0.25;

fn is_usual_side(degrees: &f32) -> bool {
    *degrees == SIDE_DEGREES
}

fn is_usual_tolerance(tolerance: &f32) -> bool {
    *tolerance == TOLERANCE
}

/// What a stroke leaves where it passes. Values that a file lacks are those of [`Brush::default`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Brush {
    /// Shape of a stamp.
    pub tip: Tip,
    /// Picture that is stamped instead of the tip; the radius is half of its longer side, and the hardness does not count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture: Option<PictureTip>,
    /// Radius at full pressure, model units.
    pub radius: f32,
    /// Share of the radius within which the brush has its full strength; it fades from there to the border.
    pub hardness: f32,
    /// Way in which it fades. Left out of files where it is the usual one, as for [`Brush::turn`].
    #[serde(skip_serializing_if = "Fade::is_usual")]
    pub fade: Fade,
    /// Strength of a single stamp, 0 to 1: below 1 a stroke builds up where it passes slowly or again.
    pub flow: f32,
    /// Limit of a whole stroke, 0 to 1.
    pub opacity: f32,
    /// Way between two stamps, as a share of the radius.
    pub spacing: f32,
    /// Direction that the tip follows. Left out of files where it is the stroke's, so that strokes from before there was a choice
    /// keep their bytes, and with these the names of their versions.
    #[serde(skip_serializing_if = "Turn::is_along_stroke")]
    pub turn: Turn,
    /// Turn of the tip away from that direction, degrees counter-clockwise as seen from outside.
    pub angle_degrees: f32,
    /// Random differences between stamps.
    pub jitter: Jitter,
    /// Value that the mask gets, 0 to 1.
    pub value: f32,
    /// Color, linear.
    pub color: [f32; 3],
    /// Height that is added, model units; below 0 it carves.
    pub height: f32,
    /// Places that are left alone.
    pub limits: Limits,
    /// Angle between triangles at which the side that a fill covers ends, degrees. Left out of files where it is 30.
    #[serde(skip_serializing_if = "is_usual_side")]
    pub side_degrees: f32,
    /// Difference of cover at which a fill of a similar area ends, 0 to 1. Left out of files where it is a quarter.
    #[serde(skip_serializing_if = "is_usual_tolerance")]
    pub tolerance: f32,
    /// Copies of the stroke on the other sides of the model.
    pub symmetry: Symmetry,
    /// True if a stroke reaches other pieces of the model that lie near and face the same way, such as the next board.
    pub reaches_pieces: bool,
    /// What the pressure of a pen changes.
    pub pressure: PenEffects,
    /// Effects of the tilt of a pen, from upright on the surface to flat on it. Left out of files where there are none.
    #[serde(skip_serializing_if = "PenEffects::are_none")]
    pub tilt: PenEffects,
}

/// Direction of the x axis of a tip on the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Turn {
    /// Along the stroke.
    #[default]
    Stroke,
    /// Down the surface, for tips that hang; along the stroke where the surface is level.
    Down,
    /// With the pen: where it leans; along the stroke where it stands upright, or where nothing is known of it.
    Pen,
}

impl Turn {
    /// All directions with their titles.
    pub const ALL: [(Turn, &'static str); 3] = [(Turn::Stroke, "Stroke"), (Turn::Down, "Down"), (Turn::Pen, "Pen")];

    fn is_along_stroke(&self) -> bool {
        *self == Turn::Stroke
    }
}

/// Copies of a stroke on the other sides of the model. Planes and the axis, which is upright, go through the middle of its box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Symmetry {
    /// Mirrors across the planes at right angles to x, y and z.
    pub mirrors: [bool; 3],
    /// Number of copies around the upright axis, the stroke itself among them; 0 and 1 are none.
    pub turns: u32,
}

impl Symmetry {
    /// Most copies around the axis.
    pub const TURNS_LIMIT: u32 = 64;
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
            turn: Turn::Stroke,
            angle_degrees: 0.0,
            jitter: Jitter::default(),
            value: 1.0,
            color: [0.5; 3],
            height: 0.0,
            limits: Limits::default(),
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
    /// The brush with every number in its range; numbers that are none become those of the default brush.
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
            limits: Limits {
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

    /// Share that is left of a property of the brush under a pen, of which both effects change an amount.
    fn share_at(&self, pose: &Pose, amount: impl Fn(&PenEffects) -> f32) -> f64 {
        let by_pressure = self.pressure.share(amount(&self.pressure), pose.pressure);
        let by_tilt = |tilt: f32| self.tilt.share(amount(&self.tilt), tilt);
        // A mouse does not lean.
        by_pressure * pose.lean.map_or(1.0, |lean| by_tilt(lean.tilt))
    }

    /// Radius under a pen, model units; never below a fiftieth of the full one.
    pub(crate) fn radius_at(&self, pose: &Pose) -> f64 {
        f64::from(self.radius) * self.share_at(pose, |effects| effects.radius).max(0.02)
    }

    /// Strength of a stamp under a pen, 0 to 1.
    pub(crate) fn strength_at(&self, pose: &Pose) -> f64 {
        self.share_at(pose, |effects| effects.flow)
    }

    /// Distance of stamps from the way under a pen, as a share of the radius.
    pub(crate) fn scatter_at(&self, pose: &Pose) -> f64 {
        f64::from(self.jitter.place) * self.share_at(pose, |effects| effects.scatter)
    }

    /// Share of the radius that has the full strength under a pen.
    pub(crate) fn hardness_at(&self, pose: &Pose) -> f64 {
        f64::from(self.hardness) * self.share_at(pose, |effects| effects.hardness)
    }

    /// Turn of the tip under a pen, degrees counter-clockwise.
    pub(crate) fn turn_at(&self, pose: &Pose) -> f64 {
        let by_tilt = pose.lean.map_or(0.0, |lean| self.tilt.turn(lean.tilt));
        f64::from(self.angle_degrees) + self.pressure.turn(pose.pressure) + by_tilt
    }

    /// Share of the full strength at a distance from the middle, given in radii: that of the hard part inside of the hardness, which is 1
    /// but for curves, 0 from 1 on, and faded in between.
    pub fn falloff(&self, distance: f64) -> f64 {
        self.falloff_of(distance, f64::from(self.hardness))
    }

    /// As [`Brush::falloff`], with another hardness.
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
