//! Borders of charts: ghosts beyond a jump of the data, which maps show with the nearest texel of their own chart.
//!
//! The rule is that of exported maps, see `ChartBorders` in `crates/sabi_export/src/borders.rs`; a test holds both against each other.
//! @use atlas

struct Borders {
    // Ghosts of the atlas.
    ghost_count: u32,
    // Workgroups along x.
    row_length: u32,
    // Word that is set where a ghost lies beyond a jump.
    place: u32,
    // 1 where the first three numbers of a texel are changed together.
    are_three_together: u32,
    // 1 where ghosts directly beside their chart stay as they are.
    keeps_first_ring: u32,
    // Multiple of the largest step of the chart up to which a ghost may differ, for each texel of its distance.
    steeper: f32,
    pad_0: u32,
    pad_1: u32,
}

@group(1) @binding(0) var<uniform> borders: Borders;
// For each ghost a bit for each texel around its anchor, row by row, that the chart owns, and the step from there, see `STEP_BIT`; 0 for
// ghosts that always stay as they are.
@group(1) @binding(1) var<storage, read> border_ghosts: array<u32>;
@group(1) @binding(2) var field: texture_2d_array<f32>;

// Texels on each side of an anchor that are looked at, and along a side of what is looked at.
const REACH: i32 = 2;
const SIDE: i32 = 5;
// First bit of the step from an anchor to its ghost, numbered like the texels around the anchor.
const STEP_BIT: u32 = 25u;

// What is shown for a ghost.
struct ShownGhost {
    value: vec4f,
    // Whether that is the value of its chart.
    is_changed: bool,
}

fn value_of(texel: vec3i) -> vec4f {
    return textureLoad(field, texel.xy, texel.z, 0);
}

fn is_own(own: u32, index: i32) -> bool {
    return ((own >> u32(index)) & 1u) != 0u;
}

// The largest differences between texels of the chart that lie side by side around an anchor.
fn steepest(anchor: vec3i, own: u32) -> vec4f {
    var most = vec4f(0.0);
    // Of the row above, up to the present column of the present row.
    var last: array<vec4f, 5>;
    for (var index = 0; index < SIDE * SIDE; index++) {
        if !is_own(own, index) {
            continue;
        }
        let column = index % SIDE;
        let here = value_of(anchor + vec3i(column - REACH, index / SIDE - REACH, 0));
        if index >= SIDE && is_own(own, index - SIDE) {
            most = steeper_of(most, here - last[column]);
        }
        if column > 0 && is_own(own, index - 1) {
            most = steeper_of(most, here - last[column - 1]);
        }
        last[column] = here;
    }
    return most;
}

// What is no number is no step.
fn steeper_of(most: vec4f, difference: vec4f) -> vec4f {
    return select(most, abs(difference), abs(difference) > most);
}

fn shown_ghost(index: u32) -> ShownGhost {
    let link = ghost_link(index);
    let texel = vec3i(i32(link.texel & 0xffffu), i32(link.texel >> 16u), i32(link.page));
    let row = border_ghosts[index];
    let own = value_of(texel);
    let at = i32(row >> STEP_BIT);
    let step = vec2i(at % SIDE, at / SIDE) - REACH;
    let is_kept = row == 0u || (borders.keeps_first_ring != 0u && all(abs(step) <= vec2i(1)));
    if is_kept {
        return ShownGhost(own, false);
    }
    let anchor = texel - vec3i(step, 0);
    let nearest = value_of(anchor);
    if all(own == nearest) {
        return ShownGhost(own, false);
    }
    let most = borders.steeper * length(vec2f(step)) * steepest(anchor, row);
    let jumps = abs(own - nearest) > most;
    let three = vec3<bool>(any(jumps.xyz));
    let changed = vec4<bool>(select(jumps.xyz, three, borders.are_three_together != 0u), jumps.w);
    return ShownGhost(select(own, nearest, changed), any(changed));
}
