//! Unit vectors in four bytes.

/// Encodes a unit vector as a point on an octahedron that is unfolded to a square (Meyer and others, "On floating-point
/// normal vectors", 2010).
pub(crate) fn octahedral([x, y, z]: [f32; 3]) -> [i16; 2] {
    let sum = x.abs() + y.abs() + z.abs();
    if sum.is_nan() || sum <= 0.0 {
        return [0, 0];
    }
    let [mut u, mut v] = [x / sum, y / sum];
    if z < 0.0 {
        [u, v] = [
            (1.0 - v.abs()) * 1.0_f32.copysign(u),
            (1.0 - u.abs()) * 1.0_f32.copysign(v),
        ];
    }
    [u, v].map(|value| (value * f32::from(i16::MAX)).round() as i16)
}

/// Returns the unit vector that [`octahedral`] encoded.
pub(crate) fn from_octahedral(packed: [i16; 2]) -> [f32; 3] {
    let [u, v] = packed.map(|value| f32::from(value) / f32::from(i16::MAX));
    let z = 1.0 - u.abs() - v.abs();
    let (x, y) = if z < 0.0 {
        (
            (1.0 - v.abs()) * 1.0_f32.copysign(u),
            (1.0 - u.abs()) * 1.0_f32.copysign(v),
        )
    } else {
        (u, v)
    };
    glam::Vec3::new(x, y, z).normalize_or_zero().to_array()
}
