//! Paint of one stroke, before it is put on a canvas.

use sabi_color::luminance;

use super::{Canvas, TexelPaint};
use crate::stroke::{Action, Stroke};
use crate::supplies::{InputColors, bounded};

/// Strength of a stroke at each texel while it is painted, and its other values.
pub(super) struct Strengths {
    /// Strength of each texel; 0 where the stroke does not touch, and everywhere between strokes.
    texels: Vec<f32>,
    /// Texels that the stroke touches, without repeats.
    touched: Vec<u32>,
    /// Direction of the stroke at each texel that it touches; empty until directions are kept.
    directions: Vec<[f32; 3]>,
    /// Color times strength at each texel that it touches; empty until a picture provides colors.
    colors: Vec<[f32; 3]>,
    /// Grain of the model for the tip at each texel; NaN if it has not been computed. Empty until a tip uses it.
    grains: Vec<f32>,
    /// Texels whose grain is known.
    grained: Vec<u32>,
}

/// State of a stroke while it is painted, for continuing it later.
pub(super) struct SavedStrengths {
    /// Texels with their strength, in the order in which they were touched.
    texels: Vec<(u32, f32)>,
    directions: Vec<[f32; 3]>,
    colors: Vec<[f32; 3]>,
    grains: Vec<(u32, f32)>,
}

impl SavedStrengths {
    /// Returns the number of bytes of memory that it uses.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.texels.as_slice())
            + size_of_val(self.directions.as_slice())
            + size_of_val(self.colors.as_slice())
            + size_of_val(self.grains.as_slice())
    }
}

/// Values of a stroke that are kept in addition to its strength.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct KeptValues {
    pub(super) directions: bool,
    pub(super) colors: bool,
}

/// Paint that a stamp adds to a texel.
#[derive(Clone, Copy)]
pub(super) struct AddedPaint {
    /// 0 to 1.
    pub(super) strength: f64,
    /// Share of it that is added at once.
    pub(super) flow: f64,
    /// True if it adds up with earlier stamps until they cover fully; otherwise the strength is that of the strongest stamp.
    pub(super) builds_up: bool,
    /// Direction of the stroke, if directions are kept.
    pub(super) direction: Option<[f32; 3]>,
    /// Color of the stamp, if colors are kept.
    pub(super) color: Option<[f32; 3]>,
}

impl AddedPaint {
    /// Returns a strength that has an effect only if it is the greatest.
    pub(super) fn at_most(strength: f64) -> AddedPaint {
        AddedPaint {
            strength,
            flow: 1.0,
            builds_up: false,
            direction: None,
            color: None,
        }
    }
}

impl Strengths {
    pub(super) fn new(texels: usize) -> Strengths {
        Strengths {
            texels: vec![0.0; texels],
            touched: Vec::new(),
            directions: Vec::new(),
            colors: Vec::new(),
            grains: Vec::new(),
            grained: Vec::new(),
        }
    }

    /// Number of texels of the atlas.
    pub(super) fn texel_count(&self) -> usize {
        self.texels.len()
    }

    /// Returns the strength of the stroke at a texel so far.
    pub(super) fn at(&self, texel: usize) -> f32 {
        self.texels[texel]
    }

    /// Returns the grain at a texel. It is computed by the function if this stroke has not needed it before.
    pub(super) fn grain(&mut self, texel: usize, find: impl FnOnce() -> f64) -> f64 {
        if self.grains.is_empty() {
            self.grains = vec![f32::NAN; self.texels.len()];
        }
        if self.grains[texel].is_nan() {
            self.grains[texel] = find() as f32;
            self.grained.push(texel as u32);
        }
        f64::from(self.grains[texel])
    }

    /// Forgets the grains of the previous stroke, which had another brush.
    pub(super) fn forget_grains(&mut self) {
        for texel in self.grained.drain(..) {
            self.grains[texel as usize] = f32::NAN;
        }
    }

    /// Allocates memory for the values that are kept.
    pub(super) fn prepare(&mut self, kept: KeptValues) {
        let count = self.texels.len();
        if kept.directions && self.directions.is_empty() {
            self.directions = vec![[0.0; 3]; count];
        }
        if kept.colors && self.colors.is_empty() {
            self.colors = vec![[0.0; 3]; count];
        }
    }

    /// Adds a stamp at a texel.
    pub(super) fn add(&mut self, texel: usize, added: &AddedPaint) {
        if added.strength <= 0.0 {
            return;
        }
        let before = self.texels[texel];
        let known = f64::from(before);
        let risen = if added.builds_up {
            (1.0 - known) * added.strength
        } else {
            (added.strength - known).max(0.0)
        };
        let after = known + added.flow * risen;
        if let Some(direction) = added.direction.filter(|_| before == 0.0 || after as f32 > before) {
            self.directions[texel] = direction;
        }
        if let Some(color) = added.color {
            // A stamp covers earlier stamps, or adds its color in proportion to how far it exceeds them.
            let (share, left) = if added.builds_up {
                let share = (added.flow * added.strength) as f32;
                (share, 1.0 - share)
            } else {
                ((after - known) as f32, 1.0)
            };
            let kept = &mut self.colors[texel];
            *kept = std::array::from_fn(|axis| kept[axis] * left + share * color[axis]);
        }
        if before == 0.0 {
            self.touched.push(texel as u32);
        }
        // Ensures that the texel is recorded as touched, even if the strength is too small for a float.
        self.texels[texel] = (after as f32).max(f32::MIN_POSITIVE);
    }

    /// Returns the state of the stroke so far.
    pub(super) fn saved(&self, kept: KeptValues) -> SavedStrengths {
        let of_touched = |is_kept: bool, values: &[[f32; 3]]| match is_kept {
            true => self.touched.iter().map(|texel| values[*texel as usize]).collect(),
            false => Vec::new(),
        };
        let with_value = |texels: &[u32], values: &[f32]| {
            let texels = texels.iter();
            texels.map(|texel| (*texel, values[*texel as usize])).collect()
        };
        SavedStrengths {
            texels: with_value(&self.touched, &self.texels),
            directions: of_touched(kept.directions, &self.directions),
            colors: of_touched(kept.colors, &self.colors),
            grains: with_value(&self.grained, &self.grains),
        }
    }

    /// Starts a stroke from a saved state.
    pub(super) fn restore(&mut self, saved: &SavedStrengths) {
        for (texel, strength) in &saved.texels {
            self.touched.push(*texel);
            self.texels[*texel as usize] = *strength;
        }
        for (values, all) in [
            (&saved.directions, &mut self.directions),
            (&saved.colors, &mut self.colors),
        ] {
            for ((texel, _), value) in saved.texels.iter().zip(values) {
                all[*texel as usize] = *value;
            }
        }
        for (texel, grain) in &saved.grains {
            self.grain(*texel as usize, || f64::from(*grain));
        }
    }

    /// Ends the stroke and returns its paint.
    pub(super) fn take(&mut self, kept: KeptValues, lost: usize) -> LaidStroke {
        let mut laid = LaidStroke {
            texels: Vec::with_capacity(self.touched.len()),
            directions: Vec::new(),
            colors: Vec::new(),
            is_copied: false,
            lost,
        };
        for texel in self.touched.drain(..) {
            let strength = std::mem::take(&mut self.texels[texel as usize]);
            laid.texels.push((texel, strength));
            if kept.directions {
                // Fills have no directions, and the next stroke must not find any.
                laid.directions
                    .push(std::mem::take(&mut self.directions[texel as usize]));
            }
            if kept.colors {
                let color = std::mem::take(&mut self.colors[texel as usize]);
                laid.colors.push(color.map(|channel| channel / strength));
            }
        }
        laid
    }
}

/// Paint of a stroke, before it is put on a canvas.
pub struct LaidStroke {
    /// Texels with the strength of the stroke.
    texels: Vec<(u32, f32)>,
    /// Directions of the stroke at these texels; empty if they are not kept.
    directions: Vec<[f32; 3]>,
    /// Colors at these texels; empty if the stroke has the color of its brush.
    colors: Vec<[f32; 3]>,
    /// True if the colors are copied. In this case the mask receives their luminance, and the existing height and direction are kept.
    is_copied: bool,
    /// Number of points of the stroke that the model no longer has.
    pub lost: usize,
}

impl LaidStroke {
    /// Replaces its colors by those of a node result.
    pub(super) fn copy(&mut self, input: &InputColors<'_>) {
        let colors = self.texels.iter().map(|(texel, _)| bounded(input(*texel as usize)));
        self.colors = colors.collect();
        self.is_copied = true;
    }

    /// Puts the stroke on a canvas.
    pub fn onto(&self, canvas: &mut Canvas, stroke: &Stroke) {
        let brush = stroke.brush.bounded();
        for (index, (texel, strength)) in self.texels.iter().enumerate() {
            let direction = self.directions.get(index).copied().unwrap_or([0.0; 3]); // The direction is zero if it is not kept, in which case it is not read.
            let color = self.colors.get(index).copied().unwrap_or(brush.color); // Without a color of its own, the texel has the color of the brush.
            let paint = TexelPaint {
                strength: strength * brush.opacity,
                value: if self.is_copied { luminance(color) } else { brush.value },
                height: if self.is_copied { 0.0 } else { brush.height },
                color,
                direction: (!self.is_copied).then_some(direction),
            };
            canvas.lay(*texel as usize, stroke.action == Action::Erase, &paint);
        }
    }
}
