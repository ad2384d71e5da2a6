//! Invert
//! Inverts a mask: 1 becomes 0, and 0 becomes 1.
//!
//! @alias invert not negative opposite complement

/// 1 minus the mask.
/// @input source The mask to invert. @optional @default 0
fn mask(source: f32) -> f32 {
    return 1.0 - source;
}
