// Computes what coupled ghost texels hold: not all of the four texels around their point over the seam are owned. A table
// says in two rows what is there. Orphans, which take the value of one owned texel, are read alike.

struct Gather {
    ghost_count: u32,
    // 0: only owned texels count, 1: ghosts too
    with_ghosts: u32,
    row_length: u32,
    rows: u32,
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
    let link = fill_link(index * gather.rows);
    let known = textureLoad(ghosts, table_texel(index * gather.rows + 1u), 0);
    let step = vec2i(vec2u(known.z & 7u, known.z >> 3u)) - 2;
    let anchor = textureLoad(field, link.texel + step, link.own_page, 0);
    let a = textureLoad(field, link.corner, link.page, 0);
    let b = textureLoad(field, link.corner + vec2i(1, 0), link.page, 0);
    let c = textureLoad(field, link.corner + vec2i(0, 1), link.page, 0);
    let d = textureLoad(field, link.corner + vec2i(1, 1), link.page, 0);
    let along = vec4f(1.0 - link.weight.x, link.weight.x, 1.0 - link.weight.x, link.weight.x);
    let down = vec4f(1.0 - link.weight.yy, link.weight.yy);
    // Bits of the four: owned or ghosts, and owned.
    let counted = select(known.y, known.x, gather.with_ghosts != 0u);
    let is_counted = (vec4u(counted) & vec4u(1u, 2u, 4u, 8u)) != vec4u(0u);
    let shares = select(vec4f(0.0), along.xyzw * down.xyzw, is_counted);
    let largest = max(max(shares.x, shares.y), max(shares.z, shares.w));
    var nearest = d;
    nearest = select(nearest, c, shares.z == largest);
    nearest = select(nearest, b, shares.y == largest);
    nearest = select(nearest, a, shares.x == largest);
    // Around the nearest one, so that a constant stays what it is, bit by bit; what does not count may hold anything.
    let total = shares.x + shares.y + shares.z + shares.w;
    var sum = select(vec4f(0.0), shares.x * (a - nearest), is_counted.x);
    sum += select(vec4f(0.0), shares.y * (b - nearest), is_counted.y);
    sum += select(vec4f(0.0), shares.z * (c - nearest), is_counted.z);
    sum += select(vec4f(0.0), shares.w * (d - nearest), is_counted.w);
    var filled = select(anchor, nearest + sum / max(total, 1e-6), largest > 0.0);
    // Only part of what is around the point over the seam is owned: what is there lies the further away. Between it and
    // the own chart's last texel the ghost is where a straight line says. Two ghosts that lie on one another, where both
    // charts end a texel before the seam, would else hand what they do not know to and fro.
    let away = 1.0 - total;
    if gather.with_ghosts == 0u && away > 0.0 {
        filled += (anchor - filled) * (away / (away + max(length(vec2f(step)), 1.0)));
    }
    values[index] = filled;
}
