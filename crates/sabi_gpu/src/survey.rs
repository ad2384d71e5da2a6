//! Surveys: histograms of a mask by surface area.

use sabi_nodes::link::{Format, SURVEY_GROUPS};
use sabi_nodes::wgsl_struct;
use sabi_plan::Grouping;

use crate::bindings::{storage_entry, texture_entry, uniform_entry, write_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipelines::fixed_kernel;
use crate::pool::array_view;
use crate::run_options::RunOptions;
use crate::shaders::FixedShader;
use crate::surface::GpuSurface;
use crate::tiles::Slices;

/// Bins between the lowest and the highest value, as in `lib/survey.wgsl`.
pub(crate) const BINS: u32 = 1024;
/// Total count of the whole surface. It is half of the largest possible count, since the count of each texel is rounded.
const SURFACE_COUNT: f64 = (1_u32 << 31) as f64;

wgsl_struct! {
    "surface/survey_group" Survey:
    /// Constants of a survey.
    pub(crate) struct SurveyConstants {
        count_per_area: f32,
        each: u32,
        groups: u32,
        pad: u32,
    }
}

/// Writes the survey of a mask to a table; with groups, writes the survey of each group to a row of a table.
pub(crate) fn survey(
    gpu: &Gpu,
    surface: &GpuSurface,
    each: Grouping,
    [source, table]: [&wgpu::Texture; 2],
    options: &RunOptions<'_>,
) -> Result<(), GpuError> {
    let (number, groups) = match each {
        Grouping::Whole => (0, 1),
        Grouping::Part => (1, SURVEY_GROUPS),
        Grouping::Piece => (2, SURVEY_GROUPS),
        Grouping::Chart => (3, SURVEY_GROUPS),
    };
    let counts = gpu.guarded("the counts of a survey", |device| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("counts"),
            size: u64::from(4 * groups * (2 + BINS)),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })?;
    let mut start = vec![0_u32; (groups * (2 + BINS)) as usize];
    for group in start.chunks_exact_mut((2 + BINS) as usize) {
        group[0] = u32::MAX;
    }
    gpu.queue.write_buffer(&counts, 0, bytemuck::cast_slice(&start));
    let constants = SurveyConstants {
        count_per_area: (SURFACE_COUNT / surface.area.max(1e-30)) as f32,
        each: number,
        groups,
        pad: 0,
    };
    let constants = gpu.uniform(bytemuck::bytes_of(&constants));
    let (source, table) = (array_view(source), array_view(table));
    let view = wgpu::BindingResource::TextureView;
    let counts = counts.as_entire_binding();
    let slices = Slices::new(gpu, surface, options.submission);

    let entries = [uniform_entry(0), texture_entry(1), write_entry(2)];
    let kernel = fixed_kernel(gpu, FixedShader::SurveyRange, &entries)?;
    let resources = [constants.as_entire_binding(), view(&source), counts.clone()];
    let group = gpu.bind(&kernel.layout, resources);
    slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;

    let kernel = fixed_kernel(gpu, FixedShader::SurveyCount, &entries)?;
    let resources = [constants.as_entire_binding(), view(&source), counts.clone()];
    let group = gpu.bind(&kernel.layout, resources);
    slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;

    let entries = [uniform_entry(0), write_entry(1), storage_entry(2, Format::Rgba32Float)];
    let kernel = fixed_kernel(gpu, FixedShader::SurveySum, &entries)?;
    let resources = [constants.as_entire_binding(), counts, view(&table)];
    let group = gpu.bind(&kernel.layout, resources);
    slices.submit(&kernel.pipeline, &group, 0, groups.div_ceil(64));
    gpu.wait()
}
