//! Area of the surface by value: whole numbers, so that the order of adding does not matter.
//! @use atlas survey surface/place surface/sorted surface/survey_group

@group(1) @binding(0) var<uniform> survey: Survey;
@group(1) @binding(1) var source: texture_2d_array<f32>;
@group(1) @binding(2) var<storage, read_write> counts: array<atomic<u32>>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY || (owner & GHOST_BIT) != 0u {
        return;
    }
    let row = owner * GEOMETRY_ROWS;
    let area = length(cross(geometry_row(row + 1u).xyz, geometry_row(row + 2u).xyz));
    let first = survey_counts_of(owner, survey);
    let low = value_of(atomicLoad(&counts[first]));
    let high = value_of(atomicLoad(&counts[first + 1u]));
    let value = textureLoad(source, texel.xy, texel.z, 0).x;
    let share = (value - low) / max(high - low, 1e-30);
    let bin = u32(clamp(share * f32(SURVEY_STEPS), 0.0, f32(SURVEY_STEPS) - 1.0));
    atomicAdd(&counts[first + 2u + bin], u32(area * survey.count_per_area + 0.5));
}
