//! Fibers
//! Fine noise drawn out along a direction: brushed and turned metal, fibers, hair, wood grain, worn stone.
//!
//! The direction may turn from place to place and comes from a vector, from the piece, or runs around an axis as on a lathe.
//! Fibers run over seams. Connect Mask to the roughness or, weakly, to the height of a layer. Fibers finer than the texels
//! fade to their mean.
//! @alias anisotropic brushed fiber hair grain lathe turned satin directional streaks wood fur grind machined
//! @use noise surface

struct Params {
    /// Thickness of the fibers.
    /// @length @range 0.00001 100 @soft 0.001 0.05 @default 0.01
    size: f32,
    /// Length of the fibers.
    /// @length @range 0.0001 100 @soft 0.02 1 @default 0.25
    length: f32,
    /// Source of the direction: the input Toward, circles around the axis Toward through Center, the longest side of each
    /// piece, or circles around the longest side of each piece.
    /// @choice toward around piece piece_around @default toward
    along: u32,
    /// A point on the axis that the fibers run around. Affects only fibers around Toward.
    /// @range -1000 1000 @soft -1 1 @default 0 0 0
    center: vec3f,
    /// Number of finer layers of fibers.
    /// @label Detail @range 1 6 @default 3
    octaves: u32,
    /// Contrast: 0 is an even gray, at 0.5 all values are equally frequent, 1 is black and white.
    /// @range 0 1 @default 0.5
    contrast: f32,
    /// Crookedness of the fibers.
    /// @range 0 1 @default 0.1
    wander: f32,
    /// Strength of a second family of fibers that crosses the first at a right angle.
    /// @range 0 1 @default 0
    cross: f32,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The place in the piece's box, whose differences from texel to texel tell how the box is turned.
/// @pass 1 @vector
fn box_place(at: Surface) -> vec3f {
    return at.piece_position;
}

/// The fibers: values from 0 to 1.
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
/// @input toward Direction of the fibers, or the axis that they run around, in model space. @vector @optional @default 0 1 0
fn mask(at: Surface, position: vec3f, toward: vec3f, box_place: texture_2d_array<f32>, params: Params) -> f32 {
    let site = site_of(at, position, toward, box_of(at, box_place), params);
    var sum = 0.0;
    // Rings in space are drawn out along the surface only where they lie in it; elsewhere fibers follow their direction.
    if site.slant < 1.0 {
        sum = sqrt(1.0 - site.slant) * ring_fibers(site, at.texel_size, params);
    }
    if site.slant > 0.0 {
        sum += sqrt(site.slant) * turning_fibers(site, site.along, at.texel_size, params);
    }
    if params.cross > 0.0 {
        let second = turning_fibers(site, cross(site.normal, site.along), at.texel_size, params);
        sum = (sum + params.cross * second) * inverseSqrt(1.0 + params.cross * params.cross);
    }
    // Detail that the texels do not carry has lowered the deviation, so the mask fades to its mean.
    let steep = params.contrast / max(1.0 - params.contrast, 0.02);
    return normal_share(clamp(sum * steep, -5.0, 5.0));
}

/// Direction of the fibers along the surface, unit length, in model space.
/// @vector
fn direction(at: Surface, toward: vec3f, box_place: texture_2d_array<f32>, params: Params) -> vec3f {
    let box = box_of(at, box_place);
    let way = site_of(at, at.position, toward, box, params).along;
    return select(way, normalize(box.x * way.x + box.y * way.y + box.z * way.z), params.along >= ALONG_PIECE);
}

// The axes of the piece's box in model space: along the surface by the slopes of the place in the box, across it by the normal.
struct Box {
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

fn box_of(at: Surface, box_place: texture_2d_array<f32>) -> Box {
    let u = 0.5 * (surface_neighbor(box_place, at, vec2i(1, 0)) - surface_neighbor(box_place, at, vec2i(-1, 0)));
    let v = 0.5 * (surface_neighbor(box_place, at, vec2i(0, 1)) - surface_neighbor(box_place, at, vec2i(0, -1)));
    let x = surface_covector(at, vec2f(u.x, v.x)) + at.face_normal * at.piece_normal.x;
    let y = surface_covector(at, vec2f(u.y, v.y)) + at.face_normal * at.piece_normal.y;
    let z = surface_covector(at, vec2f(u.z, v.z)) + at.face_normal * at.piece_normal.z;
    return Box(unit_or_zero(x), unit_or_zero(y), unit_or_zero(z));
}

fn unit_or_zero(v: vec3f) -> vec3f {
    return v * inverseSqrt(max(dot(v, v), 1e-12));
}

const ALONG_AROUND: u32 = 1u;
const ALONG_PIECE: u32 = 2u;
const ALONG_PIECE_AROUND: u32 = 3u;
// Directions to half a side of the cube that fibers are frozen to: neighbors are at most 7 degrees apart.
const FROZEN: f32 = 8.0;

// A place among the fibers, in the space that they live in: the model, or the piece's box.
struct Site {
    place: vec3f,
    normal: vec3f,
    // Unit direction along the surface.
    along: vec3f,
    // The axis that fibers run around, unit length.
    axis: vec3f,
    // 0 where fibers run in rings around the axis, 1 where they follow the direction.
    slant: f32,
    key: vec3u,
}

fn site_of(at: Surface, position: vec3f, toward: vec3f, box: Box, params: Params) -> Site {
    let in_piece = params.along >= ALONG_PIECE;
    var place = select(position - params.center, at.piece_position + (position - at.position), in_piece);
    // The shading normal in the piece's box: the triangle's is known there.
    let bent = at.normal - at.face_normal;
    let normal_in_box = normalize(at.piece_normal + vec3f(dot(bent, box.x), dot(bent, box.y), dot(bent, box.z)));
    let normal = select(at.normal, normal_in_box, in_piece);
    let long = dot(toward, toward);
    let given = select(vec3f(0.0, 1.0, 0.0), toward * inverseSqrt(max(long, 1e-20)), long > 1e-12);
    let axis = select(given, vec3f(1.0, 0.0, 0.0), in_piece);
    // Every piece has fibers of its own.
    let key = seed_key(params.seed + select(0u, at.seed, in_piece));
    let radius = place - axis * dot(place, axis);
    let is_around = params.along == ALONG_AROUND || params.along == ALONG_PIECE_AROUND;
    let way = select(axis, cross(axis, radius), is_around);
    let along = along_surface(way, normal, axis);
    let lean = abs(dot(unit_or_zero(way), normal));
    let slant = select(1.0, smoothstep(0.06, 0.25, lean), is_around);
    if params.wander > 0.0 {
        let p = place / (0.8 * params.length);
        let moves = vec3f(
            simplex_noise(p, key + vec3u(1u)), simplex_noise(p, key + vec3u(2u)), simplex_noise(p, key + vec3u(3u)));
        place += params.wander * carried(0.8 * params.length, at.texel_size) * 0.1 * params.length * moves;
    }
    return Site(place, normal, along, axis, slant, key);
}

// The direction `way` laid on the surface. Where it stands almost upright on the surface, another axis takes its place,
// turned in smoothly.
fn along_surface(way: vec3f, normal: vec3f, axis: vec3f) -> vec3f {
    let whole = max(dot(way, way), 1e-20);
    let unit = way * inverseSqrt(whole);
    let flat = unit - normal * dot(unit, normal);
    let m = abs(axis);
    let other = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 0.0, 1.0), m.x > max(m.y, m.z));
    let side = other - normal * dot(other, normal);
    let share = smoothstep(0.3, 0.1, length(flat));
    let mixed = mix(flat, side * select(-1.0, 1.0, dot(flat, side) >= 0.0), share);
    let size = dot(mixed, mixed);
    return select(unit, mixed * inverseSqrt(max(size, 1e-20)), size > 1e-12);
}

// Fibers along a direction that may turn. Noise that is drawn out along the local direction would swim where that turns; so it
// is drawn out along frozen directions, the three nearest of a net over all directions, and blended with their variance
// kept (as by-example noise is, Heitz and Neyret 2018). A direction and its opposite are one.
fn turning_fibers(site: Site, along: vec3f, texel_size: f32, params: Params) -> f32 {
    let m = abs(along);
    let face = select(select(2u, 1u, m.y >= m.z), 0u, m.x >= m.y && m.x >= m.z);
    let turned = select(select(along.zxy, along.yzx, face == 1u), along, face == 0u);
    let net = clamp(turned.yz / turned.x, vec2f(-1.0), vec2f(1.0)) * FROZEN;
    let corner = floor(net);
    let inside = net - corner;
    let is_upper = inside.x + inside.y > 1.0;
    let weights = select(
        vec3f(1.0 - inside.x - inside.y, inside.x, inside.y),
        vec3f(inside.x + inside.y - 1.0, 1.0 - inside.x, 1.0 - inside.y),
        is_upper,
    );
    var sum = 0.0;
    var whole = 0.0;
    for (var index = 0; index < 3; index++) {
        // Sharpened, so that most places have one family only.
        let near = weights[index] * weights[index];
        let weight = near * weights[index];
        var step = select(vec2f(0.0), vec2f(1.0), is_upper);
        if index == 1 {
            step = select(vec2f(1.0, 0.0), vec2f(0.0, 1.0), is_upper);
        }
        if index == 2 {
            step = select(vec2f(0.0, 1.0), vec2f(1.0, 0.0), is_upper);
        }
        if weight > 1e-3 {
            let node = vec3f(FROZEN, corner + step);
            let frozen = select(select(node.yzx, node.zxy, face == 1u), node, face == 0u);
            sum += weight * frozen_fibers(site, frozen, texel_size, params);
        }
        whole += weight * weight;
    }
    return sum * inverseSqrt(max(whole, 1e-12));
}

// Fibers along one direction, given in whole numbers: the same from both sides of the cube's edges.
fn frozen_fibers(site: Site, frozen: vec3f, texel_size: f32, params: Params) -> f32 {
    // Of a direction and its opposite the one whose first number that is not 0 is above it.
    let lead = select(select(frozen.z, frozen.y, frozen.y != 0.0), frozen.x, frozen.x != 0.0);
    let whole = frozen * sign(lead);
    let along = normalize(whole);
    let m = abs(along);
    let other = select(vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, 1.0), m.y > 0.7);
    let first = normalize(cross(along, other));
    let second = cross(along, first);
    let place = vec3f(dot(site.place, along), dot(site.place, first), dot(site.place, second));
    return fiber_octaves(place, site.key + bitcast<vec3u>(vec3i(whole)) * 747796405u, texel_size, params);
}

// Fibers around an axis. The angle is cut open on one side; two cuts are blended, each where the other one is.
fn ring_fibers(site: Site, texel_size: f32, params: Params) -> f32 {
    let m = abs(site.axis);
    let other = select(vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, 1.0), m.y > 0.7);
    let first = normalize(cross(site.axis, other));
    let second = cross(site.axis, first);
    let flat = vec2f(dot(site.place, first), dot(site.place, second));
    let radius = length(flat);
    let turn = select(0.0, atan2(flat.y, flat.x), radius > 1e-9);
    let opposite = turn - select(-3.1415927, 3.1415927, turn > 0.0);
    // Squares of the weights: their sum is 1.
    let near = 0.5 + 0.5 * flat.x / max(radius, 1e-9);
    let place = vec3f(0.0, radius, dot(site.place, site.axis));
    var sum = 0.0;
    if near > 1e-3 {
        sum += sqrt(near) * fiber_octaves(place + vec3f(turn * radius, 0.0, 0.0), site.key, texel_size, params);
    }
    if near < 0.999 {
        let key = site.key + vec3u(0x51ed270bu, 0x2545f491u, 0x6c8e9cf5u);
        sum += sqrt(1.0 - near) * fiber_octaves(place + vec3f(opposite * radius, 0.0, 0.0), key, texel_size, params);
    }
    return sum;
}

// Octaves of noise that is drawn out along x, working units: mean 0, standard deviation 1 where the texels carry them.
fn fiber_octaves(place: vec3f, key: vec3u, texel_size: f32, params: Params) -> f32 {
    var wave = params.size;
    var long = params.length;
    var own = key;
    var weight = 1.0;
    var sum = 0.0;
    var whole = 0.0;
    for (var octave = 0u; octave < params.octaves; octave++) {
        let seen = weight * carried(wave, texel_size);
        if seen > 0.0 {
            // Leaning a little, so that fibers do not begin and end in rows.
            let p = vec3f(place.x / max(long, wave), place.yz / wave) + 0.37 * f32(octave);
            sum += seen * simplex_noise(vec3f(p.x + 0.31 * p.y - 0.23 * p.z, p.yz), own);
        }
        whole += weight * weight;
        weight *= 0.75;
        wave *= 0.5;
        long *= 0.62;
        own += vec3u(0x9e3779b9u, 0x85ebca6bu, 0xc2b2ae35u);
    }
    return sum * inverseSqrt(whole);
}
