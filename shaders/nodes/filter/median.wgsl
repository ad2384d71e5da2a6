//! Median
//! Removes specks and rounds corners, but keeps borders sharp.
//!
//! Repeats the median of a texel and its eight neighbors: bent borders become straighter, shapes smaller than the radius
//! vanish, and straight borders stay.
//! @alias despeckle denoise clean smooth
//! @use surface

struct Params {
    /// Specks of about this radius vanish.
    /// @length @range 0 0.2 @soft 0 0.02 @default 0.005
    radius: f32,
}

/// The mask to filter.
/// @pass 1 @texel params.radius / 8
/// @input source The mask to filter.
fn start(at: Surface, source: texture_2d_array<f32>) -> f32 {
    return surface_here(source, at).x;
}

/// One median.
/// @pass 2 @texel params.radius / 8
/// @repeat ceil(params.radius * params.radius / texel / texel)
fn cleaned(at: Surface, round: Round, params: Params, start: texture_2d_array<f32>) -> f32 {
    // Where lengths are shares of each piece, the largest one is filtered more often than others.
    let own = params.radius / round.texel;
    if f32(round.index) >= max(own * own, 0.5) {
        return surface_here(start, at).x;
    }
    // Sorting the three of each column, then the middle one of the largest low, the middle middle and the smallest high.
    let left = sorted(
        surface_neighbor(start, at, vec2i(-1, -1)).x,
        surface_neighbor(start, at, vec2i(-1, 0)).x,
        surface_neighbor(start, at, vec2i(-1, 1)).x,
    );
    let middle = sorted(
        surface_neighbor(start, at, vec2i(0, -1)).x,
        surface_here(start, at).x,
        surface_neighbor(start, at, vec2i(0, 1)).x,
    );
    let right = sorted(
        surface_neighbor(start, at, vec2i(1, -1)).x,
        surface_neighbor(start, at, vec2i(1, 0)).x,
        surface_neighbor(start, at, vec2i(1, 1)).x,
    );
    let low = max(max(left.x, middle.x), right.x);
    let high = min(min(left.z, middle.z), right.z);
    let between = sorted(left.y, middle.y, right.y).y;
    return sorted(low, between, high).y;
}

fn sorted(a: f32, b: f32, c: f32) -> vec3f {
    let low = min(min(a, b), c);
    let high = max(max(a, b), c);
    return vec3f(low, max(min(a, b), min(max(a, b), c)), high);
}

/// The filtered mask.
fn mask(at: Surface, params: Params, cleaned: texture_2d_array<f32>, source: texture_2d_array<f32>) -> f32 {
    return select(surface_here(source, at).x, surface_here(cleaned, at).x, params.radius > 0.0);
}
