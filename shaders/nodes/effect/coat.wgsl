//! Coat
//! A coat of paint or plaster that has come off in places, with thickness, lifted edges and an older coat below.
//!
//! Where Gone is above one half the coat is lost; the border breaks along straight teeth. There it lifts off and curls, most
//! at the tips of flakes and not everywhere alike, where its strength wins over its adhesion. The bare side lies in the
//! shadow of the lifted edge. The relief below shows in the coat, and the coat's own is added to it.
//! @alias peeling paint flake curl chip plaster layer wear old coat varnish enamel
//! @use blend distance heat cells

struct Params {
    /// Thickness of the coat.
    /// @length @range 0 100 @soft 0 0.02 @default 0.002
    thickness: f32,
    /// Distance from the border over which the coat has come loose.
    /// @length @range 0.00001 2 @soft 0.002 0.2 @default 0.04
    curl_width: f32,
    /// Height to which the free edge lifts.
    /// @length @range 0 1 @soft 0 0.05 @default 0.012
    curl_height: f32,
    /// How differently parts of the border are lifted: 0 lifts all of it alike.
    /// @range 0 1 @default 0.6
    uneven: f32,
    /// Darkness of the shadow that the lifted edge throws on the bare side.
    /// @range 0 1 @default 0.65
    undercut: f32,
    /// Width of the line along the broken edge of the coat.
    /// @length @range 0 2 @soft 0 0.02 @default 0.0015
    rim: f32,
    /// Color of that line: chalky for old paint, dark for dirt.
    /// @color @default #cfc9bb
    rim_color: vec3f,
    /// Share of the border at which an older coat shows between the coat and the ground.
    /// @range 0 1 @default 0.5
    old: f32,
    /// Largest width of the older coat.
    /// @length @range 0 2 @soft 0 0.1 @default 0.02
    old_width: f32,
    /// Color of the older coat.
    /// @color @default #a98a55
    old_color: vec3f,
    /// Length of the teeth of the broken border.
    /// @length @range 0 0.5 @soft 0 0.03 @default 0.006
    ragged: f32,
    /// How much of the relief below shows in the coat.
    /// @range 0 1 @default 1
    follow: f32,
    /// Number that chooses one of many borders.
    /// @seed @default 0
    seed: u32,
}

/// Share of its height by which the free end of a curl rolls down again.
const LIP_DROP: f32 = 0.45;

/// Where the coat is gone, with a broken border. That a coat breaks in pieces and lifts from its cracks on: Paquette, Poulin
/// and Drettakis, "The Simulation of Paint Cracking and Peeling", 2002; Gobron and Chiba, "Simulation of Peeling Using 3D-Surface
/// Cellular Automata", 2001. Here the pieces are cells, and the lift is a profile over the distance from the border.
/// @pass 1
/// @input gone Where the coat is lost: above one half.
fn broken(at: Surface, params: Params, gone: texture_2d_array<f32>) -> f32 {
    let size = 2.4 * params.ragged;
    let sharp = carried(size, at.texel_size);
    if sharp <= 0.0 {
        return surface_here(gone, at).x;
    }
    let place = cells_place(at.position, size, vec3f(1.0), vec3f(0.0));
    let key = seed_key(params.seed);
    let bend = vec3f(
        simplex_noise(place * 1.3, key + 1u),
        simplex_noise(place * 1.3, key + 2u),
        simplex_noise(place * 1.3, key + 3u),
    );
    // A cell goes with its middle, so the border follows the straight walls between cells.
    let cell = nearest_point(place + 0.06 * bend, 1.0, key, 0.0);
    let walk = surface_walk(surface_standing(at), (size * sharp) * (cell.offset + 0.06 * bend));
    return surface_sample(gone, walk).x;
}

/// The same without the steps of single texels.
/// @pass 2
fn bare(at: Surface, broken: texture_2d_array<f32>) -> f32 {
    let center = surface_here(broken, at).x;
    let beside = (surface_neighbor(broken, at, vec2i(1, 0)).x - center)
        + (surface_neighbor(broken, at, vec2i(-1, 0)).x - center)
        + (surface_neighbor(broken, at, vec2i(0, 1)).x - center)
        + (surface_neighbor(broken, at, vec2i(0, -1)).x - center);
    let across = (surface_neighbor(broken, at, vec2i(1, 1)).x - center)
        + (surface_neighbor(broken, at, vec2i(-1, 1)).x - center)
        + (surface_neighbor(broken, at, vec2i(1, -1)).x - center)
        + (surface_neighbor(broken, at, vec2i(-1, -1)).x - center);
    return center + 0.125 * beside + 0.0625 * across;
}

/// Where the border passes, measured on both of its sides.
/// @pass 3
fn border(at: Surface, params: Params, bare: texture_2d_array<f32>) -> f32 {
    let far = 1.1 * reach(params) + 3.0 * at.texel_size;
    // One of the two is 0, and the other one is the distance.
    return max(distance_start(bare, at, 0.5, 1.0, far), distance_start(bare, at, 0.5, -1.0, far));
}

/// How far the border is, close by.
/// @pass 4
/// @repeat ceil(3.5 * max(min(max(max(params.rim, params.old_width), max(3 * (params.thickness + params.curl_height), 0.4 * params.curl_width)) / 8, 16 * finest), finest) / finest) + 4
fn close(at: Surface, border: texture_2d_array<f32>) -> f32 {
    return distance_sweep(border, at);
}

/// The same on a level that has some ten texels for the whole way.
/// @pass 5
/// @texel min(max(max(params.rim, params.old_width), max(3 * (params.thickness + params.curl_height), 0.4 * params.curl_width)) / 8, 16 * finest)
fn seeded(at: Surface, close: texture_2d_array<f32>) -> f32 {
    return surface_here(close, at).x;
}

/// How far it is from everywhere.
/// @pass 6
/// @texel min(max(max(params.rim, params.old_width), max(3 * (params.thickness + params.curl_height), 0.4 * params.curl_width)) / 8, 16 * finest)
/// @repeat ceil(1.3 * max(max(params.rim, params.old_width), max(3 * (params.thickness + params.curl_height), 0.4 * params.curl_width)) / texel) + 8
fn far(at: Surface, seeded: texture_2d_array<f32>) -> f32 {
    return distance_sweep(seeded, at);
}

/// Width of the texels of that level.
/// @pass 7
/// @texel min(max(max(params.rim, params.old_width), max(3 * (params.thickness + params.curl_height), 0.4 * params.curl_width)) / 8, 16 * finest)
fn coarse(at: Surface, round: Round) -> f32 {
    return round.texel;
}

/// How heat flows along u.
/// @pass 8 @vector @texel params.curl_width / 6
fn across(at: Surface, round: Round) -> vec3f {
    return heat_across(at, round, false);
}

/// How heat flows along v.
/// @pass 9 @vector @texel params.curl_width / 6
fn along(at: Surface, round: Round) -> vec3f {
    return heat_along(at, round, false);
}

/// What pulls at the coat.
/// @pass 10 @vector @texel params.curl_width / 6
fn start(at: Surface, bare: texture_2d_array<f32>) -> vec3f {
    return heat_start(smoothstep(0.4, 0.6, surface_here(bare, at).x));
}

/// The share of lost coat around each place. A tip of the coat has more around it than a straight border, and a notch less.
/// @pass 11 @vector @texel params.curl_width / 6
/// @repeat max(2.55 * params.curl_width / texel, 10.2)
fn loss(
    at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, across: texture_2d_array<f32>,
    along: texture_2d_array<f32>,
) -> vec3f {
    return heat_stage(start, across, along, at, round, 0.5 * params.curl_width);
}

/// Distance to the border, below 0 where the coat is gone; share of the full curl; how much the edge nearby is lifted.
/// @pass 12 @vector
/// @input lift Where the edges lift more. @optional @default 1
fn shape(
    at: Surface, round: Round, params: Params, lift: f32,
    bare: texture_2d_array<f32>, close: texture_2d_array<f32>, far: texture_2d_array<f32>, coarse: texture_2d_array<f32>,
    loss: texture_2d_array<f32>,
) -> vec3f {
    let away = distance_known(close, far, coarse, at, clamp(reach(params) / 8.0, round.finest, 16.0 * round.finest));
    let is_gone = surface_here(bare, at).x >= 0.5;
    let signed_away = select(away, -away, is_gone);
    let place = cells_place(at.position, 3.0 * params.curl_width, vec3f(1.0), vec3f(0.0));
    let noise = simplex_noise(place, seed_key(params.seed + 11u)) + 0.5 * simplex_noise(2.7 * place, seed_key(params.seed + 12u));
    let loose = smoothstep(0.1, 0.9, normal_share(0.89 * noise));
    let lifted = clamp(lift, 0.0, 1.0) * mix(1.0, loose, params.uneven);
    let state = surface_here(loss, at);
    // One half on a straight border.
    let pull = clamp(2.0 * select(0.0, state.x, state.z > 0.5), 0.0, 1.2);
    // The free end rolls over: highest a little way from the border.
    let lip = 1.0 - clamp(away / (0.22 * params.curl_width), 0.0, 1.0);
    let curl = pull * sqrt(pull) * (1.0 - LIP_DROP * lip * lip);
    return vec3f(signed_away, select(curl * lifted, 0.0, is_gone), lifted);
}

// The largest distance that is asked for; the formulas of the passes know it, too.
fn reach(params: Params) -> f32 {
    let relief = max(3.0 * (params.thickness + params.curl_height), 0.4 * params.curl_width);
    return max(max(params.rim, params.old_width), relief);
}

// The share of the place that is on the near side of a border `away` in front of it.
fn covered(away: f32, at: Surface) -> f32 {
    return clamp(away / at.texel_size + 0.5, 0.0, 1.0);
}

/// Where the coat still is.
fn mask(at: Surface, shape: texture_2d_array<f32>) -> f32 {
    return covered(surface_here(shape, at).x, at);
}

// How far inside of the older coat; below 0 outside of it.
fn inside_old(at: Surface, away: f32, params: Params) -> f32 {
    let place = cells_place(at.position, max(1.5 * params.old_width, 1e-5), vec3f(1.0), vec3f(0.0));
    let key = seed_key(params.seed + 21u);
    let noise = 0.9 * simplex_noise(place, key)
        + 0.4 * simplex_noise(place * 4.0, key + 1u) * carried(0.375 * params.old_width, at.texel_size);
    let width = params.old_width * clamp(2.2 * params.old - 1.2 * normal_share(noise), 0.0, 1.0);
    return select(-1.0, width + away, width > 0.0);
}

/// Where the older coat shows.
fn old(at: Surface, params: Params, shape: texture_2d_array<f32>) -> f32 {
    let away = surface_here(shape, at).x;
    return covered(inside_old(at, away, params), at) * (1.0 - covered(away, at));
}

/// The line along the broken edge of the coat.
fn rim(at: Surface, params: Params, shape: texture_2d_array<f32>) -> f32 {
    let away = surface_here(shape, at).x;
    let noise = simplex_noise(at.position / max(3.0 * params.rim, 1e-6), seed_key(params.seed + 31u));
    let width = params.rim * clamp(0.55 + 0.4 * noise, 0.05, 1.0);
    let share = clamp((width - away) / max(0.4 * width, at.texel_size) + 0.5, 0.0, 1.0);
    // A line thinner than a texel is weaker instead.
    return covered(away, at) * share * min(width / at.texel_size, 1.0);
}

/// How far the coat has come off the ground: 1 is the whole height of the curl.
fn lift(at: Surface, shape: texture_2d_array<f32>) -> f32 {
    return surface_here(shape, at).y;
}

/// The shadow of the lifted edge on the bare side.
fn shadow(at: Surface, params: Params, shape: texture_2d_array<f32>) -> f32 {
    let found = surface_here(shape, at).xyz;
    let away = max(-found.x, 0.0);
    let edge = params.thickness + (1.0 - LIP_DROP) * params.curl_height * found.z;
    // The light that a long wall of this height takes away; under a loose edge a little more.
    let wide = edge * (0.8 + 0.4 * found.z);
    let taken = 1.0 - away * inverseSqrt(away * away + wide * wide + 1e-20);
    let end = 1.0 - smoothstep(0.6, 1.0, away / reach(params));
    return params.undercut * taken * end * min(2.0 * wide / at.texel_size, 1.0) * (1.0 - covered(found.x, at));
}

/// Height of the coat and of the older coat over the ground.
fn height(at: Surface, params: Params, shape: texture_2d_array<f32>) -> f32 {
    let found = surface_here(shape, at).xyz;
    let whole = params.thickness + params.curl_height * found.y;
    let step = 0.5 * params.thickness * covered(inside_old(at, found.x, params), at);
    return mix(step, whole, covered(found.x, at));
}

/// The ground with the coat on it.
/// @input below The material under the coat. @optional
/// @input coat The coat. Its height is added to that of what it lies on. @optional
fn material(at: Surface, params: Params, below: Material, coat: Material, shape: texture_2d_array<f32>) -> Material {
    let dark = shadow(at, params, shape);
    let ring = old(at, params, shape);
    var ground = below;
    ground.base_color = mix(ground.base_color, params.old_color, ring);
    ground.roughness = mix(ground.roughness, clamp(coat.roughness + 0.15, 0.0, 1.0), ring);
    ground.metallic = mix(ground.metallic, 0.0, ring);
    ground.occlusion *= 1.0 - dark;
    // The occlusion of a material dims light from all around only. What hides below an edge is dark in any light.
    ground.base_color *= 1.0 - 0.55 * dark;
    var paint = coat;
    let line = rim(at, params, shape);
    paint.base_color = mix(paint.base_color, params.rim_color, line);
    paint.roughness = mix(paint.roughness, max(paint.roughness, 0.85), line);
    paint.metallic = mix(paint.metallic, 0.0, line);
    paint.height += params.follow * below.height;
    paint.slope += params.follow * below.slope;
    var result = blend_material(ground, paint, mask(at, shape));
    result.height += height(at, params, shape);
    return result;
}
