//! Invert
//! Turns a mask over: what was selected is not, and what was not is.
//!
//! @alias invert not negative opposite complement

/// 1 minus the mask.
/// @input source The mask to turn over. @optional @default 0
fn mask(source: f32) -> f32 {
    return 1.0 - source;
}
