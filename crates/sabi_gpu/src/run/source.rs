//! Upload of the results of source nodes.

use sabi_nodes::link::Format;
use sabi_plan::SourceStep;
use sabi_surface::atlas::TILE;

use super::Runner;
use crate::error::GpuError;
use crate::formats::wgpu_format;
use crate::readback::PlaneData;
use crate::source_fill::SourceFill;
use crate::tile_set::{TILE_EXTENT, TileSet, copied_tile};

impl Runner<'_> {
    pub(super) fn source(&mut self, step: &SourceStep, sources: &mut dyn SourceFill) -> Result<(), GpuError> {
        let inputs = self.source_inputs(step)?;
        let covered = self.coverages.tiles(self.at);
        for (output, planes) in &step.writes {
            for (plane, slot) in planes {
                if (self.options.is_canceled)() {
                    return Err(GpuError::Canceled);
                }
                let texture = self.texture(*slot)?;
                let format = self.plan.slots[*slot].format;
                let failed = |reason: String| GpuError::Node {
                    node: step.id.clone(),
                    reason,
                };
                if let Some(tiles) = self.part.clone() {
                    let bytes = sources
                        .plane_tiles(step, output, *plane, &inputs, &tiles)
                        .map_err(failed)?;
                    self.upload_tiles(&texture, format, &tiles, &bytes);
                    continue;
                }
                let bytes = sources.plane(step, output, *plane, &inputs, covered).map_err(failed)?;
                if bytes.len() as u64 != self.surfaces.finest.texels() * format.texel_bytes() {
                    let given = bytes.len();
                    let message = format!(
                        "node '{}' gave {given} bytes for '{output}', too few or too many",
                        step.id
                    );
                    return Err(GpuError::Defect(message));
                }
                self.upload(&texture, format, self.surfaces.finest.extent, &bytes);
                drop(bytes);
                // The driver holds a copy until the upload is done, which must end before the next plane is made.
                self.gpu.queue.submit([]);
                self.wait()?;
            }
        }
        Ok(())
    }

    /// Reads back the connected inputs of a source, which works on the processor.
    fn source_inputs(&mut self, step: &SourceStep) -> Result<Vec<Option<PlaneData>>, GpuError> {
        let mut inputs = Vec::new();
        for slot in &step.reads {
            inputs.push(match slot {
                Some(slot) => {
                    let texture = self.texture(*slot)?;
                    let format = self.plan.slots[*slot].format;
                    Some(self.gpu.read_texture(&texture, self.surfaces.finest.extent, format)?)
                }
                None => None,
            });
        }
        Ok(inputs)
    }

    /// Uploads some tiles of a texture, whose texels are given tile by tile.
    fn upload_tiles(&self, texture: &wgpu::Texture, format: Format, tiles: &TileSet, bytes: &[u8]) {
        let row_bytes = TILE * format.texel_bytes() as u32;
        let of_tile = (row_bytes * TILE) as usize;
        for (place, bytes) in tiles.places().zip(bytes.chunks_exact(of_tile)) {
            self.gpu.queue.write_texture(
                copied_tile(texture, place),
                bytes,
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row_bytes),
                    rows_per_image: Some(TILE),
                },
                TILE_EXTENT,
            );
        }
    }

    pub(super) fn upload(
        &self,
        texture: &wgpu::Texture,
        format: Format,
        [width, height, pages]: [u32; 3],
        bytes: &[u8],
    ) {
        debug_assert_eq!(texture.format(), wgpu_format(format));
        let bytes_per_row = Some(width * format.texel_bytes() as u32);
        self.gpu.queue.write_texture(
            texture.as_image_copy(),
            bytes,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row,
                rows_per_image: Some(height),
            },
            wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: pages,
            },
        );
    }
}
