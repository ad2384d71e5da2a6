//! Values of the vertices of a triangle, and texture coordinates and tangents of other UV sets than that of the atlas, from tables.
//! @use core atlas surface/place surface/tangent_frame source/triangle_point source/picture

// Rows of a triangle in a table of coordinates: the coordinates of its first corner, whether it has any, and the sign of the
// bitangent; the change of the coordinates a texel along u and v; then the tangent and its change, where the table has them.
const COORDINATE_ROWS: u32 = 2u;
const COORDINATE_ROWS_WITH_TANGENTS: u32 = 5u;

// A texture of a material.
struct Texture {
    // Transform of texture coordinates, by rows.
    u: vec3f,
    // Rows of a triangle in the table of its own coordinates; 0 where it has those of the atlas.
    coordinate_rows: u32,
    v: vec3f,
    pad: u32,
    picture: Picture,
}

// Footprint of a texel on a picture in the layout of the atlas.
fn own_footprint(point: TrianglePoint) -> Footprint {
    let width = 1.0 / dispatch.size;
    return Footprint(point.uv, vec2f(width, 0.0), vec2f(0.0, width));
}

// Footprint of a texel on a picture in another layout; `rows` is the number of rows of a triangle.
fn other_footprint(table: texture_2d<u32>, rows: u32, point: TrianglePoint) -> Footprint {
    let corner = table_row(table, rows * point.triangle);
    let change = table_row(table, rows * point.triangle + 1u);
    return Footprint(corner.xy + change.xy * point.step.x + change.zw * point.step.y, change.xy, change.zw);
}

// True for a triangle with coordinates for a texture.
fn is_laid_out(coordinates: texture_2d<u32>, own: Texture, triangle: u32) -> bool {
    return own.coordinate_rows == 0u || table_row(coordinates, own.coordinate_rows * triangle).z != 0.0;
}

// A texture at a point; another color on triangles without coordinates for it.
fn texture_mean(
    table: texture_2d<u32>, coordinates: texture_2d<u32>, storage: u32, own: Texture, point: TrianglePoint, otherwise: vec4f,
) -> vec4f {
    var covered = own_footprint(point);
    if own.coordinate_rows != 0u {
        covered = other_footprint(coordinates, own.coordinate_rows, point);
    }
    let mean = footprint_mean(table, storage, own.picture, transformed(covered, own.u, own.v));
    return select(otherwise, mean, is_laid_out(coordinates, own, point.triangle));
}

// The tangent frame of a normal map in another layout.
fn other_frame(table: texture_2d<u32>, own: TangentFrame, point: TrianglePoint) -> TangentFrame {
    let row = COORDINATE_ROWS_WITH_TANGENTS * point.triangle;
    let along = table_row(table, row + 3u).xyz * point.step.x + table_row(table, row + 4u).xyz * point.step.y;
    let tangent = table_row(table, row + 2u).xyz + along;
    return TangentFrame(tangent, table_row(table, row).w * cross(own.normal, tangent), own.normal);
}
