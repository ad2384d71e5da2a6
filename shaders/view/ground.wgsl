//! Shade of the model on the ground below it.
//! @use view/frame view/irradiance view/shadow view/switches

// Share of light that reaches the ground behind a pixel, compared with ground without the model: of the environment as rays
// found it, of lights by their shadows. 1 where there is no ground.
fn open_ground(place: vec3f, towards: vec3f) -> f32 {
    let origin = select(place, frame.eye.xyz, frame.eye.w > 0.5);
    let height = origin.y - frame.ground.x;
    if towards.y > -1e-4 || height <= 0.0 {
        return 1.0;
    }
    let at = origin + towards * (height / -towards.y);
    let radius = frame.ground.y;
    let uv = at.xz / (2.0 * radius) + 0.5;
    let open = textureSampleLevel(ground_openness, smooth_sampler, uv, 0.0).x;
    let up = vec3f(0.0, 1.0, 0.0);
    let around = luminance_of(irradiance_at(frame.irradiance, up)) * frame.environment.z;
    var whole = around;
    var reaching = around * open;
    for (var index = 0u; index < LIGHT_COUNT; index++) {
        let light = frame.lights[index];
        let towards_light = towards_light_from(light, at);
        let arriving = luminance_of(light.color.xyz) * max(towards_light.y, 0.0) * towards_light.w / PI;
        var reaches = 1.0;
        if ((SHADOWS_OF >> index) & 1u) != 0u {
            reaches = unshadowed(light, at, up, towards_light.xyz);
        }
        whole += arriving;
        reaching += arriving * reaches;
    }
    // Far from the model the ground is gone, so that it has no border.
    let near = 1.0 - smoothstep(0.55, 1.0, length(at.xz) / radius);
    return mix(1.0, reaching / max(whole, 1e-6), near);
}

fn luminance_of(color: vec3f) -> f32 {
    return dot(color, vec3f(0.2126, 0.7152, 0.0722));
}
