// Lowest and highest value of one component over the surface, as numbers that sort like the values, and how many texels
// hold no number.

struct Asked {
    // Which component of a texel, and the first of the three places for what is found.
    component: u32,
    place: u32,
    pad: vec2u,
}

@group(1) @binding(0) var<uniform> asked: Asked;
@group(1) @binding(1) var source: texture_2d_array<f32>;
@group(1) @binding(2) var<storage, read_write> found: array<atomic<u32>>;

const INFINITY_BITS: u32 = 0x7f800000u;

// Larger values have larger keys, below and above 0.
fn key_of(bits: u32) -> u32 {
    return select(bits | 0x80000000u, ~bits, (bits & 0x80000000u) != 0u);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY || (owner & GHOST_BIT) != 0u {
        return;
    }
    let bits = bitcast<u32>(textureLoad(source, texel.xy, texel.z, 0)[asked.component]);
    if (bits & 0x7fffffffu) > INFINITY_BITS {
        atomicAdd(&found[asked.place + 2u], 1u);
        return;
    }
    // Looking first spares nearly all writes to the two places that everybody wants.
    let key = key_of(bits);
    if key < atomicLoad(&found[asked.place]) {
        atomicMin(&found[asked.place], key);
    }
    if key > atomicLoad(&found[asked.place + 1u]) {
        atomicMax(&found[asked.place + 1u], key);
    }
}
