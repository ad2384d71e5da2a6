//! The pen: its pose at a point of a stroke, and the effects of the pose.

use glam::{DMat3, DVec3, Vec3};
use serde::{Deserialize, Serialize};

use crate::octahedral::{from_octahedral, octahedral};

/// Bend value of a straight curve between pressure or tilt and its effect.
const STRAIGHT: f32 = 0.5;
/// Largest rotation of the tip in degrees.
const MOST_TURNED: f32 = 180.0;

/// Direction of the shaft of a pen in model space, from its tip to its other end, stored in four bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shaft([i16; 2]);

impl Shaft {
    /// Bytes in files for an unknown shaft. No direction is encoded as these bytes.
    pub(crate) const BYTES: usize = 4;
    const NONE: [i16; 2] = [i16::MIN; 2];

    /// Returns the shaft along a direction of any length; `None` if the direction is zero or not finite.
    pub fn along(direction: DVec3) -> Option<Shaft> {
        let unit = direction.try_normalize()?.as_vec3();
        Some(Shaft(octahedral(unit.to_array())))
    }

    /// Returns the shaft of a pen that leans by an angle from a unit normal toward a unit direction perpendicular to it.
    pub fn leaning(normal: DVec3, toward: DVec3, angle_degrees: f32) -> Option<Shaft> {
        let (sine, cosine) = f64::from(angle_degrees).clamp(0.0, 90.0).to_radians().sin_cos();
        Shaft::along(cosine * normal + sine * toward)
    }

    /// Returns the unit direction.
    pub fn direction(self) -> DVec3 {
        Vec3::from(from_octahedral(self.0)).as_dvec3()
    }

    pub(crate) fn turned(self, turn: &DMat3) -> Option<Shaft> {
        Shaft::along(*turn * self.direction())
    }

    pub(crate) fn bytes_of(shaft: Option<Shaft>) -> [u8; Shaft::BYTES] {
        let [u, v] = shaft.map_or(Shaft::NONE, |shaft| shaft.0).map(i16::to_le_bytes);
        [u[0], u[1], v[0], v[1]]
    }

    pub(crate) fn of_bytes([a, b, c, d]: [u8; Shaft::BYTES]) -> Option<Shaft> {
        let packed = [[a, b], [c, d]].map(i16::from_le_bytes);
        (packed != Shaft::NONE).then_some(Shaft(packed))
    }
}

/// Way in which a pen touches a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Pressure, 0 to 1.
    pub pressure: f32,
    /// Direction of the shaft; `None` if it is unknown, for example for a mouse.
    pub shaft: Option<Shaft>,
}

impl From<f32> for Touch {
    /// A pressure alone.
    fn from(pressure: f32) -> Touch {
        Touch { pressure, shaft: None }
    }
}

impl Touch {
    /// Returns the touch with a pressure from 0 to 1. NaN becomes 1.
    pub(crate) fn bounded(self) -> Touch {
        let pressure = if self.pressure.is_finite() {
            self.pressure.clamp(0.0, 1.0)
        } else {
            1.0
        };
        Touch { pressure, ..self }
    }

    /// Returns the touch at a share of the way from one touch to another.
    pub(crate) fn between([from, to]: [Touch; 2], share: f32) -> Touch {
        let shaft = match (from.shaft, to.shaft) {
            (Some(one), Some(other)) if one != other => {
                let between = one.direction().lerp(other.direction(), f64::from(share));
                // Between opposite directions there is no direction, so the first is used.
                Shaft::along(between).or(Some(one))
            }
            (one, other) => one.or(other),
        };
        Touch {
            pressure: from.pressure + share * (to.pressure - from.pressure),
            shaft,
        }
    }

    /// Returns the pose of the pen over a surface. `normal` returns the unit normal of the surface.
    pub(crate) fn over(self, normal: impl FnOnce() -> DVec3) -> PenPose {
        PenPose {
            pressure: self.pressure,
            lean: self.shaft.map(|shaft| Lean::of(shaft.direction(), normal())),
        }
    }
}

/// Pose of a pen relative to the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PenPose {
    /// Pressure, 0 to 1.
    pub(crate) pressure: f32,
    pub(crate) lean: Option<Lean>,
}

/// Lean of a pen relative to the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lean {
    /// Tilt: 0 upright on the surface, 1 flat on it.
    pub(crate) tilt: f32,
    /// Direction of the lean along the surface. Its length is the sine of the angle, zero for an upright pen.
    pub(crate) toward: Vec3,
}

impl Lean {
    fn of(shaft: DVec3, normal: DVec3) -> Lean {
        // A pen that points into a curved surface counts as flat on it.
        let up = shaft.dot(normal).clamp(0.0, 1.0);
        Lean {
            tilt: (up.acos() / std::f64::consts::FRAC_PI_2) as f32,
            toward: (shaft - shaft.dot(normal) * normal).as_vec3(),
        }
    }
}

impl PenPose {
    /// Returns the pose at a share of the way from one pose to another.
    pub(crate) fn between([from, to]: [PenPose; 2], share: f32) -> PenPose {
        let lean = match (from.lean, to.lean) {
            (Some(one), Some(other)) => Some(Lean {
                tilt: one.tilt + share * (other.tilt - one.tilt),
                toward: one.toward.lerp(other.toward, share),
            }),
            (one, other) => one.or(other),
        };
        PenPose {
            pressure: from.pressure + share * (to.pressure - from.pressure),
            lean,
        }
    }

    /// Returns true if the pose differs from another pose by less than `least`.
    pub(crate) fn is_near(&self, other: &PenPose, least: f32) -> bool {
        let leans = match (self.lean, other.lean) {
            (Some(one), Some(other)) => {
                (one.tilt - other.tilt).abs() < least && one.toward.distance(other.toward) < least
            }
            (one, other) => one == other,
        };
        (self.pressure - other.pressure).abs() < least && leans
    }
}

/// Effects of the pressure or the tilt of a pen. An amount of 0 means no effect. With 1, a value grows in proportion, up to
/// that of the brush. With a negative amount, it shrinks instead.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PenEffects {
    /// Effect on the radius.
    pub radius: f32,
    /// Effect on the strength.
    pub flow: f32,
    /// Effect on the distance of stamps from the way. 0 is not written to files.
    #[serde(skip_serializing_if = "is_none")]
    pub scatter: f32,
    /// Effect on the hardness. 0 is not written to files.
    #[serde(skip_serializing_if = "is_none")]
    pub hardness: f32,
    /// Rotation of the tip at full pressure or tilt, in degrees counter-clockwise. 0 is not written to files.
    #[serde(skip_serializing_if = "is_none")]
    pub angle_degrees: f32,
    /// Bend of the curve between the value and its effect: 0.5 is straight. With a higher bend, low values have more
    /// effect; with a lower bend, less. The straight curve is not written to files.
    #[serde(skip_serializing_if = "is_straight")]
    pub bend: f32,
}

fn is_none(amount: &f32) -> bool {
    *amount == 0.0
}

fn is_straight(bend: &f32) -> bool {
    *bend == STRAIGHT
}

impl Default for PenEffects {
    /// Returns the effects of the pressure on the usual brush: only on the strength.
    fn default() -> PenEffects {
        PenEffects {
            flow: 1.0,
            ..PenEffects::NONE
        }
    }
}

impl PenEffects {
    /// No effects.
    pub const NONE: PenEffects = PenEffects {
        radius: 0.0,
        flow: 0.0,
        scatter: 0.0,
        hardness: 0.0,
        angle_degrees: 0.0,
        bend: STRAIGHT,
    };

    pub(crate) fn are_none(&self) -> bool {
        *self == PenEffects::NONE
    }

    /// Returns true if the effects change a line without separate stamps.
    pub(crate) fn change_lines(&self) -> bool {
        [self.radius, self.flow, self.hardness]
            .iter()
            .any(|amount| *amount != 0.0)
    }

    /// Returns the effects with every number in its range. NaN is replaced by the number in `usual`.
    pub(crate) fn bounded(&self, usual: &PenEffects) -> PenEffects {
        let within = |value: f32, usual: f32, [low, high]: [f32; 2]| match value.is_finite() {
            true => value.clamp(low, high),
            false => usual,
        };
        let amount = |value: f32, usual: f32| within(value, usual, [-1.0, 1.0]);
        PenEffects {
            radius: amount(self.radius, usual.radius),
            flow: amount(self.flow, usual.flow),
            scatter: amount(self.scatter, usual.scatter),
            hardness: amount(self.hardness, usual.hardness),
            angle_degrees: within(self.angle_degrees, usual.angle_degrees, [-MOST_TURNED, MOST_TURNED]),
            bend: within(self.bend, usual.bend, [0.05, 0.95]),
        }
    }

    /// Returns the effect of a pressure or tilt, both 0 to 1 (the bias of Schlick, "Fast alternatives to Perlin's bias and
    /// gain functions", 1994).
    pub fn effect(&self, value: f32) -> f64 {
        let (value, bend) = (f64::from(value.clamp(0.0, 1.0)), f64::from(self.bend));
        value / ((1.0 / bend - 2.0) * (1.0 - value) + 1.0)
    }

    /// Returns the factor for a property of the brush that a pressure or tilt changes by an amount.
    pub(crate) fn share(&self, amount: f32, value: f32) -> f64 {
        let effect = self.effect(value);
        let lacking = if amount >= 0.0 { 1.0 - effect } else { effect };
        (1.0 - f64::from(amount.abs()) * lacking).clamp(0.0, 1.0)
    }

    /// Returns the rotation of the tip at a pressure or tilt, in degrees counter-clockwise.
    pub(crate) fn turn(&self, value: f32) -> f64 {
        f64::from(self.angle_degrees) * self.effect(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_of_a_pen_is_straight_unless_it_is_bent() {
        let straight = PenEffects::default();
        assert!((0..=10).all(|tenth| (straight.effect(tenth as f32 / 10.0) - f64::from(tenth) / 10.0).abs() < 1e-6));
        let light = PenEffects { bend: 0.8, ..straight };
        assert!((light.effect(0.5) - 0.8).abs() < 1e-6, "{}", light.effect(0.5));
        assert_eq!([light.effect(0.0), light.effect(1.0)], [0.0, 1.0]);
    }

    #[test]
    fn a_value_grows_with_a_positive_amount_and_shrinks_with_a_negative_one() {
        let effects = PenEffects {
            angle_degrees: 90.0,
            ..PenEffects::NONE
        };
        for (amount, shares) in [
            (0.0, [1.0, 1.0, 1.0]),
            (1.0, [0.0, 0.25, 1.0]),
            (-1.0, [1.0, 0.75, 0.0]),
            (0.5, [0.5, 0.625, 1.0]),
        ] {
            assert_eq!(
                [0.0, 0.25, 1.0].map(|value| effects.share(amount, value)),
                shares,
                "{amount}"
            );
        }
        assert_eq!([0.0, 0.5, 1.0].map(|value| effects.turn(value)), [0.0, 45.0, 90.0]);
    }

    #[test]
    fn effects_of_zero_are_not_written_to_files() {
        let text = serde_json::to_string(&PenEffects::default()).unwrap();
        assert_eq!(text, r#"{"radius":0.0,"flow":1.0}"#);
    }

    #[test]
    fn nan_is_replaced_and_other_numbers_are_kept_in_range() {
        let odd = PenEffects {
            radius: f32::NAN,
            flow: f32::INFINITY,
            scatter: 7.0,
            hardness: -7.0,
            angle_degrees: f32::NEG_INFINITY,
            bend: 0.0,
        };
        let bounded = odd.bounded(&PenEffects::NONE);
        assert_eq!(
            [bounded.radius, bounded.flow, bounded.scatter, bounded.hardness],
            [0.0, 0.0, 1.0, -1.0]
        );
        assert_eq!([bounded.angle_degrees, bounded.bend], [0.0, 0.05]);
        assert_eq!(Touch::from(f32::NAN).bounded().pressure, 1.0);
        assert_eq!(Touch::from(-3.0).bounded().pressure, 0.0);
        for direction in [DVec3::ZERO, DVec3::NAN, DVec3::new(f64::INFINITY, 0.0, 0.0)] {
            assert_eq!(Shaft::along(direction), None);
        }
        assert_eq!(Shaft::leaning(DVec3::Y, DVec3::X, f32::NAN), None);
    }

    #[test]
    fn a_shaft_keeps_its_direction_in_four_bytes_and_an_unknown_one_stays_unknown() {
        for direction in [DVec3::X, -DVec3::Z, DVec3::new(0.3, -0.5, -0.8), DVec3::ONE] {
            let shaft = Shaft::along(direction).unwrap();
            assert!(shaft.direction().distance(direction.normalize()) < 1e-4, "{direction}");
            assert_eq!(Shaft::of_bytes(Shaft::bytes_of(Some(shaft))), Some(shaft));
        }
        assert_eq!(Shaft::of_bytes(Shaft::bytes_of(None)), None);
    }

    #[test]
    fn the_lean_is_measured_from_the_surface() {
        let shaft = Shaft::leaning(DVec3::Y, DVec3::X, 45.0);
        let touch = Touch { pressure: 0.5, shaft };
        let lean = touch.over(|| DVec3::Y).lean.unwrap();
        assert!(
            (lean.tilt - 0.5).abs() < 1e-3 && lean.toward.normalize().distance(Vec3::X) < 1e-3,
            "{lean:?}"
        );
        assert!(touch.over(|| DVec3::new(1.0, 1.0, 0.0).normalize()).lean.unwrap().tilt < 0.01);
        assert_eq!(Touch::from(0.5).over(|| DVec3::Y).lean, None);
    }

    #[test]
    fn between_two_touches_values_are_interpolated_and_a_missing_shaft_is_replaced() {
        let leaning = |degrees| Touch {
            pressure: degrees / 90.0,
            shaft: Shaft::leaning(DVec3::Y, DVec3::X, degrees),
        };
        let middle = Touch::between([leaning(0.0), leaning(90.0)], 0.5);
        let expected = leaning(45.0).shaft.unwrap().direction();
        assert!((middle.pressure - 0.5).abs() < 1e-6);
        assert!(middle.shaft.unwrap().direction().distance(expected) < 1e-3);
        assert_eq!(
            Touch::between([Touch::from(0.0), leaning(30.0)], 0.5).shaft,
            leaning(30.0).shaft
        );
        let opposite = [DVec3::X, -DVec3::X].map(|direction| Touch {
            pressure: 1.0,
            shaft: Shaft::along(direction),
        });
        assert!(Touch::between(opposite, 0.5).shaft.is_some());
    }
}
