//! The anisotropy of a material in the tangent frame, as glTF has it: the unit direction along which highlights are drawn out,
//! which lies across the fine scratches, and the strength (KHR_materials_anisotropy).
//! @use atlas surface/place surface/stencil_marks surface/tangent_frame

@group(1) @binding(0) var scratches: texture_2d_array<f32>;
@group(1) @binding(1) var stencils: texture_2d_array<u32>;
// x and y of the direction, −1..1, and the strength, 0..1.
@group(1) @binding(2) var anisotropies: texture_storage_2d_array<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let marks = textureLoad(stencils, texel.xy, texel.z, 0).x;
    let triangle = owner_of(texel + unpacked_step(marks));
    if texel.x < 0 || triangle == EMPTY || (marks & NO_STENCIL) != 0u {
        return;
    }
    let frame = tangent_frame_at(triangle, texel);
    let up = unit_or(frame.normal, vec3f(0.0, 1.0, 0.0));
    let stored = textureLoad(scratches, texel.xy, texel.z, 0).xyz;
    let along = stored - up * dot(up, stored);
    let across = cross(up, along);
    let tangent = unit_or(frame.tangent, vec3f(1.0, 0.0, 0.0));
    let bitangent = unit_or(frame.bitangent, vec3f(0.0, 1.0, 0.0));
    let direction = unit_or(vec3f(dot(across, tangent), dot(across, bitangent), 0.0), vec3f(1.0, 0.0, 0.0));
    textureStore(anisotropies, texel.xy, texel.z, vec4f(direction.xy, min(length(along), 1.0), 1.0));
}
