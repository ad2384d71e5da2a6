//! Strokes put onto a canvas one after another, with faint groups as layers.
//!
//! Strokes of one group that lie on each other make one layer: they are laid in full, and the group's opacity then says how much of what
//! they changed together is seen. So strokes of a faint group that cross are no stronger where they cross.

use std::sync::Arc;

use crate::canvas::Canvas;
use crate::stroke::Stroke;

/// A canvas to which strokes are added.
#[derive(Clone)]
pub(super) struct Layered {
    /// Paint of all strokes, those of the open layer in full.
    pub(super) full: Canvas,
    /// Layer of the topmost strokes; none if they are in no faint group.
    open: Option<OpenLayer>,
}

/// A layer that further strokes may belong to.
#[derive(Clone)]
struct OpenLayer {
    layer: Layer,
    /// The canvas below its strokes.
    below: Canvas,
}

/// The layer of a stroke.
#[derive(Clone, Copy, PartialEq)]
struct Layer {
    /// Number of the group.
    group: u32,
    /// Opacity of the group, 0 to 1.
    opacity: f32,
}

impl Layer {
    /// That of a stroke; none where its group is as strong as its strokes.
    fn of(stroke: &Stroke) -> Option<Layer> {
        let group = stroke.group.as_ref()?;
        let opacity = group.bounded().opacity;
        (opacity < 1.0).then_some(Layer {
            group: group.number,
            opacity,
        })
    }
}

impl Layered {
    pub(super) fn new(canvas: Canvas) -> Layered {
        Layered {
            full: canvas,
            open: None,
        }
    }

    /// Goes on with the layer of a stroke: ends the open one if it is another.
    pub(super) fn go_on_with(&mut self, stroke: &Stroke) {
        let layer = Layer::of(stroke);
        if self.open.as_ref().map(|open| open.layer) == layer {
            return;
        }
        self.full = self.shown(None);
        self.open = layer.map(|layer| OpenLayer {
            layer,
            below: self.full.clone(),
        });
    }

    /// The canvas with the open layer as faint as its group is. Tiles are taken from an earlier one with what was shown of it, where they
    /// are the same.
    pub(super) fn shown(&self, before: Option<(&Layered, &Canvas)>) -> Canvas {
        let Some(open) = &self.open else {
            return self.full.clone();
        };
        let known = before.and_then(|(before, shown)| {
            let other = before.open.as_ref().filter(|other| other.layer == open.layer)?;
            Some([&other.below, &before.full, shown])
        });
        self.full.faded(&open.below, open.layer.opacity, known)
    }

    /// All canvases that it consists of.
    pub(super) fn canvases(&self) -> impl Iterator<Item = &Canvas> {
        std::iter::once(&self.full).chain(self.open.as_ref().map(|open| &open.below))
    }
}

/// Returns true if two strokes are of the same layer, or of none.
pub(super) fn share_layer(one: &Arc<Stroke>, other: &Arc<Stroke>) -> bool {
    Layer::of(one) == Layer::of(other)
}
