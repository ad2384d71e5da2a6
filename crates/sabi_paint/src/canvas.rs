//! What strokes leave on an atlas.

mod adjust;
mod fills;
mod grid;
mod growing;
mod left;
mod outlines;
mod painter;
mod patches;
mod ribbon;
mod shape;
mod sight;
mod similar;
mod stamps;
mod strengths;
#[cfg(test)]
mod tests;
mod texels;
mod used_brush;

pub use growing::Growth;
pub(crate) use growing::can_grow;
pub use painter::Painter;
pub use strengths::LaidStroke;

use std::sync::Arc;

use sabi_color::luminance;

use crate::supplies::bounded;

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

/// Texels of a tile: as many of a page's row as a stroke that is there changes most likely.
const TILE: usize = 512;
/// Texels that are held together against others.
const EIGHT: usize = 8;

/// Paint that strokes left on a texel; 0 for layers that are not kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CanvasTexel {
    /// Painted share of it, 0 to 1.
    pub cover: f32,
    /// Value times cover.
    pub value: f32,
    /// Linear color times cover.
    pub color: [f32; 3],
    /// Height, model units.
    pub height: f32,
    /// Direction of the strokes in model space times cover.
    pub direction: [f32; 3],
}

/// Paint that a stroke lays on a texel.
struct Laid {
    /// Share of the texel, 0 to 1.
    strength: f32,
    /// Value of the mask.
    value: f32,
    /// Height that is added, model units.
    height: f32,
    /// Linear color.
    color: [f32; 3],
    /// Direction of the stroke in model space; none where that below stays.
    direction: Option<[f32; 3]>,
}

/// Place of each layer among the numbers of a texel, behind its cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Channels {
    value: Option<usize>,
    height: Option<usize>,
    color: Option<usize>,
    direction: Option<usize>,
    /// Numbers of a texel.
    count: usize,
}

/// Paint of strokes on an atlas: for each texel, ghosts included. A copy shares the tiles with its original until one of them is
/// painted on, so that a stroke costs what it touches.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    layers: Layers,
    channels: Channels,
    texels: usize,
    /// Numbers of the texels of each tile, texel by texel; none where nothing is painted.
    tiles: Vec<Option<Arc<Vec<f32>>>>,
}

impl Channels {
    fn of(layers: Layers) -> Channels {
        let mut count = 1;
        let mut place = |is_kept: bool, numbers: usize| {
            is_kept.then(|| {
                count += numbers;
                count - numbers
            })
        };
        let (value, height) = (place(layers.value, 1), place(layers.height, 1));
        let (color, direction) = (place(layers.color, 3), place(layers.direction, 3));
        Channels {
            value,
            height,
            color,
            direction,
            count,
        }
    }
}

/// Returns true if two canvases share a tile, or nothing is painted there on either.
fn is_same(one: &Option<Arc<Vec<f32>>>, other: &Option<Arc<Vec<f32>>>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => Arc::ptr_eq(one, other),
        (one, other) => one.is_none() && other.is_none(),
    }
}

impl Canvas {
    /// An empty canvas for an atlas of that many texels.
    pub fn empty(texels: usize, layers: Layers) -> Canvas {
        Canvas {
            channels: Channels::of(layers),
            tiles: vec![None; texels.div_ceil(TILE)],
            layers,
            texels,
        }
    }

    /// An empty canvas of the same atlas and layers.
    pub fn emptied(&self) -> Canvas {
        Canvas::empty(self.texels, self.layers)
    }

    /// The layers that it keeps.
    pub fn layers(&self) -> Layers {
        self.layers
    }

    /// Bytes of memory that canvases of one atlas take alone: without the tiles that others share with them.
    pub(crate) fn own_bytes(canvases: &[&Canvas]) -> usize {
        let count = canvases.first().map_or(0, |canvas| canvas.tiles.len());
        let tables: usize = canvases.iter().map(|canvas| size_of_val(canvas.tiles.as_slice())).sum();
        let bytes_at = |index: usize| {
            let tiles = || canvases.iter().filter_map(|canvas| canvas.tiles[index].as_ref());
            let own = tiles().enumerate().filter(|(at, tile)| {
                let is_first = !tiles().take(*at).any(|other| Arc::ptr_eq(other, tile));
                is_first && Arc::strong_count(tile) == tiles().filter(|other| Arc::ptr_eq(other, tile)).count()
            });
            own.map(|(_, tile)| 4 * tile.len()).sum::<usize>()
        };
        (0..count).map(bytes_at).sum::<usize>() + tables
    }

    /// The canvas with only a share, 0 to 1, of what it changes on a canvas below it. `known` are three canvases of which the last is what
    /// that gave for the first, below, and the second: tiles that are the same in both are taken from it.
    pub(crate) fn faded(&self, below: &Canvas, share: f32, known: Option<[&Canvas; 3]>) -> Canvas {
        let empty = vec![0.0; TILE * self.channels.count];
        let tiles = self
            .tiles
            .iter()
            .zip(&below.tiles)
            .enumerate()
            .map(|(index, (full, under))| {
                if is_same(full, under) {
                    return full.clone();
                }
                if let Some([known_under, known_full, faded]) =
                    known.map(|known| known.map(|canvas| &canvas.tiles[index]))
                    && is_same(known_full, full)
                    && is_same(known_under, under)
                {
                    return faded.clone();
                }
                let [full, under] = [full, under].map(|tile| tile.as_deref().unwrap_or(&empty)); // Nothing is painted there.
                let mixed = full
                    .iter()
                    .zip(under)
                    .map(|(full, under)| under + share * (full - under));
                Some(Arc::new(mixed.collect()))
            });
        Canvas {
            tiles: tiles.collect(),
            ..self.emptied()
        }
    }

    /// Address and bytes of each tile.
    #[cfg(test)]
    pub(crate) fn tile_addresses(&self) -> impl Iterator<Item = (usize, usize)> {
        let tiles = self.tiles.iter().flatten();
        tiles.map(|tile| (Arc::as_ptr(tile) as usize, 4 * tile.len()))
    }

    /// The paint on a texel.
    pub fn texel(&self, texel: usize) -> CanvasTexel {
        let Some(numbers) = self.numbers(texel) else {
            return CanvasTexel::default();
        };
        let single = |at: Option<usize>| at.map_or(0.0, |at| numbers[at]);
        let several = |at: Option<usize>| at.map_or([0.0; 3], |at| [numbers[at], numbers[at + 1], numbers[at + 2]]);
        CanvasTexel {
            cover: numbers[0],
            value: single(self.channels.value),
            color: several(self.channels.color),
            height: single(self.channels.height),
            direction: several(self.channels.direction),
        }
    }

    /// All texels in order.
    pub fn texels(&self) -> impl Iterator<Item = CanvasTexel> {
        (0..self.texels).map(|texel| self.texel(texel))
    }

    /// Numbers of a texel; none where nothing is painted around it, or for a texel that the atlas does not have.
    fn numbers(&self, texel: usize) -> Option<&[f32]> {
        let tile = self.tiles.get(texel / TILE)?.as_ref()?;
        let at = texel % TILE * self.channels.count;
        tile.get(at..at + self.channels.count)
    }

    /// Numbers of a texel that are to be changed.
    fn numbers_mut(&mut self, texel: usize) -> &mut [f32] {
        let count = self.channels.count;
        let empty = || Arc::new(vec![0.0; TILE * count]);
        let tile = Arc::make_mut(self.tiles[texel / TILE].get_or_insert_with(empty));
        let at = texel % TILE * count;
        &mut tile[at..at + count]
    }

    /// The first texel of each eight in a row that differ from those of an earlier canvas of the same atlas, in order; none where the
    /// other one has other layers.
    pub fn changed_since(&self, before: &Canvas) -> Option<Vec<u32>> {
        if (self.layers, self.texels) != (before.layers, before.texels) {
            return None;
        }
        let count = EIGHT * self.channels.count;
        let empty = vec![0.0; TILE * self.channels.count];
        let mut changed = Vec::new();
        for (at, tiles) in self.tiles.iter().zip(&before.tiles).enumerate() {
            if is_same(tiles.0, tiles.1) {
                continue;
            }
            let [own, old] = [tiles.0, tiles.1].map(|tile| tile.as_deref().unwrap_or(&empty)); // Nothing is painted there.
            let eights = own.chunks_exact(count).zip(old.chunks_exact(count)).enumerate();
            let differs = eights.filter(|(_, (own, old))| own != old);
            changed.extend(differs.map(|(index, _)| (at * TILE + index * EIGHT) as u32));
        }
        changed.retain(|texel| (*texel as usize) < self.texels);
        Some(changed)
    }

    /// Number of values of a texel, over all layers.
    fn channel_count(&self) -> usize {
        self.channels.count
    }

    /// The values of a texel that [`Canvas::write`] takes.
    fn read(&self, texel: usize, values: &mut [f32]) {
        match self.numbers(texel) {
            Some(numbers) => values.copy_from_slice(numbers),
            None => values.fill(0.0),
        }
    }

    /// The values of a texel that is fully painted in a linear color: its luminance is the value of the mask.
    fn values_of_color(&self, color: [f32; 3], values: &mut [f32]) {
        let color = bounded(color);
        values.fill(0.0);
        values[0] = 1.0;
        if let Some(at) = self.channels.value {
            values[at] = luminance(color);
        }
        if let Some(at) = self.channels.color {
            values[at..at + 3].copy_from_slice(&color);
        }
    }

    /// Replaces the height and the direction among some values of a texel by those of others.
    fn keep_relief(&self, from: &[f32], values: &mut [f32]) {
        let height = self.channels.height.map(|at| at..at + 1);
        let direction = self.channels.direction.map(|at| at..at + 3);
        for range in [height, direction].into_iter().flatten() {
            values[range.clone()].copy_from_slice(&from[range]);
        }
    }

    /// Replaces the values of a texel; what a mask and a color cannot be is brought into their ranges.
    fn write(&mut self, texel: usize, values: &[f32]) {
        let channels = self.channels;
        let numbers = self.numbers_mut(texel);
        numbers.copy_from_slice(values);
        let cover = numbers[0].clamp(0.0, 1.0);
        numbers[0] = cover;
        let value = channels.value.map(|at| at..at + 1);
        let color = channels.color.map(|at| at..at + 3);
        for range in [value, color].into_iter().flatten() {
            for number in &mut numbers[range] {
                *number = number.clamp(0.0, cover);
            }
        }
    }

    /// Lays paint on a texel, or takes paint away from it.
    fn lay(&mut self, texel: usize, erases: bool, paint: &Laid) {
        let left = 1.0 - paint.strength;
        let laid = if erases { 0.0 } else { paint.strength };
        let channels = self.channels;
        let numbers = self.numbers_mut(texel);
        numbers[0] = numbers[0] * left + laid;
        if let Some(at) = channels.value {
            numbers[at] = numbers[at] * left + laid * paint.value;
        }
        for (at, new) in [
            (channels.color, Some(paint.color)),
            (channels.direction, paint.direction),
        ] {
            if let (Some(at), Some(new)) = (at, new) {
                for (number, new) in numbers[at..at + 3].iter_mut().zip(new) {
                    *number = *number * left + laid * new;
                }
            }
        }
        if let Some(at) = channels.height {
            // Strokes that carve or raise add up; others leave the height alone.
            numbers[at] = if erases {
                numbers[at] * left
            } else {
                numbers[at] + paint.strength * paint.height
            };
        }
    }
}
