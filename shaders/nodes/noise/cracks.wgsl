//! Cracks
//! A net of cracks, as in dried mud, glaze, plaster or old paint.
//!
//! The cracks are bent walls between cells in space, where the surface cuts them: they run over seams and around corners. Finer
//! cracks divide the pieces and meet the wider ones at about right angles. Widths are measured on the surface, also where
//! Bend, Stretch or a moved position distort the pattern. Cracks thinner than a texel become faint, not dotted; nets finer
//! than the texels fade to their mean.
//! @alias cracks craquelure crazing mud dry paint glaze plaster alligator voronoi worley crackle broken fissure
//! @use bends cells lines surface

struct Params {
    /// Mean distance between the centers of neighboring pieces of the first level.
    /// @length @range 0.0001 100 @soft 0.02 0.5 @default 0.15
    size: f32,
    /// Width of the widest cracks, measured on the surface at half their strength.
    /// @length @range 0 10 @soft 0.001 0.02 @default 0.004
    width: f32,
    /// Softness of the borders: full width of a crack by its width at full strength. 1 is crisp.
    /// @range 1 100 @soft 1 8 @default 2
    fade: f32,
    /// Irregularity: how far the pieces are from a regular grid of blocks.
    /// @range 0 1 @default 1
    jitter: f32,
    /// Crookedness of the cracks, from wide curves to fine jags.
    /// @range 0 1 @default 0.5
    bend: f32,
    /// Levels of cracks: each further one divides the pieces into smaller ones by thinner cracks.
    /// @range 1 3 @default 2
    levels: u32,
    /// Share of the cracks that are missing. They end in the middle of a piece, so that pieces hang together.
    /// @range 0 1 @default 0.15
    breaks: f32,
    /// Variation of the width, between the cracks and along each of them.
    /// @range 0 1 @default 0.5
    uneven: f32,
    /// Height of raised borders beside the cracks, as a share of their depth. Affects Height only.
    /// @range 0 1 @default 0
    lip: f32,
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

/// The way from each place to where the noise is read there. Its differences from texel to texel tell how much a
/// connected position stretches the pattern.
/// @pass 1 @vector @with position
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
fn moved(at: Surface, position: vec3f) -> vec3f {
    return position - at.position;
}

/// The free share, the height and the id of the same cracks, in that order.
/// @pass 2 @vector
/// @input strength Factor on the width of the cracks; there are none where it is 0. @optional @default 1
fn net(at: Surface, moved: texture_2d_array<f32>, strength: f32, params: Params) -> vec3f {
    let outer = outer_of(params);
    let reach = max(outer + at.texel_size, select(0.0, LIP_REACH * params.size, params.lip > 0.0));
    let found = net_at(at, moved, strength, reach, params);
    return vec3f(found.clear, found.low + params.lip * found.lip * (1.0 + found.low), unit_random(found.id));
}

/// The cracks: 1 inside, 0 on the pieces.
fn mask(at: Surface, net: texture_2d_array<f32>) -> f32 {
    return 1.0 - surface_here(net, at).x;
}

/// A rounded groove for each crack: -1 at the bottom of the widest, 0 on the pieces, above 0 on raised borders. Connect it
/// to the height map of an effect; the effect's height is then the depth of the cracks.
fn height(at: Surface, net: texture_2d_array<f32>) -> f32 {
    return surface_here(net, at).y;
}

/// Distance to the middle of the nearest crack, in working units, up to half of Size.
fn away(at: Surface, moved: texture_2d_array<f32>, strength: f32, params: Params) -> f32 {
    return min(net_at(at, moved, strength, 0.5 * params.size, params).away, 0.5 * params.size);
}

/// A random value for each piece.
fn id(at: Surface, net: texture_2d_array<f32>) -> f32 {
    return surface_here(net, at).z;
}

/// A slight tilt of each piece: 0.5 in its middle, more on one side and less on the other. Add it to the height.
fn tilt(at: Surface, moved: texture_2d_array<f32>, params: Params) -> f32 {
    return clamp(0.5 + net_at(at, moved, 1.0, 0.0, params).tilt, 0.0, 1.0);
}

// Size of the pieces of a level by those of the level before, and width of its cracks likewise.
const FINER: f32 = 0.43;
const THINNER: f32 = 0.6;
// How far from a crack the finer ones turn toward it, in pieces of its own level.
const TURN_REACH: f32 = 0.3;
// How far raised borders reach, likewise.
const LIP_REACH: f32 = 0.13;
// Octaves of the bends, and the longest wave, in pieces.
const BENDS: u32 = 5u;
const LONGEST_BEND: f32 = 1.6;

// What one place has of all levels.
struct Net {
    // The share that all cracks leave free.
    clear: f32,
    // Depth of the grooves (below 0), and height of the borders beside them.
    low: f32,
    lip: f32,
    // Distance to the nearest crack, working units.
    away: f32,
    id: u32,
    tilt: f32,
}

// One level of the net.
struct Level {
    key: vec3u,
    // Width by that of the first level.
    width: f32,
    // Working units in a cube.
    size: f32,
    // How far the walls are looked for: working units.
    reach: f32,
    // Evenly spread random numbers, slowly and quickly changing along the cracks.
    slow: f32,
    quick: f32,
    strength: f32,
    is_last: bool,
    // The steps without the bends, and their mean length: cubes for a working unit along the surface.
    straight: PatternFrame,
    scale: f32,
}

// Where a crack ends: its strength falls evenly from 1 to 0 around half its width, so that its area is the same whatever
// the fade.
fn outer_of(params: Params) -> f32 {
    return params.width * params.fade / (1.0 + params.fade);
}

// The mean of one level. Straight cracks are 2.36 long for each square of their size (measured), those of the next level 1.08
// times as much in area (measured), and cracks overlap at random when they are wide.
fn mean_cover(index: u32, strength: f32, params: Params) -> f32 {
    let kept = (1.0 - params.breaks) * (1.0 - 0.43 * params.uneven) * (1.0 + 0.3 * params.bend);
    let more = select(select(1.17, 1.08, index == 1u), 1.0, index == 0u);
    return 1.0 - exp2(-3.4 * kept * more * strength * params.width / params.size);
}

// All levels of the net. Cracks further than `reach` are left out.
fn net_at(at: Surface, moved: texture_2d_array<f32>, strength: f32, reach: f32, params: Params) -> Net {
    let straight = frame_at(at, moved, params);
    let scale = sqrt(0.5 * (dot(straight.along, straight.along) + dot(straight.across, straight.across)));
    var frame = bent_frame(straight, at, params);
    var net = Net(1.0, 0.0, 0.0, params.size, params.seed, 0.0);
    var level = Level(seed_key(params.seed), 1.0, params.size, reach, 0.5, 0.5, max(strength, 0.0), false, straight, scale);
    let count = clamp(params.levels, 1u, 3u);
    // The mean of a groove is, in area, 16/15 of half the width that it ends at; narrow ones are shallower.
    let hollow = 0.95 * outer_of(params) / max(params.width, 1e-12);
    for (var index = 0u; index < count; index++) {
        level.is_last = index + 1u == count;
        let before = net;
        net = Net(1.0, 0.0, 0.0, net.away, net.id, net.tilt);
        // A crack by itself is right down to texels half as wide as the pieces.
        let seen = carried(2.0 * level.size * finest_stretch(params.stretch), at.texel_size);
        if seen > 0.0 {
            // Where there are no cracks, only the pieces are needed.
            if params.breaks > 0.0 && level.strength > 0.0 {
                level.slow = normal_share(simplex_noise(frame.place * 0.8, level.key + vec3u(11u)));
            }
            if params.uneven > 0.0 && level.strength > 0.0 {
                level.quick = normal_share(simplex_noise(frame.place * 3.1, level.key + vec3u(23u)));
            }
            frame = add_level(&net, frame, level, at, params);
        }
        let mean = mean_cover(index, level.strength, params);
        net.clear = before.clear * mix(1.0 - mean, net.clear, seen);
        net.low = mix(before.low - hollow * mean * sqrt(level.width), min(before.low, net.low), seen);
        net.lip = max(before.lip, net.lip * seen);
        net.away = mix(min(before.away, 0.2 * level.size), net.away, seen);
        net.tilt = mix(before.tilt, net.tilt, seen);
        // The next level: turned, so that the cubes of two levels never line up, and moved.
        frame = finer_frame(frame);
        level.straight = finer_frame(level.straight);
        level.key += vec3u(0x9e3779b9u, 0x85ebca6bu, 0xc2b2ae35u);
        level.width *= THINNER;
        level.size *= FINER;
        level.scale /= FINER;
    }
    return net;
}

fn finer_frame(frame: PatternFrame) -> PatternFrame {
    let place = finer(frame.place) + vec3f(0.37, 0.61, 0.83);
    return PatternFrame(place, finer(frame.along), finer(frame.across), finer(frame.up));
}

fn finer(v: vec3f) -> vec3f {
    let turned = vec3f(
        0.8 * v.y + 0.6 * v.z,
        0.36 * v.y - 0.8 * v.x - 0.48 * v.z,
        0.64 * v.z - 0.6 * v.x - 0.48 * v.y,
    );
    return turned / FINER;
}

// The place in the pattern before it is bent.
fn frame_at(at: Surface, moved: texture_2d_array<f32>, params: Params) -> PatternFrame {
    let size = max(length(at.texel_step), 1e-12);
    let first = at.texel_step / size;
    let second = cross(at.face_normal, first);
    let along_u = change_of(moved, at, vec2i(1, 0));
    let along_v = change_of(moved, at, vec2i(0, 1));
    let rise = vec2f(dot(at.texel_rise, first), dot(at.texel_rise, second));
    let upright = select(0.0, 1.0 / rise.y, abs(rise.y) > 1e-3 * size);
    let along = along_u / size;
    let across = (along_v - rise.x * along) * upright;
    let scale = params.stretch * params.size;
    let place = cells_place(at.position + surface_here(moved, at).xyz, params.size, params.stretch, params.rotate);
    let first_step = noise_direction(first + along, params.rotate) / scale;
    let second_step = noise_direction(second + across, params.rotate) / scale;
    return PatternFrame(place, first_step, second_step, cross(first_step, second_step));
}

// Change of the stored vectors from a texel to the next. Where they jump, or where the surface ends, that of one side.
fn change_of(moved: texture_2d_array<f32>, at: Surface, step: vec2i) -> vec3f {
    let here = surface_here(moved, at).xyz;
    let ahead = surface_neighbor(moved, at, step).xyz - here;
    let behind = here - surface_neighbor(moved, at, -step).xyz;
    let sizes = vec2f(dot(ahead, ahead), dot(behind, behind));
    let one_side = select(behind, ahead, sizes.x < sizes.y);
    return select(one_side, 0.5 * (ahead + behind), max(sizes.x, sizes.y) < 16.0 * min(sizes.x, sizes.y));
}

// The frame after the bends. Each octave moves the place by a noise of known derivatives, so that the steps stay true (chain
// rule). The amounts fall with the wavelength, as on broken surfaces, which look alike at every scale (Bouchaud, Lapasset
// and Planès, "Fractal dimension of fractured surfaces", 1990).
fn bent_frame(frame: PatternFrame, at: Surface, params: Params) -> PatternFrame {
    var bent = frame;
    var wave = LONGEST_BEND;
    var key = seed_key(params.seed) + vec3u(0x51ed270bu, 0x2545f491u, 0x6c8e9cf5u);
    let finest = params.size * finest_stretch(params.stretch);
    for (var octave = 0u; octave < BENDS; octave++) {
        let amount = 0.17 * params.bend * carried(wave * finest, at.texel_size);
        if amount <= 0.0 {
            break;
        }
        let scaled = PatternFrame(frame.place / wave + 0.29 * f32(octave), frame.along / wave, frame.across / wave, vec3f(0.0));
        let move_by = bend_noise(scaled, key);
        bent.place += amount * wave * move_by.place;
        bent.along += amount * wave * move_by.along;
        bent.across += amount * wave * move_by.across;
        bent.up = select(bent.up, cross(bent.along, bent.across), octave < 3u);
        wave *= 0.47;
        key += vec3u(0x9e3779b9u, 0x85ebca6bu, 0xc2b2ae35u);
    }
    return bent;
}

// Adds the cracks of one level to the net. Returns the frame for the next level, in the cubes of this one: near a crack the
// place moves away from it and stands still across it. What is read there runs straight up to the crack, and is not the same
// on both sides of it.
fn add_level(net: ptr<function, Net>, frame: PatternFrame, level: Level, at: Surface, params: Params) -> PatternFrame {
    // Walls almost along the surface count as if they stood at 12 degrees, so a cube reaches at most so far.
    let drawn = min(level.reach * level.scale * 1.5, 1.0);
    let reach = max(drawn, select(TURN_REACH, 0.0, level.is_last));
    let nearest = nearest_point(frame.place, params.jitter, level.key, 2.0 * reach);
    let random = unit_random3(pcg3d(vec3u(nearest.id, 0x7feb352du, 0x846ca68bu)));
    var turned = frame;
    var whole = 1.0;
    if level.strength > 0.0 && nearest.others - nearest.distance < 2.0 * reach {
        let rows = rows_around(frame.place, level.key);
        let limit = nearest.distance + 2.0 * reach;
        for (var index = 0; index < 9; index++) {
            if rows_done(rows, index, limit * limit) {
                break;
            }
            let points = point_row(rows, index, params.jitter, level.key);
            let x = points.x - nearest.offset.x;
            let y = points.y - nearest.offset.y;
            let z = points.z - nearest.offset.z;
            let squares = x * x + y * y + z * z;
            // Half of the way between two points, along it: twice the distance to the wall by the length of that way.
            let middles = x * (points.x + nearest.offset.x) + y * (points.y + nearest.offset.y)
                + z * (points.z + nearest.offset.z);
            let near = (middles * middles < 4.0 * reach * reach * squares) & (squares > vec3f(1e-9));
            if !any(near) {
                continue;
            }
            let numbers = number_row(rows, row_step(rows, index), level.key).x;
            for (var column = 0; column < 3; column++) {
                let point = vec3f(points.x[column], points.y[column], points.z[column]);
                let between = point - nearest.offset;
                let square = dot(between, between);
                let side = between * inverseSqrt(max(square, 1e-12));
                let distance = max(0.5 * dot(point + nearest.offset, side), 0.0);
                if square > 1e-9 && distance < reach {
                    let present = add_wall(net, frame, level, side, distance, nearest.id + numbers[column], at, params);
                    let left = max(TURN_REACH - distance, 0.0);
                    turned.place -= side * (present * left * left * (0.5 / TURN_REACH));
                    let stop = 0.9 * present * left / TURN_REACH;
                    turned.along -= side * (stop * dot(side, frame.along));
                    turned.across -= side * (stop * dot(side, frame.across));
                    turned.up += side * (stop / (1.0 - stop) * dot(side, frame.up));
                    whole = min(whole, max(present, distance / TURN_REACH));
                }
            }
        }
    }
    (*net).id = pcg3d(vec3u((*net).id, nearest.id, 0x5eed0007u)).x;
    (*net).tilt -= 0.7 * whole * level.width * dot(random - 0.5, nearest.offset);
    return turned;
}

// Adds the crack at one wall: `side` points over it, `distance` is in cubes, `pair` a number that both sides share. Returns how
// much of the crack there is: 0 where it is missing.
fn add_wall(
    net: ptr<function, Net>, frame: PatternFrame, level: Level, side: vec3f, distance: f32, pair: u32, at: Surface,
    params: Params,
) -> f32 {
    let random = unit_random3(pcg3d(vec3u(pair, 0x68e31da4u, level.key.x)));
    // Where a wall lies along the surface, its bends would cut out islands.
    let flat = dot(side, frame.up) * inverseSqrt(max(dot(frame.up, frame.up), 1e-30));
    let upright = smoothstep(0.06, 0.06 + 0.8 * params.bend, 1.0 - flat * flat);
    let present = upright * present_at(0.6 * random.x + 0.4 * level.slow, params.breaks);
    let quick = mix(random.y, level.quick, 0.6);
    let share = present * level.strength * level.width * mix(1.0, 0.2 + 0.8 * quick, params.uneven);
    // How fast the distance grows along the surface. Further away, the slope here with its fine bends is not that of the
    // whole way: there it is the slope without bends, turned as the surface is.
    let slope = vec2f(dot(side, frame.along), dot(side, frame.across));
    let straight = level.straight;
    let unbent = vec2f(dot(side, straight.along), dot(side, straight.across));
    let unbent_flat = dot(side, straight.up) * inverseSqrt(max(dot(straight.up, straight.up), 1e-30));
    let unbent_turn = 1.0 - unbent_flat * unbent_flat;
    let upright_slope = select(level.scale, length(unbent) * inverseSqrt(max(unbent_turn, 0.04)), unbent_turn > 0.04);
    let coarse = upright_slope * sqrt(max(1.0 - flat * flat, 0.04));
    let steep = mix(max(length(slope), 0.2 * upright_slope), coarse, smoothstep(0.02, 0.15, distance));
    let true_distance = distance / steep;
    if share > 1e-3 && params.width > 0.0 && true_distance < level.reach {
        let outer = outer_of(params) * share;
        let cosine = min(abs(slope.x) / max(length(slope), 1e-12), 1.0);
        let sine = sqrt(1.0 - cosine * cosine);
        let texel = at.texel_size * vec2f(max(cosine, sine), min(cosine, sine));
        (*net).clear *= 1.0 - line_cover(true_distance, params.width * share - outer, outer, texel);
        (*net).low = min((*net).low, min(sqrt(share), 1.0) * groove_height(true_distance, outer, texel));
        (*net).away = min((*net).away, true_distance);
        let beside = max(1.0 - true_distance / (LIP_REACH * level.size), 0.0);
        (*net).lip = max((*net).lip, present * level.width * beside * beside);
    }
    return present * min(level.strength, 1.0);
}

// How much of a crack there is, by a sum of two even random numbers weighed 0.6 and 0.4: 1 but for the share `breaks`, with
// tapered ends.
fn present_at(sum: f32, breaks: f32) -> f32 {
    // The distribution of the sum makes it even.
    let low = sum * sum / 0.48;
    let high = 1.0 - (1.0 - sum) * (1.0 - sum) / 0.48;
    let even = select(select(high, (sum - 0.2) / 0.6, sum < 0.6), low, sum < 0.4);
    return clamp((even - 1.25 * breaks) * 4.0 + 1.0, 0.0, 1.0);
}
