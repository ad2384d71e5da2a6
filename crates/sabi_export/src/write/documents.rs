//! Writing of documents of materials beside the maps that they name.

use super::BakeWriter;
use super::options::{NamedPreset, SetOptions};
use crate::document::{self, DocumentMaterial, PresetFiles};
use crate::preset::DocumentFormat;
use crate::{Channel, DocumentRecord, ExportError, OutputRecord};

/// Alignment of the files in a package, as the specification of USDZ has it.
const PACKAGE_ALIGNMENT: u16 = 64;

/// Result of writing documents.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WrittenDocuments {
    /// Maps of UDIM tiles that were written for them.
    pub outputs: Vec<OutputRecord>,
    /// The documents.
    pub documents: Vec<DocumentRecord>,
    /// Sentences about what they lack.
    pub warnings: Vec<String>,
}

impl BakeWriter {
    /// Writes the documents that the presets ask for, once all sets are finished: materials of the sets that were written.
    /// `uv_set` gives that of the maps of a material.
    pub fn documents(
        &mut self,
        options: &SetOptions,
        uv_set: &dyn Fn(u32) -> u32,
    ) -> Result<WrittenDocuments, ExportError> {
        if options.document_stem.is_none() {
            return Ok(WrittenDocuments::default());
        }
        let mut written = WrittenDocuments {
            outputs: self.fill_tiles(options)?,
            ..WrittenDocuments::default()
        };
        for (index, NamedPreset { preset, names }) in options.presets.iter().enumerate() {
            for document in &preset.documents {
                let files = PresetFiles {
                    index,
                    preset,
                    names,
                    takes: &|format| document.takes(format),
                    uv_set,
                };
                let materials = document::materials(&self.facts, files);
                let path = options.document_name(*document).filter(|_| !materials.is_empty());
                let Some(path) = path else { continue };
                let text = document::text(*document, &materials);
                if !self.stage_document(*document, &path, &text, &materials)? {
                    let why = "it would have 4 GiB or more, which programs do not read; choose smaller maps";
                    written.warnings.push(format!("{path} was not written: {why}"));
                    continue;
                }
                let lacks = materials
                    .iter()
                    .filter_map(|material| lack(*document, &path, &preset.name, material));
                // The text beside a package lacks less.
                written
                    .warnings
                    .extend(lacks.filter(|_| *document != DocumentFormat::Usdz));
                written.documents.push(DocumentRecord {
                    blake3: self.hash(&path)?,
                    path,
                    preset: preset.name.clone(),
                    format: *document,
                    materials: materials
                        .iter()
                        .map(|material| document::documented(*document, material))
                        .collect(),
                });
            }
        }
        Ok(written)
    }

    /// Stages a document; returns false if it is too large for its format.
    fn stage_document(
        &mut self,
        document: DocumentFormat,
        path: &str,
        text: &str,
        materials: &[DocumentMaterial],
    ) -> Result<bool, ExportError> {
        if document != DocumentFormat::Usdz {
            self.staged.stage(path, text.as_bytes())?;
            return Ok(true);
        }
        let members = document::usd_files(materials);
        let first = format!("{}.{}", path.trim_end_matches(".usdz"), DocumentFormat::Usda.ending());
        Ok(self
            .staged
            .stage_package(path, &first, text.as_bytes(), &members, PACKAGE_ALIGNMENT)?)
    }

    /// BLAKE3 of a staged file.
    fn hash(&self, path: &str) -> Result<String, ExportError> {
        let mut hasher = blake3::Hasher::new();
        self.staged.copy_staged(path, &mut hasher)?;
        Ok(hasher.finalize().to_hex().to_string())
    }
}

/// A sentence on the channels that vary and that no file of the preset gives to a document.
fn lack(document: DocumentFormat, path: &str, preset: &str, material: &DocumentMaterial) -> Option<String> {
    let missing: Vec<_> = document::lacking(document, material).map(Channel::name).collect();
    (!missing.is_empty()).then(|| {
        format!(
            "{path} has no {} of '{}': the preset {preset} has no map that a document can read it from",
            missing.join(", "),
            material.name
        )
    })
}
