//! Bind groups and pipelines of a scene.

use sabi_gpu::Gpu;
use sabi_nodes::wgsl_struct;

use super::{Renderer, choice};
use crate::error::ViewError;
use crate::frame::FrameUniforms;
use crate::pipelines::PipelineKey;
use crate::render_target::VisibilityBuffer;
use crate::scene::{Lines, MaterialLook, Mode, Scene, Shot};
use crate::shadows::ShadowMaps;

wgsl_struct! {
    "view/maps" BoundMaterial:
    /// Values of channels without a map.
    pub(crate) struct BoundMaterial {
        color: [f32; 4],
        surface: [f32; 4],
    }
}

wgsl_struct! {
    "view/lines" LineStyle:
    /// Looks of lines.
    pub(crate) struct LineStyle {
        color: [f32; 4],
        size: [f32; 2],
        nearer: f32,
        pad: f32,
    }
}

/// Triangles of one material, ready to be drawn.
pub(super) struct BoundRange {
    pub(super) pipeline: wgpu::RenderPipeline,
    pub(super) indices: std::ops::Range<u32>,
    /// Number of their look.
    pub(super) look: usize,
    /// Pipeline of their shadow, if their look has transparent places.
    pub(super) veiled_shadow: Option<wgpu::RenderPipeline>,
}

/// Bind group and pipeline of a look.
pub(super) struct BoundLook {
    pub(super) material: wgpu::BindGroup,
    pub(super) shading: wgpu::RenderPipeline,
}

/// Bind groups and pipelines shared by all samples of a picture.
pub(super) struct BoundScene {
    pub(super) looks: Vec<BoundLook>,
    pub(super) ranges: Vec<BoundRange>,
    pub(super) charts: wgpu::BindGroup,
    pub(super) panorama: wgpu::BindGroup,
    pub(super) background: Option<wgpu::RenderPipeline>,
    pub(super) lines: Vec<(Lines, wgpu::BindGroup, wgpu::RenderPipeline)>,
}

impl BoundScene {
    /// Returns true if light passes through some of the model.
    pub(super) fn is_veiled(&self) -> bool {
        self.ranges.iter().any(|range| range.veiled_shadow.is_some())
    }
}

impl Renderer {
    /// Bind group of the values shared by all shaders of a sample.
    pub(super) fn frame_group(
        &self,
        gpu: &Gpu,
        shadows: &ShadowMaps,
        scene: &Scene<'_>,
        frame: &FrameUniforms,
    ) -> Result<wgpu::BindGroup, ViewError> {
        let uniform = self.uniform(gpu, frame)?;
        let reflections = scene.environment.specular();
        let ground = scene.model.ground();
        let view = wgpu::BindingResource::TextureView;
        let resources = [
            uniform.as_entire_binding(),
            wgpu::BindingResource::Sampler(&self.linear_sampler),
            view(&reflections),
            view(&self.directional_albedo),
            view(&shadows.view),
            wgpu::BindingResource::Sampler(&self.shadow_sampler),
            view(ground.map_or(&self.open_ground, |ground| &ground.openness)),
        ];
        Ok(self.bind(gpu, &self.layouts().frame, resources))
    }

    /// Bind group of a visibility buffer.
    pub(super) fn visibility_group(
        &self,
        gpu: &Gpu,
        visibility: &VisibilityBuffer,
        scene: &Scene<'_>,
    ) -> wgpu::BindGroup {
        let record = visibility.record.create_view(&wgpu::TextureViewDescriptor::default());
        let depth = visibility.depth.create_view(&wgpu::TextureViewDescriptor {
            aspect: wgpu::TextureAspect::DepthOnly,
            ..Default::default()
        });
        let openness = scene.model.openness();
        let (open, charts) = match openness {
            Some(openness) => (&openness.texels, &openness.charts),
            None => (&self.empty_map, &scene.model.charts),
        };
        let views = [&scene.model.charts, &record, &depth, open, charts].map(wgpu::BindingResource::TextureView);
        self.bind(gpu, &self.layouts().visibility, views)
    }

    pub(super) fn bound(
        &self,
        gpu: &Gpu,
        size: [u32; 2],
        scene: &Scene<'_>,
        shot: &Shot,
    ) -> Result<BoundScene, ViewError> {
        let view = wgpu::BindingResource::TextureView;
        let panorama = scene.environment.backdrop();
        let charts = view(&scene.model.charts);
        let background = choice::background(scene, shot).map(|key| self.pipelines.get(gpu, key));
        let lines = |lines: &Lines| -> Result<_, ViewError> {
            let uniform = self.uniform(gpu, &line_style(*lines, shot, size))?;
            let group = self.bind(gpu, &self.layouts().uniform, [uniform.as_entire_binding()]);
            Ok((*lines, group, self.pipelines.get(gpu, PipelineKey::Lines)?))
        };
        Ok(BoundScene {
            looks: choice::looks(scene)
                .iter()
                .map(|look| {
                    Ok(BoundLook {
                        material: self.look_group(gpu, look, shot.mode)?,
                        shading: self.pipelines.get(gpu, choice::shading(look, scene, shot))?,
                    })
                })
                .collect::<Result<_, ViewError>>()?,
            ranges: self.bound_ranges(gpu, scene, shot)?,
            charts: self.bind(gpu, &self.layouts().charts, [charts]),
            panorama: self.bind(
                gpu,
                &self.layouts().panorama,
                [view(&panorama), wgpu::BindingResource::Sampler(&self.panorama_sampler)],
            ),
            background: background.transpose()?,
            lines: shot.lines.iter().map(lines).collect::<Result<_, _>>()?,
        })
    }

    /// Returns the triangles of the visible materials with their pipelines.
    fn bound_ranges(&self, gpu: &Gpu, scene: &Scene<'_>, shot: &Shot) -> Result<Vec<BoundRange>, ViewError> {
        let ranges = scene.model.ranges.iter();
        let visible = ranges.filter_map(|range| Some((range, choice::look_of(range, scene)?)));
        visible
            .map(|(range, (index, look))| {
                let veiled_shadow = choice::veiled_shadow(look, shot).map(|key| self.pipelines.get(gpu, key));
                Ok(BoundRange {
                    pipeline: self.pipelines.get(gpu, choice::raster(range, look, shot))?,
                    indices: range.indices.clone(),
                    look: index,
                    veiled_shadow: veiled_shadow.transpose()?,
                })
            })
            .collect()
    }

    fn look_group(&self, gpu: &Gpu, look: &MaterialLook, mode: Mode) -> Result<wgpu::BindGroup, ViewError> {
        let [roughness, metallic, occlusion] = look.surface;
        let values = BoundMaterial {
            color: look.color,
            surface: [roughness, metallic, occlusion, 0.0],
        };
        let uniform = self.uniform(gpu, &values)?;
        let views = look.bound_maps(mode).map(|map| match map {
            Some(map) => map.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            }),
            None => self.empty_map.clone(),
        });
        let resources = views.iter().map(wgpu::BindingResource::TextureView);
        let resources = std::iter::once(uniform.as_entire_binding()).chain(resources);
        Ok(self.bind(gpu, &self.layouts().material, resources))
    }
}

fn line_style(lines: Lines, shot: &Shot, [width, height]: [u32; 2]) -> LineStyle {
    let exposure = if shot.mode == Mode::Material {
        shot.exposure_stops.exp2()
    } else {
        1.0
    };
    let ([r, g, b], line_width) = match lines {
        Lines::Wires => ([0.02, 0.02, 0.025], 1.0),
        Lines::Seams => ([1.0, 0.35, 0.05], 2.5),
    };
    LineStyle {
        color: [r / exposure, g / exposure, b / exposure, line_width],
        size: [width as f32, height as f32],
        nearer: 1e-3,
        pad: 0.0,
    }
}
