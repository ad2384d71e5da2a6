//! Solid noise: where it is read, how fine it may be, simplex noise, and masks that mean coverage.
//! @use hash

/// Sines and cosines of three angles, radians. Polynomials after reduction to an eighth of a turn (error below 1e-6),
/// since the built-in functions may differ by 2⁻¹¹ from adapter to adapter, which fine noise turns into another
/// picture.
struct Turn {
    sine: vec3f,
    cosine: vec3f,
}

/// Sines and cosines of angles of a few turns; an angle of 0 gives exactly 0 and 1.
fn turn_of(angle: vec3f) -> Turn {
    let quarter = round(angle * 0.63661977);
    // Pi/2 in two parts: the first has few bits, so that its product with a small whole number is exact.
    let rest = (angle - quarter * 1.5703125) - quarter * 4.8382679e-4;
    let square = rest * rest;
    let near_sine = rest * (1.0 + square * (-0.16666654 + square * (0.0083321608 + square * -1.9515296e-4)));
    let near_cosine = 1.0 + square * (-0.5 + square * (0.041666645 + square * (-0.0013887316 + square * 2.4433157e-5)));
    let index = vec3i(quarter);
    let odd = (index & vec3i(1)) != vec3i(0);
    let sine = select(near_sine, near_cosine, odd);
    let cosine = select(near_cosine, near_sine, odd);
    return Turn(
        select(sine, -sine, (index & vec3i(2)) != vec3i(0)),
        select(cosine, -cosine, ((index + vec3i(1)) & vec3i(2)) != vec3i(0)),
    );
}

/// A direction of the model in the noise's own axes, which `rotate` has turned (radians; about x, then y, then z).
fn noise_direction(direction: vec3f, rotate: vec3f) -> vec3f {
    let turn = turn_of(rotate);
    // The pattern is turned forward by looking it up backward: z first, then y, then x.
    var p = direction;
    p = vec3f(turn.cosine.z * p.x + turn.sine.z * p.y, turn.cosine.z * p.y - turn.sine.z * p.x, p.z);
    p = vec3f(turn.cosine.y * p.x - turn.sine.y * p.z, p.y, turn.cosine.y * p.z + turn.sine.y * p.x);
    return vec3f(p.x, turn.cosine.x * p.y + turn.sine.x * p.z, turn.cosine.x * p.z - turn.sine.x * p.y);
}

/// The place in the noise's own space: turns the pattern by `rotate` and draws it out by `stretch` along its own axes.
fn noise_place(position: vec3f, stretch: vec3f, rotate: vec3f) -> vec3f {
    return noise_direction(position, rotate) / stretch;
}

/// The factor by which `stretch` changes the finest wavelength.
fn finest_stretch(stretch: vec3f) -> f32 {
    return min(min(stretch.x, stretch.y), stretch.z);
}

/// How much of a wave a grid of texels can carry: 0 below two texels a wave, 1 from four on, smooth between.
/// The rest is to be replaced by its mean.
fn carried(wavelength: f32, texel_size: f32) -> f32 {
    let t = clamp(wavelength / max(2.0 * texel_size, 1e-12) - 1.0, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// Folds a place into the range where cells can be told apart: the pattern repeats every 65536 cells.
fn wrapped(place: vec3f) -> vec3f {
    return place - 65536.0 * round(place * 1.52587890625e-5);
}

/// The cell a place lies in, decided in 1/65536 of a cell, so that adapters that round the place alike agree on the
/// cell.
fn cell_of(place: vec3f) -> vec3i {
    return vec3i(round(place * 65536.0)) >> vec3u(16u);
}

/// Random numbers of a cell, the same for cells 65536 apart.
fn cell_random(cell: vec3i, key: vec3u) -> vec3u {
    return pcg3d((bitcast<vec3u>(cell) & vec3u(65535u)) + key);
}

/// Contribution of one corner of a simplex: `base` is the corner's hash state, `offset` leads from the corner to the place.
fn simplex_corner(base: vec3u, offset: vec3f) -> f32 {
    // pcg3d, of which the first number is enough.
    var v = base;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3u(16u);
    let bits = v.x + v.y * v.z;
    // One of the twelve directions to the edges of a cube: thirty bits choose the two axes, the last two the signs.
    let axes = bits & 0x3fffffffu;
    let first = select(offset.x, offset.y, axes < 0x15555556u);
    let second = select(offset.z, offset.y, axes >= 0x2aaaaaabu);
    let slope = bitcast<f32>(bitcast<u32>(first) ^ (bits & 0x80000000u))
        + bitcast<f32>(bitcast<u32>(second) ^ ((bits << 1u) & 0x80000000u));
    let near = max(0.5 - dot(offset, offset), 0.0);
    let near_square = near * near;
    return near_square * near_square * slope;
}

/// Simplex noise in three dimensions, one feature a unit: mean 0, standard deviation 1, continuous with its first
/// derivatives.
///
/// The cell is chosen in floats: a place on a border gives the same value from both sides, so nothing depends on the
/// choice.
fn simplex_noise(place: vec3f, key: vec3u) -> f32 {
    let skewed = place + (place.x + place.y + place.z) * 0.33333333;
    let cell = floor(skewed);
    let inside = skewed - cell;
    let offset = inside - (inside.x + inside.y + inside.z) * 0.16666667;
    // The order of the coordinates says which two of the cube's other corners the simplex has. The last comparison is
    // strict, so that equal coordinates still make an order.
    let greater = vec3u(
        select(0u, 1u, inside.x >= inside.y),
        select(0u, 1u, inside.y >= inside.z),
        select(0u, 1u, inside.z > inside.x),
    );
    let smaller = vec3u(1u) - greater;
    let second = greater & smaller.zxy;
    let third = greater | smaller.zxy;
    let base = (bitcast<vec3u>(vec3i(cell)) + key) * 1664525u + 1013904223u;
    let sum = simplex_corner(base, offset)
        + simplex_corner(base + second * 1664525u, offset - vec3f(second) + 0.16666667)
        + simplex_corner(base + third * 1664525u, offset - vec3f(third) + 0.33333333)
        + simplex_corner(base + 1664525u, offset - 0.5);
    // 1 / 0.00510120, the standard deviation of the sum over 4 million random places.
    return sum * 196.032;
}

/// The share of a normal distribution below `deviation` standard deviations, within 3e-4: turns noise into a mask whose
/// threshold is the covered share of the surface (Abramowitz and Stegun, 7.1.27).
fn normal_share(deviation: f32) -> f32 {
    let x = abs(deviation) * 0.70710678;
    let rise = 1.0 + x * (0.278393 + x * (0.230389 + x * (0.000972 + x * 0.078108)));
    let square = rise * rise;
    let tail = 0.5 / (square * square);
    return select(tail, 1.0 - tail, deviation > 0.0);
}
