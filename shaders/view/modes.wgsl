//! Modes of the viewport.

// The lit material.
const MATERIAL: u32 = 0u;
const BASE_COLOR: u32 = 1u;
const OPACITY: u32 = 2u;
const ROUGHNESS: u32 = 3u;
const METALLIC: u32 = 4u;
const OCCLUSION: u32 = 5u;
const HEIGHT: u32 = 6u;
const NORMAL: u32 = 7u;
const EMISSION: u32 = 8u;
const NODE: u32 = 9u;
const CHECKER: u32 = 10u;
const DENSITY: u32 = 11u;
const FACING: u32 = 12u;
const CLAY: u32 = 13u;
// Shift of the visible place by relief, texels; for tests.
const SHIFT: u32 = 14u;
const MODEL_NORMAL: u32 = 15u;
const COAT: u32 = 16u;
const COAT_ROUGHNESS: u32 = 17u;
const ANISOTROPY: u32 = 18u;
const SHEEN: u32 = 19u;
const SHEEN_ROUGHNESS: u32 = 20u;
const SUBSURFACE: u32 = 21u;
const TRANSMISSION: u32 = 22u;
const NODE_ON_CLAY: u32 = 23u;
