//! Table of a survey, as `lib/survey.wgsl` reads it: for each step of the values the share of the surface that lies below
//! its end, the integral of that share, and lowest and highest value. One invocation adds, always in the same order.
//! @use survey surface/sorted

@group(1) @binding(0) var<storage, read_write> counts: array<atomic<u32>>;
@group(1) @binding(1) var table: texture_storage_2d_array<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    if any(group != vec3u(0u)) || any(local != vec3u(0u)) {
        return;
    }
    let low = value_of(atomicLoad(&counts[0]));
    let high = value_of(atomicLoad(&counts[1]));
    var all = 0u;
    for (var bin = 0u; bin < u32(SURVEY_STEPS); bin++) {
        all += atomicLoad(&counts[2u + bin]);
    }
    var sum = 0u;
    var before = 0.0;
    var integral = 0.0;
    for (var bin = 0u; bin < u32(SURVEY_STEPS); bin++) {
        sum += atomicLoad(&counts[2u + bin]);
        let share = f32(sum) / max(f32(all), 1.0);
        integral += 0.5 * (before + share) / f32(SURVEY_STEPS);
        before = share;
        textureStore(table, vec2i(i32(bin), 0), 0, vec4f(share, integral, low, high));
    }
}
