//! Draws a contact sheet of all tips, white on dark, in the order of [`Tip::ALL`]: `cargo run --release -p sabi_paint
//! --example tips -- FILE.png [TIP]`. Shows a large stamp, a stroke, and both in the small size of a panel. For a single
//! tip, given by its number from 0 on, everything is three times as large. Prints the time for a texel of each tip.

#![allow(clippy::print_stdout, reason = "a program of its own")]

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use sabi_paint::{Brush, StampPictures, SwatchPixel, Tip, stamp_swatch, swatch};

/// Columns of the sheet.
const COLUMNS: usize = 4;
/// Size of a cell of the sheet.
const CELL: [usize; 2] = [470, 200];
/// Side in texels of the stamp whose time is measured.
const TIMED: usize = 512;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let file = PathBuf::from(arguments.next().ok_or("name the file to write")?);
    let only: Option<usize> = arguments.next().and_then(|number| number.to_str()?.parse().ok());
    let tips: Vec<_> = match only {
        Some(index) => vec![*Tip::ALL.get(index).ok_or("there is no tip of that number")?],
        None => Tip::ALL.to_vec(),
    };
    let (columns, scale) = if only.is_some() { (1, 3) } else { (COLUMNS, 1) };
    let pictures = StampPictures::new();
    let cell = CELL.map(|side| side * scale);
    let mut sheet = Sheet::new([columns * cell[0], tips.len().div_ceil(columns) * cell[1]]);
    for (index, (tip, title)) in tips.into_iter().enumerate() {
        let brush = Brush::default().with_tip(tip);
        let corner = [index % columns * cell[0], index / columns * cell[1]];
        let at = |x: usize, y: usize| [corner[0] + scale * x, corner[1] + scale * y];
        sheet.put(&stamp_swatch(&brush, &pictures, 180 * scale), 180 * scale, at(6, 10));
        sheet.put(
            &swatch(&brush, &pictures, [256 * scale, 80 * scale]),
            256 * scale,
            at(200, 10),
        );
        sheet.put(&stamp_swatch(&brush, &pictures, 64 * scale), 64 * scale, at(200, 108));
        sheet.put(
            &swatch(&brush, &pictures, [128 * scale, 40 * scale]),
            128 * scale,
            at(280, 120),
        );
        sheet.put(&stamp_swatch(&brush, &pictures, 32 * scale), 32 * scale, at(420, 122));
        let (stamp, stroke) = times(&brush);
        println!("{title:12} {stamp:5.0} ns for a texel, {stroke:5.1} ms for a swatch");
    }
    std::fs::write(file, sheet.png())?;
    Ok(())
}

/// Returns nanoseconds for a texel of a large stamp, and milliseconds for a swatch of 128 x 40.
fn times(brush: &Brush) -> (f64, f64) {
    let seconds = |work: &dyn Fn()| {
        let taken = (0..3).map(|_| {
            let started = Instant::now();
            work();
            started.elapsed().as_secs_f64()
        });
        taken.fold(f64::INFINITY, f64::min)
    };
    let stamp = |brush: &Brush| {
        seconds(&|| {
            stamp_swatch(brush, &StampPictures::new(), TIMED);
        })
    };
    // The time of a soft disk is subtracted, so that only the time of the tip itself remains.
    let plain = Brush::default().with_tip(Tip::Soft);
    let texels = std::f64::consts::FRAC_PI_4 * (TIMED * TIMED) as f64;
    let stroke = seconds(&|| {
        swatch(brush, &StampPictures::new(), [128, 40]);
    });
    ((stamp(brush) - stamp(&plain)) / texels * 1e9, stroke * 1e3)
}

/// A picture in shades of gray.
struct Sheet {
    size: [usize; 2],
    pixels: Vec<u8>,
}

impl Sheet {
    fn new(size: [usize; 2]) -> Sheet {
        Sheet {
            size,
            pixels: vec![24; size[0] * size[1]],
        }
    }

    fn put(&mut self, shown: &[SwatchPixel], width: usize, corner: [usize; 2]) {
        for (y, row) in shown.chunks(width).enumerate() {
            for (x, shown) in row.iter().enumerate() {
                let at = (corner[1] + y) * self.size[0] + corner[0] + x;
                if let Some(pixel) = self.pixels.get_mut(at) {
                    *pixel = (40.0 + 205.0 * shown.strength) as u8;
                }
            }
        }
    }

    /// Returns the picture as a PNG file without compression, which needs no encoder.
    fn png(&self) -> Vec<u8> {
        let mut rows = Vec::new();
        for row in self.pixels.chunks(self.size[0]) {
            rows.push(0);
            rows.extend(row);
        }
        let mut data = vec![0x78, 1];
        let blocks = rows.chunks(65535);
        let last = blocks.len() - 1;
        for (index, block) in blocks.enumerate() {
            let length = block.len() as u16;
            data.push(u8::from(index == last));
            data.extend(length.to_le_bytes());
            data.extend((!length).to_le_bytes());
            data.extend(block);
        }
        let (mut a, mut b) = (1_u32, 0_u32);
        for byte in &rows {
            a = (a + u32::from(*byte)) % 65521;
            b = (b + a) % 65521;
        }
        data.extend((b << 16 | a).to_be_bytes());
        let mut header: Vec<u8> = self.size.iter().flat_map(|side| (*side as u32).to_be_bytes()).collect();
        header.extend([8, 0, 0, 0, 0]);
        let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
        for (name, content) in [(b"IHDR", header), (b"IDAT", data), (b"IEND", Vec::new())] {
            file.extend((content.len() as u32).to_be_bytes());
            let start = file.len();
            file.extend(name);
            file.extend(content);
            let sum = checksum(&file[start..]);
            file.extend(sum.to_be_bytes());
        }
        file
    }
}

/// CRC-32 of a chunk of a PNG file.
fn checksum(bytes: &[u8]) -> u32 {
    let mut sum = u32::MAX;
    for byte in bytes {
        sum ^= u32::from(*byte);
        for _ in 0..8 {
            sum = if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 };
        }
    }
    !sum
}
