//! Radiance HDR files (Ward 1991, Real Pixels; new run lengths as in Radiance 2.0).

use glam::DVec3;

/// The shortest run that is written as one: a shorter one costs as much as its bytes.
const SHORTEST_RUN: usize = 4;
/// The longest stretch of bytes or of a run, in bytes.
const LONGEST: [usize; 2] = [128, 127];

/// The file of linear pixels, row by row from the top.
pub(super) fn encode(width: usize, pixels: &[DVec3]) -> Vec<u8> {
    let height = pixels.len() / width;
    let mut file = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for row in pixels.chunks_exact(width) {
        file.extend([2, 2, (width >> 8) as u8, width as u8]);
        let row: Vec<[u8; 4]> = row.iter().map(|pixel| shared_exponent(*pixel)).collect();
        for channel in 0..4 {
            let bytes: Vec<u8> = row.iter().map(|pixel| pixel[channel]).collect();
            squeeze(&bytes, &mut file);
        }
    }
    file
}

/// Three mantissas and the exponent of the largest.
fn shared_exponent(color: DVec3) -> [u8; 4] {
    let largest = color.max_element();
    if largest < 1e-32 {
        return [0; 4];
    }
    let mut exponent = largest.log2().floor() as i32 + 1;
    let mantissa = |value: f64, exponent: i32| (value.max(0.0) * f64::from(8 - exponent).exp2()).round();
    if mantissa(largest, exponent) > 255.0 {
        exponent += 1;
    }
    let [r, g, b] = color.to_array().map(|value| mantissa(value, exponent) as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// One channel of a row: runs of equal bytes, and stretches of others.
fn squeeze(bytes: &[u8], file: &mut Vec<u8>) {
    let run_at = |at: usize| {
        let same = bytes[at..].iter().take_while(|byte| **byte == bytes[at]).count();
        same.min(LONGEST[1])
    };
    let mut at = 0;
    while at < bytes.len() {
        let start = at;
        while at < bytes.len() && run_at(at) < SHORTEST_RUN {
            at += 1;
        }
        for stretch in bytes[start..at].chunks(LONGEST[0]) {
            file.push(stretch.len() as u8);
            file.extend(stretch);
        }
        if at < bytes.len() {
            let run = run_at(at);
            file.extend([128 + run as u8, bytes[at]]);
            at += run;
        }
    }
}
