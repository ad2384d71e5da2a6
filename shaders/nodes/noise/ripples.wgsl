//! Ripples
//! Wavy stripes of even width that run along a direction, fork and end: sand ripples, zebra, fingerprints, wood grain.
//!
//! Spread decides on the kind: straight stripes, waves, or a maze without a direction. The stripes run over seams. Stripes
//! narrower than the texels fade to their mean.
//! @alias stripes zebra sand dunes fingerprint ridges waves phasor gabor maze labyrinth wood grain brushed tiger wave
//! @use cells

struct Params {
    /// Distance from one stripe to the next.
    /// @length @range 0.0001 100 @soft 0.005 0.2 @default 0.04
    size: f32,
    /// Range of directions that the stripes wave about: 0 is straight, 180 is a maze.
    /// @angle @range 0 180 @default 50
    spread: f32,
    /// Frequency of forks and ends.
    /// @range 0 1 @default 0.5
    forks: f32,
    /// Sharpness of the borders: 0 is a soft wave, 1 has crisp borders.
    /// @range 0 1 @default 0.3
    sharpness: f32,
    /// Share of the surface that the stripes of Mask cover.
    /// @range 0 1 @default 0.5
    share: f32,
    /// Lean of the waves of Height to one side, as of wind-blown sand.
    /// @range -1 1 @default 0.3
    lean: f32,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// Cosine and sine of the phase of the waves.
/// @shared
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
/// @input toward Direction that the stripes run in, in model space. @vector @optional @default 1 0 0
fn wave(at: Surface, position: vec3f, toward: vec3f, params: Params) -> vec2f {
    // Cosine and sine of the waves' phase (phasor noise: Tricard, Efremov, Zanni, Neyret, Martinez and Lefebvre, "Procedural
    // phasor noise", 2019): the phase of a sum of wave packets is even where their amplitude is not. Packets are scattered through
    // space, two in each cube; their direction is taken at the place that is evaluated, since it is not known
    // elsewhere; a packet is so short that this does not show.
    // Radius of a packet, in waves: also the side of a cube.
    let radius = mix(7.0, 1.8, sqrt(clamp(params.forks, 0.0, 1.0)));
    let place = wrapped(position / (radius * params.size) + vec3f(0.2713, 0.3137, 0.2299));
    let key = seed_key(params.seed);
    let rows = rows_around(place, key);
    let ahead = along_surface(toward, at.normal);
    let across = cross(at.normal, ahead);
    let cycle = 6.2831853 * radius;
    var sum = vec2f(0.0);
    for (var index = 0; index < 9; index++) {
        let step = row_step(rows, index);
        let numbers = number_row(rows, step, key);
        let x = vec3f(-1.0, 0.0, 1.0) - rows.inside.x;
        let yz = vec2f(step) - rows.inside.yz;
        sum += packets(numbers.x, numbers.z & vec3u(0xffffu), x, yz, ahead, across, cycle, params.spread);
        sum += packets(numbers.y, numbers.z >> vec3u(16u), x, yz, ahead, across, cycle, params.spread);
    }
    // At the forks the amplitude is zero; close to them the wave flattens.
    return sum * inverseSqrt(dot(sum, sum) + 0.0008);
}

/// The stripes: 1 on them, 0 between.
fn mask(at: Surface, wave: vec2f, params: Params) -> f32 {
    // The cosine that the wanted share of all phases lies above. Soft borders reach further, so at the ends it goes further too.
    let cosine = turn_of(vec3f(3.1415927 * params.share)).cosine.x;
    // Borders no sharper than two texels.
    let blur = max(1.2 * (1.0 - params.sharpness), min(3.1415927 * at.texel_size / params.size, 1.0));
    let square = cosine * cosine;
    let end = square * square * square * square;
    let level = cosine * (1.0 + min(blur, 1.0) * end * end);
    let value = clamp(0.5 + 0.5 * softened(wave.x - level, blur) / softened(1.0, blur), 0.0, 1.0);
    // Nothing at 0, everything at 1.
    let some = value * min(50.0 * params.share, 1.0);
    let covered = 1.0 - (1.0 - some) * min(50.0 * (1.0 - params.share), 1.0);
    return mix(params.share, covered, carried(params.size, at.texel_size));
}

/// The waves: 0 in the troughs, 1 on the crests, which are sharper the higher Sharpness is.
fn height(at: Surface, wave: vec2f, params: Params) -> f32 {
    // The second harmonic pushes crests aside.
    let leaning = wave.x * (1.0 + 0.9 * params.lean * wave.y) / (1.0 + 0.35 * abs(params.lean));
    let round = clamp(0.5 + 0.5 * leaning, 0.0, 1.0);
    let crest = round * (1.0 - params.sharpness) + params.sharpness * round * round;
    let mean = 0.5 - 0.125 * params.sharpness;
    return mix(mean, crest, carried(params.size, at.texel_size));
}

/// Where the place lies between a stripe and the next: 0 on one, growing to 1 at the next one. Connect it to a curve for a
/// profile of your own.
fn phase(wave: vec2f) -> f32 {
    return fract(atan2(wave.y, wave.x) * 0.15915494 + 1.0);
}

fn softened(x: f32, blur: f32) -> f32 {
    return x * inverseSqrt(x * x + blur * blur * 0.25 + 1e-8);
}

// The sum of three packets, one in each cube of a row; `bits` are their places, `waves` their phases and directions.
fn packets(
    bits: vec3u, waves: vec3u, x: vec3f, yz: vec2f, ahead: vec3f, across: vec3f, cycle: f32, turns: f32,
) -> vec2f {
    // From the place to the packets' middles, decided in 1/1024 of a cube.
    let dx = x + vec3f(bits >> vec3u(22u)) * 0.0009765625;
    let dy = yz.x + vec3f((bits >> vec3u(12u)) & vec3u(1023u)) * 0.0009765625;
    let dz = yz.y + vec3f((bits >> vec3u(2u)) & vec3u(1023u)) * 0.0009765625;
    let near = max(1.0 - (dx * dx + dy * dy + dz * dz), vec3f(0.0));
    if near.x + near.y + near.z <= 0.0 {
        return vec2f(0.0);
    }
    let weight = near * near;
    let beside = across.x * dx + across.y * dy + across.z * dz;
    let along = ahead.x * dx + ahead.y * dy + ahead.z * dz;
    let turn = turn_of(turns * (vec3f(waves & vec3u(255u)) / 255.0 - 0.5));
    let start = vec3f(waves >> vec3u(8u)) * 0.024543693;
    let wave = turn_of(start - cycle * (turn.cosine * beside + turn.sine * along));
    return vec2f(dot(weight, wave.cosine), dot(weight, wave.sine));
}

// The direction laid on the surface. Where it stands almost upright on the surface, another axis takes its place, turned in
// smoothly.
fn along_surface(way: vec3f, normal: vec3f) -> vec3f {
    let whole = dot(way, way);
    let unit = select(vec3f(1.0, 0.0, 0.0), way * inverseSqrt(max(whole, 1e-20)), whole > 1e-12);
    let m = abs(unit);
    let other = select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), m.z >= max(m.x, m.y));
    let flat = unit - normal * dot(unit, normal);
    let side = other - normal * dot(other, normal);
    let mixed = mix(flat, side, smoothstep(0.3, 0.1, length(flat)));
    let size = dot(mixed, mixed);
    let any = cross(normal, select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(normal.x) > 0.7));
    return select(normalize(any), mixed * inverseSqrt(max(size, 1e-20)), size > 1e-8);
}
