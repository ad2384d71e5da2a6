//! Own
//! A node.

/// The mask.
fn mask(at: Surface) -> f32 {
    let out = load_0(at.uv.x); return out;
}
fn load_0(x: f32) -> f32 { return x; }
fn store_0(x: f32) -> f32 { return x; }
fn main_(x: f32) -> f32 { return x; }
