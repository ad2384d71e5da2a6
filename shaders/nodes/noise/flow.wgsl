//! Flow
//! Swirling noise, as of smoke, oil, marble, soot and stirred paint.
//!
//! Large eddies carry the small ones along, so that shapes are drawn out, folded and wound up. Mask are the clouds, Veins are
//! thin lines through them, and Direction follows both. Age lets the same pattern flow on. Detail finer than the texels
//! fades out evenly.
//! @alias smoke turbulence swirl marble oil veins soot curl eddies liquid stirred warp domain fluid ink
//! @use noise lines

struct Params {
    /// Size of the largest eddies.
    /// @length @range 0.0001 100 @soft 0.02 1 @default 0.25
    size: f32,
    /// Number of finer layers.
    /// @label Detail @range 1 12 @soft 1 8 @default 6
    octaves: u32,
    /// Strength of each layer relative to the one before.
    /// @label Grain @range 0 1 @default 0.5
    gain: f32,
    /// Strength of the eddies: 0 are plain clouds, 1 is wound up, more is thoroughly mixed.
    /// @range 0 4 @soft 0 2 @default 1
    swirl: f32,
    /// Time that the pattern has flowed; fine eddies turn faster than large ones.
    /// @range -1000 1000 @soft 0 2 @default 0
    age: f32,
    /// Width of the lines of Veins, measured on the surface.
    /// @length @range 0 10 @soft 0.001 0.05 @default 0.006
    width: f32,
    /// Stretches the pattern along its axes.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The noise, its slope and its direction.
/// @shared
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
fn flow(at: Surface, position: vec3f, params: Params) -> Flow {
    // Flow noise: gradients that rotate with time, and layers that the coarser layers carry along (Perlin and Neyret, "Flow
    // noise", 2001). Each corner of the lattice has an eddy around the axis that its gradient rotates about, and all derivatives are
    // kept by the chain rule.
    let sides = sides_of(at);
    let scale = params.stretch * params.size;
    var key = seed_key(params.seed);
    var frame = Frame(
        noise_place(position, params.stretch, params.rotate) / params.size + unit_random3(pcg3d(key)),
        noise_direction(sides.first, params.rotate) / scale,
        noise_direction(sides.second, params.rotate) / scale,
    );
    let strength = simplex_noise(frame.place * 0.9, key + vec3u(5u));
    var wave = 1.4;
    for (var index = 0u; index < EDDIES; index++) {
        frame = carried_along(frame, wave, 0.33 * params.swirl, params.age, key + vec3u(0x51ed270bu), at.texel_size);
        key += vec3u(0x9e3779b9u, 0x85ebca6bu, 0xc2b2ae35u);
        wave *= 0.6;
    }
    var flow = Flow(0.0, 0.0, vec2f(0.0), smoothstep(-2.0, 0.9, strength));
    var weight = 1.0;
    var whole = 0.0;
    var kept = 0.0;
    var finer = 1.0;
    for (var octave = 0u; octave < params.octaves; octave++) {
        let scaled = Frame(frame.place * finer + 0.37 * f32(octave), frame.first * finer, frame.second * finer);
        let seen = weight * carried(wavelength_of(scaled), at.texel_size);
        let eddy = eddy_noise(scaled, params.age * sqrt(finer), key);
        flow.value += seen * eddy.value;
        let low = select(0.0, seen, octave < 2u);
        flow.line += low * eddy.value;
        flow.slope += low * vec2f(eddy.first, eddy.second);
        whole += weight * weight;
        kept += seen * seen;
        let carry = 0.15 * params.swirl * seen / max(weight, 1e-9) / finer;
        frame.place += carry * eddy.turn.place;
        frame.first += carry * eddy.turn.first;
        frame.second += carry * eddy.turn.second;
        weight *= params.gain;
        finer *= 2.0;
        key += vec3u(0x9e3779b9u, 0x85ebca6bu, 0xc2b2ae35u);
    }
    // What the texels do not carry is averaged out, as in Clouds.
    let norm = inverseSqrt(max(2.0 * whole - kept, 1e-12));
    flow.value *= norm;
    return flow;
}

/// The clouds, spread evenly over 0 to 1.
fn mask(flow: Flow) -> f32 {
    return normal_share(clamp(flow.value, -5.0, 5.0));
}

/// Thin lines along the flow, of different strength: the veins of marble.
fn veins(at: Surface, flow: Flow, params: Params) -> f32 {
    let steep = max(length(flow.slope), 1e-6);
    let distance = abs(flow.line) / steep;
    let across = abs(flow.slope.x) / steep;
    let sine = sqrt(max(1.0 - across * across, 0.0));
    let texel = at.texel_size * vec2f(max(across, sine), min(across, sine));
    // Where the noise is flat, a line of it would be a patch.
    let present = smoothstep(0.3, 2.0, steep * params.size) * flow.strength;
    let outer = params.width * present;
    return present * line_cover(distance, 0.0, outer, texel);
}

/// Direction of the flow along the surface, unit length, in model space.
/// @vector
fn direction(at: Surface, flow: Flow) -> vec3f {
    let sides = sides_of(at);
    let way = sides.second * flow.slope.x - sides.first * flow.slope.y;
    let size = dot(way, way);
    return select(sides.first, way * inverseSqrt(max(size, 1e-30)), size > 1e-20);
}

// Octaves of the eddies that the clouds are drawn out by before they are read.
const EDDIES: u32 = 3u;

// Two directions along the surface, at right angles.
struct Sides {
    first: vec3f,
    second: vec3f,
}

fn sides_of(at: Surface) -> Sides {
    let n = at.normal;
    let flat = at.tangent.xyz - n * dot(at.tangent.xyz, n);
    let size = dot(flat, flat);
    let other = cross(n, select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(n.x) > 0.7));
    let first = normalize(select(other, flat, size > 1e-8));
    return Sides(first, cross(n, first));
}

// A place in the noise, and how far it moves for a step of one working unit along either side.
struct Frame {
    place: vec3f,
    first: vec3f,
    second: vec3f,
}

struct Flow {
    // Mean 0, standard deviation 1.
    value: f32,
    // The same of the largest layers only, whose zeros are the veins.
    line: f32,
    // Its change for a step of one working unit along either side.
    slope: vec2f,
    // A slow random value for the strength of veins.
    strength: f32,
}

// The frame after eddies of one size, in two steps, so that they wind up and do not fold.
fn carried_along(frame: Frame, wave: f32, amount: f32, age: f32, key: vec3u, texel_size: f32) -> Frame {
    var moved = frame;
    let share = 0.5 * amount * wave;
    for (var step = 0; step < 2; step++) {
        let scaled = Frame(moved.place / wave, moved.first / wave, moved.second / wave);
        let seen = share * carried(wavelength_of(scaled), texel_size);
        if seen == 0.0 {
            break;
        }
        let turn = eddy_noise(scaled, age, key).turn;
        moved.place += seen * turn.place;
        moved.first += seen * turn.first;
        moved.second += seen * turn.second;
    }
    return moved;
}

// Wavelength of a noise of one feature a unit, as it lies on the surface here.
fn wavelength_of(frame: Frame) -> f32 {
    return inverseSqrt(max(max(dot(frame.first, frame.first), dot(frame.second, frame.second)), 1e-20));
}

struct Eddy {
    // Simplex noise, standard deviation 1, and its change for both steps of the frame.
    value: f32,
    first: f32,
    second: f32,
    // The movement of the eddies, and its changes.
    turn: Frame,
}

// Simplex noise (Perlin 2001) with rotating gradients, and the eddies around its corners: each is a rotation that fades
// outward, which neither gathers nor spreads what it moves.
fn eddy_noise(frame: Frame, age: f32, key: vec3u) -> Eddy {
    let place = frame.place;
    let skewed = place + (place.x + place.y + place.z) * 0.33333333;
    let cell = floor(skewed);
    let inside = skewed - cell;
    let offset = inside - (inside.x + inside.y + inside.z) * 0.16666667;
    let greater = vec3u(
        select(0u, 1u, inside.x >= inside.y),
        select(0u, 1u, inside.y >= inside.z),
        select(0u, 1u, inside.z > inside.x),
    );
    let smaller = vec3u(1u) - greater;
    let base = bitcast<vec3u>(vec3i(cell)) + key;
    var sum = Eddy(0.0, 0.0, 0.0, Frame(vec3f(0.0), vec3f(0.0), vec3f(0.0)));
    for (var corner = 0u; corner < 4u; corner++) {
        var step = select(vec3u(0u), vec3u(1u), corner == 3u);
        step = select(step, greater & smaller.zxy, corner == 1u);
        step = select(step, greater | smaller.zxy, corner == 2u);
        let away = offset - vec3f(step) + f32(corner) * 0.16666667;
        let random = pcg3d(base + step);
        // 16 bits each: an axis, and a direction that is turned about it.
        let axis = vec3f(random & vec3u(0xffffu)) / 32768.0 - 1.0;
        let start = vec3f(random >> vec3u(16u)) / 32768.0 - 1.0;
        let aside = cross(axis, start);
        let turn = turn_of(vec3f(6.2831853 * fract(age * (0.5 + 0.5 * abs(axis.x)))));
        let gradient = start * turn.cosine.x + aside * turn.sine.x;
        let near = max(0.5 - dot(away, away), 0.0);
        let cube = near * near * near;
        let rise = dot(gradient, away);
        let slope = cube * (near * gradient - 8.0 * rise * away);
        sum.value += cube * near * rise;
        sum.first += dot(slope, frame.first);
        sum.second += dot(slope, frame.second);
        let spin = cross(axis, away);
        let fall = -8.0 * cube;
        sum.turn.place += cube * near * spin;
        sum.turn.first += cube * near * cross(axis, frame.first) + fall * dot(away, frame.first) * spin;
        sum.turn.second += cube * near * cross(axis, frame.second) + fall * dot(away, frame.second) * spin;
    }
    let strength = 250.0;
    return Eddy(
        sum.value * strength, sum.first * strength, sum.second * strength,
        Frame(sum.turn.place * strength, sum.turn.first * strength, sum.turn.second * strength),
    );
}
