//! Brings a plane from points that are spread over the surface to the finest texels: the plane that fits the points around best,
//! near ones more than far ones (moving least squares, Lancaster, Salkauskas 1981).
//! @use atlas surface/place surface/level
//! @given StoredField

// The point in whose cell each texel of the cells' level lies, or the texel that a ghost continues.
@group(1) @binding(1) var point_of_texel: texture_2d_array<u32>;
// Triangles on that level.
@group(1) @binding(2) var cell_frames: texture_2d<u32>;
// For each point its place and its first row; then rows of four points each, those around it, with EMPTY at the end.
@group(1) @binding(3) var around: texture_2d<u32>;
@group(1) @binding(4) var points: texture_2d_array<f32>;
@group(1) @binding(5) var fine: StoredField;

// Reach of a point, in spacings: points are one to one and a half spacings apart.
const REACH: f32 = 1.9;

// The point in whose cell a texel lies; EMPTY where there is none near on the cells' level.
fn point_at(texel: vec3i, owner: u32) -> u32 {
    let row = owner * FRAME_ROWS;
    let place = frame_row(row + 3u);
    let cell_place = textureLoad(cell_frames, table_texel(row + 3u), 0);
    let page = page_of_row(textureLoad(cell_frames, table_texel(row + 1u), 0).w);
    let in_chart = (vec2f(texel.xy) + 0.5 - place.xy) / f32(scale.factor);
    let corner = vec2i(floor(in_chart + bitcast<vec2f>(cell_place.xy)));
    let size = vec2i(textureDimensions(point_of_texel));
    // The texel itself, and the eight around it.
    var found = textureLoad(point_of_texel, clamp(corner, vec2i(0), size - 1), page, 0).r;
    for (var index = 0; index < 9 && found == EMPTY; index++) {
        let near = corner + vec2i(index % 3, index / 3) - 1;
        found = textureLoad(point_of_texel, clamp(near, vec2i(0), size - 1), page, 0).r;
    }
    return found;
}

fn value_of(point: u32) -> vec4f {
    let width = textureDimensions(points).x;
    return textureLoad(points, vec2u(point % width, point / width), 0, 0);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY || (owner & GHOST_BIT) != 0u {
        return;
    }
    let own = point_at(texel, owner);
    if own == EMPTY {
        textureStore(fine, texel.xy, texel.z, vec4f(0.0));
        return;
    }
    let at = surface_at(texel, owner);
    let right = unit_or(cross(at.face_normal, select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(at.face_normal.x) > 0.7)), vec3f(1.0, 0.0, 0.0));
    let ahead = cross(at.face_normal, right);
    // Differences from the own point, so that a constant keeps its bits.
    let base = value_of(own);
    var weights = 0.0;
    var places = vec2f(0.0);
    var squares = vec3f(0.0);
    var values = vec4f(0.0);
    var along = vec4f(0.0);
    var across = vec4f(0.0);
    var list = bitcast<u32>(point_row(own).w);
    var is_done = false;
    while !is_done {
        let four = textureLoad(around, table_texel(list), 0);
        for (var index = 0u; index < 4u; index++) {
            let point = four[index];
            if point == EMPTY {
                is_done = true;
                break;
            }
            let away = (point_row(point).xyz - at.position) / scale.spacing;
            let near = max(1.0 - length(away) / REACH, 0.0);
            // Wendland's function, which ends smoothly.
            let weight = near * near * near * near * (5.0 - 4.0 * near);
            let place = vec2f(dot(away, right), dot(away, ahead));
            let value = value_of(point) - base;
            weights += weight;
            places += weight * place;
            squares += weight * vec3f(place.x * place.x, place.x * place.y, place.y * place.y);
            values += weight * value;
            along += weight * place.x * value;
            across += weight * place.y * value;
        }
        list++;
    }
    weights = max(weights, 1e-12);
    let middle = places / weights;
    let mean = values / weights;
    // A little is added to the squares, so that points on a line have a plane, too.
    let xx = squares.x / weights - middle.x * middle.x + 1e-3;
    let xy = squares.y / weights - middle.x * middle.y;
    let yy = squares.z / weights - middle.y * middle.y + 1e-3;
    let rise = along / weights - middle.x * mean;
    let lift = across / weights - middle.y * mean;
    let slope_x = (yy * rise - xy * lift) / (xx * yy - xy * xy);
    let slope_y = (xx * lift - xy * rise) / (xx * yy - xy * xy);
    textureStore(fine, texel.xy, texel.z, base + mean - slope_x * middle.x - slope_y * middle.y);
}

fn point_row(point: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(around, table_texel(point), 0));
}
