//! Layout of a panorama.

/// The place of a direction of any length in a panorama, 0 to 1 from the left and from the top; latitude by longitude as
/// OpenEXR has it: the middle looks to +Z, a quarter of the way from the left to +X.
fn panorama_place(direction: vec3f) -> vec2f {
    let turn = 6.28318530718;
    let latitude = atan2(direction.y, length(direction.xz));
    return vec2f(0.5 - atan2(direction.x, direction.z) / turn, 0.5 - 2.0 * latitude / turn);
}
