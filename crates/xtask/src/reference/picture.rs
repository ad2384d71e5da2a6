//! Pictures in and out: PNG textures as Sabi writes them, and small PNGs of few colors.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use glam::{DVec2, DVec3};

/// No picture of the reference takes more.
pub(crate) const MOST_BYTES: usize = 24 * 1024;

/// A decoded texture of 8 bits a channel.
#[derive(Clone, Debug)]
pub(crate) struct Texture {
    width: usize,
    height: usize,
    /// Codes 0 to 1, three channels; gray ones are repeated.
    pixels: Vec<[f32; 3]>,
}

impl Texture {
    /// Reads a PNG file; the sentence says what is wrong with it.
    pub(crate) fn read(path: &Path) -> Result<Texture, String> {
        let fault = |error: &dyn std::fmt::Display| format!("{} cannot be read: {error}", path.display());
        let file = File::open(path).map_err(|error| fault(&error))?;
        let mut decoder = png::Decoder::new(BufReader::new(file));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(|error| fault(&error))?;
        let size = reader.output_buffer_size().ok_or_else(|| fault(&"it is too large"))?;
        let mut bytes = vec![0; size];
        let info = reader.next_frame(&mut bytes).map_err(|error| fault(&error))?;
        let samples = info.color_type.samples();
        let pixels = bytes[..info.buffer_size()]
            .chunks_exact(samples)
            .map(|texel| {
                let code = |at: usize| f32::from(texel[at]) / 255.0;
                if samples < 3 {
                    [code(0); 3]
                } else {
                    [code(0), code(1), code(2)]
                }
            })
            .collect();
        Ok(Texture {
            width: info.width as usize,
            height: info.height as usize,
            pixels,
        })
    }

    /// Codes at a texture coordinate (v downward), between the four nearest texels.
    pub(crate) fn sample(&self, uv: DVec2) -> DVec3 {
        let x = (uv.x * self.width as f64 - 0.5).clamp(0.0, self.width as f64 - 1.0);
        let y = (uv.y * self.height as f64 - 0.5).clamp(0.0, self.height as f64 - 1.0);
        let (left, top) = (x as usize, y as usize);
        let at = |i: usize, j: usize| {
            let pixel = self.pixels[j.min(self.height - 1) * self.width + i.min(self.width - 1)];
            DVec3::from(pixel.map(f64::from))
        };
        let upper = at(left, top).lerp(at(left + 1, top), x - left as f64);
        let lower = at(left, top + 1).lerp(at(left + 1, top + 1), x - left as f64);
        upper.lerp(lower, y - top as f64)
    }
}

/// sRGB code 0..1 to linear.
pub(crate) fn linear_from_srgb(code: f64) -> f64 {
    if code <= 0.04045 {
        code / 12.92
    } else {
        ((code + 0.055) / 1.055).powf(2.4)
    }
}

/// Linear to sRGB code 0..255.
pub(crate) fn srgb8_from_linear(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let code = if linear <= 0.003_130_8 {
        linear * 12.92
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    (code * 255.0).round() as u8
}

/// A square picture as a PNG of so many colors as fit into [`MOST_BYTES`].
pub(crate) fn encode(pixels: &[[u8; 3]], side: usize) -> Result<Vec<u8>, String> {
    for colors in [192, 128, 96, 64, 48, 32, 24, 16, 8] {
        let (palette, indices) = reduce(pixels, colors);
        let bytes = write(&palette, &indices, side).map_err(|error| error.to_string())?;
        if bytes.len() <= MOST_BYTES {
            return Ok(bytes);
        }
    }
    Err(format!("even with eight colors it takes more than {MOST_BYTES} bytes"))
}

fn write(palette: &[[u8; 3]], indices: &[u8], side: usize) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, side as u32, side as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.concat());
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(indices)?;
    writer.finish()?;
    Ok(bytes)
}

/// A palette by median cut (Heckbert 1982) and each pixel's entry, the palette ordered by brightness.
fn reduce(pixels: &[[u8; 3]], colors: usize) -> (Vec<[u8; 3]>, Vec<u8>) {
    let mut boxes: Vec<Vec<[u8; 3]>> = vec![pixels.to_vec()];
    let spread = |colors: &[[u8; 3]]| {
        let range = |channel: usize| {
            let codes = || colors.iter().map(|color| color[channel]);
            codes().max().unwrap_or(0) - codes().min().unwrap_or(0)
        };
        (0..3).map(|channel| (range(channel), channel)).max().unwrap_or((0, 0))
    };
    let mut spreads = vec![spread(&boxes[0])];
    while boxes.len() < colors {
        // The widest box, the larger of equals; counts only weigh as their root, so that small details keep a color.
        let weight = |i: usize| f64::from(spreads[i].0) * (boxes[i].len() as f64).powf(0.35);
        let Some(widest) = (0..boxes.len()).max_by(|&one, &other| weight(one).total_cmp(&weight(other))) else {
            break;
        };
        let (range, channel) = spreads[widest];
        if range == 0 {
            break;
        }
        let mut all = std::mem::take(&mut boxes[widest]);
        all.sort_unstable_by_key(|color| (color[channel], *color));
        let mut middle = all.len() / 2;
        while middle > 0 && all[middle - 1][channel] == all[middle][channel] {
            middle -= 1;
        }
        if middle == 0 {
            let lowest = all[0][channel];
            middle = all.partition_point(|color| color[channel] == lowest);
        }
        let upper = all.split_off(middle);
        spreads[widest] = spread(&all);
        spreads.push(spread(&upper));
        boxes[widest] = all;
        boxes.push(upper);
    }
    let mean = |colors: &Vec<[u8; 3]>| -> [u8; 3] {
        std::array::from_fn(|channel| {
            let sum: usize = colors.iter().map(|color| usize::from(color[channel])).sum();
            (sum as f64 / colors.len().max(1) as f64).round() as u8
        })
    };
    let mut palette: Vec<[u8; 3]> = boxes.iter().map(mean).collect();
    palette.sort_unstable_by_key(|color| (color.iter().map(|&code| u32::from(code)).sum::<u32>(), *color));
    palette.dedup();
    let mut known = std::collections::BTreeMap::new();
    let nearest = |color: &[u8; 3]| {
        let distance = |entry: &[u8; 3]| -> i32 {
            (0..3)
                .map(|at| (i32::from(entry[at]) - i32::from(color[at])).pow(2))
                .sum()
        };
        (0..palette.len()).min_by_key(|&i| distance(&palette[i])).unwrap_or(0) as u8
    };
    let indices = pixels
        .iter()
        .map(|color| *known.entry(*color).or_insert_with(|| nearest(color)))
        .collect();
    (palette, indices)
}
