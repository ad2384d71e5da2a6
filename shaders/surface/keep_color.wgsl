//! Keeps filled values of textures with four components in a buffer. Linked with `access_gather.wgsl`.
//! @use atlas

@group(1) @binding(2) var<storage, read_write> values: array<vec4f>;

fn keep(index: u32, link: FillLink, value: vec4f) {
    values[index] = value;
}
