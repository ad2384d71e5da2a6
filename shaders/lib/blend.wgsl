//! Blending: true interpolation, in linear light, between the value below and the result of a mode.
//!
//! The modes, in the order in which every node offers them: normal, add, subtract, multiply, screen, overlay,
//! soft_light, hard_light, min, max, difference, divide.
//! @use core

/// Result of a mode for the value below and the value above, before a mask weighs it.
fn blend_mode(below: f32, above: f32, mode: u32) -> f32 {
    switch mode {
        case 1u: { return below + above; }
        case 2u: { return below - above; }
        case 3u: { return below * above; }
        case 4u: { return below + above - below * above; }
        case 5u: { return hard_light(above, below); }
        // Without the root of the usual formula, which has a kink: multiply and screen, mixed by the value below.
        case 6u: { return below * (below + 2.0 * above * (1.0 - below)); }
        case 7u: { return hard_light(below, above); }
        case 8u: { return min(below, above); }
        case 9u: { return max(below, above); }
        case 10u: { return abs(below - above); }
        // Nothing divides by less than a thousandth, so the result stays finite.
        case 11u: { return below / max(above, 1e-3); }
        default: { return above; }
    }
}

/// Multiply where `above` is below one half, screen elsewhere.
fn hard_light(below: f32, above: f32) -> f32 {
    let doubled = 2.0 * above;
    return select(below * doubled, below + (doubled - 1.0) * (1.0 - below), above > 0.5);
}

/// Weight of a blend: masks are clamped to 0..1 here, and only here.
fn blend_weight(mask: f32, opacity: f32) -> f32 {
    return clamp(mask, 0.0, 1.0) * opacity;
}

/// A value blended over another: exactly `below` at weight 0, exactly the mode's result at weight 1.
fn blend_value(below: f32, above: f32, mode: u32, weight: f32) -> f32 {
    return mix(below, blend_mode(below, above, mode), weight);
}

/// A linear color blended over another, each component for itself.
fn blend_color(below: vec3f, above: vec3f, mode: u32, weight: f32) -> vec3f {
    let blended = vec3f(
        blend_mode(below.x, above.x, mode),
        blend_mode(below.y, above.y, mode),
        blend_mode(below.z, above.z, mode),
    );
    return mix(below, blended, weight);
}

/// Weight for a property of a part of both materials, such as the roughness of a coat: by how much of the part each of them
/// has, since what is not there has no roughness.
fn part_weight(below_share: f32, above_share: f32, weight: f32) -> f32 {
    let kept = below_share * (1.0 - weight);
    let added = above_share * weight;
    let both = kept + added;
    return select(weight, added / both, both > 1e-9);
}

/// Sign for a direction of fine scratches above another one. They have no head: the one above counts the way around that is
/// nearer to the one below, so that opposite ones are one.
fn axis_sign(below: vec3f, above: vec3f) -> f32 {
    return select(1.0, -1.0, dot(below, above) < 0.0);
}

/// Amount of sheen, as a weight.
fn sheen_share(sheen: vec3f) -> f32 {
    return dot(sheen, vec3f(1.0));
}

/// `above` over `below`, every channel, the slope and the height included.
fn blend_material(below: Material, above: Material, weight: f32) -> Material {
    return Material(
        mix(below.base_color, above.base_color, weight),
        mix(below.alpha, above.alpha, weight),
        mix(below.roughness, above.roughness, weight),
        mix(below.metallic, above.metallic, weight),
        mix(below.occlusion, above.occlusion, weight),
        mix(below.height, above.height, weight),
        mix(below.slope, above.slope, weight),
        mix(below.emission, above.emission, weight),
        mix(below.coat, above.coat, weight),
        mix(below.coat_roughness, above.coat_roughness, part_weight(below.coat, above.coat, weight)),
        mix(below.anisotropy, above.anisotropy * axis_sign(below.anisotropy, above.anisotropy), weight),
        mix(below.sheen, above.sheen, weight),
        mix(
            below.sheen_roughness, above.sheen_roughness,
            part_weight(sheen_share(below.sheen), sheen_share(above.sheen), weight),
        ),
        mix(below.subsurface, above.subsurface, weight),
        mix(below.transmission, above.transmission, weight),
    );
}
