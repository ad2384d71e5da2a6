//! Relief
//! Sinks or raises a material without changing its color: holes, scratches, dents, broken edges, bumps.
//!
//! The mask decides where and how deep, from 0 to the full Depth; Profile decides the shape of a soft mask's border. Sunk
//! and Raised follow the mask itself. Dent and Bump are rounded. Groove and Ridge are rounded with material pushed aside:
//! a scratch with raised edges, a weld bead. Cut and Plateau have steep walls where the mask is one half,
//! and a flat floor or top: broken edges, flaked paint.
//! @alias relief height dent bump hole scratch groove carve emboss displace broken raise sink displacement
//! @use blend

struct Params {
    /// Depth or height of the relief; Height map is multiplied by it.
    /// @length @range -100 100 @soft 0 0.05 @default 0.005
    depth: f32,
    /// Shape of the mask's border, sunk in or raised.
    /// @choice sunk raised dent bump groove ridge cut plateau
    /// @default sunk
    profile: u32,
    /// Added to the roughness: the inside of a hole is dull, a worn dent shines.
    /// @range -1 1 @default 0
    roughness: f32,
}

// The share of the depth at a place, from 0 where the mask is 0 to 1 where it is 1; every second profile is raised.
fn profile_at(share: f32, profile: u32) -> f32 {
    let rounded = share * share * (3.0 - 2.0 * share);
    switch profile / 2u {
        case 0u: { return share; }
        case 1u: { return rounded; }
        case 2u: {
            // Takes as much away as makes a burr of a fifth of the depth, level at both ends.
            let beside = share * (1.0 - share);
            return rounded - 9.6 * beside * beside;
        }
        default: { return smoothstep(0.4, 0.6, share); }
    }
}

/// The material with the relief in it.
/// @input base The material underneath. @optional
/// @input mask Where the relief is. @optional @default 1
/// @input height_map Multiplies the depth. @optional @default 1
fn material(base: Material, mask: f32, height_map: f32, params: Params) -> Material {
    let weight = blend_weight(mask, 1.0);
    let side = select(-1.0, 1.0, params.profile % 2u == 1u);
    var result = base;
    result.height = base.height + side * params.depth * height_map * profile_at(weight, params.profile);
    result.roughness = clamp(base.roughness + params.roughness * weight, 0.0, 1.0);
    return result;
}
