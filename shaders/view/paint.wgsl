//! Paints the pixels of the model: the lit material, or another view.
//! @use view/cover view/lighting view/seen view/show

fn painted(at: vec2f, has_relief: bool) -> vec4f {
    let pixel = pixel_at(at);
    let spot = spot_of(pixel);
    return vec4f(min(lit(spot, pixel, has_relief), vec3f(65504.0)), 1.0);
}

@fragment
fn paint(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return painted(at.xy, false);
}

// With shadows of the heights.
@fragment
fn paint_relief(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return painted(at.xy, true);
}

// A view other than the lit material.
@fragment
fn paint_shown(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = pixel_at(at.xy);
    return vec4f(shown_color(pixel, spot_of(pixel)), 1.0);
}
