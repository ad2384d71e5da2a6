//! Viewpoints, and their text form.

use std::str::FromStr;

/// Direction and relative distance of a camera, independent of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Side of the model that faces the camera: 0 is the front (+Z), 90 the right (+X).
    pub yaw_degrees: f32,
    /// Elevation of the camera: 90 looks straight down.
    pub pitch_degrees: f32,
    /// Multiple of the distance that frames the model.
    pub distance: f32,
}

/// Range of distances in a text.
const DISTANCES: [f32; 2] = [0.01, 100.0];

impl Viewpoint {
    /// Viewpoints by name. Left and right are those in the front view.
    pub const NAMED: [(&'static str, Viewpoint); 7] = [
        ("front", Viewpoint::at(0.0, 0.0)),
        ("three-quarter", Viewpoint::at(35.0, 20.0)),
        ("left", Viewpoint::at(-90.0, 0.0)),
        ("right", Viewpoint::at(90.0, 0.0)),
        ("back", Viewpoint::at(180.0, 0.0)),
        ("top", Viewpoint::at(0.0, 90.0)),
        ("bottom", Viewpoint::at(0.0, -90.0)),
    ];
    /// The side of +Z, which is the front in glTF.
    pub const FRONT: Viewpoint = Viewpoint::NAMED[0].1;
    /// From the right and slightly above, the usual way to show a model.
    pub const THREE_QUARTER: Viewpoint = Viewpoint::NAMED[1].1;

    /// Returns the viewpoint in a direction, at the distance that frames the model.
    pub const fn at(yaw_degrees: f32, pitch_degrees: f32) -> Viewpoint {
        Viewpoint {
            yaw_degrees,
            pitch_degrees,
            distance: 1.0,
        }
    }
}

impl FromStr for Viewpoint {
    type Err = ViewpointError;

    /// Reads a name of [`Viewpoint::NAMED`], or `YAW,PITCH[,DISTANCE]`.
    fn from_str(text: &str) -> Result<Viewpoint, ViewpointError> {
        let name = text.trim();
        let named = Viewpoint::NAMED
            .iter()
            .find(|(known, _)| known.eq_ignore_ascii_case(name));
        if let Some((_, viewpoint)) = named {
            return Ok(*viewpoint);
        }
        let parts: Vec<&str> = name.split(',').map(str::trim).collect();
        let (yaw, pitch, distance) = match parts[..] {
            [yaw, pitch] => (yaw, pitch, "1"),
            [yaw, pitch, distance] => (yaw, pitch, distance),
            _ => return Err(ViewpointError::Unknown { text: name.to_string() }),
        };
        let number = |what, part: &str| {
            let number = part.parse().ok().filter(|number: &f32| number.is_finite());
            number.ok_or_else(|| ViewpointError::NoNumber {
                text: name.to_string(),
                what,
                part: part.to_string(),
            })
        };
        let viewpoint = Viewpoint {
            yaw_degrees: number("yaw", yaw)?,
            pitch_degrees: number("pitch", pitch)?,
            distance: number("distance", distance)?,
        };
        if !(-90.0..=90.0).contains(&viewpoint.pitch_degrees) {
            return Err(ViewpointError::Pitch {
                pitch: pitch.to_string(),
            });
        }
        if !(DISTANCES[0]..=DISTANCES[1]).contains(&viewpoint.distance) {
            return Err(ViewpointError::Distance {
                distance: distance.to_string(),
            });
        }
        Ok(viewpoint)
    }
}

fn names() -> String {
    Viewpoint::NAMED.map(|(name, _)| name).join(", ")
}

/// Error in a text that should be a viewpoint. Its display is a sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ViewpointError {
    /// The text is neither a name nor numbers.
    #[error(
        "{text:?} is no view of the model; use one of {}, or YAW,PITCH[,DISTANCE] in degrees and in multiples of the \
         distance that frames the model, as in 35,20 or 35,20,1.5",
        names()
    )]
    Unknown {
        /// Text that was given.
        text: String,
    },
    /// A part of the text should be a number.
    #[error("the {what} of the view {text:?} is {part:?}, which is no number; write it as in 35,20 or 35,20,1.5")]
    NoNumber {
        /// Text that was given.
        text: String,
        /// `yaw`, `pitch` or `distance`.
        what: &'static str,
        /// The part that should be a number.
        part: String,
    },
    /// The pitch is beyond straight up or down.
    #[error("a view with a pitch of {pitch} degrees was asked for, but it has to be between -90 and 90")]
    Pitch {
        /// Text that was given.
        pitch: String,
    },
    /// The distance is not above 0.
    #[error(
        "a view from {distance} times the distance that frames the model was asked for, but it has to be between 0.01 \
         and 100"
    )]
    Distance {
        /// Text that was given.
        distance: String,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        text.parse::<Viewpoint>().unwrap_err().to_string()
    }

    #[test]
    fn a_viewpoint_is_a_name_or_two_or_three_numbers() {
        assert_eq!("front".parse(), Ok(Viewpoint::FRONT));
        assert_eq!(" Three-Quarter ".parse(), Ok(Viewpoint::THREE_QUARTER));
        for (name, viewpoint) in Viewpoint::NAMED {
            assert_eq!(name.parse(), Ok(viewpoint));
        }
        assert_eq!("-30, 12.5".parse(), Ok(Viewpoint::at(-30.0, 12.5)));
        let far = Viewpoint {
            distance: 2.0,
            ..Viewpoint::at(400.0, 0.0)
        };
        assert_eq!("400,0,2".parse(), Ok(far));
    }

    #[test]
    fn an_error_for_a_wrong_viewpoint_says_what_a_viewpoint_is() {
        assert_eq!(
            refused("sideways"),
            "\"sideways\" is no view of the model; use one of front, three-quarter, left, right, back, top, bottom, or \
             YAW,PITCH[,DISTANCE] in degrees and in multiples of the distance that frames the model, as in 35,20 or \
             35,20,1.5"
        );
        for text in ["", "30", "1,2,3,4"] {
            assert!(refused(text).starts_with(&format!("{text:?} is no view of the model; ")));
        }
        assert_eq!(
            refused("30,up"),
            "the pitch of the view \"30,up\" is \"up\", which is no number; write it as in 35,20 or 35,20,1.5"
        );
        assert!(refused("nan,0").starts_with("the yaw of the view \"nan,0\" is \"nan\", which is no number"));
        assert!(refused("0,0,inf").starts_with("the distance of the view"));
    }

    #[test]
    fn numbers_out_of_range_are_refused_with_the_range() {
        assert_eq!(
            refused("0,120"),
            "a view with a pitch of 120 degrees was asked for, but it has to be between -90 and 90"
        );
        assert_eq!(
            refused("0,0,0"),
            "a view from 0 times the distance that frames the model was asked for, but it has to be between 0.01 and 100"
        );
    }
}
