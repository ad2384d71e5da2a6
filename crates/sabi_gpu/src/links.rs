//! Linked texels, which take their values from other texels: ghosts, and texels without a counterpart on another level.

mod kernels;
mod rows;

use std::sync::OnceLock;

use bytemuck::Pod;
use sabi_nodes::link::Format;
use sabi_nodes::wgsl_struct;
use sabi_surface::atlas::{Atlas, Orphan};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pool::array_view;
use crate::surface::GpuSurface;
use crate::uploads::{storage_buffer, table_texture};
use kernels::Part;
pub(crate) use rows::{GHOST_ROWS, GhostLinkRow, GhostReadRow};
use rows::{LinkRow, coupled_slots, fill_rows, orphan_rows};

/// Links per workgroup.
pub(crate) const GROUP: u32 = 64;
/// Workgroups in a row of a dispatch.
const ROW: u32 = 32_768;

/// One round of filling linked texels: the texels that values are taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LinkRound {
    /// The four owned texels around the point of a plain ghost.
    Plain,
    /// Owned texels only.
    Owned,
    /// Owned texels and ghosts that an earlier round filled.
    WithGhosts,
    /// The same again, directly after a [`LinkRound::WithGhosts`].
    Settled,
    /// The same with cubic instead of linear interpolation, which would flatten crests where a slope is taken over a seam.
    Cubic,
}

/// All rounds that fill ghosts. The first reads owned texels only, so that no value of an earlier pass is carried on.
/// If the texels of two charts meet halfway, a ghost lies between an owned texel and a ghost of the other chart, whose
/// value depends on it in turn: each further round removes most of the remaining error. The cubic rounds are for
/// results, since slopes are computed from them.
const ALL_ROUNDS: [LinkRound; 6] = [
    LinkRound::Owned,
    LinkRound::WithGhosts,
    LinkRound::Settled,
    LinkRound::Cubic,
    LinkRound::Cubic,
    LinkRound::Cubic,
];

impl LinkRound {
    /// Rounds for ghosts that hold old values, or, as in a repeated pass from the third repetition on, nearly the right
    /// ones; and for results or intermediate textures.
    pub(crate) fn of(holds_nearly: bool, is_result: bool) -> &'static [LinkRound] {
        &ALL_ROUNDS[usize::from(holds_nearly)..if is_result { 6 } else { 3 }]
    }
}

/// Links of the ghosts of a surface: all of them for kernels that read links, and in two parts for filling.
pub(crate) struct GhostLinks {
    pub(crate) all: Links,
    /// Ghosts between four owned texels, which one round fills.
    plain: Links,
    /// All others: they depend on ghosts, or some of the four texels are empty.
    coupled: Links,
}

impl GhostLinks {
    /// Uploads the links of the ghosts of an atlas.
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
            all: Links::upload(
                gpu,
                &rows.iter().map(LinkRow::rows).collect::<Vec<_>>(),
                GHOST_ROWS as u32,
            )?,
        })
    }
}

/// Links on the device.
pub(crate) struct Links {
    /// Rows in the layout that `ghosts` of `shaders/lib/atlas.wgsl` has.
    pub(crate) rows: wgpu::TextureView,
    count: u32,
    /// Constants of rounds over owned texels only, and of rounds with ghosts.
    constants: [wgpu::Buffer; 2],
    /// Surface bind group with these links; made at its first use.
    surface: OnceLock<wgpu::BindGroup>,
    /// One value per link, between gathering and scattering.
    values: wgpu::Buffer,
}

impl Links {
    /// Uploads the links of texels without a counterpart on another level.
    pub(crate) fn of_orphans(gpu: &Gpu, orphans: &[Orphan]) -> Result<Links, GpuError> {
        let rows: Vec<[[u32; 4]; 2]> = orphans.iter().map(orphan_rows).collect();
        Links::upload(gpu, &rows, 2)
    }

    fn upload<Row: Pod>(gpu: &Gpu, rows: &[Row], of_ghost: u32) -> Result<Links, GpuError> {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let constants = [0, 1].map(|with_ghosts| {
            let constants = FillConstants {
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

wgsl_struct! {
    "surface/fill" Fill:
    /// Constants of a dispatch over a table of links.
    pub(crate) struct FillConstants {
        ghost_count: u32,
        with_ghosts: u32,
        row_length: u32,
        rows: u32,
    }
}

impl Gpu {
    /// Fills the ghosts of one texture: plain ones once, coupled ones round by round, then all of them in the cubic rounds.
    pub(crate) fn fill_ghosts(
        &self,
        surface: &GpuSurface,
        texture: (&wgpu::Texture, Format),
        rounds: &[LinkRound],
    ) -> Result<(), GpuError> {
        let GhostLinks { all, plain, coupled } = &surface.ghosts;
        let cubic = rounds.iter().position(|round| *round == LinkRound::Cubic);
        // Without a cubic round, all are linear.
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

    /// Fills the linked texels of one texture; `surface_group` binds the surface with these links.
    pub(crate) fn fill_links(
        &self,
        links: &Links,
        surface_group: &wgpu::BindGroup,
        texture: (&wgpu::Texture, Format),
        rounds: &[LinkRound],
    ) -> Result<(), GpuError> {
        self.in_one_pass(|pass| self.encode_links(pass, links, surface_group, texture, rounds))
    }

    /// Encodes and submits one pass; passes are costly on software drivers.
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
                // All textures share the buffer of values: one submission gathers and scatters.
                let values = (*part != Part::InPlace).then(|| links.values.as_entire_binding());
                let group = self.bind(&kernel.layout, [constants, view].into_iter().chain(values));
                pass.set_pipeline(&kernel.pipeline);
                pass.set_bind_group(1, &group, &[]);
                pass.dispatch_workgroups(ROW.min(groups), groups.div_ceil(ROW), 1);
            }
        }
        Ok(())
    }

    /// Uniform buffer with these bytes.
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

    /// Bind group with these resources at bindings 0, 1, 2, …
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
