//! Entries of bind group layouts, and the layout of the surface, which every kernel binds.

use sabi_nodes::link::Format;

use crate::formats::wgpu_format;

/// Bind group layout of the surface; see `shaders/lib/atlas.wgsl`.
pub(crate) fn surface_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("surface"),
        entries: &surface_entries(),
    })
}

/// Number of textures in the bind group of the surface.
pub(crate) fn surface_texture_count() -> usize {
    let is_texture = |entry: &wgpu::BindGroupLayoutEntry| matches!(entry.ty, wgpu::BindingType::Texture { .. });
    surface_entries().into_iter().filter(is_texture).count()
}

fn surface_entries() -> [wgpu::BindGroupLayoutEntry; 8] {
    let entries = [
        uniform_entry(0),
        read_entry(1),
        owners_entry(2),
        table_entry(3),
        table_entry(4),
        table_entry(5),
        read_entry(6),
        owners_entry(7),
    ];
    // The viewport's fragment shaders use the same tables to follow relief across seams.
    entries.map(|entry| wgpu::BindGroupLayoutEntry {
        visibility: wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT,
        ..entry
    })
}

fn buffer_entry(binding: u32, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    entry(
        binding,
        wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
    )
}

fn entry(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    }
}

/// A texture that is read texel by texel.
pub(crate) fn texture_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let sample_type = wgpu::TextureSampleType::Float { filterable: false };
    sampled_entry(binding, sample_type, wgpu::TextureViewDimension::D2Array)
}

/// Returns an entry for whole numbers, one for each texel of the atlas.
pub(crate) fn owners_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let sample_type = wgpu::TextureSampleType::Uint;
    sampled_entry(binding, sample_type, wgpu::TextureViewDimension::D2Array)
}

/// Returns an entry for a table of bit patterns.
pub(crate) fn table_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    sampled_entry(binding, wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2)
}

fn sampled_entry(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindGroupLayoutEntry {
    entry(
        binding,
        wgpu::BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled: false,
        },
    )
}

/// A texture that is written.
pub(crate) fn storage_entry(binding: u32, format: Format) -> wgpu::BindGroupLayoutEntry {
    storage_texture_entry(binding, format, wgpu::StorageTextureAccess::WriteOnly)
}

/// Returns an entry for a texture that is read and written. Every adapter allows that for its format.
pub(crate) fn update_entry(binding: u32, format: Format) -> wgpu::BindGroupLayoutEntry {
    storage_texture_entry(binding, format, wgpu::StorageTextureAccess::ReadWrite)
}

/// A texture of whole numbers that is written.
pub(crate) fn marks_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    storage_of(
        binding,
        wgpu::TextureFormat::R32Uint,
        wgpu::StorageTextureAccess::WriteOnly,
    )
}

fn storage_texture_entry(
    binding: u32,
    format: Format,
    access: wgpu::StorageTextureAccess,
) -> wgpu::BindGroupLayoutEntry {
    storage_of(binding, wgpu_format(format), access)
}

fn storage_of(
    binding: u32,
    format: wgpu::TextureFormat,
    access: wgpu::StorageTextureAccess,
) -> wgpu::BindGroupLayoutEntry {
    let view_dimension = wgpu::TextureViewDimension::D2Array;
    entry(
        binding,
        wgpu::BindingType::StorageTexture {
            access,
            format,
            view_dimension,
        },
    )
}

/// A buffer that is read.
pub(crate) fn read_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    buffer_entry(binding, wgpu::BufferBindingType::Storage { read_only: true })
}

/// A buffer that is read and written.
pub(crate) fn write_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    buffer_entry(binding, wgpu::BufferBindingType::Storage { read_only: false })
}

/// A small buffer of constants.
pub(crate) fn uniform_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    buffer_entry(binding, wgpu::BufferBindingType::Uniform)
}
