//! Tiling without visible repeats: a plane of overlapping hexagonal patches, each of which shows another part of a picture.
//!
//! The grid and its weights are those of Mikkelsen 2022, "Practical Real-Time Hex-Tiling" (JCGT 11(2)). Patches are blended
//! such that mean and variance of the picture stay (Heitz and Neyret 2018, "High-Performance By-Example Noise using a
//! Histogram-Preserving Blending Operator", section 3.2): the weighted sum of deviations from the mean, divided by the length
//! of the weights. Weights do not depend on the picture, so that several pictures of one material stay aligned.
//! @use core hash source/picture

// Triangles of the grid along a side of a tile: two hexagons and a half fit into it.
const PATCH_GRID: f32 = 3.4641016;
const SQRT_3: f32 = 1.7320508;

// Arrangement of patches.
struct Patches {
    seed: u32,
    // Largest rotation of a patch, radians.
    most_turned: f32,
    // Height of the picture divided by its width.
    aspect: f32,
}

// Part of a picture that a patch shows at a point.
struct Patch {
    footprint: Footprint,
    // Factor of the deviation from the picture's mean; the squares of all patches of a point sum to 1.
    weight: f32,
    // Cosine and sine of the rotation of the patch, counter-clockwise.
    turn: vec2f,
}

// Corners of the triangle of the grid around a point, with weights that sum to 1.
struct PatchCorners {
    first: vec2i,
    second: vec2i,
    third: vec2i,
    weights: vec3f,
}

fn patch_corners(at: vec2f) -> PatchCorners {
    let skewed = vec2f(at.x - at.y / SQRT_3, 2.0 * at.y / SQRT_3);
    let base = vec2i(floor(skewed));
    let inside = skewed - floor(skewed);
    let rest = 1.0 - inside.x - inside.y;
    let is_low = rest > 0.0;
    return PatchCorners(
        base + select(vec2i(1, 1), vec2i(0, 0), is_low),
        base + select(vec2i(1, 0), vec2i(0, 1), is_low),
        base + select(vec2i(0, 1), vec2i(1, 0), is_low),
        select(vec3f(-rest, 1.0 - inside.y, 1.0 - inside.x), vec3f(rest, inside.y, inside.x), is_low),
    );
}

// Three random numbers from 0 to 1 for a corner of the grid.
fn patch_random(seed: u32, corner: vec2i) -> vec3f {
    let row = u32(corner.y);
    let first = pcg(pcg(seed ^ 0x9e3779b9u) ^ u32(corner.x));
    let second = pcg(first ^ ((row << 16u) | (row >> 16u)));
    let third = pcg(second ^ 0x85ebca6bu);
    return vec3f(vec3u(second, third, pcg(third))) / 4294967295.0;
}

// The patch of one of the corners, 0 to 2, at a footprint on the repeated picture.
fn patch_at(patches: Patches, whole: Footprint, index: u32) -> Patch {
    // On a plane where the picture is as wide as 1 and has square pixels.
    let at = vec2f(whole.uv.x, whole.uv.y * patches.aspect);
    let corners = patch_corners(at * PATCH_GRID);
    let squares = corners.weights * corners.weights;
    // Patches fade over a part of their width only.
    let weights = squares * squares;
    var corner = select(corners.second, corners.first, index == 0u);
    corner = select(corner, corners.third, index == 2u);
    let random = patch_random(patches.seed, corner);
    let middle = vec2f(f32(corner.x) + 0.5 * f32(corner.y), 0.5 * SQRT_3 * f32(corner.y)) / PATCH_GRID;
    let angle = (2.0 * random.z - 1.0) * patches.most_turned;
    let turn = vec2f(cos(angle), sin(angle));
    let place = patch_turned(patches, turn, at - middle);
    let uv = place + vec2f(middle.x, middle.y / patches.aspect) + random.xy;
    let along = patch_turned(patches, turn, vec2f(whole.along.x, whole.along.y * patches.aspect));
    let across = patch_turned(patches, turn, vec2f(whole.across.x, whole.across.y * patches.aspect));
    return Patch(Footprint(uv, along, across), weights[index] / length(weights), turn);
}

fn patch_turned(patches: Patches, turn: vec2f, v: vec2f) -> vec2f {
    return vec2f(turn.x * v.x - turn.y * v.y, (turn.y * v.x + turn.x * v.y) / patches.aspect);
}
