//! Pictures in and out: PNG, EXR, HDR, color spaces, dithering.
//!
//! [`decode`] turns the bytes of a picture file into a [`Picture`], and [`check_header`] tells early whether it may;
//! [`encode_png`] and [`encode_exr`] turn numbers into the bytes of a file. Nothing here opens files, and the same numbers always give the same bytes.

mod color;
mod decode;
mod decode_exr;
mod encode_exr;
mod encode_png;
mod error;
mod picture;
mod quantize;

pub use color::{linear_from_srgb, srgb_from_linear, srgb8_from_linear};
pub use decode::{MAX_DECODED_BYTES, MAX_SIDE, check_header, decode};
pub use encode_exr::encode_exr;
pub use encode_png::{PngData, PngOptions, encode_png};
pub use error::ImageError;
pub use picture::{Declared, LinearPicture, Picture, Pixels};
pub use quantize::{Dither, dither_threshold, quantize_u8, quantize_u16};
