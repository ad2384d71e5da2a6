//! Canvases that were painted, so that a further stroke, or a step back, paints little again.

use std::sync::Arc;

use sabi_surface::atlas::Atlas;

use crate::canvas::{Canvas, Layers, Painter};
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
        let mut painter = Painter::new(surface, atlas);
        for (index, stroke) in list.strokes.iter().enumerate().skip(known) {
            lost += painter.paint(&mut canvas, stroke);
            let count = index + 1;
            if count.is_multiple_of(KEYFRAME) && count < list.strokes.len() {
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

/// Returns true if a list begins with the strokes of a canvas. A stroke that did not change is the same in memory.
fn starts_with(list: &StrokeList, kept: &KeptCanvas) -> bool {
    kept.strokes.len() <= list.strokes.len()
        && kept
            .strokes
            .iter()
            .zip(&list.strokes)
            .all(|(kept, stroke)| Arc::ptr_eq(kept, stroke))
}
