//! Results of source nodes: drawn on the device, or uploaded.

use sabi_nodes::link::Format;
use sabi_plan::SourceStep;
use sabi_surface::atlas::TILE;

use super::Runner;
use crate::error::GpuError;
use crate::formats::wgpu_format;
use crate::readback::{PlaneData, read_texture};
use crate::source_canvas::SourceCanvas;
use crate::source_fill::SourceFill;
use crate::tile_set::{TILE_EXTENT, TileSet, copied_tile};

impl Runner<'_> {
    pub(super) fn source(&mut self, step: &SourceStep, sources: &mut dyn SourceFill) -> Result<(), GpuError> {
        let bound = self.connected(step)?;
        let unused = self.unused_plane(Format::Rgba16Float, false)?;
        let mut read_inputs = None;
        let covered = self.coverages.tiles(self.at);
        for (output, planes) in &step.writes {
            for (plane, slot) in planes {
                self.stop_if_canceled()?;
                let texture = self.texture(*slot)?;
                let format = self.plan.slots[*slot].format;
                let failed = |reason: String| GpuError::Node {
                    node: step.id.clone(),
                    reason,
                };
                let canvas = SourceCanvas {
                    gpu: self.gpu,
                    surface: self.surfaces.finest,
                    field: &texture,
                    format,
                    inputs: &bound,
                    unused: &unused,
                    covered: self.part.as_ref().or(covered),
                    options: self.options,
                };
                if sources.draw(&canvas, step, output, *plane)? {
                    // Releases the memory of the uploads before the next plane is computed.
                    self.wait()?;
                    continue;
                }
                let inputs = match &mut read_inputs {
                    Some(inputs) => inputs,
                    none => none.insert(self.read_inputs(step, &bound)?),
                };
                if let Some(tiles) = self.part.clone() {
                    let bytes = sources
                        .plane_tiles(step, output, *plane, inputs, &tiles)
                        .map_err(failed)?;
                    self.stop_if_canceled()?;
                    self.upload_tiles(&texture, format, &tiles, &bytes);
                    continue;
                }
                let bytes = sources.plane(step, output, *plane, inputs, covered).map_err(failed)?;
                self.stop_if_canceled()?;
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
                // The driver holds a copy until the upload is done, so the upload has to end before the next plane is computed.
                self.gpu.queue.submit([]);
                self.wait()?;
            }
        }
        Ok(())
    }

    /// Ends the run if it is canceled: the plane of a stopped source is incomplete.
    fn stop_if_canceled(&self) -> Result<(), GpuError> {
        match (self.options.is_canceled)() {
            true => Err(GpuError::Canceled),
            false => Ok(()),
        }
    }

    /// Returns the textures of the connected inputs of a source.
    fn connected(&mut self, step: &SourceStep) -> Result<Vec<Option<wgpu::Texture>>, GpuError> {
        let slots = step.reads.iter();
        slots
            .map(|slot| slot.map(|slot| self.texture(slot)).transpose())
            .collect()
    }

    /// Reads back the connected inputs of a source that is computed on the processor.
    fn read_inputs(
        &self,
        step: &SourceStep,
        bound: &[Option<wgpu::Texture>],
    ) -> Result<Vec<Option<PlaneData>>, GpuError> {
        let both = step.reads.iter().zip(bound);
        let read = both.map(|(slot, texture)| match (slot, texture) {
            (Some(slot), Some(texture)) => {
                let format = self.plan.slots[*slot].format;
                let read = read_texture(self.gpu, texture, self.surfaces.finest.extent, format)?;
                Ok(Some(read))
            }
            _ => Ok(None),
        });
        read.collect()
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
