//! Node kinds that are not WGSL: one file each.

mod model;
mod output_mask;
mod output_material;
mod sampler;

use std::collections::BTreeMap;

use sabi_plan::SourceKind;

pub(crate) use model::{ModelSource, kind_for};
pub(crate) use output_mask::{NAME as OUTPUT_MASK, mask_name};
pub(crate) use output_material::{NAME as OUTPUT_MATERIAL, claim};

/// Kinds that give, by id. `source/model` learns its content once a model is loaded.
pub(crate) fn kinds() -> BTreeMap<String, SourceKind> {
    [model::kind()]
        .into_iter()
        .map(|kind| (kind.id.clone(), kind))
        .collect()
}

/// Kinds that take, by id.
pub(crate) fn sinks() -> BTreeMap<String, SourceKind> {
    let sinks = [output_material::kind(), output_mask::kind()];
    sinks.into_iter().map(|kind| (kind.id.clone(), kind)).collect()
}
