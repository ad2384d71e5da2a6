// Rays through a tree of two boxes a node, nearer one first, done at the first hit: what the wide tree is measured against.

struct Rays {
    count: u32,
    row_length: u32,
}

struct Ray {
    origin: vec3f,
    reach: f32,
    direction: vec3f,
    pad: f32,
}

@group(0) @binding(0) var<uniform> rays: Rays;
// Four rows a node: low corner and reference, high corner and number of triangles, of its left side and of its right. A
// side without triangles refers to a node, else to its first triangle.
@group(0) @binding(1) var nodes: texture_2d<u32>;
// Three rows a triangle: a corner and the edges from it.
@group(0) @binding(2) var triangles: texture_2d<u32>;
@group(0) @binding(3) var<storage, read> shot: array<Ray>;
@group(0) @binding(4) var<storage, read_write> hits: array<vec2u>;

fn node_row(row: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(nodes, table_texel(row), 0));
}

fn triangle_row(row: u32) -> vec3f {
    return bitcast<vec4f>(textureLoad(triangles, table_texel(row), 0)).xyz;
}

fn entry(low: vec3f, high: vec3f, origin: vec3f, inverse: vec3f, reach: f32) -> f32 {
    let one = (low - origin) * inverse;
    let two = (high - origin) * inverse;
    let near = min(one, two);
    let far = max(one, two);
    let enter = max(max(near.x, near.y), max(near.z, 0.0));
    let leave = min(min(far.x, far.y), min(far.z, reach));
    return select(1e30, enter, enter <= leave * 1.0000005);
}

fn meets(first: u32, count: u32, ray: Ray) -> bool {
    for (var index = first; index < first + count; index++) {
        let corner = triangle_row(index * 3u);
        let one = triangle_row(index * 3u + 1u);
        let two = triangle_row(index * 3u + 2u);
        let across = cross(ray.direction, two);
        let inverse = 1.0 / dot(one, across);
        let away = ray.origin - corner;
        let u = dot(away, across) * inverse;
        let side = cross(away, one);
        let v = dot(ray.direction, side) * inverse;
        let distance = dot(two, side) * inverse;
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= 0.0 && distance <= ray.reach {
            return true;
        }
    }
    return false;
}

fn any_hit(ray: Ray) -> bool {
    let inverse = 1.0 / select(ray.direction, vec3f(1e-12), abs(ray.direction) < vec3f(1e-12));
    var stack: array<u32, 48>;
    var depth = 0u;
    var node = 0u;
    var is_hit = false;
    var is_done = false;
    while !is_done {
        let left_low = node_row(node * 4u);
        let left_high = node_row(node * 4u + 1u);
        let right_low = node_row(node * 4u + 2u);
        let right_high = node_row(node * 4u + 3u);
        var left = entry(left_low.xyz, left_high.xyz, ray.origin, inverse, ray.reach);
        var right = entry(right_low.xyz, right_high.xyz, ray.origin, inverse, ray.reach);
        let left_count = bitcast<u32>(left_high.w);
        let right_count = bitcast<u32>(right_high.w);
        if left < 1e30 && left_count > 0u {
            is_hit = meets(bitcast<u32>(left_low.w), left_count, ray);
            left = 1e30;
        }
        if !is_hit && right < 1e30 && right_count > 0u {
            is_hit = meets(bitcast<u32>(right_low.w), right_count, ray);
            right = 1e30;
        }
        let is_left_first = left <= right;
        let near = select(bitcast<u32>(right_low.w), bitcast<u32>(left_low.w), is_left_first);
        let far = select(bitcast<u32>(left_low.w), bitcast<u32>(right_low.w), is_left_first);
        if max(left, right) < 1e30 {
            stack[min(depth, 47u)] = far;
            depth += 1u;
        }
        if is_hit {
            is_done = true;
        } else if min(left, right) < 1e30 {
            node = near;
        } else if depth == 0u {
            is_done = true;
        } else {
            depth -= 1u;
            node = stack[min(depth, 47u)];
        }
    }
    return is_hit;
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let index = (group.y * rays.row_length + group.x) * 64u + local.x;
    if index < rays.count {
        hits[index] = vec2u(select(0xbf800000u, 0u, any_hit(shot[index])), 0xffffffffu);
    }
}
