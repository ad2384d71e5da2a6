//! Streak
//! Lets a mask run down the surface: stains below screws, rain marks, rust from edges.
//!
//! High values run far, low ones a short way. Nothing runs where the surface is level.
//! @alias run drip leak stain flow smear trail
//! @use surface

struct Params {
    /// Direction in which the mask runs, in model space.
    /// @default 0 -1 0
    toward: vec3f,
    /// Distance that the highest values run.
    /// @length @range 0.0001 4 @soft 0.01 1 @default 0.2
    length: f32,
    /// Share of the way on which a streak fades: 0 ends abruptly, 1 fades from the start.
    /// @range 0 1 @default 0.5
    fade: f32,
}

/// The way back up, as long as the surface is steep.
/// @pass 1 @vector @texel params.length / 100
/// @input direction Direction for each place, in place of Toward. @optional @vector @default 0 0 0
fn upward(at: Surface, params: Params, direction: vec3f) -> vec3f {
    let down = select(params.toward, direction, dot(direction, direction) > 1e-12);
    let along = down * inverseSqrt(max(dot(down, down), 1e-12));
    return at.normal * dot(at.normal, along) - along;
}

/// What runs, how far it would still come (1 is the whole length), and its own share of the length.
/// @pass 2 @vector @texel params.length / 100
/// @input source The mask that runs down.
/// @type mask
/// @input length_map Multiplies the length of the streaks that begin at each place. @optional @default 1
fn start(at: Surface, source: texture_2d_array<f32>, length_map: f32) -> vec3f {
    let value = surface_here(source, at).x;
    // What does not run stays where it is.
    let share = clamp(length_map, 1e-3, 1.0);
    return vec3f(value, value * share, share);
}

/// Takes what comes from further up, twice as far each time; on a level with some hundred texels on the whole way.
/// @pass 3 @vector @texel params.length / 100 @repeat log2(params.length / texel + 2)
fn run(at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, upward: texture_2d_array<f32>) -> vec3f {
    let own = surface_here(start, at).xyz;
    // All ways together are the whole length.
    let share = f32(1u << min(round.index, 30u)) / (f32(1u << min(round.count, 31u)) - 1.0);
    let way = params.length * share;
    let parts = clamp(i32(way / round.texel / 4.0) + 1, 1, 8);
    var walk = surface_standing(at);
    for (var part = 0; part < parts && part < 8; part++) {
        walk = surface_walk(walk, surface_sample(upward, walk).xyz * (way / f32(parts)));
    }
    let above = surface_sample(start, walk).xyz;
    let arrives = above.y - share;
    // What stands still on level ground does not feed itself.
    return select(own, vec3f(above.x, arrives, above.z), arrives > own.y);
}

/// What has come to a place, as one number, which is brought to the finest level.
/// @pass 4 @texel params.length / 100
fn ran(at: Surface, params: Params, run: texture_2d_array<f32>) -> f32 {
    let state = surface_here(run, at);
    let left = 1.0 - (state.x - state.y / max(state.z, 1e-3));
    return state.x * clamp(left / max(params.fade, 1e-3), 0.0, 1.0);
}

/// The streaks, together with the mask they start from.
fn mask(at: Surface, ran: texture_2d_array<f32>, source: texture_2d_array<f32>) -> f32 {
    // The mask itself is as fine as the maps.
    return max(surface_here(source, at).x, surface_here(ran, at).x);
}
