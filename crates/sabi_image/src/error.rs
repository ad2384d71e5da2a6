//! Errors of decoding and encoding images.

use thiserror::Error;

/// Reason why an image could not be decoded or encoded.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ImageError {
    /// The file is empty.
    #[error("{name} is empty; check that it was saved or copied completely")]
    Empty {
        /// Name as given by the caller.
        name: String,
    },
    /// A kind of image that is not supported.
    #[error(
        "{name} is {kind}, which Sabi does not read; save it as PNG, JPEG, WebP, TGA, BMP, HDR or OpenEXR and use that file"
    )]
    Unsupported {
        /// Name as given by the caller.
        name: String,
        /// Kind of the image with its article: `a TIFF picture`.
        kind: String,
    },
    /// The pointer of Git LFS in place of a file that was not fetched.
    #[error("{name} is a Git LFS pointer instead of the picture itself; run `git lfs pull` where it came from")]
    Pointer {
        /// Name as given by the caller.
        name: String,
    },
    /// A supported kind of file that contains an unsupported feature.
    #[error("{name} cannot be used: {feature}; save it again as a plain {format} file")]
    Feature {
        /// Name as given by the caller.
        name: String,
        /// `PNG`, `OpenEXR`…
        format: &'static str,
        /// Feature that is not supported.
        feature: String,
    },
    /// The file contradicts itself or ends early.
    #[error("{name} is a damaged {format} file ({detail}); open and save it again in a paint program, or copy it anew")]
    Damaged {
        /// Name as given by the caller.
        name: String,
        /// `PNG`, `OpenEXR`…
        format: &'static str,
        /// Message of the decoder.
        detail: String,
    },
    /// More pixels than are supported.
    #[error(
        "{name} claims {width} × {height} pixels; pictures of up to 16384 × 16384 and 1 GiB decoded are read, so make it smaller"
    )]
    TooLarge {
        /// Name as given by the caller.
        name: String,
        /// Claimed width, pixels.
        width: u64,
        /// Claimed height, pixels.
        height: u64,
    },
    /// A layer that the file does not have.
    #[error("{name} has no layer '{asked}'; {}", layers_there(.layers))]
    Layer {
        /// Name as given by the caller.
        name: String,
        /// Layer that was requested.
        asked: String,
        /// Layers of the file.
        layers: Vec<String>,
    },
    /// The numbers given to an encoder do not form the requested image.
    #[error("cannot encode a {width} × {height} picture: {reason}")]
    Encode {
        /// Requested width, pixels.
        width: u32,
        /// Requested height, pixels.
        height: u32,
        /// Contradiction between size and samples.
        reason: String,
    },
}

/// Maximum number of layers that a message lists.
const NAMED_LAYERS: usize = 12;

/// Formats names of layers as a list in a sentence. Of many names only the first are listed.
pub fn listed_layers(layers: &[String]) -> String {
    let named = layers.iter().take(NAMED_LAYERS).map(String::as_str).collect::<Vec<_>>();
    let named = named.join(", ");
    match layers.len().saturating_sub(NAMED_LAYERS) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

/// Formats the layers of a file as a clause.
fn layers_there(layers: &[String]) -> String {
    match layers.is_empty() {
        true => "only OpenEXR files have layers, so leave the name empty".to_owned(),
        false => format!("it has {}", listed_layers(layers)),
    }
}

/// Returns the error for a damaged file, with the message of its decoder.
pub(crate) fn damaged(name: &str, format: &'static str, detail: impl ToString) -> ImageError {
    let mut detail = detail.to_string().trim_end_matches('.').to_owned();
    // The PNG decoder prints a chunk as a Rust value. Only the name is kept.
    const BEFORE_NAME: &str = "ChunkType { type: ";
    while let Some(start) = detail.find(BEFORE_NAME) {
        let Some(length) = detail[start..].find('}') else { break };
        let chunk = detail[start + BEFORE_NAME.len()..].split(',').next().map(str::to_owned);
        let Some(chunk) = chunk else { break };
        detail.replace_range(start..=start + length, &chunk);
    }
    ImageError::Damaged {
        name: name.into(),
        format,
        detail,
    }
}
