//! Canvases that were painted, so that a further stroke, or a step back, paints little again.

use std::sync::Arc;

use rayon::prelude::*;
use sabi_surface::atlas::Atlas;

use crate::canvas::{Canvas, LaidStroke, Layers, Painter};
use crate::list::StrokeList;
use crate::stroke::Stroke;
use crate::surface::PaintSurface;

/// Strokes after which a canvas is kept for steps back.
const KEYFRAME: usize = 64;

/// Canvases of several lists of strokes and atlases, the one used last at the end.
#[derive(Default)]
pub struct Canvases {
    kept: Vec<KeptCanvas>,
}

struct KeptCanvas {
    /// Atlas of the surface.
    atlas: [u8; 32],
    strokes: Vec<Arc<Stroke>>,
    canvas: Arc<Canvas>,
    /// Places of its strokes that the model does not have any more.
    lost: usize,
}

/// Result of painting a list of strokes.
#[derive(Clone)]
pub struct Painted {
    /// The canvas.
    pub canvas: Arc<Canvas>,
    /// Places of its strokes that the model does not have any more.
    pub lost: usize,
}

impl Canvases {
    /// The canvas of a list of strokes with at least these layers; `key` tells atlases apart. Strokes that a kept canvas has
    /// already are not painted again. At most `budget` bytes are kept, or a single canvas.
    pub fn painted(
        &mut self,
        surface: &PaintSurface<'_>,
        (atlas, key): (&Atlas, [u8; 32]),
        list: &StrokeList,
        layers: Layers,
        budget: usize,
    ) -> Painted {
        let fits =
            |kept: &KeptCanvas| kept.atlas == key && kept.canvas.layers().contain(layers) && starts_with(list, kept);
        let best = (0..self.kept.len()).filter(|index| fits(&self.kept[*index]));
        let best = best.max_by_key(|index| self.kept[*index].strokes.len());
        if let Some(best) = best.filter(|best| self.kept[*best].strokes.len() == list.strokes.len()) {
            let found = self.kept.remove(best);
            let painted = found.painted();
            self.kept.push(found);
            return painted;
        }
        let (mut canvas, known, mut lost) = match best {
            Some(best) => {
                let found = &self.kept[best];
                (Canvas::clone(&found.canvas), found.strokes.len(), found.lost)
            }
            None => (Canvas::empty(atlas.owners.len(), layers), 0, 0),
        };
        let mut count = known;
        for strokes in list.strokes[known..].chunks(KEYFRAME) {
            for (stroke, laid) in strokes.iter().zip(laid(surface, atlas, strokes, layers.direction)) {
                laid.onto(&mut canvas, stroke);
                lost += laid.lost;
            }
            count += strokes.len();
            if count < list.strokes.len() {
                self.keep(key, &list.strokes[..count], canvas.clone(), lost, budget);
            }
        }
        self.keep(key, &list.strokes, canvas, lost, budget)
    }

    fn keep(
        &mut self,
        atlas: [u8; 32],
        strokes: &[Arc<Stroke>],
        canvas: Canvas,
        lost: usize,
        budget: usize,
    ) -> Painted {
        let kept = KeptCanvas {
            atlas,
            strokes: strokes.to_vec(),
            canvas: Arc::new(canvas),
            lost,
        };
        let painted = kept.painted();
        self.kept.push(kept);
        let mut bytes: usize = self.kept.iter().map(|kept| kept.canvas.bytes()).sum();
        while bytes > budget && self.kept.len() > 1 {
            bytes -= self.kept.remove(0).canvas.bytes();
        }
        painted
    }
}

impl KeptCanvas {
    fn painted(&self) -> Painted {
        Painted {
            canvas: Arc::clone(&self.canvas),
            lost: self.lost,
        }
    }
}

/// What strokes leave, each by itself: several at a time on all processors, in the order of the strokes.
fn laid(surface: &PaintSurface<'_>, atlas: &Atlas, strokes: &[Arc<Stroke>], keeps_direction: bool) -> Vec<LaidStroke> {
    if let [stroke] = strokes {
        return vec![Painter::new(surface, atlas).lay(stroke, keeps_direction)];
    }
    // In a few parts, since each prepares for the whole atlas.
    let part = strokes.len().div_ceil(2 * rayon::current_num_threads()).max(1);
    let parts = strokes.par_chunks(part).map(|part| {
        let mut painter = Painter::new(surface, atlas);
        part.iter()
            .map(|stroke| painter.lay(stroke, keeps_direction))
            .collect::<Vec<LaidStroke>>()
    });
    parts.flatten().collect()
}

/// Returns true if a list begins with the strokes of a canvas. A stroke that did not change is the same in memory.
fn starts_with(list: &StrokeList, kept: &KeptCanvas) -> bool {
    kept.strokes.len() <= list.strokes.len()
        && kept
            .strokes
            .iter()
            .zip(&list.strokes)
            .all(|(kept, stroke)| Arc::ptr_eq(kept, stroke))
}
