//! Reconstruction of a texel's place on the surface from the linked atlas, and of what is stored for it. Linked to every
//! kernel.
//! @use core atlas

// Texels along a side of a tile, each of which a workgroup covers.
const TILE: u32 = 8u;

fn texel_of(group: vec3u, local: vec3u) -> vec3i {
    let index = dispatch.first_tile + group.y * dispatch.row_length + group.x;
    if index >= dispatch.end_tile {
        return vec3i(-1);
    }
    // column: 11 bits, row: 11 bits, page: 10 bits
    let tile = tiles[index];
    let corner = vec2u(tile & 0x7ffu, (tile >> 11u) & 0x7ffu) * TILE;
    return vec3i(vec2i(corner + local.xy), i32(tile >> 22u));
}

// The triangle under a texel, and where on its chart the texel's surface point lies.
struct Spot {
    triangle: u32,
    point: vec2f,
    // The texel axes of the chart that reads it, in texels of the triangle's chart, column by column.
    axes: vec4f,
}

fn spot_of(texel: vec3i, owner: u32) -> Spot {
    if (owner & GHOST_BIT) != 0u {
        let link = ghost_link(owner & ~GHOST_BIT);
        return Spot(link.triangle, link.target_texel, link.target_from_own);
    }
    return Spot(owner, vec2f(texel.xy) + 0.5, vec4f(1.0, 0.0, 0.0, 1.0));
}

fn surface_at(texel: vec3i, owner: u32) -> Surface {
    let spot = spot_of(texel, owner);
    let g = spot.triangle * GEOMETRY_ROWS;
    let f = spot.triangle * FRAME_ROWS;
    let origin = geometry_row(g);
    let along_u = geometry_row(g + 1u);
    let along_v = geometry_row(g + 2u);
    let normal = geometry_row(g + 3u);
    let normal_u = geometry_row(g + 4u);
    let normal_v = geometry_row(g + 5u);
    let tangent = frame_row(f);
    let tangent_u = frame_row(f + 1u);
    let tangent_v = frame_row(f + 2u);
    let chart = frame_row(f + 3u);
    let step = spot.point - vec2f(origin.w, along_u.w);
    let face = face_along(along_u, along_v);
    let shading = unit_or(normal.xyz + normal_u.xyz * step.x + normal_v.xyz * step.y, face);
    let direction = tangent.xyz + tangent_u.xyz * step.x + tangent_v.xyz * step.y;
    // A ghost is read by its own chart, so its detail fades with that chart's texels: with those over the seam, coarser or
    // finer, every seam between charts of different density would show as a step.
    let axes = spot.axes;
    let texel_step = along_u.xyz * axes.x + along_v.xyz * axes.y;
    let texel_rise = along_u.xyz * axes.z + along_v.xyz * axes.w;
    let across = max(length(texel_step), length(texel_rise));
    let texel_size = select(abs(along_v.w), across, (owner & GHOST_BIT) != 0u);
    let position = origin.xyz + along_u.xyz * step.x + along_v.xyz * step.y;
    let piece = bitcast<u32>(chart.w);
    return Surface(
        position,
        texel_size,
        shading,
        bitcast<u32>(tangent.w),
        face,
        bitcast<u32>(normal.w),
        vec4f(unit_or(direction, vec3f(1.0, 0.0, 0.0)), bitangent_sign_of(tangent_u.w)),
        (spot.point - chart.xy) / dispatch.size,
        bitcast<u32>(normal_u.w),
        bitcast<u32>(normal_v.w),
        along_sides(piece, position - piece_middle(piece)),
        tangent_v.w,
        piece,
        along_sides(piece, face),
        texel_step,
        texel_rise,
        texel,
    );
}

fn piece_middle(piece: u32) -> vec3f {
    let row = piece * PIECE_ROWS;
    return vec3f(pieces[row].w, pieces[row + 1u].w, pieces[row + 2u].w);
}

// A vector along the sides of a piece's own box.
fn along_sides(piece: u32, v: vec3f) -> vec3f {
    let row = piece * PIECE_ROWS;
    return vec3f(dot(pieces[row].xyz, v), dot(pieces[row + 1u].xyz, v), dot(pieces[row + 2u].xyz, v));
}

// A stored material. Channels without a bit in `present`, in storage order, are those of the plain material.
fn switched_material(
    present: u32, color: vec4f, surface: vec4f, height: f32, slope: vec3f, emission: vec3f,
) -> Material {
    var material = plain_material();
    if (present & 1u) != 0u {
        material.base_color = color.xyz;
        material.alpha = color.w;
    }
    if (present & 2u) != 0u {
        material.roughness = surface.x;
        material.metallic = surface.y;
        material.occlusion = surface.z;
    }
    if (present & 4u) != 0u { material.height = height; }
    if (present & 8u) != 0u { material.slope = slope; }
    if (present & 16u) != 0u { material.emission = emission; }
    return material;
}

// The same for the channels that few materials have.
fn with_rare_channels(
    usual: Material, present: u32, coat: vec4f, anisotropy: vec4f, sheen: vec4f, subsurface: vec4f,
) -> Material {
    var material = usual;
    if (present & 32u) != 0u {
        material.coat = coat.x;
        material.coat_roughness = coat.y;
    }
    if (present & 64u) != 0u { material.anisotropy = anisotropy.xyz; }
    if (present & 128u) != 0u {
        material.sheen = sheen.xyz;
        material.sheen_roughness = sheen.w;
    }
    if (present & 256u) != 0u {
        material.subsurface = subsurface.xyz;
        material.transmission = subsurface.w;
    }
    return material;
}

// A mask input: as it is (1), or the luminance of a color (3).
fn switched_mask(mode: u32, value: vec4f) -> f32 {
    return select(value.x, luminance(value.xyz), mode == 3u);
}

// A color input: as it is (1), or a gray mask (2).
fn switched_color(mode: u32, value: vec4f) -> vec3f {
    return select(value.xyz, value.xxx, mode == 2u);
}
