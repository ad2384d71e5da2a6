//! Table of a survey, as `lib/survey.wgsl` reads it: for each step of the values the share of the surface that lies below
//! its end, the integral of that share, and lowest and highest value; a row for each group. One invocation adds a row,
//! always in the same order.
//! @use survey surface/sorted surface/survey_group

@group(1) @binding(0) var<uniform> survey: Survey;
@group(1) @binding(1) var<storage, read_write> counts: array<atomic<u32>>;
@group(1) @binding(2) var table: texture_storage_2d_array<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let row = 64u * group.x + 8u * local.y + local.x;
    if row >= survey.groups {
        return;
    }
    let first = row * SURVEY_COUNTS;
    var all = 0u;
    for (var bin = 0u; bin < u32(SURVEY_STEPS); bin++) {
        all += atomicLoad(&counts[first + 2u + bin]);
    }
    // A number that no group has holds no values.
    let is_empty = all == 0u;
    let low = select(value_of(atomicLoad(&counts[first])), 0.0, is_empty);
    let high = select(value_of(atomicLoad(&counts[first + 1u])), 0.0, is_empty);
    var sum = 0u;
    var before = 0.0;
    var integral = 0.0;
    for (var bin = 0u; bin < u32(SURVEY_STEPS); bin++) {
        sum += atomicLoad(&counts[first + 2u + bin]);
        let share = f32(sum) / max(f32(all), 1.0);
        integral += 0.5 * (before + share) / f32(SURVEY_STEPS);
        before = share;
        textureStore(table, vec2i(i32(bin), i32(row)), 0, vec4f(share, integral, low, high));
    }
}
