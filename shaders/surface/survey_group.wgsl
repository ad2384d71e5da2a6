//! Constants of a survey, and the group that a texel is measured with: the whole surface, its part, its piece or its chart.
//! @use atlas survey

struct Survey {
    // Count for a unit of area.
    count_per_area: f32,
    // What is measured apart, as `each` of nodes: 0 nothing, 1 parts, 2 pieces, 3 charts.
    each: u32,
    // Number of groups; numbers go around.
    groups: u32,
    pad: u32,
}

// Counts of a group: lowest and highest key, and one for each step.
const SURVEY_COUNTS: u32 = 2u + u32(SURVEY_STEPS);

// First count of the group of a triangle.
fn survey_counts_of(triangle: u32, survey: Survey) -> u32 {
    let frame = triangle * FRAME_ROWS;
    let part = bitcast<u32>(geometry_row(triangle * GEOMETRY_ROWS + 3u).w);
    var number = 0u;
    switch survey.each {
        case 1u: { number = part; }
        case 2u: { number = bitcast<u32>(frame_row(frame + 3u).w); }
        case 3u: { number = bitcast<u32>(frame_row(frame).w); }
        default: {}
    }
    return (number % survey.groups) * SURVEY_COUNTS;
}
