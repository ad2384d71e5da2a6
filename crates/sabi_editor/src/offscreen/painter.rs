//! Paints frames onto a texture in place of a screen.

use eframe::egui_wgpu::{RenderState, ScreenDescriptor};
use egui::epaint::ImageDelta;
use egui::{ClippedPrimitive, TextureId, Vec2};

/// Texture that frames are painted on.
pub(super) struct FramePainter {
    render: RenderState,
    screen: wgpu::TextureView,
    size: [u32; 2],
}

impl FramePainter {
    pub(super) fn new(render: RenderState, size: Vec2) -> FramePainter {
        let size = [size.x, size.y].map(|side| (side as u32).max(1));
        let [width, height] = size;
        let screen = render.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("screen"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: render.target_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        FramePainter {
            screen: screen.create_view(&wgpu::TextureViewDescriptor::default()),
            render,
            size,
        }
    }

    /// Uploads textures that a frame has changed.
    pub(super) fn upload(&self, changed: &[(TextureId, ImageDelta)]) {
        let mut renderer = self.render.renderer.write();
        for (id, delta) in changed {
            renderer.update_texture(&self.render.device, &self.render.queue, *id, delta);
        }
    }

    /// Frees textures that are not used after a frame.
    pub(super) fn free(&self, textures: &[TextureId]) {
        let mut renderer = self.render.renderer.write();
        for id in textures {
            renderer.free_texture(id);
        }
    }

    /// Submits a frame to the device.
    pub(super) fn paint(&self, primitives: &[ClippedPrimitive]) {
        let RenderState {
            device,
            queue,
            renderer,
            ..
        } = &self.render;
        let descriptor = ScreenDescriptor {
            size_in_pixels: self.size,
            pixels_per_point: 1.0,
        };
        let mut renderer = renderer.write();
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        renderer.update_buffers(device, queue, &mut encoder, primitives, &descriptor);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("window"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.screen,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        renderer.render(&mut pass.forget_lifetime(), primitives, &descriptor);
        queue.submit([encoder.finish()]);
    }
}
