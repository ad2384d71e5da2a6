//! The linked atlas as kernels read it: the triangle under each texel, the links of ghosts, and the triangles' tables.
//!
//! Linked to every kernel. Nodes go through `lib/surface`.
//! @given SURFACE_GROUP

const EMPTY: u32 = 0xffffffffu;
const GHOST_BIT: u32 = 0x80000000u;
// Rows of four floats a triangle has in `geometry` and in `frames`, and a link in `ghosts`.
const GEOMETRY_ROWS: u32 = 6u;
const FRAME_ROWS: u32 = 4u;
const GHOST_ROWS: u32 = 4u;
// Rows of four floats a piece has in `pieces`.
const PIECE_ROWS: u32 = 3u;

// Bits of the longest straight step.
const LEAP_BITS: u32 = 6u;

struct Pass {
    // First tile of this dispatch in the tile list, and one past the last; of kernels over groups of a survey, 64 groups each.
    first_tile: u32,
    end_tile: u32,
    // Number of workgroups along x.
    row_length: u32,
    // Texels for one unit of UV.
    size: f32,
    // As in `Round`.
    round: u32,
    rounds: u32,
    texel: f32,
    finest: f32,
    // The largest coordinate of the model, working units.
    farthest: f32,
    // Page and first row of what kernels of points write, where that is a band of the atlas.
    first_page: u32,
    first_row: u32,
    pad_1: u32,
}

struct GhostLink {
    // Texel coordinates of the point over the seam, in the chart of its triangle.
    target_texel: vec2f,
    triangle: u32,
    // The ghost's own texel: column | row << 16, and its page.
    texel: u32,
    page: u32,
    // Page of the target's chart.
    target_page: u32,
    chart: u32,
    // Carries own texel vectors to texel vectors of the target's chart, column by column.
    target_from_own: vec4f,
}

// Source of a ghost's stored values.
struct GhostRead {
    // Texel coordinates, and the page.
    texel: vec2f,
    page: u32,
    // The step from the ghost to the nearest owned texel of its own chart: x + 2 | (y + 2) << 3.
    anchor: u32,
}

@group(SURFACE_GROUP) @binding(0) var<uniform> dispatch: Pass;
@group(SURFACE_GROUP) @binding(1) var<storage, read> tiles: array<u32>;
@group(SURFACE_GROUP) @binding(2) var owners: texture_2d_array<u32>;
// Tables are textures of bit patterns, row after row of the table: each texel reads a place of its own, which processors
// do faster from a texture than from a buffer.
@group(SURFACE_GROUP) @binding(3) var geometry: texture_2d<u32>;
@group(SURFACE_GROUP) @binding(4) var frames: texture_2d<u32>;
@group(SURFACE_GROUP) @binding(5) var ghosts: texture_2d<u32>;
@group(SURFACE_GROUP) @binding(6) var<storage, read> pieces: array<vec4f>;
// For each texel the length of the longest straight step, in texels, in `LEAP_BITS` bits, and in two bits the planes under it,
// see `planes_under`.
@group(SURFACE_GROUP) @binding(7) var leaps: texture_2d_array<u32>;

// Rays of each place, in kernels that shoot them.
var<private> ray_count: u32 = 1u;

// Tables are textures of two to the power of so many texels side by side.
const TABLE_BITS: u32 = 13u;

// Texel of a table's texture that holds a row.
fn table_texel(row: u32) -> vec2u {
    return vec2u(row & ((1u << TABLE_BITS) - 1u), row >> TABLE_BITS);
}

fn geometry_row(row: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(geometry, table_texel(row), 0));
}

fn frame_row(row: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(frames, table_texel(row), 0));
}

// Page of a triangle's chart, which shares a number with the sign of the bitangent.
fn page_of_row(page_and_sign: u32) -> i32 {
    return i32(page_and_sign >> 1u);
}

fn bitangent_sign_of(page_and_sign: f32) -> f32 {
    return select(1.0, -1.0, (bitcast<u32>(page_and_sign) & 1u) != 0u);
}

fn ghost_link(index: u32) -> GhostLink {
    let row = index * GHOST_ROWS;
    let a = textureLoad(ghosts, table_texel(row), 0);
    let b = textureLoad(ghosts, table_texel(row + 1u), 0);
    let c = textureLoad(ghosts, table_texel(row + 2u), 0);
    return GhostLink(bitcast<vec2f>(a.xy), a.z, a.w, b.x, b.y, b.z, bitcast<vec4f>(c));
}

// A ghost and the four texels around its point over the seam, where tables of plain or coupled ghosts are bound in the
// place of that of all.
struct FillLink {
    // The lowest of the four, and its page.
    corner: vec2i,
    page: i32,
    // Distance of the point from it towards the highest.
    weight: vec2f,
    // The ghost itself.
    texel: vec2i,
    own_page: i32,
}

fn fill_link(table_row: u32) -> FillLink {
    let row = textureLoad(ghosts, table_texel(table_row), 0);
    let pages = vec2i(i32(row.w & 0xffffu), i32(row.w >> 16u));
    let corner = vec2i(i32(row.x & 0xffffu), i32(row.x >> 16u));
    let weight = vec2f(f32(row.y & 0xffffu), f32(row.y >> 16u)) / 65536.0;
    return FillLink(corner, pages.x, weight, vec2i(i32(row.z & 0xffffu), i32(row.z >> 16u)), pages.y);
}

fn ghost_read(index: u32) -> GhostRead {
    let row = textureLoad(ghosts, table_texel(index * GHOST_ROWS + 3u), 0);
    return GhostRead(bitcast<vec2f>(row.xy), row.z, row.w);
}

fn owner_of(texel: vec3i) -> u32 {
    if texel.x < 0 {
        return EMPTY;
    }
    return textureLoad(owners, texel.xy, texel.z, 0).r;
}

// Normals of a triangle's plane and, at a point of it, of its shading.
struct Facing {
    face: vec3f,
    shading: vec3f,
}

// The normal of a triangle's plane by its steps a texel. The sign of the texel's width, which is with the second of them,
// says that the chart is mirrored, which turns the cross product over.
fn face_along(along_u: vec4f, along_v: vec4f) -> vec3f {
    let turned = select(1.0, -1.0, along_v.w < 0.0);
    return unit_or(cross(along_v.xyz, along_u.xyz) * turned, vec3f(0.0, 1.0, 0.0));
}

fn leap_of(texel: vec3i) -> f32 {
    return f32(textureLoad(leaps, texel.xy, texel.z, 0).r & ((1u << LEAP_BITS) - 1u));
}

// Whether one plane lies under two quarters of a texel that face each other: bit 0 for those towards lower columns and rows
// and towards higher ones, bit 1 for the other two.
fn planes_under(texel: vec3i) -> u32 {
    return textureLoad(leaps, texel.xy, texel.z, 0).r >> LEAP_BITS;
}

fn facing_of(triangle: u32, position: vec3f) -> Facing {
    let g = triangle * GEOMETRY_ROWS;
    let origin = geometry_row(g);
    let along_u = geometry_row(g + 1u);
    let along_v = geometry_row(g + 2u);
    let face = face_along(along_u, along_v);
    // Texel coordinates of the nearest point on the triangle's plane.
    let away = position - origin.xyz;
    let metric = vec3f(dot(along_u.xyz, along_u.xyz), dot(along_u.xyz, along_v.xyz), dot(along_v.xyz, along_v.xyz));
    let right = vec2f(dot(away, along_u.xyz), dot(away, along_v.xyz));
    let determinant = max(metric.x * metric.z - metric.y * metric.y, 1e-30);
    let step = vec2f(metric.z * right.x - metric.y * right.y, metric.x * right.y - metric.y * right.x) / determinant;
    let normal = geometry_row(g + 3u).xyz + geometry_row(g + 4u).xyz * step.x + geometry_row(g + 5u).xyz * step.y;
    return Facing(face, unit_or(normal, face));
}

fn unit_or(v: vec3f, fallback: vec3f) -> vec3f {
    let square = dot(v, v);
    return select(fallback, v * inverseSqrt(max(square, 1e-30)), square > 1e-30);
}
