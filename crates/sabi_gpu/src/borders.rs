//! Borders of charts on shown maps: where values jump at a border, ghosts repeat their own chart, as they do on exported maps.

use sabi_nodes::kind::Channel;
use sabi_nodes::link::Plane;
use sabi_nodes::wgsl_struct;

use crate::bindings::{read_entry, texture_entry, uniform_entry, write_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::formats::format_of;
use crate::ghosts::encode_scattered_ghosts;
use crate::pipelines::fixed_kernel;
use crate::pool::array_view;
use crate::readback::StagingBuffer;
use crate::shaders::FixedShader;
use crate::surface::GpuSurface;
use crate::uploads::storage_buffer;

/// Ghosts per workgroup.
pub(crate) const GROUP: u32 = 64;
/// Workgroups in a row of a dispatch.
const ROW: u32 = 32_768;
/// First bit of the step from an anchor to its ghost. The lower bits hold the texels around the anchor.
pub(crate) const STEP_BIT: u32 = 25;

/// Ghost whose own chart has a texel near it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BorderGhost {
    /// Its index among the ghosts of the atlas.
    pub index: u32,
    /// Step from the ghost's anchor, which is the nearest texel of its chart, to the ghost, in texels across and down; at most two each.
    pub step: [i8; 2],
    /// The 5 × 5 texels around the anchor, one bit for each, row by row: set if the chart owns the texel.
    pub own: u32,
}

/// Ghosts of an atlas, on the device. Where values jump, they repeat their chart.
pub struct Borders {
    steeper: f32,
    /// A word for each ghost of the atlas, as `borders.wgsl` reads them.
    ghosts: wgpu::Buffer,
}

/// Treatment of the ghosts of a map beyond a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BorderKind {
    /// Number of components of a texel, counted from the first, that are changed together. A fourth component is changed on its own.
    pub together: usize,
    /// True if ghosts directly beside their chart stay as they are, since both sides of a seam have to meet.
    pub keeps_first_ring: bool,
}

impl BorderKind {
    /// Returns the treatment of a plane. Values that are written to the same map are changed together.
    pub fn of(plane: Plane) -> BorderKind {
        let together = match plane {
            Plane::Mask | Plane::Material(Channel::Surface | Channel::Height | Channel::Coat) => 1,
            Plane::Color
            | Plane::Vector
            | Plane::Material(
                Channel::Color
                | Channel::Slope
                | Channel::Emission
                | Channel::Anisotropy
                | Channel::Sheen
                | Channel::Subsurface,
            ) => 3,
        };
        BorderKind {
            together,
            // Different heights on the two sides of a seam would show as a crack.
            keeps_first_ring: plane == Plane::Material(Channel::Height),
        }
    }
}

wgsl_struct! {
    "surface/borders" Borders:
    /// Constants of a dispatch over the ghosts.
    pub(crate) struct BorderConstants {
        ghost_count: u32,
        row_length: u32,
        place: u32,
        are_three_together: u32,
        keeps_first_ring: u32,
        steeper: f32,
        pad: [u32; 2],
    }
}

impl Borders {
    /// Uploads the ghosts of the atlas of a surface. A ghost is beyond a jump if, for each texel of its distance from its anchor, its
    /// value differs from the anchor's by more than `steeper` times the largest step between neighboring texels of the chart around there.
    pub fn upload(
        gpu: &Gpu,
        surface: &GpuSurface,
        ghosts: impl IntoIterator<Item = BorderGhost>,
        steeper: f32,
    ) -> Result<Borders, GpuError> {
        let mut words = vec![0_u32; surface.ghosts.all.count as usize];
        for ghost in ghosts {
            let [x, y] = ghost.step.map(|step| (i32::from(step) + 2) as u32);
            if let Some(word) = words.get_mut(ghost.index as usize) {
                *word = ghost.own | (5 * y + x) << STEP_BIT;
            }
        }
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let bytes: &[u8] = bytemuck::cast_slice(&words);
        let buffer = storage_buffer(gpu, "the borders of charts", bytes.len() as u64, limit)?;
        if !bytes.is_empty() {
            gpu.queue.write_buffer(&buffer, 0, bytes);
        }
        Ok(Borders {
            steeper,
            ghosts: buffer,
        })
    }

    fn constants(&self, surface: &GpuSurface, kind: BorderKind, place: usize) -> BorderConstants {
        let count = surface.ghosts.all.count;
        BorderConstants {
            ghost_count: count,
            row_length: ROW.min(count.div_ceil(GROUP)),
            place: place as u32,
            are_three_together: u32::from(kind.together == 3),
            keeps_first_ring: u32::from(kind.keeps_first_ring),
            steeper: self.steeper,
            pad: [0; 2],
        }
    }

    /// Returns for each texture on the atlas whether it has ghosts beyond a jump.
    pub(crate) fn find_jumps(
        &self,
        gpu: &Gpu,
        surface: &GpuSurface,
        of: &[(&wgpu::Texture, BorderKind)],
    ) -> Result<Vec<bool>, GpuError> {
        if surface.ghosts.all.count == 0 || of.is_empty() {
            return Ok(vec![false; of.len()]);
        }
        let bytes = (of.len() * size_of::<u32>()) as u64;
        let found = gpu.guarded("the jumps of maps", |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("jumps"),
                size: bytes,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            })
        })?;
        gpu.queue.write_buffer(&found, 0, &vec![0; bytes as usize]);
        for (place, (texture, kind)) in of.iter().enumerate() {
            let constants = self.constants(surface, *kind, place);
            let entries = [uniform_entry(0), read_entry(1), texture_entry(2), write_entry(3)];
            let dispatch = BorderDispatch {
                shader: FixedShader::FindJumps,
                entries: &entries,
                constants,
                output: found.as_entire_binding(),
            };
            gpu.submit_compute_pass(|pass| self.encode(gpu, pass, surface, texture, dispatch))?;
        }
        let staging = StagingBuffer::new(gpu, bytes)?;
        let copy = staging.copy_buffer(gpu, &found, bytes);
        staging.read(gpu, copy, |bytes| {
            let (words, _) = bytes.as_chunks::<4>();
            words.iter().map(|word| *word != [0; 4]).collect()
        })
    }

    /// Writes the ghosts of a texture on the atlas into a copy of it, or into the texture itself. Ghosts beyond a jump repeat their chart.
    pub(crate) fn repeat_charts(
        &self,
        gpu: &Gpu,
        surface: &GpuSurface,
        [texture, shown]: [&wgpu::Texture; 2],
        kind: BorderKind,
    ) -> Result<(), GpuError> {
        let links = &surface.ghosts.all;
        if links.count == 0 {
            return Ok(());
        }
        let entries = [uniform_entry(0), read_entry(1), texture_entry(2), write_entry(3)];
        let dispatch = BorderDispatch {
            shader: FixedShader::GatherBorders,
            entries: &entries,
            constants: self.constants(surface, kind, 0),
            output: links.values.as_entire_binding(),
        };
        let format = format_of(texture)?;
        // All textures share the buffer of values, so the work is one submission.
        gpu.submit_compute_pass(|pass| {
            self.encode(gpu, pass, surface, texture, dispatch)?;
            encode_scattered_ghosts(gpu, pass, surface, shown, format)
        })
    }

    fn encode(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::ComputePass<'_>,
        surface: &GpuSurface,
        texture: &wgpu::Texture,
        dispatch: BorderDispatch<'_>,
    ) -> Result<(), GpuError> {
        let kernel = fixed_kernel(gpu, dispatch.shader, dispatch.entries)?;
        let constants = gpu.uniform(bytemuck::bytes_of(&dispatch.constants));
        let view = array_view(texture);
        let group = gpu.bind(
            &kernel.layout,
            [
                constants.as_entire_binding(),
                self.ghosts.as_entire_binding(),
                wgpu::BindingResource::TextureView(&view),
                dispatch.output,
            ],
        );
        let links = &surface.ghosts.all;
        let bound = surface.bindings_of_ghosts(gpu, links);
        let groups = links.count.div_ceil(GROUP);
        pass.set_pipeline(&kernel.pipeline);
        pass.set_bind_group(0, bound, &[]);
        pass.set_bind_group(1, &group, &[]);
        pass.dispatch_workgroups(ROW.min(groups), groups.div_ceil(ROW), 1);
        Ok(())
    }
}

/// Dispatch over all ghosts of the borders of charts.
struct BorderDispatch<'a> {
    shader: FixedShader,
    entries: &'a [wgpu::BindGroupLayoutEntry],
    constants: BorderConstants,
    output: wgpu::BindingResource<'a>,
}
