//! Shapes of stamps: drops, splats, chips, leaves, bolts, scratches and prints, each in a square of its own.
//! @use core hash noise

/// Measures of a shape: its largest distance from the outline and its area, in half lengths, and its mean height. The area was
/// measured.
fn stamp_size(shape: u32) -> vec3f {
    switch shape {
        case 0u: { return vec3f(1.0, 2.97, 0.9); }
        case 1u: { return vec3f(0.2, 1.8, 0.7); }
        case 2u: { return vec3f(0.42, 0.77, 0.6); }
        case 3u: { return vec3f(0.4, 0.62, 0.7); }
        case 4u: { return vec3f(0.6, 1.6, 0.6); }
        case 5u: { return vec3f(0.36, 0.66, 0.5); }
        case 6u: { return vec3f(0.82, 2.15, 0.9); }
        case 7u: { return vec3f(1.0, 2.97, -0.25); }
        case 8u: { return vec3f(0.05, 0.092, -0.5); }
        default: { return vec3f(0.6, 0.67, 0.7); }
    }
}

/// A shape in its own square, -1 to 1, y ahead: the distance inward from its outline, its height, and how full it is there.
fn stamp_shape(q: vec2f, shape: u32, bits: u32, texel: f32) -> vec3f {
    let random = pcg3d(vec3u(bits, 0x2c1b3c6du, 0x297a2d39u));
    let away = length(q);
    switch shape {
        case 0u: { return vec3f(1.0 - away, stamp_rounded((1.0 - away) * 4.0), 1.0); }
        case 1u: { return vec3f(0.2 - abs(away - 0.8), stamp_rounded(1.0 - abs(5.0 * away - 4.0)), 1.0); }
        case 2u: { return stamp_drop(q, random); }
        case 3u: { return stamp_splat(q, random); }
        case 4u: { return stamp_chip(q, random); }
        case 5u: { return stamp_leaf(q, random); }
        case 6u: { return stamp_bolt(q); }
        case 7u: {
            let bowl = max(1.0 - away * away / 0.52, 0.0);
            return vec3f(1.0 - away, 0.3 - 0.3 * smoothstep(0.0, 0.22, abs(away - 0.78)) - bowl * sqrt(bowl), 1.0);
        }
        case 8u: { return stamp_scratch(q, random); }
        default: { return stamp_print(q, random, texel); }
    }
}

// The quarter of a circle: 0 at 0, 1 from 1 on.
fn stamp_rounded(x: f32) -> f32 {
    let t = clamp(x, 0.0, 1.0);
    return sqrt(t * (2.0 - t));
}

// The larger of two distances, rounded off where they are within `soft` of each other.
fn stamp_merged(a: f32, b: f32, soft: f32) -> f32 {
    let t = max(soft - abs(a - b), 0.0) / soft;
    return max(a, b) + 0.25 * t * t * soft;
}

// A bar with round ends of different size: the distance inward.
fn stamp_bar(q: vec2f, from_end: vec2f, to_end: vec2f, from_radius: f32, to_radius: f32) -> f32 {
    let way = to_end - from_end;
    let t = clamp(dot(q - from_end, way) / max(dot(way, way), 1e-9), 0.0, 1.0);
    return mix(from_radius, to_radius, t) - length(q - from_end - t * way);
}

// A head that runs ahead and a thin, slightly bent tail behind it.
fn stamp_drop(q: vec2f, random: vec3u) -> vec3f {
    let behind = max(0.56 - q.y, 0.0);
    let p = vec2f(q.x + 0.12 * (2.0 * unit_random(random.x) - 1.0) * behind * behind, q.y);
    let head = 0.42 - length(p - vec2f(0.0, 0.56));
    let tail = stamp_bar(p, vec2f(0.0, 0.4), vec2f(0.0, -0.95), 0.24, 0.03);
    let inward = stamp_merged(head, tail, 0.35);
    return vec3f(inward, stamp_rounded(inward / 0.42), 1.0);
}

// A blob that has burst: fingers to all sides, most with a droplet at the end or beyond it.
fn stamp_splat(q: vec2f, random: vec3u) -> vec3f {
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
        let finger = stamp_bar(q, way * 0.2, way * min(far, 0.52), 0.13, 0.4 * tip);
        inward = stamp_merged(inward, finger - 0.03 * step(0.62, far), 0.16);
        inward = stamp_merged(inward, tip - length(q - way * far), 0.05);
    }
    return vec3f(inward, stamp_rounded(inward * 4.0) * (0.6 + 0.4 * stamp_rounded(inward * 2.0)), 1.0);
}

// A flake with straight sides and a slanted face.
fn stamp_chip(q: vec2f, random: vec3u) -> vec3f {
    var inward = 1.0 - length(q);
    for (var i = 0u; i < 6u; i++) {
        let own = unit_random3(pcg3d(random + vec3u(i, 0x68e31da4u, 0xc2b2ae35u)));
        let turn = turn_of(vec3f(1.0471976 * (f32(i) + 0.8 * own.x), 0.0, 0.0));
        inward = min(inward, 0.5 + 0.4 * own.y - dot(q, vec2f(turn.cosine.x, turn.sine.x)));
    }
    return vec3f(inward, (0.7 + 0.3 * dot(unit_random3(random).xy - 0.5, q)) * clamp(inward * 5.0, 0.0, 1.0), 1.0);
}

// A blade with a toothed border, a midrib, side veins and a stem behind.
fn stamp_leaf(q: vec2f, random: vec3u) -> vec3f {
    let bent = q.x + 0.25 * (2.0 * unit_random(random.y) - 1.0) * (q.y * q.y - 0.3);
    let x = abs(bent);
    let s = clamp((q.y + 0.62) / 1.6, 0.0, 1.0);
    let teeth = 0.03 * abs(2.0 * fract(9.0 * q.y - 4.0 * x) - 1.0) * smoothstep(0.0, 0.15, s);
    let half = 0.87 * sqrt(s) * (1.0 - s) * (1.0 - 0.15 * s) + teeth * (1.0 - s);
    let stem = stamp_bar(vec2f(bent, q.y), vec2f(0.0, -0.97), vec2f(0.0, 0.4), 0.035, 0.015);
    let blade = (half - x) * 0.8 - select(0.0, 1.0, q.y < -0.62 || q.y > 0.98);
    let vein = abs(2.0 * fract(5.0 * (q.y - 0.9 * x)) - 1.0);
    let ribs = max(smoothstep(0.75, 1.0, vein) * 0.5, 1.0 - smoothstep(0.0, 0.05, x));
    let curl = 0.35 + 0.5 * min(x / max(half, 0.05), 1.0) * (0.4 + 0.6 * unit_random(random.z));
    let inward = max(blade, stem);
    return vec3f(inward, stamp_rounded(inward * 12.0) * clamp(1.3 * curl - 0.3 * ribs + 0.12, 0.0, 1.0), 1.0);
}

// A hexagonal head with a dome and beveled corners.
fn stamp_bolt(q: vec2f) -> vec3f {
    let p = abs(q);
    let inward = 0.82 - max(p.x, 0.5 * p.x + 0.8660254 * p.y);
    let bevel = clamp(1.0 - 2.2 * max(length(q) - 0.74, 0.0), 0.0, 1.0);
    let dome = 0.78 + 0.22 * sqrt(max(1.0 - dot(q, q), 0.0));
    return vec3f(inward, clamp(inward * 16.0, 0.0, 1.0) * dome * bevel, 1.0);
}

// A groove, pointed at both ends, with a slight ridge on either side.
fn stamp_scratch(q: vec2f, random: vec3u) -> vec3f {
    let bent = q.x + 0.12 * (2.0 * unit_random(random.x) - 1.0) * (q.y * q.y - 0.4);
    let half = max(0.055 * (1.0 - q.y * q.y), 1e-3);
    let square = min(bent * bent / (half * half), 1.0);
    let deep = clamp(1.2 - q.y * q.y, 0.0, 1.0);
    return vec3f(half - abs(bent), deep * (1.0 - square) * (4.0 * square - 1.0), select(1.0, 0.0, abs(q.y) > 1.0));
}

// A fingertip: an oval of loops whose ends run down, pressed unevenly.
fn stamp_print(q: vec2f, random: vec3u, texel: f32) -> vec3f {
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
    let full = clamp(ridge * clamp(press, 0.0, 1.0) * (0.75 + 0.25 * stamp_rounded(oval * 4.0)), 0.0, 1.0);
    return vec3f(oval, full, full);
}
