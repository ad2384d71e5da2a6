//! Texture formats of storage formats.

use sabi_nodes::link::Format;

use crate::error::GpuError;

/// Texture format of a storage format.
pub(crate) fn wgpu_format(format: Format) -> wgpu::TextureFormat {
    match format {
        Format::R32Float => wgpu::TextureFormat::R32Float,
        Format::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        Format::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
    }
}

/// Storage format of a texture that kernels read and write.
pub(crate) fn format_of(texture: &wgpu::Texture) -> Result<Format, GpuError> {
    let known = [Format::R32Float, Format::Rgba16Float, Format::Rgba32Float];
    let found = known
        .into_iter()
        .find(|format| wgpu_format(*format) == texture.format());
    found.ok_or_else(|| GpuError::Defect(format!("no result is stored as {:?}", texture.format())))
}
