//! Padding outside the charts: the nearest covered pixel, found once for a texture set and used for every channel.

use rayon::prelude::*;

use crate::layout::{Cover, NONE, SetLayout};
use crate::{Channel, ChannelPixels};

/// Distance over which padding extends the charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Padding {
    /// Number of texels, Euclidean; pixels further away have the channel's neutral value.
    Texels(u32),
    /// The whole picture, so that no mip level contains an empty texel.
    #[default]
    Infinite,
}

/// For each pixel of a texture set the pixel that gives its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PaddingMap {
    /// Row by row from the top: the pixel itself where a chart or a ring covers it, else the nearest covered one, or
    /// [`NONE`].
    pub source: Vec<u32>,
}

/// Pixels of one parallel task.
const PART: usize = 1 << 14;

impl PaddingMap {
    /// Finds the exact nearest covered pixel by Euclidean distance, in two passes in integers (Meijster 2000). Of pixels
    /// equally near, the left column is taken, and in a column the upper one.
    pub fn new(layout: &SetLayout, padding: Padding) -> PaddingMap {
        let size = layout.size as usize;
        let nearest_row = nearest_in_column(size, &layout.cover);
        let reach_squared = match padding {
            Padding::Infinite => i64::MAX,
            Padding::Texels(texels) => i64::from(texels) * i64::from(texels),
        };
        let mut source = vec![NONE; size * size];
        source
            .par_chunks_mut(size.max(1))
            .enumerate()
            .for_each_init(Vec::new, |envelope, (y, row)| {
                let rows = &nearest_row[y * size..(y + 1) * size];
                // Many rows are covered completely and need no search.
                if layout.cover[y * size..(y + 1) * size]
                    .iter()
                    .all(|&cover| cover != Cover::Empty)
                {
                    for (x, pixel) in row.iter_mut().enumerate() {
                        *pixel = (y * size + x) as u32;
                    }
                } else {
                    nearest_in_row(y, rows, reach_squared, envelope, row);
                }
            });
        PaddingMap { source }
    }

    /// Gathers a channel of the set from the atlas: covered pixels are exact copies of their texels, or the mean of those that
    /// share one in a merged layout; padding repeats them.
    ///
    /// `texel` returns the values of an atlas texel, of which the channel's begin at `first`; values beyond them are the
    /// channel's neutral ones.
    pub fn gather(
        &self,
        layout: &SetLayout,
        channel: &Channel,
        first: usize,
        texel: impl Fn(usize) -> [f32; 4] + Sync,
    ) -> ChannelPixels {
        let data = match channel.neutral() {
            [neutral] => self.gathered([*neutral], layout, first, texel),
            [x, y, z] => self.gathered([*x, *y, *z], layout, first, texel),
            _ => Vec::new(),
        };
        ChannelPixels {
            components: channel.components(),
            data,
        }
    }

    fn gathered<const N: usize>(
        &self,
        neutral: [f32; N],
        layout: &SetLayout,
        first: usize,
        texel: impl Fn(usize) -> [f32; 4] + Sync,
    ) -> Vec<f32> {
        let of_texel = |at: usize| {
            let stored = texel(at);
            // A texel has four values; components beyond them are neutral.
            std::array::from_fn(|index| stored.get(first + index).copied().unwrap_or(neutral[index]))
        };
        let mut data = vec![0.0; self.source.len() * N];
        let parts = data.par_chunks_mut(PART * N).zip(self.source.par_chunks(PART));
        parts.for_each(|(values, sources)| {
            for (values, &pixel) in values.as_chunks_mut::<N>().0.iter_mut().zip(sources) {
                // A pixel beyond the distance of the padding is `NONE`, which is no index.
                let from = layout.source.get(pixel as usize).copied().unwrap_or(NONE);
                *values = if from == NONE { neutral } else { of_texel(from as usize) };
            }
        });
        self.share(layout, &mut data, of_texel);
        data
    }

    /// Sets pixels that several texels claim to their mean.
    fn share<const N: usize>(&self, layout: &SetLayout, data: &mut [f32], of_texel: impl Fn(usize) -> [f32; N]) {
        if layout.shared.is_empty() {
            return;
        }
        for (values, &pixel) in data.as_chunks_mut::<N>().0.iter_mut().zip(&self.source) {
            let mut sources = layout.sources(pixel as usize).skip(1).peekable();
            if sources.peek().is_none() {
                continue;
            }
            let mut count = 1.0;
            for from in sources {
                let more = of_texel(from);
                *values = std::array::from_fn(|at| values[at] + more[at]);
                count += 1.0;
            }
            *values = values.map(|sum| sum / count);
        }
    }

    /// Fills the pixels that no chart covers, in a channel laid out as the set is.
    pub fn pad(&self, channel: &Channel, pixels: &mut ChannelPixels) {
        let components = pixels.components;
        let neutral = channel.neutral();
        for pixel in 0..self.source.len().min(pixels.data.len() / components.max(1)) {
            let from = self.source[pixel] as usize;
            let to = pixel * components;
            if self.source[pixel] == NONE {
                for (value, &neutral) in pixels.data[to..to + components].iter_mut().zip(neutral) {
                    *value = neutral;
                }
            } else if from != pixel {
                // Sources are covered pixels, which are never written.
                pixels.data.copy_within(from * components..(from + 1) * components, to);
            }
        }
    }
}

/// Returns for each pixel the row of the nearest covered one in its column, of two equally near the upper.
fn nearest_in_column(size: usize, cover: &[Cover]) -> Vec<u32> {
    let mut nearest = vec![NONE; size * size];
    let mut last = vec![NONE; size];
    for y in 0..size {
        for (x, last) in last.iter_mut().enumerate() {
            if cover[y * size + x] != Cover::Empty {
                *last = y as u32;
            }
            nearest[y * size + x] = *last;
        }
    }
    last.fill(NONE);
    for y in (0..size).rev() {
        for (x, last) in last.iter_mut().enumerate() {
            let at = y * size + x;
            if nearest[at] == y as u32 {
                *last = y as u32;
            } else if *last != NONE && (nearest[at] == NONE || *last - (y as u32) < y as u32 - nearest[at]) {
                nearest[at] = *last;
            }
        }
    }
    nearest
}

/// Parabola of a column in the lower envelope, with the first pixel of the row at which it is the lowest.
#[derive(Clone, Copy)]
struct Parabola {
    column: usize,
    height_squared: i64,
    from: i64,
}

fn nearest_in_row(y: usize, nearest_row: &[u32], reach_squared: i64, envelope: &mut Vec<Parabola>, row: &mut [u32]) {
    let size = row.len();
    envelope.clear();
    for (column, &nearest) in nearest_row.iter().enumerate() {
        if nearest == NONE {
            continue;
        }
        let height = i64::from(nearest) - y as i64;
        let height_squared = height * height;
        let mut from = 0;
        while let Some(&top) = envelope.last() {
            // First pixel at which the new column is strictly nearer than the one before it.
            let (i, u) = (top.column as i64, column as i64);
            from = (u * u - i * i + height_squared - top.height_squared).div_euclid(2 * (u - i)) + 1;
            if from > top.from {
                break;
            }
            envelope.pop();
            from = 0;
        }
        if from < size as i64 {
            envelope.push(Parabola {
                column,
                height_squared,
                from,
            });
        }
    }
    let mut parabolas = envelope.iter().peekable();
    let mut current = None;
    for (x, pixel) in row.iter_mut().enumerate() {
        while let Some(parabola) = parabolas.next_if(|parabola| parabola.from <= x as i64) {
            current = Some(parabola);
        }
        let Some(parabola) = current else { break };
        let across = x as i64 - parabola.column as i64;
        if across * across + parabola.height_squared <= reach_squared {
            *pixel = (nearest_row[parabola.column] as usize * size + parabola.column) as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::SetKey;

    fn layout(size: u32, covered: &[bool]) -> SetLayout {
        let cover = |&owned: &bool| if owned { Cover::Owned } else { Cover::Empty };
        let source = |(index, &owned): (usize, &bool)| if owned { index as u32 } else { NONE };
        SetLayout {
            key: SetKey {
                material: 0,
                uv_tile: [0, 0],
                udim: None,
            },
            size,
            source: covered.iter().enumerate().map(source).collect(),
            cover: covered.iter().map(cover).collect(),
            shared: Vec::new(),
            collisions: 0,
        }
    }

    fn distance_squared(size: u32, a: u32, b: u32) -> i64 {
        let (ax, ay, bx, by) = (a % size, a / size, b % size, b / size);
        (i64::from(ax) - i64::from(bx)).pow(2) + (i64::from(ay) - i64::from(by)).pow(2)
    }

    proptest! {
        #[test]
        fn padding_is_the_nearest_covered_pixel(
            size in 1u32..24, seeds in proptest::collection::vec(0u32..576, 0..12), dense: bool, reach in 0u32..10
        ) {
            let mut covered = vec![false; (size * size) as usize];
            for seed in &seeds {
                covered[(seed % (size * size)) as usize] = true;
            }
            if dense {
                covered.iter_mut().enumerate().for_each(|(i, c)| *c |= i % 3 == 1);
            }
            let layout = layout(size, &covered);
            for padding in [Padding::Infinite, Padding::Texels(reach)] {
                let map = PaddingMap::new(&layout, padding);
                for pixel in 0..size * size {
                    let nearest = (0..size * size)
                        .filter(|&other| covered[other as usize])
                        .map(|other| distance_squared(size, pixel, other))
                        .min();
                    let limit = if padding == Padding::Infinite { i64::MAX } else { i64::from(reach * reach) };
                    match nearest {
                        Some(nearest) if nearest <= limit => {
                            let source = map.source[pixel as usize];
                            prop_assert!(source != NONE && covered[source as usize]);
                            prop_assert_eq!(distance_squared(size, pixel, source), nearest);
                        }
                        _ => prop_assert_eq!(map.source[pixel as usize], NONE),
                    }
                }
            }
        }
    }

    const SIZE: u32 = 128;

    /// Charts of several shapes, with gaps between them from one texel on, as a map of ones over a background of zeros.
    fn ones(padding: Padding) -> (Vec<bool>, Vec<f32>) {
        let covered: Vec<bool> = (0..SIZE * SIZE)
            .map(|pixel| {
                let (x, y) = ((pixel % SIZE) as i32, (pixel / SIZE) as i32);
                let is_disk = (x - 90).pow(2) + (y - 85).pow(2) < 20 * 20;
                let is_strip = (20..22).contains(&x) && (10..110).contains(&y);
                let is_triangle = x > 24 && y > 8 && x + y < 70;
                is_disk || is_strip || is_triangle || (x, y) == (110, 20)
            })
            .collect();
        let layout = layout(SIZE, &covered);
        let one = |_| [1.0, 0.0, 0.0, 0.0];
        let map = PaddingMap::new(&layout, padding).gather(&layout, &Channel::Metallic, 0, one);
        (covered, map.data)
    }

    /// The next mip level by averaging four texels.
    fn halved(level: &[f32]) -> Vec<f32> {
        let side = level.len().isqrt();
        let mean = |at: usize| {
            let first = at / (side / 2) * 2 * side + at % (side / 2) * 2;
            (level[first] + level[first + 1] + level[first + side] + level[first + side + 1]) / 4.0
        };
        (0..level.len() / 4).map(mean).collect()
    }

    /// The lowest value that a bilinear lookup in a mip level finds at the corners of covered texels.
    fn lowest(covered: &[bool], level: &[f32]) -> f32 {
        let side = level.len().isqrt() as i32;
        let texel = |x: i32, y: i32| level[(y.clamp(0, side - 1) * side + x.clamp(0, side - 1)) as usize];
        let lookup = |x: f32, y: f32| {
            let [x, y] = [x, y].map(|at| at * side as f32 / SIZE as f32 - 0.5);
            let (left, top, u, v) = (x.floor() as i32, y.floor() as i32, x - x.floor(), y - y.floor());
            let row = |y| texel(left, y) * (1.0 - u) + texel(left + 1, y) * u;
            row(top) * (1.0 - v) + row(top + 1) * v
        };
        let mut lowest = f32::INFINITY;
        for pixel in (0..SIZE * SIZE).filter(|pixel| covered[*pixel as usize]) {
            let (x, y) = ((pixel % SIZE) as f32, (pixel / SIZE) as f32);
            for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.5)] {
                lowest = lowest.min(lookup(x + dx, y + dy));
            }
        }
        lowest
    }

    #[test]
    fn no_mip_level_that_the_padding_is_for_bleeds() {
        for texels in [2_u32, 4, 8, 16] {
            let (covered, mut level) = ones(Padding::Texels(texels));
            let mut first_that_bleeds = None;
            for number in 0..6_u32 {
                if lowest(&covered, &level) < 1.0 {
                    first_that_bleeds = first_that_bleeds.or(Some(number));
                }
                level = halved(&level);
            }
            // A lookup reaches one and a half texels of its level out of a chart, which is 2.1 across a corner.
            let first = first_that_bleeds.unwrap();
            assert!(2_u32.pow(first) * 2 > texels, "{texels} texels: level {first} bleeds");
        }
        let (covered, mut level) = ones(Padding::Infinite);
        while level.len() > 1 {
            assert_eq!(lowest(&covered, &level), 1.0);
            assert!(level.iter().all(|&value| value == 1.0), "infinite fills all");
            level = halved(&level);
        }
    }

    #[test]
    fn of_two_equally_near_pixels_the_left_and_the_upper_one_is_taken() {
        let covered: Vec<bool> = (0..25).map(|i| [2, 10, 14, 22].contains(&i)).collect();
        let map = PaddingMap::new(&layout(5, &covered), Padding::Infinite);
        assert_eq!(map.source[12], 10);
        let column: Vec<bool> = (0..25).map(|i| [2, 22].contains(&i)).collect();
        assert_eq!(PaddingMap::new(&layout(5, &column), Padding::Infinite).source[12], 2);
    }

    #[test]
    fn covered_pixels_are_copies_and_the_rest_is_neutral_beyond_the_reach() {
        let covered: Vec<bool> = (0..64).map(|i| i == 9).collect();
        let layout = layout(8, &covered);
        let map = PaddingMap::new(&layout, Padding::Texels(1));
        let texel = |at: usize| std::array::from_fn(|value| (4 * at + value) as f32);
        let normal = map.gather(&layout, &Channel::Normal, 1, texel);
        assert_eq!(normal.data[27..30], [37.0, 38.0, 39.0]);
        assert_eq!(normal.data[30..33], [37.0, 38.0, 39.0]);
        assert_eq!(normal.data[33..36], [0.0, 0.0, 1.0]);
        let mut padded = normal.clone();
        padded.data[30] = f32::NAN;
        padded.data[33] = 7.0;
        map.pad(&Channel::Normal, &mut padded);
        assert_eq!(padded, normal);
    }
}
