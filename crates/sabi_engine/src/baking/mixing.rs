//! Which result each texel of a texture set is read from: on a sheet that materials share, each texel from the one that
//! serves its material.

use std::collections::BTreeMap;

use sabi_gpu::PlaneData;
use sabi_plan::PlannedResult;
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT};

/// The results of a set, and what is whose.
pub(crate) struct Mixing<'p> {
    /// Each once, in the order of the first material that it serves.
    pub(crate) results: Vec<&'p PlannedResult>,
    /// For each texel of the atlas an index into the results; empty where there is but one.
    of_texel: Vec<u16>,
}

impl<'p> Mixing<'p> {
    /// The results that serve the materials of a set. A ring around a chart is read as the chart is.
    pub(crate) fn new(atlas: &Atlas, serving: &BTreeMap<u32, &'p PlannedResult>) -> Mixing<'p> {
        let mut results: Vec<&PlannedResult> = Vec::new();
        let mut of_material: BTreeMap<u32, u16> = BTreeMap::new();
        for (&material, &result) in serving {
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
            // Charts of other sets and empty texels are not read; any index does.
            let of_chart: Vec<u16> = of_chart.map(|at| at.copied().unwrap_or(0)).collect();
            let of_owner = |owner: &u32| chart_of(atlas, *owner).and_then(|chart| of_chart.get(chart as usize));
            let of_owners = atlas.owners.iter().map(of_owner);
            of_texel = of_owners.map(|at| at.copied().unwrap_or(0)).collect(); // Empty texels are not read.
        }
        Mixing { results, of_texel }
    }

    /// A texel out of planes, one for each result; none where its own result does not have the plane. A lone plane is for
    /// all texels.
    pub(crate) fn texel(&self, planes: &[Option<PlaneData>], texel: usize) -> Option<[f32; 4]> {
        let at = match planes {
            [_] => 0,
            // The list is empty where one result serves all texels.
            _ => usize::from(self.of_texel.get(texel).copied().unwrap_or(0)),
        };
        Some(planes.get(at)?.as_ref()?.texel(texel))
    }
}

/// The chart of an entry of [`Atlas::owners`].
fn chart_of(atlas: &Atlas, owner: u32) -> Option<u32> {
    match owner {
        EMPTY => None,
        ghost if ghost & GHOST_BIT != 0 => Some(atlas.ghosts.get((ghost & !GHOST_BIT) as usize)?.chart),
        triangle => atlas.triangle_chart.get(triangle as usize).copied(),
    }
}
