//! Places that a stroke does not paint although its brush reaches them.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Range of angles in degrees below the largest angle of a brush in which the strength fades to zero.
const ANGLE_FADE: f64 = 15.0;

/// Limits that keep a stroke from painting some of the places that its brush reaches.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BrushLimits {
    /// Largest angle in degrees between the surface under the middle of the brush and a place that it paints. The strength
    /// fades over the last 15 degrees. 180 means no limit.
    pub angle_degrees: f32,
    /// True if places that face away from the artist, and those seen nearly edge-on, are not painted.
    pub front_only: bool,
    /// True if places that are hidden from the artist by another part of the model are not painted.
    pub seen_only: bool,
}

impl Default for BrushLimits {
    fn default() -> BrushLimits {
        BrushLimits {
            angle_degrees: 180.0,
            front_only: false,
            seen_only: false,
        }
    }
}

impl BrushLimits {
    /// Returns the share of the strength that remains at an angle with this cosine: 1 for a brush without a limit.
    pub(crate) fn of_angle(&self, cosine: f64) -> f64 {
        let most = f64::from(self.angle_degrees);
        if most >= 180.0 {
            return 1.0;
        }
        let angle = cosine.clamp(-1.0, 1.0).acos().to_degrees();
        ((most - angle) / ANGLE_FADE).clamp(0.0, 1.0)
    }
}

/// Eye of the artist while a stroke was drawn, in model space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Eye {
    /// A position in model units.
    Place([f32; 3]),
    /// Very far away in this direction, which has unit length. For a view without perspective.
    Toward([f32; 3]),
}

impl Eye {
    /// Returns the vector from a place to the eye in model space. Its length has no meaning for a view without perspective.
    pub fn way_from(&self, place: DVec3) -> DVec3 {
        match self {
            Eye::Place(eye) => DVec3::from(eye.map(f64::from)) - place,
            Eye::Toward(direction) => DVec3::from(direction.map(f64::from)),
        }
    }

    /// Returns true if it sees the back of a surface, which has this unit normal at a place.
    pub fn sees_back(&self, place: DVec3, normal: DVec3) -> bool {
        self.is_finite() && self.way_from(place).dot(normal) < 0.0
    }

    /// Returns true if all its numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        let (Eye::Place(numbers) | Eye::Toward(numbers)) = self;
        numbers.iter().all(|number| number.is_finite())
    }
}
