//! Strokes as text, for the clipboard.
//!
//! The text is one JSON object: `sabi_strokes` is the version of the format, and `strokes` is a list of the descriptions of
//! the steps that add the strokes, each with its points as numbers: triangle, key, position, normal, pressure, and 1 if a
//! run starts there. If there are shafts of the pen at these points, they are a separate list, as in a stroke file.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::pen::Shaft;
use crate::step_bytes::{POINTS_LIMIT, StepDescription, added, description_of};
use crate::stroke::{Step, Stroke, StrokePoint};
use crate::version::Version;
use glam::DVec3;
use sabi_surface::patch::Site;
use std::sync::Arc;

/// Version of the format.
const FORMAT: u32 = 1;

/// Error of a text that contains no strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NoStrokes {
    /// The text is something else.
    #[error("the clipboard holds no strokes; copy some from the list of strokes first")]
    Other,
    /// The text is from a later version of the program.
    #[error("the strokes in the clipboard are of a newer version of Sabi")]
    Newer,
}

#[derive(Serialize, Deserialize)]
struct StrokesText {
    sabi_strokes: u32,
    strokes: Vec<StrokeText>,
}

#[derive(Serialize, Deserialize)]
struct StrokeText {
    step: StepDescription,
    points: Vec<PointText>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    shafts: Vec<Option<Shaft>>,
}

/// Triangle, key, position, normal, pressure, and whether a run starts.
type PointText = (u32, u32, [f32; 3], [f32; 3], f32, u8);

/// Returns strokes as a text, the lowest first.
pub fn strokes_as_text(strokes: &[Arc<Stroke>]) -> String {
    let texts = strokes.iter().map(|stroke| StrokeText {
        step: description_of(&Step::Add(Arc::clone(stroke))),
        points: stroke.source.iter().chain(&stroke.points).map(text_of).collect(),
        shafts: shafts_of(stroke),
    });
    let text = StrokesText {
        sabi_strokes: FORMAT,
        strokes: texts.collect(),
    };
    // Numbers of bounded brushes and of points are finite, so JSON can represent all of them.
    serde_json::to_string(&text).unwrap_or_default()
}

/// Returns true if a text begins like those of [`strokes_as_text`].
pub fn is_text_of_strokes(text: &str) -> bool {
    text.starts_with("{\"sabi_strokes\"")
}

/// Returns the strokes of a text, the lowest first.
///
/// # Errors
/// The text is something else, or of a later version of the program.
pub fn strokes_from_text(text: &str) -> Result<Vec<Stroke>, NoStrokes> {
    let value: serde_json::Value = serde_json::from_str(text).map_err(|_| NoStrokes::Other)?;
    let format = value.get("sabi_strokes").and_then(serde_json::Value::as_u64);
    match format {
        Some(format) if format > u64::from(FORMAT) => return Err(NoStrokes::Newer),
        Some(_) => {}
        None => return Err(NoStrokes::Other),
    }
    let text: StrokesText = serde_json::from_value(value).map_err(|_| NoStrokes::Other)?;
    let strokes = text.strokes.into_iter().map(|stroke| {
        if stroke.points.len() > POINTS_LIMIT {
            return None;
        }
        let points = stroke.points.into_iter().map(point_of);
        let mut points = points.collect::<Option<Vec<StrokePoint>>>()?;
        if !stroke.shafts.is_empty() && stroke.shafts.len() != points.len() {
            return None;
        }
        for (point, shaft) in points.iter_mut().zip(stroke.shafts) {
            point.shaft = shaft;
        }
        added(stroke.step, points, Version::EMPTY)
    });
    strokes.collect::<Option<_>>().ok_or(NoStrokes::Other)
}

/// Returns the shafts of the pen at the points of a stroke; empty if none is known.
fn shafts_of(stroke: &Stroke) -> Vec<Option<Shaft>> {
    let shafts: Vec<_> = stroke
        .source
        .iter()
        .chain(&stroke.points)
        .map(|point| point.shaft)
        .collect();
    if shafts.iter().any(Option::is_some) {
        shafts
    } else {
        Vec::new()
    }
}

fn text_of(point: &StrokePoint) -> PointText {
    let position = point.site.position.as_vec3().to_array();
    let starts = u8::from(point.starts);
    (
        point.site.triangle,
        point.triangle_key,
        position,
        point.normal,
        point.pressure,
        starts,
    )
}

fn point_of(text: PointText) -> Option<StrokePoint> {
    let (triangle, triangle_key, stored_position, normal, pressure, starts) = text;
    let position = DVec3::from(stored_position.map(f64::from));
    let is_finite = position.is_finite() && normal.iter().all(|number| number.is_finite()) && pressure.is_finite();
    is_finite.then(|| StrokePoint {
        site: Site { triangle, position },
        normal,
        triangle_key,
        pressure: pressure.clamp(0.0, 1.0),
        starts: starts != 0,
        shaft: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Action, Brush, StrokeGroup};

    fn stroke() -> Stroke {
        let point = |index: u32| StrokePoint {
            site: Site {
                triangle: index,
                position: DVec3::new(0.1_f32.into(), f64::from(index), 0.25),
            },
            normal: [0.0, 1.0, 0.0],
            triangle_key: 7 + index,
            pressure: 0.5,
            starts: index == 1,
            shaft: None,
        };
        Stroke {
            name: "Rust \"here\"".to_owned(),
            action: Action::Clone,
            source: Some(point(0)),
            group: Some(Arc::new(StrokeGroup {
                number: 3,
                name: "Hands".to_owned(),
                opacity: 0.5,
                is_hidden: false,
            })),
            ..Stroke::new(Brush::default(), vec![point(1), point(2)])
        }
    }

    #[test]
    fn strokes_converted_to_text_and_back_are_the_same() {
        let text = strokes_as_text(&[Arc::new(stroke())]);
        assert!(is_text_of_strokes(&text) && !is_text_of_strokes("{}"));
        assert_eq!(strokes_from_text(&text), Ok(vec![stroke()]));
    }

    #[test]
    fn other_texts_are_refused_with_an_error() {
        assert_eq!(strokes_from_text("{}"), Err(NoStrokes::Other));
        assert_eq!(strokes_from_text("[1, 2"), Err(NoStrokes::Other));
        let newer = strokes_as_text(&[]).replace(":1", ":2");
        let error = strokes_from_text(&newer).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the strokes in the clipboard are of a newer version of Sabi"
        );
        let odd = strokes_as_text(&[Arc::new(stroke())]).replace("0.25", "1e300");
        assert_eq!(strokes_from_text(&odd), Err(NoStrokes::Other));
    }
}
