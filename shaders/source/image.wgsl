//! A picture on the surface, as `source/image` shows it.
//! @use core atlas hash surface/place surface/tangent_frame
//! @use source/triangle_point source/picture source/coordinates source/patches source/projection source/stored
//! @given StoredField IS_HALF STORAGE_0 SHOWS_SLOPE WAY READS_PLACE HAS_CELLS IS_RANDOM

// Values of a picture that are shown; the channels follow.
const SHOWN_COLOR: u32 = 0u;
const SHOWN_LUMINANCE: u32 = 1u;
const SHOWN_ALPHA: u32 = 2u;
const SHOWN_CHANNELS: u32 = 3u;

// Weight below which a patch is not read: less than a step of 8 bits.
const LEAST_WEIGHT: f32 = 0.00390625;

struct Image {
    projection: Projection,
    // Mean of the picture.
    mean: vec4f,
    picture: Picture,
    shown: u32,
    // 1 for values that lie between 0 and 1.
    is_limited: u32,
    // Arrangement of random patches.
    seed: u32,
    most_turned: f32,
    // Sign of green in a normal map; 0 where the picture is gray.
    green: f32,
    // 1 if the choice of one of several pictures in a file is connected.
    has_cell: u32,
    pad_1: u32,
    pad_2: u32,
}

@group(1) @binding(0) var<uniform> image: Image;
@group(1) @binding(1) var table: texture_2d<u32>;
@group(1) @binding(2) var places: texture_2d_array<f32>;
@group(1) @binding(3) var chosen: texture_2d_array<f32>;
@group(1) @binding(4) var field: StoredField;

fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

// A place that is read; numbers that are not finite count as 0.
fn place_at(texel: vec3i) -> vec3f {
    let stored = textureLoad(places, texel.xy, texel.z, 0).xyz;
    let known = vec3<bool>(is_finite(stored.x), is_finite(stored.y), is_finite(stored.z));
    return select(vec3f(0.0), stored, known);
}

// True for a texel that the surface covers.
fn is_covered(texel: vec3i) -> bool {
    let size = vec2i(textureDimensions(owners).xy);
    let is_there = all(texel.xy >= vec2i(0)) && all(texel.xy < size);
    return is_there && owner_of(select(vec3i(-1), texel, is_there)) != EMPTY;
}

// Change of the place over a texel along one axis: the smaller one of those to both sides. Places jump from one cell of a pattern
// to the next, and a picture that was averaged over the jump would be a blurred line there.
fn place_step(texel: vec3i, axis: vec3i, at: vec3f) -> vec3f {
    let behind = at - place_at(texel - axis);
    let ahead = place_at(texel + axis) - at;
    let has_behind = is_covered(texel - axis);
    let has_ahead = is_covered(texel + axis);
    let is_behind = has_behind && (!has_ahead || dot(behind, behind) < dot(ahead, ahead));
    return select(select(vec3f(0.0), ahead, has_ahead), behind, is_behind);
}

fn place_of(texel: vec3i, point: TrianglePoint) -> ReadPlace {
    if !READS_PLACE {
        return own_place(point);
    }
    let at = place_at(texel);
    return ReadPlace(at, place_step(texel, vec3i(1, 0, 0), at), place_step(texel, vec3i(0, 1, 0), at));
}

// Choice of one of several pictures in the file: the connected one, else the third texture coordinate that is read.
fn cell_of(texel: vec3i, read: ReadPlace) -> f32 {
    let own = select(0.0, read.at.z, READS_PLACE && WAY == BY_UV);
    let stored = textureLoad(chosen, texel.xy, texel.z, 0).x;
    return select(own, stored, image.has_cell != 0u && is_finite(stored));
}

// A color as it adds up with others: times its alpha where clear colors do not count.
fn weighed(color: vec4f) -> vec4f {
    return vec4f(color.xyz * select(1.0, color.w, image.picture.by_alpha != 0u), color.w);
}

// A color of sums of weighed ones; where all are clear, another one.
fn unweighed(sum: vec4f, otherwise: vec3f) -> vec4f {
    if image.picture.by_alpha == 0u {
        return sum;
    }
    return vec4f(select(otherwise, sum.xyz / max(sum.w, 1e-12), sum.w > 0.0), sum.w);
}

// The shown part of a color of the picture, but for colors themselves.
fn shown_of(color: vec4f, cover: f32) -> vec3f {
    let luminous = select(color.w, luminance(color.xyz), image.shown == SHOWN_LUMINANCE);
    let channel = color[clamp(image.shown, SHOWN_CHANNELS, SHOWN_CHANNELS + 2u) - SHOWN_CHANNELS];
    return vec3f(cover * select(luminous, channel, image.shown >= SHOWN_CHANNELS), 0.0, 0.0);
}

// The slope of a color of a normal map; `turn` is the rotation of its patch. Patches are blended as gradients: they add up,
// normals do not.
fn slope_of(color: vec4f, view: View, frame: TangentFrame, turn: vec2f) -> vec3f {
    let code = 2.0 * color.xyz - 1.0;
    let y = image.green * code.y;
    let normal = vec3f(turn.x * code.x - turn.y * y, turn.y * code.x + turn.x * y, code.z);
    return view_slope(image.projection, view, frame, normal);
}

// The value of one view, of the picture as it is or of its patches: a color with its alpha, or the shown part of it.
fn view_value(view: View, frame: TangentFrame) -> vec4f {
    var color = vec4f(0.0);
    var slope = vec3f(0.0);
    if IS_RANDOM {
        let patches = Patches(image.seed, image.most_turned, image.projection.aspect);
        let mean = weighed(image.mean);
        color = mean;
        for (var index = 0u; index < 3u; index++) {
            let part = patch_at(patches, view.footprint, index);
            // Patches that are hardly seen are not read.
            for (var read = 0u; read < select(0u, 1u, part.weight > LEAST_WEIGHT); read++) {
                let own = footprint_mean(table, STORAGE_0, image.picture, part.footprint);
                color += part.weight * (weighed(own) - mean);
                slope += part.weight * slope_of(own, view, frame, part.turn);
            }
        }
        if image.is_limited != 0u {
            color = clamp(color, vec4f(0.0), vec4f(1.0));
        }
        color = unweighed(color, image.mean.xyz);
        if image.is_limited != 0u {
            color = min(color, vec4f(1.0));
        }
    } else {
        color = footprint_mean(table, STORAGE_0, image.picture, view.footprint);
        slope = slope_of(color, view, frame, vec2f(1.0, 0.0));
    }
    if SHOWS_SLOPE {
        return vec4f(select(view.cover * slope, vec3f(0.0), image.green == 0.0), 1.0);
    }
    if image.shown == SHOWN_COLOR {
        return color;
    }
    return vec4f(shown_of(color, view.cover), 1.0);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY {
        return;
    }
    let point = triangle_point(texel, owner);
    let frame = tangent_frame(point.triangle, point.step);
    let read = place_of(texel, point);
    let is_triplanar = WAY == TRIPLANAR;
    let normal = unit_or(frame.normal, select(image.projection.toward, vec3f(0.0, 1.0, 0.0), is_triplanar));
    let is_color = !SHOWS_SLOPE && image.shown == SHOWN_COLOR;
    var sum = vec4f(0.0);
    // Of colors that no alpha weighs, where all views are clear.
    var clear = vec3f(0.0);
    for (var side = 0u; side < select(1u, 3u, is_triplanar); side++) {
        var view = view_of(image.projection, point, normal, read, side);
        if HAS_CELLS {
            view.footprint = in_cell(image.projection, view.footprint, cell_of(texel, read));
        }
        for (var seen = 0u; seen < select(0u, 1u, view.weight > 0.0); seen++) {
            let value = view_value(view, frame);
            sum += view.weight * select(value, weighed(value), is_color);
            clear += view.weight * value.xyz;
        }
    }
    let value = select(sum.xyz, unweighed(sum, clear).xyz, is_color);
    textureStore(field, texel.xy, texel.z, stored(vec4f(value, 1.0)));
}
