//! The record that the model's raster leaves for a pixel, and the material there.
//! @use atlas view/frame view/maps view/switches

@group(2) @binding(1) var seen_places: texture_2d_array<u32>;
@group(2) @binding(2) var depths: texture_depth_2d;

// Openness of the model on an atlas of its own: the mean open direction, −1..1 as 0..1, and the open share; and its charts,
// as `charts` has them.
@group(2) @binding(3) var openness: texture_2d_array<f32>;
@group(2) @binding(4) var openness_charts: texture_2d<f32>;

// A pixel's place of the surface.
struct Pixel {
    // View space.
    position: vec3f,
    place: Place,
    chart: u32,
    is_front: bool,
    // Not of unit length: interpolated.
    normal: vec3f,
    tangent: vec3f,
    bitangent: vec3f,
    // Values stored in the tangent's place in some modes.
    extra: vec2f,
}

fn pixel_at(at: vec2f) -> Pixel {
    let texel = vec2i(at);
    let first = textureLoad(seen_places, texel, 0, 0);
    let second = textureLoad(seen_places, texel, 1, 0);
    let depth = textureLoad(depths, texel, 0);
    let size = vec2f(textureDimensions(depths));
    let clip = vec2f(2.0, -2.0) * (at / size) + vec2f(-1.0, 1.0);
    let view = frame.view_from_clip * vec4f(clip, depth, 1.0);
    let chart = first.z >> 2u;
    let normal = bitcast<vec3f>(second.xyz);
    let tangent = unpacked_vector(vec2u(first.w, second.w));
    let sign = select(1.0, -1.0, (first.z & 2u) != 0u);
    return Pixel(
        view.xyz / view.w,
        Place(bitcast<vec2f>(first.xy), i32(chart_row(chart).z)),
        chart,
        (first.z & 1u) != 0u,
        normal,
        tangent,
        cross(normal, tangent) * sign,
        bitcast<vec2f>(vec2u(first.w, second.w)),
    );
}

fn unpacked_vector(packed: vec2u) -> vec3f {
    let steps = vec3u(packed.x & 0x1fffffu, (packed.x >> 21u) | ((packed.y & 0x3ffu) << 11u), packed.y >> 10u);
    return vec3f(steps & vec3u(0x1fffffu)) / 2097151.0 * 2.0 - 1.0;
}

// Openness of the model at a pixel: the mean open direction, not of unit length, and the open share.
fn openness_at(pixel: Pixel) -> vec4f {
    let uv = (pixel.place.texel - chart_row(pixel.chart).xy) / frame.texels_of_uv;
    let row = textureLoad(openness_charts, vec2u(pixel.chart & ((1u << CHART_BITS) - 1u), pixel.chart >> CHART_BITS), 0);
    let value = value_at(openness, Place(uv * frame.openness_size + row.xy, i32(row.z)));
    return vec4f(value.xyz * 2.0 - 1.0, value.w);
}

// Material and normals at a place of the surface.
struct Spot {
    base_color: vec3f,
    alpha: f32,
    roughness: f32,
    metallic: f32,
    occlusion: f32,
    emission: vec3f,
    // Value of the normal map.
    tangent_normal: vec3f,
    // Unit vectors that face the eye: with the normal map, and without.
    normal: vec3f,
    smooth_normal: vec3f,
    // Share and roughness of a clear coat.
    coat: vec2f,
    // Direction in the tangent frame along which highlights are drawn out, and strength.
    anisotropy: vec3f,
    // Color and roughness of a sheen.
    sheen: vec4f,
    // Shares of the light that spread below the surface, and transmission.
    subsurface: vec4f,
}

fn spot_of(pixel: Pixel) -> Spot {
    let color = select(material.color, value_at(colors, pixel.place), has_map(COLOR_MAP));
    let surface = select(material.surface, value_at(surfaces, pixel.place), has_map(SURFACE_MAP));
    let emission = select(vec3f(0.0), value_at(emissions, pixel.place).xyz, has_map(EMISSION_MAP));
    let mapped = select(vec3f(0.0, 0.0, 1.0), value_at(normals, pixel.place).xyz, has_map(NORMAL_MAP));
    // Decoded as MikkTSpace has it: with the interpolated frame, not made orthonormal.
    let bent = pixel.tangent * mapped.x + pixel.bitangent * mapped.y + pixel.normal * mapped.z;
    let towards = select(-1.0, 1.0, pixel.is_front);
    let smooth_normal = unit_or(pixel.normal, vec3f(0.0, 1.0, 0.0));
    let coat = select(vec2f(0.0), value_at(coats, pixel.place).xy, has_map(COAT_MAP));
    let anisotropy = select(vec3f(1.0, 0.0, 0.0), value_at(anisotropies, pixel.place).xyz, has_map(ANISOTROPY_MAP));
    let sheen = select(vec4f(0.0), value_at(sheens, pixel.place), has_map(SHEEN_MAP));
    let subsurface = select(vec4f(0.0), value_at(subsurfaces, pixel.place), has_map(SUBSURFACE_MAP));
    return Spot(
        color.xyz,
        color.w,
        clamp(surface.x, 0.0, 1.0),
        clamp(surface.y, 0.0, 1.0),
        clamp(surface.z, 0.0, 1.0),
        max(emission, vec3f(0.0)),
        mapped,
        unit_or(bent, smooth_normal) * towards,
        smooth_normal * towards,
        clamp(coat, vec2f(0.0), vec2f(1.0)),
        anisotropy,
        clamp(sheen, vec4f(0.0), vec4f(1.0)),
        clamp(subsurface, vec4f(0.0), vec4f(1.0)),
    );
}
