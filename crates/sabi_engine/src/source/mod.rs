//! Node kinds that are not WGSL: one file each.

mod model;
mod output_mask;
mod output_material;
mod sampler;
mod texels;
mod texture_set;

use std::collections::BTreeMap;

use sabi_gpu::SourceFill;
use sabi_nodes::link::Plane;
use sabi_plan::{SourceKind, SourceStep};

pub(crate) use model::kind_for;
pub(crate) use output_mask::{NAME as OUTPUT_MASK, mask_name};
pub(crate) use output_material::{NAME as OUTPUT_MATERIAL, claim};
pub(crate) use texels::Ground;

/// Kinds that give, by id. `source/model` learns its content once a model is loaded.
pub(crate) fn kinds() -> BTreeMap<String, SourceKind> {
    by_id([model::kind()])
}

/// Kinds that take, by id.
pub(crate) fn sinks() -> BTreeMap<String, SourceKind> {
    by_id([output_material::kind(), output_mask::kind()])
}

fn by_id(kinds: impl IntoIterator<Item = SourceKind>) -> BTreeMap<String, SourceKind> {
    kinds.into_iter().map(|kind| (kind.id.clone(), kind)).collect()
}

/// Fills the results of all kinds that give.
pub(crate) struct Sources<'a> {
    ground: Ground<'a>,
    model: model::ModelSource<'a>,
    /// What cannot be shown, as sentences.
    pub(crate) warnings: Vec<String>,
}

impl<'a> Sources<'a> {
    /// Sources that have not opened anything yet.
    pub(crate) fn new(ground: Ground<'a>) -> Sources<'a> {
        Sources {
            ground,
            model: model::ModelSource::default(),
            warnings: Vec::new(),
        }
    }
}

impl SourceFill for Sources<'_> {
    fn plane(&mut self, step: &SourceStep, output: &str, plane: Plane) -> Result<Vec<u8>, String> {
        match step.kind.as_str() {
            model::NAME => Ok(self.model.plane(&self.ground, output, plane, &mut self.warnings)),
            other => Err(format!(
                "node '{}' is of kind '{other}', which nobody fills; this is a mistake in Sabi",
                step.id
            )),
        }
    }
}
