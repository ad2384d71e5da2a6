//! Texels that hold what other texels hold: ghosts over seams, and those without a counterpart on another level.

mod rows;

use std::sync::{Arc, OnceLock};

use bytemuck::{Pod, Zeroable};
use sabi_nodes::link::Format;
use sabi_surface::atlas::{Atlas, Orphan};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipelines::{FixedKernel, read_entry, storage_entry, texture_entry, uniform_entry, write_entry};
use crate::pool::array_view;
use crate::surface::GpuSurface;
use crate::uploads::{storage_buffer, table_texture};
use rows::{LinkRow, fill_rows, orphan_rows};

/// Links a workgroup.
const GROUP: u32 = 64;
/// Workgroups in a row of a dispatch.
const ROW: u32 = 32_768;

/// Which texels a link takes its value from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LinkRound {
    /// The four owned texels around a plain ghost's point.
    Plain,
    /// Owned texels only.
    Owned,
    /// Ghosts, too, that an earlier round has filled.
    WithGhosts,
    /// As before, along cubics instead of straight lines: where a slope is taken over a seam, straight lines would flatten
    /// crests there.
    Cubic,
}

/// All rounds that fill ghosts. The first one reads owned texels alone, along straight lines where not all are owned that
/// would be read, so that nothing old is handed on. Where the texels of two charts meet halfway, a ghost lies between an
/// owned texel and a ghost of the other side, whose value depends on it in turn: each further round takes away most of
/// what is left of that. The cubic ones are for results: slopes are taken of them.
const ALL_ROUNDS: [LinkRound; 6] = [
    LinkRound::Owned,
    LinkRound::WithGhosts,
    LinkRound::WithGhosts,
    LinkRound::Cubic,
    LinkRound::Cubic,
    LinkRound::Cubic,
];

impl LinkRound {
    /// The rounds for ghosts that may hold something old, or, as those of a repeated pass two repetitions later, nearly
    /// what they will; and for results or what is only passed on.
    pub(crate) fn of(holds_nearly: bool, is_result: bool) -> &'static [LinkRound] {
        &ALL_ROUNDS[usize::from(holds_nearly)..if is_result { 6 } else { 3 }]
    }
}

/// The links of a surface's ghosts: all of them for kernels, and in two parts to fill them.
pub(crate) struct GhostLinks {
    pub(crate) all: Links,
    /// Those between four owned texels, which are known at once.
    plain: Links,
    /// The others, which hang on ghosts or lack texels.
    coupled: Links,
}

impl GhostLinks {
    /// Those of an atlas' ghosts.
    pub(crate) fn of(gpu: &Gpu, atlas: &Atlas) -> Result<GhostLinks, GpuError> {
        let rows: Vec<LinkRow> = atlas
            .ghosts
            .iter()
            .map(|ghost| LinkRow::of_ghost(atlas, ghost))
            .collect();
        let (plain, coupled): (Vec<_>, Vec<_>) = rows
            .iter()
            .map(|row| fill_rows(atlas, row))
            .partition(|[_, known]| known[1] == 0xf);
        let plain: Vec<[u32; 4]> = plain.into_iter().map(|[row, _]| row).collect();
        Ok(GhostLinks {
            plain: Links::upload(gpu, &plain, 1)?,
            coupled: Links::upload(gpu, &coupled, 2)?,
            all: Links::upload(gpu, &rows, 4)?,
        })
    }
}

/// Links on the device.
pub(crate) struct Links {
    /// As `ghosts` in `shaders/lib/atlas.wgsl`.
    pub(crate) rows: wgpu::TextureView,
    count: u32,
    /// For rounds over owned texels only, and with ghosts.
    constants: [wgpu::Buffer; 2],
    /// The surface with these as its ghosts, once they are filled.
    surface: OnceLock<wgpu::BindGroup>,
    /// Room for one value a link, on its way from where it is gathered to where it is written.
    values: wgpu::Buffer,
}

impl Links {
    /// Those of texels without a counterpart.
    pub(crate) fn of_orphans(gpu: &Gpu, orphans: &[Orphan]) -> Result<Links, GpuError> {
        let rows: Vec<[[u32; 4]; 2]> = orphans.iter().map(orphan_rows).collect();
        Links::upload(gpu, &rows, 2)
    }

    fn upload<Row: Pod>(gpu: &Gpu, rows: &[Row], of_ghost: u32) -> Result<Links, GpuError> {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let constants = [0, 1].map(|with_ghosts| {
            let constants = Constants {
                ghost_count: rows.len() as u32,
                with_ghosts,
                row_length: ROW.min((rows.len() as u32).div_ceil(GROUP)),
                rows: of_ghost,
            };
            gpu.uniform(bytemuck::bytes_of(&constants))
        });
        Ok(Links {
            constants,
            surface: OnceLock::new(),
            rows: table_texture(gpu, "the links over seams", bytemuck::cast_slice(rows))?,
            count: rows.len() as u32,
            values: storage_buffer(gpu, "the values over seams", 16 * rows.len() as u64, limit)?,
        })
    }
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Constants {
    ghost_count: u32,
    with_ghosts: u32,
    row_length: u32,
    rows: u32,
}

impl Gpu {
    /// Refreshes the ghosts of one texture: plain ones once, what hangs on them round by round, and with cubics all again.
    pub(crate) fn fill_ghosts(
        &self,
        surface: &GpuSurface,
        texture: (&wgpu::Texture, Format),
        rounds: &[LinkRound],
    ) -> Result<(), GpuError> {
        let GhostLinks { all, plain, coupled } = &surface.ghosts;
        let cubic = rounds.iter().position(|round| *round == LinkRound::Cubic);
        let (straight, cubic) = rounds.split_at(cubic.unwrap_or(rounds.len()));
        let parts = [(plain, &[LinkRound::Plain][..]), (coupled, straight), (all, cubic)];
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (links, rounds) in parts {
            if links.count > 0 && !rounds.is_empty() {
                let group = links.surface.get_or_init(|| self.surface_group(surface, links));
                self.encode_links(&mut encoder, links, group, texture, rounds)?;
            }
        }
        self.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Refreshes the linked texels of one texture; `surface_group` binds the surface with the links as its ghosts.
    pub(crate) fn fill_links(
        &self,
        links: &Links,
        surface_group: &wgpu::BindGroup,
        texture: (&wgpu::Texture, Format),
        rounds: &[LinkRound],
    ) -> Result<(), GpuError> {
        if links.count == 0 {
            return Ok(());
        }
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.encode_links(&mut encoder, links, surface_group, texture, rounds)?;
        self.queue.submit([encoder.finish()]);
        Ok(())
    }

    fn encode_links(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        links: &Links,
        surface_group: &wgpu::BindGroup,
        (texture, format): (&wgpu::Texture, Format),
        rounds: &[LinkRound],
    ) -> Result<(), GpuError> {
        // All rounds of all fields take turns with it: what one submission gathers, the same one writes.
        let values = &links.values;
        let view = array_view(texture);
        let groups = links.count.div_ceil(GROUP);
        for round in rounds {
            let with_ghosts = usize::from(*round == LinkRound::WithGhosts);
            let constants = links.constants[with_ghosts].as_entire_binding();
            let view = wgpu::BindingResource::TextureView(&view);
            let [gather, scatter] = self.link_kernels(*round, format)?;
            let steps = [
                (gather, [constants.clone(), view.clone(), values.as_entire_binding()]),
                (scatter, [constants, values.as_entire_binding(), view]),
            ];
            for (kernel, resources) in steps {
                let group = self.bind(&kernel.layout, resources);
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(&kernel.pipeline);
                pass.set_bind_group(0, surface_group, &[]);
                pass.set_bind_group(1, &group, &[]);
                pass.dispatch_workgroups(ROW.min(groups), groups.div_ceil(ROW), 1);
            }
        }
        Ok(())
    }

    /// The kernels of a round: one that computes ghosts, and one that writes them to textures of a format.
    fn link_kernels(&self, round: LinkRound, format: Format) -> Result<[Arc<FixedKernel>; 2], GpuError> {
        let (name, gather) = match round {
            LinkRound::Plain => (
                "gather plain",
                include_str!("../../../shaders/surface/gather_plain.wgsl"),
            ),
            LinkRound::Owned | LinkRound::WithGhosts => (
                "gather coupled",
                include_str!("../../../shaders/surface/gather_coupled.wgsl"),
            ),
            LinkRound::Cubic => (
                "refine ghosts",
                include_str!("../../../shaders/surface/refine_ghosts.wgsl"),
            ),
        };
        let gather_entries = [uniform_entry(0), texture_entry(1), write_entry(2)];
        let (scatter_name, scatter) = match round {
            LinkRound::Plain | LinkRound::Owned | LinkRound::WithGhosts => (
                "scatter filled",
                include_str!("../../../shaders/surface/scatter_filled.wgsl"),
            ),
            LinkRound::Cubic => (
                "scatter ghosts",
                include_str!("../../../shaders/surface/scatter_ghosts.wgsl"),
            ),
        };
        let scatter = scatter.replace("FORMAT", format.wgsl());
        let scatter_entries = [uniform_entry(0), read_entry(1), storage_entry(2, format)];
        Ok([
            self.fixed_kernel(name, None, gather, &gather_entries)?,
            self.fixed_kernel(scatter_name, Some(format), &scatter, &scatter_entries)?,
        ])
    }

    /// A small buffer of constants.
    pub(crate) fn uniform(&self, bytes: &[u8]) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes.len() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// A bind group with these resources at 0, 1, 2, …
    pub(crate) fn bind<'r>(
        &self,
        layout: &wgpu::BindGroupLayout,
        resources: impl IntoIterator<Item = wgpu::BindingResource<'r>>,
    ) -> wgpu::BindGroup {
        let entry = |(binding, resource)| wgpu::BindGroupEntry {
            binding: binding as u32,
            resource,
        };
        let entries: Vec<_> = resources.into_iter().enumerate().map(entry).collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        })
    }
}
