//! Any bytes are a picture as large as it says, or a fault.

use sabi_image::{Pixels, decode};

pub fn survives(bytes: &[u8]) {
    let Ok(picture) = decode("picture", bytes) else {
        return;
    };
    let samples = match &picture.pixels {
        Pixels::U8(values) => values.len(),
        Pixels::U16(values) => values.len(),
        Pixels::F32(values) => values.len(),
    };
    let pixels = picture.width as usize * picture.height as usize;
    assert_eq!(samples, pixels * usize::from(picture.channels));
}
