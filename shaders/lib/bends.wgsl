//! Bends of patterns: a noise of vectors with its derivatives, so that widths stay true where a pattern is bent.
//! @use hash

/// A place in a pattern, in the pattern's own cells, and how far it moves for a step of one working unit on the surface: along
/// the first side of the texel, and across that side.
struct PatternFrame {
    place: vec3f,
    along: vec3f,
    across: vec3f,
    // The surface's normal, of any length; without the finer bends.
    up: vec3f,
}

/// Simplex noise (Perlin, "Noise hardware", 2001) of vectors: each corner has a direction to move to besides its gradient.
/// Returns the value, about 0.6 in the mean of the squares for each axis, and its derivatives along both steps of the frame.
fn bend_noise(frame: PatternFrame, key: vec3u) -> PatternFrame {
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
    var sum = PatternFrame(vec3f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0));
    for (var corner = 0u; corner < 4u; corner++) {
        var step = select(vec3u(0u), vec3u(1u), corner == 3u);
        step = select(step, greater & smaller.zxy, corner == 1u);
        step = select(step, greater | smaller.zxy, corner == 2u);
        let away = offset - vec3f(step) + f32(corner) * 0.16666667;
        let random = pcg3d(base + step);
        // 16 bits each.
        let gradient = vec3f(random >> vec3u(16u)) / 32768.0 - 1.0;
        let toward = vec3f(random & vec3u(0xffffu)) / 32768.0 - 1.0;
        let near = max(0.5 - dot(away, away), 0.0);
        let cube = near * near * near;
        let rise = dot(gradient, away);
        let slope = cube * (near * gradient - 8.0 * rise * away);
        sum.place += toward * (cube * near * rise);
        sum.along += toward * dot(slope, frame.along);
        sum.across += toward * dot(slope, frame.across);
    }
    return PatternFrame(sum.place * 250.0, sum.along * 250.0, sum.across * 250.0, sum.up);
}
