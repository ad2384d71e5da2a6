//! Spots
//! Splashes and stains of many sizes that gather in places: spilled paint, mud, leaks, bird droppings, mildew.
//!
//! Spots are uneven blots; large ones are rare and have small ones around them. With Drip they run down into tails, with Rim
//! they have dried at the border as coffee does. Spots smaller than the texels fade to their mean.
//! @alias splash splatter drops stains grunge speckles blots leak drip paint mud mildew freckles
//! @use cells

struct Params {
    /// Size of the largest spots.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.1
    size: f32,
    /// Number of spots: 1 is the maximum.
    /// @range 0 1 @default 0.5
    amount: f32,
    /// Gathering of the spots: 0 is even, 1 leaves large places without any.
    /// @range 0 1 @default 0.6
    cluster: f32,
    /// Number of layers of ever smaller spots.
    /// @label Detail @range 1 5 @default 4
    octaves: u32,
    /// Irregularity of the outlines.
    /// @range 0 1 @default 0.4
    ragged: f32,
    /// Length of the tails that spots run down into, along Toward.
    /// @range 0 1 @default 0
    drip: f32,
    /// Strength of dried borders: at 1 only the borders are left.
    /// @range 0 1 @default 0
    rim: f32,
    /// Softness of the borders, as a share of the size of a spot.
    /// @range 0 1 @default 0.1
    softness: f32,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The spots of a place.
/// @shared
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
/// @input toward Direction in which spots run down, in model space. @vector @optional @default 0 -1 0
/// @input density Factor on the number of spots; there are none where it is 0. @optional @default 1
fn spots(at: Surface, position: vec3f, toward: vec3f, density: f32, params: Params) -> Spots {
    let way = toward * inverseSqrt(max(dot(toward, toward), 1e-20));
    var site = Site(way - at.normal * dot(way, at.normal), 0.0, seed_key(params.seed), 0.0, density);
    var found = Spots(0.0, 0.0, 0.0);
    // A cube is as wide as the largest spot with its whole tail needs.
    var cube = 0.5 * params.size / RADIUS;
    for (var octave = 0u; octave < params.octaves; octave++) {
        let seen = carried(2.0 * cube, at.texel_size);
        var layer = Spots(0.0, 0.0, 0.0);
        // Places without density have no spots.
        if seen > 0.0 && density > 0.0 {
            site.texel = at.texel_size / cube;
            let p = position / cube;
            // Outlines of two sizes, as far as the texels carry them.
            site.wobble = 0.22 * carried(0.4 * cube, at.texel_size) * simplex_noise(p / 0.4, site.key + vec3u(3u))
                + 0.1 * carried(0.15 * cube, at.texel_size) * simplex_noise(p / 0.15, site.key + vec3u(4u));
            let place = cells_place(position, cube, vec3f(1.0), vec3f(0.0));
            layer = layer_at(place, site, cube / params.size, params);
        }
        let mean = mean_cover(density, params);
        let cover = mix(mean, layer.cover, seen);
        if cover > found.cover {
            found.id = layer.id;
        }
        found.depth = max(found.depth, layer.depth * seen);
        found.cover = 1.0 - (1.0 - found.cover) * (1.0 - cover);
        cube *= FINER;
        site.key += vec3u(0x9e3779b9u, 0x85ebca6bu, 0xc2b2ae35u);
    }
    return found;
}

/// The spots: 1 inside, 0 between.
fn mask(spots: Spots) -> f32 {
    return spots.cover;
}

/// A random value for each spot, 0 between them.
fn id(spots: Spots) -> f32 {
    return spots.id;
}

/// How far inside of a spot: 0 on the border, growing to 1 in the middle. Use it for drops that bulge.
fn height(spots: Spots) -> f32 {
    let depth = spots.depth;
    return sqrt(max(depth * (2.0 - depth), 0.0));
}

// Radius of the largest spots of a layer, in its cubes, before they are drawn out.
const RADIUS: f32 = 0.42;
// How much smaller each layer's spots are.
const FINER: f32 = 0.5;

struct Spots {
    cover: f32,
    // How far inside of the spot that covers most: 1 in its middle.
    depth: f32,
    id: f32,
}

// What all layers share at a place.
struct Site {
    // The direction that spots run in along the surface, as long as the surface is steep.
    down: vec3f,
    // Uneven outlines: even random numbers around 0.
    wobble: f32,
    key: vec3u,
    // A texel in cubes of the layer.
    texel: f32,
    density: f32,
}

// The share that one layer covers, fitted to what was measured.
fn mean_cover(density: f32, params: Params) -> f32 {
    let count = clamp(params.amount * density, 0.0, 1.0) * (1.0 - 0.57 * params.cluster);
    return 0.053 * count * (1.0 + 0.05 * params.drip) * (1.0 - 0.48 * params.rim);
}

// The spots of one layer: one point in each cube may have one. `scale` is a cube by the size of the largest spots.
fn layer_at(place: vec3f, site: Site, scale: f32, params: Params) -> Spots {
    let rows = rows_around(place, site.key);
    var found = Spots(0.0, 0.0, 0.0);
    // No spot reaches further, with its outline and tail.
    let whole = RADIUS * (1.45 + 0.5 * params.softness) * (1.0 + 3.0 * params.drip);
    let reach = min(whole + 1.5 * site.texel, 1.0);
    for (var index = 0; index < 9; index++) {
        if rows_done(rows, index, reach * reach) {
            break;
        }
        let points = point_row(rows, index, 1.0, site.key);
        let numbers = number_row(rows, row_step(rows, index), site.key).x;
        let squares = points.x * points.x + points.y * points.y + points.z * points.z;
        if min(squares.x, min(squares.y, squares.z)) >= reach * reach {
            continue;
        }
        for (var column = 0; column < 3; column++) {
            if squares[column] < reach * reach {
                let offset = vec3f(points.x[column], points.y[column], points.z[column]);
                add_spot(&found, offset, place + offset, numbers[column], site, scale, params);
            }
        }
    }
    return found;
}

// Adds one spot. `offset` leads to its middle from the place, which is at `middle` in cubes.
fn add_spot(
    found: ptr<function, Spots>, offset: vec3f, middle: vec3f, id: u32, site: Site, scale: f32, params: Params,
) {
    let random = unit_random3(pcg3d(vec3u(id, 0x2c1b3c6du, site.key.x)));
    let most = params.amount * site.density;
    if random.z >= most * (1.0 + 0.4 * params.cluster) {
        return;
    }
    // Small ones are frequent: a power law, as of drops that break up.
    let radius = RADIUS * (0.2 + 0.8 * random.x * random.x * random.x);
    // Below the middle, distances count less: a tail, narrower toward its end. Steep places run further.
    let long = 1.0 + 3.0 * params.drip * random.y * random.y;
    let steep = length(site.down);
    let along = -dot(offset, site.down) / max(steep, 1e-6);
    let tail = mix(1.0, min(long, 0.66 / radius), steep);
    let beside = sqrt(max(dot(offset, offset) - along * along, 0.0));
    let run = max(along, 0.0) / tail;
    let narrow = 1.0 + (tail - 1.0) * 0.8 * run / radius;
    let away = length(vec2f(beside * narrow, select(along, run, along > 0.0)));
    let rough = clamp(1.0 + params.ragged * site.wobble * 1.6, 0.2, 1.45);
    let depth = 1.0 - away / (radius * rough);
    let blur = max(params.softness, 1.5 * site.texel / radius);
    if depth < -0.5 * blur {
        return;
    }
    // Where spots gather; asked at the middle, so that a spot is whole or not there.
    let gather = normal_share(1.3 * simplex_noise(middle * scale / 3.0, seed_key(params.seed) + vec3u(9u)));
    let chance = most * mix(1.0, smoothstep(0.35, 0.85, gather) * 1.4, params.cluster);
    if random.z >= chance {
        return;
    }
    var cover = clamp(depth / blur + 0.5, 0.0, 1.0);
    // A spot thinner than a texel is a faint one.
    cover *= min(1.0, radius / (0.75 * site.texel));
    let middle_left = smoothstep(0.35, 0.08, depth);
    let dried = cover * mix(1.0, middle_left, params.rim);
    if dried > (*found).cover || ((*found).cover == 0.0 && dried > 0.0) {
        (*found).id = unit_random(id * 747796405u + 2891336453u);
    }
    (*found).cover = max((*found).cover, dried);
    (*found).depth = max((*found).depth, clamp(depth, 0.0, 1.0) * min(radius / RADIUS * 1.5, 1.0));
}
