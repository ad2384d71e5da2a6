//! Projections of a picture onto the surface: by texture coordinates, triplanar, or as a decal.
//! @use core atlas surface/place surface/tangent_frame source/triangle_point source/picture source/coordinates
//! @given WAY READS_PLACE

// Ways to project.
const BY_UV: u32 = 0u;
const TRIPLANAR: u32 = 1u;

// Angle over which a decal fades out where the surface turns away, radians: ten degrees.
const FACING_FADE: f32 = 0.17453293;
// Part of a decal's depth over which it fades out.
const DEPTH_FADE: f32 = 0.1;

// Lengths and positions in working units, directions in model space.
struct Projection {
    // Width of a tile, or of the decal.
    size: f32,
    // Height of a tile divided by its width.
    aspect: f32,
    // Cosine and sine of the rotation, counter-clockwise as seen.
    turn: vec2f,
    // To the right and up, in tiles.
    offset: vec2f,
    // Repeats of the texture coordinates.
    tiles: vec2f,
    // Columns and rows of pictures in the file.
    cells: vec2f,
    // Half a pixel of the file, in texture coordinates.
    half_pixel: vec2f,
    middle: vec3f,
    // Largest angle between the normal of the surface and that of a decal, radians.
    facing: f32,
    right: vec3f,
    // Exponent of the weights of the three sides.
    sharpness: f32,
    up: vec3f,
    // Reach of a decal in front of its middle and behind it.
    depth: f32,
    toward: vec3f,
    pad: f32,
}

// Position where a picture is read, of the surface or connected (`READS_PLACE`), and its change over one texel along the u and the v of the atlas: lengths, or texture
// coordinates with y upward.
struct ReadPlace {
    at: vec3f,
    along: vec3f,
    across: vec3f,
}

// A picture at a point of the surface, as seen from one direction.
struct View {
    footprint: Footprint,
    // Weight in the result; the weights of all views of a point sum to 1.
    weight: f32,
    // 1, or less where a decal ends.
    cover: f32,
    // Directions on the surface in which the picture's x and y grow; not those of the tangent frame.
    has_axes: bool,
    right: vec3f,
    up: vec3f,
}

// The place of the surface itself.
fn own_place(point: TrianglePoint) -> ReadPlace {
    let row = point.triangle * GEOMETRY_ROWS;
    return ReadPlace(position_of(point), geometry_row(row + 1u).xyz, geometry_row(row + 2u).xyz);
}

// The view from one of three sides, or the only one.
fn view_of(projection: Projection, point: TrianglePoint, normal: vec3f, read: ReadPlace, side: u32) -> View {
    if WAY == BY_UV {
        return uv_view(projection, point, read);
    }
    if WAY == TRIPLANAR {
        return side_view(projection, normal, read, side);
    }
    return decal_view(projection, normal, read);
}

fn uv_view(projection: Projection, point: TrianglePoint, read: ReadPlace) -> View {
    if !READS_PLACE {
        return View(tiled(projection, own_footprint(point)), 1.0, 1.0, false, vec3f(0.0), vec3f(0.0));
    }
    let uv = vec2f(read.at.x, 1.0 - read.at.y);
    let up = vec2f(1.0, -1.0);
    let footprint = tiled(projection, Footprint(uv, read.along.xy * up, read.across.xy * up));
    // The directions in which x and y grow on the surface, along the texels of the chart that reads it.
    let row = point.triangle * GEOMETRY_ROWS;
    let texel_u = geometry_row(row + 1u).xyz;
    let texel_v = geometry_row(row + 2u).xyz;
    let along = texel_u * point.axes.x + texel_v * point.axes.y;
    let across = texel_u * point.axes.z + texel_v * point.axes.w;
    let right = gradient_of(along, across, vec2f(read.along.x, read.across.x));
    let upward = gradient_of(along, across, vec2f(read.along.y, read.across.y));
    let has_axes = any(right != vec3f(0.0)) && any(upward != vec3f(0.0));
    return View(footprint, 1.0, 1.0, has_axes, right, upward);
}

// Direction of the tangent vector whose products with the sides of a texel are the changes along them; 0 where there is no change.
fn gradient_of(along: vec3f, across: vec3f, change: vec2f) -> vec3f {
    let metric = vec3f(dot(along, along), dot(along, across), dot(across, across));
    let of_along = metric.z * change.x - metric.y * change.y;
    let of_across = metric.x * change.y - metric.y * change.x;
    // Scaled before it is squared, as both are tiny.
    let scale = max(abs(of_along) * length(along), abs(of_across) * length(across));
    return unit_or((of_along * along + of_across * across) / max(scale, 1e-37), vec3f(0.0));
}

// The footprint of texture coordinates on the repeated picture.
fn tiled(projection: Projection, own: Footprint) -> Footprint {
    let middle = 0.5 * projection.tiles + vec2f(-projection.offset.x, projection.offset.y);
    let uv = turned_uv(projection, own.uv - 0.5) + middle;
    return Footprint(uv, turned_uv(projection, own.along), turned_uv(projection, own.across));
}

// v points down, angles are counter-clockwise.
fn turned_uv(projection: Projection, v: vec2f) -> vec2f {
    let x = v.x * projection.tiles.x;
    let y = -v.y * projection.tiles.y;
    let turn = projection.turn;
    return vec2f(turn.x * x + turn.y * y, turn.y * x - turn.x * y);
}

fn side_view(projection: Projection, normal: vec3f, read: ReadPlace, side: u32) -> View {
    let weights = pow(abs(normal), vec3f(projection.sharpness));
    let weight = weights[side] / max(weights.x + weights.y + weights.z, 1e-30);
    // The picture faces outward on both sides; at the change of sides its weight is 0.
    let facing = select(1.0, -1.0, normal[side] < 0.0);
    let right = select(vec3f(facing, 0.0, 0.0), vec3f(0.0, 0.0, -facing), side == 0u);
    let up = select(vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, -1.0), side == 1u);
    let footprint = on_plane(projection, right, up, vec3f(0.0), read);
    return View(footprint, select(0.0, weight, weight > 1e-6), 1.0, true, right, up);
}

fn decal_view(projection: Projection, normal: vec3f, read: ReadPlace) -> View {
    let footprint = on_plane(projection, projection.right, projection.up, projection.middle, read);
    // Part of the texel that lies on the picture, estimated from the extent of the texel.
    let extent = max(abs(footprint.along) + abs(footprint.across), vec2f(1e-9));
    let inside = clamp(0.5 + min(footprint.uv, 1.0 - footprint.uv) / extent, vec2f(0.0), vec2f(1.0));
    let away = abs(dot(read.at - projection.middle, projection.toward));
    let deep = clamp((projection.depth - away) / max(DEPTH_FADE * projection.depth, 1e-9), 0.0, 1.0);
    let angle = acos(clamp(dot(normal, projection.toward), -1.0, 1.0));
    let faces = clamp((projection.facing - angle) / FACING_FADE, 0.0, 1.0);
    return View(footprint, 1.0, inside.x * inside.y * deep * faces, true, projection.right, projection.up);
}

// The footprint of a texel on a picture in a plane, with its center at `middle`.
fn on_plane(projection: Projection, right: vec3f, up: vec3f, middle: vec3f, read: ReadPlace) -> Footprint {
    let across = projection.turn.x * right + projection.turn.y * up;
    let upward = projection.turn.x * up - projection.turn.y * right;
    let scale = vec2f(1.0, -1.0 / projection.aspect) / projection.size;
    let away = read.at - middle;
    let uv = vec2f(dot(away, across), dot(away, upward)) * scale;
    return Footprint(
        uv + vec2f(0.5 - projection.offset.x, 0.5 + projection.offset.y),
        vec2f(dot(read.along, across), dot(read.along, upward)) * scale,
        vec2f(dot(read.across, across), dot(read.across, upward)) * scale,
    );
}

// The footprint on the file of one on a single picture, from 0 for the first to 1 for the last one, which does not reach over
// its borders.
fn in_cell(projection: Projection, own: Footprint, cell: f32) -> Footprint {
    let cells = projection.cells;
    let number = min(floor(clamp(cell, 0.0, 1.0) * cells.x * cells.y), cells.x * cells.y - 1.0);
    let row = floor((number + 0.5) / cells.x);
    let place = vec2f(number - row * cells.x, row);
    let along = own.along / cells;
    let across = own.across / cells;
    let is_inside = (own.uv >= vec2f(0.0)) & (own.uv <= vec2f(1.0));
    let inside = select(own.uv - floor(own.uv), own.uv, is_inside);
    let reach = 0.5 * (abs(along) + abs(across)) + projection.half_pixel;
    let margin = min(reach * cells, vec2f(0.5));
    return Footprint((place + clamp(inside, margin, 1.0 - margin)) / cells, along, across);
}

// The surface gradient in model space of a normal of the picture in a view.
fn view_slope(projection: Projection, view: View, frame: TangentFrame, normal: vec3f) -> vec3f {
    let turn = projection.turn;
    let turned = vec3f(turn.x * normal.x - turn.y * normal.y, turn.y * normal.x + turn.x * normal.y, normal.z);
    // The gradient in space of a height that is constant along the projection, and its part in the surface
    // (Mikkelsen 2020, "Surface Gradient-Based Bump Mapping Framework").
    let steep = max(max(normal.z, 1e-3 * length(normal)), 1e-30);
    let gradient = -(turned.x * view.right + turned.y * view.up) / steep;
    let up = unit_or(frame.normal, vec3f(0.0));
    return select(frame_slope(frame, turned), gradient - dot(gradient, up) * up, view.has_axes);
}
