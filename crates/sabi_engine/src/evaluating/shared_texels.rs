//! Texels of overlapping charts, which show the same values in the viewport as on the maps.

use std::collections::BTreeSet;

use sabi_export::{SharedTexels, ShownTexels, set_keys};
use sabi_surface::atlas::{Atlas, Chart};

use crate::evaluating::texture_space::set_layout;
use crate::opening::linked_model::LinkedModel;

impl LinkedModel {
    /// Finds the texels of all texture sets that show the values of other texels on the maps. Nothing is laid out for a
    /// model without overlap.
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

/// Minimum share of overlapping texels. Below it, finding the shown texels takes more time than it saves.
const LEAST_SHARED: f64 = 0.1;

impl LinkedModel {
    /// Returns the tiles whose own values maps and pictures show, by column, row and page; `None` if these are nearly all tiles.
    pub(crate) fn shown_tiles(&self) -> Option<Vec<[u32; 3]>> {
        let texels =
            |charts: &mut dyn Iterator<Item = &Chart>| -> u64 { charts.map(|chart| u64::from(chart.texels)).sum() };
        let owned = texels(&mut self.atlas.charts.iter());
        let repeating = texels(&mut self.atlas.charts.iter().filter(|chart| repeats(&self.atlas, chart)));
        let shared = self.atlas.report.overlap_texels.max(repeating);
        if (shared as f64) < LEAST_SHARED * owned as f64 {
            return None;
        }
        let sheets = sharing_sheets(&self.atlas);
        let mut shown = ShownTexels::new(&self.atlas);
        for key in set_keys(&self.atlas) {
            if sheets.contains(&key.material) {
                shown.hide(&set_layout(self, key));
            }
        }
        let tiles = shown.tiles();
        (tiles.len() < self.atlas.tiles.len()).then_some(tiles)
    }
}

/// Lists the sheets on which charts may overlap each other or, if a texture repeats, themselves. The atlas report lists a
/// limited number of pairs, so all sheets are returned for a model with any overlap.
fn sharing_sheets(atlas: &Atlas) -> BTreeSet<u32> {
    let overlaps = atlas.report.overlap_texels > 0;
    let charts = atlas.charts.iter().filter(|chart| overlaps || repeats(atlas, chart));
    charts.map(|chart| chart.sheet).collect()
}

/// Returns true if a chart is larger than the maps, so that it overlaps itself where its texture repeats.
fn repeats(atlas: &Atlas, chart: &Chart) -> bool {
    let [x0, y0, x1, y1] = chart.bounds;
    (x1 - x0).max(y1 - y0) > atlas.size
}
