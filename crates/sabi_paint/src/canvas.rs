//! Canvases: the paint that strokes leave on an atlas.

mod adjust;
mod brush_shape;
mod fills;
mod grid;
mod outlines;
mod painter;
mod patches;
mod remaining_paint;
mod ribbon;
mod sight;
mod similar;
mod stamps;
mod strengths;
mod stroke_growth;
#[cfg(test)]
mod tests;
mod texels;
mod used_brush;

pub use painter::Painter;
pub use strengths::LaidStroke;
pub use stroke_growth::Growth;
pub(crate) use stroke_growth::can_grow;

use std::sync::Arc;

use sabi_color::luminance;

use crate::supplies::bounded;

/// Layers that a canvas stores for each texel in addition to the cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CanvasLayers {
    /// The value of a mask.
    pub value: bool,
    /// The color.
    pub color: bool,
    /// The height.
    pub height: bool,
    /// The direction of the strokes.
    pub direction: bool,
}

impl CanvasLayers {
    /// Returns the layers that are in at least one of the two.
    pub fn and(self, other: CanvasLayers) -> CanvasLayers {
        CanvasLayers {
            value: self.value || other.value,
            color: self.color || other.color,
            height: self.height || other.height,
            direction: self.direction || other.direction,
        }
    }

    /// Returns true if all layers of `other` are among these.
    pub fn contain(self, other: CanvasLayers) -> bool {
        (self.value || !other.value)
            && (self.color || !other.color)
            && (self.height || !other.height)
            && (self.direction || !other.direction)
    }
}

/// Texels of a tile: about as many as a stroke changes in a row of a page.
const TILE: usize = 512;
/// Number of texels that are compared at once.
const EIGHT: usize = 8;

/// Paint on a texel; 0 for layers that are not stored.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CanvasTexel {
    /// Painted share of the texel, 0 to 1.
    pub cover: f32,
    /// Value times cover.
    pub value: f32,
    /// Linear color times cover.
    pub color: [f32; 3],
    /// Height, model units.
    pub height: f32,
    /// Direction of the strokes in model space, times cover.
    pub direction: [f32; 3],
}

/// Paint that a stroke puts on a texel.
struct TexelPaint {
    /// Share of the texel, 0 to 1.
    strength: f32,
    /// Value of the mask.
    value: f32,
    /// Height that is added, model units.
    height: f32,
    /// Linear color.
    color: [f32; 3],
    /// Direction of the stroke in model space; `None` if the existing direction is kept.
    direction: Option<[f32; 3]>,
}

/// Index of each layer among the numbers of a texel, which start with the cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Channels {
    value: Option<usize>,
    height: Option<usize>,
    color: Option<usize>,
    direction: Option<usize>,
    /// Numbers of a texel.
    count: usize,
}

/// Paint of strokes on an atlas, for each texel including ghosts. A copy shares its tiles with the original until they are
/// painted on, so that a stroke costs only the tiles that it touches.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    layers: CanvasLayers,
    channels: Channels,
    texels: usize,
    /// Numbers of the texels of each tile, texel by texel; `None` for tiles without paint.
    tiles: Vec<Option<Arc<Vec<f32>>>>,
}

impl Channels {
    fn of(layers: CanvasLayers) -> Channels {
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

/// Returns true if two canvases share a tile, or if both have no paint there.
fn is_same(one: &Option<Arc<Vec<f32>>>, other: &Option<Arc<Vec<f32>>>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => Arc::ptr_eq(one, other),
        (one, other) => one.is_none() && other.is_none(),
    }
}

impl Canvas {
    /// An empty canvas for an atlas of that many texels.
    pub fn empty(texels: usize, layers: CanvasLayers) -> Canvas {
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

    /// Returns the layers that the canvas stores.
    pub fn layers(&self) -> CanvasLayers {
        self.layers
    }

    /// Returns the bytes of memory that only these canvases of one atlas use, without tiles that they share with others.
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

    /// Returns a canvas with only a share, 0 to 1, of the changes from `below` to this canvas. `known` holds three canvases: an earlier
    /// `below`, an earlier full canvas, and the result for these two. Tiles for which both inputs are the same are taken from that result.
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
                let [full, under] = [full, under].map(|tile| tile.as_deref().unwrap_or(&empty)); // An empty tile has no paint.
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

    /// Returns the numbers of a texel; `None` if its tile has no paint, or if the atlas has no such texel.
    fn numbers(&self, texel: usize) -> Option<&[f32]> {
        let tile = self.tiles.get(texel / TILE)?.as_ref()?;
        let at = texel % TILE * self.channels.count;
        tile.get(at..at + self.channels.count)
    }

    /// Returns the numbers of a texel for changing them.
    fn numbers_mut(&mut self, texel: usize) -> &mut [f32] {
        let count = self.channels.count;
        let empty = || Arc::new(vec![0.0; TILE * count]);
        let tile = Arc::make_mut(self.tiles[texel / TILE].get_or_insert_with(empty));
        let at = texel % TILE * count;
        &mut tile[at..at + count]
    }

    /// Returns the first texel of each group of eight that differs from an earlier canvas of the same atlas, in ascending
    /// order; `None` if the other canvas has other layers.
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
            let [own, old] = [tiles.0, tiles.1].map(|tile| tile.as_deref().unwrap_or(&empty)); // An empty tile has no paint.
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

    /// Reads the values of a texel, as [`Canvas::write`] takes them.
    fn read(&self, texel: usize, values: &mut [f32]) {
        match self.numbers(texel) {
            Some(numbers) => values.copy_from_slice(numbers),
            None => values.fill(0.0),
        }
    }

    /// Writes to `values` those of a texel that is fully painted in a linear color. The value of the mask is the luminance of the color.
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

    /// Replaces the height and the direction in `values` by those in `from`.
    fn keep_relief(&self, from: &[f32], values: &mut [f32]) {
        let height = self.channels.height.map(|at| at..at + 1);
        let direction = self.channels.direction.map(|at| at..at + 3);
        for range in [height, direction].into_iter().flatten() {
            values[range.clone()].copy_from_slice(&from[range]);
        }
    }

    /// Replaces the values of a texel. Values that are out of range for a mask or a color are clamped.
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

    /// Puts paint on a texel, or removes paint from it.
    fn lay(&mut self, texel: usize, erases: bool, paint: &TexelPaint) {
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
            // Heights of strokes that carve or raise add up. Other strokes keep the height.
            numbers[at] = if erases {
                numbers[at] * left
            } else {
                numbers[at] + paint.strength * paint.height
            };
        }
    }
}
