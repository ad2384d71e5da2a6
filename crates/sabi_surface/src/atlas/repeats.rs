//! UVs that repeat so often that a map shows little of what they cover: found before charts are cut.

use std::collections::{BTreeMap, BTreeSet};

use super::Udim;
use super::build::orientations;
use super::charts::{partition, sheet_of};
use super::fixed::Uvs;
use super::topology::Topology;
use super::udim::udim_sheets;
use crate::model::Mesh;

/// Least number of tiles of UVs on one map at which it repeats too often: seven eighths of the surface and more show what belongs
/// elsewhere, and take as many times the texels of the map.
const TOO_OFTEN: f64 = 8.0;
/// Least side of the UVs of a sheet that repeats, in tiles; those within one are stacked.
const LEAST_EXTENT: f32 = 1.25;

/// Material with UVs that repeat too often.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeats {
    /// An index into the model's materials.
    pub material: u32,
    /// Area of its surface in UV, in areas of a map.
    pub times: f64,
}

/// Area and box of the UVs of a sheet.
struct Extent {
    area: f64,
    low: [f32; 2],
    high: [f32; 2],
}

/// Finds the materials whose UVs repeat so often that their maps show little of them. Those of UDIM layouts are none, nor are charts
/// that are stacked within one tile. The cost grows with the triangles alone, not with what their UVs cover.
pub fn repeats(mesh: &Mesh, udim: Udim) -> Vec<Repeats> {
    // What is wrong with a mesh is said when its atlas is built.
    let Ok(uvs) = Uvs::check(mesh, 1) else {
        return Vec::new();
    };
    if mesh.is_one_sheet {
        return Vec::new();
    }
    let mut extents: BTreeMap<u32, Extent> = BTreeMap::new();
    for (triangle, material) in mesh.triangle_material.iter().enumerate() {
        let extent = extents.entry(*material).or_insert(Extent {
            area: 0.0,
            low: [f32::INFINITY; 2],
            high: [f32::NEG_INFINITY; 2],
        });
        extent.area += mesh.uv_area(triangle as u32);
        for vertex in mesh.triangles[triangle] {
            let at = mesh.uvs[vertex as usize];
            // Minima and maxima ignore what is not a number.
            extent.low = [0, 1].map(|axis| extent.low[axis].min(at[axis]));
            extent.high = [0, 1].map(|axis| extent.high[axis].max(at[axis]));
        }
    }
    let reaches_out = |extent: &Extent| (0..2).any(|axis| extent.high[axis] - extent.low[axis] > LEAST_EXTENT);
    extents.retain(|_, extent| extent.area > TOO_OFTEN && reaches_out(extent));
    if extents.is_empty() {
        return Vec::new();
    }
    let udims = udims(mesh, &uvs, udim);
    let found = extents.iter().filter(|(material, _)| !udims.contains(material));
    found
        .map(|(&material, extent)| Repeats {
            material,
            times: extent.area,
        })
        .collect()
}

/// Returns the sheets of which each tile has maps of its own.
fn udims(mesh: &Mesh, uvs: &Uvs<'_>, udim: Udim) -> BTreeSet<u32> {
    let charts = partition(mesh, &Topology::new(mesh), &orientations(uvs, mesh));
    let all = || {
        (0..charts.len())
            .map(|chart| sheet_of(mesh, charts.triangles(chart)))
            .collect()
    };
    // A tile without a number is an error of the build, which says more.
    udim_sheets(mesh, &charts, udim).unwrap_or_else(|_| all())
}
