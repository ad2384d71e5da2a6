//! Kept canvases, with which a further stroke or a step back repaints little.

mod layered_canvas;

use std::collections::BTreeMap;
use std::sync::Arc;

use layered_canvas::{LayeredCanvas, share_layer};
use rayon::prelude::*;
use sabi_surface::atlas::Atlas;

use crate::canvas::{Canvas, CanvasLayers, Growth, LaidStroke, Painter, can_grow};
use crate::list::StrokeList;
use crate::stroke::Stroke;
use crate::supplies::Supplies;
use crate::surface::PaintSurface;
use crate::version::Version;

/// Number of strokes after which a canvas is kept for steps back.
const KEYFRAME: usize = 64;
/// Maximum number of strokes that can be continued: one in two sizes, and those of another node.
const MOST_GROWING: usize = 4;
/// Maximum memory for the state of a stroke that can be continued.
const MOST_GROWING_BYTES: usize = 256 << 20;
/// Number of strokes that each painter paints before all of them are put on the canvas.
const STROKES_A_PAINTER: usize = 4;

/// Canvases of several stroke lists and atlases. The one used last is at the end.
#[derive(Default)]
pub struct Canvases {
    kept: Vec<KeptCanvas>,
    /// Total number of bytes. Tiles that several canvases share count once.
    bytes: usize,
    /// Strokes that can be continued, each with its atlas. The one drawn last is at the end.
    growing: Vec<([u8; 32], Growth)>,
}

struct KeptCanvas {
    /// Atlas of the surface.
    atlas: [u8; 32],
    strokes: Vec<Arc<Stroke>>,
    /// The canvas to which further strokes are added.
    layered: LayeredCanvas,
    /// The canvas as it is shown.
    shown: Arc<Canvas>,
    lost: LostPlaces,
}

/// Number of points that the model no longer has, for each stroke with such points.
type LostPlaces = BTreeMap<Version, usize>;

/// Result of painting a list of strokes.
#[derive(Clone)]
pub struct PaintedStrokes {
    /// The canvas.
    pub canvas: Arc<Canvas>,
    /// Number of points that the model no longer has, for each stroke with such points.
    pub lost: BTreeMap<Version, usize>,
}

impl Canvases {
    /// Returns the canvas of a list of strokes with at least these layers. `key` identifies atlas and supplies. Strokes
    /// that are already on a kept canvas are not painted again. At most `budget` bytes are kept, but always one canvas. If
    /// the work is stopped, the canvas is unfinished and nothing is kept.
    pub fn painted(
        &mut self,
        surface: &PaintSurface<'_>,
        atlas: &Atlas,
        key: [u8; 32],
        list: &StrokeList,
        supplies: Supplies<'_>,
        layers: CanvasLayers,
        budget: usize,
    ) -> PaintedStrokes {
        // Includes the layers of the earlier canvas of these strokes, since the outputs of a node are requested one after another.
        let before = self
            .kept
            .iter()
            .filter(|kept| kept.atlas == key && starts_with(list, kept))
            .max_by_key(|kept| kept.strokes.len());
        let layers = before.map_or(layers, |before| layers.and(before.shown.layers()));
        let best = self.best(key, list, layers);
        if let Some(best) = best.filter(|best| best.strokes.len() == list.strokes.len()) {
            return best.painted();
        }
        let (mut canvas, known, mut lost) = match best {
            Some(best) => (best.layered.clone(), best.strokes.len(), best.lost.clone()),
            None => (
                LayeredCanvas::new(Canvas::empty(atlas.owners.len(), layers)),
                0,
                LostPlaces::new(),
            ),
        };
        let mut painters = Painters::new(surface, atlas, supplies, list.strokes.len() - known);
        let mut count = known;
        // The topmost stroke may still be drawn, so the canvas below it is kept as well.
        let below = known.max(list.strokes.len().saturating_sub(1));
        let (lower, top) = list.strokes[known..].split_at(below - known);
        for strokes in batches(lower, painters.batch()).chain(batches(top, 1)) {
            canvas.go_on_with(&strokes[0]);
            // Only the topmost stroke may still be drawn and continued.
            match strokes {
                [top] if count + 1 == list.strokes.len() && can_grow(top) => {
                    self.paint_growing(&mut painters, &mut canvas.full, top, key, &mut lost);
                }
                _ => painters.paint(&mut canvas.full, strokes, &mut lost),
            }
            if surface.is_stopped() {
                break;
            }
            let before = count;
            count += strokes.len();
            if (before / KEYFRAME < count / KEYFRAME || count == below) && count < list.strokes.len() {
                // The canvas is moved and then copied, so that its tiles count as its own.
                canvas = self
                    .keep(key, &list.strokes[..count], canvas, &lost, budget)
                    .layered
                    .clone();
            }
        }
        if surface.is_stopped() {
            self.growing.clear();
            return PaintedStrokes {
                canvas: Arc::new(canvas.shown(None)),
                lost,
            };
        }
        self.keep(key, &list.strokes, canvas, &lost, budget).painted()
    }

    /// Returns the kept canvas with these layers and the most strokes of a list. It is marked as used last, so that it is
    /// kept while a stroke on top of it is drawn.
    fn best(&mut self, atlas: [u8; 32], list: &StrokeList, layers: CanvasLayers) -> Option<&KeptCanvas> {
        let fits =
            |kept: &KeptCanvas| kept.atlas == atlas && kept.shown.layers().contain(layers) && starts_with(list, kept);
        let all = (0..self.kept.len()).filter(|index| fits(&self.kept[*index]));
        let best = all.max_by_key(|index| self.kept[*index].strokes.len())?;
        let found = self.kept.remove(best);
        self.kept.push(found);
        self.kept.last()
    }

    /// Paints the topmost stroke, which may still be drawn and continued.
    fn paint_growing(
        &mut self,
        painters: &mut Painters<'_>,
        canvas: &mut Canvas,
        stroke: &Arc<Stroke>,
        atlas: [u8; 32],
        lost: &mut LostPlaces,
    ) {
        let known = self.growing.iter().position(|(own, _)| *own == atlas);
        let mut growth = known.map(|known| self.growing.remove(known).1);
        let Some(painter) = painters.all.first_mut() else {
            return;
        };
        let laid = painter.lay_growing(stroke, canvas.layers().direction, &mut growth);
        laid.onto(canvas, stroke);
        if laid.lost > 0 {
            lost.insert(stroke.id, laid.lost);
        }
        // A stroke whose state takes much memory is painted as a whole each time.
        let growth = growth.filter(|growth| growth.bytes() <= MOST_GROWING_BYTES);
        self.growing.extend(growth.map(|growth| (atlas, growth)));
        if self.growing.len() > MOST_GROWING {
            self.growing.remove(0);
        }
    }

    /// Forgets the states of strokes that could be continued, since the brush was lifted.
    pub fn end_strokes(&mut self) {
        self.growing.clear();
    }

    /// Returns the bytes of the kept canvases. Tiles that several canvases share count once.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Keeps a canvas, and returns it.
    fn keep(
        &mut self,
        atlas: [u8; 32],
        strokes: &[Arc<Stroke>],
        layered: LayeredCanvas,
        lost: &LostPlaces,
        budget: usize,
    ) -> &KeptCanvas {
        let before = self.kept.iter().rev().find(|kept| kept.atlas == atlas);
        let shown = layered.shown(before.map(|before| (&before.layered, &*before.shown)));
        let kept = KeptCanvas {
            atlas,
            strokes: strokes.to_vec(),
            layered,
            shown: Arc::new(shown),
            lost: lost.clone(),
        };
        // A stroke that is being drawn replaces its earlier version.
        for index in (0..self.kept.len()).rev() {
            if is_earlier_part(&self.kept[index], &kept) {
                self.forget(index);
            }
        }
        self.bytes += kept.own_bytes();
        self.kept.push(kept);
        while self.bytes > budget && self.kept.len() > 1 {
            self.forget(0);
        }
        &self.kept[self.kept.len() - 1]
    }

    /// Removes a canvas. Tiles that it shares with others remain.
    fn forget(&mut self, index: usize) {
        let forgotten = self.kept.remove(index);
        self.bytes = self.bytes.saturating_sub(forgotten.own_bytes());
    }
}

impl KeptCanvas {
    fn painted(&self) -> PaintedStrokes {
        PaintedStrokes {
            canvas: Arc::clone(&self.shown),
            lost: self.lost.clone(),
        }
    }

    /// Returns the bytes of memory that only this canvas uses.
    fn own_bytes(&self) -> usize {
        let canvases = self.layered.canvases().chain([&*self.shown]);
        Canvas::own_bytes(&canvases.collect::<Vec<_>>())
    }
}

/// Painters that paint several strokes at a time on all processors.
struct Painters<'a> {
    all: Vec<Painter<'a>>,
}

impl<'a> Painters<'a> {
    /// Creates as many painters as there are processors, or strokes if there are fewer.
    fn new(surface: &'a PaintSurface<'a>, atlas: &'a Atlas, supplies: Supplies<'a>, strokes: usize) -> Painters<'a> {
        let count = rayon::current_num_threads().min(strokes);
        Painters {
            all: (0..count).map(|_| Painter::new(surface, atlas, supplies)).collect(),
        }
    }

    /// Returns the number of strokes that are painted before they are put on the canvas. It is small, since a fill touches all texels.
    fn batch(&self) -> usize {
        (STROKES_A_PAINTER * self.all.len()).max(1)
    }

    /// Paints a batch of strokes. Adds those with lost points to `lost`.
    fn paint(&mut self, canvas: &mut Canvas, strokes: &[Arc<Stroke>], lost: &mut LostPlaces) {
        let mut add = |stroke: &Stroke, count: usize| {
            if count > 0 {
                lost.insert(stroke.id, count);
            }
        };
        if let ([stroke], Some(painter)) = (strokes, self.all.first_mut()) {
            return add(stroke, painter.paint(canvas, stroke));
        }
        let laid = self.lay(strokes, canvas.layers().direction);
        for (stroke, laid) in strokes.iter().zip(&laid) {
            laid.onto(canvas, stroke);
            add(stroke, laid.lost);
        }
    }

    /// Returns the paint of each stroke separately, in the order of the strokes.
    fn lay(&mut self, strokes: &[Arc<Stroke>], keeps_direction: bool) -> Vec<LaidStroke> {
        let part = strokes.len().div_ceil(self.all.len().max(1)).max(1);
        let parts = self.all.par_iter_mut().zip(strokes.par_chunks(part));
        let laid = parts.map(|(painter, part)| {
            let laid = part.iter().map(|stroke| painter.lay(stroke, keeps_direction));
            laid.collect::<Vec<LaidStroke>>()
        });
        laid.flatten().collect()
    }
}

/// Divides strokes into batches of at most `most` strokes of one layer that do not depend on one another. A stroke that
/// depends on existing paint is a batch of its own.
fn batches(strokes: &[Arc<Stroke>], most: usize) -> impl Iterator<Item = &[Arc<Stroke>]> {
    let are_apart = |stroke: &Arc<Stroke>, next: &Arc<Stroke>| {
        !stroke.depends_on_paint() && !next.depends_on_paint() && share_layer(stroke, next)
    };
    strokes.chunk_by(are_apart).flat_map(move |part| part.chunks(most))
}

/// Returns true if two canvases differ only in their topmost stroke.
fn is_earlier_part(other: &KeptCanvas, kept: &KeptCanvas) -> bool {
    let (Some((_, below)), Some((_, own))) = (other.strokes.split_last(), kept.strokes.split_last()) else {
        return false;
    };
    other.atlas == kept.atlas
        && other.shown.layers() == kept.shown.layers()
        && below.len() == own.len()
        && below.iter().zip(own).all(|(below, own)| Arc::ptr_eq(below, own))
}

/// Returns true if a list begins with the strokes of a canvas. An unchanged stroke is the same object in memory.
fn starts_with(list: &StrokeList, kept: &KeptCanvas) -> bool {
    kept.strokes.len() <= list.strokes.len()
        && kept
            .strokes
            .iter()
            .zip(&list.strokes)
            .all(|(kept, stroke)| Arc::ptr_eq(kept, stroke))
}

#[cfg(test)]
mod tests;
