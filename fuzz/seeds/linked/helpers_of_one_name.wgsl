//! Own
//! A node.

/// The mask.
fn mask(at: Surface) -> f32 {
    return helper(at.uv.x) + place;
}
const place = 0.5;
fn helper(x: f32) -> f32 { let main = x; return main; }
struct Block { a: f32 }
fn block(b: Block) -> f32 { return b.a; }
