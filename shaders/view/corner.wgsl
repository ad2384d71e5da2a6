//! Corners of the model's triangles, and the values that the raster interpolates between them.

struct Corner {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    // w is the sign of the bitangent.
    @location(2) tangent: vec4f,
    // Texel coordinates on the chart's page.
    @location(3) texel: vec2f,
    @location(4) chart: u32,
}

struct Seen {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec3f,
    @location(3) texel: vec2f,
    // Twice the chart's number, and 1 more where the bitangent's sign is negative.
    @location(4) @interpolate(flat) chart: u32,
}
