//! Where the point of a texel lies on its triangle, as the kernels of sources need it. That of a ghost lies over the seam.
//! @use core atlas surface/place surface/tangent_frame

struct TrianglePoint {
    triangle: u32,
    // From the triangle's first corner, in texels of its chart.
    step: vec2f,
    // Texture coordinates that maps are laid out by.
    uv: vec2f,
    // The texel axes of the chart that reads it, in texels of the triangle's chart, column by column.
    axes: vec4f,
}

fn triangle_point(texel: vec3i, owner: u32) -> TrianglePoint {
    let is_ghost = (owner & GHOST_BIT) != 0u;
    var spot = Spot(select(owner, 0u, is_ghost), vec2f(texel.xy) + 0.5, vec4f(1.0, 0.0, 0.0, 1.0));
    // Processors skip a loop that no texel at hand goes through, and few texels are ghosts.
    for (var links = 0u; links < select(0u, 1u, is_ghost); links++) {
        spot = spot_of(texel, owner);
    }
    let row = spot.triangle * GEOMETRY_ROWS;
    let corner = vec2f(geometry_row(row).w, geometry_row(row + 1u).w);
    let chart = frame_row(spot.triangle * FRAME_ROWS + 3u);
    return TrianglePoint(spot.triangle, spot.point - corner, (spot.point - chart.xy) / dispatch.size, spot.axes);
}

// A row of a table of numbers.
fn table_row(table: texture_2d<u32>, row: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(table, table_texel(row), 0));
}

// Number of the material of a triangle.
fn material_of(triangle: u32) -> u32 {
    return bitcast<u32>(geometry_row(triangle * GEOMETRY_ROWS + 5u).w);
}

fn position_of(point: TrianglePoint) -> vec3f {
    let row = point.triangle * GEOMETRY_ROWS;
    let along = geometry_row(row + 1u).xyz * point.step.x + geometry_row(row + 2u).xyz * point.step.y;
    return geometry_row(row).xyz + along;
}

// The surface gradient of a normal in a tangent frame: `up − n / (n · up)` with `n` in model space.
fn frame_slope(frame: TangentFrame, normal: vec3f) -> vec3f {
    let tilted = normal.x * frame.tangent + normal.y * frame.bitangent + normal.z * frame.normal;
    let up = frame.normal / max(length(frame.normal), 1e-30);
    // A normal that points below the surface has no slope; it counts as very steep.
    let along = max(max(dot(tilted, up), 1e-3 * length(tilted)), 1e-30);
    return select(up - tilted / along, vec3f(0.0), all(normal.xy == vec2f(0.0)));
}
