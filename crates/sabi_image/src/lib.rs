//! Decoding and encoding of images: PNG, EXR, HDR and others, color spaces, dithering.
//!
//! [`decode`] converts the bytes of an image file to a [`Picture`], and [`check_header`] checks beforehand whether it can.
//! [`encode_png`] and [`encode_exr`] convert numbers to the bytes of a file.
//!
//! Invariants:
//! * Nothing here opens files or knows the purpose of an image.
//! * The same numbers give the same bytes, on every machine and any number of threads.
//! * The size of an image is checked before memory is allocated for it.
//! * sRGB is decoded and encoded by `sabi_color`; no formula of it is repeated here.
//!
//! ```
//! use sabi_color::srgb8_from_linear;
//! use sabi_image::{Pixels, PngData, PngOptions, decode, encode_png};
//!
//! let codes = [0.0, 0.2, 1.0].map(srgb8_from_linear);
//! let options = PngOptions { channels: 3, bits: 8, srgb_chunk: true };
//! let file = encode_png(1, 1, PngData::U8(&codes), options)?;
//! assert_eq!(decode("pixel.png", &file)?.pixels, Pixels::U8(vec![0, 124, 255]));
//! # Ok::<(), sabi_image::ImageError>(())
//! ```

mod blue_noise;
mod declared_color;
mod decode;
mod decode_bmp;
mod decode_exr;
mod decode_hdr;
mod decode_ktx2;
mod encode_exr;
mod encode_png;
mod encode_tga;
mod error;
mod exr_layers;
mod picture;
mod quantize;
mod size_limits;

pub use blue_noise::DitherPattern;
pub use decode::{check_header, decode, decode_layer, decoded_size, layer_names};
pub use encode_exr::{ExrSamples, encode_exr};
pub use encode_png::{PngData, PngOptions, encode_png};
pub use encode_tga::encode_tga;
pub use error::{ImageError, listed_layers};
pub use picture::{DeclaredColorSpace, LinearPicture, Picture, PictureRemarks, Pixels, TransferCurve};
pub use quantize::{DitheredRow, level, quantize_u8, quantize_u16, rounded};
pub use size_limits::{DecodedSize, MAX_DECODED_BYTES, MAX_SIDE};
