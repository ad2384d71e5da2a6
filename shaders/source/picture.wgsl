//! A picture with copies of half, a quarter… its size, in a table of rows of four numbers, and its mean over the footprint of a
//! texel. All values are linear.
//! @use core atlas

// Storage of the pixels of a picture and its copies: four codes of 8 bits or of 16, where copies have four floats; four halves;
// or four floats.
const CODES_8: u32 = 0u;
const CODES_16: u32 = 1u;
const HALVES: u32 = 2u;
const FLOATS: u32 = 3u;
// There is no picture.
const NO_PICTURE: u32 = 4u;

// The table begins with a row for the picture and for each of its copies: the first row of its pixels, its width and height.
const COPY_ROWS: u32 = 32u;

// Pixels beyond the borders.
const WRAP_REPEAT: u32 = 0u;
const WRAP_CLAMP: u32 = 1u;

// Most taps along one side of a footprint.
const TAPS_LIMIT: f32 = 16.0;
// Distance from the center of a pixel, in pixels, within which a place is that center: rounding of texture coordinates must not
// blend pixels where a texel is one.
const CENTER: f32 = 0.002;

struct Picture {
    // Number of the smallest copy.
    last: u32,
    // 1 where a color counts in averages as much as it is opaque.
    by_alpha: u32,
    // Pixels beyond the borders along u and v.
    wrap: vec2u,
}

// Area of a picture that a texel of the atlas covers, in texture coordinates.
struct Footprint {
    // Its middle.
    uv: vec2f,
    // Change of the coordinates over one texel along the u and along the v of the atlas.
    along: vec2f,
    across: vec2f,
}

// Sums over pixels, each times its share.
struct Sums {
    plain: vec4f,
    // Of colors times alpha.
    opaque: vec3f,
}

// The mean of pixels. By alpha, clear pixels give it no color, unless all are clear.
fn mean_of(sums: Sums, by_alpha: bool) -> vec4f {
    let is_seen = by_alpha && sums.plain.w > 0.0;
    let color = sums.opaque / select(1.0, sums.plain.w, is_seen);
    return vec4f(select(sums.plain.xyz, color, is_seen), sums.plain.w);
}

// A footprint through the transform of a texture, by rows.
fn transformed(own: Footprint, u: vec3f, v: vec3f) -> Footprint {
    let along = vec2f(dot(u.xy, own.along), dot(v.xy, own.along));
    let across = vec2f(dot(u.xy, own.across), dot(v.xy, own.across));
    return Footprint(vec2f(dot(u.xy, own.uv) + u.z, dot(v.xy, own.uv) + v.z), along, across);
}

// The mean of a picture over a footprint: taps on a grid, at the copy whose pixels are at most half as large as the shorter side
// of the footprint; bilinear where the picture is magnified. Processors skip a loop that no texel at hand goes through, so
// the picture and its copies have a loop each.
fn footprint_mean(table: texture_2d<u32>, storage: u32, picture: Picture, covered: Footprint) -> vec4f {
    let whole = textureLoad(table, table_texel(0u), 0);
    let size = vec2f(whole.yz);
    let sides = vec2f(length(covered.along * size), length(covered.across * size));
    let finest = max(max(0.5 * min(sides.x, sides.y), max(sides.x, sides.y) / TAPS_LIMIT), 1.0);
    // Rounding must not turn a footprint of two pixels into a finer copy.
    let copy = min(firstLeadingBit(u32(min(finest * 1.00001, 1e9))), picture.last);
    let taps = clamp(ceil(sides / f32(1u << copy) - 1e-3), vec2f(1.0), vec2f(TAPS_LIMIT));
    let across = u32(taps.x);
    let count = across * u32(taps.y);
    var sums = Sums(vec4f(0.0), vec3f(0.0));
    for (var tap = 0u; tap < select(0u, count, copy == 0u); tap++) {
        let at = tap_place(covered, taps, vec2u(tap % across, tap / across));
        let near = bilinear(table, storage, picture.wrap, whole, at);
        sums = Sums(sums.plain + near.plain, sums.opaque + near.opaque);
    }
    let of_copies = select(FLOATS, HALVES, storage == HALVES);
    for (var tap = 0u; tap < select(count, 0u, copy == 0u); tap++) {
        let at = tap_place(covered, taps, vec2u(tap % across, tap / across));
        let head = textureLoad(table, table_texel(copy), 0);
        let near = bilinear(table, of_copies, picture.wrap, head, at);
        sums = Sums(sums.plain + near.plain, sums.opaque + near.opaque);
    }
    let mean = Sums(sums.plain / f32(count), sums.opaque / f32(count));
    return mean_of(mean, picture.by_alpha != 0u);
}

fn tap_place(covered: Footprint, taps: vec2f, tap: vec2u) -> vec2f {
    let share = (vec2f(tap) + 0.5) / taps - 0.5;
    return covered.uv + share.x * covered.along + share.y * covered.across;
}

// One to four pixels around a place; `head` is the row of the copy.
fn bilinear(table: texture_2d<u32>, storage: u32, wrap: vec2u, head: vec4u, at: vec2f) -> Sums {
    let size = vec2i(head.yz);
    let inside = vec2f(within(at.x, wrap.x), within(at.y, wrap.y));
    let place = inside * vec2f(size) - 0.5;
    let corner = floor(place);
    let fraction = place - corner;
    let is_center = (fraction < vec2f(CENTER)) | (fraction > vec2f(1.0 - CENTER));
    let ahead = select(fraction, vec2f(0.0), is_center);
    // The center of the next pixel is a corner of its own.
    let low = vec2i(select(corner, corner + 1.0, is_center & (fraction > vec2f(0.5))));
    var sums = Sums(vec4f(0.0), vec3f(0.0));
    for (var corner_index = 0u; corner_index < select(4u, 1u, all(is_center)); corner_index++) {
        let step = vec2u(corner_index & 1u, corner_index >> 1u);
        let share = select(1.0 - ahead, ahead, step != vec2u(0u));
        let column = pixel_within(low.x + i32(step.x), size.x, wrap.x);
        let row = pixel_within(low.y + i32(step.y), size.y, wrap.y);
        let seen = pixel(table, storage, head.x, row * head.y + column);
        let weight = share.x * share.y;
        sums = Sums(sums.plain + weight * seen, sums.opaque + weight * seen.w * seen.xyz);
    }
    return sums;
}

// A texture coordinate at which the same is seen, near the picture.
fn within(at: f32, wrap: u32) -> f32 {
    let side = select(2.0, 1.0, wrap == WRAP_REPEAT);
    return select(at - side * floor(at / side), clamp(at, -1.0, 2.0), wrap == WRAP_CLAMP);
}

// The pixel of a row or column that is seen at a place near the picture.
fn pixel_within(at: i32, size: i32, wrap: u32) -> u32 {
    let repeated = (at + size) % size;
    let around = (at + 2 * size) % (2 * size);
    let mirrored = select(2 * size - 1 - around, around, around < size);
    let tiled = select(mirrored, repeated, wrap == WRAP_REPEAT);
    return u32(select(tiled, clamp(at, 0, size - 1), wrap == WRAP_CLAMP));
}

fn pixel(table: texture_2d<u32>, storage: u32, first_row: u32, index: u32) -> vec4f {
    if storage == FLOATS {
        return bitcast<vec4f>(textureLoad(table, table_texel(first_row + index), 0));
    }
    if storage == HALVES || storage == CODES_16 {
        let pair = textureLoad(table, table_texel(first_row + index / 2u), 0);
        let words = select(pair.xy, pair.zw, (index & 1u) != 0u);
        if storage == HALVES {
            return vec4f(unpack2x16float(words.x), unpack2x16float(words.y));
        }
        return vec4f(vec4u(words.x & 0xffffu, words.x >> 16u, words.y & 0xffffu, words.y >> 16u)) / 65535.0;
    }
    let four = textureLoad(table, table_texel(first_row + index / 4u), 0);
    let half = select(four.xz, four.yw, (index & 1u) != 0u);
    let word = select(half.x, half.y, (index & 2u) != 0u);
    return vec4f(vec4u(word & 0xffu, (word >> 8u) & 0xffu, (word >> 16u) & 0xffu, word >> 24u)) / 255.0;
}
