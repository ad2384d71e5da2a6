//! Measurements of a build and the warnings that follow from them.

use std::collections::BTreeSet;

use super::build_inputs::ChartSet;
use super::chart_placement::ChartPlacement;
use super::fixed_point_uvs::Uvs;
use super::overlap::ChartOverlap;
use super::topology::Topology;
use super::{AtlasReport, Chart};
use crate::model::Mesh;

/// Ratio of the densest to the sparsest chart above which texels differ visibly in size.
const DENSITY_RATIO: f64 = 4.0;
/// Share of the surface on thin charts up to which there is no warning: the texels of a few rivets are not noticed.
const THIN_LEAST_SHARE: f64 = 5e-3;
/// Charts below this share of the surface are ignored when densities are compared.
const DENSITY_LEAST_SHARE: f64 = 1e-3;

/// Inputs of the report.
pub(super) struct ReportInputs<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) topology: &'a Topology,
    pub(super) uvs: Uvs<'a>,
    /// Charts in UV.
    pub(super) in_uv: &'a ChartSet,
    pub(super) orientations: &'a [i8],
    pub(super) sound: &'a [bool],
    /// Charts that are placed.
    pub(super) charts: &'a [Chart],
    pub(super) placement: &'a ChartPlacement,
    pub(super) udims: &'a BTreeSet<u32>,
    pub(super) size: u32,
}

impl ReportInputs<'_> {
    pub(super) fn report(&self, overlap: ChartOverlap, unlinked_ghosts: u32, pulled_ghosts: u32) -> AtlasReport {
        let owned: u64 = self.charts.iter().map(|chart| u64::from(chart.texels)).sum();
        let squares = self.squares() as f64 * f64::from(self.size).powi(2);
        let count = |found: &mut dyn Iterator<Item = bool>| found.filter(|&found| found).count() as u32;
        let mut report = AtlasReport {
            coverage: (owned as f64 / squares) as f32,
            overlap_texels: overlap.texels,
            overlapping_charts: overlap.pairs,
            stacked_charts: overlap.stacked,
            mirrored_charts: self.count_in_uv(|chart| chart.mirrored),
            degenerate_uv_triangles: count(&mut self.orientations.iter().map(|&way| way == 0)),
            degenerate_triangles: count(&mut self.sound.iter().map(|&sound| !sound)),
            nonmanifold_edges: self.topology.nonmanifold_edges,
            border_edges: self.topology.border_edges,
            thin_charts: self.thin_charts(),
            moved_charts: self.moved_charts(),
            unlinked_ghosts,
            pulled_ghosts,
            warnings: Vec::new(),
        };
        report.warnings = self.warnings(&report);
        report
    }

    /// Counts the unit squares in use: one for each sheet, or one for each tile of a sheet whose tiles have maps of
    /// their own.
    fn squares(&self) -> usize {
        let square = |chart: &Chart| match self.udims.contains(&chart.sheet) {
            true if chart.texels == 0 => None,
            true => Some((chart.sheet, chart.uv_tile)),
            false => Some((chart.sheet, [0, 0])),
        };
        let squares: BTreeSet<(u32, [i32; 2])> = self.charts.iter().filter_map(square).collect();
        squares.len()
    }

    /// Counts charts in UV of which a placed part is as asked for.
    fn count_in_uv(&self, is_counted: impl Fn(&Chart) -> bool) -> u32 {
        let counted = self.charts.iter().filter(|chart| is_counted(chart));
        let in_uv: BTreeSet<u32> = counted.map(|chart| chart.uv_chart).collect();
        in_uv.len() as u32
    }

    /// Counts thin charts.
    fn thin_charts(&self) -> u32 {
        self.thin().count() as u32
    }

    /// Share of the surface that lies on thin charts.
    fn thin_share(&self) -> f64 {
        let partition = &self.in_uv.partition;
        let area = |chart: usize| self.areas(partition.triangles(chart)).0;
        let all: f64 = (0..partition.len()).map(area).sum();
        self.thin().map(area).sum::<f64>() / all
    }

    /// Thin charts. Those without area in UV do not count.
    fn thin(&self) -> impl Iterator<Item = usize> {
        let has_area = move |chart: usize| {
            let mut triangles = self.in_uv.partition.triangles(chart).iter();
            triangles.any(|&triangle| self.orientations[triangle as usize] != 0)
        };
        let masks = self.in_uv.masks.iter().enumerate();
        let thin = masks.filter(move |(chart, mask)| mask.is_thin() && has_area(*chart));
        thin.map(|(chart, _)| chart)
    }

    fn moved_charts(&self) -> u32 {
        if self.placement.kept {
            return 0;
        }
        self.count_in_uv(|chart| chart.texels > 0 && (chart.texel_from_uv != [0, 0] || chart.page != 0))
    }

    fn warnings(&self, report: &AtlasReport) -> Vec<String> {
        let mut warnings = Vec::new();
        let repeats = |chart: &Chart| chart.uv_tile != [0, 0] && !self.udims.contains(&chart.sheet) && chart.texels > 0;
        let outside = self.count_in_uv(repeats);
        if outside > 0 {
            let charts = counted(outside, "UV chart lies", "UV charts lie");
            warnings.push(format!("{charts} outside of the unit square; maps repeat there"));
        }
        if report.degenerate_uv_triangles > 0 {
            let triangles = counted(report.degenerate_uv_triangles, "triangle has", "triangles have");
            warnings.push(format!("{triangles} no area in UV and no place on the maps"));
        }
        if report.thin_charts > 0 && self.thin_share() > THIN_LEAST_SHARE {
            let charts = counted(report.thin_charts, "UV chart is", "UV charts are");
            warnings.push(format!(
                "{charts} thinner than two texels at size {}; a larger size or fewer, larger charts would help",
                self.size
            ));
        }
        if report.nonmanifold_edges > 0 {
            let edges = counted(report.nonmanifold_edges, "edge is shared", "edges are shared");
            warnings.push(format!(
                "{edges} by more than two triangles; filters treat those as borders"
            ));
        }
        if let Some(ratio) = self.density_ratio().filter(|&ratio| ratio > DENSITY_RATIO) {
            warnings.push(format!(
                "texels are up to {ratio:.1} times as dense on some UV charts as on others; scale them alike when you \
                 unwrap"
            ));
        }
        warnings
    }

    /// Returns the ratio of texels per model unit between the densest and the sparsest chart.
    fn density_ratio(&self) -> Option<f64> {
        let partition = &self.in_uv.partition;
        let areas: Vec<(f64, f64)> = (0..partition.len())
            .map(|chart| self.areas(partition.triangles(chart)))
            .collect();
        let least = areas.iter().map(|(space, _)| space).sum::<f64>() * DENSITY_LEAST_SHARE;
        let densities = areas
            .iter()
            .filter(|(space, texels)| *space > least && *texels > 0.0)
            .map(|(space, texels)| (texels / space).sqrt());
        let (low, high) = densities.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), density| {
            (low.min(density), high.max(density))
        });
        (low < high).then(|| high / low)
    }

    /// Returns the area in square model units and in texels.
    fn areas(&self, triangles: &[u32]) -> (f64, f64) {
        triangles
            .iter()
            .filter(|&&triangle| self.sound[triangle as usize])
            .fold((0.0, 0.0), |sum, &triangle| {
                let [q0, q1, q2] = self.uvs.corners(triangle);
                let texels = (q1 - q0).perp_dot(q2 - q0).abs() / 2.0;
                let [a, b, c] = self.mesh.corners(triangle);
                (sum.0 + (b - a).cross(c - a).length() / 2.0, sum.1 + texels)
            })
    }
}

fn counted(count: u32, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
