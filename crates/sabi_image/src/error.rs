//! Errors of decoding and encoding pictures.

use thiserror::Error;

/// Reason why a picture could not be decoded or encoded.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ImageError {
    /// The file holds nothing at all.
    #[error("{name} is empty; check that it was saved or copied completely")]
    Empty {
        /// Name as given by the caller.
        name: String,
    },
    /// A kind of picture that is not read.
    #[error(
        "{name} is {kind}, which Sabi does not read; save it as PNG, JPEG, WebP, TGA, BMP, HDR or OpenEXR and use that file"
    )]
    Unsupported {
        /// Name as given by the caller.
        name: String,
        /// With its article: `a TIFF picture`.
        kind: String,
    },
    /// The right kind of file with something in it that is not read.
    #[error("{name} cannot be used: {feature}; save it again as a plain {format} file")]
    Feature {
        /// Name as given by the caller.
        name: String,
        /// `PNG`, `OpenEXR`…
        format: &'static str,
        /// Feature that is not read.
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
    /// More pixels than are read.
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
        /// Layer that was asked for.
        asked: String,
        /// Layers of the file.
        layers: Vec<String>,
    },
    /// The numbers given to an encoder do not make the picture that was asked for.
    #[error("cannot encode a {width} × {height} picture: {reason}")]
    Encode {
        /// Width asked for, pixels.
        width: u32,
        /// Height asked for, pixels.
        height: u32,
        /// Contradiction between size and samples.
        reason: String,
    },
}

/// Most layers that a sentence names.
const NAMED_LAYERS: usize = 12;

/// Returns names of layers as a list in a sentence, of many only the first.
pub fn listed_layers(layers: &[String]) -> String {
    let named = layers.iter().take(NAMED_LAYERS).map(String::as_str).collect::<Vec<_>>();
    let named = named.join(", ");
    match layers.len().saturating_sub(NAMED_LAYERS) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

/// Layers of a file as half a sentence.
fn layers_there(layers: &[String]) -> String {
    match layers.is_empty() {
        true => "only OpenEXR files have layers, so leave the name empty".to_owned(),
        false => format!("it has {}", listed_layers(layers)),
    }
}

/// The error of a damaged file, with the words of its decoder.
pub(crate) fn damaged(name: &str, format: &'static str, detail: impl ToString) -> ImageError {
    let mut detail = detail.to_string().trim_end_matches('.').to_owned();
    // The PNG decoder prints a chunk as a Rust value; its name is enough.
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
