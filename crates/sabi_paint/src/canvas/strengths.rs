//! Paint of one stroke, before it lies on a canvas.

use sabi_color::luminance;

use super::{Canvas, Laid};
use crate::stroke::{Action, Stroke};
use crate::supplies::{InputColors, bounded};

/// Strength of a stroke at each texel while it is drawn, and what else it leaves there.
pub(super) struct Strengths {
    /// 0 where the stroke does not touch, and everywhere between strokes.
    texels: Vec<f32>,
    /// Texels that the stroke touches, each once.
    touched: Vec<u32>,
    /// Direction of the stroke at each texel that it touches; empty until directions are kept.
    directions: Vec<[f32; 3]>,
    /// Color times strength at each texel that it touches; empty until a picture gives colors.
    colors: Vec<[f32; 3]>,
    /// Grain of the model for the tip at each texel, no number where it was not asked for; empty until a tip has one.
    grains: Vec<f32>,
    /// Texels whose grain is known.
    grained: Vec<u32>,
}

/// State of a stroke while it is drawn, to go on from there.
pub(super) struct SavedStrengths {
    /// Texels with the strength there, in the order in which they were touched.
    texels: Vec<(u32, f32)>,
    directions: Vec<[f32; 3]>,
    colors: Vec<[f32; 3]>,
    grains: Vec<(u32, f32)>,
}

impl SavedStrengths {
    /// Bytes of memory that it takes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.texels.as_slice())
            + size_of_val(self.directions.as_slice())
            + size_of_val(self.colors.as_slice())
            + size_of_val(self.grains.as_slice())
    }
}

/// Values of a stroke that are kept besides its strength.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Kept {
    pub(super) directions: bool,
    pub(super) colors: bool,
}

/// Paint that a stamp adds at a texel.
#[derive(Clone, Copy)]
pub(super) struct Added {
    /// 0 to 1.
    pub(super) strength: f64,
    /// Share of it that is added at once.
    pub(super) flow: f64,
    /// True if it adds up with the stamps before until they cover; else they rise to the strongest of them.
    pub(super) builds_up: bool,
    /// Direction of the stroke, where directions are kept.
    pub(super) direction: Option<[f32; 3]>,
    /// Color of the stamp, where colors are kept.
    pub(super) color: Option<[f32; 3]>,
}

impl Added {
    /// A strength that counts where it is the greatest.
    pub(super) fn at_most(strength: f64) -> Added {
        Added {
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

    /// Strength of the stroke at a texel so far.
    pub(super) fn at(&self, texel: usize) -> f32 {
        self.texels[texel]
    }

    /// Grain at a texel: that of before in this stroke, or what the function gives.
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

    /// Forgets the grains of the stroke before, whose brush was another.
    pub(super) fn forget_grains(&mut self) {
        for texel in self.grained.drain(..) {
            self.grains[texel as usize] = f32::NAN;
        }
    }

    /// Makes room for what is kept.
    pub(super) fn prepare(&mut self, kept: Kept) {
        let count = self.texels.len();
        if kept.directions && self.directions.is_empty() {
            self.directions = vec![[0.0; 3]; count];
        }
        if kept.colors && self.colors.is_empty() {
            self.colors = vec![[0.0; 3]; count];
        }
    }

    /// Adds a stamp at a texel.
    pub(super) fn add(&mut self, texel: usize, added: &Added) {
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
            // A stamp covers those before it, or adds the color of what it rises above them.
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
        // Touched only once, also where the strength is too small for a float.
        self.texels[texel] = (after as f32).max(f32::MIN_POSITIVE);
    }

    /// State of the stroke so far.
    pub(super) fn saved(&self, kept: Kept) -> SavedStrengths {
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

    /// Begins a stroke, for which this was prepared, with what another one had.
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

    /// Ends the stroke.
    pub(super) fn take(&mut self, kept: Kept, lost: usize) -> LaidStroke {
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
                // Fills have no direction, and leave none to the next stroke.
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

/// Paint of a stroke, before it lies on a canvas.
pub struct LaidStroke {
    /// Texels with the strength of the stroke there.
    texels: Vec<(u32, f32)>,
    /// Directions of the stroke there; empty where they are not kept.
    directions: Vec<[f32; 3]>,
    /// Colors there; empty where the stroke has the color of its brush.
    colors: Vec<[f32; 3]>,
    /// True if the colors are copied, so that the mask gets their luminance; the height and the direction below stay.
    is_copied: bool,
    /// Places of the stroke that the model does not have any more.
    pub lost: usize,
}

impl LaidStroke {
    /// Replaces its colors by those of a result.
    pub(super) fn copy(&mut self, input: &InputColors<'_>) {
        let colors = self.texels.iter().map(|(texel, _)| bounded(input(*texel as usize)));
        self.colors = colors.collect();
        self.is_copied = true;
    }

    /// Lays the stroke on a canvas.
    pub fn onto(&self, canvas: &mut Canvas, stroke: &Stroke) {
        let brush = stroke.brush.bounded();
        for (index, (texel, strength)) in self.texels.iter().enumerate() {
            let direction = self.directions.get(index).copied().unwrap_or([0.0; 3]); // Not kept, and so not read.
            let color = self.colors.get(index).copied().unwrap_or(brush.color); // As the brush has it.
            let paint = Laid {
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
