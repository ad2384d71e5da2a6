// Values go to a buffer, since texels are read that others of the same round are to write. VALUE is what the storage format
// of the field holds, PARTS its components.

struct Fill {
    ghost_count: u32,
    // 0: only owned texels count, 1: ghosts too
    with_ghosts: u32,
    row_length: u32,
    // Rows of the table for a ghost.
    rows: u32,
}

@group(1) @binding(0) var<uniform> fill: Fill;
@group(1) @binding(1) var field: texture_2d_array<f32>;
@group(1) @binding(2) var<storage, read_write> values: array<VALUE>;

fn field_at(texel: vec2i, page: i32) -> vec4f {
    return textureLoad(field, texel, page, 0);
}

fn slots_of(index: u32) -> vec4u {
    return vec4u(0u);
}

fn tap_at(texel: vec2i, page: i32, slot: u32) -> vec4f {
    return field_at(texel, page);
}

fn keep(index: u32, link: FillLink, value: vec4f) {
    values[index] = value.PARTS;
}
