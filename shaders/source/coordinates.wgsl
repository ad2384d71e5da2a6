//! Values of the vertices of a triangle, and texture coordinates and tangents of other UV sets than that of the atlas, from tables.
//! @use core atlas surface/place surface/tangent_frame source/triangle_point source/picture

// Rows of a triangle in a table of coordinates: the coordinates of its first corner, whether it has any, and the sign of the
// bitangent; the change of the coordinates a texel along u and v; then the tangent and its change, where the table has them.
const COORDINATE_ROWS: u32 = 2u;
const COORDINATE_ROWS_WITH_TANGENTS: u32 = 5u;

fn coordinate_row(table: texture_2d<u32>, row: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(table, table_texel(row), 0));
}

// Footprint of a texel on a picture in the layout of the atlas.
fn own_footprint(point: TrianglePoint) -> Footprint {
    let width = 1.0 / dispatch.size;
    return Footprint(point.uv, vec2f(width, 0.0), vec2f(0.0, width));
}

// Footprint of a texel on a picture in another layout; `rows` is the number of rows of a triangle.
fn other_footprint(table: texture_2d<u32>, rows: u32, point: TrianglePoint) -> Footprint {
    let corner = coordinate_row(table, rows * point.triangle);
    let change = coordinate_row(table, rows * point.triangle + 1u);
    return Footprint(corner.xy + change.xy * point.step.x + change.zw * point.step.y, change.xy, change.zw);
}

// Whether a triangle has coordinates of another layout.
fn is_laid_out(table: texture_2d<u32>, rows: u32, triangle: u32) -> bool {
    return coordinate_row(table, rows * triangle).z != 0.0;
}

// The tangent frame of a normal map in another layout.
fn other_frame(table: texture_2d<u32>, own: TangentFrame, point: TrianglePoint) -> TangentFrame {
    let row = COORDINATE_ROWS_WITH_TANGENTS * point.triangle;
    let along = coordinate_row(table, row + 3u).xyz * point.step.x + coordinate_row(table, row + 4u).xyz * point.step.y;
    let tangent = coordinate_row(table, row + 2u).xyz + along;
    return TangentFrame(tangent, coordinate_row(table, row).w * cross(own.normal, tangent), own.normal);
}
