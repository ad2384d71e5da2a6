//! A plane of a source's result that the device draws.

use sabi_nodes::link::Format;

use crate::device::Gpu;
use crate::error::GpuError;
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

/// Kernel with what it is given, and the tiles that it fills.
pub struct SourceDraw<'a, C> {
    /// The kernel.
    pub shader: SourceShader,
    /// Its constants; `()` for a kernel without any.
    pub constants: C,
    /// Its tables.
    pub tables: &'a [&'a DeviceTable],
    /// Tiles that it fills at most; none for all.
    pub tiles: Option<&'a TileSet>,
}

/// A plane of a source's result on the device, to be drawn.
pub struct SourceCanvas<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) surface: &'a GpuSurface,
    pub(crate) field: &'a wgpu::Texture,
    pub(crate) format: Format,
    /// Connected inputs, in the order of the kind.
    pub(crate) inputs: &'a [Option<wgpu::Texture>],
    /// Bound where an input is not connected.
    pub(crate) unused: &'a wgpu::Texture,
    /// Tiles that are needed; none for all.
    pub(crate) covered: Option<&'a TileSet>,
    pub(crate) options: &'a RunOptions<'a>,
}

impl SourceCanvas<'_> {
    /// Returns whether an input of the node is connected.
    pub fn has_input(&self, index: usize) -> bool {
        self.inputs.get(index).is_some_and(Option::is_some)
    }

    /// Most rows of a table.
    pub fn most_rows(&self) -> usize {
        most_table_rows(self.gpu)
    }

    /// Uploads a table, given by its rows of bit patterns.
    ///
    /// # Errors
    /// It has more rows than [`SourceCanvas::most_rows`], or the device refuses.
    pub fn table(&self, what: &'static str, rows: &[[u32; 4]]) -> Result<DeviceTable, GpuError> {
        let view = table_texture(self.gpu, what, bytemuck::cast_slice(rows))?;
        // The driver holds a copy until the upload is done, which must end before the next one is made.
        self.gpu.queue.submit([]);
        Ok(DeviceTable { view })
    }

    /// Fills texels of the plane, ghosts among them; those of other tiles stay as they are.
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
        let kernel = self
            .gpu
            .fixed_kernel(FixedShader::Source(shader, self.format), &shader.entries(self.format))?;
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
