// Computes what each ghost texel holds: the stored field at the point over the seam.

struct Gather {
    ghost_count: u32,
    // 0: only owned texels count, 1: ghosts too
    with_ghosts: u32,
    row_length: u32,
    pad: u32,
}

@group(1) @binding(0) var<uniform> gather: Gather;
@group(1) @binding(1) var field: texture_2d_array<f32>;
@group(1) @binding(2) var<storage, read_write> values: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * gather.row_length + group.x) * 64u + local;
    if index >= gather.ghost_count {
        return;
    }
    let link = ghost_link(index);
    let read = ghost_read(index);
    let page = i32(read.page);
    let corner = floor(read.texel - 0.5);
    let weight = read.texel - 0.5 - corner;
    var nearest = vec4f(0.0);
    var nearest_share = -1.0;
    var taps: array<vec4f, 4>;
    var shares: array<f32, 4>;
    for (var tap = 0u; tap < 4u; tap++) {
        let step = vec2i(i32(tap & 1u), i32(tap >> 1u));
        let texel = vec2i(corner) + step;
        let owner = textureLoad(owners, texel, page, 0).r;
        let is_ghost = owner != EMPTY && (owner & GHOST_BIT) != 0u;
        let counts = owner != EMPTY && (gather.with_ghosts != 0u || !is_ghost);
        let along = select(1.0 - weight, weight, step == vec2i(1));
        let share = select(0.0, along.x * along.y, counts);
        let value = textureLoad(field, texel, page, 0);
        taps[tap] = value;
        shares[tap] = share;
        if counts && share > nearest_share {
            nearest_share = share;
            nearest = value;
        }
    }
    // Around the nearest tap, so that a constant stays what it is, bit by bit.
    var sum = vec4f(0.0);
    var total = 0.0;
    for (var tap = 0u; tap < 4u; tap++) {
        sum += shares[tap] * select(vec4f(0.0), taps[tap] - nearest, shares[tap] > 0.0);
        total += shares[tap];
    }
    let texel = vec2i(i32(link.texel & 0xffffu), i32(link.texel >> 16u));
    let step = vec2i(i32(read.anchor & 7u), i32(read.anchor >> 3u)) - 2;
    let anchor = textureLoad(field, texel + step, i32(link.page), 0);
    var filled = select(anchor, nearest + sum / max(total, 1e-6), nearest_share >= 0.0);
    // Only part of what is around the point over the seam is owned: what is there lies the further away. Between it and
    // the own chart's last texel the ghost is where a straight line says. Two ghosts that lie on one another, where both
    // charts end a texel before the seam, would else hand what they do not know to and fro.
    let away = 1.0 - total;
    if gather.with_ghosts == 0u && away > 0.0 {
        filled += (anchor - filled) * (away / (away + max(length(vec2f(step)), 1.0)));
    }
    values[index] = filled;
}
