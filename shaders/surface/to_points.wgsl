//! Brings a plane to points that are spread over the surface: the mean of the texels of the cell of each, by their area.
//! @use atlas surface/place
//! @given StoredField

// For each point its first row and the number of its texels; then rows of two texels each: their indices, page by page and row
// by row, and their shares of the area.
@group(1) @binding(0) var cells: texture_2d<u32>;
@group(1) @binding(1) var texels: texture_2d_array<f32>;
@group(1) @binding(2) var points: StoredField;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let point = owner_of(texel);
    if point == EMPTY {
        return;
    }
    let size = textureDimensions(texels);
    let list = textureLoad(cells, table_texel(point), 0);
    var first = vec4f(0.0);
    var sum = vec4f(0.0);
    for (var index = 0u; index < list.y; index++) {
        let pair = textureLoad(cells, table_texel(list.x + index / 2u), 0);
        let entry = select(pair.xy, pair.zw, (index & 1u) == 1u);
        let row = entry.x / size.x;
        let place = vec2u(entry.x % size.x, row % size.y);
        let value = textureLoad(texels, place, row / size.y, 0);
        // Differences from the first one, so that a constant keeps its bits.
        first = select(first, value, index == 0u);
        sum += bitcast<f32>(entry.y) * (value - first);
    }
    textureStore(points, texel.xy, texel.z, first + sum);
}
