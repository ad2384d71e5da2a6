//! The maps of a material on the linked atlas. Ghosts hold the values over a seam, so a place between four texels is read
//! alike on both sides of it.

struct BoundMaterial {
    // Values of channels without a map: base color and alpha; roughness, metallic, occlusion.
    color: vec4f,
    surface: vec4f,
}

@group(1) @binding(0) var<uniform> material: BoundMaterial;
// Base color and alpha, or a node's own result.
@group(1) @binding(1) var colors: texture_2d_array<f32>;
@group(1) @binding(2) var surfaces: texture_2d_array<f32>;
@group(1) @binding(3) var emissions: texture_2d_array<f32>;
@group(1) @binding(4) var normals: texture_2d_array<f32>;
@group(1) @binding(5) var heights: texture_2d_array<f32>;
// Share and roughness of a clear coat; tangent-space direction along which highlights are drawn out, and strength; color and
// roughness of a sheen; light that spreads below the surface, and transmission.
@group(1) @binding(6) var coats: texture_2d_array<f32>;
@group(1) @binding(7) var anisotropies: texture_2d_array<f32>;
@group(1) @binding(8) var sheens: texture_2d_array<f32>;
@group(1) @binding(9) var subsurfaces: texture_2d_array<f32>;
// For each chart: the offset of its texel coordinates from UVs times `texels_of_uv`, and its page.
@group(2) @binding(0) var charts: texture_2d<f32>;

// A place on a page.
struct Place {
    texel: vec2f,
    page: i32,
}

// The table of charts is two to the power of so many texels wide.
const CHART_BITS: u32 = 10u;

fn chart_row(chart: u32) -> vec4f {
    return textureLoad(charts, vec2u(chart & ((1u << CHART_BITS) - 1u), chart >> CHART_BITS), 0);
}

// Between the four texels around a place, by texel loads rather than a sampler: samplers of some adapters know only 256 steps
// between two texels, and the export reads none.
fn value_at(map: texture_2d_array<f32>, place: Place) -> vec4f {
    let at = place.texel - 0.5;
    let corner = floor(at);
    let weight = at - corner;
    let first = vec2i(corner);
    let a = textureLoad(map, first, place.page, 0);
    let b = textureLoad(map, first + vec2i(1, 0), place.page, 0);
    let c = textureLoad(map, first + vec2i(0, 1), place.page, 0);
    let d = textureLoad(map, first + vec2i(1, 1), place.page, 0);
    // Differences from one of them, so that a constant keeps its bits.
    let top = (b - a) * weight.x;
    let bottom = (c - a) + (d - c) * weight.x;
    return a + top + (bottom - top) * weight.y;
}
