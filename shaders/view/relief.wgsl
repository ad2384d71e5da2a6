//! Relief: lines of sight and of light are traced through the heights, across seams as well.
//!
//! A line descends from the highest height to the lowest in steps of at most a texel, and the intersection is interpolated
//! between the last two of them (relief mapping, Policarpo, Oliveira and Comba 2005).
//! @use atlas view/frame view/maps view/switches

// Steps of a line towards a light.
const LIGHT_STEPS: i32 = 12;

// A place on the relief.
struct Stand {
    texel: vec2f,
    page: i32,
    // Maps texel steps of the chart that the line began on to those of the current chart, column by column.
    axes: mat2x2f,
}

// A step of at most two texels of the chart that the line began on; from a ghost it continues on the other side of the seam.
fn stepped(stand: Stand, step: vec2f) -> Stand {
    var next = stand;
    next.texel += next.axes * step;
    for (var hop = 0; hop < 2; hop++) {
        let texel = vec3i(vec2i(floor(next.texel)), next.page);
        let owner = owner_of(texel);
        if owner == EMPTY || (owner & GHOST_BIT) == 0u {
            break;
        }
        let link = ghost_link(owner & ~GHOST_BIT);
        let over = mat2x2f(link.target_from_own.xy, link.target_from_own.zw);
        next.texel = link.target_texel + over * (next.texel - vec2f(texel.xy) - 0.5);
        next.page = i32(link.target_page);
        next.axes = over * next.axes;
    }
    return next;
}

fn height_there(stand: Stand) -> f32 {
    return value_at(heights, Place(stand.texel, stand.page)).x * frame.view_from_working;
}

// Texels that a line moves for each unit of height that it climbs; no more than the steps there are can go.
fn texels_a_climb(along_u: vec3f, along_v: vec3f, up: vec3f, towards: vec3f, depth: f32, steps: i32) -> vec2f {
    let volume = dot(along_u, cross(along_v, up));
    let climb = dot(towards, cross(along_u, along_v)) / volume;
    let across = vec2f(dot(towards, cross(along_v, up)), dot(towards, cross(up, along_u))) / volume;
    let slope = across / select(min(climb, -1e-3), max(climb, 1e-3), climb > 0.0);
    let texels = length(slope) * depth;
    let is_sound = abs(volume) > 1e-30 && texels < 1e6;
    return select(vec2f(0.0), slope * min(1.0, f32(steps) / max(texels, 1e-6)), is_sound);
}

// Share of a light that the relief lets through to a place: a line that stays well below a height on its way is dark.
fn through_relief(place: Place, up: vec3f, to_light: vec3f) -> f32 {
    let stand = Stand(place.texel, place.page, mat2x2f(1.0, 0.0, 0.0, 1.0));
    let owner = owner_of(vec3i(vec2i(floor(stand.texel)), stand.page));
    let reach = frame.heights * frame.view_from_working;
    if !has_map(HEIGHT_MAP) || owner == EMPTY || (owner & GHOST_BIT) != 0u {
        return 1.0;
    }
    let g = owner * GEOMETRY_ROWS;
    let along_u = geometry_row(g + 1u).xyz * frame.view_from_working;
    let along_v = geometry_row(g + 2u).xyz * frame.view_from_working;
    let start = height_there(stand);
    let depth = reach.y - start;
    if depth <= 1e-7 {
        return 1.0;
    }
    let slope = texels_a_climb(along_u, along_v, up, to_light, depth, LIGHT_STEPS);
    var there = stand;
    let steps = clamp(i32(ceil(length(slope) * depth)), 1, LIGHT_STEPS);
    let climb = depth / f32(steps);
    var dark = 0.0;
    for (var step = 1; step <= steps; step++) {
        there = stepped(there, slope * climb);
        let buried = height_there(there) - (start + climb * f32(step));
        // Softer the further away it is, as from a lamp of some width.
        dark = max(dark, buried / (depth * (0.05 + 0.2 * f32(step) / f32(steps))));
    }
    return 1.0 - clamp(dark, 0.0, 1.0);
}
