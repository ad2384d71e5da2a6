//! Places that a stroke leaves alone, though its brush reaches them.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Degrees over which the strength fades to nothing at the largest angle of a brush.
const ANGLE_FADE: f64 = 15.0;

/// Places that a stroke leaves alone, though its brush reaches them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Limits {
    /// Largest angle between the surface under the middle of the brush and a place that it paints, degrees; the last 15 fade. 180
    /// for none.
    pub angle_degrees: f32,
    /// True if places are left alone that face away from where the artist looks from, and those nearly edge-on.
    pub front_only: bool,
    /// True if places are left alone that the artist does not see, since something is before them.
    pub seen_only: bool,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits {
            angle_degrees: 180.0,
            front_only: false,
            seen_only: false,
        }
    }
}

impl Limits {
    /// Share of the strength that is left at an angle with this cosine: 1 for a brush without a limit.
    pub(crate) fn of_angle(&self, cosine: f64) -> f64 {
        let most = f64::from(self.angle_degrees);
        if most >= 180.0 {
            return 1.0;
        }
        let angle = cosine.clamp(-1.0, 1.0).acos().to_degrees();
        ((most - angle) / ANGLE_FADE).clamp(0.0, 1.0)
    }
}

/// Eye of an artist while a stroke was drawn, model space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Eye {
    /// A place, model units.
    Place([f32; 3]),
    /// Very far away in this direction, which has unit length: a view without perspective.
    Toward([f32; 3]),
}

impl Eye {
    /// Way from a place to the eye, model space: its length means nothing for a view without perspective.
    pub fn way_from(&self, place: DVec3) -> DVec3 {
        match self {
            Eye::Place(eye) => DVec3::from(eye.map(f64::from)) - place,
            Eye::Toward(direction) => DVec3::from(direction.map(f64::from)),
        }
    }

    /// True if all its numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        let (Eye::Place(numbers) | Eye::Toward(numbers)) = self;
        numbers.iter().all(|number| number.is_finite())
    }
}
