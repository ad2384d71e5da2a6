//! Settings of a brush that suit each tip.

use crate::brush::{Brush, TipDirection};
use crate::dynamics::Jitter;
use crate::tips::Tip;

/// Settings of the stamps of a brush that suit its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamps {
    /// As [`Brush::spacing`].
    pub spacing: f32,
    /// As [`Brush::flow`].
    pub flow: f32,
    /// As [`Brush::hardness`].
    pub hardness: f32,
    /// As [`Brush::jitter`].
    pub jitter: Jitter,
    /// As [`Brush::turn`].
    pub turn: TipDirection,
}

impl Tip {
    /// Returns settings that suit the tip.
    pub fn stamps(self) -> Stamps {
        // Spacing, flow and hardness; then jitter of position, size, angle in degrees, and flow.
        let (base, jitter): ([f32; 3], [f32; 4]) = match self {
            Tip::Round => ([0.15, 1.0, 0.5], [0.0; 4]),
            Tip::Soft => ([0.1, 0.2, 0.0], [0.0; 4]),
            Tip::Square => ([0.5, 1.0, 0.5], [0.0; 4]),
            Tip::Chalk => ([0.1, 0.6, 0.5], [0.0; 4]),
            Tip::Sponge => ([0.75, 1.0, 0.45], [0.15, 0.2, 180.0, 0.15]),
            Tip::Spray => ([0.3, 0.8, 0.5], [0.0; 4]),
            Tip::Bristles => ([0.08, 0.5, 0.5], [0.0; 4]),
            Tip::DryBrush => ([0.1, 1.0, 0.55], [0.0; 4]),
            Tip::Splatter => ([0.9, 1.0, 0.5], [0.6, 0.5, 180.0, 0.0]),
            Tip::Drips => ([0.85, 1.0, 0.97], [0.12, 0.4, 0.0, 0.0]),
            Tip::Leaks => ([0.6, 1.0, 0.9], [0.15, 0.45, 1.5, 0.3]),
            Tip::Ring => ([1.7, 1.0, 0.97], [0.15, 0.5, 180.0, 0.3]),
            Tip::Scratches => ([0.7, 1.0, 0.95], [0.3, 0.4, 12.0, 0.3]),
            Tip::Scuffs => ([0.55, 1.0, 0.9], [0.25, 0.3, 9.0, 0.3]),
            Tip::Gouge => ([1.8, 1.0, 0.97], [0.15, 0.45, 8.0, 0.15]),
            Tip::Cracks => ([1.5, 1.0, 0.97], [0.1, 0.3, 180.0, 0.0]),
            Tip::Crackle => ([0.15, 1.0, 0.35], [0.0; 4]),
            Tip::Flakes => ([0.9, 1.0, 0.97], [0.3, 0.5, 180.0, 0.0]),
            Tip::Pits => ([0.7, 1.0, 0.95], [0.25, 0.4, 180.0, 0.1]),
            Tip::Fingerprint => ([2.2, 1.0, 0.97], [0.1, 0.12, 35.0, 0.4]),
            Tip::Lint => ([0.9, 1.0, 0.95], [0.3, 0.3, 180.0, 0.3]),
            Tip::Moss => ([0.15, 1.0, 0.3], [0.0; 4]),
            Tip::Lichen => ([1.1, 1.0, 0.97], [0.3, 0.5, 180.0, 0.15]),
            Tip::Weld | Tip::Rope => ([2.0, 1.0, 0.9], [0.0; 4]),
            Tip::Stitches | Tip::Rivets => ([2.0, 1.0, 0.97], [0.0; 4]),
            Tip::Leaves => ([1.4, 1.0, 0.97], [0.2, 0.4, 180.0, 0.0]),
        };
        let ([spacing, flow, hardness], [place, size, angle_degrees, fainter]) = (base, jitter);
        Stamps {
            spacing,
            flow,
            hardness,
            jitter: Jitter {
                place,
                size,
                angle_degrees,
                flow: fainter,
                ..Jitter::default()
            },
            turn: match self {
                Tip::Drips | Tip::Leaks => TipDirection::Down,
                _ => TipDirection::Stroke,
            },
        }
    }
}

impl Brush {
    /// The brush with another tip and the settings that suit it.
    pub fn with_tip(&self, tip: Tip) -> Brush {
        let Stamps {
            spacing,
            flow,
            hardness,
            jitter,
            turn,
        } = tip.stamps();
        Brush {
            tip,
            spacing,
            flow,
            hardness,
            jitter,
            turn,
            ..self.clone()
        }
    }
}
