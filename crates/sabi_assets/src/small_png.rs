//! PNG files: those that Sabi writes are read, and small ones of few colors are written, for pages that are read in a browser.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Decoded picture of 8 bits a channel.
#[derive(Clone, Debug)]
pub(crate) struct RgbPicture {
    /// Width and height in pixels.
    pub(crate) size: [usize; 2],
    /// Codes row by row; gray is repeated.
    pub(crate) pixels: Vec<[u8; 3]>,
}

/// Reads a PNG file; an error is a sentence that names the file.
pub(crate) fn read(path: &Path) -> Result<RgbPicture, String> {
    let fault = |error: &dyn std::fmt::Display| format!("{} cannot be read: {error}", path.display());
    let file = File::open(path).map_err(|error| fault(&error))?;
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|error| fault(&error))?;
    let size = reader.output_buffer_size().ok_or_else(|| fault(&"it is too large"))?;
    let mut bytes = vec![0; size];
    let info = reader.next_frame(&mut bytes).map_err(|error| fault(&error))?;
    let pixels = bytes[..info.buffer_size()].chunks_exact(info.color_type.samples());
    Ok(RgbPicture {
        size: [info.width as usize, info.height as usize],
        pixels: pixels
            .map(|pixel| match *pixel {
                [r, g, b, ..] => [r, g, b],
                _ => [pixel[0]; 3],
            })
            .collect(),
    })
}

/// Encodes a picture as a PNG with as many colors as fit into `most_bytes`.
pub(crate) fn encode(pixels: &[[u8; 3]], size: [usize; 2], most_bytes: usize) -> Result<Vec<u8>, String> {
    for colors in [192, 128, 96, 64, 48, 32, 24, 16, 8] {
        let (palette, indices) = reduce(pixels, colors);
        let bytes = write(&palette, &indices, size).map_err(|error| error.to_string())?;
        if bytes.len() <= most_bytes {
            return Ok(bytes);
        }
    }
    Err(format!("even with eight colors it takes more than {most_bytes} bytes"))
}

fn write(palette: &[[u8; 3]], indices: &[u8], [width, height]: [usize; 2]) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
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

/// Computes a palette by median cut (Heckbert 1982), ordered by brightness, and the entry of each pixel.
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
