//! Colors of the model's vertices.
//! @use core atlas surface/place source/triangle_point source/stored
//! @given StoredField IS_HALF IS_ALPHA

// Rows of a triangle in `corners`: the numbers of its vertices; the change of the weights of its second and third one, a texel
// along u and v.
const CORNER_ROWS: u32 = 2u;

@group(1) @binding(0) var corners: texture_2d<u32>;
@group(1) @binding(1) var colors: texture_2d<u32>;
@group(1) @binding(2) var field: StoredField;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY {
        return;
    }
    let point = triangle_point(texel, owner);
    let vertices = textureLoad(corners, table_texel(CORNER_ROWS * point.triangle), 0);
    let change = table_row(corners, CORNER_ROWS * point.triangle + 1u);
    // The center of a texel may lie outside its triangle; colors are not extrapolated.
    let weights = max(vec2f(dot(change.xy, point.step), dot(change.zw, point.step)), vec2f(0.0));
    let inside = weights / max(weights.x + weights.y, 1.0);
    let first = table_row(colors, vertices.x);
    let color = first + (table_row(colors, vertices.y) - first) * inside.x + (table_row(colors, vertices.z) - first) * inside.y;
    let shown = select(vec4f(color.xyz, 1.0), vec4f(color.w, 0.0, 0.0, 1.0), IS_ALPHA);
    textureStore(field, texel.xy, texel.z, stored(shown));
}
