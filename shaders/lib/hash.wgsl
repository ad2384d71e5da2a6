//! Random numbers without state: integer hashes, so that every adapter draws the same ones.

/// Three random numbers for three (pcg3d of Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020).
fn pcg3d(key: vec3u) -> vec3u {
    var v = key * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3u(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

/// Three numbers to add to a cell before it is hashed: every seed moves the cells to another part of the hash.
fn seed_key(seed: u32) -> vec3u {
    return vec3u(seed, seed * 747796405u + 2891336453u, seed * 277803737u + 1831565813u);
}

/// A number from 0 to just below 1 from 32 random bits.
fn unit_random(bits: u32) -> f32 {
    return f32(bits >> 8u) * 5.9604645e-8;
}

/// Three numbers from 0 to just below 1 from 3 × 32 random bits.
fn unit_random3(bits: vec3u) -> vec3f {
    return vec3f(bits >> vec3u(8u)) * 5.9604645e-8;
}

/// A random number for one (pcg of Jarzynski and Olano).
fn pcg(value: u32) -> u32 {
    let state = value * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/// The random value of a piece of the model, which Parts gives by piece.
fn piece_random(piece: u32) -> f32 {
    return unit_random(pcg(pcg(piece) ^ 4u));
}
