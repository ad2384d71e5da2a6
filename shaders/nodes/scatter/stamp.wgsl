//! Stamp
//! Shapes scattered over the surface, each turned its own way: drops, splats, dents, bolts, leaves, prints.
//!
//! Points in space near the surface, each drawn flat on it: stamps run over seams and keep their size on every side of the
//! model. Sharp edges cut them off, and where the surface bends more tightly than a stamp is wide they shrink. Connect Height
//! to the height map of a layer, Id to a color gradient, and Place to the position of an image or a noise.
//! @alias scatter decal splatter splash mud drops rain dents hail rivets screws fingerprints smudges flakes bubbles tile sampler
//! @use cells stamps atlas

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

/// The stamps of a place.
/// @shared
/// @input position Where the stamps are read; connect a moved position to warp them. @vector @optional @default at.position
/// @input toward Direction of the stamps, in model space: drops run and leaves point this way. @vector @optional @default 0 -1 0
/// @input density Share of the stamps that is kept here, read at each place: a sharp border in it cuts stamps off. @optional @default 1
fn found(at: Surface, position: vec3f, toward: vec3f, density: f32, params: Params) -> Found {
    return stamps_at(at, position, toward, density, 0.0, params);
}

/// The stamps: 1 inside, 0 between them.
fn mask(at: Surface, found: Found, density: f32, params: Params) -> f32 {
    return mix(mean_cover(density, params), found.cover, carried(4.0 * params.spacing, at.texel_size));
}

/// The profile of the stamps, -1 to 1: dents and scratches are below 0, the other shapes above; 0 between them.
fn height(at: Surface, found: Found, density: f32, params: Params) -> f32 {
    return mix(mean_cover(density, params) * stamp_size(params.shape).z, found.height, carried(4.0 * params.spacing, at.texel_size));
}

/// A random value for each stamp; 0 between them.
fn id(found: Found) -> f32 {
    return found.id;
}

/// The place in the stamp for an image: x to the right and y along the stamp's direction, 0 to 1; z is the random value, by
/// which Image chooses one of several pictures in a file.
/// @vector
fn place(found: Found) -> vec3f {
    return vec3f(found.place, found.id);
}

/// Distance to the outline of the nearest stamp: above 0 inside, below 0 outside, down to a quarter of Size.
fn away(at: Surface, position: vec3f, toward: vec3f, density: f32, params: Params) -> f32 {
    // Stamps beside the place matter too, so it does not share what the other outputs find.
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
    return 1.0 - exp2(-1.44 * stamp_size(params.shape).y * params.squash * radius * radius * spread * share);
}

// A stamp that covers a place: its random number, which decides which one is on top, 0 for none; the place in its square;
// half its length; and how far inside its outline the place lies, its height there, and how full it is.
struct Stamp {
    bits: u32,
    q: vec2f,
    radius: f32,
    drawn: vec3f,
}

// The stamps over one another in one place that are looked at, the highest first. Members instead of an array: software
// adapters keep an array that is read at a computed index in memory, which is slow.
struct Stack {
    a: Stamp,
    b: Stamp,
    c: Stamp,
    d: Stamp,
    e: Stamp,
    f: Stamp,
}

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
    var stack: Stack;
    var away = -1e9;
    let site = Site(cell, inside, side, border, at.normal, key, slab, thick, reach, mean, 0.5 * texel + margin / unit, density);
    // Places without density have no stamps, so they need no walk.
    var walk = CubeWalk(vec3i(0), density > 0.0);
    // Only stamps that may cover the place are drawn: software adapters go through all of a loop for each of its rounds,
    // whatever is skipped in it.
    for (var n = 0; n < 128 && walk.goes_on; n++) {
        let next = next_stamp(walk, site, params);
        walk = next.walk;
        if !walk.goes_on {
            break;
        }
        if !next.is_found {
            continue;
        }
        let rise = dot(at.normal, next.offset);
        let along = next.offset - rise * at.normal;
        let bits = number_of(next.random);
        let radius = own_size(bits, params.variation) * mean;
        let ahead = ahead_of(at.normal, way, bits, params);
        // Close to the sides of the slab a stamp that a curved surface leaves shrinks instead of being cut.
        var whole = ahead.w * (1.0 - smoothstep(mix(0.98, 0.75, params.jitter) * slab, slab, abs(rise)));
        // A little of the mask's own softness, so that a border in it shrinks stamps before it cuts them.
        whole *= room_for(next.random, density);
        let point = cell_point(next.random, params.jitter);
        whole *= room(Point(cell + next.step, point, bits, radius), next.offset, at.normal, slab, mean, key, params);
        if whole > 0.02 {
            let own = radius * whole;
            // From the middle to the place, to the right as seen from outside and ahead, in half lengths.
            let q = -vec2f(dot(along, cross(ahead.xyz, at.normal)), dot(along, ahead.xyz)) / own * vec2f(1.0 / params.squash, 1.0);
            let drawn = stamp_shape(q, params.shape, bits, texel / own);
            // Distances across a squashed stamp are shorter than they look; right where the outline lies along it.
            let inward = drawn.x * params.squash * own;
            away = max(away, inward * unit);
            // A place in the circle that the shape leaves free is left to the stamps below.
            if inward > -0.5 * texel && drawn.z > 0.0 {
                stack = with_stamp(stack, Stamp(bits, q, own, vec3f(inward, drawn.yz)));
            }
        }
    }
    return all_laid(stack, away, texel, params);
}

// Values by which the points around one place are found; lengths in cubes.
struct Site {
    cell: vec3i,
    // The place in its own cube.
    inside: vec3f,
    side: vec3i,
    border: vec3f,
    normal: vec3f,
    key: vec3u,
    // Half of how thick the slab is, and the same with what a point may lie away from the middle of its cube.
    slab: f32,
    thick: f32,
    // No point further away than this matters.
    reach: f32,
    mean: f32,
    // Distance beyond its own circle at which a stamp still matters.
    beyond: f32,
    density: f32,
}

// The next point whose stamp may cover a place: where the walk goes on behind it, the step to its cube, the random numbers
// of that, and the way from the place to the point.
struct Next {
    walk: CubeWalk,
    step: vec3i,
    random: vec3u,
    offset: vec3f,
    // Not, where the next 32 cubes have no such point.
    is_found: bool,
}

fn next_stamp(start: CubeWalk, site: Site, params: Params) -> Next {
    var next = Next(start, vec3i(0), vec3u(0u), vec3f(0.0), false);
    for (var n = 0; n < 32; n++) {
        let cube = cube_at(next.walk, site.side, site.border);
        next.walk = next_cube(next.walk, 7, cube.distance < site.reach * site.reach);
        if !next.walk.goes_on {
            break;
        }
        next.step = cube.step;
        next.random = cell_random(site.cell + cube.step, site.key);
        next.offset = vec3f(cube.step) + cell_point(next.random, params.jitter) - site.inside;
        let rise = dot(site.normal, next.offset);
        let along = next.offset - rise * site.normal;
        let outer = own_size(number_of(next.random), params.variation) * site.mean + site.beyond;
        let is_kept = unit_random(next.random.y) < params.keep && room_for(next.random, site.density) > 0.0;
        let is_near = abs(rise) < site.slab && dot(along, along) < outer * outer
            && abs(dot(site.normal, vec3f(cube.step) + 0.5 - site.inside)) <= site.thick;
        if is_kept && is_near {
            next.is_found = true;
            break;
        }
    }
    return next;
}

// Share of a stamp that the density leaves.
fn room_for(random: vec3u, density: f32) -> f32 {
    return clamp((1.1 * density - unit_random(random.z)) * 10.0, 0.0, 1.0);
}

// The stamps over one another, laid from the lowest on.
fn all_laid(stack: Stack, away: f32, texel: f32, params: Params) -> Found {
    var found = Found(0.0, 0.0, away, 0.0, vec2f(0.5));
    found = laid(found, stack.f, texel, params);
    found = laid(found, stack.e, texel, params);
    found = laid(found, stack.d, texel, params);
    found = laid(found, stack.c, texel, params);
    found = laid(found, stack.b, texel, params);
    return laid(found, stack.a, texel, params);
}

// Lays a stamp over those below it.
fn laid(below: Found, stamp: Stamp, texel: f32, params: Params) -> Found {
    let inner = max(stamp_size(params.shape).x * params.squash * stamp.radius, 1e-20);
    let t = clamp((stamp.drawn.x + 0.5 * texel) / max(params.soft * inner, texel), 0.0, 1.0);
    // Stamps thinner than a texel become faint.
    let full = mix(t, t * t * (3.0 - 2.0 * t), params.soft) * min(2.0 * inner / texel, 1.0) * stamp.drawn.z;
    let cover = select(0.0, full, stamp.bits > 0u);
    var found = below;
    found.cover += (1.0 - found.cover) * cover;
    found.height = mix(found.height, stamp.drawn.y, cover);
    let is_seen = cover > select(0.0, 0.5, found.id > 0.0);
    found.id = select(found.id, max(unit_random(stamp.bits), 1e-4), is_seen);
    found.place = select(found.place, clamp(0.5 + 0.5 * stamp.q, vec2f(0.0), vec2f(1.0)), is_seen);
    return found;
}

// The stack with one more stamp; the one with the highest number is on top.
fn with_stamp(stack: Stack, stamp: Stamp) -> Stack {
    if stamp.bits > stack.a.bits { return Stack(stamp, stack.a, stack.b, stack.c, stack.d, stack.e); }
    if stamp.bits > stack.b.bits { return Stack(stack.a, stamp, stack.b, stack.c, stack.d, stack.e); }
    if stamp.bits > stack.c.bits { return Stack(stack.a, stack.b, stamp, stack.c, stack.d, stack.e); }
    if stamp.bits > stack.d.bits { return Stack(stack.a, stack.b, stack.c, stamp, stack.d, stack.e); }
    if stamp.bits > stack.e.bits { return Stack(stack.a, stack.b, stack.c, stack.d, stamp, stack.e); }
    if stamp.bits > stack.f.bits { return Stack(stack.a, stack.b, stack.c, stack.d, stack.e, stamp); }
    return stack;
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
