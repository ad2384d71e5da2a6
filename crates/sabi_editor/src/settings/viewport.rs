//! Light and picture of the viewport, as they are kept between runs.

use std::ops::RangeInclusive;

use sabi_view::{
    Background, Light, LightPlace, STUDIO_ENVIRONMENT_STRENGTH, STUDIO_LIGHTS, Shot, USUAL_BLOOM, ViewTransform,
};

/// Limits of the menus.
pub(crate) const TURN_DEGREES: RangeInclusive<f32> = -180.0..=180.0;
pub(crate) const STRENGTH: RangeInclusive<f32> = 0.0..=4.0;
pub(crate) const EXPOSURE_STOPS: RangeInclusive<f32> = -6.0..=6.0;
pub(crate) const BLOOM: RangeInclusive<f32> = 0.0..=1.0;

/// Backgrounds, with their names in settings and their titles.
pub(crate) const BACKGROUNDS: [(&str, &str, Background); 4] = [
    ("studio", "Studio", Background::Studio),
    ("blurred", "Blurred", Background::Blurred),
    ("environment", "Sharp", Background::Environment),
    ("plain", "Plain", Background::Plain([0.028, 0.029, 0.032])),
];

/// View transforms, with their names in settings and their titles.
pub(crate) const TRANSFORMS: [(&str, &str, ViewTransform); 5] = [
    ("neutral", "Neutral", ViewTransform::Neutral),
    ("agx", "AgX", ViewTransform::AgX),
    ("punchy_agx", "AgX, punchy", ViewTransform::PunchyAgX),
    ("aces", "ACES", ViewTransform::Aces),
    ("standard", "Standard", ViewTransform::Standard),
];

/// Limits of a light besides the environment.
pub(crate) const LIGHT_HEIGHT_DEGREES: RangeInclusive<f32> = -90.0..=90.0;
pub(crate) const LIGHT_SIZE_DEGREES: RangeInclusive<f32> = 0.0..=60.0;
pub(crate) const LIGHT_STRENGTH: RangeInclusive<f32> = 0.0..=20.0;

/// A light besides the environment.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct LightSetting {
    /// Direction that it comes from: around the model, and above it.
    pub(crate) turn_degrees: f32,
    pub(crate) height_degrees: f32,
    /// Linear, 0..1.
    pub(crate) color: [f32; 3],
    pub(crate) strength: f32,
    pub(crate) has_shadow: bool,
    /// Angle across its disc: the larger, the softer its shadow.
    pub(crate) size_degrees: f32,
    /// True if it turns with the camera around the model.
    pub(crate) follows_camera: bool,
}

impl Default for LightSetting {
    /// From the left and above, as in the usual studio.
    fn default() -> LightSetting {
        LightSetting {
            turn_degrees: -40.0,
            height_degrees: 35.0,
            color: [1.0; 3],
            strength: 2.0,
            has_shadow: true,
            size_degrees: 2.0,
            follows_camera: false,
        }
    }
}

impl LightSetting {
    /// The lights that the viewport has at first.
    pub(crate) fn studio() -> Vec<LightSetting> {
        STUDIO_LIGHTS.iter().map(LightSetting::of).collect()
    }

    fn of(light: &Light) -> LightSetting {
        let (LightPlace::Directional(from) | LightPlace::Point(from)) = light.place;
        let [x, y, z] = from;
        let strength = light.color.into_iter().fold(0.0, f32::max);
        LightSetting {
            turn_degrees: x.atan2(z).to_degrees(),
            height_degrees: y.atan2(x.hypot(z)).to_degrees(),
            color: light.color.map(|part| part / strength.max(1e-6)),
            strength,
            has_shadow: light.has_shadow,
            size_degrees: light.size_degrees,
            follows_camera: light.follows_camera,
        }
    }

    /// The light with all values within their limits, since settings may have been edited by hand.
    pub(crate) fn sanitized(self) -> LightSetting {
        let usual = LightSetting::default();
        LightSetting {
            turn_degrees: within(self.turn_degrees, &TURN_DEGREES, usual.turn_degrees),
            height_degrees: within(self.height_degrees, &LIGHT_HEIGHT_DEGREES, usual.height_degrees),
            color: self.color.map(|number| within(number, &(0.0..=1.0), 1.0)),
            strength: within(self.strength, &LIGHT_STRENGTH, usual.strength),
            has_shadow: self.has_shadow,
            size_degrees: within(self.size_degrees, &LIGHT_SIZE_DEGREES, usual.size_degrees),
            follows_camera: self.follows_camera,
        }
    }
}

/// Light and picture of the viewport.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct ViewChoices {
    environment_turn_degrees: f32,
    environment_strength: f32,
    exposure_stops: f32,
    bloom: f32,
    transform: String,
    background: String,
    has_ground: bool,
    has_relief: bool,
    /// Lights besides the environment.
    pub(crate) lights: Vec<LightSetting>,
}

impl Default for ViewChoices {
    fn default() -> ViewChoices {
        ViewChoices {
            environment_turn_degrees: 0.0,
            environment_strength: STUDIO_ENVIRONMENT_STRENGTH,
            exposure_stops: 0.0,
            bloom: USUAL_BLOOM,
            transform: TRANSFORMS[0].0.to_owned(),
            background: BACKGROUNDS[0].0.to_owned(),
            has_ground: true,
            has_relief: false,
            lights: LightSetting::studio(),
        }
    }
}

impl ViewChoices {
    /// Choices that a shot and these lights show.
    pub(crate) fn of(shot: &Shot, lights: &[LightSetting]) -> ViewChoices {
        let transform = TRANSFORMS.iter().find(|(.., known)| *known == shot.transform);
        let background = BACKGROUNDS.iter().find(|(.., known)| *known == shot.background);
        let usual = ViewChoices::default();
        ViewChoices {
            // A drag may turn it by more than a whole turn.
            environment_turn_degrees: (shot.environment_turn_degrees + 180.0).rem_euclid(360.0) - 180.0,
            environment_strength: shot.environment_strength,
            exposure_stops: shot.exposure_stops,
            bloom: shot.bloom,
            transform: transform.map_or(usual.transform, |(name, ..)| (*name).to_owned()),
            background: background.map_or(usual.background, |(name, ..)| (*name).to_owned()),
            has_ground: shot.has_ground,
            has_relief: shot.has_relief,
            lights: lights.to_vec(),
        }
        .sanitized()
    }

    /// Applies the choices to a shot, except for the lights.
    pub(crate) fn apply(&self, shot: &mut Shot) {
        shot.environment_turn_degrees = self.environment_turn_degrees;
        shot.environment_strength = self.environment_strength;
        shot.exposure_stops = self.exposure_stops;
        shot.bloom = self.bloom;
        shot.has_ground = self.has_ground;
        shot.has_relief = self.has_relief;
        for (name, _, transform) in TRANSFORMS {
            if name == self.transform {
                shot.transform = transform;
            }
        }
        for (name, _, background) in BACKGROUNDS {
            if name == self.background {
                shot.background = background;
            }
        }
    }

    /// Choices with all values within their limits, since settings may have been edited by hand.
    pub(crate) fn sanitized(mut self) -> ViewChoices {
        let usual = ViewChoices::default();
        for (number, limits, usual) in [
            (
                &mut self.environment_turn_degrees,
                TURN_DEGREES,
                usual.environment_turn_degrees,
            ),
            (&mut self.environment_strength, STRENGTH, usual.environment_strength),
            (&mut self.exposure_stops, EXPOSURE_STOPS, usual.exposure_stops),
            (&mut self.bloom, BLOOM, usual.bloom),
        ] {
            *number = within(*number, &limits, usual);
        }
        if !TRANSFORMS.iter().any(|(name, ..)| *name == self.transform) {
            self.transform = usual.transform;
        }
        if !BACKGROUNDS.iter().any(|(name, ..)| *name == self.background) {
            self.background = usual.background;
        }
        self
    }
}

/// A number clamped to its limits; the default for one that is not finite.
pub(crate) fn within(number: f32, limits: &RangeInclusive<f32>, usual: f32) -> f32 {
    match number.is_finite() {
        true => number.clamp(*limits.start(), *limits.end()),
        false => usual,
    }
}

#[cfg(test)]
mod tests {
    use sabi_view::Camera;

    use super::*;

    #[test]
    fn choices_are_restored_and_invalid_ones_are_replaced() {
        let mut shot = Shot::new(Camera::default());
        shot.has_ground = true;
        shot.background = Background::Studio;
        shot.environment_strength = STUDIO_ENVIRONMENT_STRENGTH;
        assert_eq!(ViewChoices::of(&shot, &LightSetting::studio()), ViewChoices::default());
        shot.exposure_stops = -1.5;
        shot.bloom = 0.75;
        shot.environment_turn_degrees = 400.0;
        shot.transform = ViewTransform::Standard;
        shot.background = BACKGROUNDS[3].2;
        shot.has_relief = true;
        let kept = ViewChoices::of(&shot, &[]);
        let text = serde_json::to_string(&kept).expect("text");
        let read: ViewChoices = serde_json::from_str(&text).expect("choices");
        let mut other = Shot::new(Camera::default());
        read.sanitized().apply(&mut other);
        shot.environment_turn_degrees = 40.0;
        assert_eq!(other, shot);
        let nonsense = r#"{ "exposure_stops": 900, "bloom": -2, "environment_strength": -3, "transform": "sepia", "background": "" }"#;
        let read: ViewChoices = serde_json::from_str(nonsense).expect("choices");
        let expected = ViewChoices {
            exposure_stops: 6.0,
            bloom: 0.0,
            environment_strength: 0.0,
            ..ViewChoices::default()
        };
        assert_eq!(read.sanitized(), expected);
    }
}
