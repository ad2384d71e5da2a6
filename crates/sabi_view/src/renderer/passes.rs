//! The passes of a picture.

use sabi_gpu::Gpu;
use sabi_nodes::wgsl_struct;

use super::Renderer;
use super::bound_scene::BoundScene;
use crate::error::ViewError;
use crate::lights::{lights_of_sample, move_between_samples};
use crate::pipelines::PipelineKey;
use crate::render_target::VisibilityBuffer;
use crate::scene::{Lines, MOST_LIGHTS, Mode, Scene, Shot};
use crate::shadows::{ShadowMaps, layers_of, shadow_matrices};

wgsl_struct! {
    "view/cast_shadow" Caster:
    /// Light that shadows are cast from.
    pub(crate) struct Caster {
        clip_from_view: [[f32; 4]; 4],
        sample: f32,
        pad_1: f32,
        pad_2: f32,
        pad_3: f32,
    }
}

impl Renderer {
    /// Creates the shadow maps of all lights and renders those of the first sample.
    pub(super) fn shadow_maps(
        &self,
        gpu: &Gpu,
        scene: &Scene<'_>,
        shot: &Shot,
        bound: &BoundScene,
        known: Option<ShadowMaps>,
    ) -> Result<ShadowMaps, ViewError> {
        let lights = &scene.lights[..scene.lights.len().min(MOST_LIGHTS)];
        let layers = lights.iter().map(layers_of).sum();
        let mut maps = match known.filter(|known| known.has_layers(layers)) {
            Some(known) => known,
            None => ShadowMaps::new(gpu, layers)?,
        };
        self.cast_shadows(gpu, scene, shot, 0, bound, &mut maps)?;
        Ok(maps)
    }

    /// Renders the shadow maps of a sample if they differ from those of the first sample.
    pub(super) fn cast_again(
        &self,
        gpu: &Gpu,
        scene: &Scene<'_>,
        shot: &Shot,
        sample: u32,
        bound: &BoundScene,
        maps: &mut ShadowMaps,
    ) -> Result<(), ViewError> {
        let is_lit = sample > 0 && shot.mode == Mode::Material;
        if is_lit && (move_between_samples(scene, shot) || bound.is_veiled()) {
            self.cast_shadows(gpu, scene, shot, sample, bound, maps)?;
        }
        Ok(())
    }

    /// Renders the shadow maps of a sample, unless they already show these lights and this opaque model.
    fn cast_shadows(
        &self,
        gpu: &Gpu,
        scene: &Scene<'_>,
        shot: &Shot,
        sample: u32,
        bound: &BoundScene,
        maps: &mut ShadowMaps,
    ) -> Result<(), ViewError> {
        let lights = lights_of_sample(scene, shot, sample);
        let cast = (scene.model.vertices.clone(), lights);
        if maps.cast.as_ref() == Some(&cast) {
            return Ok(());
        }
        let opaque = self.pipelines.get(gpu, PipelineKey::Shadow(None))?;
        let mut encoder = gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (layer, matrix) in shadow_matrices(&cast.1).iter().enumerate() {
            let caster = Caster {
                clip_from_view: matrix.to_cols_array_2d(),
                sample: sample as f32,
                pad_1: 0.0,
                pad_2: 0.0,
                pad_3: 0.0,
            };
            let uniform = self.uniform(gpu, &caster)?;
            let group = self.bind(gpu, &self.layouts().uniform, [uniform.as_entire_binding()]);
            let view = maps.layer(layer);
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shadow"),
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &view,
                    depth_ops: Some(cleared(1.0)),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_bind_group(0, &group, &[]);
            draw_casters(&mut pass, scene, bound, &opaque);
        }
        gpu.queue().submit([encoder.finish()]);
        // Shadows of transparent places differ from sample to sample, and their maps may change, so they are not reused.
        maps.cast = (!bound.is_veiled()).then_some(cast);
        Ok(())
    }
}

/// Draws the model into a shadow map: all at once if it is opaque.
fn draw_casters(pass: &mut wgpu::RenderPass<'_>, scene: &Scene<'_>, bound: &BoundScene, opaque: &wgpu::RenderPipeline) {
    pass.set_vertex_buffer(0, scene.model.vertices.slice(..));
    pass.set_index_buffer(scene.model.indices.slice(..), wgpu::IndexFormat::Uint32);
    if !bound.is_veiled() {
        pass.set_pipeline(opaque);
        pass.draw_indexed(0..scene.model.index_count, 0, 0..1);
        return;
    }
    for range in &bound.ranges {
        pass.set_pipeline(range.veiled_shadow.as_ref().unwrap_or(opaque));
        if range.veiled_shadow.is_some() {
            pass.set_bind_group(1, &bound.looks[range.look].material, &[]);
            pass.set_bind_group(2, &bound.charts, &[]);
        }
        pass.draw_indexed(range.indices.clone(), 0, 0..1);
    }
}

/// Draws the visibility buffer, and writes the number of each pixel's look to the stencil.
pub(super) fn draw_raster(
    encoder: &mut wgpu::CommandEncoder,
    visibility: &VisibilityBuffer,
    scene: &Scene<'_>,
    frame: &wgpu::BindGroup,
    bound: &BoundScene,
) {
    let layer = |layer| {
        visibility.record.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        })
    };
    let (places, frames) = (layer(0), layer(1));
    let depth = visibility.depth.create_view(&wgpu::TextureViewDescriptor::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("raster"),
        color_attachments: &[Some(color_attachment(&places)), Some(color_attachment(&frames))],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth,
            // Depth is reversed, so 0 is farthest.
            depth_ops: Some(cleared(0.0)),
            stencil_ops: Some(cleared(0)),
        }),
        ..Default::default()
    });
    pass.set_bind_group(0, frame, &[]);
    pass.set_bind_group(2, &bound.charts, &[]);
    pass.set_bind_group(3, &scene.model.surface, &[]);
    pass.set_vertex_buffer(0, scene.model.vertices.slice(..));
    pass.set_index_buffer(scene.model.indices.slice(..), wgpu::IndexFormat::Uint32);
    for range in &bound.ranges {
        pass.set_pipeline(&range.pipeline);
        pass.set_bind_group(1, &bound.looks[range.look].material, &[]);
        pass.set_stencil_reference(range.look as u32 + 1);
        pass.draw_indexed(range.indices.clone(), 0, 0..1);
    }
}

/// Draws the light of one sample.
pub(super) fn draw_light(
    encoder: &mut wgpu::CommandEncoder,
    light: &wgpu::Texture,
    visibility: &VisibilityBuffer,
    visibility_group: &wgpu::BindGroup,
    scene: &Scene<'_>,
    frame: &wgpu::BindGroup,
    bound: &BoundScene,
    parts: Option<&[PixelRect]>,
) {
    let light = light.create_view(&wgpu::TextureViewDescriptor::default());
    let depth = visibility.depth.create_view(&wgpu::TextureViewDescriptor::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("light"),
        color_attachments: &[Some(part_attachment(&light, parts))],
        // Read-only, since shaders read it as well.
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth,
            depth_ops: None,
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_bind_group(0, frame, &[]);
    pass.set_bind_group(2, visibility_group, &[]);
    pass.set_bind_group(3, &scene.model.surface, &[]);
    for_parts(&mut pass, parts, |pass| {
        for (index, look) in bound.looks.iter().enumerate() {
            pass.set_stencil_reference(index as u32 + 1);
            pass.set_pipeline(&look.shading);
            pass.set_bind_group(1, &look.material, &[]);
            pass.draw(0..3, 0..1);
        }
        if let Some(background) = bound.background.as_ref().filter(|_| parts.is_none()) {
            pass.set_pipeline(background);
            pass.set_stencil_reference(0);
            pass.set_bind_group(1, &bound.panorama, &[]);
            pass.draw(0..3, 0..1);
        }
        for (lines, style, pipeline) in &bound.lines {
            let (ends, count) = &scene.model.edges[usize::from(*lines == Lines::Seams)];
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, style, &[]);
            pass.set_vertex_buffer(0, ends.slice(..));
            pass.draw(0..6, 0..*count);
        }
    });
}

/// Part of a picture that is drawn: its left, upper, right and lower border in pixels.
pub(crate) type PixelRect = [u32; 4];

/// Returns an attachment. If there are parts, only they are drawn again, so the rest is kept.
pub(super) fn part_attachment<'v>(
    view: &'v wgpu::TextureView,
    parts: Option<&[PixelRect]>,
) -> wgpu::RenderPassColorAttachment<'v> {
    let attachment = color_attachment(view);
    match parts {
        Some(_) => wgpu::RenderPassColorAttachment {
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Load,
                store: wgpu::StoreOp::Store,
            },
            ..attachment
        },
        None => attachment,
    }
}

/// Draws the whole picture, or the given parts one after another.
pub(super) fn for_parts(
    pass: &mut wgpu::RenderPass<'_>,
    parts: Option<&[PixelRect]>,
    draw: impl Fn(&mut wgpu::RenderPass<'_>),
) {
    let Some(parts) = parts else {
        return draw(pass);
    };
    for [left, top, right, bottom] in parts.iter().copied() {
        if left < right && top < bottom {
            pass.set_scissor_rect(left, top, right - left, bottom - top);
            draw(pass);
        }
    }
}

pub(super) fn color_attachment(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: cleared(wgpu::Color::TRANSPARENT),
    }
}

fn cleared<V>(value: V) -> wgpu::Operations<V> {
    wgpu::Operations {
        load: wgpu::LoadOp::Clear(value),
        store: wgpu::StoreOp::Store,
    }
}
