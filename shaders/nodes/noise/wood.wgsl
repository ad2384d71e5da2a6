//! Wood
//! Rings, knots and fiber of sawn wood; every piece of the model is cut from another part of the tree.
//!
//! The wood is solid and its grain runs along the longest side of each piece, such as each plank of a table, so a cut
//! across shows rings and a cut along shows streaks and arches. Rings differ in width; late wood is dark and ends sharply.
//! Knots are branches that grew with the trunk, and its rings bend around them. Details smaller than the texels fade to
//! their mean.
//! @alias timber plank board veneer grain rings knots oak pine varnish
//! @use noise

struct Params {
    /// Mean width of an annual ring.
    /// @length @range 0.0001 100 @soft 0.004 0.1 @default 0.03
    rings: f32,
    /// Number of knots.
    /// @range 0 1 @default 0.3
    knots: f32,
    /// Strength of fibers and pores.
    /// @range 0 1 @default 0.5
    grain: f32,
    /// Stretches the wood along its axes: x is along the grain.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the wood about the axes of the piece: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Number that chooses one of many trees.
    /// @seed @default 0
    seed: u32,
}

/// The wood of a place.
/// @shared
/// @input position Where the wood is read; unconnected, the position in the bounding box of the piece. @vector @optional @default at.piece_position
fn wood(at: Surface, position: vec3f, params: Params) -> Wood {
    let tree = tree_of(at, params);
    let key = seed_key(tree.x);
    let ring_width = params.rings * finest_stretch(params.stretch);
    let place = noise_place(position, params.stretch, params.rotate) / params.rings;
    let texel = at.texel_size / ring_width;

    // The piece is cut beside the pith, which crosses its box at a slight angle and wanders.
    let chance = unit_random3(pcg3d(key));
    let lean = unit_random3(pcg3d(key + vec3u(1u))) - 0.5;
    let cut = turn_of(vec3f(6.2831853 * chance.x, 0.0, 0.0));
    let beside = (1.5 + 6.0 * chance.y) * vec2f(cut.cosine.x, cut.sine.x);
    let wander = vec2f(
        simplex_noise(vec3f(place.x / 26.0, 0.5, 0.0), key),
        simplex_noise(vec3f(place.x / 26.0, 0.0, 17.5), key),
    );
    let across = place.yz - beside - 0.09 * lean.xy * place.x - 0.45 * wander;

    let bump = simplex_noise(vec3f(place.x / 36.0, place.yz / 9.0), key + vec3u(2u));
    let ripple = simplex_noise(vec3f(place.x / 10.0, place.yz / 2.8), key + vec3u(3u));
    let taper = 0.02 * lean.z * place.x;
    var year = length(across) + taper + 0.4 * bump + 0.08 * ripple;
    let branch = nearest_branch(place.x, across, -beside, key, params.knots);
    year -= branch.swell;
    // Trunk and branch grow as one: a smooth minimum of when they came.
    let share = clamp(0.5 + (year - branch.year) / 1.1, 0.0, 1.0);
    year = mix(year, branch.year, share) - 0.55 * share * (1.0 - share);
    // A little more than the way over a texel, since texels are squares and stand at an angle.
    let outward = vec3f(0.02 * lean.z, across / max(length(across), 1e-6));
    let blur = 1.2 * texel * mix(steepness(at, position, outward, params), 4.0, share);

    let along = vec3f(place.x, place.yz - branch.aside);
    let fiber = 0.5 * streaks(along, 9.0, 0.5, key + vec3u(4u), texel)
        + 0.5 * streaks(along, 6.0, 0.2, key + vec3u(5u), texel)
        + 0.4 * streaks(along, 3.0, 0.08, key + vec3u(6u), texel);
    let streak = streaks(along, 45.0, 2.6, key + vec3u(7u), texel);
    let pore = smoothstep(1.1, 2.1, simplex_noise(vec3f(along.x / 2.2, along.yz / 0.13), key + vec3u(8u)));
    let pores = mix(PORES, pore, kept(0.13, texel));
    return Wood(
        ring_tone(year, blur, key),
        clamp(0.4 * streak, -1.0, 1.0),
        fiber * (1.0 - share),
        pores * (1.0 - share),
        share,
        4.0 * share * (1.0 - share),
    );
}

/// How dark the wood is: low in early wood, high in late wood, knots and pores.
fn mask(wood: Wood, params: Params) -> f32 {
    let streaks = 0.16 * wood.streak + params.grain * (0.15 * wood.fiber + 0.5 * wood.pore * (1.0 - wood.ring));
    let tone = 0.1 + 0.62 * wood.ring + streaks;
    return clamp(mix(tone, 0.52 + 0.42 * tone, wood.knot) + 0.16 * wood.bark, 0.0, 1.0);
}

/// The relief of worn wood: late wood and knots stand out, pores are deepest.
fn height(wood: Wood, params: Params) -> f32 {
    let fiber = params.grain * (0.08 * wood.fiber - 0.4 * wood.pore * (1.0 - wood.ring));
    return clamp(mix(0.35 + 0.4 * wood.ring + fiber, 0.7 + 0.2 * wood.ring, wood.knot), 0.0, 1.0);
}

/// A random value for each piece.
fn id(at: Surface, params: Params) -> f32 {
    return unit_random(tree_of(at, params).y);
}

// The share of pores, the mean of their step over the noise.
const PORES: f32 = 0.05;

// The wood at a place, before it is weighed.
struct Wood {
    // 0 in early wood to 1 at the end of a dark year.
    ring: f32,
    // Broad tones along the trunk, fine fibers: mean 0, about -1 to 1.
    streak: f32,
    fiber: f32,
    // How much of a pore, of a knot, of the bark around it.
    pore: f32,
    knot: f32,
    bark: f32,
}

// What the shape of a branch does to its surroundings. Lengths are rings.
struct Knot {
    // When the branch reached this place, in years of the trunk.
    year: f32,
    // How far it pushed the trunk's rings outward here, and its fibers aside.
    swell: f32,
    aside: vec2f,
}

fn tree_of(at: Surface, params: Params) -> vec3u {
    return pcg3d(vec3u(at.seed, params.seed, 0x5eed0007u));
}

// How fast years pass along the surface, compared with the way straight outward: a face along the rings shows few of them,
// and wide. Bumps are counted in as if they were everywhere.
fn steepness(at: Surface, position: vec3f, outward: vec3f, params: Params) -> f32 {
    let normal = cut_of(at, position);
    let side = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(normal.x) > 0.7);
    let first = normalize(cross(normal, side));
    let second = cross(normal, first);
    let slope = vec2f(
        dot(outward, noise_place(first, params.stretch, params.rotate)),
        dot(outward, noise_place(second, params.stretch, params.rotate)),
    ) * finest_stretch(params.stretch);
    return sqrt(dot(slope, slope) + 0.01);
}

// The normal of the face that cuts the wood, in the space in which the wood is read: the piece's box, or the model.
fn cut_of(at: Surface, position: vec3f) -> vec3f {
    let from_piece = position - at.piece_position;
    let from_model = position - at.position;
    return select(at.face_normal, at.piece_normal, dot(from_piece, from_piece) <= dot(from_model, from_model));
}

// Noise drawn out along the grain, as far as the texels carry it.
fn streaks(place: vec3f, long: f32, wide: f32, key: vec3u, texel: f32) -> f32 {
    return simplex_noise(vec3f(place.x / long, place.yz / wide), key) * kept(wide, texel);
}

// What is left of lines of a width when texels average them: unlike crossing waves they still show where a texel is nearly as
// wide as they are.
fn kept(wide: f32, texel: f32) -> f32 {
    let share = texel / wide;
    let square = share * share;
    return 1.0 / (1.0 + 2.0 * square * square);
}

// Where a year ends and the next begins, in mean widths: no two are equal.
fn year_end(year: i32, key: vec3u) -> f32 {
    return f32(year) + 0.4 * (unit_random(cell_random(vec3i(year, 0, 0), key).x) - 0.5);
}

// A place among the years: which one, and how far through it.
struct Year {
    number: i32,
    through: f32,
    width: f32,
    dark: f32,
}

fn year_at(time: f32, key: vec3u) -> Year {
    var number = i32(floor(clamp(time, -1e6, 1e6)));
    number -= select(0, 1, time < year_end(number, key));
    number += select(0, 1, time >= year_end(number + 1, key));
    let start = year_end(number, key);
    let width = year_end(number + 1, key) - start;
    let dark = 0.55 + 0.45 * unit_random(cell_random(vec3i(number, 0, 0), key).y);
    return Year(number, clamp((time - start) / width, 0.0, 1.0), width, dark);
}

// The tone from the start of a year on, summed up: a slow rise, x / 4 + 3 x⁴ / 4, that ends at once.
fn summed(year: Year) -> f32 {
    let x = year.through;
    let square = x * x;
    return year.dark * year.width * square * (0.125 + 0.15 * square * x);
}

fn whole(year: Year) -> f32 {
    return 0.275 * year.dark * year.width;
}

// The mean tone over a stretch of `blur` years: the edge between years is as sharp as the texels allow.
fn ring_tone(time: f32, blur: f32, key: vec3u) -> f32 {
    let reach = clamp(blur, 0.07, 1.0);
    let first = year_at(time - 0.5 * reach, key);
    let last = year_at(time + 0.5 * reach, key);
    var sum = summed(last) - summed(first);
    sum += select(0.0, whole(first), last.number > first.number);
    // The narrowest year is 0.6 wide, so at most one lies between.
    if last.number > first.number + 1 {
        sum += whole(year_at(0.5 * (year_end(first.number + 1, key) + year_end(last.number, key)), key));
    }
    let mean = 0.275 * 0.775;
    return mix(mean, sum / reach, carried(2.0, blur));
}

// The branch that matters most here. They leave the pith in cells of its length, mostly toward the piece.
fn nearest_branch(along: f32, across: vec2f, toward: vec2f, key: vec3u, knots: f32) -> Knot {
    var nearest = Knot(1e6, 0.0, vec2f(0.0));
    let spacing = 12.0;
    // Branches rise alike, within a tenth: the cell is that from which one comes here.
    let cell = i32(floor(clamp((along - 0.3 * length(across)) / spacing, -1e6, 1e6)));
    let ahead = toward / max(length(toward), 1e-6);
    for (var i = -1; i < 2; i++) {
        let random = pcg3d(bitcast<vec3u>(vec3i(cell + i, 1, 0)) + key);
        let chance = unit_random3(random);
        let more = unit_random3(pcg3d(random));
        if chance.x >= knots {
            continue;
        }
        let turn = turn_of(vec3f(1.3 * (chance.y - 0.5), 0.0, 0.0));
        let side = vec2f(
            ahead.x * turn.cosine.x - ahead.y * turn.sine.x,
            ahead.x * turn.sine.x + ahead.y * turn.cosine.x,
        );
        let rise = 0.25 + 0.1 * more.x;
        let axis = vec3f(rise, side) * inverseSqrt(1.0 + rise * rise);
        let away = vec3f(along - spacing * (f32(cell + i) + chance.z), across);
        let branch = branch_at(away, axis, 0.2 + 0.14 * more.y);
        nearest.swell = max(nearest.swell, branch.swell);
        nearest.aside += branch.aside;
        nearest.year = min(nearest.year, branch.year);
    }
    return nearest;
}

// A branch that starts where `away` is zero and grows `thick` wide in a year.
fn branch_at(away: vec3f, axis: vec3f, thick: f32) -> Knot {
    let out = dot(away, axis);
    let beside = away - axis * out;
    let distance = length(beside);
    let grown = max(out, 0.0);
    // The branch runs ahead of the trunk, less and less; its width is what it has grown since.
    let lead = 0.42 * grown / (1.0 + grown / 10.0);
    let year = abs(out) - lead + distance / thick;
    let radius = thick * lead;
    // Ends three reaches away, before a cell that was not looked at could matter.
    let reach = min(2.2 * radius + 0.25, 1.2);
    let stretched = vec3f(0.45 * beside.x, beside.yz) / (3.0 * reach);
    let left = max(1.0 - dot(stretched, stretched), 0.0);
    let near = left * left * left;
    let lateral = beside.yz;
    let width = length(lateral);
    let push = min(radius * near, 0.7 * width);
    return Knot(year, 1.4 * radius * near * near, lateral * (push / max(width, 1e-6)));
}
