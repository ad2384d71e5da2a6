// The round after one whose values are in the buffer alone: what is coupled is read from there, and so nobody reads a texel
// that is written. FORMAT is the storage format of the field, one that can be read and written.

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
@group(1) @binding(2) var<storage, read> values: array<f32>;

fn field_at(texel: vec2i, page: i32) -> vec4f {
    return textureLoad(field, texel, page);
}

// Where the buffer holds the four, each where it is coupled.
fn slots_of(index: u32) -> vec4u {
    return textureLoad(ghosts, table_texel(index * fill.rows + 2u), 0);
}

fn tap_at(texel: vec2i, page: i32, slot: u32) -> vec4f {
    if slot != EMPTY {
        return vec4f(values[slot], 0.0, 0.0, 1.0);
    }
    return field_at(texel, page);
}

fn keep(index: u32, link: FillLink, value: vec4f) {
    textureStore(field, link.texel, link.own_page, value);
}
