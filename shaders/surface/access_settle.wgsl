//! Reads and writes the field that ghosts are filled in, for the round after one whose values are in the buffer alone:
//! coupled ghosts are read from there, so that no texel is read that is written. The format of `StoredField` is one that can
//! be read and written.
//! @use atlas surface/fill
//! @given StoredField

@group(1) @binding(1) var field: StoredField;
@group(1) @binding(2) var<storage, read> values: array<f32>;

fn field_at(texel: vec2i, page: i32) -> vec4f {
    return textureLoad(field, texel, page);
}

// Slots of the four texels in the buffer; `EMPTY` for those that are not coupled.
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
