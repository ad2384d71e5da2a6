//! Linked texels, which take their values from other texels: ghosts, and texels without a counterpart on another level.

mod rows;

use std::sync::OnceLock;

use bytemuck::Pod;
use sabi_nodes::wgsl_struct;
use sabi_surface::atlas::{Atlas, Orphan};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::uploads::{storage_buffer, table_texture};
pub(crate) use rows::{GHOST_ROWS, GhostLinkRow, GhostReadRow};
use rows::{LinkRow, coupled_slots, fill_rows, orphan_rows};

/// Links per workgroup.
pub(crate) const GROUP: u32 = 64;
/// Workgroups in a row of a dispatch.
pub(crate) const ROW: u32 = 32_768;

/// Links of the ghosts of a surface: all of them for kernels that read links, and divided into two parts for filling.
pub(crate) struct GhostLinks {
    pub(crate) all: Links,
    /// Ghosts between four owned texels, which one round fills.
    pub(crate) plain: Links,
    /// All other ghosts: they depend on ghosts, or some of their four texels are empty.
    pub(crate) coupled: Links,
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
    pub(crate) count: u32,
    /// Constants of rounds over owned texels only, and of rounds with ghosts.
    pub(crate) constants: [wgpu::Buffer; 2],
    /// Bind group of the surface with these links; made at its first use.
    pub(crate) surface_bindings: OnceLock<wgpu::BindGroup>,
    /// One value per link, between gathering and scattering.
    pub(crate) values: wgpu::Buffer,
}

impl GhostLinks {
    /// Returns links of no ghosts, with `table` in place of the table of all links.
    pub(crate) fn none_beside(gpu: &Gpu, table: &[[u32; 4]]) -> Result<GhostLinks, GpuError> {
        let none = || Links::upload::<[u32; 4]>(gpu, &[], 1);
        Ok(GhostLinks {
            all: Links {
                rows: table_texture(gpu, "the flow between points", bytemuck::cast_slice(table))?,
                ..none()?
            },
            plain: none()?,
            coupled: none()?,
        })
    }
}

impl Links {
    /// Uploads the links of texels without a counterpart on another level.
    pub(crate) fn of_orphans(gpu: &Gpu, orphans: &[Orphan]) -> Result<Links, GpuError> {
        let rows: Vec<[[u32; 4]; 2]> = orphans.iter().map(orphan_rows).collect();
        Links::upload(gpu, &rows, 2)
    }

    fn upload<Row: Pod>(gpu: &Gpu, rows: &[Row], link_rows: u32) -> Result<Links, GpuError> {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let constants = [0, 1].map(|with_ghosts| {
            let constants = FillConstants {
                ghost_count: rows.len() as u32,
                with_ghosts,
                row_length: ROW.min((rows.len() as u32).div_ceil(GROUP)),
                rows: link_rows,
            };
            gpu.uniform(bytemuck::bytes_of(&constants))
        });
        Ok(Links {
            constants,
            surface_bindings: OnceLock::new(),
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
