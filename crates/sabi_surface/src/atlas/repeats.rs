//! Finds UVs that repeat so often that a map shows little of the surface they cover. This is done before charts are cut.

use std::collections::{BTreeMap, BTreeSet};

use super::Udim;
use super::build::orientations;
use super::charts::{partition, sheet_of};
use super::fixed_point_uvs::Uvs;
use super::topology::Topology;
use super::udim::udim_sheets;
use crate::model::Mesh;

/// Number of overlapping tiles of UVs from which a map counts as repeating too often: at least seven eighths of the surface
/// would show values that belong elsewhere, and would need as many times the texels of the map.
const TOO_OFTEN: f64 = 8.0;
/// Minimum extent, in tiles, of the UVs of a sheet that counts as repeating. UVs within one tile are stacked instead.
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
struct UvExtent {
    area: f64,
    low: [f32; 2],
    high: [f32; 2],
}

/// Finds the materials whose UVs repeat so often that their maps show little of the surface. UDIM layouts do not count, nor do charts that
/// are stacked within one tile. The cost depends only on the number of triangles, not on the area that their UVs cover.
pub fn repeats(mesh: &Mesh, udim: Udim) -> Vec<Repeats> {
    // A faulty mesh is reported when its atlas is built.
    let Ok(uvs) = Uvs::check(mesh, 1) else {
        return Vec::new();
    };
    if mesh.is_one_sheet {
        return Vec::new();
    }
    let mut extents: BTreeMap<u32, UvExtent> = BTreeMap::new();
    for (triangle, material) in mesh.triangle_material.iter().enumerate() {
        let extent = extents.entry(*material).or_insert(UvExtent {
            area: 0.0,
            low: [f32::INFINITY; 2],
            high: [f32::NEG_INFINITY; 2],
        });
        extent.area += mesh.uv_area(triangle as u32);
        for vertex in mesh.triangles[triangle] {
            let at = mesh.uvs[vertex as usize];
            // `min` and `max` ignore NaN.
            extent.low = [0, 1].map(|axis| extent.low[axis].min(at[axis]));
            extent.high = [0, 1].map(|axis| extent.high[axis].max(at[axis]));
        }
    }
    let reaches_out = |extent: &UvExtent| (0..2).any(|axis| extent.high[axis] - extent.low[axis] > LEAST_EXTENT);
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

/// Returns the sheets whose tiles have separate maps.
fn udims(mesh: &Mesh, uvs: &Uvs<'_>, udim: Udim) -> BTreeSet<u32> {
    let charts = partition(mesh, &Topology::new(mesh), &orientations(uvs, mesh));
    let all = || {
        (0..charts.len())
            .map(|chart| sheet_of(mesh, charts.triangles(chart)))
            .collect()
    };
    // A tile without a number is reported by the build, with more detail.
    udim_sheets(mesh, &charts, udim).unwrap_or_else(|_| all())
}
