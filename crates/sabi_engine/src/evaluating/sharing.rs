//! The viewport shows what is exported, where charts share a place on the maps.

use std::collections::BTreeSet;

use sabi_export::{SharedTexels, set_keys};
use sabi_gpu::Shares;
use sabi_surface::atlas::{Atlas, Chart};

use crate::baking::maps::set_layout;
use crate::error::EngineError;
use crate::evaluating::evaluator::Evaluator;
use crate::opening::linked_model::LinkedModel;

impl Evaluator {
    /// Which texels show what other texels hold, since an engine would find that on the maps: found when first asked for. None
    /// for a model whose charts all have places of their own.
    ///
    /// Sources and targets are texels of one result. Only an unwrapped model has a sheet with charts that other results serve,
    /// and there charts have places of their own, unless they are too small for the size: a texel that lost its place to
    /// another material's chart shows its own material there, and not that one.
    pub(crate) fn shares(&self) -> Result<Option<&Shares>, EngineError> {
        if self.shares.get().is_none() {
            let shared = self.linked.shared_texels();
            let shares = match shared.is_empty() {
                true => None,
                false => Some(Shares::upload(&self.gpu, shared.groups())?),
            };
            // Whoever else was here meanwhile found the same.
            let _ = self.shares.set(shares);
        }
        Ok(self.shares.get().and_then(Option::as_ref))
    }
}

impl LinkedModel {
    /// Texels of all texture sets that show what other texels hold, as the maps do. For a model without overlap nothing is
    /// laid out.
    pub fn shared_texels(&self) -> SharedTexels {
        let sheets = sharing_sheets(&self.atlas);
        let mut shared = SharedTexels::default();
        if !sheets.is_empty() {
            let keys = set_keys(&self.atlas).into_iter();
            for key in keys.filter(|key| sheets.contains(&key.material)) {
                shared.add(&self.atlas, &set_layout(self, key));
            }
        }
        shared
    }
}

/// Sheets on which charts may share a place, with another one or, where a texture repeats, with themselves. The atlas does not
/// list all pairs of a crowded model, so that one that overlaps anywhere is looked at everywhere.
fn sharing_sheets(atlas: &Atlas) -> BTreeSet<u32> {
    let overlaps = atlas.report.overlap_texels > 0;
    let repeats = |chart: &&Chart| {
        let [x0, y0, x1, y1] = chart.bounds;
        (x1 - x0).max(y1 - y0) > atlas.size
    };
    let charts = atlas.charts.iter().filter(|chart| overlaps || repeats(chart));
    charts.map(|chart| chart.sheet).collect()
}
