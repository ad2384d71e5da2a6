//! Parts of pipelines: entry points, vertex layouts, depth.

use crate::render_target::DEPTH_FORMAT;

/// Options by which the pipelines differ.
pub(super) struct PipelineOptions<'r> {
    pub(super) label: &'r str,
    pub(super) module: &'r wgpu::ShaderModule,
    /// Entry points of the vertex shader and, if colors are written, of the fragment shader.
    pub(super) entries: (&'r str, Option<&'r str>),
    /// Values of the module's overrides.
    pub(super) switches: &'r [(&'r str, f64)],
    pub(super) groups: &'r [&'r wgpu::BindGroupLayout],
    pub(super) vertex_buffers: &'r [wgpu::VertexBufferLayout<'r>],
    pub(super) targets: &'r [wgpu::TextureFormat],
    pub(super) cull: Option<wgpu::Face>,
    pub(super) depth: Option<wgpu::DepthStencilState>,
}

/// Returns depth and stencil tests. With `is_written`, both buffers are written.
pub(super) fn depth(
    compare: wgpu::CompareFunction,
    stencil: wgpu::CompareFunction,
    is_written: bool,
) -> wgpu::DepthStencilState {
    let face = wgpu::StencilFaceState {
        compare: stencil,
        pass_op: match is_written {
            true => wgpu::StencilOperation::Replace,
            false => wgpu::StencilOperation::Keep,
        },
        ..wgpu::StencilFaceState::IGNORE
    };
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(is_written),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState {
            front: face,
            back: face,
            read_mask: 0xff,
            write_mask: if is_written { 0xff } else { 0 },
        },
        bias: wgpu::DepthBiasState::default(),
    }
}

pub(super) fn pipeline(device: &wgpu::Device, options: &PipelineOptions<'_>) -> wgpu::RenderPipeline {
    let groups: Vec<Option<&wgpu::BindGroupLayout>> = options.groups.iter().copied().map(Some).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(options.label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let target = |format: &wgpu::TextureFormat| Some(wgpu::ColorTargetState::from(*format));
    let targets: Vec<_> = options.targets.iter().map(target).collect();
    let (vertex, fragment) = options.entries;
    let compilation_options = wgpu::PipelineCompilationOptions {
        constants: options.switches,
        ..Default::default()
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(options.label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: options.module,
            entry_point: Some(vertex),
            compilation_options: compilation_options.clone(),
            buffers: options.vertex_buffers,
        },
        primitive: wgpu::PrimitiveState {
            cull_mode: options.cull,
            ..Default::default()
        },
        depth_stencil: options.depth.clone(),
        multisample: wgpu::MultisampleState::default(),
        fragment: fragment.map(|fragment| wgpu::FragmentState {
            module: options.module,
            entry_point: Some(fragment),
            compilation_options: compilation_options.clone(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

pub(super) const VERTEX_ATTRIBUTES: [wgpu::VertexAttribute; 5] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Uint32];
pub(super) const POSITION_ATTRIBUTE: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];
pub(super) const LINE_ATTRIBUTES: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];

pub(super) fn vertex_buffer<T>(
    attributes: &[wgpu::VertexAttribute],
    step_mode: wgpu::VertexStepMode,
) -> wgpu::VertexBufferLayout<'_> {
    wgpu::VertexBufferLayout {
        array_stride: size_of::<T>() as u64,
        step_mode,
        attributes,
    }
}

#[cfg(test)]
mod tests {
    use sabi_nodes::link::{MirrorValue, MirrorsWgsl};

    use super::{LINE_ATTRIBUTES, POSITION_ATTRIBUTE, VERTEX_ATTRIBUTES};
    use crate::edges::Line;
    use crate::model::Vertex;

    fn offsets<T: MirrorsWgsl>() -> Vec<u64> {
        match T::mirror().value {
            MirrorValue::Vertex(members) => members.iter().map(|member| member.offset as u64).collect(),
            other => panic!("{other:?} is not of a vertex buffer"),
        }
    }

    #[test]
    fn vertex_attributes_have_the_offsets_of_their_fields() {
        let attributes = |attributes: &[wgpu::VertexAttribute]| -> Vec<u64> {
            (0..)
                .zip(attributes)
                .map(|(location, attribute)| {
                    assert_eq!(attribute.shader_location, location);
                    attribute.offset
                })
                .collect()
        };
        assert_eq!(attributes(&VERTEX_ATTRIBUTES), offsets::<Vertex>());
        assert_eq!(attributes(&LINE_ATTRIBUTES), offsets::<Line>());
        assert_eq!(attributes(&POSITION_ATTRIBUTE), offsets::<Vertex>()[..1]);
    }
}
