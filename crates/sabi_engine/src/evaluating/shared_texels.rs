//! Texels of overlapping charts, which show in the viewport what the maps hold.

use std::collections::BTreeSet;

use sabi_export::{SharedTexels, ShownTexels, set_keys};
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

/// Share of the texels that must lie on others before those that are shown are told from the rest, which takes time, too.
const LEAST_SHARED: f64 = 0.1;

impl LinkedModel {
    /// Finds the tiles with texels whose own values maps and pictures show, by column, row and page; none where these are nearly
    /// all.
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

/// Lists the sheets on which charts may overlap, each other or, where a texture repeats, themselves. The atlas report lists a
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
