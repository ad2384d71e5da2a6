//! What strokes leave on an atlas.

mod adjust;
mod fills;
mod grid;
mod outlines;
mod painter;
mod patches;
mod shape;
mod sight;
mod stamps;
mod strengths;
#[cfg(test)]
mod tests;
mod texels;

pub use painter::Painter;
pub use stamps::rightward;
pub use strengths::LaidStroke;

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
    /// All layers of both.
    pub fn and(self, other: Layers) -> Layers {
        Layers {
            value: self.value || other.value,
            color: self.color || other.color,
            height: self.height || other.height,
            direction: self.direction || other.direction,
        }
    }

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

    /// Number of values of a texel, over all layers.
    fn channel_count(&self) -> usize {
        let has = |is_empty: bool| usize::from(!is_empty);
        1 + has(self.value.is_empty())
            + has(self.height.is_empty())
            + 3 * (has(self.color.is_empty()) + has(self.direction.is_empty()))
    }

    /// The values of a texel that [`Canvas::write`] takes.
    fn read(&self, texel: usize, values: &mut [f32]) {
        let single = [&self.cover, &self.value, &self.height].map(|layer| layer.get(texel).copied());
        let several = [&self.color, &self.direction].map(|layer| layer.get(texel).copied());
        let all = single
            .into_iter()
            .flatten()
            .chain(several.into_iter().flatten().flatten());
        for (value, own) in values.iter_mut().zip(all) {
            *value = own;
        }
    }

    /// Replaces the values of a texel; what a mask, a color and a height cannot be is brought into their ranges.
    fn write(&mut self, texel: usize, values: &[f32]) {
        let mut values = values.iter().copied();
        let mut next = || values.next().unwrap_or(0.0); // As many as were read.
        let cover = next().clamp(0.0, 1.0);
        self.cover[texel] = cover;
        if let Some(value) = self.value.get_mut(texel) {
            *value = next().clamp(0.0, cover);
        }
        if let Some(height) = self.height.get_mut(texel) {
            *height = next();
        }
        if let Some(color) = self.color.get_mut(texel) {
            *color = [0; 3].map(|_| next().clamp(0.0, cover));
        }
        if let Some(direction) = self.direction.get_mut(texel) {
            *direction = [0; 3].map(|_| next());
        }
    }

    /// Lays a brush on a texel with this strength, 0 to 1, or takes paint away from it.
    fn lay(
        &mut self,
        texel: usize,
        action: Action,
        brush: &Brush,
        strength: f32,
        (laid_color, direction): ([f32; 3], [f32; 3]),
    ) {
        let left = 1.0 - strength;
        let laid = if action == Action::Paint { strength } else { 0.0 };
        if let Some(cover) = self.cover.get_mut(texel) {
            *cover = *cover * left + laid;
        }
        if let Some(value) = self.value.get_mut(texel) {
            *value = *value * left + laid * brush.value;
        }
        if let Some(color) = self.color.get_mut(texel) {
            *color = std::array::from_fn(|axis| color[axis] * left + laid * laid_color[axis]);
        }
        if let Some(height) = self.height.get_mut(texel) {
            // Strokes that carve or raise add up; others leave the height alone.
            *height = if action == Action::Paint {
                *height + strength * brush.height
            } else {
                *height * left
            };
        }
        if let Some(kept) = self.direction.get_mut(texel) {
            *kept = std::array::from_fn(|axis| kept[axis] * left + laid * direction[axis]);
        }
    }
}
