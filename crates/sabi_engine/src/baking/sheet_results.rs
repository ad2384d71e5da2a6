//! Assignment of results to the texels of a sheet that materials share. Each texel is read from the result that serves its material.

use std::collections::BTreeMap;

use sabi_gpu::PlaneData;
use sabi_plan::PlannedResult;
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT};

/// Results of a texture set, and the texels that each serves.
pub(crate) struct SheetResults<'p> {
    /// Distinct results, in the order of the first material that each serves.
    pub(crate) distinct: Vec<&'p PlannedResult>,
    /// Index into the results for each texel of the atlas; empty for a single result.
    of_texel: Vec<u16>,
}

impl<'p> SheetResults<'p> {
    /// Assigns the results that serve the materials of a set. Ghosts use the result of their chart.
    pub(crate) fn new(atlas: &Atlas, result_of_material: &BTreeMap<u32, &'p PlannedResult>) -> SheetResults<'p> {
        let mut results: Vec<&PlannedResult> = Vec::new();
        let mut of_material: BTreeMap<u32, u16> = BTreeMap::new();
        for (&material, &result) in result_of_material {
            let known = results.iter().position(|other| std::ptr::eq(*other, result));
            let at = known.unwrap_or_else(|| {
                results.push(result);
                results.len() - 1
            });
            of_material.insert(material, at as u16);
        }
        let mut of_texel = Vec::new();
        if results.len() > 1 {
            let of_chart = atlas.charts.iter().map(|chart| of_material.get(&chart.material));
            // Charts of other sets and empty texels are not read, so any index may be used.
            let of_chart: Vec<u16> = of_chart.map(|at| at.copied().unwrap_or(0)).collect();
            let of_owner = |owner: &u32| chart_of(atlas, *owner).and_then(|chart| of_chart.get(chart as usize));
            let of_owners = atlas.owners.iter().map(of_owner);
            of_texel = of_owners.map(|at| at.copied().unwrap_or(0)).collect(); // Empty texels are not read.
        }
        SheetResults {
            distinct: results,
            of_texel,
        }
    }

    /// Reads a texel from planes, one for each result; `None` if its result does not have the plane. A single plane serves all texels.
    pub(crate) fn texel(&self, planes: &[Option<PlaneData>], texel: usize) -> Option<[f32; 4]> {
        let at = match planes {
            [_] => 0,
            // The list is empty if one result serves all texels.
            _ => usize::from(self.of_texel.get(texel).copied().unwrap_or(0)),
        };
        Some(planes.get(at)?.as_ref()?.texel(texel))
    }
}

/// Returns the chart of an entry of [`Atlas::owners`].
fn chart_of(atlas: &Atlas, owner: u32) -> Option<u32> {
    match owner {
        EMPTY => None,
        ghost if ghost & GHOST_BIT != 0 => Some(atlas.ghosts.get((ghost & !GHOST_BIT) as usize)?.chart),
        triangle => atlas.triangle_chart.get(triangle as usize).copied(),
    }
}
