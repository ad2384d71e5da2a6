//! Own
//! A node.

/// The mask.
fn mask(at: Surface) -> f32 {
    return f32(a(3));
}
fn a(x: i32) -> i32 { return b(x); }
fn b(x: i32) -> i32 { return a(x); }
