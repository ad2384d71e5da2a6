//! Inputs of a build: what does not depend on where charts are placed, and the charts with their masks.

use super::charts::Partition;
use super::fixed::Uvs;
use super::mask::Mask;
use super::topology::Topology;
use crate::model::Mesh;

/// Inputs of a build that do not depend on the placement of charts.
pub(super) struct Plan<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) topology: &'a Topology,
    pub(super) uvs: Uvs<'a>,
    /// Winding of each triangle in UV.
    pub(super) orientations: &'a [i8],
    pub(super) size: u32,
    pub(super) page_limit: u32,
}

/// Where a chart of the atlas comes from.
#[derive(Clone, Copy)]
pub(super) struct Origin {
    /// Number of the chart in UV that it is, or is a part of.
    pub(super) uv_chart: u32,
    /// Tile of that chart in UV.
    pub(super) uv_tile: [i32; 2],
}

/// Charts with their masks: those in UV, or their parts, which are placed each on its own.
pub(super) struct ChartSet {
    pub(super) partition: Partition,
    pub(super) masks: Vec<Mask>,
    pub(super) origins: Vec<Origin>,
}
