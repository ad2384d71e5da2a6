//! Strokes that are put on a canvas one after another, with faint groups as layers.
//!
//! Consecutive strokes of one group form a layer. They are painted with full strength, and the opacity of the group is
//! applied to all their changes together. Therefore crossing strokes of a faint group are not stronger where they cross.

use std::sync::Arc;

use crate::canvas::Canvas;
use crate::stroke::Stroke;

/// A canvas to which strokes are added.
#[derive(Clone)]
pub(super) struct LayeredCanvas {
    /// Paint of all strokes, with the open layer at full strength.
    pub(super) full: Canvas,
    /// Layer of the topmost strokes; `None` if they are not in a faint group.
    open: Option<OpenLayer>,
}

/// Layer to which further strokes may be added.
#[derive(Clone)]
struct OpenLayer {
    layer: StrokeLayer,
    /// Canvas below its strokes.
    below: Canvas,
}

/// Layer of a stroke.
#[derive(Clone, Copy, PartialEq)]
struct StrokeLayer {
    /// Number of the group.
    group: u32,
    /// Opacity of the group, 0 to 1.
    opacity: f32,
}

impl StrokeLayer {
    /// Returns the layer of a stroke; `None` if its group has the full opacity.
    fn of(stroke: &Stroke) -> Option<StrokeLayer> {
        let group = stroke.group.as_ref()?;
        let opacity = group.bounded().opacity;
        (opacity < 1.0).then_some(StrokeLayer {
            group: group.number,
            opacity,
        })
    }
}

impl LayeredCanvas {
    pub(super) fn new(canvas: Canvas) -> LayeredCanvas {
        LayeredCanvas {
            full: canvas,
            open: None,
        }
    }

    /// Opens the layer of a stroke. An open layer is ended if it is a different one.
    pub(super) fn go_on_with(&mut self, stroke: &Stroke) {
        let layer = StrokeLayer::of(stroke);
        if self.open.as_ref().map(|open| open.layer) == layer {
            return;
        }
        self.full = self.shown(None);
        self.open = layer.map(|layer| OpenLayer {
            layer,
            below: self.full.clone(),
        });
    }

    /// Returns the canvas with the open layer faded by the opacity of its group. `before` is an earlier canvas and the
    /// result for it; tiles that have not changed are taken from that result.
    pub(super) fn shown(&self, before: Option<(&LayeredCanvas, &Canvas)>) -> Canvas {
        let Some(open) = &self.open else {
            return self.full.clone();
        };
        let known = before.and_then(|(before, shown)| {
            let other = before.open.as_ref().filter(|other| other.layer == open.layer)?;
            Some([&other.below, &before.full, shown])
        });
        self.full.faded(&open.below, open.layer.opacity, known)
    }

    /// Returns all canvases of which it consists.
    pub(super) fn canvases(&self) -> impl Iterator<Item = &Canvas> {
        std::iter::once(&self.full).chain(self.open.as_ref().map(|open| &open.below))
    }
}

/// Returns true if two strokes have the same layer, or both have none.
pub(super) fn share_layer(one: &Arc<Stroke>, other: &Arc<Stroke>) -> bool {
    StrokeLayer::of(one) == StrokeLayer::of(other)
}
