//! Colonies
//! Colonies that grow outward from many places and stop where they meet: lichen, mold, moss cushions, rust blooms.
//!
//! Each colony is lobed at its border, banded by its age and old in its middle. There are three sizes of them; where two
//! meet a thin border stays free. They grow around corners and over seams. Connect Age to a color gradient for rings, Id for
//! colonies of different tones, and Height to the height map of a layer.
//! @alias lichen mold mould fungus colony growth eden dla thallus crust patches blooms moss algae rosette spores mildew
//! @use cells

struct Params {
    /// Diameter of the largest colonies. The others have a half and a quarter of it.
    /// @length @range 0.0005 100 @soft 0.02 1 @default 0.22
    size: f32,
    /// How many colonies there are: at 1, and grown to their full size, they cover more than half of the surface.
    /// @range 0 1 @default 0.5
    amount: f32,
    /// How far they have grown: at 0 none has started, at 1 all have their full size.
    /// @range 0 1 @default 0.85
    age: f32,
    /// How lobed the border is: 0 makes round colonies, 1 fingers with deep clefts between them.
    /// @range 0 1 @default 0.55
    lobes: f32,
    /// Number of bands of age from the middle to the border; 0 makes none.
    /// @range 0 12 @default 4
    rings: f32,
    /// How much of the old middle has died and fallen out, at random.
    /// @range 0 1 @default 0.15
    hollow: f32,
    /// Share of small colonies: 0 leaves only the largest size.
    /// @range 0 1 @default 0.7
    small: f32,
    /// Width of the border that stays free where colonies meet, as a share of Size.
    /// @range 0 0.2 @default 0.015
    gap: f32,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The colony of a place.
/// @shared
/// @input position Where the colonies are read; connect a moved position to warp them. @vector @optional @default at.position
/// @input density How well they grow here: 1 lets them reach their full size, 0 keeps them away. @optional @default 1
fn colony(at: Surface, position: vec3f, density: f32, params: Params) -> Colony {
    var near: Nearest;
    for (var kind = 0u; kind < 3u; kind++) {
        near = gathered(near, kind, position, density, params);
    }
    var first = Colony(0u, -1e9, 0.0, 0.0, 1.0);
    var second = -1e9;
    for (var i = 0; i < 4; i++) {
        let next = near.first;
        if next.inward <= 0.0 {
            break;
        }
        near = Nearest(near.second, near.third, near.fourth, near.fourth);
        let colony = grown(next, at.texel_size, params);
        second = max(second, min(first.inward, colony.inward));
        if colony.inward > first.inward {
            first = colony;
        }
    }
    // Both have come equally far where they meet.
    let meeting = 0.5 * (first.inward - second) - 0.5 * params.gap * params.size;
    first.inward = min(first.inward, meeting);
    return hollowed(position, first, params);
}

/// The colonies: 1 inside, 0 between them.
fn mask(at: Surface, colony: Colony, density: f32, params: Params) -> f32 {
    return mix(mean_cover(density, params), cover_of(at, colony), seen(at, params));
}

/// Age of the place in its colony: 0 at the border, which has grown last, 1 at the origin; 0 between colonies.
fn age(at: Surface, colony: Colony) -> f32 {
    return clamp(colony.age, 0.0, 1.0) * cover_of(at, colony);
}

/// Bands of age: 1 in the middle of each, 0 between them and between colonies.
fn bands(at: Surface, colony: Colony, params: Params) -> f32 {
    return (1.0 - between_bands(colony, params)) * cover_of(at, colony);
}

/// A random value for each colony; 0 between them.
fn id(at: Surface, colony: Colony) -> f32 {
    return select(0.0, max(unit_random(colony.bits), 1e-4), colony.inward > -0.5 * at.texel_size);
}

/// The thickness of the colonies: rounded lobes, bands, and warts and cracks in the middle; 0 between them.
fn height(at: Surface, colony: Colony, position: vec3f, density: f32, params: Params) -> f32 {
    let thickness = thickness_of(at, position, colony, params);
    return mix(0.4 * mean_cover(density, params), cover_of(at, colony) * thickness, seen(at, params));
}

// The colony of a place. Lengths are working units.
struct Colony {
    bits: u32,
    // From the border inward; below 0 outside.
    inward: f32,
    age: f32,
    // 0 in the clefts between lobes, 1 on them.
    lobe: f32,
    // Radius.
    reach: f32,
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(params.size, at.texel_size);
}

// The covered share of the surface, for colonies too small to be seen; fitted to what was measured.
fn mean_cover(fertility: f32, params: Params) -> f32 {
    let density = clamp(fertility, 0.0, 1.0);
    let old = params.age * params.age;
    let share = params.amount * old * old * density * density * (1.0 + 1.5 * params.small) * (1.0 - 0.18 * params.lobes);
    return 1.0 - exp2(-0.63 * share);
}

fn cover_of(at: Surface, found: Colony) -> f32 {
    return clamp(found.inward / max(at.texel_size, 1e-9) + 0.5, 0.0, 1.0);
}

// A colony that a place may be in.
struct Near {
    // How far inside of the whole circle the place is; none if below 0.
    inward: f32,
    radius: f32,
    offset: vec3f,
    bits: u32,
}

// The colonies that are looked at in one place, the one furthest inside first. Only two matter, but their lobes decide which.
// Members instead of an array: software adapters keep an array that is read at a computed index in memory, which is slow.
struct Nearest {
    first: Near,
    second: Near,
    third: Near,
    fourth: Near,
}

// The nearest colonies with one more, in order.
fn with_near(found: Nearest, near: Near) -> Nearest {
    var nearest = found;
    if near.inward > found.first.inward {
        nearest = Nearest(near, found.first, found.second, found.third);
    } else if near.inward > found.second.inward {
        nearest = Nearest(found.first, near, found.second, found.third);
    } else if near.inward > found.third.inward {
        nearest = Nearest(found.first, found.second, near, found.third);
    } else if near.inward > found.fourth.inward {
        nearest.fourth = near;
    }
    return nearest;
}

// The colonies of one size around a place, put among the nearest: the three sizes are cells of three grids, and a colony is
// at most one cell wide.
fn gathered(found: Nearest, kind: u32, position: vec3f, density: f32, params: Params) -> Nearest {
    var near = found;
    let unit = params.size * select(select(0.25, 0.5, kind == 1u), 1.0, kind == 0u);
    let share = params.amount * select(params.small, 1.0, kind == 0u);
    let key = seed_key(params.seed + kind * 0x9e3779b9u);
    let place = cells_place(position, unit, vec3f(1.0), vec3f(0.0));
    let cell = cell_of(place);
    let inside = place - vec3f(cell);
    let side = select(vec3i(-1), vec3i(1), inside > vec3f(0.5));
    let border = min(inside, 1.0 - inside);
    // Lobes reach beyond the circle.
    let most = 1.0 + 0.3 * params.lobes;
    let reach = 0.5 * params.age * most;
    var walk = CubeWalk(vec3i(0), true);
    for (var n = 0; n < 30; n++) {
        let cube = cube_at(walk, side, border);
        walk = next_cube(walk, 3, cube.distance < reach * reach);
        if !walk.goes_on {
            break;
        }
        let random = cell_random(cell + cube.step, key);
        let offset = inside - vec3f(cube.step) - cell_point(random, 1.0);
        // Colonies start at different times and grow at the same speed.
        let begin = 0.6 * unit_random(random.z) * (1.2 - 0.8 * params.age);
        let radius = 0.5 * max(params.age - begin, 0.0) * clamp(density, 0.0, 1.0);
        let inward = (radius * most - length(offset)) * unit;
        if inward > 0.0 && unit_random(random.y) < share {
            near = with_near(near, Near(inward, radius * unit, offset * unit, random.x ^ (random.z * 747796405u)));
        }
    }
    return near;
}

// A colony by the place's offset from its origin. Lobes are bumps on the ball of directions, divided by thin clefts, and
// divide again on their way out.
fn grown(near: Near, texel_size: f32, params: Params) -> Colony {
    let away = length(near.offset);
    let way = near.offset / max(away, 1e-9);
    let share = away / max(near.radius, 1e-9);
    let key = pcg3d(vec3u(near.bits, 0x85ebca6bu, 0xc2b2ae35u));
    let shape = clamp(simplex_noise(way * 0.55, key), -2.0, 2.0);
    // Large colonies have more lobes than small ones.
    let count = 1.0 + 1.4 * sqrt(min(2.0 * near.radius / params.size, 1.0));
    let coarse = abs(simplex_noise(way * (count + 0.15 * shape) + 0.35 * share, key.yzx));
    let fine = abs(simplex_noise(way * (2.1 * count) + 0.5 * share, key.yxz));
    let wide = min(coarse * 1.6, 1.0);
    let divided = smoothstep(0.45, 0.9, share) * carried(near.radius / (1.4 * count), texel_size);
    let narrow = mix(1.0, min(fine * 1.8, 1.0), divided);
    let cleft = (1.0 - wide) * (1.0 - wide) * 0.5 + (1.0 - narrow) * (1.0 - narrow) * 0.22;
    let whole = near.radius * (1.0 + 0.14 * params.lobes * shape);
    let reach = whole - near.radius * params.lobes * cleft;
    // The clefts are younger than what is beside them, but do not show in the middle.
    let front = mix(whole, reach, smoothstep(0.3, 0.9, share));
    let lobe = wide * mix(1.0, narrow, 0.6);
    return Colony(near.bits, reach - away, 1.0 - away / max(front, 1e-9), lobe, near.radius);
}

// The colony without what has fallen out of its middle.
fn hollowed(position: vec3f, colony: Colony, params: Params) -> Colony {
    var left = colony;
    let noise = simplex_noise(position / (0.09 * params.size), seed_key(params.seed ^ 0x51ed270bu));
    let old = 1.0 - params.hollow * (0.45 + 0.45 * unit_random(colony.bits * 747796405u + 1u)) + 0.08 * noise;
    let rest = (old - colony.age) * colony.reach;
    left.inward = select(colony.inward, min(colony.inward, rest), params.hollow > 0.0);
    return left;
}

// 1 between two bands of age, 0 in the middle of one.
fn between_bands(found: Colony, params: Params) -> f32 {
    let phase = fract(clamp(found.age, 0.0, 1.0) * params.rings);
    return select(0.0, abs(2.0 * phase - 1.0), params.rings > 0.0);
}

fn thickness_of(at: Surface, position: vec3f, found: Colony, params: Params) -> f32 {
    let edge = clamp(found.inward / (0.22 * found.reach + 1e-9), 0.0, 1.0);
    let rim = sqrt(edge * (2.0 - edge));
    let lobe = mix(1.0, 0.45 + 0.55 * found.lobe, params.lobes * (1.0 - 0.6 * found.age));
    let band = 1.0 - 0.25 * smoothstep(0.4, 1.0, between_bands(found, params)) * (1.0 - found.age);
    // Warts that grow with age, divided by cracks.
    let wart_size = 0.045 * params.size;
    let place = cells_place(position, wart_size, vec3f(1.0), vec3f(0.0));
    let wart = nearest_point(place, 1.0, seed_key(params.seed ^ 0x2545f491u), 0.25);
    let crack = smoothstep(0.0, 0.22, wart.others - wart.distance);
    let bump = mix(0.72, crack * (0.75 + 0.25 * unit_random(wart.id)), carried(wart_size, at.texel_size));
    return rim * lobe * band * mix(0.9, bump, smoothstep(0.15, 0.6, found.age));
}
