//! Sum
//! Adds more than a node may take.

/// All of them together.
/// @input a0 A part of the sum.
/// @input a1 A part of the sum.
/// @input a2 A part of the sum.
/// @input a3 A part of the sum.
/// @input a4 A part of the sum.
/// @input a5 A part of the sum.
/// @input a6 A part of the sum.
/// @input a7 A part of the sum.
/// @input a8 A part of the sum.
/// @input a9 A part of the sum.
/// @input a10 A part of the sum.
/// @input a11 A part of the sum.
/// @input a12 A part of the sum.
/// @input a13 A part of the sum.
/// @input a14 A part of the sum.
/// @input a15 A part of the sum.
/// @input a16 A part of the sum.
fn mask(
    a0: f32,
    a1: f32,
    a2: f32,
    a3: f32,
    a4: f32,
    a5: f32,
    a6: f32,
    a7: f32,
    a8: f32,
    a9: f32,
    a10: f32,
    a11: f32,
    a12: f32,
    a13: f32,
    a14: f32,
    a15: f32,
    a16: f32
) -> f32 {
    return a0 + a1 + a2 + a3 + a4 + a5 + a6 + a7 + a8 + a9 + a10 + a11 + a12 + a13 + a14 + a15 + a16;
}
