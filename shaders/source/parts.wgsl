//! Values of the parts of a model, or places in the boxes around them.
//! @use core atlas surface/place source/triangle_point source/stored
//! @given StoredField IS_HALF BY HAS_BOXES

// Owners of the rows; of anything else there is one row for all.
const BY_PART: u32 = 0u;
const BY_MATERIAL: u32 = 1u;
const BY_CHART: u32 = 2u;
const BY_PIECE: u32 = 3u;

@group(1) @binding(0) var rows: texture_2d<u32>;
@group(1) @binding(1) var field: StoredField;

fn number_of(triangle: u32) -> u32 {
    if BY == BY_PART {
        return bitcast<u32>(geometry_row(triangle * GEOMETRY_ROWS + 3u).w);
    }
    if BY == BY_MATERIAL {
        return material_of(triangle);
    }
    if BY == BY_CHART {
        return bitcast<u32>(frame_row(triangle * FRAME_ROWS).w);
    }
    if BY == BY_PIECE {
        return bitcast<u32>(frame_row(triangle * FRAME_ROWS + 3u).w);
    }
    return 0u;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY {
        return;
    }
    let point = triangle_point(texel, owner);
    let number = number_of(point.triangle);
    var value = table_row(rows, number);
    if HAS_BOXES {
        // The sides of the box, with the middle of the box in the fourth column.
        let first = table_row(rows, 3u * number);
        let second = table_row(rows, 3u * number + 1u);
        let third = table_row(rows, 3u * number + 2u);
        let away = position_of(point) - vec3f(first.w, second.w, third.w);
        value = vec4f(dot(first.xyz, away), dot(second.xyz, away), dot(third.xyz, away), 1.0);
    }
    textureStore(field, texel.xy, texel.z, stored(value));
}
