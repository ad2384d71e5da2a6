//! A library of the faults' own.

/// A ray.
struct Ray {
    /// Where it starts.
    origin: vec3f,
    /// How far it goes.
    reach: f32,
    /// Its direction.
    direction: vec3f,
}

/// What a ray hit.
struct Hit {
    /// Whether it hit anything.
    is_hit: bool,
    /// How far that is.
    distance: f32,
}

/// A ray straight up.
fn straight(at: Surface, reach: f32) -> Ray {
    return Ray(at.position, reach, at.normal);
}
