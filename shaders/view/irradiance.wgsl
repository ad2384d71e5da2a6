//! Irradiance of an environment.

/// Irradiance divided by pi at a normal of unit length; the rows are those of `Environment::irradiance`.
fn irradiance_at(rows: array<vec4f, 9>, n: vec3f) -> vec3f {
    let degree_1 = rows[1] * n.x + rows[2] * n.y + rows[3] * n.z;
    let mixed = rows[4] * n.x * n.y + rows[5] * n.y * n.z + rows[6] * n.z * n.x;
    let squares = rows[7] * (3.0 * n.y * n.y - 1.0) + rows[8] * (n.x * n.x - n.z * n.z);
    return max((rows[0] + degree_1 + mixed + squares).rgb, vec3f());
}
