//! Share of the maps that the UVs of a model cover.

use std::collections::BTreeMap;

use sabi_export::{set_keys, set_names};

use crate::opening::linked_model::LinkedModel;
use crate::remedy::Remedy;
use crate::warning::Warning;

/// Share of its maps below which a layout is probably a mistake: UVs in another scale, or of a part of a larger sheet.
const LEAST_COVERED: f64 = 0.05;

/// Least share of the texels per area of the densest other sheet with which a sheet has enough of them, however little it covers.
const LEAST_DENSE: f64 = 0.25;

/// Texels of a sheet, and the area of the model that has them.
#[derive(Clone, Copy, Default)]
struct SheetCoverage {
    covered: u64,
    maps: u64,
    /// Square model units.
    area: f64,
}

impl SheetCoverage {
    fn share(&self) -> f64 {
        self.covered as f64 / self.maps.max(1) as f64
    }

    /// Texels for each square model unit.
    fn density(&self) -> f64 {
        self.covered as f64 / self.area
    }
}

/// Warns about each sheet that covers little of its maps, unless its texel density is about that of the sheets that
/// cover much: then it belongs to a small part of the model. Sheets that cover nothing are reported by the bake.
pub(crate) fn warnings(linked: &LinkedModel) -> Vec<Warning> {
    let atlas = &linked.atlas;
    let mut sheets: BTreeMap<u32, SheetCoverage> = BTreeMap::new();
    for key in set_keys(atlas) {
        sheets.entry(key.material).or_default().maps += u64::from(atlas.size).pow(2);
    }
    for chart in &atlas.charts {
        sheets.entry(chart.sheet).or_default().covered += u64::from(chart.texels);
    }
    let mesh = &linked.model.mesh;
    for (triangle, chart) in (0..).zip(&atlas.triangle_chart) {
        let [a, b, c] = mesh.corners(triangle);
        let sheet = atlas.charts.get(*chart as usize).map_or(0, |chart| chart.sheet);
        sheets.entry(sheet).or_default().area += (b - a).cross(c - a).length() / 2.0;
    }
    let names = set_names(&linked.model);
    let full = sheets.values().filter(|sheet| sheet.share() >= LEAST_COVERED);
    let densest = full.map(SheetCoverage::density).fold(0.0, f64::max);
    let is_as_dense = |sheet: &SheetCoverage| densest > 0.0 && sheet.density() >= LEAST_DENSE * densest;
    let sparse = sheets
        .iter()
        .filter(|(_, sheet)| sheet.covered > 0 && sheet.share() < LEAST_COVERED && !is_as_dense(sheet));
    let warning = |(&material, sheet): (&u32, &SheetCoverage)| {
        let name = match linked.model.mesh.is_one_sheet {
            true => linked.model.stem.as_str(),
            // Each sheet has a material.
            false => names.get(material as usize).map_or("", String::as_str),
        };
        let sentence = format!(
            "the UVs of '{name}' cover {} of its maps, so that few texels show anything",
            percent(sheet.share())
        );
        let remedies: &[Remedy] = match linked.unwrapped {
            Some(_) => &[],
            None => &[Remedy::UnwrapModel, Remedy::EditUvs],
        };
        Warning::new(sentence, remedies.iter().copied())
    };
    sparse.map(warning).collect()
}

/// Returns a small share in percent, with one significant digit.
fn percent(share: f64) -> String {
    let percent = share * 100.0;
    match percent {
        0.95.. => format!("{percent:.0} %"),
        0.095.. => format!("{percent:.1} %"),
        0.0095.. => format!("{percent:.2} %"),
        _ => "less than 0.01 %".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn a_share_is_shown_with_one_significant_digit() {
        assert_eq!(
            [0.0431, 0.0092, 0.00052, 0.00003].map(percent),
            ["4 %", "0.9 %", "0.05 %", "less than 0.01 %"]
        );
    }
}
