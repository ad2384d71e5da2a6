//! Pipelines that draw a picture, and their bind group layouts.

mod keys;
mod layouts;
mod options;
mod switches;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

use sabi_gpu::{Gpu, GpuError, shader_module};

use crate::edges::Line;
use crate::model::Vertex;
use crate::render_target::{LIGHT_FORMAT, PICTURE_FORMAT, SUM_FORMAT, VISIBILITY_FORMAT};
use crate::shaders::ViewShader;
use crate::shadows::SHADOW_FORMAT;
pub(crate) use keys::{Backdrop, BackgroundKey, BloomStep, Development, PipelineKey, Shading, Transform};
pub(crate) use layouts::Layouts;
use options::{
    LINE_ATTRIBUTES, POSITION_ATTRIBUTE, PipelineOptions, VERTEX_ATTRIBUTES, depth, pipeline, vertex_buffer,
};
pub(crate) use switches::{MAP_BITS, RasterVariant, SHOWN_COLOR, SHOWN_VECTOR, Switches};

/// All pipelines of a renderer. Each is created when it is first used.
pub(crate) struct Pipelines {
    pub(crate) layouts: Layouts,
    /// Bind group layout of a surface.
    surface: wgpu::BindGroupLayout,
    made: Mutex<BTreeMap<PipelineKey, wgpu::RenderPipeline>>,
    /// Compiled shader modules.
    modules: Mutex<BTreeMap<ViewShader, wgpu::ShaderModule>>,
}

impl Pipelines {
    /// Creates all layouts and no pipelines.
    pub(crate) fn new(gpu: &Gpu) -> Result<Pipelines, GpuError> {
        Ok(Pipelines {
            layouts: gpu.guarded("the viewport's layouts", Layouts::new)?,
            surface: gpu.surface_layout().clone(),
            made: Mutex::default(),
            modules: Mutex::default(),
        })
    }

    /// Returns those of the pipelines that have not been compiled yet, without repeats.
    pub(crate) fn missing(&self, wanted: Vec<PipelineKey>) -> BTreeSet<PipelineKey> {
        let mut missing: BTreeSet<PipelineKey> = wanted.into_iter().collect();
        if let Ok(made) = self.made.lock() {
            missing.retain(|key| !made.contains_key(key));
        }
        missing
    }

    /// Returns the pipeline with this key. It is compiled when it is first used.
    pub(crate) fn get(&self, gpu: &Gpu, key: PipelineKey) -> Result<wgpu::RenderPipeline, GpuError> {
        if let Ok(made) = self.made.lock()
            && let Some(known) = made.get(&key)
        {
            return Ok(known.clone());
        }
        let module = self.module(gpu, key.shader())?;
        let made = gpu.guarded("the viewport's pipelines", |device| self.make(device, &module, key));
        if made.is_err()
            && let Ok(mut modules) = self.modules.lock()
        {
            // The modules are dropped as well, since one of them may have caused the failure.
            modules.clear();
        }
        let made = made?;
        if let Ok(mut known) = self.made.lock() {
            known.insert(key, made.clone());
        }
        Ok(made)
    }

    fn make(&self, device: &wgpu::Device, module: &wgpu::ShaderModule, key: PipelineKey) -> wgpu::RenderPipeline {
        match key {
            PipelineKey::Raster {
                is_double_sided,
                variant,
                switches,
            } => self.raster(device, module, is_double_sided, variant, switches),
            PipelineKey::Shade(shading, switches) => self.shade(device, module, shading, switches),
            PipelineKey::Background(backing) => self.background(device, module, backing),
            PipelineKey::Lines => self.lines(device, module),
            PipelineKey::Shadow(veiled) => self.shadow(device, module, veiled),
            PipelineKey::Bloom(step) => self.bloom(device, module, step),
            PipelineKey::Accumulate(development) => {
                self.display(device, module, "gather", SUM_FORMAT, development, None)
            }
            PipelineKey::Encode(development) => {
                self.display(device, module, "encode", PICTURE_FORMAT, development, None)
            }
            PipelineKey::EncodeModel(development) => {
                let on_model = depth(wgpu::CompareFunction::Always, wgpu::CompareFunction::NotEqual, false);
                self.display(device, module, "encode", PICTURE_FORMAT, development, Some(on_model))
            }
            // Samples are already transformed when they are summed.
            PipelineKey::EncodeMean => {
                self.display(device, module, "encode_sum", PICTURE_FORMAT, Development::DONE, None)
            }
        }
    }

    /// Returns a shader module. It is compiled when it is first used.
    fn module(&self, gpu: &Gpu, shader: ViewShader) -> Result<wgpu::ShaderModule, GpuError> {
        if let Ok(modules) = self.modules.lock()
            && let Some(known) = modules.get(&shader)
        {
            return Ok(known.clone());
        }
        let compiled = shader_module(gpu, &shader.spec())?;
        if let Ok(mut modules) = self.modules.lock() {
            modules.insert(shader, compiled.clone());
        }
        Ok(compiled)
    }

    fn raster(
        &self,
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        is_double_sided: bool,
        variant: RasterVariant,
        switches: Switches,
    ) -> wgpu::RenderPipeline {
        let Layouts {
            frame,
            material,
            charts,
            ..
        } = &self.layouts;
        let groups = [frame, material, charts, &self.surface];
        let (entry, groups) = match variant {
            RasterVariant::Opaque => ("lay", &groups[..3]),
            RasterVariant::Transparent => ("lay_veiled", &groups[..3]),
            RasterVariant::Relief => ("lay_relief", &groups[..]),
            RasterVariant::TransparentRelief => ("lay_veiled_relief", &groups[..]),
        };
        pipeline(
            device,
            &PipelineOptions {
                label: "raster",
                module,
                entries: ("place_corner", Some(entry)),
                switches: &switches.named(),
                groups,
                vertex_buffers: &[vertex_buffer::<Vertex>(
                    &VERTEX_ATTRIBUTES,
                    wgpu::VertexStepMode::Vertex,
                )],
                targets: &[VISIBILITY_FORMAT; 2],
                cull: (!is_double_sided).then_some(wgpu::Face::Back),
                depth: Some(depth(
                    wgpu::CompareFunction::Greater,
                    wgpu::CompareFunction::Always,
                    true,
                )),
            },
        )
    }

    fn shade(
        &self,
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        shading: Shading,
        switches: Switches,
    ) -> wgpu::RenderPipeline {
        let Layouts {
            frame,
            material,
            visibility,
            ..
        } = &self.layouts;
        let groups = [frame, material, visibility, &self.surface];
        let entry = match shading {
            Shading::Lit => "paint",
            Shading::LitRelief => "paint_relief",
            Shading::Unlit => "paint_shown",
        };
        pipeline(
            device,
            &PipelineOptions {
                label: "shade",
                module,
                entries: ("cover", Some(entry)),
                switches: &switches.named(),
                groups: &groups,
                vertex_buffers: &[],
                targets: &[LIGHT_FORMAT],
                cull: None,
                depth: Some(depth(
                    wgpu::CompareFunction::Always,
                    wgpu::CompareFunction::Equal,
                    false,
                )),
            },
        )
    }

    fn background(
        &self,
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        backing: BackgroundKey,
    ) -> wgpu::RenderPipeline {
        let Backdrop(backdrop) = backing.backdrop;
        let mut switches = vec![
            ("BACKDROP", f64::from(backdrop)),
            ("GROUND", f64::from(u8::from(backing.has_ground))),
        ];
        switches.extend(backing.switches.of_lights());
        pipeline(
            device,
            &PipelineOptions {
                label: "background",
                module,
                entries: ("cover", Some("paint")),
                switches: &switches,
                groups: &[&self.layouts.frame, &self.layouts.panorama],
                vertex_buffers: &[],
                targets: &[LIGHT_FORMAT],
                cull: None,
                depth: Some(depth(
                    wgpu::CompareFunction::Always,
                    wgpu::CompareFunction::Equal,
                    false,
                )),
            },
        )
    }

    fn lines(&self, device: &wgpu::Device, module: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
        pipeline(
            device,
            &PipelineOptions {
                label: "lines",
                module,
                entries: ("place_end", Some("paint")),
                switches: &[],
                groups: &[&self.layouts.frame, &self.layouts.uniform],
                vertex_buffers: &[vertex_buffer::<Line>(&LINE_ATTRIBUTES, wgpu::VertexStepMode::Instance)],
                targets: &[LIGHT_FORMAT],
                cull: None,
                depth: Some(depth(
                    wgpu::CompareFunction::GreaterEqual,
                    wgpu::CompareFunction::Always,
                    false,
                )),
            },
        )
    }

    fn shadow(
        &self,
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        veiled: Option<Switches>,
    ) -> wgpu::RenderPipeline {
        let groups = [&self.layouts.uniform, &self.layouts.material, &self.layouts.charts];
        let (entries, groups, attributes) = match veiled {
            Some(_) => (
                ("place_veiled", Some("pass_clear")),
                &groups[..],
                &VERTEX_ATTRIBUTES[..],
            ),
            None => (("place_corner", None), &groups[..1], &POSITION_ATTRIBUTE[..]),
        };
        let switches = veiled.map(Switches::named);
        pipeline(
            device,
            &PipelineOptions {
                label: "shadow",
                module,
                entries,
                switches: switches.as_ref().map_or(&[], |switches| &switches[..]),
                groups,
                vertex_buffers: &[vertex_buffer::<Vertex>(attributes, wgpu::VertexStepMode::Vertex)],
                targets: &[],
                cull: None,
                depth: Some(wgpu::DepthStencilState {
                    format: SHADOW_FORMAT,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
            },
        )
    }

    fn bloom(&self, device: &wgpu::Device, module: &wgpu::ShaderModule, step: BloomStep) -> wgpu::RenderPipeline {
        pipeline(
            device,
            &PipelineOptions {
                label: "bloom",
                module,
                entries: ("cover", Some(step.entry())),
                switches: &[],
                groups: &[&self.layouts.bloom],
                vertex_buffers: &[],
                targets: &[LIGHT_FORMAT],
                cull: None,
                depth: None,
            },
        )
    }

    fn display(
        &self,
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        entry: &str,
        target: wgpu::TextureFormat,
        development: Development,
        depth: Option<wgpu::DepthStencilState>,
    ) -> wgpu::RenderPipeline {
        let Transform(transform) = development.transform;
        pipeline(
            device,
            &PipelineOptions {
                label: "display",
                module,
                entries: ("cover", Some(entry)),
                switches: &[
                    ("TRANSFORM", f64::from(transform)),
                    ("BLOOM", f64::from(u8::from(development.has_bloom))),
                ],
                groups: &[&self.layouts.display],
                vertex_buffers: &[],
                targets: &[target],
                cull: None,
                depth,
            },
        )
    }
}
