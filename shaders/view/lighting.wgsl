//! Light that a place of the surface sends to the eye.
//! @use atlas view/brdf view/finish view/frame view/irradiance view/relief view/seen view/shadow view/switches

// Share of a reflection that reaches a place with a degree of openness to its surrounding (Lagarde and de Rousiers 2014, "Moving
// Frostbite to physically based rendering").
fn reflected_share(to_eye: f32, open: f32, roughness: f32) -> f32 {
    return clamp(pow(to_eye + open, exp2(-16.0 * roughness - 1.0)) - 1.0 + open, 0.0, 1.0);
}

// Dominant direction of the lobe of a rough surface: the rougher, the nearer to the normal. The idea is Lagarde's and de
// Rousiers', as above; of no turn, their turn and this one, this one comes nearest to Cycles' metal spheres, see
// `docs/cycles`.
fn mirrored_from(normal: vec3f, towards: vec3f, roughness: f32) -> vec3f {
    let width = roughness * roughness;
    return mix(towards, normal, width * width);
}

// The normal of a mirror: bumps turned so far from the eye that they would reflect the inside of the surface are turned back
// until they reflect the directions just above it, as Cycles does. Diffuse light does not need it.
fn mirroring_normal(spot: Spot, to_eye: vec3f) -> vec3f {
    let up = spot.smooth_normal;
    let sideways = spot.normal - up * dot(spot.normal, up);
    let height = dot(to_eye, up);
    let least = min(0.9 * height, 0.01);
    if height <= 0.0 || length(sideways) < 1e-4 || dot(reflect(-to_eye, spot.normal), up) >= least {
        return spot.normal;
    }
    // In the plane of both normals, a mirror at an angle from the surface's normal reflects the direction at twice the angle
    // less the eye's; its height above the surface is to be `least`.
    let aside = normalize(sideways);
    let eye = vec2f(height, dot(to_eye, aside));
    let angle = 0.5 * (atan2(eye.y, eye.x) + acos(clamp(least / length(eye), -1.0, 1.0)));
    return up * cos(angle) + aside * sin(angle);
}

// Light of the environment around a direction, over a lobe of a roughness.
fn light_from(direction: vec3f, roughness: f32) -> vec3f {
    let level = roughness * (2.0 - roughness) * frame.environment.w;
    return textureSampleLevel(reflections, smooth_sampler, in_environment(direction), level).xyz;
}

// Light that a mirror of a roughness reflects to the eye.
fn mirrored_light(mirror: vec3f, to_eye: vec3f, roughness: f32) -> vec3f {
    return light_from(mirrored_from(mirror, reflect(-to_eye, mirror), roughness), roughness);
}

// The same of facets that lean further along one direction: the mean of mirrors at the middles of five equal shares of the
// facets by their slope along it. A GGX slope has the quantile width · u / √(1 − u²) at u in −1..1.
fn drawn_out_light(mirror: vec3f, to_eye: vec3f, roughness: f32, finish: Finish) -> vec3f {
    var sum = vec3f(0.0);
    var count = 0.0;
    for (var index = 0; index < 5; index++) {
        let u = 0.4 * f32(index) - 0.8;
        let leaning = normalize(mirror + finish.along * (finish.along_width * u * inverseSqrt(1.0 - u * u)));
        if dot(reflect(-to_eye, leaning), mirror) > 0.0 {
            sum += mirrored_light(leaning, to_eye, roughness);
            count += 1.0;
        }
    }
    return sum / max(count, 1.0);
}

// `open` is the openness of the model: the mean open direction and the open share.
fn from_environment(
    spot: Spot, mirror: vec3f, made: Substance, finish: Finish, lobe: vec2f, to_eye: vec3f, cosine: f32, open: vec4f,
) -> vec3f {
    let both = surrounded(made, lobe);
    let towards = reflect(-to_eye, mirror);
    var reflected = mirrored_light(mirror, to_eye, made.roughness);
    if has_map(ANISOTROPY_MAP) {
        reflected = drawn_out_light(mirror, to_eye, made.roughness, finish);
    }
    // Where the smooth normal itself faces away, reflections still go through the surface.
    let above = clamp(1.0 + dot(towards, spot.smooth_normal), 0.0, 1.0);
    let unblocked = spot.occlusion * open.w;
    let share = reflected_share(cosine, unblocked, made.roughness) * above * above;
    // Light arrives from where the surface is open, the more so the less of it is.
    let from_open = unit_or(mix(spot.normal, open.xyz, 0.7 * (1.0 - open.w)), spot.normal);
    let irradiance = irradiance_at(frame.irradiance, in_environment(from_open));
    var light = both.reflected * reflected * share + both.scattered * irradiance * unblocked;
    if has_map(SUBSURFACE_MAP) {
        // As through thin glass: what lies behind, blurred by the roughness and tinted by the color.
        light += finish.clear * (1.0 - both.reflected) * light_from(-to_eye, made.roughness);
    }
    if has_finish() {
        let coat_share = reflected_share(cosine, unblocked, finish.coat.y) * above * above;
        let coat = COAT_REFLECTANCE * finish.coat_lobe.x + finish.coat_lobe.y;
        light *= passing(finish);
        light += finish.sheen.xyz * finish.sheen_albedo * mirrored_light(mirror, to_eye, finish.sheen.w) * unblocked;
        light += coat * mirrored_light(mirror, to_eye, finish.coat.y) * (finish.coat.x * coat_share);
    }
    return light * frame.environment.z;
}

fn from_lights(
    spot: Spot, pixel: Pixel, made: Substance, finish: Finish, lobe: vec2f, to_eye: vec3f, has_relief: bool,
) -> vec3f {
    var sum = vec3f(0.0);
    for (var index = 0u; index < LIGHT_COUNT; index++) {
        let light = frame.lights[index];
        let towards_light = towards_light_from(light, pixel.position);
        let to_light = towards_light.xyz;
        let falloff = towards_light.w;
        let cosine = dot(spot.normal, to_light);
        // A light behind the surface itself does not shine through bumps.
        let is_above = cosine > 0.0 && dot(spot.smooth_normal, to_light) > -0.1;
        if is_above {
            var reaches = 1.0;
            if ((SHADOWS_OF >> index) & 1u) != 0u {
                reaches = unshadowed(light, pixel.position, spot.smooth_normal, to_light);
            }
            if has_relief && reaches > 0.0 {
                reaches *= through_relief(pixel.place, spot.smooth_normal, to_light);
            }
            if has_finish() {
                let sent = finished(made, lobe, finish, spot.normal, to_eye, to_light);
                sum += sent * light.color.xyz * (falloff * reaches);
            } else {
                let sent = scattered(made, lobe, spot.normal, to_eye, to_light);
                sum += sent * light.color.xyz * (cosine * falloff * reaches);
            }
        } else if has_map(SUBSURFACE_MAP) && cosine <= 0.0 {
            // Light that entered on the lit side; nothing but the surface itself stands between.
            let spread = diffuse_part(made, lobe) * spread_cosine(cosine, finish.spread);
            sum += spread * light.color.xyz * (falloff * passing(finish));
        }
    }
    return sum;
}

fn lit(spot: Spot, pixel: Pixel, has_relief: bool) -> vec3f {
    let to_eye = -ray_through(pixel.position);
    let mirror = mirroring_normal(spot, to_eye);
    let cosine = clamp(dot(mirror, to_eye), 1e-3, 1.0);
    var made = substance_of(max(spot.base_color, vec3f(0.0)), spot.metallic, spot.roughness);
    let lobe = albedo_of_lobe(cosine, made.roughness);
    var open = vec4f(spot.normal, 1.0);
    if OPENNESS == 1u {
        open = openness_at(pixel);
    }
    let finish = finish_of(spot, pixel, made, cosine);
    made.diffuse *= 1.0 - spot.subsurface.w;
    let emitted = select(spot.emission, spot.emission * passing(finish), has_finish());
    return from_environment(spot, mirror, made, finish, lobe, to_eye, cosine, open)
        + from_lights(spot, pixel, made, finish, lobe, to_eye, has_relief) + emitted;
}
