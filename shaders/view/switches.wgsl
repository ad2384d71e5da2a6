//! What a pipeline is made for. Branches on what all pixels share ask these, which costs nothing, and never a uniform buffer alone:
//! Mesa's software driver builds such a shader anew at every draw, and keeps all of them.

// What is shown, see `modes.wgsl`.
override MODE: u32 = 0u;
// Which maps a material has: 1 color, 2 surface, 4 emission, 8 normal, 16 height.
override MAPS: u32 = 0u;
// The type of a node's own result, see `show.wgsl`.
override SHOWN_TYPE: u32 = 0u;
// How many lights there are besides the environment, and which of them throw shadows, the first in the lowest bit.
override LIGHT_COUNT: u32 = 0u;
override SHADOWS_OF: u32 = 0u;

fn has_map(bit: u32) -> bool {
    return (MAPS & bit) != 0u;
}
