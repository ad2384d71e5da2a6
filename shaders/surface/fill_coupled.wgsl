//! Computes coupled ghost texels: not all of the four texels around their point over the seam are owned. The first two rows
//! of a table describe each. Orphans, which take the value of one owned texel, are read alike. Linked with one of
//! `access_*.wgsl`, which says where texels are read (`field_at`, `slots_of`, `tap_at`) and where values go (`keep`).
//! @use atlas surface/fill

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * fill.row_length + group.x) * 64u + local;
    if index >= fill.ghost_count {
        return;
    }
    let link = fill_link(index * fill.rows);
    let known = textureLoad(ghosts, table_texel(index * fill.rows + 1u), 0);
    let step = vec2i(vec2u(known.z & 7u, known.z >> 3u)) - 2;
    let own = link.texel + step;
    let anchor = field_at(own, link.own_page);
    let along = vec4f(1.0 - link.weight.x, link.weight.x, 1.0 - link.weight.x, link.weight.x);
    let down = vec4f(1.0 - link.weight.yy, link.weight.yy);
    // Bits of the four: owned or ghosts, and owned.
    let counted = select(known.y, known.x, fill.with_ghosts != 0u);
    let is_counted = (vec4u(counted) & vec4u(1u, 2u, 4u, 8u)) != vec4u(0u);
    // Texels that do not count may be written in the same round: an owned texel is read in their place.
    let corner = link.corner;
    let pages = select(vec4i(link.own_page), vec4i(link.page), is_counted);
    let slots = slots_of(index);
    let a = tap_at(select(own, corner, is_counted.x), pages.x, slots.x);
    let b = tap_at(select(own, corner + vec2i(1, 0), is_counted.y), pages.y, slots.y);
    let c = tap_at(select(own, corner + vec2i(0, 1), is_counted.z), pages.z, slots.z);
    let d = tap_at(select(own, corner + vec2i(1, 1), is_counted.w), pages.w, slots.w);
    let shares = select(vec4f(0.0), along.xyzw * down.xyzw, is_counted);
    let largest = max(max(shares.x, shares.y), max(shares.z, shares.w));
    var nearest = d;
    nearest = select(nearest, c, shares.z == largest);
    nearest = select(nearest, b, shares.y == largest);
    nearest = select(nearest, a, shares.x == largest);
    // Differences from the nearest one, so that a constant keeps its bits; texels that do not count may hold anything.
    let total = shares.x + shares.y + shares.z + shares.w;
    var sum = select(vec4f(0.0), shares.x * (a - nearest), is_counted.x);
    sum += select(vec4f(0.0), shares.y * (b - nearest), is_counted.y);
    sum += select(vec4f(0.0), shares.z * (c - nearest), is_counted.z);
    sum += select(vec4f(0.0), shares.w * (d - nearest), is_counted.w);
    var filled = select(anchor, nearest + sum / max(total, 1e-6), largest > 0.0);
    // Only some of the texels around the point over the seam are owned, so their mean lies further away. Between it and the
    // last texel of the ghost's own chart the value is interpolated along a straight line. Two ghosts that lie on one
    // another, where both charts end a texel before the seam, would otherwise exchange undefined values.
    let away = 1.0 - total;
    if fill.with_ghosts == 0u && away > 0.0 {
        filled += (anchor - filled) * (away / (away + max(length(vec2f(step)), 1.0)));
    }
    keep(index, link, filled);
}
