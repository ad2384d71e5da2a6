//! Strokes that are painted piece by piece along their way. While a stroke is drawn, only the pieces that a new point
//! changes are painted again.

use std::ops::Range;
use std::sync::Arc;

use super::painter::Painter;
use super::stamps::{StampPlace, stamps_of};
use super::strengths::{KeptValues, LaidStroke, SavedStrengths};
use super::used_brush::UsedBrush;
use crate::site::passed;
use crate::stroke::{Area, Stroke};
use crate::way::WayPoint;

/// Number of points behind a piece on which it depends: they determine how its line continues and bends.
const AHEAD: usize = 2;

/// State of a stroke that was painted last, for painting the same stroke with further points.
pub struct Growth {
    stroke: Arc<Stroke>,
    kept: KeptValues,
    /// Points between the parts of its line, or its stamps.
    places: Vec<WayPoint>,
    /// Number of pieces that are included in `strengths`.
    settled: usize,
    strengths: SavedStrengths,
    /// Visibility of places from the eye of the artist, by texel.
    seen: Vec<(u32, f32)>,
}

/// Pieces of a stroke, painted one after another.
enum StrokePieces {
    /// Parts of a line between points.
    Line(Vec<WayPoint>),
    Stamps(Vec<StampPlace>),
}

impl StrokePieces {
    fn of(way: Vec<WayPoint>, used: &UsedBrush) -> StrokePieces {
        if used.draws_line() {
            StrokePieces::Line(way)
        } else {
            StrokePieces::Stamps(stamps_of(&way, used))
        }
    }

    fn count(&self) -> usize {
        match self {
            StrokePieces::Line(way) => way.len(),
            StrokePieces::Stamps(stamps) => stamps.len(),
        }
    }

    fn places(&self) -> Vec<WayPoint> {
        match self {
            StrokePieces::Line(way) => way.clone(),
            StrokePieces::Stamps(stamps) => stamps.iter().map(|stamp| stamp.point).collect(),
        }
    }
}

impl Growth {
    /// Returns the number of pieces that are not painted again when the stroke continues.
    pub fn settled(&self) -> usize {
        self.settled
    }

    /// Returns the number of bytes of memory that it uses.
    pub(crate) fn bytes(&self) -> usize {
        self.strengths.bytes() + size_of_val(self.places.as_slice()) + size_of_val(self.seen.as_slice())
    }

    /// Returns true if a stroke may be the stored one with further points.
    fn may_be(&self, stroke: &Stroke, kept: KeptValues) -> bool {
        let own = &self.stroke;
        let draws_alike = (&own.brush, own.action, own.eye, &own.stencil)
            == (&stroke.brush, stroke.action, stroke.eye, &stroke.stencil);
        draws_alike && self.kept == kept
    }

    /// Returns the number of equal points at the start.
    fn common(&self, places: &[WayPoint]) -> usize {
        let pairs = self.places.iter().zip(places);
        pairs.take_while(|(own, other)| own == other).count()
    }
}

/// Returns true for strokes that can be continued piece by piece. Those with copies cannot, since the pieces of the copies
/// would come in between.
pub(crate) fn can_grow(stroke: &Stroke) -> bool {
    let symmetry = stroke.brush.bounded().symmetry;
    let has_copies = symmetry.mirrors.contains(&true) || symmetry.turns > 1;
    stroke.area == Area::Way && stroke.path.is_none() && !stroke.depends_on_paint() && !has_copies
}

impl Painter<'_> {
    /// Paints a stroke that can grow, with the same bits as [`Painter::lay`]. `growth` is the state from an earlier call on
    /// the same atlas. It is used if it belongs to the same stroke with fewer points, and updated for the next call.
    pub fn lay_growing(
        &mut self,
        stroke: &Arc<Stroke>,
        keeps_direction: bool,
        growth: &mut Option<Growth>,
    ) -> LaidStroke {
        let before = growth.take();
        let (points, lost) = passed(self.surface, stroke);
        let wanted = KeptValues {
            directions: keeps_direction,
            colors: false,
        };
        let Some(used) = self.used(stroke, wanted).filter(|_| !points.is_empty()) else {
            return self.laid(stroke, wanted, lost);
        };
        let kept = used.kept;
        self.begin(kept);
        let copies = self.with_copies(points, None, stroke, &used.brush);
        let used = used.on(&copies[0]);
        let way = self.way_of(&copies[0].points, &used.brush);
        let pieces = StrokePieces::of(way, &used);
        let places = pieces.places();
        let before = before.filter(|before| before.may_be(stroke, kept));
        let settled = before
            .as_ref()
            .map_or(0, |before| before.common(&places).saturating_sub(AHEAD));
        let known = before.filter(|before| before.settled <= settled);
        let start = known.as_ref().map_or(0, |known| {
            self.strengths.restore(&known.strengths);
            self.sight.restore(&known.seen, self.atlas.owners.len());
            known.settled
        });
        self.draw_pieces(&pieces, start..settled, &used);
        let (strengths, seen) = match known {
            Some(known) if known.settled == settled => (known.strengths, known.seen),
            _ => (self.strengths.saved(kept), self.sight.saved()),
        };
        self.draw_pieces(&pieces, settled..places.len(), &used);
        *growth = Some(Growth {
            stroke: Arc::clone(stroke),
            kept,
            places,
            settled,
            strengths,
            seen,
        });
        self.laid(stroke, kept, lost)
    }

    /// Draws a whole way.
    pub(super) fn draw_way(&mut self, way: Vec<WayPoint>, used: &UsedBrush) {
        let pieces = StrokePieces::of(way, used);
        self.draw_pieces(&pieces, 0..pieces.count(), used);
    }

    fn draw_pieces(&mut self, pieces: &StrokePieces, range: Range<usize>, used: &UsedBrush) {
        match pieces {
            StrokePieces::Line(way) => self.draw_line(way, range, used),
            StrokePieces::Stamps(stamps) => self.draw_stamps(stamps, range, used),
        }
    }
}
