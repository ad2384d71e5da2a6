//! Directions that a texture of a model's material gives in the tangent frame: the slope of its normal map, or its fine scratches.
//! @use core atlas surface/place surface/tangent_frame source/triangle_point source/picture source/coordinates source/stored
//! @given StoredField IS_HALF STORAGE_0 SHOWS_SLOPE

struct Directions {
    // Material whose triangles are filled.
    material: u32,
    // Factor of a slope, or of the strength of scratches.
    factor: f32,
    // Cosine and sine of a rotation of the scratches.
    turn: vec2f,
    used: Texture,
}

@group(1) @binding(0) var<uniform> directions: Directions;
@group(1) @binding(1) var table: texture_2d<u32>;
@group(1) @binding(2) var coordinates: texture_2d<u32>;
@group(1) @binding(3) var field: StoredField;

// The slope of a normal of the map.
fn normal_slope(frame: TangentFrame, color: vec3f) -> vec3f {
    let normal = 2.0 * color - 1.0;
    return frame_slope(frame, vec3f(normal.xy * directions.factor, normal.z));
}

// The direction of fine scratches in model space, as long as they are strong. glTF has the direction across them.
fn scratches(frame: TangentFrame, color: vec3f) -> vec3f {
    let turn = directions.turn;
    let stored = 2.0 * color.xy - 1.0;
    let turned = vec2f(turn.x * stored.x - turn.y * stored.y, turn.y * stored.x + turn.x * stored.y);
    let tangent = unit_or(frame.tangent, vec3f(0.0));
    let bitangent = unit_or(frame.bitangent, vec3f(0.0));
    let across = turned.x * tangent + turned.y * bitangent;
    return unit_or(cross(across, frame.normal), vec3f(0.0)) * (directions.factor * color.z);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY {
        return;
    }
    let point = triangle_point(texel, owner);
    if material_of(point.triangle) != directions.material {
        return;
    }
    let own = tangent_frame(point.triangle, point.step);
    var frame = own;
    // Without a picture there is no slope, and scratches run along the tangent.
    var color = vec4f(select(vec2f(1.0, 0.5), vec2f(0.5), SHOWS_SLOPE), 1.0, 1.0);
    var is_there = false;
    if STORAGE_0 != NO_PICTURE {
        is_there = is_laid_out(coordinates, directions.used, point.triangle);
        color = texture_mean(table, coordinates, STORAGE_0, directions.used, point, color);
    }
    if is_there && directions.used.coordinate_rows == COORDINATE_ROWS_WITH_TANGENTS {
        frame = other_frame(coordinates, own, point);
    }
    var value = scratches(frame, color.xyz);
    if SHOWS_SLOPE {
        value = select(vec3f(0.0), normal_slope(frame, color.xyz), is_there);
    }
    textureStore(field, texel.xy, texel.z, stored(vec4f(value, 1.0)));
}
