//! Shadows of lights: comparison with the model's depth from each light.
//! @use view/frame

// Direction from a place to a light, and in w the factor of the light's color there.
fn towards_light_from(light: Light, position: vec3f) -> vec4f {
    let away = light.place.xyz - position * light.place.w;
    let squared = max(dot(away, away), 1e-12);
    return vec4f(away * inverseSqrt(squared), select(1.0, 1.0 / max(squared, 1e-4), light.place.w > 0.5));
}

// The layer of a light's shadow in which a direction away from it lies: one for far lights, a face of a cube for near ones.
fn layer_of(light: Light, away: vec3f) -> i32 {
    let size = abs(away);
    var face = select(4, 5, away.z < 0.0);
    face = select(face, select(2, 3, away.y < 0.0), size.y >= size.z);
    face = select(face, select(0, 1, away.x < 0.0), size.x >= size.y && size.x >= size.z);
    return i32(light.color.w) + select(0, face, light.place.w > 0.5);
}

// Share of a light with a shadow that reaches a place: four comparisons, each between four depths.
fn unshadowed(light: Light, position: vec3f, normal: vec3f, to_light: vec3f) -> f32 {
    // Offset from the surface, larger at grazing light: a depth covers a whole texel.
    let slant = 1.0 - clamp(dot(normal, to_light), 0.0, 1.0);
    let from_surface = position + normal * (0.002 + 0.006 * slant);
    let layer = layer_of(light, from_surface - light.place.xyz);
    let clip = frame.shadow_from_view[layer] * vec4f(from_surface, 1.0);
    let place = clip.xyz / max(clip.w, 1e-6);
    let uv = vec2f(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y);
    let texel = 1.0 / f32(textureDimensions(shadows).x);
    var sum = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        let step = vec2f(f32(tap & 1) - 0.5, f32(tap >> 1u) - 0.5) * 1.5 * texel;
        // Places behind the model's surroundings, such as far ground, have nothing before them there.
        sum += textureSampleCompareLevel(shadows, shadow_sampler, uv + step, layer, min(place.z, 1.0));
    }
    return sum * 0.25;
}
