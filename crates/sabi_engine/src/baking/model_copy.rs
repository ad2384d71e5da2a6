//! Copy of the model with the new maps.

use std::collections::BTreeSet;

use sabi_export::{BakeWriter, CopiedFile, CopySource, ModelCopy, SetKey, baked_materials};
use sabi_surface::model::Model;

use crate::baking::bake_request::BakeRequest;
use crate::baking::map_encoder::WrittenMaps;
use crate::baking::report::{CopiedFileReport, ModelCopyReport};
use crate::error::EngineError;
use crate::evaluating::texture_sets::{OutputAssignment, TextureSet};
use crate::opening::linked_model::LinkedModel;
use crate::warning::Warning;

/// Begins the copy if it is requested. Adds its warnings to those of `assignment`.
pub(crate) fn open_copy<'m>(
    request: &'m BakeRequest,
    linked: &'m LinkedModel,
    sets: &[TextureSet],
    assignment: &mut OutputAssignment,
    writer: &mut BakeWriter,
) -> Result<Option<ModelCopy<'m>>, EngineError> {
    let Some(copy_options) = request.model else {
        return Ok(None);
    };
    let model = &linked.model;
    let served = sets
        .iter()
        .zip(&assignment.nodes)
        .filter(|(_, nodes)| !nodes.is_empty());
    let baked: BTreeSet<SetKey> = served.map(|(set, _)| set.key).collect();
    let options = &request.evaluator.model;
    let source = CopySource {
        path: &options.path,
        model,
        uv_set: options.uv,
        unwrapped_uv_set: linked.unwrapped.as_ref().map(|unwrapped| unwrapped.uv_set),
    };
    let copy = ModelCopy::open(source, &baked, copy_options)?;
    // A name that would be refused is reported before the work.
    writer.check(&copy.file_name())?;
    writer.keep_model_maps();
    if copy_options.keeps_look && has_vertex_colors(model, &baked_materials(model, &baked)) {
        assignment.warnings.push(
            "the model has vertex colors, and programs that show its copy multiply base color by them; remove them \
             from the model where they are not meant as paint"
                .into(),
        );
    }
    Ok(Some(copy))
}

/// Returns true if any vertex of a baked material has a color other than white.
fn has_vertex_colors(model: &Model, baked: &BTreeSet<u32>) -> bool {
    let mesh = &model.mesh;
    let triangles = mesh.triangles.iter().zip(&mesh.triangle_material);
    let mut vertices = triangles
        .filter(|(_, material)| baked.contains(*material))
        .flat_map(|(corners, _)| corners);
    !mesh.colors.is_empty() && vertices.any(|vertex| mesh.colors.get(*vertex as usize) != Some(&[1.0; 4]))
}

/// Writes the copy next to the maps under a temporary name, and adds its report entry.
pub(crate) fn write_copy(
    copy: Option<ModelCopy<'_>>,
    writer: &mut BakeWriter,
    written: &mut WrittenMaps,
) -> Result<(), EngineError> {
    let Some(copy) = copy else { return Ok(()) };
    let maps = writer.take_model_maps();
    let finished = copy.finish(maps, &|name| writer.contains(name))?;
    written
        .warnings
        .extend(finished.warnings.into_iter().map(Warning::from));
    let mut stage = |file: &CopiedFile| -> Result<CopiedFileReport, EngineError> {
        writer.extra_file(&file.name, &file.bytes)?;
        Ok(CopiedFileReport {
            path: file.name.clone(),
            blake3: blake3::hash(&file.bytes).to_hex().to_string(),
        })
    };
    let copy = stage(&finished.copy)?;
    let beside: Result<Vec<CopiedFileReport>, EngineError> = finished.beside.iter().map(stage).collect();
    written.copy = Some(ModelCopyReport {
        copy,
        files: beside?,
        changes: finished.changes,
    });
    Ok(())
}
