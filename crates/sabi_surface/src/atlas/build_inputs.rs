//! Inputs of a build that do not depend on where charts are placed, and the charts with their masks.

use super::charts::{Partition, is_seam};
use super::fixed_point_uvs::Uvs;
use super::mask::Mask;
use super::topology::{NO_TWIN, Topology};
use crate::model::Mesh;

/// Inputs of a build that do not depend on the placement of charts.
pub(super) struct BuildInputs<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) topology: &'a Topology,
    pub(super) uvs: Uvs<'a>,
    /// Winding of each triangle in UV.
    pub(super) orientations: &'a [i8],
    pub(super) size: u32,
    pub(super) page_limit: u32,
    /// Most bytes of memory for the atlas.
    pub(super) memory_bytes: u64,
}

impl BuildInputs<'_> {
    /// Returns the triangle on the other side of a half-edge, if the edge is no seam.
    pub(super) fn across(&self, edge: u32) -> Option<u32> {
        let twin = self.topology.twins[edge as usize];
        (twin != NO_TWIN && !is_seam(self.mesh, self.topology, edge, twin)).then_some(twin / 3)
    }
}

/// The chart in UV to which a chart of the atlas belongs.
#[derive(Clone, Copy)]
pub(super) struct UvOrigin {
    pub(super) uv_chart: u32,
    /// Tile of the chart in UV.
    pub(super) uv_tile: [i32; 2],
}

/// Charts with their masks: charts in UV, or parts of these that are placed separately.
pub(super) struct ChartSet {
    pub(super) partition: Partition,
    pub(super) masks: Vec<Mask>,
    pub(super) origins: Vec<UvOrigin>,
}
