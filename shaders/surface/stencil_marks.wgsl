//! Marks that `stencil.wgsl` writes for each texel, and `normal.wgsl` and `anisotropy.wgsl` read. Six bits each: the step to the owned texel whose
//! triangle a ghost continues, and the step to the middle of three by three texels that the slope is taken over. Then a bit
//! for each of these nine: those that are ghosts, and those that lie over a hard edge. All are 0 where no ghost is near.

const FIRST_GHOST: u32 = 0x1000u;
const FIRST_OVER_EDGE: u32 = 0x200000u;
// A ghost without an owned texel near it.
const NO_STENCIL: u32 = 0x80000000u;

// Step from the middle of the nine texels to one of them.
fn step_of(index: i32) -> vec2i {
    return vec2i(index % 3 - 1, index / 3 - 1);
}

// A step as it is packed in the lowest six bits: two numbers of three bits with a sign.
fn unpacked_step(marks: u32) -> vec3i {
    let bits = bitcast<i32>(marks);
    return vec3i(extractBits(bits, 0u, 3u), extractBits(bits, 3u, 3u), 0);
}
