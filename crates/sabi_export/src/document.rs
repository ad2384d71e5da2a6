//! Documents of materials beside the maps of a preset: MaterialX and USD.
//!
//! While a bake writes the sets, it records facts about them ([`SetFacts`]). At its end, the tiles of a material are combined into one
//! material whose channels are files or values ([`DocumentMaterial`]), and a writer for each format converts these to text.

mod facts;
mod identifiers;
mod material;
mod materialx;
mod numbers;
#[cfg(test)]
mod tests;
mod usd;
mod xml;

pub(crate) use facts::{ChannelFacts, FileFacts, SetFacts};
pub(crate) use material::{DocumentMaterial, PresetFiles, changes_nothing, materials};

use crate::Channel;
use crate::preset::DocumentFormat;
use crate::record::DocumentedMaterial;

/// Returns the text of a document. For USDZ it is the text of its first file.
pub(crate) fn text(document: DocumentFormat, materials: &[DocumentMaterial]) -> String {
    match document {
        DocumentFormat::MaterialX => materialx::text(materials),
        DocumentFormat::Usda | DocumentFormat::Usdz => usd::text(materials),
    }
}

/// Returns the names of the files to which a USD document of the materials refers.
pub(crate) fn usd_files(materials: &[DocumentMaterial]) -> Vec<&str> {
    materials.iter().flat_map(usd::files).collect()
}

/// Returns the channels of a material that vary and that the format supports, but for which the preset has no file that the
/// document can use.
pub(crate) fn lacking(document: DocumentFormat, material: &DocumentMaterial) -> impl Iterator<Item = &Channel> {
    material.missing.iter().filter(move |channel| has(document, channel))
}

/// Returns the entry in the report for a material of a document.
pub(crate) fn documented(document: DocumentFormat, material: &DocumentMaterial) -> DocumentedMaterial {
    let untaken = material.channels.keys().filter(|channel| !has(document, channel));
    let mut left_out: Vec<Channel> = material.missing.iter().chain(untaken).cloned().collect();
    left_out.sort();
    DocumentedMaterial {
        material: material.name.clone(),
        names: match document {
            DocumentFormat::MaterialX => materialx::names(material).into(),
            DocumentFormat::Usda | DocumentFormat::Usdz => vec![usd::path(material)],
        },
        left_out,
    }
}

/// Returns true if materials of the format have the channel.
fn has(document: DocumentFormat, channel: &Channel) -> bool {
    match document {
        DocumentFormat::MaterialX => true,
        DocumentFormat::Usda | DocumentFormat::Usdz => usd::input(channel).is_some(),
    }
}
