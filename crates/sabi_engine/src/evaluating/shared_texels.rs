//! Texels of overlapping charts, which show in the viewport what the maps hold.

use std::collections::BTreeSet;

use sabi_export::{SharedTexels, set_keys};
use sabi_surface::atlas::{Atlas, Chart};

use crate::evaluating::texture_space::set_layout;
use crate::opening::linked_model::LinkedModel;

impl LinkedModel {
    /// Finds the texels of all texture sets that show the values of other texels, as the maps do. Nothing is laid out for a model
    /// without overlap.
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

/// Lists the sheets on which charts may overlap, each other or, where a texture repeats, themselves. The atlas report lists a
/// limited number of pairs, so all sheets are returned for a model with any overlap.
fn sharing_sheets(atlas: &Atlas) -> BTreeSet<u32> {
    let overlaps = atlas.report.overlap_texels > 0;
    let repeats = |chart: &&Chart| {
        let [x0, y0, x1, y1] = chart.bounds;
        (x1 - x0).max(y1 - y0) > atlas.size
    };
    let charts = atlas.charts.iter().filter(|chart| overlaps || repeats(chart));
    charts.map(|chart| chart.sheet).collect()
}
