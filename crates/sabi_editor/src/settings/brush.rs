//! The brush, as it is kept between runs.

use std::ops::RangeInclusive;

use sabi_paint::{
    Action, Area, Brush, BrushLimits, CopyOf, EdgeKind, Fade, Jitter, PenEffects, PictureTip, Stroke, Symmetry, Tip,
    TipDirection,
};
use serde::{Deserialize, Serialize};

/// Limits of the brush's size, shares of the model's largest side.
pub(crate) const SIZES: RangeInclusive<f32> = 0.001..=0.5;
/// Limits of the height that a stroke adds or carves, shares of the model's largest side.
pub(crate) const HEIGHTS: RangeInclusive<f32> = -0.02..=0.02;
/// Limits of the distance between two stamps, shares of the radius.
pub(crate) const SPACINGS: RangeInclusive<f32> = 0.02..=4.0;
/// Limits of the brush's size on the screen, points.
pub(crate) const POINTS: RangeInclusive<f32> = 1.0..=400.0;
/// Limits of the length of the string that the brush hangs on, points.
pub(crate) const LAGS: RangeInclusive<f32> = 0.0..=80.0;
/// Change of the size by one press of a key.
const SIZE_STEP: f32 = 1.15;

/// Brush, as it is kept between runs. Lengths are shares of the largest side of the model, so that a brush fits any.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct BrushChoices {
    pub(crate) tip: Tip,
    /// Picture that is stamped instead of the tip.
    pub(crate) picture: Option<PictureTip>,
    /// Action of the brush.
    pub(crate) action: Action,
    /// Source of a clone: the paint of the node or another node.
    pub(crate) copy_of: CopyOf,
    /// Area that strokes act on.
    pub(crate) area: Area,
    /// Way in which strokes are drawn.
    pub(crate) hand: Hand,
    /// Radius.
    pub(crate) size: f32,
    /// Share of the radius that is painted in full.
    pub(crate) hardness: f32,
    /// Course of its fade from the hard part to its border.
    pub(crate) fade: Fade,
    pub(crate) flow: f32,
    pub(crate) opacity: f32,
    /// Distance between two stamps, as a share of the radius.
    pub(crate) spacing: f32,
    /// Direction that the tip follows.
    pub(crate) turn: TipDirection,
    /// Turn of the tip away from it, degrees.
    pub(crate) angle_degrees: f32,
    pub(crate) jitter: Jitter,
    /// Limits of the places that strokes change.
    pub(crate) limits: BrushLimits,
    /// Angle of the edges up to which a side is filled, degrees.
    pub(crate) side_degrees: f32,
    /// Difference of coverage at which a fill ends.
    pub(crate) tolerance: f32,
    pub(crate) symmetry: Symmetry,
    /// True if strokes stay on the piece under the pointer.
    pub(crate) stays_on_piece: bool,
    /// Value of the mask.
    pub(crate) value: f32,
    /// Linear color.
    pub(crate) color: [f32; 3],
    /// Height that is added; below 0 it carves.
    pub(crate) height: f32,
    /// Effects of the pressure of a pen.
    pub(crate) pressure: PenEffects,
    /// Effects of the tilt of a pen.
    pub(crate) tilt: PenEffects,
    /// True if the size is measured on the screen, where a stroke begins.
    pub(crate) is_on_screen: bool,
    /// Radius on the screen, points.
    pub(crate) points: f32,
    /// Length of the string on which the pointer pulls the brush, points: it smooths the hand.
    pub(crate) lag: f32,
}

/// Way in which strokes are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Hand {
    /// By drags.
    #[default]
    Free,
    /// Through knots that are clicked.
    Path,
    /// Along the edges next to a click that bend sharply.
    HardEdges,
    /// Along the seams of the texture next to a click.
    Seams,
    /// Along the border between materials next to a click.
    Materials,
}

impl Hand {
    /// All of them with their titles.
    pub(crate) const ALL: [(Hand, &'static str); 5] = [
        (Hand::Free, "By hand"),
        (Hand::Path, "Path"),
        (Hand::HardEdges, "Edges"),
        (Hand::Seams, "Seams"),
        (Hand::Materials, "Borders"),
    ];

    /// Kind of edge that a click follows.
    pub(crate) fn edges(self) -> Option<EdgeKind> {
        match self {
            Hand::Free | Hand::Path => None,
            Hand::HardEdges => Some(EdgeKind::Hard),
            Hand::Seams => Some(EdgeKind::Seam),
            Hand::Materials => Some(EdgeKind::Material),
        }
    }
}

impl Default for BrushChoices {
    fn default() -> BrushChoices {
        BrushChoices {
            tip: Tip::Round,
            picture: None,
            action: Action::Paint,
            copy_of: CopyOf::default(),
            area: Area::Way,
            hand: Hand::default(),
            size: 0.04,
            hardness: 0.5,
            fade: Fade::default(),
            flow: 1.0,
            opacity: 1.0,
            spacing: Brush::default().spacing,
            turn: TipDirection::default(),
            angle_degrees: 0.0,
            jitter: Jitter::default(),
            limits: BrushLimits::default(),
            side_degrees: Brush::default().side_degrees,
            tolerance: Brush::default().tolerance,
            symmetry: Symmetry::default(),
            stays_on_piece: false,
            value: 1.0,
            color: [0.35, 0.13, 0.05],
            height: 0.0,
            pressure: PenEffects::default(),
            tilt: PenEffects::NONE,
            is_on_screen: false,
            points: 24.0,
            lag: 0.0,
        }
    }
}

impl BrushChoices {
    /// The brush on a model with this largest side, model units.
    pub(crate) fn brush(&self, largest_side: f64) -> Brush {
        let length = |share: f32| (f64::from(share) * largest_side) as f32;
        Brush {
            tip: self.tip,
            picture: self.picture.clone(),
            radius: length(self.size),
            hardness: self.hardness,
            flow: self.flow,
            opacity: self.opacity,
            spacing: self.spacing,
            turn: self.turn,
            angle_degrees: self.angle_degrees,
            jitter: self.jitter,
            limits: self.limits,
            symmetry: self.symmetry,
            reaches_pieces: !self.stays_on_piece,
            value: self.value,
            color: self.color,
            height: length(self.height),
            pressure: self.pressure,
            tilt: self.tilt,
            fade: self.fade,
            side_degrees: self.side_degrees,
            tolerance: self.tolerance,
        }
        .bounded()
    }

    /// The brush with another tip, and the stamps that suit it; bands lie along ribbons.
    pub(crate) fn with_tip(&self, tip: Tip) -> BrushChoices {
        let stamps = tip.stamps();
        BrushChoices {
            tip,
            picture: None,
            area: match self.area {
                _ if tip.is_band() => Area::Ribbon,
                Area::Ribbon if self.tip.is_band() => Area::Way,
                area if self.picture.is_some() && area.is_single() => Area::Way,
                area => area,
            },
            spacing: stamps.spacing,
            flow: stamps.flow,
            hardness: stamps.hardness,
            jitter: stamps.jitter,
            turn: stamps.turn,
            ..self.clone()
        }
    }

    /// The brush with a picture as its tip. It lays decals, labels or ribbons if it did so before, strokes if it
    /// stamped a picture before, and decals otherwise.
    pub(crate) fn with_picture(&self, picture: PictureTip) -> BrushChoices {
        let area = match self.area {
            Area::Decal | Area::Label | Area::Ribbon => self.area,
            Area::Way if self.picture.is_some() => Area::Way,
            _ => Area::Decal,
        };
        BrushChoices {
            picture: Some(picture),
            action: Action::Paint,
            area,
            spacing: 2.2,
            flow: 1.0,
            jitter: Jitter::default(),
            turn: TipDirection::Stroke,
            ..self.clone()
        }
    }

    /// The brush of a stroke on a model with this largest side, model units.
    pub(crate) fn like(&self, stroke: &Stroke, largest_side: f64) -> BrushChoices {
        let brush = stroke.brush.bounded();
        let share = |length: f32| (f64::from(length) / largest_side) as f32;
        BrushChoices {
            tip: brush.tip,
            picture: brush.picture.clone(),
            action: stroke.action,
            copy_of: stroke.copy_of,
            area: stroke.area,
            hand: self.hand,
            size: share(brush.radius),
            hardness: brush.hardness,
            flow: brush.flow,
            opacity: brush.opacity,
            spacing: brush.spacing,
            turn: brush.turn,
            angle_degrees: brush.angle_degrees,
            jitter: brush.jitter,
            limits: brush.limits,
            symmetry: brush.symmetry,
            stays_on_piece: !brush.reaches_pieces,
            value: brush.value,
            color: brush.color,
            height: share(brush.height),
            pressure: brush.pressure,
            tilt: brush.tilt,
            fade: brush.fade,
            side_degrees: brush.side_degrees,
            tolerance: brush.tolerance,
            is_on_screen: false,
            points: self.points,
            lag: self.lag,
        }
        .sanitized()
    }

    /// True if strokes need a place that they copy from.
    pub(crate) fn needs_source(&self) -> bool {
        self.action == Action::Clone && self.copy_of == CopyOf::Paint
    }

    /// Source of a stroke with this action: the chosen one, if it clones.
    pub(crate) fn copy_of_stroke(&self, action: Action) -> CopyOf {
        if action == Action::Clone {
            self.copy_of
        } else {
            CopyOf::default()
        }
    }

    /// Way in which strokes of its area are drawn: fills and decals by clicks and drags alone.
    pub(crate) fn used_hand(&self) -> Hand {
        let follows = self.action.adjusts() || matches!(self.area, Area::Way | Area::Ribbon | Area::Inside);
        if follows { self.hand } else { Hand::Free }
    }

    /// The brush one step larger or smaller.
    pub(crate) fn resized(&self, is_larger: bool) -> BrushChoices {
        let factor = if is_larger { SIZE_STEP } else { 1.0 / SIZE_STEP };
        BrushChoices {
            size: if self.is_on_screen {
                self.size
            } else {
                self.size * factor
            },
            points: if self.is_on_screen {
                self.points * factor
            } else {
                self.points
            },
            ..self.clone()
        }
        .sanitized()
    }

    /// The brush with every number in its limits, whatever a file holds.
    pub(crate) fn sanitized(self) -> BrushChoices {
        let usual = BrushChoices::default();
        let within = |value: f32, usual: f32, limits: RangeInclusive<f32>| match value.is_finite() {
            true => value.clamp(*limits.start(), *limits.end()),
            false => usual,
        };
        let share = |value: f32, usual: f32| within(value, usual, 0.0..=1.0);
        BrushChoices {
            size: within(self.size, usual.size, SIZES),
            hardness: share(self.hardness, usual.hardness),
            flow: share(self.flow, usual.flow),
            opacity: share(self.opacity, usual.opacity),
            spacing: within(self.spacing, usual.spacing, SPACINGS),
            angle_degrees: within(self.angle_degrees, 0.0, -180.0..=180.0),
            lag: within(self.lag, 0.0, LAGS),
            points: within(self.points, usual.points, POINTS),
            // The brush bounds the rest of them whenever it is used.
            jitter: self.jitter,
            symmetry: self.symmetry,
            value: share(self.value, usual.value),
            color: self.color.map(|value| share(value, 0.0)),
            height: within(self.height, usual.height, HEIGHTS),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brush_of_a_damaged_file_has_every_number_in_its_limits() {
        let odd = BrushChoices {
            size: f32::NAN,
            flow: 9.0,
            height: -3.0,
            ..BrushChoices::default()
        };
        let sane = odd.sanitized();
        assert_eq!(
            (sane.size, sane.flow, sane.height),
            (BrushChoices::default().size, 1.0, -0.02)
        );
    }

    #[test]
    fn a_tip_brings_the_stamps_that_suit_it_and_a_round_one_the_usual_ones() {
        let brush = BrushChoices::default();
        for (tip, _) in Tip::ALL {
            let changed = brush.with_tip(tip);
            assert_eq!(changed, changed.clone().sanitized());
            assert_eq!(changed.with_tip(Tip::Round), brush);
        }
    }

    #[test]
    fn the_brush_of_a_stroke_is_the_one_that_it_was_drawn_with() {
        let brush = BrushChoices {
            size: 0.1,
            height: -0.01,
            stays_on_piece: true,
            ..BrushChoices::default().with_tip(Tip::Chalk)
        };
        let stroke = Stroke::new(brush.brush(4.0), Vec::new());
        assert_eq!(BrushChoices::default().like(&stroke, 4.0), brush);
    }

    #[test]
    fn the_size_follows_the_model_and_keys_change_it_within_its_limits() {
        let brush = BrushChoices::default();
        assert!((brush.brush(10.0).radius - 10.0 * brush.size).abs() < 1e-6);
        let largest = (0..99).fold(brush.clone(), |brush, _| brush.resized(true));
        assert_eq!(largest.size, *SIZES.end());
        assert!(brush.resized(false).size < brush.size);
    }
}
