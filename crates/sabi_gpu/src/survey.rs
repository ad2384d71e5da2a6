//! Surveys: histograms of a mask by surface area.

use sabi_nodes::link::Format;
use sabi_nodes::wgsl_struct;

use crate::bindings::{storage_entry, texture_entry, uniform_entry, write_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pool::{Extent, array_view};
use crate::run_options::RunOptions;
use crate::shaders::FixedShader;
use crate::surface::GpuSurface;
use crate::tiles::Slices;

/// Bins between the lowest and the highest value, as in `lib/survey.wgsl`.
pub(crate) const BINS: u32 = 1024;
/// Extent of a survey's table: one texel per bin.
pub(crate) const SURVEY_EXTENT: Extent = [BINS, 1, 1];
/// Count of the whole surface: half of the highest count, since the count of each texel is rounded.
const SURFACE_COUNT: f64 = (1_u32 << 31) as f64;

wgsl_struct! {
    "surface/survey_count" Survey:
    /// Constants of a survey.
    pub(crate) struct SurveyConstants {
        count_per_area: f32,
        pad: [f32; 3],
    }
}

impl Gpu {
    /// Writes the survey of a mask to a table.
    pub(crate) fn survey(
        &self,
        surface: &GpuSurface,
        [source, table]: [&wgpu::Texture; 2],
        options: &RunOptions<'_>,
    ) -> Result<(), GpuError> {
        let counts = self.guarded("the counts of a survey", |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("counts"),
                size: u64::from(4 * (2 + BINS)),
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        })?;
        let mut start = vec![0_u32; 2 + BINS as usize];
        start[0] = u32::MAX;
        self.queue.write_buffer(&counts, 0, bytemuck::cast_slice(&start));
        let constants = SurveyConstants {
            count_per_area: (SURFACE_COUNT / surface.area.max(1e-30)) as f32,
            pad: [0.0; 3],
        };
        let constants = self.uniform(bytemuck::bytes_of(&constants));
        let (source, table) = (array_view(source), array_view(table));
        let view = wgpu::BindingResource::TextureView;
        let counts = counts.as_entire_binding();
        let slices = Slices::new(self, surface, options.submission);

        let kernel = self.fixed_kernel(FixedShader::SurveyRange, &[texture_entry(0), write_entry(1)])?;
        let group = self.bind(&kernel.layout, [view(&source), counts.clone()]);
        slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;

        let entries = [uniform_entry(0), texture_entry(1), write_entry(2)];
        let kernel = self.fixed_kernel(FixedShader::SurveyCount, &entries)?;
        let resources = [constants.as_entire_binding(), view(&source), counts.clone()];
        let group = self.bind(&kernel.layout, resources);
        slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;

        let entries = [write_entry(0), storage_entry(1, Format::Rgba32Float)];
        let kernel = self.fixed_kernel(FixedShader::SurveySum, &entries)?;
        let group = self.bind(&kernel.layout, [counts, view(&table)]);
        slices.submit(&kernel.pipeline, &group, 0, 1);
        self.wait()
    }
}
