//! Plane of a source's result that the device draws.

use sabi_nodes::link::Format;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipelines::fixed_kernel;
use crate::pool::array_view;
use crate::run_options::RunOptions;
use crate::shaders::FixedShader;
use crate::source_shader::SourceShader;
use crate::surface::GpuSurface;
use crate::tile_set::TileSet;
use crate::tiles::Slices;
use crate::uploads::{most_table_rows, table_texture};

/// Table of rows of four numbers on the device.
#[derive(Clone, Debug)]
pub struct DeviceTable {
    view: wgpu::TextureView,
}

/// Kernel with its constants and tables, and the tiles that it fills.
pub struct SourceDraw<'a, C> {
    /// The kernel.
    pub shader: SourceShader,
    /// Its constants; `()` for a kernel without any.
    pub constants: C,
    /// Its tables.
    pub tables: &'a [&'a DeviceTable],
    /// Tiles to which it is limited; `None` for all.
    pub tiles: Option<&'a TileSet>,
}

/// Plane of a source's result, to be drawn on the device.
pub struct SourceCanvas<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) surface: &'a GpuSurface,
    pub(crate) field: &'a wgpu::Texture,
    pub(crate) format: Format,
    /// Connected inputs, in the order in which the kind declares its inputs.
    pub(crate) inputs: &'a [Option<wgpu::Texture>],
    /// Texture that is bound for inputs that are not connected.
    pub(crate) unused: &'a wgpu::Texture,
    /// Tiles that are needed; `None` for all.
    pub(crate) covered: Option<&'a TileSet>,
    pub(crate) options: &'a RunOptions<'a>,
}

impl SourceCanvas<'_> {
    /// Returns whether an input of the node is connected.
    pub fn has_input(&self, index: usize) -> bool {
        self.inputs.get(index).is_some_and(Option::is_some)
    }

    /// Returns the maximum number of rows of a table.
    pub fn most_rows(&self) -> usize {
        most_table_rows(self.gpu)
    }

    /// Uploads a table of rows of bit patterns.
    ///
    /// # Errors
    /// It has more rows than [`SourceCanvas::most_rows`], or the device refuses.
    pub fn table(&self, what: &'static str, rows: &[[u32; 4]]) -> Result<DeviceTable, GpuError> {
        let view = table_texture(self.gpu, what, bytemuck::cast_slice(rows))?;
        // The driver holds a copy until the upload is done, so the upload has to end before the next table is built.
        self.gpu.queue.submit([]);
        Ok(DeviceTable { view })
    }

    /// Fills texels of the plane, including ghosts. Texels of other tiles are not changed.
    ///
    /// # Errors
    /// The run is canceled, or the device refuses.
    pub fn draw<C: bytemuck::NoUninit>(&self, draw: &SourceDraw<'_, C>) -> Result<(), GpuError> {
        let shader = draw.shader;
        debug_assert_eq!(draw.tables.len(), shader.tables(), "{}", shader.label());
        let both = match (draw.tiles, self.covered) {
            (Some(own), Some(covered)) => Some(own.within(covered)),
            (own, covered) => own.or(covered).cloned(),
        };
        let slices = match &both {
            Some(tiles) => Slices::over(self.gpu, self.surface, tiles, self.options.submission)?,
            None => Slices::new(self.gpu, self.surface, self.options.submission),
        };
        let fixed = FixedShader::Source(shader, self.format);
        let kernel = fixed_kernel(self.gpu, fixed, &shader.entries(self.format))?;
        let bytes = bytemuck::bytes_of(&draw.constants);
        let constants = (!bytes.is_empty()).then(|| self.gpu.uniform(bytes));
        let inputs: Vec<wgpu::TextureView> = (0..shader.inputs())
            .map(|index| array_view(self.inputs.get(index).and_then(Option::as_ref).unwrap_or(self.unused)))
            .collect();
        let field = array_view(self.field);
        let tables = draw.tables.iter().map(|table| &table.view);
        let views = tables.chain(&inputs).chain([&field]);
        let resources = constants
            .iter()
            .map(wgpu::Buffer::as_entire_binding)
            .chain(views.map(wgpu::BindingResource::TextureView));
        let group = self.gpu.bind(&kernel.layout, resources);
        slices.run(&kernel.pipeline, &kernel.pace, &group, self.options.is_canceled)?;
        Ok(())
    }
}
