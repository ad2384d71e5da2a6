//! Lowest and highest value of one component over each tile, as keys that sort like the values, and the number of texels that
//! hold no number.
//! @use atlas surface/place surface/sorted

struct Asked {
    // Component of a texel, and the first of the three values of the first tile.
    component: u32,
    place: u32,
    pad_0: u32,
    pad_1: u32,
}

@group(1) @binding(0) var<uniform> asked: Asked;
@group(1) @binding(1) var source: texture_2d_array<f32>;
@group(1) @binding(2) var<storage, read_write> found: array<atomic<u32>>;

const INFINITY_BITS: u32 = 0x7f800000u;

// One row of a tile for each invocation.
@compute @workgroup_size(8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) row: u32) {
    var lowest = 0xffffffffu;
    var highest = 0u;
    var not_numbers = 0u;
    for (var column = 0u; column < 8u; column++) {
        let texel = texel_of(group, vec3u(column, row, 0u));
        let owner = owner_of(texel);
        let is_on_surface = owner != EMPTY && (owner & GHOST_BIT) == 0u;
        let bits = bitcast<u32>(textureLoad(source, texel.xy, texel.z, 0)[asked.component]);
        let is_number = (bits & 0x7fffffffu) <= INFINITY_BITS;
        let key = key_of(bits);
        lowest = select(lowest, min(lowest, key), is_on_surface && is_number);
        highest = select(highest, max(highest, key), is_on_surface && is_number);
        not_numbers += select(0u, 1u, is_on_surface && !is_number);
    }
    let index = dispatch.first_tile + group.y * dispatch.row_length + group.x;
    if index >= dispatch.end_tile {
        return;
    }
    let place = asked.place + 3u * index;
    atomicMin(&found[place], lowest);
    atomicMax(&found[place + 1u], highest);
    if not_numbers > 0u {
        atomicAdd(&found[place + 2u], not_numbers);
    }
}
