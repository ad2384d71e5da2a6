//! Keeps filled values of textures with one component in a buffer. Linked with `access_gather.wgsl`.
//! @use atlas

@group(1) @binding(2) var<storage, read_write> values: array<f32>;

fn keep(index: u32, link: FillLink, value: vec4f) {
    values[index] = value.x;
}
