//! Building of an atlas: the steps in order.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use sabi_cancel::look;

use super::build_inputs::{BuildInputs, ChartSet, UvOrigin};
use super::chart_placement::{ChartPlacement, TEXELS_LIMIT, place, too_many_texels};
use super::charts::{Partition, partition, sheet_of};
use super::division::Division;
use super::fixed_point_uvs::{UNIT, Uvs};
use super::links::{LinkedGhosts, PlacedOwners, link};
use super::mask::Mask;
use super::overlap::overlap;
use super::report::ReportInputs;
use super::ring::Occupancy;
use super::topology::Topology;
use super::udim::udim_sheets;
use super::walk::WalkMesh;
use super::{Atlas, AtlasError, AtlasOptions, Chart, GHOST_BIT, Ghost, TILE, leap, owners};
use crate::model::Mesh;

impl Atlas {
    /// Builds the linked atlas of a mesh. The same mesh and options give the same bytes on every machine and with any number of threads.
    pub fn build(mesh: &Mesh, options: &AtlasOptions) -> Result<Atlas, AtlasError> {
        let AtlasOptions {
            size,
            page_limit,
            udim,
            memory_bytes,
        } = *options;
        if !(16..=16384).contains(&size) {
            return Err(AtlasError::SizeOutOfRange { size });
        }
        if !(32..=16384).contains(&page_limit) || !page_limit.is_multiple_of(TILE) {
            return Err(AtlasError::PageLimitOutOfRange { limit: page_limit });
        }
        let uvs = Uvs::check(mesh, size)?;
        let topology = Topology::new(mesh);
        let orientations = orientations(&uvs, mesh);
        let plan = BuildInputs {
            mesh,
            topology: &topology,
            uvs,
            orientations: &orientations,
            size,
            page_limit,
            memory_bytes,
        };
        let mut partition = partition(mesh, &topology, &orientations);
        let udims = udim_sheets(mesh, &partition, udim)?;
        plan.check_area(&partition)?;
        let mut masks = plan.masks(&partition)?;
        if let Some(split) = plan.split(&partition, &masks) {
            masks = plan.masks(&split)?;
            partition = split;
        }
        let origin = |chart: usize| UvOrigin {
            uv_chart: chart as u32,
            uv_tile: plan.uv_tile(partition.triangles(chart)),
        };
        let whole = ChartSet {
            origins: (0..partition.len()).map(origin).collect(),
            masks: masks.into_iter().map(|(mask, _)| mask).collect(),
            partition,
        };
        match plan.divide_at_narrow_gaps(&whole) {
            Division::NotNeeded => plan.assemble(&whole, &whole, udims),
            Division::TooLarge => plan.assemble_with_gaps(&whole, udims),
            Division::Divided(parts) => match plan.assemble(&parts, &whole, udims.clone()) {
                Err(AtlasError::TooManyTexels { .. }) => plan.assemble_with_gaps(&whole, udims),
                made => made,
            },
        }
    }

    /// Builds the atlas of the same charts at another size. Its report treats each of them as a chart in UV.
    pub(crate) fn rebuild(&self, mesh: &Mesh, size: u32, page_limit: u32) -> Result<Atlas, AtlasError> {
        let (triangles, expected) = (mesh.triangles.len(), self.triangle_chart.len());
        if triangles != expected {
            return Err(AtlasError::WrongMesh { triangles, expected });
        }
        let uvs = Uvs::check(mesh, size)?;
        let topology = Topology::new(mesh);
        let orientations = orientations(&uvs, mesh);
        let plan = BuildInputs {
            mesh,
            topology: &topology,
            uvs,
            orientations: &orientations,
            size,
            page_limit,
            // A coarser atlas takes only a fraction of the memory of the first one.
            memory_bytes: u64::MAX,
        };
        let partition = Partition::numbered(self.triangle_chart.clone(), self.charts.len());
        let origin = |chart: &Chart| UvOrigin {
            uv_chart: chart.uv_chart,
            uv_tile: chart.uv_tile,
        };
        let charts = ChartSet {
            origins: self.charts.iter().map(origin).collect(),
            masks: plan.masks(&partition)?.into_iter().map(|(mask, _)| mask).collect(),
            partition,
        };
        plan.assemble(&charts, &charts, self.udim_sheets.clone())
    }
}

/// Returns the winding of each triangle in UV.
pub(super) fn orientations(uvs: &Uvs, mesh: &Mesh) -> Vec<i8> {
    (0..mesh.triangles.len() as u32)
        .into_par_iter()
        .map(|triangle| uvs.orientation(triangle))
        .collect()
}

/// Memory for each texel of a page: its owner, its leap, and temporary data, here and on coarser levels.
const TEXEL_BYTES: u64 = 8;
/// Maximum number of copies of a ghost that exist at the same time: as found, sorted by texel, and on coarser levels.
const GHOST_COPIES: u64 = 3;

/// Estimates the memory of an atlas whose charts are placed, bytes.
fn placed_bytes(masks: &[Mask], placement: &ChartPlacement) -> u64 {
    let [width, height] = placement.page_size.map(u64::from);
    let texels = width * height * u64::from(placement.pages);
    let ghosts: u64 = masks
        .par_iter()
        .map(|mask| mask.grown().count().saturating_sub(mask.count()))
        .sum();
    texels * TEXEL_BYTES + ghosts * GHOST_COPIES * size_of::<Ghost>() as u64
}

/// Warning for a model whose charts are not divided because their parts would need more texels than an atlas can have.
const GAPS_WARNING: &str = "Parts of UV charts lie so close to each other that filters flow from one to the other; placing them apart would \
    take too many texels. More space between them helps.";

impl BuildInputs<'_> {
    /// Refuses charts that would need more texels than an atlas can have, before any texel is rasterized.
    fn check_area(&self, partition: &Partition) -> Result<(), AtlasError> {
        let triangles = 0..self.mesh.triangles.len() as u32;
        let tiles: f64 = triangles.map(|triangle| self.mesh.uv_area(triangle)).sum();
        let texels = tiles * f64::from(self.size).powi(2);
        if texels > TEXELS_LIMIT as f64 {
            return Err(too_many_texels(self.size, partition.len(), texels as u64));
        }
        Ok(())
    }

    /// Builds the atlas of undivided charts with narrow gaps, since their parts would need too many texels.
    fn assemble_with_gaps(&self, whole: &ChartSet, udims: BTreeSet<u32>) -> Result<Atlas, AtlasError> {
        let mut atlas = self.assemble(whole, whole, udims)?;
        atlas.report.warnings.push(GAPS_WARNING.into());
        Ok(atlas)
    }

    /// Builds the atlas of charts that are placed. These may be parts of the charts in UV, which are described in the report.
    fn assemble(&self, placed: &ChartSet, in_uv: &ChartSet, udims: BTreeSet<u32>) -> Result<Atlas, AtlasError> {
        let ChartSet { partition, masks, .. } = placed;
        if masks.iter().all(Mask::is_empty) {
            return Err(AtlasError::NoArea { size: self.size });
        }
        let placement = place(masks, self.size, self.page_limit)?;
        self.check_memory(masks.len(), placed_bytes(masks, &placement))?;
        look();
        let mut owners = owners::texel_owners(&self.uvs, partition, &placement);
        let leap = leap::leap(self.mesh, &self.uvs, partition, &owners, placement.page_size);
        look();
        let occupancy = Occupancy::new(&owners, placement.page_size);
        let sound = self.sound_triangles();
        let links = self.links(partition, masks, &placement, &owners, &occupancy, &sound);
        let [width, height] = placement.page_size.map(|side| side as usize);
        for (index, ghost) in links.ghosts.iter().enumerate() {
            let [x, y, page] = ghost.texel.map(|value| value as usize);
            owners[(page * height + y) * width + x] = GHOST_BIT | index as u32;
        }
        look();
        let charts = self.charts(placed, &placement);
        let inputs = ReportInputs {
            mesh: self.mesh,
            topology: self.topology,
            uvs: self.uvs,
            in_uv,
            orientations: self.orientations,
            sound: &sound,
            charts: &charts,
            placement: &placement,
            udims: &udims,
            size: self.size,
        };
        let overlap = overlap(self.mesh, &self.uvs, in_uv, &udims, self.size);
        let LinkedGhosts {
            ghosts,
            unlinked,
            pulled,
        } = links;
        let report = inputs.report(overlap, unlinked, pulled);
        Ok(Atlas {
            size: self.size,
            page_size: placement.page_size,
            pages: placement.pages,
            triangle_chart: partition.triangle_chart.clone(),
            triangle_texels: self.triangle_texels(partition, &placement),
            tiles: occupancy.tiles(),
            udim_sheets: udims,
            owners,
            charts,
            ghosts,
            leap,
            report,
        })
    }

    /// Refuses an atlas that needs too much memory. `charts` is the number of charts, for the message.
    pub(super) fn check_memory(&self, charts: usize, needed: u64) -> Result<(), AtlasError> {
        if needed <= self.memory_bytes {
            return Ok(());
        }
        Err(AtlasError::Memory {
            size: self.size,
            charts,
            needed_mib: needed.div_ceil(1 << 20),
            limit_mib: self.memory_bytes >> 20,
        })
    }

    /// Links the ghosts around all charts.
    fn links(
        &self,
        partition: &Partition,
        masks: &[Mask],
        placement: &ChartPlacement,
        owners: &[u32],
        occupancy: &Occupancy,
        sound: &[bool],
    ) -> LinkedGhosts {
        let usable: Vec<bool> = (0..sound.len())
            .map(|triangle| {
                let chart = partition.triangle_chart[triangle] as usize;
                sound[triangle] && self.orientations[triangle] != 0 && !masks[chart].is_empty()
            })
            .collect();
        let anchored = occupancy.anchored(owners, |triangle| usable[triangle as usize]);
        let walker = WalkMesh {
            mesh: self.mesh,
            topology: self.topology,
            uvs: self.uvs,
            usable: &usable,
        };
        link(
            &walker,
            &PlacedOwners {
                owners,
                partition,
                placement,
            },
            &anchored,
        )
    }

    /// Returns for each triangle whether it has an area in space that exceeds the rounding error of its corners.
    fn sound_triangles(&self) -> Vec<bool> {
        self.mesh
            .triangles
            .par_iter()
            .map(|triangle| {
                let position = |vertex: u32| DVec3::from(self.mesh.positions[vertex as usize].map(f64::from));
                let [a, b, c] = triangle.map(position);
                let reach = a.abs().max(b.abs()).max(c.abs()).max_element();
                let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
                let area2 = (b - a).cross(c - a).length();
                // Also false for NaN.
                area2 > longest * reach * f64::from(f32::EPSILON)
            })
            .collect()
    }

    fn triangle_texels(&self, partition: &Partition, placement: &ChartPlacement) -> Vec<[[f32; 2]; 3]> {
        partition
            .triangle_chart
            .par_iter()
            .enumerate()
            .map(|(triangle, &chart)| {
                let offset = DVec2::from(placement.charts[chart as usize].offset.map(f64::from));
                let corners = self.uvs.corners(triangle as u32);
                corners.map(|corner| (corner + offset).as_vec2().to_array())
            })
            .collect()
    }

    fn charts(&self, placed: &ChartSet, placement: &ChartPlacement) -> Vec<Chart> {
        let ChartSet {
            partition,
            masks,
            origins,
        } = placed;
        (0..partition.len())
            .into_par_iter()
            .map(|chart| {
                let (triangles, mask, place) = (partition.triangles(chart), &masks[chart], placement.charts[chart]);
                let corner = [0, 1].map(|axis| mask.origin[axis] + i64::from(place.offset[axis]));
                let bounds = if mask.is_empty() {
                    [0; 4]
                } else {
                    [
                        corner[0],
                        corner[1],
                        corner[0] + i64::from(mask.width),
                        corner[1] + i64::from(mask.height),
                    ]
                };
                let turned: f64 = triangles
                    .iter()
                    .map(|&triangle| {
                        let [a, b, c] = self.uvs.corners(triangle);
                        (b - a).perp_dot(c - a)
                    })
                    .sum();
                Chart {
                    uv_chart: origins[chart].uv_chart,
                    page: place.page,
                    texel_from_uv: place.offset,
                    bounds: bounds.map(|value| value as u32),
                    material: self.mesh.triangle_material[triangles[0] as usize],
                    sheet: sheet_of(self.mesh, triangles),
                    uv_tile: origins[chart].uv_tile,
                    // Counter-clockwise in the image means a negative area, since v grows downward.
                    mirrored: turned > 0.0,
                    triangles: triangles.len() as u32,
                    texels: mask.count() as u32,
                }
            })
            .collect()
    }

    /// Returns the UV tile that contains the middle of a chart's bounding rectangle.
    fn uv_tile(&self, triangles: &[u32]) -> [i32; 2] {
        let (mut low, mut high) = ([i64::MAX; 2], [i64::MIN; 2]);
        for corner in triangles.iter().flat_map(|&triangle| self.uvs.fixed(triangle)) {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        [0, 1].map(|axis| (low[axis] + high[axis]).div_euclid(2 * i64::from(self.size) * UNIT) as i32)
    }
}
