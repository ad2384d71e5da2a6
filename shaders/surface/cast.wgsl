//! Follows rays through an eight-way tree of boxes that are compressed to eight bits a side (Ylitie, Karras and Laine,
//! "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017), in the layout of the crate obvhs.
//! @use atlas rays

struct Casting {
    // From working units to the tree's own: (point − center) × scale.
    center: vec3f,
    scale: f32,
    rays: u32,
    row_length: u32,
    // 1 where the nearest hit is asked for, 0 where any will do.
    is_nearest: u32,
}

@group(1) @binding(0) var<uniform> casting: Casting;
// Five rows a node.
@group(1) @binding(1) var tree_nodes: texture_2d<u32>;
// Three rows a triangle: its first corner with its number, the edge to it from the second, and the edge from it to the third.
@group(1) @binding(2) var tree_triangles: texture_2d<u32>;
@group(1) @binding(3) var<storage, read> cast_rays: array<StoredRay>;
@group(1) @binding(4) var<storage, read_write> cast_hits: array<RayHit>;

// Deeper trees are not uploaded.
const STACK: u32 = 24u;
const NODE_ROWS: u32 = 5u;
const TRIANGLE_ROWS: u32 = 3u;
const WITH_CHILDREN: u32 = 0xff000000u;

fn node_row(row: u32) -> vec4u {
    return textureLoad(tree_nodes, table_texel(row), 0);
}

fn triangle_row(row: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(tree_triangles, table_texel(row), 0));
}

// The four bytes of a word.
fn bytes_of(word: u32) -> vec4u {
    return (vec4u(word) >> vec4u(0u, 8u, 16u, 24u)) & vec4u(0xffu);
}

// A ray in the tree's own units.
struct Path {
    origin: vec3f,
    direction: vec3f,
    inverse: vec3f,
    // Sides of boxes that it meets last, as masks.
    is_negative: vec3<bool>,
    // Order of a node's children along it.
    octant: u32,
}

// One number for each axis, so that no component is divided by zero.
fn inverse_of(direction: vec3f) -> vec3f {
    let least = vec3f(1.1920929e-7);
    let away = select(least, -least, direction < vec3f(0.0));
    return 1.0 / select(direction, away, abs(direction) <= least);
}

// Which of four children a ray meets: for each its bits of the node's mask.
fn met(path: Path, reach: f32, scale: vec3f, start: vec3f, meta_word: u32, low: vec3u, high: vec3u) -> u32 {
    let near_x = vec4f(bytes_of(select(low.x, high.x, path.is_negative.x)));
    let near_y = vec4f(bytes_of(select(low.y, high.y, path.is_negative.y)));
    let near_z = vec4f(bytes_of(select(low.z, high.z, path.is_negative.z)));
    let far_x = vec4f(bytes_of(select(high.x, low.x, path.is_negative.x)));
    let far_y = vec4f(bytes_of(select(high.y, low.y, path.is_negative.y)));
    let far_z = vec4f(bytes_of(select(high.z, low.z, path.is_negative.z)));
    let enter = max(max(near_x * scale.x + start.x, near_y * scale.y + start.y), max(near_z * scale.z + start.z, vec4f(0.0)));
    let leave = min(min(far_x * scale.x + start.x, far_y * scale.y + start.y), min(far_z * scale.z + start.z, vec4f(reach)));
    // A little longer than computed: rounding must not lose triangles that lie in a side of a box.
    let is_met = enter <= leave * 1.0000005;
    let entry = bytes_of(meta_word);
    let is_inner = (entry & (entry << vec4u(1u)) & vec4u(0x10u)) != vec4u(0u);
    let index = (entry ^ select(vec4u(0u), vec4u(path.octant), is_inner)) & vec4u(31u);
    let bits = select(vec4u(0u), (entry >> vec4u(5u)) << index, is_met);
    return bits.x | bits.y | bits.z | bits.w;
}

// All children of a node that a ray meets: nodes in the highest eight bits, nearest first, triangles below.
fn met_children(path: Path, reach: f32, header: vec4u, links: vec4u, row: u32) -> u32 {
    let exponents = bytes_of(header.w);
    let step = bitcast<vec3f>(exponents.xyz << vec3u(23u));
    let scale = step * path.inverse;
    let start = (bitcast<vec3f>(header.xyz) - path.origin) * path.inverse;
    let x = node_row(row + 2u);
    let y = node_row(row + 3u);
    let z = node_row(row + 4u);
    return met(path, reach, scale, start, links.z, vec3u(x.x, y.x, z.x), vec3u(x.z, y.z, z.z))
        | met(path, reach, scale, start, links.w, vec3u(x.y, y.y, z.y), vec3u(x.w, y.w, z.w));
}

// How far a triangle is along a ray, below 0 where the ray misses it (Möller and Trumbore, 1997).
fn distance_to(corner: vec3f, one: vec3f, two: vec3f, path: Path) -> f32 {
    let normal = cross(one, two);
    let away = corner - path.origin;
    let side = cross(path.direction, away);
    let determinant = dot(normal, path.direction);
    let inverse = 1.0 / determinant;
    let u = dot(side, two) * inverse;
    let v = dot(side, one) * inverse;
    let is_inside = determinant != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    return select(-1.0, dot(normal, away) * inverse, is_inside);
}

fn cast_ray(ray: Ray) -> RayHit {
    var best = RayHit(-1.0, 0xffffffffu);
    let size = length(ray.direction);
    var reach = ray.reach * casting.scale;
    // Rays that are no numbers hit nothing: they would enter every box.
    if !(reach > 0.0 && size > 0.0 && size < 1e30 && all(abs(ray.origin) < vec3f(1e30))) {
        return best;
    }
    let direction = ray.direction / size;
    let is_negative = direction < vec3f(0.0);
    let order = select(vec3u(4u, 2u, 1u), vec3u(0u), is_negative);
    let octant = order.x | order.y | order.z;
    let path = Path((ray.origin - casting.center) * casting.scale, direction, inverse_of(direction), is_negative, octant);
    var stack: array<vec2u, STACK>;
    var depth = 0u;
    // The root is the only child of a node that is none.
    var nodes = vec2u(0u, 0x80000000u);
    var is_done = false;
    while !is_done {
        // Its nearest child that is left, and the rest for later.
        let bit = firstLeadingBit(nodes.y);
        let slot = (bit - 24u) ^ octant;
        let child = nodes.x + countOneBits(nodes.y & ~(0xffffffffu << slot));
        nodes.y &= ~(1u << bit);
        if (nodes.y & WITH_CHILDREN) != 0u {
            stack[min(depth, STACK - 1u)] = nodes;
            depth += 1u;
        }
        let row = child * NODE_ROWS;
        let header = node_row(row);
        let links = node_row(row + 1u);
        let children = met_children(path, reach, header, links, row);
        nodes = vec2u(links.x, (children & WITH_CHILDREN) | (header.w >> 24u));
        var triangles = children & ~WITH_CHILDREN;
        while triangles != 0u {
            let of_node = firstLeadingBit(triangles);
            triangles &= ~(1u << of_node);
            let at = (links.y + of_node) * TRIANGLE_ROWS;
            let corner = triangle_row(at);
            let distance = distance_to(corner.xyz, triangle_row(at + 1u).xyz, triangle_row(at + 2u).xyz, path);
            if distance >= 0.0 && distance <= reach {
                best = RayHit(distance, bitcast<u32>(corner.w));
                reach = distance;
                is_done = casting.is_nearest == 0u;
                triangles = select(triangles, 0u, is_done);
            }
        }
        if !is_done && (nodes.y & WITH_CHILDREN) == 0u {
            is_done = depth == 0u;
            if !is_done {
                depth -= 1u;
                nodes = stack[min(depth, STACK - 1u)];
            }
        }
    }
    best.distance = select(-1.0, best.distance / casting.scale, best.distance >= 0.0);
    return best;
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let index = (group.y * casting.row_length + group.x) * 64u + local.x;
    if index < casting.rays {
        cast_hits[index] = cast_ray(ray_of(cast_rays[index]));
    }
}
