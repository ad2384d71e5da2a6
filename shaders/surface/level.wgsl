//! Ratio between a level and the finest one, for kernels that bring planes from one to the other.

struct Scale {
    // Finer texels along a side of a coarser one.
    factor: u32,
    // Spacing of points, working units.
    spacing: f32,
    pad_0: u32,
    pad_1: u32,
}

@group(1) @binding(0) var<uniform> scale: Scale;
