//! Views other than the lit material: one of its channels, a node's own result, or how the maps lie on the model.
//! Values are those of the picture, sRGB-encoded where they are colors, like the files of an export.
//! @use view/frame view/maps view/modes view/seen view/srgb view/switches

// Letters would need a font: squares of two sizes, tinted along u and v, tell place, size, turn and mirroring of UVs.
fn checker(texel_of_plane: vec2f) -> vec3f {
    let uv = texel_of_plane / frame.texels_of_uv;
    let coarse = vec2i(floor(uv * 8.0));
    let fine = vec2i(floor(uv * 64.0));
    let tint = vec3f(fract(uv.x), fract(uv.y), 0.5);
    let is_light = ((coarse.x + coarse.y) & 1) == 0;
    let shade = select(0.25, 0.85, is_light) + select(-0.06, 0.06, ((fine.x + fine.y) & 1) == 0);
    // A wedge in each coarse square points along +u and is cut off along +v.
    let inside = fract(uv * 8.0);
    let is_wedge = inside.x > 0.2 && inside.x < 0.8 && abs(inside.y - 0.5) < (0.8 - inside.x) * 0.4 && inside.y < 0.62;
    let plain = mix(vec3f(shade), tint, 0.45);
    return select(plain, select(vec3f(0.95), vec3f(0.1), is_light), is_wedge);
}

// Blue where texels are wider than the mean, red where narrower, up to a factor of four.
fn density_color(density: f32) -> vec3f {
    let doublings = clamp(log2(max(density / frame.even_density, 1e-6)) / 2.0, -1.0, 1.0);
    let even = vec3f(0.95, 0.95, 0.9);
    let far = select(vec3f(0.85, 0.15, 0.1), vec3f(0.1, 0.3, 0.85), doublings < 0.0);
    return mix(even, far, abs(doublings));
}

// A node's own result as a color.
fn node_color(value: vec4f) -> vec3f {
    if SHOWN_TYPE == SHOWN_COLOR {
        return code_of(value.xyz);
    }
    return select(vec3f(value.x), value.xyz * 0.5 + 0.5, SHOWN_TYPE == SHOWN_VECTOR);
}

fn shown_color(pixel: Pixel, spot: Spot) -> vec3f {
    let to_eye = -ray_through(pixel.position);
    switch MODE {
        case BASE_COLOR: { return code_of(spot.base_color); }
        case OPACITY: { return vec3f(spot.alpha); }
        case ROUGHNESS: { return vec3f(spot.roughness); }
        case METALLIC: { return vec3f(spot.metallic); }
        case OCCLUSION: { return vec3f(spot.occlusion); }
        case HEIGHT: {
            let height = select(0.0, value_at(heights, pixel.place).x, has_map(HEIGHT_MAP));
            return vec3f((height - frame.heights.x) / max(frame.heights.y - frame.heights.x, 1e-12));
        }
        case NORMAL: { return spot.tangent_normal * 0.5 + 0.5; }
        case MODEL_NORMAL: { return spot.normal * 0.5 + 0.5; }
        case EMISSION: { return code_of(spot.emission); }
        case COAT: { return vec3f(spot.coat.x); }
        case COAT_ROUGHNESS: { return vec3f(spot.coat.y); }
        case ANISOTROPY: { return vec3f(spot.anisotropy.xy * 0.5 + 0.5, spot.anisotropy.z); }
        case SHEEN: { return code_of(spot.sheen.xyz); }
        case SHEEN_ROUGHNESS: { return vec3f(spot.sheen.w); }
        case SUBSURFACE: { return code_of(spot.subsurface.xyz); }
        case TRANSMISSION: { return vec3f(spot.subsurface.w); }
        case NODE: { return node_color(value_at(colors, pixel.place)); }
        case NODE_ON_CLAY: {
            let value = value_at(colors, pixel.place);
            if SHOWN_TYPE == SHOWN_COLOR || SHOWN_TYPE == SHOWN_VECTOR {
                return node_color(value);
            }
            return vec3f(mix(0.3, 0.95, clamp(value.x, 0.0, 1.0))) * shade_of(spot.normal, to_eye);
        }
        case CHECKER: { return checker(pixel.place.texel - chart_row(pixel.chart).xy) * shade_of(spot.smooth_normal, to_eye); }
        case DENSITY: { return density_color(pixel.extra.x) * shade_of(spot.smooth_normal, to_eye); }
        case FACING: {
            return select(vec3f(0.9, 0.25, 0.2), vec3f(0.25, 0.45, 0.9), dot(spot.smooth_normal, to_eye) > 0.0)
                * shade_of(spot.smooth_normal, to_eye);
        }
        case SHIFT: { return vec3f(pixel.extra, 0.0); }
        default: { return vec3f(0.75) * shade_of(spot.normal, to_eye); }
    }
}

// Simple shading for views without lights.
fn shade_of(normal: vec3f, to_eye: vec3f) -> f32 {
    return 0.55 + 0.45 * clamp(dot(normal, to_eye), 0.0, 1.0);
}
