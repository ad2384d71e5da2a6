// Values go where they belong at once: only texels are read that nobody writes in the same round. FORMAT is the storage
// format of the field, one that can be read and written.

struct Fill {
    ghost_count: u32,
    // 0: only owned texels count, 1: ghosts too
    with_ghosts: u32,
    row_length: u32,
    // Rows of the table for a ghost.
    rows: u32,
}

@group(1) @binding(0) var<uniform> fill: Fill;
@group(1) @binding(1) var field: texture_storage_2d_array<FORMAT, read_write>;

fn field_at(texel: vec2i, page: i32) -> vec4f {
    return textureLoad(field, texel, page);
}

fn slots_of(index: u32) -> vec4u {
    return vec4u(0u);
}

fn tap_at(texel: vec2i, page: i32, slot: u32) -> vec4f {
    return field_at(texel, page);
}

fn keep(index: u32, link: FillLink, value: vec4f) {
    textureStore(field, link.texel, link.own_page, value);
}
