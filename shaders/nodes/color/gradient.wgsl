//! Gradient
//! Turns a mask into colors.
//!
//! Colors between two stops are mixed in linear light, as light and pigments of equal strength mix.
//! @alias gradient ramp map colorize color

struct Params {
    /// Up to sixteen colors with their mask values, in rising order.
    /// @default 0 #000000 1 #ffffff
    stops: array<vec4f, 16>,
}

/// The color for the mask's value.
/// @input source The mask to color. @optional @default 0
fn color(source: f32, params: Params) -> vec3f {
    var result = params.stops[0].xyz;
    result = toward_stop(result, source, params.stops[0].w, params.stops[1]);
    result = toward_stop(result, source, params.stops[1].w, params.stops[2]);
    result = toward_stop(result, source, params.stops[2].w, params.stops[3]);
    result = toward_stop(result, source, params.stops[3].w, params.stops[4]);
    result = toward_stop(result, source, params.stops[4].w, params.stops[5]);
    result = toward_stop(result, source, params.stops[5].w, params.stops[6]);
    result = toward_stop(result, source, params.stops[6].w, params.stops[7]);
    result = toward_stop(result, source, params.stops[7].w, params.stops[8]);
    result = toward_stop(result, source, params.stops[8].w, params.stops[9]);
    result = toward_stop(result, source, params.stops[9].w, params.stops[10]);
    result = toward_stop(result, source, params.stops[10].w, params.stops[11]);
    result = toward_stop(result, source, params.stops[11].w, params.stops[12]);
    result = toward_stop(result, source, params.stops[12].w, params.stops[13]);
    result = toward_stop(result, source, params.stops[13].w, params.stops[14]);
    result = toward_stop(result, source, params.stops[14].w, params.stops[15]);
    return result;
}

// Goes on to the next stop as far as `source` is past the last one. Unused stops stand at 2, out of the mask's range.
fn toward_stop(result: vec3f, source: f32, last: f32, stop: vec4f) -> vec3f {
    let t = clamp((source - last) / max(stop.w - last, 1e-6), 0.0, 1.0);
    return mix(result, stop.xyz, select(t, 0.0, stop.w > 1.5));
}
