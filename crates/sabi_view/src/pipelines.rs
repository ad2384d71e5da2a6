//! Pipelines that draw a picture, and their bind group layouts.

mod layouts;
mod recipe;
mod switches;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

use sabi_gpu::{Gpu, GpuError};

use crate::edges::Line;
use crate::model::Corner;
use crate::shaders::ViewShader;
use crate::shadows::SHADOW;
use crate::target::{LIGHT, SEEN, SHOWN, SUM};
pub(crate) use layouts::Layouts;
use recipe::{CORNER, ENDS, PLACE_ONLY, Recipe, depth, pipeline, rows_of};
pub(crate) use switches::{MAP_BITS, SHOWN_COLOR, SHOWN_VECTOR, Switches};

/// Purpose of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Draws {
    /// Rasterizes the model: the visible place of each pixel.
    Raster {
        is_double_sided: bool,
        ground: Ground,
        switches: Switches,
    },
    /// Lights the pixels of the model.
    Paint(Paint, Switches),
    /// The environment behind the model.
    Background {
        is_blurred: bool,
    },
    Lines,
    /// Depth of the model from a light.
    Shadow,
    /// Adds a sample to the sum of those before.
    Gather(Transform),
    /// Encodes the only sample.
    Encode(Transform),
    /// Encodes the mean of the samples.
    EncodeSum,
}

/// View transform: `TRANSFORM` of `display.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Transform(pub(crate) u32);

impl Transform {
    pub(crate) const STANDARD: Transform = Transform(0);
    pub(crate) const AGX: Transform = Transform(1);
    pub(crate) const ACES: Transform = Transform(2);
    /// For pictures that are encoded already.
    pub(crate) const ENCODED: Transform = Transform(3);
}

/// Properties of the surface that decide which place a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Ground {
    /// Triangles alone.
    Plain,
    /// Transparency.
    Veiled,
    /// Heights.
    Relief,
    /// Both.
    VeiledRelief,
}

/// Shading of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Paint {
    Lit,
    /// Lit, with shadows of the heights.
    LitRelief,
    /// A view other than the lit material.
    Shown,
}

/// The device, and the module whose entry points a pipeline runs.
type Part<'a> = (&'a wgpu::Device, &'a wgpu::ShaderModule);

impl Draws {
    /// Module with the entry points.
    fn shader(self) -> ViewShader {
        match self {
            Draws::Raster { .. } => ViewShader::Raster,
            Draws::Paint(..) => ViewShader::Paint,
            Draws::Background { .. } => ViewShader::Background,
            Draws::Lines => ViewShader::Lines,
            Draws::Shadow => ViewShader::CastShadow,
            Draws::Gather(_) | Draws::Encode(_) | Draws::EncodeSum => ViewShader::Display,
        }
    }
}

/// All pipelines of a renderer, each made when it is first used.
pub(crate) struct Pipelines {
    pub(crate) layouts: Layouts,
    /// Bind group layout of a surface.
    surface: wgpu::BindGroupLayout,
    made: Mutex<BTreeMap<Draws, wgpu::RenderPipeline>>,
    /// Compiled shader modules.
    modules: Mutex<BTreeMap<ViewShader, wgpu::ShaderModule>>,
}

impl Pipelines {
    /// Creates all layouts, and no pipeline yet.
    pub(crate) fn new(gpu: &Gpu) -> Result<Pipelines, GpuError> {
        Ok(Pipelines {
            layouts: gpu.guarded("the viewport's layouts", Layouts::new)?,
            surface: gpu.surface_layout().clone(),
            made: Mutex::default(),
            modules: Mutex::default(),
        })
    }

    /// Pipelines of a list that are not compiled yet, each once.
    pub(crate) fn missing(&self, wanted: Vec<Draws>) -> BTreeSet<Draws> {
        let mut missing: BTreeSet<Draws> = wanted.into_iter().collect();
        if let Ok(made) = self.made.lock() {
            missing.retain(|draws| !made.contains_key(draws));
        }
        missing
    }

    /// Pipeline of a purpose, compiled when it is first used.
    pub(crate) fn get(&self, gpu: &Gpu, draws: Draws) -> Result<wgpu::RenderPipeline, GpuError> {
        if let Ok(made) = self.made.lock()
            && let Some(known) = made.get(&draws)
        {
            return Ok(known.clone());
        }
        let module = self.module(gpu, draws.shader())?;
        let made = gpu.guarded("the viewport's pipelines", |device| self.make(device, &module, draws));
        if made.is_err()
            && let Ok(mut modules) = self.modules.lock()
        {
            // A module may have caused the failure.
            modules.clear();
        }
        let made = made?;
        if let Ok(mut known) = self.made.lock() {
            known.insert(draws, made.clone());
        }
        Ok(made)
    }

    fn make(&self, device: &wgpu::Device, module: &wgpu::ShaderModule, draws: Draws) -> wgpu::RenderPipeline {
        let part: Part<'_> = (device, module);
        match draws {
            Draws::Raster {
                is_double_sided,
                ground,
                switches,
            } => self.raster(part, is_double_sided, ground, switches),
            Draws::Paint(paint, switches) => self.paint(part, paint, switches),
            Draws::Background { is_blurred } => self.background(part, is_blurred),
            Draws::Lines => self.lines(part),
            Draws::Shadow => self.shadow(part),
            Draws::Gather(transform) => self.display(part, "gather", SUM, transform),
            Draws::Encode(transform) => self.display(part, "encode", SHOWN, transform),
            // The sum went through the transform already.
            Draws::EncodeSum => self.display(part, "encode_sum", SHOWN, Transform::STANDARD),
        }
    }

    /// A shader module, compiled when it is first used.
    fn module(&self, gpu: &Gpu, shader: ViewShader) -> Result<wgpu::ShaderModule, GpuError> {
        if let Ok(modules) = self.modules.lock()
            && let Some(known) = modules.get(&shader)
        {
            return Ok(known.clone());
        }
        let compiled = gpu.shader_module(&shader.spec())?;
        if let Ok(mut modules) = self.modules.lock() {
            modules.insert(shader, compiled.clone());
        }
        Ok(compiled)
    }

    fn raster(
        &self,
        (device, module): Part<'_>,
        is_double_sided: bool,
        ground: Ground,
        switches: Switches,
    ) -> wgpu::RenderPipeline {
        let Layouts {
            frame,
            material,
            charts,
            ..
        } = &self.layouts;
        let groups = [frame, material, charts, &self.surface];
        let (entry, groups) = match ground {
            Ground::Plain => ("lay", &groups[..3]),
            Ground::Veiled => ("lay_veiled", &groups[..3]),
            Ground::Relief => ("lay_relief", &groups[..]),
            Ground::VeiledRelief => ("lay_veiled_relief", &groups[..]),
        };
        pipeline(
            device,
            &Recipe {
                label: "raster",
                module,
                entries: ("place_corner", Some(entry)),
                switches: &switches.named(),
                groups,
                corners: &[rows_of::<Corner>(&CORNER, wgpu::VertexStepMode::Vertex)],
                targets: &[SEEN; 2],
                cull: (!is_double_sided).then_some(wgpu::Face::Back),
                depth: Some(depth(
                    wgpu::CompareFunction::Greater,
                    wgpu::CompareFunction::Always,
                    true,
                )),
            },
        )
    }

    fn paint(&self, (device, module): Part<'_>, paint: Paint, switches: Switches) -> wgpu::RenderPipeline {
        let Layouts {
            frame, material, seen, ..
        } = &self.layouts;
        let groups = [frame, material, seen, &self.surface];
        let entry = match paint {
            Paint::Lit => "paint",
            Paint::LitRelief => "paint_relief",
            Paint::Shown => "paint_shown",
        };
        pipeline(
            device,
            &Recipe {
                label: "paint",
                module,
                entries: ("cover", Some(entry)),
                switches: &switches.named(),
                groups: &groups,
                corners: &[],
                targets: &[LIGHT],
                cull: None,
                depth: Some(depth(
                    wgpu::CompareFunction::Always,
                    wgpu::CompareFunction::Equal,
                    false,
                )),
            },
        )
    }

    fn background(&self, (device, module): Part<'_>, is_blurred: bool) -> wgpu::RenderPipeline {
        let paint = if is_blurred { "paint_blurred" } else { "paint" };
        pipeline(
            device,
            &Recipe {
                label: "background",
                module,
                entries: ("cover", Some(paint)),
                switches: &[],
                groups: &[&self.layouts.frame, &self.layouts.panorama],
                corners: &[],
                targets: &[LIGHT],
                cull: None,
                depth: Some(depth(
                    wgpu::CompareFunction::Always,
                    wgpu::CompareFunction::Equal,
                    false,
                )),
            },
        )
    }

    fn lines(&self, (device, module): Part<'_>) -> wgpu::RenderPipeline {
        pipeline(
            device,
            &Recipe {
                label: "lines",
                module,
                entries: ("place_end", Some("paint")),
                switches: &[],
                groups: &[&self.layouts.frame, &self.layouts.numbers],
                corners: &[rows_of::<Line>(&ENDS, wgpu::VertexStepMode::Instance)],
                targets: &[LIGHT],
                cull: None,
                depth: Some(depth(
                    wgpu::CompareFunction::GreaterEqual,
                    wgpu::CompareFunction::Always,
                    false,
                )),
            },
        )
    }

    fn shadow(&self, (device, module): Part<'_>) -> wgpu::RenderPipeline {
        pipeline(
            device,
            &Recipe {
                label: "shadow",
                module,
                entries: ("place_corner", None),
                switches: &[],
                groups: &[&self.layouts.numbers],
                corners: &[rows_of::<Corner>(&PLACE_ONLY, wgpu::VertexStepMode::Vertex)],
                targets: &[],
                cull: None,
                depth: Some(wgpu::DepthStencilState {
                    format: SHADOW,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
            },
        )
    }

    fn display(
        &self,
        (device, module): Part<'_>,
        paint: &str,
        target: wgpu::TextureFormat,
        Transform(transform): Transform,
    ) -> wgpu::RenderPipeline {
        pipeline(
            device,
            &Recipe {
                label: "display",
                module,
                entries: ("cover", Some(paint)),
                switches: &[("TRANSFORM", f64::from(transform))],
                groups: &[&self.layouts.display],
                corners: &[],
                targets: &[target],
                cull: None,
                depth: None,
            },
        )
    }
}
