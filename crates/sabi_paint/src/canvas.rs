//! What strokes leave on an atlas.

mod fills;
mod painter;
mod patches;
mod shape;
#[cfg(test)]
mod tests;
mod texels;

pub use painter::{LaidStroke, Painter};

use crate::brush::Brush;
use crate::stroke::Action;

/// What a canvas keeps for each texel besides how much of it is painted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layers {
    /// The value of a mask.
    pub value: bool,
    /// The color.
    pub color: bool,
    /// The height.
    pub height: bool,
    /// The direction of the strokes.
    pub direction: bool,
}

impl Layers {
    /// Returns true if all layers of another canvas are among these.
    pub fn contain(self, other: Layers) -> bool {
        (self.value || !other.value)
            && (self.color || !other.color)
            && (self.height || !other.height)
            && (self.direction || !other.direction)
    }
}

/// What strokes leave on an atlas: for each texel, ghosts included. Vectors of layers that are not kept are empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    /// How much of a texel is painted, 0 to 1.
    pub cover: Vec<f32>,
    /// Value times cover.
    pub value: Vec<f32>,
    /// Linear color times cover.
    pub color: Vec<[f32; 3]>,
    /// Height, model units.
    pub height: Vec<f32>,
    /// Direction of the strokes in model space times cover.
    pub direction: Vec<[f32; 3]>,
}

impl Canvas {
    /// An empty canvas for an atlas of that many texels.
    pub fn empty(texels: usize, layers: Layers) -> Canvas {
        let count = |is_kept: bool| if is_kept { texels } else { 0 };
        Canvas {
            cover: vec![0.0; texels],
            value: vec![0.0; count(layers.value)],
            color: vec![[0.0; 3]; count(layers.color)],
            height: vec![0.0; count(layers.height)],
            direction: vec![[0.0; 3]; count(layers.direction)],
        }
    }

    /// The layers that it keeps.
    pub fn layers(&self) -> Layers {
        Layers {
            value: !self.value.is_empty(),
            color: !self.color.is_empty(),
            height: !self.height.is_empty(),
            direction: !self.direction.is_empty(),
        }
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        4 * (self.cover.len() + self.value.len() + self.height.len()) + 12 * (self.color.len() + self.direction.len())
    }

    /// Lays a brush on a texel with this strength, 0 to 1, or takes paint away from it.
    fn lay(&mut self, texel: usize, action: Action, brush: &Brush, strength: f32, direction: [f32; 3]) {
        let left = 1.0 - strength;
        let laid = if action == Action::Paint { strength } else { 0.0 };
        if let Some(cover) = self.cover.get_mut(texel) {
            *cover = *cover * left + laid;
        }
        if let Some(value) = self.value.get_mut(texel) {
            *value = *value * left + laid * brush.value;
        }
        if let Some(color) = self.color.get_mut(texel) {
            *color = std::array::from_fn(|axis| color[axis] * left + laid * brush.color[axis]);
        }
        if let Some(height) = self.height.get_mut(texel) {
            // Strokes that carve or raise add up; others leave the height alone.
            *height = match action {
                Action::Paint => *height + strength * brush.height,
                Action::Erase => *height * left,
            };
        }
        if let Some(kept) = self.direction.get_mut(texel) {
            *kept = std::array::from_fn(|axis| kept[axis] * left + laid * direction[axis]);
        }
    }
}
