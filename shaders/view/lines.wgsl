//! Lines over the model, so many pixels wide.
//! @use view/frame

struct LineStyle {
    // Scene-referred linear color; w is the width in pixels.
    color: vec4f,
    // The picture's size in pixels, and how much nearer than they are lines are drawn.
    size: vec2f,
    nearer: f32,
    pad: f32,
}

@group(1) @binding(0) var<uniform> style: LineStyle;

// Ends of a line.
struct Line {
    @location(0) first: vec3f,
    @location(1) second: vec3f,
}

@vertex
fn place_end(@builtin(vertex_index) index: u32, line: Line) -> @builtin(position) vec4f {
    let a = frame.clip_from_view * vec4f(line.first, 1.0);
    let b = frame.clip_from_view * vec4f(line.second, 1.0);
    // Two triangles: the first end once, the second end twice, and so on around.
    let is_second = index == 1u || index == 2u || index == 4u;
    let side = select(-1.0, 1.0, index == 2u || index == 4u || index == 5u);
    let clip = select(a, b, is_second);
    let a_px = a.xy / max(a.w, 1e-6) * style.size;
    let b_px = b.xy / max(b.w, 1e-6) * style.size;
    let along = b_px - a_px;
    let across = vec2f(-along.y, along.x) / max(length(along), 1e-6);
    let moved = across * side * style.color.w / style.size;
    // Depth is reversed: nearer is more.
    return vec4f(clip.xy + moved * clip.w, clip.z * (1.0 + style.nearer), clip.w);
}

@fragment
fn paint() -> @location(0) vec4f {
    return vec4f(style.color.xyz, 1.0);
}
