//! Reads the field that ghosts are filled in, for rounds whose values go to a buffer first, since texels are read that
//! others of the same round are to write. `keep_number.wgsl` or `keep_color.wgsl` writes the buffer.
//! @use atlas surface/fill

@group(1) @binding(1) var field: texture_2d_array<f32>;

fn field_at(texel: vec2i, page: i32) -> vec4f {
    return textureLoad(field, texel, page, 0);
}

fn slots_of(index: u32) -> vec4u {
    return vec4u(0u);
}

fn tap_at(texel: vec2i, page: i32, slot: u32) -> vec4f {
    return field_at(texel, page);
}
