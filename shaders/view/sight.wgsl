//! Lines of sight through the relief.
//! @use atlas view/corner view/frame view/maps view/relief

// Steps of a line of sight.
const SIGHT_STEPS: i32 = 64;

// Intersection of a line of sight with the relief, near the place where it meets the surface; `towards` is its direction.
fn met(seen: Seen, place: Place, towards: vec3f) -> Stand {
    let start = Stand(place.texel, place.page, mat2x2f(1.0, 0.0, 0.0, 1.0));
    // The triangle's texel steps, by how place and texel change over the picture.
    let across = vec4f(dpdx(seen.texel), dpdy(seen.texel));
    let determinant = across.x * across.w - across.y * across.z;
    let right = dpdx(seen.position);
    let down = dpdy(seen.position);
    let along_u = (right * across.w - down * across.y) / determinant;
    let along_v = (down * across.x - right * across.z) / determinant;
    let reach = frame.heights * frame.view_from_working;
    let depth = reach.y - reach.x;
    let up = unit_or(seen.normal, vec3f(0.0, 1.0, 0.0));
    // One condition, see `switches.wgsl`: its first half asks a uniform buffer alone.
    if (depth <= 0.0) | (abs(determinant) < 1e-20) {
        return start;
    }
    let slope = texels_a_climb(along_u, along_v, up, towards, depth, SIGHT_STEPS);
    // Back to the place where the line enters at the highest height.
    var before = start;
    let back = slope * reach.y;
    let back_steps = i32(ceil(min(length(back), f32(SIGHT_STEPS))));
    for (var step = 0; step < back_steps; step++) {
        before = stepped(before, back / f32(back_steps));
    }
    let steps = clamp(i32(ceil(length(slope) * depth)), 1, SIGHT_STEPS);
    let fall = depth / f32(steps);
    var above = reach.y - height_there(before);
    var line = reach.y;
    for (var step = 0; step < steps; step++) {
        let next = stepped(before, -slope * fall);
        let left = line - fall - height_there(next);
        if left <= 0.0 {
            return between(before, -slope * fall, above, left);
        }
        before = next;
        above = left;
        line -= fall;
    }
    return before;
}

// The place between two steps, the line above the height at the first by one number and by another, below 0, at the second.
fn between(first: Stand, step: vec2f, above: f32, below: f32) -> Stand {
    return stepped(first, step * clamp(above / max(above - below, 1e-12), 0.0, 1.0));
}

// The surface's own frame at a place, as the model has it there.
struct Basis {
    normal: vec3f,
    tangent: vec3f,
    // As in `Seen`.
    chart: u32,
}

fn basis_there(stand: Stand, otherwise: Basis) -> Basis {
    let owner = owner_of(vec3i(vec2i(floor(stand.texel)), stand.page));
    if owner == EMPTY || (owner & GHOST_BIT) != 0u {
        return otherwise;
    }
    let g = owner * GEOMETRY_ROWS;
    let f = owner * FRAME_ROWS;
    let step = stand.texel - vec2f(geometry_row(g).w, geometry_row(g + 1u).w);
    let normal = geometry_row(g + 3u).xyz + geometry_row(g + 4u).xyz * step.x + geometry_row(g + 5u).xyz * step.y;
    let along_u = frame_row(f + 1u);
    let tangent = frame_row(f).xyz + along_u.xyz * step.x + frame_row(f + 2u).xyz * step.y;
    let chart = 2u * bitcast<u32>(frame_row(f + 3u).z) + select(0u, 1u, bitangent_sign_of(along_u.w) < 0.0);
    return Basis(normal, tangent, chart);
}

