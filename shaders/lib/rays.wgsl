//! Rays: directions and lengths for a place, and hits.
//! @use core atlas noise

/// A ray, in working units.
struct Ray {
    /// Start.
    origin: vec3f,
    /// Length; 0 hits nothing.
    reach: f32,
    /// Its direction, unit length.
    direction: vec3f,
}

/// Hit of a ray.
struct Hit {
    /// Whether it hit anything within its reach.
    is_hit: bool,
    /// Distance; the ray's reach where nothing is hit.
    distance: f32,
    /// The triangle, where the rays find the nearest.
    triangle: u32,
}

/// A ray as it is stored, with the triangle that it starts on.
struct StoredRay {
    origin: vec3f,
    reach: f32,
    direction: vec3f,
    triangle: u32,
}

/// A hit as it is stored: the distance, below 0 where there is none, and the triangle.
struct RayHit {
    distance: f32,
    triangle: u32,
}

/// A ray of no length, which hits nothing.
fn no_ray() -> Ray {
    return Ray(vec3f(0.0), 0.0, vec3f(0.0, 1.0, 0.0));
}

/// A ray with the triangle that it starts on.
fn stored_ray(ray: Ray, triangle: u32) -> StoredRay {
    return StoredRay(ray.origin, ray.reach, ray.direction, triangle);
}

/// A ray without the triangle that it starts on.
fn ray_of(stored: StoredRay) -> Ray {
    return Ray(stored.origin, stored.reach, stored.direction);
}

/// Hit of a ray by the row stored for it or for a longer one of the same start and direction.
fn hit_of(stored: RayHit, ray: Ray) -> Hit {
    // The distance of a hit at the very end may have been rounded up.
    let is_hit = stored.distance >= 0.0 && stored.distance <= ray.reach * 1.000001;
    return Hit(is_hit, select(ray.reach, stored.distance, is_hit), stored.triangle);
}

/// Two numbers from 0 to just below 1 for ray `index` of a place, evenly spread over the rays of each place and over those of
/// places side by side, whose errors then cancel where they are averaged: Sobol's points, scrambled after Owen (Burley, "Practical
/// Hash-based Owen Scrambling", 2020) with the hash of Laine and Karras in the form of Vegdahl ("Building a Better LK Hash",
/// 2021), which texels take in the order of a curve through them (Ahmed and Wonka, "Screen-space Blue-noise Diffusion of Monte
/// Carlo Sampling Error via Hierarchical Ordering of Pixels", 2020).
fn ray_sample(at: Surface, index: u32, seed: u32) -> vec2f {
    let random = pcg3d(seed_key(seed) + u32(at.texel.z));
    let shuffled = owen_scrambled(texel_order(at, random.z) * ray_count + index, random.x);
    // The first of the two dimensions is the index with its bits turned round, the second has Pascal's triangle.
    let point = vec2u(reverseBits(shuffled), sobol_second(shuffled));
    let scrambled = vec2u(owen_scrambled(point.x, random.y), owen_scrambled(point.y, random.z));
    return vec2f(scrambled >> vec2u(8u)) * 5.9604645e-8;
}

/// Number of a texel on a curve that leaves each square of texels only once it has been to all of it, with the four quarters of
/// each in another order. It comes again after 2048 texels.
fn texel_order(at: Surface, seed: u32) -> u32 {
    let place = spread_bits(vec2u(at.texel.xy));
    return owen_scrambled((place.x | (place.y << 1u)) << 10u, seed) >> 10u;
}

/// Numbers below 2048 with a zero between every two of their bits.
fn spread_bits(numbers: vec2u) -> vec2u {
    var x = numbers & vec2u(0x7ffu);
    x = (x | (x << vec2u(8u))) & vec2u(0x00ff00ffu);
    x = (x | (x << vec2u(4u))) & vec2u(0x0f0f0f0fu);
    x = (x | (x << vec2u(2u))) & vec2u(0x33333333u);
    return (x | (x << vec2u(1u))) & vec2u(0x55555555u);
}

/// A third number for a ray, on its own.
fn ray_number(at: Surface, index: u32, seed: u32) -> f32 {
    let random = texel_random(at, seed ^ 0x68bc21ebu);
    return unit_random(owen_scrambled(reverseBits(owen_scrambled(index, random.x)), random.y));
}

/// Random numbers of a texel.
fn texel_random(at: Surface, seed: u32) -> vec3u {
    return pcg3d(vec3u(bitcast<vec2u>(at.texel.xy), bitcast<u32>(at.texel.z)) + seed_key(seed));
}

/// Owen's scrambling of the bits of a number, from the highest on.
fn owen_scrambled(bits: u32, seed: u32) -> u32 {
    return reverseBits(laine_karras(reverseBits(bits), seed));
}

fn laine_karras(bits: u32, seed: u32) -> u32 {
    var x = bits ^ (bits * 0x3d20adeau);
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Sobol's second dimension: bit for bit the sum of the direction numbers, which are rows of Pascal's triangle.
fn sobol_second(index: u32) -> u32 {
    var x = index;
    // Multiplication by Pascal's triangle over two, in five steps.
    x ^= (x & 0xaaaaaaaau) >> 1u;
    x ^= (x & 0xccccccccu) >> 2u;
    x ^= (x & 0xf0f0f0f0u) >> 4u;
    x ^= (x & 0xff00ff00u) >> 8u;
    x ^= (x & 0xffff0000u) >> 16u;
    return reverseBits(x);
}

/// A direction around `up` for a sample, weighted by the cosine of its angle from it.
fn cosine_direction(up: vec3f, sample: vec2f) -> vec3f {
    let turn = turn_of(vec3f(6.2831853 * sample.x));
    let side = side_of(up);
    let across = side * turn.cosine.x + cross(up, side) * turn.sine.x;
    return across * sqrt(sample.y) + up * sqrt(1.0 - sample.y);
}

/// A direction of unit length across another one.
fn side_of(up: vec3f) -> vec3f {
    let other = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(up.x) > 0.7);
    return normalize(cross(other, up));
}

/// A direction for a sample, as likely one way as any other.
fn even_direction(sample: vec2f) -> vec3f {
    let turn = turn_of(vec3f(6.2831853 * sample.x));
    let z = 1.0 - 2.0 * sample.y;
    return vec3f(vec2f(turn.cosine.x, turn.sine.x) * sqrt(1.0 - z * z), z);
}

/// A ray out of the surface. Directions below the triangle are turned up at it, or smooth shading would leave dark bands.
fn ray_out(at: Surface, direction: vec3f, reach: f32) -> Ray {
    let below = dot(direction, at.face_normal);
    return ray_along(at, direction - select(0.0, 2.0 * below, below < 0.0) * at.face_normal, reach);
}

/// A ray to either side. Its start is lifted off the triangle, to the side it goes to, when it is shot.
fn ray_along(at: Surface, direction: vec3f, reach: f32) -> Ray {
    return Ray(at.position, reach, direction);
}

/// A ray to any side, for `bend_by`.
fn ray_around(at: Surface, index: u32, seed: u32, reach: f32) -> Ray {
    return ray_along(at, even_direction(ray_sample(at, index, seed)), reach);
}

/// Normals of the triangle that a ray hit; the rays must find the nearest.
fn facing_hit(ray: Ray, hit: Hit) -> Facing {
    return facing_of(select(0u, hit.triangle, hit.is_hit), ray.origin + ray.direction * hit.distance);
}

/// How much of the turn between the triangle of a place and the one that a ray hit is seen: the share of it that the
/// shading turns too. On a hard edge that is all, between the facets of what is shaded as round next to nothing; 0 without
/// a hit. The rays must find the nearest.
fn shaded_share(at: Surface, ray: Ray, hit: Hit) -> f32 {
    return select(0.0, shaded_share_of(at, facing_hit(ray, hit)), hit.is_hit);
}

fn shaded_share_of(at: Surface, there: Facing) -> f32 {
    let turn = acos(clamp(dot(at.face_normal, there.face), -1.0, 1.0));
    let shaded = acos(clamp(dot(at.normal, there.shading), -1.0, 1.0));
    return clamp(shaded / max(turn, 1e-3), 0.0, 1.0);
}

/// How much a hit counts for an edge or a crease of at least `angle` (radians): nothing where the triangle that was hit turns
/// by little, as the facets of a round body do beside each other; with `is_shaded` as much of it as the shading turns too.
/// The rays must find the nearest.
fn crease_share(at: Surface, ray: Ray, hit: Hit, angle: f32, is_shaded: bool) -> f32 {
    return select(0.0, crease_share_of(at, facing_hit(ray, hit), angle, is_shaded), hit.is_hit);
}

fn crease_share_of(at: Surface, there: Facing, angle: f32, is_shaded: bool) -> f32 {
    let turn = acos(clamp(dot(at.face_normal, there.face), -1.0, 1.0));
    // Whole before the angle is reached: an edge of just that angle has to count whatever rounding does.
    let enough = smoothstep(0.6 * angle, 0.9 * angle + 1e-4, turn);
    return select(1.0, shaded_share_of(at, there), is_shaded) * enough;
}

/// The same for an edge alone: a hit from inside counts for nothing on a triangle that looks the opposite way, as the back of
/// a thin sheet does: from a turn of 172 degrees on, and for all up to 160. The rays must find the nearest.
fn edge_share(at: Surface, ray: Ray, hit: Hit, angle: f32, is_shaded: bool) -> f32 {
    // Looked up once: it takes as long as the ray itself.
    let there = facing_hit(ray, hit);
    let is_inside = dot(ray.direction, at.face_normal) < 0.0;
    let back = select(0.0, smoothstep(0.93969262, 0.99026807, -dot(at.face_normal, there.face)), is_inside);
    return select(0.0, crease_share_of(at, there, angle, is_shaded) * (1.0 - back), hit.is_hit);
}

/// Contribution of a ray to any side to the bend; the mean is the share of rays stopped inside less that of those stopped
/// outside, each of its side's half of all.
fn bend_by(at: Surface, ray: Ray, hit: Hit) -> f32 {
    let side = select(-2.0, 2.0, dot(ray.direction, at.face_normal) < 0.0);
    return select(0.0, side, hit.is_hit);
}

/// 1 where the surface bends well beyond what an edge that turns by `angle` does, 0 where it bends less. On an edge the bend
/// is the angle's share of a half turn, 0.5 for a right angle, and falls to 0 over the rays' reach.
fn bent_beyond(bend: f32, angle: f32, softness: f32) -> f32 {
    let least = angle * 0.31830989;
    return smoothstep(least, least + max(softness * (0.5 - least), 1e-3), bend);
}
