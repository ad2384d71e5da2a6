//! Stamp
//! Shapes scattered over the surface, each turned its own way: drops, splats, dents, bolts, leaves, prints.
//!
//! Points in space near the surface, each drawn flat on it: stamps run over seams and keep their size on every side of the
//! model. Sharp edges cut them off, and where the surface bends more tightly than a stamp is wide they shrink. Connect Height
//! to the height map of a layer, Id to a color gradient, and Place to the position of an image or a noise.
//! @alias scatter decal splatter splash mud drops rain dents hail rivets screws fingerprints smudges flakes bubbles tile sampler
//! @use cells atlas

struct Params {
    /// What is scattered.
    /// @choice disc ring drop splat chip leaf bolt dent scratch print @default splat
    shape: u32,
    /// Length of a stamp of mean size. The largest stamps are limited to four times the spacing.
    /// @length @range 0.0001 100 @soft 0.005 0.3 @default 0.09
    size: f32,
    /// Mean distance between neighboring stamps.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.12
    spacing: f32,
    /// Variation of the size: 0 makes all stamps alike, 1 mixes tiny ones with some of twice the size.
    /// @range 0 1 @default 0.5
    variation: f32,
    /// Share of the stamps that is kept; the others are left out at random.
    /// @range 0 1 @default 1
    keep: f32,
    /// Largest random turn away from Toward, to either side: 0 lays all stamps along it, 180 in any direction.
    /// @angle @range 0 180 @default 180
    turn: f32,
    /// Width of a stamp as a share of its length.
    /// @range 0.1 1 @default 1
    squash: f32,
    /// Irregularity: how far the stamps are from a regular grid.
    /// @range 0 1 @default 1
    jitter: f32,
    /// Softness of the borders: 0 is a sharp line, 1 fades from the middle.
    /// @range 0 1 @default 0.05
    soft: f32,
    /// How much stamps may lie over one another, the one with the highest Id on top: 0 leaves out those that would touch
    /// another one, 1 keeps all.
    /// @range 0 1 @default 0.5
    overlap: f32,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The stamps: 1 inside, 0 between them.
/// @input position Where the stamps are read; connect a moved position to warp them. @vector @optional @default at.position
/// @input toward Direction of the stamps, in model space: drops run and leaves point this way. @vector @optional @default 0 -1 0
/// @input density Share of the stamps that is kept here, read at each place: a sharp border in it cuts stamps off. @optional @default 1
fn mask(at: Surface, position: vec3f, toward: vec3f, density: f32, params: Params) -> f32 {
    let found = stamps_at(at, position, toward, density, 0.0, params);
    return mix(mean_cover(density, params), found.cover, carried(4.0 * params.spacing, at.texel_size));
}

/// The profile of the stamps, -1 to 1: dents and scratches are below 0, the other shapes above; 0 between them.
fn height(at: Surface, position: vec3f, toward: vec3f, density: f32, params: Params) -> f32 {
    let found = stamps_at(at, position, toward, density, 0.0, params);
    return mix(mean_cover(density, params) * shape_size(params.shape).z, found.height, carried(4.0 * params.spacing, at.texel_size));
}

/// A random value for each stamp; 0 between them.
fn id(at: Surface, position: vec3f, toward: vec3f, density: f32, params: Params) -> f32 {
    return stamps_at(at, position, toward, density, 0.0, params).id;
}

/// The place in the stamp for an image: x to the right and y along the stamp's direction, 0 to 1; z is the random value, by
/// which Image chooses one of several pictures in a file.
/// @vector
fn place(at: Surface, position: vec3f, toward: vec3f, density: f32, params: Params) -> vec3f {
    let found = stamps_at(at, position, toward, density, 0.0, params);
    return vec3f(found.place, found.id);
}

/// Distance to the outline of the nearest stamp: above 0 inside, below 0 outside, down to a quarter of Size.
fn away(at: Surface, position: vec3f, toward: vec3f, density: f32, params: Params) -> f32 {
    let most = 0.25 * params.size;
    return max(stamps_at(at, position, toward, density, most, params).away, -most);
}

// Lengths below are in cubes, each with one point. Points in a slab around the surface count, as thick as this twice: thin,
// so that curved surfaces keep them; on a regular grid as thick as a cube, so that flat sides get one whole layer.
fn slab_of(params: Params) -> f32 {
    return mix(0.5, 0.4, params.jitter);
}

// Length of a cube, for one stamp on each square of the spacing.
fn unit_of(params: Params) -> f32 {
    return params.spacing * sqrt(2.0 * slab_of(params));
}

// Half the length of the mean stamp, held where the largest one reaches no further than the cubes that are looked at.
fn mean_radius(params: Params) -> f32 {
    return min(0.5 * params.size / unit_of(params), 2.7 / (1.0 + params.variation));
}

// How large a stamp is, compared with the mean one: small ones are more frequent.
fn own_size(bits: u32, variation: f32) -> f32 {
    let chance = unit_random(bits * 747796405u + 2891336453u);
    return mix(1.0, 0.25 + 1.75 * chance * chance, variation);
}

// The covered share of the surface, for stamps too small to be seen.
fn mean_cover(density: f32, params: Params) -> f32 {
    let radius = mean_radius(params) * unit_of(params) / params.spacing;
    let spread = 1.0 - 0.12 * params.variation;
    let share = clamp(density, 0.0, 1.0) * params.keep * mix(0.6, 1.0, params.overlap);
    return 1.0 - exp2(-1.44 * shape_size(params.shape).y * params.squash * radius * radius * spread * share);
}

// A stamp that covers a place: its random number, which decides which one is on top, 0 for none; the place in its square;
// half its length; and how far inside its outline the place lies, its height there, and how full it is.
struct Stamp {
    bits: u32,
    q: vec2f,
    radius: f32,
    drawn: vec3f,
}

// How many stamps over one another are looked at in one place.
const STACK: i32 = 8;

// What the stamps over one another make of a place.
struct Found {
    cover: f32,
    height: f32,
    away: f32,
    id: f32,
    place: vec2f,
}

fn stamps_at(at: Surface, position: vec3f, toward: vec3f, density: f32, margin: f32, params: Params) -> Found {
    let unit = unit_of(params);
    let place = cells_place(position, unit, vec3f(1.0), vec3f(0.0));
    let key = seed_key(params.seed);
    let texel = min(at.texel_size / unit, 2.0);
    let mean = mean_radius(params);
    let reach = min(mean * (1.0 + params.variation) + 0.5 * texel + margin / unit, 3.0);
    let cell = cell_of(place);
    let inside = place - vec3f(cell);
    let side = select(vec3i(-1), vec3i(1), inside > vec3f(0.5));
    let border = min(inside, 1.0 - inside);
    let slab = slab_of(params);
    let thick = slab + 0.5 * params.jitter * dot(abs(at.normal), vec3f(1.0)) + 1e-3;
    let way = unit_or(toward, vec3f(0.0, -1.0, 0.0));
    var stack: array<Stamp, STACK>;
    var away = -1e9;
    var walk = CubeWalk(vec3i(0), true);
    for (var n = 0; n < 345; n++) {
        let cube = cube_at(walk, side, border);
        walk = next_cube(walk, 7, cube.distance < reach * reach);
        if !walk.goes_on {
            break;
        }
        if abs(dot(at.normal, vec3f(cube.step) + 0.5 - inside)) > thick {
            continue;
        }
        let random = cell_random(cell + cube.step, key);
        let point = cell_point(random, params.jitter);
        let offset = vec3f(cube.step) + point - inside;
        let rise = dot(at.normal, offset);
        let along = offset - rise * at.normal;
        let bits = number_of(random);
        let radius = own_size(bits, params.variation) * mean;
        let outer = radius + 0.5 * texel + margin / unit;
        if abs(rise) >= slab || dot(along, along) >= outer * outer || unit_random(random.y) >= params.keep {
            continue;
        }
        let ahead = ahead_of(at.normal, way, bits, params);
        // Close to the sides of the slab a stamp that a curved surface leaves shrinks instead of being cut.
        var whole = ahead.w * (1.0 - smoothstep(mix(0.98, 0.75, params.jitter) * slab, slab, abs(rise)));
        // A little of the mask's own softness, so that a border in it shrinks stamps before it cuts them.
        whole *= clamp((1.1 * density - unit_random(random.z)) * 10.0, 0.0, 1.0);
        whole *= room(Point(cell + cube.step, point, bits, radius), offset, at.normal, slab, mean, key, params);
        if whole > 0.02 {
            let own = radius * whole;
            // From the middle to the place, to the right as seen from outside and ahead, in half lengths.
            let q = -vec2f(dot(along, cross(ahead.xyz, at.normal)), dot(along, ahead.xyz)) / own * vec2f(1.0 / params.squash, 1.0);
            let drawn = shape_at(q, params.shape, bits, texel / own);
            // Distances across a squashed stamp are shorter than they look; right where the outline lies along it.
            let inward = drawn.x * params.squash * own;
            away = max(away, inward * unit);
            // A place in the circle that the shape leaves free is left to the stamps below.
            if inward > -0.5 * texel && drawn.z > 0.0 {
                keep_highest(&stack, Stamp(bits, q, own, vec3f(inward, drawn.yz)));
            }
        }
    }
    return laid(stack, away, texel, params);
}

// The stamps over one another, the lowest first.
fn laid(stack: array<Stamp, STACK>, away: f32, texel: f32, params: Params) -> Found {
    let size = shape_size(params.shape).x * params.squash;
    var stamps = stack;
    var found = Found(0.0, 0.0, away, 0.0, vec2f(0.5));
    for (var i = 0; i < STACK; i++) {
        let stamp = stamps[STACK - 1 - i];
        if stamp.bits == 0u { continue; }
        let inner = size * stamp.radius;
        let t = clamp((stamp.drawn.x + 0.5 * texel) / max(params.soft * inner, texel), 0.0, 1.0);
        // What is thinner than a texel becomes faint.
        let cover = mix(t, t * t * (3.0 - 2.0 * t), params.soft) * min(2.0 * inner / texel, 1.0) * stamp.drawn.z;
        found.cover += (1.0 - found.cover) * cover;
        found.height = mix(found.height, stamp.drawn.y, cover);
        let is_seen = cover > select(0.0, 0.5, found.id > 0.0);
        found.id = select(found.id, max(unit_random(stamp.bits), 1e-4), is_seen);
        found.place = select(found.place, clamp(0.5 + 0.5 * stamp.q, vec2f(0.0), vec2f(1.0)), is_seen);
    }
    return found;
}

// Puts a stamp among the highest.
fn keep_highest(stack: ptr<function, array<Stamp, STACK>>, stamp: Stamp) {
    var rest = stamp;
    for (var i = 0; i < STACK; i++) {
        if rest.bits > (*stack)[i].bits {
            let lower = (*stack)[i];
            (*stack)[i] = rest;
            rest = lower;
        }
    }
}

// Where a stamp points, and in `w` its share of the full size: 0 where it would turn too fast on a curved surface. The way
// is that of an axis in space which each stamp has for its own, as the surface sees it: all places under the stamp agree on
// it without knowing where its middle is. The axis leans a little to a random side, so that stamps have a direction also
// where Toward is the normal; the further they turn, the more.
fn ahead_of(normal: vec3f, way: vec3f, bits: u32, params: Params) -> vec4f {
    let random = unit_random3(pcg3d(vec3u(bits, 0x85ebca6bu, 0x9e3779b9u)));
    let free = params.turn * 0.31830989;
    let turn = turn_of(vec3f(6.2831853 * random.x, (2.0 * random.y - 1.0) * params.turn, 0.0));
    let side = normalize(cross(select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(way.x) > 0.7), way));
    let cosine = mix(0.99, 2.0 * random.z - 1.0, free * free * free);
    let axis = way * cosine + (side * turn.cosine.x + cross(way, side) * turn.sine.x) * sqrt(1.0 - cosine * cosine);
    let rise = dot(axis, normal);
    let along = unit_or(axis - rise * normal, side);
    let ahead = along * turn.cosine.y + cross(normal, along) * turn.sine.y;
    return vec4f(ahead, 1.0 - free * smoothstep(0.86, 0.96, abs(rise)));
}

// A number of its own for each point, whatever its place.
fn number_of(random: vec3u) -> u32 {
    return ((random.x * 747796405u) ^ (random.y * 277803737u) ^ (random.z << 11u)) | 1u;
}

// The point of a stamp: its cube, its place in it, its number, and half the length of the stamp.
struct Point {
    cell: vec3i,
    place: vec3f,
    bits: u32,
    radius: f32,
}

// 0 if a stamp with a larger number lies over too much of this one, 1 if not, little between.
fn room(own: Point, offset: vec3f, normal: vec3f, slab: f32, mean: f32, key: vec3u, params: Params) -> f32 {
    let corner = offset - own.place;
    var room = 1.0;
    for (var i = 0; i < 27 && params.overlap < 1.0; i++) {
        let row = (i * 11) >> 5u;
        let step = vec3i(i - 3 * row, row - 3 * ((row * 11) >> 5u), (row * 11) >> 5u) - 1;
        let random = cell_random(own.cell + step, key);
        let number = number_of(random);
        let other = corner + vec3f(step) + cell_point(random, params.jitter);
        let between = cross(other - offset, normal);
        let square = dot(between, between);
        let apart = 0.9 * (1.0 - params.overlap) * (own.radius + own_size(number, params.variation) * mean);
        let close = clamp((apart * apart - square) / max(0.2 * apart * apart, 1e-6), 0.0, 1.0);
        let strong = clamp(9.0 - 9.0 * abs(dot(normal, other)) / slab, 0.0, 1.0);
        let is_over = number > own.bits && unit_random(random.y) < params.keep;
        room *= 1.0 - select(0.0, close * strong, is_over);
    }
    return room;
}

// What each shape has: its largest distance from the outline and the area that was measured, in half lengths, and its mean
// height.
const SHAPES = array<vec3f, 10>(
    vec3f(1.0, 2.97, 0.9), vec3f(0.2, 1.8, 0.7), vec3f(0.42, 0.77, 0.6), vec3f(0.4, 0.62, 0.7), vec3f(0.6, 1.6, 0.6),
    vec3f(0.36, 0.66, 0.5), vec3f(0.82, 2.15, 0.9), vec3f(1.0, 2.97, -0.25), vec3f(0.05, 0.092, -0.5), vec3f(0.6, 0.67, 0.7),
);

fn shape_size(shape: u32) -> vec3f {
    var shapes = SHAPES;
    return shapes[min(shape, 9u)];
}

// A shape in its own square, -1 to 1, y ahead: the distance inward from its outline, its height, and how full it is there.
fn shape_at(q: vec2f, shape: u32, bits: u32, texel: f32) -> vec3f {
    let random = pcg3d(vec3u(bits, 0x2c1b3c6du, 0x297a2d39u));
    let away = length(q);
    switch shape {
        case 0u: { return vec3f(1.0 - away, rounded((1.0 - away) * 4.0), 1.0); }
        case 1u: { return vec3f(0.2 - abs(away - 0.8), rounded(1.0 - abs(5.0 * away - 4.0)), 1.0); }
        case 2u: { return drop(q, random); }
        case 3u: { return splat(q, random); }
        case 4u: { return chip(q, random); }
        case 5u: { return leaf(q, random); }
        case 6u: { return bolt(q); }
        case 7u: {
            let bowl = max(1.0 - away * away / 0.52, 0.0);
            return vec3f(1.0 - away, 0.3 - 0.3 * smoothstep(0.0, 0.22, abs(away - 0.78)) - bowl * sqrt(bowl), 1.0);
        }
        case 8u: { return scratch(q, random); }
        default: { return print(q, random, texel); }
    }
}

// The quarter of a circle: 0 at 0, 1 from 1 on.
fn rounded(x: f32) -> f32 {
    let t = clamp(x, 0.0, 1.0);
    return sqrt(t * (2.0 - t));
}

// The larger of two distances, rounded off where they are within `soft` of each other.
fn merged(a: f32, b: f32, soft: f32) -> f32 {
    let t = max(soft - abs(a - b), 0.0) / soft;
    return max(a, b) + 0.25 * t * t * soft;
}

// A bar with round ends of different size: the distance inward.
fn bar(q: vec2f, from_end: vec2f, to_end: vec2f, from_radius: f32, to_radius: f32) -> f32 {
    let way = to_end - from_end;
    let t = clamp(dot(q - from_end, way) / max(dot(way, way), 1e-9), 0.0, 1.0);
    return mix(from_radius, to_radius, t) - length(q - from_end - t * way);
}

// A head that runs ahead and a thin, slightly bent tail behind it.
fn drop(q: vec2f, random: vec3u) -> vec3f {
    let behind = max(0.56 - q.y, 0.0);
    let p = vec2f(q.x + 0.12 * (2.0 * unit_random(random.x) - 1.0) * behind * behind, q.y);
    let head = 0.42 - length(p - vec2f(0.0, 0.56));
    let tail = bar(p, vec2f(0.0, 0.4), vec2f(0.0, -0.95), 0.24, 0.03);
    let inward = merged(head, tail, 0.35);
    return vec3f(inward, rounded(inward / 0.42), 1.0);
}

// A blob that has burst: fingers to all sides, most with a droplet at the end or beyond it.
fn splat(q: vec2f, random: vec3u) -> vec3f {
    var inward = 0.36 - length(q * (0.9 + 0.2 * unit_random3(random).xy));
    // Nine fingers, one in each ninth of the circle; only the four around the place reach it.
    let first = i32(round(atan2(q.y, q.x) * 1.43239449)) - 2;
    for (var beside = 0; beside < 4; beside++) {
        let i = u32(first + beside + 9) % 9u;
        let own = unit_random3(pcg3d(random + vec3u(i, 0x7feb352du, 0x846ca68bu)));
        let turn = turn_of(vec3f(0.69813170 * (f32(i) + 0.9 * own.x), 0.0, 0.0));
        let way = vec2f(turn.cosine.x, turn.sine.x);
        // Few fly far; those leave no finger behind.
        let far = 0.42 + 0.5 * own.y * own.y;
        let tip = 0.035 + 0.065 * own.z * (1.3 - far);
        let finger = bar(q, way * 0.2, way * min(far, 0.52), 0.13, 0.4 * tip);
        inward = merged(inward, finger - 0.03 * step(0.62, far), 0.16);
        inward = merged(inward, tip - length(q - way * far), 0.05);
    }
    return vec3f(inward, rounded(inward * 4.0) * (0.6 + 0.4 * rounded(inward * 2.0)), 1.0);
}

// A flake with straight sides and a slanted face.
fn chip(q: vec2f, random: vec3u) -> vec3f {
    var inward = 1.0 - length(q);
    for (var i = 0u; i < 6u; i++) {
        let own = unit_random3(pcg3d(random + vec3u(i, 0x68e31da4u, 0xc2b2ae35u)));
        let turn = turn_of(vec3f(1.0471976 * (f32(i) + 0.8 * own.x), 0.0, 0.0));
        inward = min(inward, 0.5 + 0.4 * own.y - dot(q, vec2f(turn.cosine.x, turn.sine.x)));
    }
    return vec3f(inward, (0.7 + 0.3 * dot(unit_random3(random).xy - 0.5, q)) * clamp(inward * 5.0, 0.0, 1.0), 1.0);
}

// A blade with a toothed border, a midrib, side veins and a stem behind.
fn leaf(q: vec2f, random: vec3u) -> vec3f {
    let bent = q.x + 0.25 * (2.0 * unit_random(random.y) - 1.0) * (q.y * q.y - 0.3);
    let x = abs(bent);
    let s = clamp((q.y + 0.62) / 1.6, 0.0, 1.0);
    let teeth = 0.03 * abs(2.0 * fract(9.0 * q.y - 4.0 * x) - 1.0) * smoothstep(0.0, 0.15, s);
    let half = 0.87 * sqrt(s) * (1.0 - s) * (1.0 - 0.15 * s) + teeth * (1.0 - s);
    let stem = bar(vec2f(bent, q.y), vec2f(0.0, -0.97), vec2f(0.0, 0.4), 0.035, 0.015);
    let blade = (half - x) * 0.8 - select(0.0, 1.0, q.y < -0.62 || q.y > 0.98);
    let vein = abs(2.0 * fract(5.0 * (q.y - 0.9 * x)) - 1.0);
    let ribs = max(smoothstep(0.75, 1.0, vein) * 0.5, 1.0 - smoothstep(0.0, 0.05, x));
    let curl = 0.35 + 0.5 * min(x / max(half, 0.05), 1.0) * (0.4 + 0.6 * unit_random(random.z));
    let inward = max(blade, stem);
    return vec3f(inward, rounded(inward * 12.0) * clamp(1.3 * curl - 0.3 * ribs + 0.12, 0.0, 1.0), 1.0);
}

// A hexagonal head with a dome and beveled corners.
fn bolt(q: vec2f) -> vec3f {
    let p = abs(q);
    let inward = 0.82 - max(p.x, 0.5 * p.x + 0.8660254 * p.y);
    let bevel = clamp(1.0 - 2.2 * max(length(q) - 0.74, 0.0), 0.0, 1.0);
    let dome = 0.78 + 0.22 * sqrt(max(1.0 - dot(q, q), 0.0));
    return vec3f(inward, clamp(inward * 16.0, 0.0, 1.0) * dome * bevel, 1.0);
}

// A groove, pointed at both ends, with a slight ridge on either side.
fn scratch(q: vec2f, random: vec3u) -> vec3f {
    let bent = q.x + 0.12 * (2.0 * unit_random(random.x) - 1.0) * (q.y * q.y - 0.4);
    let half = max(0.055 * (1.0 - q.y * q.y), 1e-3);
    let square = min(bent * bent / (half * half), 1.0);
    let deep = clamp(1.2 - q.y * q.y, 0.0, 1.0);
    return vec3f(half - abs(bent), deep * (1.0 - square) * (4.0 * square - 1.0), select(1.0, 0.0, abs(q.y) > 1.0));
}

// A fingertip: an oval of loops whose ends run down, pressed unevenly.
fn print(q: vec2f, random: vec3u, texel: f32) -> vec3f {
    let own = unit_random3(random);
    let oval = 0.62 * (1.0 - length(q * vec2f(1.0 / 0.66, 1.0 / 0.95)));
    let core = q - vec2f(0.16 * (own.x - 0.5), -0.12 + 0.2 * (own.y - 0.5));
    // Above the core circles, below it lines that spread.
    let up = 0.5 * (sqrt(core.y * core.y + 0.03) - core.y);
    let down = up + core.y;
    let wave = 0.025 * simplex_noise(vec3f(q * 1.7, 8.0 * own.z), vec3u(random.x));
    let loops = length(vec2f(core.x * (1.0 - 0.25 * down) + 0.15 * down * (own.z - 0.5), up)) + wave;
    let stripe = smoothstep(0.2, 0.5, abs(2.0 * fract(10.0 * loops) - 1.0));
    let press = 0.85 + 0.25 * simplex_noise(vec3f(q * 2.3, 8.0 * own.x), vec3u(random.y));
    let ridge = mix(0.55, stripe, carried(0.1, texel));
    let full = clamp(ridge * clamp(press, 0.0, 1.0) * (0.75 + 0.25 * rounded(oval * 4.0)), 0.0, 1.0);
    return vec3f(oval, full, full);
}
