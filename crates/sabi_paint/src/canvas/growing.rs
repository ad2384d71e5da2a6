//! Pieces of strokes along their way. While a stroke is drawn, only the pieces that a further place changes are laid again.

use std::ops::Range;
use std::sync::Arc;

use super::painter::Painter;
use super::stamps::{StampPlace, stamps_of};
use super::strengths::{Kept, LaidStroke, SavedStrengths};
use super::used_brush::UsedBrush;
use crate::site::passed;
use crate::stroke::{Area, Stroke};
use crate::way::WayPoint;

/// Places behind a piece that it depends on: where its line goes on, and how that bends there.
const AHEAD: usize = 2;

/// A stroke as it was laid last, for the same stroke with further places.
pub struct Growth {
    stroke: Arc<Stroke>,
    kept: Kept,
    /// Ends of the parts of its line, or its stamps.
    places: Vec<WayPoint>,
    /// Number of pieces that are laid in `strengths`.
    settled: usize,
    strengths: SavedStrengths,
    /// Places that were seen from the eye of the artist, by texel.
    seen: Vec<(u32, f32)>,
}

/// Pieces of a stroke, laid one after another.
enum Pieces {
    /// Parts of a line between places.
    Line(Vec<WayPoint>),
    Stamps(Vec<StampPlace>),
}

impl Pieces {
    fn of(way: Vec<WayPoint>, used: &UsedBrush) -> Pieces {
        if used.draws_line() {
            Pieces::Line(way)
        } else {
            Pieces::Stamps(stamps_of(&way, used))
        }
    }

    fn count(&self) -> usize {
        match self {
            Pieces::Line(way) => way.len(),
            Pieces::Stamps(stamps) => stamps.len(),
        }
    }

    fn places(&self) -> Vec<WayPoint> {
        match self {
            Pieces::Line(way) => way.clone(),
            Pieces::Stamps(stamps) => stamps.iter().map(|stamp| stamp.point).collect(),
        }
    }
}

impl Growth {
    /// Number of pieces that are not laid again when the stroke goes on.
    pub fn settled(&self) -> usize {
        self.settled
    }

    /// Bytes of memory that it takes.
    pub(crate) fn bytes(&self) -> usize {
        self.strengths.bytes() + size_of_val(self.places.as_slice()) + size_of_val(self.seen.as_slice())
    }

    /// Returns true if a stroke may be this one with further places.
    fn may_be(&self, stroke: &Stroke, kept: Kept) -> bool {
        let own = &self.stroke;
        let draws_alike = (&own.brush, own.action, own.eye, &own.stencil)
            == (&stroke.brush, stroke.action, stroke.eye, &stroke.stencil);
        draws_alike && self.kept == kept
    }

    /// Number of first places that are the same.
    fn common(&self, places: &[WayPoint]) -> usize {
        let pairs = self.places.iter().zip(places);
        pairs.take_while(|(own, other)| own == other).count()
    }
}

/// Returns true for strokes that go on piece by piece, without copies whose pieces would lie in between.
pub(crate) fn can_grow(stroke: &Stroke) -> bool {
    let symmetry = stroke.brush.bounded().symmetry;
    let has_copies = symmetry.mirrors.contains(&true) || symmetry.turns > 1;
    stroke.area == Area::Way && stroke.path.is_none() && !stroke.depends_on_paint() && !has_copies
}

impl Painter<'_> {
    /// Paint of a stroke that can grow, to the bit as [`Painter::lay`] gives it. `growth` is what this kept of a stroke on the same atlas; it
    /// is taken up if that is the same stroke with fewer places, and kept for the next ones.
    pub fn lay_growing(
        &mut self,
        stroke: &Arc<Stroke>,
        keeps_direction: bool,
        growth: &mut Option<Growth>,
    ) -> LaidStroke {
        let before = growth.take();
        let (points, lost) = passed(self.surface, stroke);
        let wanted = Kept {
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
        let pieces = Pieces::of(way, &used);
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
        let pieces = Pieces::of(way, used);
        self.draw_pieces(&pieces, 0..pieces.count(), used);
    }

    fn draw_pieces(&mut self, pieces: &Pieces, range: Range<usize>, used: &UsedBrush) {
        match pieces {
            Pieces::Line(way) => self.draw_line(way, range, used),
            Pieces::Stamps(stamps) => self.draw_stamps(stamps, range, used),
        }
    }
}
