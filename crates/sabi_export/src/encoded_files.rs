//! Cache of encoded files by the data that they were encoded from, so that no file is encoded twice.

use std::collections::BTreeMap;
use std::fmt::Debug;

use crate::ChannelPixels;
use crate::encode::{ComponentPlane, FileEncoding};

/// Store of encoded files.
pub trait EncodedFiles: Debug + Send + Sync {
    /// Returns the file that was kept under a key.
    fn find(&self, key: &[u8; 32]) -> Option<Vec<u8>>;

    /// Keeps a file under a key.
    fn keep(&self, key: &[u8; 32], file: &[u8]);
}

/// Returns a hash of everything except the program that determines the bytes of a file.
pub(crate) fn key(planes: &[ComponentPlane<'_>], encoding: FileEncoding) -> [u8; 32] {
    let mut hash = blake3::Hasher::new_derive_key("sabi encoded files");
    // Channels are packed more than once.
    let mut known: BTreeMap<*const f32, blake3::Hash> = BTreeMap::new();
    let mut pixels_hash = |pixels: &ChannelPixels| {
        *known.entry(pixels.data.as_ptr()).or_insert_with(|| {
            blake3::Hasher::new()
                .update_rayon(bytemuck::cast_slice(&pixels.data))
                .finalize()
        })
    };
    let mut part = |bytes: &[u8]| {
        hash.update(&(bytes.len() as u64).to_le_bytes());
        hash.update(bytes);
    };
    part(format!("{encoding:?}").as_bytes());
    for plane in planes {
        match plane {
            ComponentPlane::Constant(value) => part(&value.to_le_bytes()),
            ComponentPlane::Channel {
                pixels,
                index,
                codes,
                is_inverted,
                dither,
            } => {
                let how = format!("{index} of {}, {codes:?}, {is_inverted}, {dither:?}", pixels.components);
                part(how.as_bytes());
                part(pixels_hash(pixels).as_bytes());
            }
        }
    }
    *hash.finalize().as_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encode::{CodeMapping, encode};
    use crate::preset::MapFormat;
    use sabi_image::DitherPattern;

    const ENCODING: FileEncoding = FileEncoding {
        size: [2, 1],
        format: MapFormat::Png { bits: 8 },
        is_srgb: false,
    };

    #[test]
    fn files_of_different_bytes_have_different_keys() {
        let pixels = |data: [f32; 4]| ChannelPixels {
            components: 2,
            data: data.to_vec(),
        };
        let (one, same, other) = (
            pixels([0.0, 0.25, 0.5, 1.0]),
            pixels([0.0, 0.25, 0.5, 1.0]),
            pixels([0.0, 0.25, 0.5, 0.75]),
        );
        let plane = |pixels, index, codes, is_inverted| ComponentPlane::Channel {
            pixels,
            index,
            codes,
            is_inverted,
            dither: None,
        };
        let of = |plane: ComponentPlane<'_>, encoding| (key(&[plane], encoding), encode(&[plane], encoding).unwrap());
        let first = of(plane(&one, 0, CodeMapping::Unit, false), ENCODING);
        assert_eq!(of(plane(&same, 0, CodeMapping::Unit, false), ENCODING), first);
        let others = [
            of(plane(&one, 1, CodeMapping::Unit, false), ENCODING),
            of(plane(&other, 1, CodeMapping::Unit, false), ENCODING),
            of(plane(&one, 0, CodeMapping::Unit, true), ENCODING),
            of(plane(&one, 0, CodeMapping::Range([0.0, 2.0]), false), ENCODING),
            of(ComponentPlane::Constant(0.5), ENCODING),
            of(
                plane(&one, 0, CodeMapping::Unit, false),
                FileEncoding {
                    is_srgb: true,
                    ..ENCODING
                },
            ),
            of(
                plane(&one, 0, CodeMapping::Unit, false),
                FileEncoding {
                    format: MapFormat::Png { bits: 16 },
                    ..ENCODING
                },
            ),
        ];
        let noise = |seed| {
            let dithered = ComponentPlane::Channel {
                pixels: &one,
                index: 0,
                codes: CodeMapping::Unit,
                is_inverted: false,
                dither: Some(DitherPattern::new(seed, "roughness", 0)),
            };
            key(&[dithered], ENCODING)
        };
        assert!(noise(1) != first.0 && noise(1) != noise(2) && noise(1) == noise(1));
        let mut known = vec![first];
        for (key, file) in others {
            assert!(known.iter().all(|(other, bytes)| *other != key && *bytes != file));
            known.push((key, file));
        }
    }
}
