//! Texels that hold what other texels hold: ghosts over seams, and those without a counterpart on another level.

mod kernels;
mod rows;

use std::sync::OnceLock;

use bytemuck::{Pod, Zeroable};
use sabi_nodes::link::Format;
use sabi_surface::atlas::{Atlas, Orphan};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pool::array_view;
use crate::surface::GpuSurface;
use crate::uploads::{storage_buffer, table_texture};
use kernels::Part;
use rows::{LinkRow, coupled_slots, fill_rows, orphan_rows};

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
    /// The same once more, right after a round of that.
    Settled,
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
    LinkRound::Settled,
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
        let filled: Vec<[[u32; 4]; 2]> = rows.iter().map(|row| fill_rows(atlas, row)).collect();
        let is_plain = |rows: &[[u32; 4]; 2]| rows[1][1] == 0xf;
        let plain: Vec<[u32; 4]> = filled
            .iter()
            .filter(|rows| is_plain(rows))
            .map(|rows| rows[0])
            .collect();
        let mut next = 0..;
        let slots: Vec<Option<u32>> = filled
            .iter()
            .map(|rows| if is_plain(rows) { None } else { next.next() })
            .collect();
        let of_coupled = |rows: &[[u32; 4]; 2]| [rows[0], rows[1], coupled_slots(atlas, rows, &slots)];
        let coupled: Vec<[[u32; 4]; 3]> = filled.iter().filter(|rows| !is_plain(rows)).map(of_coupled).collect();
        Ok(GhostLinks {
            plain: Links::upload(gpu, &plain, 1)?,
            coupled: Links::upload(gpu, &coupled, 3)?,
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
        self.in_one_pass(|pass| {
            for (links, rounds) in parts {
                let group = links.surface.get_or_init(|| self.surface_group(surface, links));
                self.encode_links(pass, links, group, texture, rounds)?;
            }
            Ok(())
        })
    }

    /// Refreshes the linked texels of one texture; `surface_group` binds the surface with the links as its ghosts.
    pub(crate) fn fill_links(
        &self,
        links: &Links,
        surface_group: &wgpu::BindGroup,
        texture: (&wgpu::Texture, Format),
        rounds: &[LinkRound],
    ) -> Result<(), GpuError> {
        self.in_one_pass(|pass| self.encode_links(pass, links, surface_group, texture, rounds))
    }

    /// Submits what is encoded: one pass, since each costs software drivers something.
    pub(crate) fn in_one_pass(
        &self,
        encode: impl FnOnce(&mut wgpu::ComputePass<'_>) -> Result<(), GpuError>,
    ) -> Result<(), GpuError> {
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encode(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()))?;
        self.queue.submit([encoder.finish()]);
        Ok(())
    }

    fn encode_links(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        links: &Links,
        surface_group: &wgpu::BindGroup,
        (texture, format): (&wgpu::Texture, Format),
        rounds: &[LinkRound],
    ) -> Result<(), GpuError> {
        if links.count == 0 || rounds.is_empty() {
            return Ok(());
        }
        let view = array_view(texture);
        let groups = links.count.div_ceil(GROUP);
        pass.set_bind_group(0, surface_group, &[]);
        for round in rounds {
            let with_ghosts = usize::from(matches!(round, LinkRound::WithGhosts | LinkRound::Settled));
            for part in Part::of(*round, format) {
                let kernel = self.link_kernel(*round, *part, format)?;
                let constants = links.constants[with_ghosts].as_entire_binding();
                let view = wgpu::BindingResource::TextureView(&view);
                // All rounds of all fields take turns with the values: what one submission gathers, the same one writes.
                let values = (*part != Part::InPlace).then(|| links.values.as_entire_binding());
                let group = self.bind(&kernel.layout, [constants, view].into_iter().chain(values));
                pass.set_pipeline(&kernel.pipeline);
                pass.set_bind_group(1, &group, &[]);
                pass.dispatch_workgroups(ROW.min(groups), groups.div_ceil(ROW), 1);
            }
        }
        Ok(())
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
