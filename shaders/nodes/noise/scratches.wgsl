//! Scratches
//! Bent scratches in all directions or in one: traces of use, transport, brushing, sanding.
//!
//! Each scratch is where one side of a thin, slightly bent disk in space cuts the surface: it runs over seams, and ends where
//! the surface turns away from that side. Some are cut far from the middle of their disk and are shorter and finer.
//! Scratches thinner than a texel become faint, not dotted.
//! @alias scratches scratched scrapes brushed sanded grinding wear marks
//! @use cells lines

struct Params {
    /// Number of scratches: 1 is the maximum.
    /// @range 0 1 @default 0.5
    density: f32,
    /// Length of the longest scratches.
    /// @length @range 0.0001 100 @soft 0.02 1 @default 0.3
    length: f32,
    /// Width of the widest scratches, measured on the surface at half their strength.
    /// @length @range 0 10 @soft 0.0005 0.02 @default 0.004
    width: f32,
    /// How bent the scratches are: offset of the ends of the most bent ones, as a share of half their length.
    /// @range 0 1 @default 0.2
    bend: f32,
    /// Range of directions around Toward, measured from one side to the other. Has no effect without Toward.
    /// @angle @range 0 180 @default 180
    spread: f32,
    /// Stretches the scratches along the axes of the pattern; their width stays the same.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The scratches of a place.
/// @shared
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
/// @input toward Direction of the scratches, in model space; unconnected, scratches have any direction. @vector @optional @default 0 0 0
fn found(at: Surface, position: vec3f, toward: vec3f, params: Params) -> Found {
    let unit = 0.5 * params.length;
    let place = cells_place(position, unit, params.stretch, params.rotate);
    let normal = noise_direction(at.normal, params.rotate);
    let way = noise_direction(toward, params.rotate) / params.stretch;
    let way_size = length(way);
    let lead = way / max(way_size, 1e-12);
    let strays = select(1.0, turn_of(vec3f(0.5 * params.spread)).sine.x, way_size > 1e-6);
    let key = seed_key(params.seed);
    // No disk is further away than this, in cubes, if the texel sees its scratch or the ridges beside it.
    let reach = (params.width + at.texel_size) / (unit * finest_stretch(params.stretch)) * (1.0 + params.bend);
    // A plane's normal where space is drawn out: disks are looked for on this side only.
    let up = normalize(normal * params.stretch);
    let rows = rows_around(place, key);
    let disks = disks_around(rows, up, key, params.density * IN_CUBE);
    // Those that cut it, first: most do not, and the rest is much work that processors do for several places at once.
    var cuts = vec3u(0u);
    var left = disks;
    for (var i = 0; i < 81; i++) {
        let at_hand = next_disk(left);
        if !at_hand.is_one {
            break;
        }
        left &= ~at_hand.bits;
        let cut = cut_of(at_hand, rows, lead, strays, key, params);
        cuts |= select(vec3u(0u), at_hand.bits, abs(cut.away) < reach && cut.is_there);
    }
    var found = Found(1.0, 0.0, 0.0, 0.0, 0u, vec3f(0.0));
    for (var i = 0; i < 81; i++) {
        let at_hand = next_disk(cuts);
        if !at_hand.is_one {
            break;
        }
        cuts &= ~at_hand.bits;
        let cut = cut_of(at_hand, rows, lead, strays, key, params);
        add_scratch(&found, cut, unit, at, normal, -dot(up, cut.offset), params);
    }
    return found;
}

/// The scratches: 1 inside, 0 between them.
fn mask(at: Surface, found: Found, params: Params) -> f32 {
    return mix(mean_cover(params), 1.0 - found.clear, seen(at, params));
}

/// A groove with raised ridges for each scratch: -1 at the bottom of the widest, up to 0.25 on the ridges, 0 between. Connect it to
/// the height map of an effect; the effect's height is then the depth of the scratches.
fn height(at: Surface, found: Found, params: Params) -> f32 {
    // The ridges take half of a groove back, and fine scratches are shallow: 0.3 of the mask is left, measured.
    return mix(-0.3 * mean_cover(params), found.low + found.high * (1.0 + found.low), seen(at, params));
}

/// Direction of the scratch, in model space; its length is the strength of the scratch, 0 between scratches.
/// @vector
fn direction(at: Surface, found: Found, params: Params) -> vec3f {
    let rotate = params.rotate;
    let turned = vec3f(
        dot(noise_direction(vec3f(1.0, 0.0, 0.0), rotate), found.along),
        dot(noise_direction(vec3f(0.0, 1.0, 0.0), rotate), found.along),
        dot(noise_direction(vec3f(0.0, 0.0, 1.0), rotate), found.along),
    );
    return turned * seen(at, params);
}

/// A random value for each scratch; 0 between them.
fn id(found: Found) -> f32 {
    return select(0.0, unit_random(found.id), found.depth > 0.0);
}

// Disks in a cube, at most. A cube's side is half the length, which is also the radius of a disk and the unit below.
const IN_CUBE: f32 = 3.0;
// How far above the surface the middles of disks may be: only the nearer halves of disks cut, so that a board is not
// scratched all around.
const HIGHEST: f32 = 0.7;

struct Disk {
    // Normal in its middle, in the noise's own axes.
    normal: vec3f,
    // Half of the curvature of the sphere that it is part of.
    bend: f32,
    // Width of its scratch as a share of the largest.
    width: f32,
}

struct Found {
    // The share that all scratches leave free.
    clear: f32,
    low: f32,
    high: f32,
    // How far inside of the border of the nearest scratch the place is, and which one that is.
    depth: f32,
    id: u32,
    along: vec3f,
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(params.length * finest_stretch(params.stretch), at.texel_size);
}

// The covered share of the surface, fitted to what was measured.
fn mean_cover(params: Params) -> f32 {
    return 1.0 - exp2(-2.92 * params.density * params.width / params.length);
}

// One of the disks of the cubes around.
struct AtHand {
    // Whether there is one.
    is_one: bool,
    // Its cube, of 27, and its number there.
    cube: i32,
    number: u32,
    // Its bit in the sets of `disks_around`.
    bits: vec3u,
}

fn next_disk(left: vec3u) -> AtHand {
    let number = select(select(2u, 1u, left.y != 0u), 0u, left.x != 0u);
    let of_number = select(select(left.z, left.y, number == 1u), left.x, number == 0u);
    let bit = of_number & (~of_number + 1u);
    return AtHand(
        of_number != 0u,
        i32(firstTrailingBit(of_number | 0x80000000u)),
        number,
        select(vec3u(0u), vec3u(bit), vec3u(number) == vec3u(0u, 1u, 2u)),
    );
}

// A disk, and how it lies to the place.
struct Cut {
    disk: Disk,
    // From its middle to the place.
    offset: vec3f,
    // How far the place is from it.
    away: f32,
    // Its random number.
    id: u32,
    // Whether the density has it at all.
    is_there: bool,
}

fn cut_of(at_hand: AtHand, rows: CubeRows, lead: vec3f, strays: f32, key: vec3u, params: Params) -> Cut {
    let step = cube_step(at_hand.cube);
    let numbers = cell_random(rows.cell + step, key);
    let bits = select(select(numbers.z, numbers.y, at_hand.number == 1u), numbers.x, at_hand.number == 0u);
    let offset = rows.inside - vec3f(step) - middle_of(bits);
    let random = pcg3d(vec3u(bits, 0x85ebca6bu, 0x9e3779b9u));
    // Few are bent much.
    let bent = f32(random.y & 65535u) / 32768.0 - 1.0;
    let disk = Disk(disk_normal(random, lead, strays), bent * abs(bent) * params.bend, own_width(random));
    let away = dot(disk.normal, offset) - disk.bend * dot(offset, offset);
    let is_there = unit_random(random.z) < params.density * IN_CUBE - f32(at_hand.number);
    return Cut(disk, offset, away, bits, is_there);
}

// Which disks may cut the surface here: for each number of a disk in its cube one bit for each of the 27 cubes around.
fn disks_around(rows: CubeRows, up: vec3f, key: vec3u, count: f32) -> vec3u {
    let corner = 0.00048828125 - rows.inside;
    let columns = corner.x + vec3f(-1.0, 0.0, 1.0);
    var found = vec3u(0u);
    var left = rows_hit(rows, up);
    for (var i = 0; i < 9; i++) {
        if left == 0u {
            break;
        }
        let row = i32(firstTrailingBit(left));
        left &= left - 1u;
        let step = row_step_of(row);
        let numbers = number_row(rows, step, key);
        let line = corner.yz + vec2f(step);
        let hits = vec3u(
            hits_of(numbers.x, columns, line, up),
            hits_of(numbers.y, columns, line, up),
            hits_of(numbers.z, columns, line, up),
        );
        found |= hits << vec3u(3u * u32(row));
    }
    return select(vec3u(0u), found, vec3f(count) > vec3f(0.0, 1.0, 2.0));
}

// One bit for each row of cubes that may have the middle of such a disk.
fn rows_hit(rows: CubeRows, up: vec3f) -> u32 {
    let middle = 0.5 - rows.inside;
    let y = middle.y + vec3f(-1.0, 0.0, 1.0);
    let z = middle.z + vec3f(-1.0, 0.0, 1.0);
    let apart_y = max(abs(y) - 0.5, vec3f(0.0));
    let apart_z = max(abs(z) - 0.5, vec3f(0.0));
    let rise_y = up.x * middle.x + up.y * y;
    let rise_z = up.z * z;
    let reach = dot(abs(up), vec3f(1.5, 0.5, 0.5));
    return lines_hit(rise_y + rise_z.x, apart_y * apart_y + apart_z.x * apart_z.x, reach)
        | (lines_hit(rise_y + rise_z.y, apart_y * apart_y + apart_z.y * apart_z.y, reach) << 3u)
        | (lines_hit(rise_y + rise_z.z, apart_y * apart_y + apart_z.z * apart_z.z, reach) << 6u);
}

fn lines_hit(rise: vec3f, apart: vec3f, reach: f32) -> u32 {
    return bits_of((rise > vec3f(-reach)) & (rise < vec3f(HIGHEST + reach)) & (apart < vec3f(1.0)));
}

fn bits_of(hits: vec3<bool>) -> u32 {
    let bits = select(vec3u(0u), vec3u(1u, 2u, 4u), hits);
    return bits.x | bits.y | bits.z;
}

// One bit for each of three disks that the place may be on, with their cubes' corners.
fn hits_of(bits: vec3u, columns: vec3f, line: vec2f, up: vec3f) -> u32 {
    let x = columns + vec3f(bits >> vec3u(22u)) * 0.0009765625;
    let y = line.x + vec3f((bits >> vec3u(12u)) & vec3u(1023u)) * 0.0009765625;
    let z = line.y + vec3f((bits >> vec3u(2u)) & vec3u(1023u)) * 0.0009765625;
    let rise = up.x * x + up.y * y + up.z * z;
    return bits_of((x * x + y * y + z * z < vec3f(1.0)) & (rise > vec3f(0.0)) & (rise < vec3f(HIGHEST)));
}

// The step to cube `index` of 27, three in each row.
fn cube_step(index: i32) -> vec3i {
    let row = (index * 11) >> 5u;
    return vec3i(index - 3 * row - 1, row_step_of(row));
}

// The step along y and z to row `row` of nine.
fn row_step_of(row: i32) -> vec2i {
    let z = (row * 11) >> 5u;
    return vec2i(row - 3 * z, z) - 1;
}

// The middle of a disk in its cube, decided in 1/1024 of it.
fn middle_of(bits: u32) -> vec3f {
    return thousandth((vec3u(bits) >> vec3u(22u, 12u, 2u)) & vec3u(1023u));
}

fn thousandth(bits: vec3u) -> vec3f {
    return (vec3f(bits) + 0.5) * 0.0009765625;
}

// Fine ones are more frequent than wide ones.
fn own_width(random: vec3u) -> f32 {
    let chance = f32(random.y >> 16u) / 65536.0;
    return 0.25 + 0.75 * chance * chance;
}

// The normal of a disk whose plane holds `lead` but for an angle whose sine is at most `strays`.
fn disk_normal(random: vec3u, lead: vec3f, strays: f32) -> vec3f {
    // A random direction: even along the axis, and around it by two parabolas for sine and cosine.
    let z = f32(random.x & 65535u) / 32768.0 - 1.0;
    let turn = f32(random.x >> 16u) / 32768.0 - 1.0;
    let turned = turn + select(0.5, -1.5, turn > 0.5);
    let around = vec2f(turn * (1.0 - abs(turn)), turned * (1.0 - abs(turned)));
    let even = vec3f(around * sqrt((1.0 - z * z) / dot(around, around)), z);
    if strays == 1.0 {
        return even;
    }
    // Pressed toward the plane across the way.
    let high = dot(even, lead);
    let flat = even - high * lead;
    let low = strays * high;
    return flat * sqrt((1.0 - low * low) / max(dot(flat, flat), 1e-12)) + low * lead;
}

// `above` is how far the middle of the disk is above the surface.
fn add_scratch(
    found: ptr<function, Found>, cut: Cut, unit: f32, at: Surface, normal: vec3f, above: f32, params: Params,
) {
    let disk = cut.disk;
    let offset = cut.offset;
    // What is left of the slope along the surface turns the distance from the disk to one on the surface.
    let slope = (disk.normal - 2.0 * disk.bend * offset) / params.stretch;
    let rise = dot(slope, normal);
    let whole = dot(slope, slope);
    let steep = sqrt(max(whole - rise * rise, 1e-12));
    let distance = abs(cut.away) * unit / steep;
    // A disk almost along the surface would cut out a patch, not a line.
    let upright = steep * inverseSqrt(max(whole, 1e-12));
    let edge = clamp((upright - 0.3) * 4.0, 0.0, 1.0) * clamp(10.0 * min(above, HIGHEST - above), 0.0, 1.0);
    let square = dot(offset, offset);
    // Pointed at its ends.
    let size = disk.width * edge * (1.0 - square * square);
    let half = 0.5 * params.width * size;
    let texel_step = noise_direction(at.texel_step, params.rotate);
    let texel = line_texel(slope - rise * normal, texel_step, at.texel_size);
    let cover = line_cover(distance, 0.6 * half, 1.4 * half, texel);
    (*found).clear *= 1.0 - cover;
    let height = size * ridged_height(distance, 1.4 * half, texel);
    (*found).low = min((*found).low, height);
    (*found).high = max((*found).high, height);
    let depth = half - distance;
    if depth > (*found).depth {
        (*found).id = cut.id;
        (*found).depth = depth;
    }
    let along = cross(normal, slope) / steep;
    (*found).along = mix((*found).along, along, cover);
}
