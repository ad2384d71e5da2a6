//! Surface normal
//! The direction that the surface faces at each place, as a vector.
//!
//! It is the model's own shading normal, without the relief of the graph. Split vector makes masks of it.
//! @alias normal world object space facing direction shading

/// The normal, in model space, of unit length.
/// @vector
fn normal(at: Surface) -> vec3f {
    return at.normal;
}
