//! Reads and writes the field that ghosts are filled in, for rounds that read no texel that they write. The format of
//! `StoredField` is one that can be read and written.
//! @use atlas surface/fill
//! @given StoredField

@group(1) @binding(1) var field: StoredField;

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
