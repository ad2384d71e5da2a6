//! Relief occlusion
//! How enclosed each place is in the relief: high under rims, between bumps and in cracks.
//!
//! Like Occlusion, but for the relief that the graph creates. It measures along several paths over the surface how high
//! the relief rises within the distance.
//! @alias ambient occlusion ao dirt shadow buried micro detail
//! @use surface noise

struct Params {
    /// Length of the paths.
    /// @length @range 0.00001 1 @soft 0.001 0.1 @default 0.02
    distance: f32,
    /// Number of paths.
    /// @range 3 10 @default 8
    ways: u32,
}

/// Places measured on each path.
const STEPS: i32 = 5;

/// The share that is blocked, on a level with some twenty texels on each path.
/// @pass 1 @texel params.distance / 20
/// @input height The height that the graph creates, in working units.
/// @type mask
fn buried(at: Surface, params: Params, height: texture_2d_array<f32>) -> f32 {
    let own = surface_here(height, at).x;
    let side = normalize(cross(at.face_normal, select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(at.face_normal.x) > 0.7)));
    let across = cross(at.face_normal, side);
    // Every texel looks another way first, so that the few ways show no pattern.
    let turn = unit_random(pcg3d(bitcast<vec3u>(at.position)).x);
    var blocked = 0.0;
    for (var way = 0u; way < params.ways; way++) {
        let toward_turn = turn_of(vec3f(6.2831853 * (f32(way) + turn) / f32(params.ways)));
        let toward = side * toward_turn.cosine.x + across * toward_turn.sine.x;
        var walk = surface_standing(at);
        walk.heading = toward;
        var steepest = 0.0;
        var gone = 0.0;
        for (var step = 1; step <= STEPS; step++) {
            // Steps grow: near by the relief matters most.
            let share = f32(step) / f32(STEPS);
            let next = params.distance * share * share;
            walk = surface_walk(walk, walk.heading * (next - gone));
            gone = next;
            steepest = max(steepest, (surface_sample(height, walk).x - own) / gone);
        }
        // The sine of the horizon's angle, squared: cosine-weighted light below it.
        blocked += steepest * steepest / (1.0 + steepest * steepest);
    }
    return blocked / f32(params.ways);
}

/// Share of the light, weighted by its cosine, that the relief blocks.
fn mask(at: Surface, buried: texture_2d_array<f32>) -> f32 {
    return surface_here(buried, at).x;
}

/// The inverse: white where the relief is open.
fn ao(at: Surface, buried: texture_2d_array<f32>) -> f32 {
    return 1.0 - mask(at, buried);
}
