//! Documents of materials next to the maps.

use sabi_export::{BakeWriter, SetOptions, unwrapped_materials};

use crate::baking::bake_request::BakeRequest;
use crate::baking::map_encoder::{WrittenMaps, sort_by_set};
use crate::error::EngineError;
use crate::opening::linked_model::LinkedModel;
use crate::opening::mesh_report::DecodedUvs;
use crate::warning::Warning;

/// Refuses documents that cannot be written in their places, before the work.
pub(crate) fn check_documents(options: &SetOptions, writer: &BakeWriter) -> Result<(), EngineError> {
    let names = options.document_names();
    Ok(names.iter().try_for_each(|name| writer.check(name))?)
}

/// Writes the documents that presets request, and the additional maps that they need, under temporary names. Adds them to
/// the written files.
pub(crate) fn write_documents(
    request: &BakeRequest,
    options: &SetOptions,
    linked: &LinkedModel,
    writer: &mut BakeWriter,
    written: &mut WrittenMaps,
) -> Result<(), EngineError> {
    let unwrapped = unwrapped_materials(&linked.model);
    let uv_set = |material: u32| match &linked.unwrapped {
        Some(new) if unwrapped.contains(&material) => new.uv_set,
        _ => request.evaluator.model.uv,
    };
    let made = writer.documents(options, &uv_set)?;
    written.outputs.extend(made.outputs);
    sort_by_set(written);
    written.documents = made.documents;
    written.warnings.extend(made.warnings.into_iter().map(Warning::from));
    let decoded = DecodedUvs::of(linked);
    if let (Some(document), [first, ..]) = (written.documents.first(), &decoded[..]) {
        written.warnings.push(
            format!(
                "{} lacks the transform under which the model stores the UVs of '{}': apply it to the UVs in a modeling \
                 program, or use the copy of the model, which has it",
                document.path, first.material
            )
            .into(),
        );
    }
    let asks = options.presets.iter().any(|named| !named.preset.documents.is_empty());
    if asks && options.document_stem.is_none() {
        let sentence = "no documents of materials were written: with a part of the channels they would be incomplete; bake \
                        all channels to write them";
        written.warnings.push(sentence.into());
    }
    Ok(())
}
