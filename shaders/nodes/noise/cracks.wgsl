//! Cracks
//! A net of cracks, as in dried mud, old paint or glaze.
//!
//! The cracks are the walls between cells in space, where the surface cuts them: they run over seams and around corners,
//! and have the given width on every side of the model. Cracks thinner than a texel become faint, not dotted; nets
//! finer than the texels fade to their mean.
//! @alias cracks craquelure mud dry paint glaze voronoi worley crackle broken
//! @use cells lines

struct Params {
    /// Mean distance between the centers of neighboring pieces.
    /// @length @range 0.0001 100 @soft 0.02 0.5 @default 0.15
    size: f32,
    /// Width of a crack, measured on the surface at half its strength.
    /// @length @range 0 10 @soft 0.001 0.02 @default 0.004
    width: f32,
    /// Softness of the borders: full width of a crack by its width at full strength. 1 is crisp.
    /// @range 1 100 @soft 1 8 @default 2
    fade: f32,
    /// Irregularity: how far the pieces are from a regular grid of blocks.
    /// @range 0 1 @default 1
    jitter: f32,
    /// Stretches the pieces along the axes of the pattern; the width of the cracks stays the same.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The cracks: 1 inside, 0 on the pieces.
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
fn mask(at: Surface, position: vec3f, params: Params) -> f32 {
    let outer = outer_of(params);
    let crack = nearest_crack(at, position, outer, params);
    let cover = line_cover(crack.distance, params.width - outer, outer, texel_across(at, crack, params));
    return mix(mean_cover(params), cover, seen(at, params));
}

/// A rounded groove for each crack: -1 at its bottom, 0 on the pieces. Connect it to the height map of an effect;
/// the effect's height is then the depth of the cracks.
fn height(at: Surface, position: vec3f, params: Params) -> f32 {
    let outer = outer_of(params);
    let crack = nearest_crack(at, position, outer, params);
    let groove = groove_height(crack.distance, outer, texel_across(at, crack, params));
    // In area, 16/15 of half the width that it ends at.
    let share = 1.0666667 * outer / max(params.width, 1e-12);
    return mix(-share * mean_cover(params), groove, seen(at, params));
}

/// A random value for each piece.
fn id(position: vec3f, params: Params) -> f32 {
    let place = cells_place(position, params.size, params.stretch, params.rotate);
    return unit_random(nearest_point(place, params.jitter, seed_key(params.seed), 0.0).id);
}

// Where a crack ends: its strength falls evenly from 1 to 0 around half its width, so that its area is the same whatever
// the fade.
fn outer_of(params: Params) -> f32 {
    return params.width * params.fade / (1.0 + params.fade);
}

fn seen(at: Surface, params: Params) -> f32 {
    // A crack by itself is right down to texels half as wide as the pieces.
    return carried(2.0 * params.size * finest_stretch(params.stretch), at.texel_size);
}

// Cracks are 2.36 long for each square of their size (measured), and overlap at random when they are wide.
fn mean_cover(params: Params) -> f32 {
    return 1.0 - exp2(-3.4 * params.width / params.size);
}

fn texel_across(at: Surface, crack: Wall, params: Params) -> vec2f {
    return line_texel(crack.across, noise_direction(at.texel_step, params.rotate), at.texel_size);
}

// The nearest crack along the surface, as far as it matters.
fn nearest_crack(at: Surface, position: vec3f, outer: f32, params: Params) -> Wall {
    let finest = finest_stretch(params.stretch);
    let place = cells_place(position, params.size, params.stretch, params.rotate);
    let normal = noise_direction(at.normal, params.rotate);
    let key = seed_key(params.seed);
    // Further than a cube away from its own borders no cell reaches.
    let reach = min((outer + at.texel_size) / params.size, finest);
    let nearest = nearest_point(place, params.jitter, key, 2.0 * reach / finest);
    var crack = Wall(reach, normal.zxy);
    // No wall is nearer than half of what any other point is further away than the nearest.
    if nearest.others - nearest.distance < 2.0 * reach / finest {
        crack = nearest_wall(place, nearest, params.jitter, key, params.stretch, normal, reach);
    }
    crack.distance *= params.size;
    return crack;
}
