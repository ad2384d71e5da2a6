//! Constants that every kernel over tiles reads.

use sabi_nodes::wgsl_struct;

wgsl_struct! {
    "atlas" Pass:
    /// Constants of a dispatch over tiles.
    pub(crate) struct PassConstants {
        pub(crate) first_tile: u32,
        pub(crate) end_tile: u32,
        pub(crate) row_length: u32,
        pub(crate) size: f32,
        pub(crate) round: u32,
        pub(crate) rounds: u32,
        pub(crate) texel: f32,
        pub(crate) finest: f32,
        pub(crate) farthest: f32,
        pub(crate) first_page: u32,
        pub(crate) first_row: u32,
        pub(crate) pad: u32,
    }
}
