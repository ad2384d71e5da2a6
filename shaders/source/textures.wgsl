//! Channels of the textures of a model's material, each a product of two of them and a factor.
//! @use core atlas surface/place surface/tangent_frame source/triangle_point source/picture source/coordinates source/stored
//! @given StoredField IS_HALF STORAGE_0 STORAGE_1 STORAGE_2 STORAGE_3

// Channel of no texture, which is 1.
const NO_CHANNEL: u32 = 16u;

struct Textures {
    // Material whose triangles are filled.
    material: u32,
    // Value from which a component that is cut is 1, and below which it is 0.
    cutoff: f32,
    // Components that are cut, a bit for each.
    is_cut: u32,
    pad: u32,
    // Channels of the textures, four for each in turn, that each component is a product of.
    first: vec4u,
    second: vec4u,
    factor: vec4f,
    // Added to the product.
    addend: vec4f,
    used: array<Texture, 4>,
}

// Means of the textures.
struct Means {
    first: vec4f,
    second: vec4f,
    third: vec4f,
    fourth: vec4f,
}

@group(1) @binding(0) var<uniform> textures: Textures;
@group(1) @binding(1) var table_0: texture_2d<u32>;
@group(1) @binding(2) var table_1: texture_2d<u32>;
@group(1) @binding(3) var table_2: texture_2d<u32>;
@group(1) @binding(4) var table_3: texture_2d<u32>;
@group(1) @binding(5) var coordinates_0: texture_2d<u32>;
@group(1) @binding(6) var coordinates_1: texture_2d<u32>;
@group(1) @binding(7) var coordinates_2: texture_2d<u32>;
@group(1) @binding(8) var coordinates_3: texture_2d<u32>;
@group(1) @binding(9) var field: StoredField;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY {
        return;
    }
    let point = triangle_point(texel, owner);
    if material_of(point.triangle) != textures.material {
        return;
    }
    let white = vec4f(1.0);
    var means = Means(white, white, white, white);
    if STORAGE_0 != NO_PICTURE {
        means.first = texture_mean(table_0, coordinates_0, STORAGE_0, textures.used[0], point, white);
    }
    if STORAGE_1 != NO_PICTURE {
        means.second = texture_mean(table_1, coordinates_1, STORAGE_1, textures.used[1], point, white);
    }
    if STORAGE_2 != NO_PICTURE {
        means.third = texture_mean(table_2, coordinates_2, STORAGE_2, textures.used[2], point, white);
    }
    if STORAGE_3 != NO_PICTURE {
        means.fourth = texture_mean(table_3, coordinates_3, STORAGE_3, textures.used[3], point, white);
    }
    let first = vec4f(
        channel_of(means, textures.first.x),
        channel_of(means, textures.first.y),
        channel_of(means, textures.first.z),
        channel_of(means, textures.first.w),
    );
    let second = vec4f(
        channel_of(means, textures.second.x),
        channel_of(means, textures.second.y),
        channel_of(means, textures.second.z),
        channel_of(means, textures.second.w),
    );
    let value = textures.addend + textures.factor * first * second;
    let cut = select(vec4f(0.0), vec4f(1.0), value >= vec4f(textures.cutoff));
    let is_cut = (vec4u(textures.is_cut) & vec4u(1u, 2u, 4u, 8u)) != vec4u(0u);
    textureStore(field, texel.xy, texel.z, stored(select(value, cut, is_cut)));
}

// A channel of one of the textures, four for each in turn, or 1.
fn channel_of(means: Means, channel: u32) -> f32 {
    var mean = means.first;
    if STORAGE_1 != NO_PICTURE {
        mean = select(mean, means.second, channel >= 4u);
    }
    if STORAGE_2 != NO_PICTURE {
        mean = select(mean, means.third, channel >= 8u);
    }
    if STORAGE_3 != NO_PICTURE {
        mean = select(mean, means.fourth, channel >= 12u);
    }
    let half = select(mean.xz, mean.yw, (channel & 1u) != 0u);
    return select(select(half.x, half.y, (channel & 2u) != 0u), 1.0, channel == NO_CHANNEL);
}
