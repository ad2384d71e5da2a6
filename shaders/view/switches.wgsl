//! Constants that each pipeline is specialized by. Branches that all pixels take alike test these, which costs nothing, and
//! never a uniform buffer alone: Mesa's software driver compiles a shader with such a branch at every draw, and keeps each.

// Mode, see `modes.wgsl`.
override MODE: u32 = 0u;
// Bits of the maps that a material has.
override MAPS: u32 = 0u;
// Type of a node's own result; 0 for a mask.
override SHOWN_TYPE: u32 = 0u;
// Number of lights besides the environment, and a bit for each that casts shadows, the first in the lowest bit.
override LIGHT_COUNT: u32 = 0u;
override SHADOWS_OF: u32 = 0u;
// 1 where the openness of the model is known.
override OPENNESS: u32 = 0u;

// Bits of `MAPS`.
const COLOR_MAP: u32 = 1u;
const SURFACE_MAP: u32 = 2u;
const EMISSION_MAP: u32 = 4u;
const NORMAL_MAP: u32 = 8u;
const HEIGHT_MAP: u32 = 16u;
const COAT_MAP: u32 = 32u;
const ANISOTROPY_MAP: u32 = 64u;
const SHEEN_MAP: u32 = 128u;
const SUBSURFACE_MAP: u32 = 256u;

// Types of a node's own result, besides masks.
const SHOWN_COLOR: u32 = 1u;
const SHOWN_VECTOR: u32 = 2u;

fn has_map(bit: u32) -> bool {
    return (MAPS & bit) != 0u;
}
