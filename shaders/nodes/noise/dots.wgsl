//! Dots
//! Round dots scattered over the surface: spots, speckles, pores, rivets.
//!
//! Points in space near the surface, each drawn as a disk on it: dots are round, of the same size on every side of a model,
//! and run over seams. Where the surface curves more tightly than the dots are wide they get smaller, and
//! a sharp edge may cut one off. Dots smaller than a texel become faint; dots closer than the texels fade to their mean.
//! @alias dots spots speckles pores polka rivets freckles splatter drops tile sampler scatter
//! @use cells

struct Params {
    /// Mean diameter of a dot. The largest dots, with their soft borders, are limited to twice the spacing.
    /// @length @range 0.0001 100 @soft 0.002 0.2 @default 0.02
    size: f32,
    /// Mean distance between neighboring dots; dots smaller than 0.45 times this never touch.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.06
    spacing: f32,
    /// Sharpness of the borders: 1 is a sharp line, 0 fades from the center.
    /// @range 0 1 @default 0.8
    sharpness: f32,
    /// Variation of the size of dots.
    /// @range 0 1 @default 0.3
    variation: f32,
    /// Stretches the dots along the axes of the pattern.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The dot of a place.
/// @shared
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
fn found(at: Surface, position: vec3f, params: Params) -> Dot {
    let unit = 0.5 * params.spacing;
    let place = cells_place(position, unit, params.stretch, params.rotate);
    // A plane's normal where space is drawn out.
    let normal = normalize(noise_direction(at.normal, params.rotate) * params.stretch);
    let key = seed_key(params.seed);
    let texel = min(at.texel_size / (unit * finest_stretch(params.stretch)), 2.0);
    let softness = 1.0 - params.sharpness;
    let reach = min(outer_radius(1.0 + params.variation, softness, texel, params), 3.0);
    let cell = cell_of(place);
    let inside = place - vec3f(cell);
    let side = select(vec3i(-1), vec3i(1), inside > vec3f(0.5));
    let border = min(inside, 1.0 - inside);
    let slab = slab_of(params);
    let thick = slab + 0.5 * dot(abs(normal), vec3f(1.0));
    var clear = 1.0;
    var found = Dot(0.0, 0.0, 0u);
    var walk = CubeWalk(vec3i(0), true);
    for (var n = 0; n < 400; n++) {
        let cube = cube_at(walk, side, border);
        walk = next_cube(walk, 7, cube.distance < reach * reach);
        if !walk.goes_on {
            break;
        }
        if abs(dot(normal, vec3f(cube.step) + 0.5 - inside)) > thick {
            continue;
        }
        let random = cell_random(cell + cube.step, key);
        let offset = vec3f(cube.step) + unit_random3(random) - inside;
        let rise = dot(normal, offset);
        let away = sqrt(max(dot(offset, offset) - rise * rise, 0.0));
        if abs(rise) >= slab || away >= reach || !counts(random, slab) {
            continue;
        }
        let size = own_size(random, params);
        if away >= outer_radius(size, softness, texel, params) {
            continue;
        }
        let whole = presence(rise / slab) * room(cell + cube.step, offset, normal, slab, key);
        let radius = size * whole * mean_radius(softness, params);
        clear *= 1.0 - disk_cover(away, radius, softness, texel);
        let depth = 1.0 - away / max(radius, 1e-6);
        found.id = select(found.id, number_of(random.yzx), depth > found.depth);
        found.depth = max(found.depth, depth);
    }
    found.cover = 1.0 - clear;
    return found;
}

/// The dots: 1 inside, 0 between them.
fn mask(at: Surface, found: Dot, params: Params) -> f32 {
    // Down to texels as wide as the spacing each dot is seen by itself.
    let seen = carried(4.0 * params.spacing * finest_stretch(params.stretch), at.texel_size);
    return mix(mean_cover(params), found.cover, seen);
}

/// A random value for each dot; 0 between them.
fn id(found: Dot) -> f32 {
    return select(0.0, unit_random(found.id), found.depth > 0.0);
}

// Everything below is counted in cubes of half the spacing. Points in a slab around the surface, as thick as this twice,
// make 1.5 dots for each square of the spacing, of which 1 is left when those too close to another one are gone. Large
// dots need a thicker slab, or a curved surface would leave it within a dot; then only some of the points count.
const THINNEST: f32 = 0.18;

fn slab_of(params: Params) -> f32 {
    return max(THINNEST, 0.6 * mean_radius(1.0 - params.sharpness, params));
}

fn counts(random: vec3u, slab: f32) -> bool {
    return unit_random(number_of(random.zxy)) * slab < THINNEST;
}

// Two dots are at least this far apart (Matérn's second hard-core process: of two that are closer, the one with the
// smaller number goes).
const APART: f32 = 0.9;

struct Dot {
    cover: f32,
    // How far inside of the dot's border the place is, as a share of its radius.
    depth: f32,
    id: u32,
}

// The mean radius, held where no dot reaches further than the cubes that are looked at.
fn mean_radius(softness: f32, params: Params) -> f32 {
    return min(params.size / params.spacing, 2.0 / ((1.0 + params.variation) * (1.0 + softness)));
}

// Where a dot of `size` times the mean ends.
fn outer_radius(size: f32, softness: f32, texel: f32, params: Params) -> f32 {
    let radius = size * mean_radius(softness, params);
    return radius + length(vec2f(radius * softness, 0.5 * texel));
}

// How large a dot is, compared with the mean one.
fn own_size(random: vec3u, params: Params) -> f32 {
    return 1.0 + params.variation * (2.0 * unit_random(number_of(random.yxz)) - 1.0);
}

// 1 inside of the slab, falling to 0 close to its sides: a dot that a curved surface leaves shrinks instead of being cut.
fn presence(rise: f32) -> f32 {
    let x = rise * rise;
    let x4 = x * x * x * x;
    return sqrt(max(1.0 - x4 * x4, 0.0));
}

// 0 if another point with a larger number is too close, 1 if not, little between.
fn room(cell: vec3i, offset: vec3f, normal: vec3f, slab: f32, key: vec3u) -> f32 {
    let own = cell_random(cell, key);
    let number = number_of(own);
    let corner = offset - unit_random3(own);
    var room = 1.0;
    for (var i = 0; i < 9; i++) {
        // Three at a time and without branches, so that processors can work on all of them at once.
        for (var j = -1; j < 2; j++) {
            let step = vec3i(j, i % 3 - 1, i / 3 - 1);
            let random = cell_random(cell + step, key);
            let other = corner + vec3f(step) + unit_random3(random);
            let rise = dot(normal, other);
            let between = other - offset;
            let lift = dot(normal, between);
            let square = dot(between, between) - lift * lift;
            let close = clamp((APART * APART - square) * 10.0, 0.0, 1.0);
            let strong = clamp((slab - abs(rise)) * 9.0 / slab, 0.0, 1.0);
            room *= 1.0 - select(0.0, close * strong, number_of(random) > number && counts(random, slab));
        }
    }
    return room;
}

// A number of its own for each point, whatever its place.
fn number_of(random: vec3u) -> u32 {
    return (random.x * 747796405u) ^ (random.y * 277803737u) ^ (random.z << 24u);
}

// A disk as a texel sees it: the border widened to a texel, and the whole as much fainter as it got larger.
fn disk_cover(away: f32, radius: f32, softness: f32, texel: f32) -> f32 {
    let soft = radius * softness;
    let ramp = max(length(vec2f(soft, 0.5 * texel)), 1e-6);
    let cover = clamp((radius + ramp - away) / (2.0 * ramp), 0.0, 1.0);
    // Areas, divided by pi: a disk that fades out evenly; one without a whole middle is a cone.
    let area = radius * radius + soft * soft / 3.0;
    let outer = radius + ramp;
    let cone = outer * outer * outer / (6.0 * ramp);
    let widened = select(cone, radius * radius + ramp * ramp / 3.0, radius > ramp);
    return cover * area / max(widened, 1e-12);
}

// The covered share of the surface, fitted to what was measured.
fn mean_cover(params: Params) -> f32 {
    let softness = 1.0 - params.sharpness;
    let radius = 0.5 * mean_radius(softness, params);
    let square = radius * radius * (1.0 + params.variation * params.variation / 3.0) * (1.0 + softness * softness / 3.0);
    return 1.0 - exp2(-square * (4.9 + 10.7 * square * square));
}
