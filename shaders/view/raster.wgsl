//! Rasterizes the model: the visible place, its chart and its frame for each pixel. Light follows in a pass of its own, once
//! for each pixel, however small the triangles are.
//! @use view/corner view/frame view/maps view/modes view/relief view/sight view/switches view/veil

@vertex
fn place_corner(corner: Corner) -> Seen {
    let clip = frame.clip_from_view * vec4f(corner.position, 1.0);
    let chart = 2u * corner.chart + select(0u, 1u, corner.tangent.w < 0.0);
    return Seen(clip, corner.position, corner.normal, corner.tangent.xyz, corner.texel, chart);
}

// As `seen.wgsl` reads it.
struct Laid {
    @location(0) place: vec4u,
    @location(1) frame: vec4u,
}

fn laid(seen: Seen, place: vec2f, chart: u32, normal: vec3f, tangent: vec3f, is_front: bool) -> Laid {
    let code = 2u * chart + select(0u, 1u, is_front);
    var packed = packed_vector(tangent);
    if MODE == DENSITY {
        packed = vec2u(bitcast<u32>(density(seen.texel, seen.position)), 0u);
    }
    if MODE == SHIFT {
        packed = bitcast<vec2u>(place - seen.texel);
    }
    return Laid(vec4u(bitcast<vec2u>(place), code, packed.x), vec4u(bitcast<vec3u>(normal), packed.y));
}

// Three numbers of −1..1 in 21 bits each.
fn packed_vector(v: vec3f) -> vec2u {
    let steps = vec3u(round(clamp(v * 0.5 + 0.5, vec3f(0.0), vec3f(1.0)) * 2097151.0));
    return vec2u(steps.x | (steps.y << 21u), (steps.y >> 11u) | (steps.z << 10u));
}

// Texels along a unit of view space.
fn density(texel: vec2f, position: vec3f) -> f32 {
    let texels = abs(determinant(mat2x2f(dpdx(texel), dpdy(texel))));
    let area = length(cross(dpdx(position), dpdy(position)));
    return sqrt(texels / max(area, 1e-20));
}

fn page_of(chart: u32) -> i32 {
    return i32(chart_row(chart >> 1u).z);
}

@fragment
fn lay(seen: Seen, @builtin(front_facing) is_front: bool) -> Laid {
    return laid(seen, seen.texel, seen.chart, seen.normal, seen.tangent, is_front);
}

@fragment
fn lay_veiled(seen: Seen, @builtin(front_facing) is_front: bool) -> Laid {
    if is_clear(Place(seen.texel, page_of(seen.chart)), seen.clip.xy, f32(frame.sample)) {
        discard;
    }
    return laid(seen, seen.texel, seen.chart, seen.normal, seen.tangent, is_front);
}

@fragment
fn lay_relief(seen: Seen, @builtin(front_facing) is_front: bool) -> Laid {
    return laid_at(seen, met(seen, Place(seen.texel, page_of(seen.chart)), ray_through(seen.position)), is_front);
}

@fragment
fn lay_veiled_relief(seen: Seen, @builtin(front_facing) is_front: bool) -> Laid {
    let hit = met(seen, Place(seen.texel, page_of(seen.chart)), ray_through(seen.position));
    if is_clear(Place(hit.texel, hit.page), seen.clip.xy, f32(frame.sample)) {
        discard;
    }
    return laid_at(seen, hit, is_front);
}

fn laid_at(seen: Seen, hit: Stand, is_front: bool) -> Laid {
    let basis = basis_there(hit, Basis(seen.normal, seen.tangent, seen.chart));
    return laid(seen, hit.texel, basis.chart, basis.normal, basis.tangent, is_front);
}
