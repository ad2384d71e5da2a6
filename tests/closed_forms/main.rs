//! Closed forms: results whose value is known without running a kernel.

mod blending;
mod casters;
mod cells;
mod colors;
mod curves;
mod filters;
mod heat;
mod image;
mod marks;
mod materials;
mod model_copy;
mod noise;
mod one_sheet;
mod predecessor;
mod predecessor_maps;
mod rays;
mod reexport;
mod relief;
mod relief_seams;
mod survey;
mod texture_sets;
mod vertex_color;
mod waves;
mod wood;
