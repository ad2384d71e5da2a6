//! Steps as bytes.

use std::sync::Arc;

use glam::DVec3;
use sabi_surface::patch::Site;
use serde::{Deserialize, Serialize};

use crate::brush::Brush;
use crate::brush_limits::Eye;
use crate::octahedral::{from_octahedral, octahedral};
use crate::path_form::PathForm;
use crate::pen::Shaft;
use crate::stencil::Stencil;
use crate::stroke::{Action, Area, CopyOf, Step, Stroke, StrokeGroup, StrokePoint};
use crate::version::Version;

/// Bytes of a point.
const POINT_BYTES: usize = 4 + 4 + 12 + 4 + 2;
/// Maximum number of points of a stroke. Nobody draws so many by hand.
pub(crate) const POINTS_LIMIT: usize = 1 << 20;
/// Byte after the shafts. Older versions of the program, which know only points, refuse such a step whatever its length
/// instead of misreading it.
const SHAFTS_END: u8 = 0;
/// Flag of a point at which a new run starts.
const START_BIT: u16 = 1 << 15;

/// Description of a step.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum StepDescription {
    Add {
        #[serde(default, skip_serializing_if = "String::is_empty")]
        name: String,
        #[serde(default)]
        action: Action,
        #[serde(default)]
        area: Area,
        brush: Box<Brush>,
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        hidden: bool,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        eye: Option<Eye>,
        /// True if the first point is the source of a copy and not part of the way.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        source: bool,
        #[serde(default, skip_serializing_if = "CopyOf::is_paint")]
        copy_of: CopyOf,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        path: Option<PathForm>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stencil: Option<Stencil>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        group: Option<StrokeGroup>,
        /// True if the shafts of the pen follow the points.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        shafts: bool,
    },
    Group {
        strokes: Vec<String>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        group: Option<StrokeGroup>,
    },
    Remove {
        strokes: Vec<String>,
    },
    Change {
        stroke: String,
        #[serde(default)]
        name: String,
        brush: Box<Brush>,
        #[serde(default)]
        hidden: bool,
    },
    Move {
        stroke: String,
        to: usize,
    },
    Place {
        stroke: String,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        eye: Option<Eye>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        path: Option<PathForm>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stencil: Option<Stencil>,
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        shafts: bool,
    },
}

/// Encodes a step as bytes.
pub(crate) fn encode_step(step: &Step) -> Vec<u8> {
    let (source, points): (Option<StrokePoint>, &[StrokePoint]) = match step {
        Step::Add(stroke) => (stroke.source, &stroke.points),
        Step::Place { points, .. } => (None, points),
        Step::Remove(_) | Step::Change { .. } | Step::Move { .. } | Step::Group { .. } => (None, &[]),
    };
    // Numbers of a bounded brush are finite, so JSON can represent all of them.
    let text = serde_json::to_vec(&description_of(step)).unwrap_or_default();
    let mut bytes = (text.len() as u32).to_le_bytes().to_vec();
    bytes.extend_from_slice(&text);
    for point in source.iter().chain(points) {
        push_point(&mut bytes, point);
    }
    if have_shafts(source.iter().chain(points)) {
        let shafts = source.iter().chain(points).map(|point| Shaft::bytes_of(point.shaft));
        bytes.extend(shafts.flatten());
        bytes.push(SHAFTS_END);
    }
    bytes
}

/// Returns the description of a step: everything except its points.
pub(crate) fn description_of(step: &Step) -> StepDescription {
    match step {
        Step::Add(stroke) => StepDescription::Add {
            name: stroke.name.clone(),
            action: stroke.action,
            area: stroke.area,
            brush: Box::new(stroke.brush.bounded()),
            hidden: stroke.is_hidden,
            eye: stroke.eye.filter(Eye::is_finite),
            source: stroke.source.is_some(),
            copy_of: stroke.copy_of,
            path: stroke.path.clone(),
            stencil: written(&stroke.stencil),
            group: stroke.group.as_ref().map(|group| group.bounded()),
            shafts: have_shafts(stroke.source.iter().chain(&stroke.points)),
        },
        Step::Group { strokes, group } => StepDescription::Group {
            strokes: strokes.iter().map(Version::to_string).collect(),
            group: group.as_ref().map(|group| group.bounded()),
        },
        Step::Place {
            stroke,
            path,
            eye,
            stencil,
            points,
        } => StepDescription::Place {
            shafts: have_shafts(points),
            stroke: stroke.to_string(),
            path: path.clone(),
            eye: eye.filter(Eye::is_finite),
            stencil: written(stencil),
        },
        Step::Remove(strokes) => StepDescription::Remove {
            strokes: strokes.iter().map(Version::to_string).collect(),
        },
        Step::Change {
            stroke,
            name,
            brush,
            is_hidden,
        } => StepDescription::Change {
            stroke: stroke.to_string(),
            name: name.clone(),
            brush: Box::new(brush.bounded()),
            hidden: *is_hidden,
        },
        Step::Move { stroke, to } => StepDescription::Move {
            stroke: stroke.to_string(),
            to: *to,
        },
    }
}

/// Returns true if the shaft of the pen is known at any of some points.
fn have_shafts<'a>(points: impl IntoIterator<Item = &'a StrokePoint>) -> bool {
    points.into_iter().any(|point| point.shaft.is_some())
}

/// Returns a stencil in the form in which a step describes it.
fn written(stencil: &Option<Arc<Stencil>>) -> Option<Stencil> {
    stencil.as_deref().filter(|stencil| stencil.is_finite()).cloned()
}

/// Decodes a step. `version` is the version that it leads to. Returns `None` if the bytes are not a step.
pub(crate) fn decode_step(bytes: &[u8], version: Version) -> Option<Step> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    let length = u32::from_le_bytes(*length) as usize;
    let (text, points) = rest.split_at_checked(length)?;
    let id = |text: &str| text.parse::<Version>().ok();
    let ids = |texts: &[String]| texts.iter().map(|text| id(text)).collect::<Option<Vec<Version>>>();
    Some(match serde_json::from_slice(text).ok()? {
        description @ StepDescription::Add { shafts, .. } => {
            Step::Add(Arc::new(added(description, points_of(points, shafts)?, version)?))
        }
        StepDescription::Remove { strokes } => Step::Remove(ids(&strokes)?),
        StepDescription::Group { strokes, group } => Step::Group {
            strokes: ids(&strokes)?,
            group: group.map(|group| Arc::new(group.bounded())),
        },
        StepDescription::Change {
            stroke,
            name,
            brush,
            hidden,
        } => Step::Change {
            stroke: id(&stroke)?,
            name,
            brush: Box::new(brush.bounded()),
            is_hidden: hidden,
        },
        StepDescription::Move { stroke, to } => Step::Move {
            stroke: id(&stroke)?,
            to,
        },
        StepDescription::Place {
            stroke,
            eye,
            path,
            stencil,
            shafts,
        } => Step::Place {
            eye,
            path,
            stencil: stencil.map(Arc::new),
            stroke: id(&stroke)?,
            points: points_of(points, shafts)?,
        },
    })
}

/// Returns the stroke that a description adds; `None` for other descriptions. If the stroke has a source, it is the first of the points.
pub(crate) fn added(description: StepDescription, mut points: Vec<StrokePoint>, id: Version) -> Option<Stroke> {
    let StepDescription::Add {
        name,
        action,
        area,
        brush,
        hidden,
        eye,
        source,
        copy_of,
        path,
        stencil,
        group,
        shafts: _,
    } = description
    else {
        return None;
    };
    let source = (source && !points.is_empty()).then(|| points.remove(0));
    Some(Stroke {
        id,
        name,
        brush: brush.bounded(),
        action,
        area,
        is_hidden: hidden,
        eye,
        source,
        copy_of,
        group: group.map(|group| Arc::new(group.bounded())),
        path,
        stencil: stencil.map(Arc::new),
        points,
    })
}

/// Decodes points, which are followed by the shafts of the pen if `have_shafts` is true.
fn points_of(bytes: &[u8], have_shafts: bool) -> Option<Vec<StrokePoint>> {
    if have_shafts {
        let (end, bytes) = bytes.split_last()?;
        let count = bytes.len() / (POINT_BYTES + Shaft::BYTES);
        let (points, shafts) = bytes.split_at_checked(count * POINT_BYTES)?;
        let (shafts, rest) = shafts.as_chunks::<{ Shaft::BYTES }>();
        if *end != SHAFTS_END || !rest.is_empty() || shafts.len() != count {
            return None;
        }
        let mut points = points_of(points, false)?;
        for (point, shaft) in points.iter_mut().zip(shafts) {
            point.shaft = Shaft::of_bytes(*shaft);
        }
        return Some(points);
    }
    if !bytes.len().is_multiple_of(POINT_BYTES) || bytes.len() > POINTS_LIMIT * POINT_BYTES {
        return None;
    }
    bytes.chunks_exact(POINT_BYTES).map(point_of).collect()
}

fn push_point(bytes: &mut Vec<u8>, point: &StrokePoint) {
    bytes.extend_from_slice(&point.site.triangle.to_le_bytes());
    bytes.extend_from_slice(&point.triangle_key.to_le_bytes());
    for value in point.site.position.to_array() {
        bytes.extend_from_slice(&(value as f32).to_le_bytes());
    }
    for value in octahedral(point.normal) {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    let pressure = (point.pressure.clamp(0.0, 1.0) * f32::from(START_BIT - 1)).round() as u16;
    let flag = if point.starts { START_BIT } else { 0 };
    bytes.extend_from_slice(&(pressure | flag).to_le_bytes());
}

fn point_of(bytes: &[u8]) -> Option<StrokePoint> {
    let word = |at: usize| bytes.get(at..at + 4)?.first_chunk::<4>().copied();
    let half = |at: usize| bytes.get(at..at + 2)?.first_chunk::<2>().copied();
    let mut position = [0.0; 3];
    for (axis, value) in position.iter_mut().enumerate() {
        *value = f64::from(f32::from_le_bytes(word(8 + 4 * axis)?));
    }
    let position = DVec3::from(position);
    let packed = u16::from_le_bytes(half(24)?);
    position.is_finite().then_some(StrokePoint {
        site: Site {
            triangle: u32::from_le_bytes(word(0)?),
            position,
        },
        triangle_key: u32::from_le_bytes(word(4)?),
        normal: from_octahedral([i16::from_le_bytes(half(20)?), i16::from_le_bytes(half(22)?)]),
        pressure: f32::from(packed & !START_BIT) / f32::from(START_BIT - 1),
        starts: packed & START_BIT != 0,
        shaft: None,
    })
}
