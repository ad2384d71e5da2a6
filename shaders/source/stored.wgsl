//! Values as the texture of a plane holds them.
//! @given IS_HALF

// The nearest values that a texture of half floats holds exactly, since drivers round to them in their own ways.
fn stored(value: vec4f) -> vec4f {
    if IS_HALF {
        let bits = bitcast<vec4u>(value);
        let odd = (bits >> vec4u(13u)) & vec4u(1u);
        return bitcast<vec4f>((bits + 0xfffu + odd) & vec4u(0xffffe000u));
    }
    return value;
}
