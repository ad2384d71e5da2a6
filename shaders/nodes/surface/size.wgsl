//! Size
//! How large the piece is that a place belongs to: bolts and rods dark, beams and walls bright.
//!
//! The size of a piece, such as a plank, a bolt or a whole statue, is the side of a cube with the volume of its box. Place is
//! measured in it: noises that read there are as fine on a bolt as they are on a beam. Small and Large are shares of the
//! model, also in graphs whose other lengths are shares of each piece.
//! @alias size scale piece part bolt thickness small large relative

struct Params {
    /// Size of pieces that are dark.
    /// @length @absolute @range 0 100 @soft 0 0.5 @default 0.02
    small: f32,
    /// Size of pieces that are bright.
    /// @length @absolute @range 0 100 @soft 0 1 @default 0.4
    large: f32,
}

/// How large the piece is: 0 at Small, 1 at Large, by the logarithm between.
fn mask(at: Surface, params: Params) -> f32 {
    let small = log2(max(params.small, 1e-6));
    let large = log2(max(params.large, 1e-6));
    let size = log2(max(at.piece_size, 1e-6));
    let range = large - small;
    // Equal ends cut between smaller and larger pieces.
    let share = (size - small) / select(range, 1e-6, abs(range) < 1e-6);
    return clamp(share, 0.0, 1.0);
}

/// The place in sizes of the piece, for the position of noises.
/// @vector
fn place(at: Surface) -> vec3f {
    return at.position / max(at.piece_size, 1e-6);
}
