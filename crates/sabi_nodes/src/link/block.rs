//! Layout of a kernel's parameter block.

use sabi_graph::PortType;

use crate::kind::{InputDefault, Kind};

/// Alignment of a struct in the block.
const STRUCT_ALIGN: u32 = 16;

/// Byte layout of a kernel's parameter block, by WGSL's rules for the uniform address space.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockLayout {
    /// Size in bytes, at least 16.
    pub size: u32,
    /// Offset of the four flag words, which come first; `None` for a kernel without switches.
    pub flags: Option<u32>,
    /// Layout for each block of the calls.
    pub calls: Vec<CallLayout>,
}

/// Offsets of one node's values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CallLayout {
    /// Offset of `struct Params`; `None` if the kind has no parameters.
    pub params: Option<u32>,
    /// Offset of each knob in the block, by index of the input; `None` for inputs without a knob.
    pub knobs: Vec<Option<u32>>,
}

impl BlockLayout {
    /// Computes the layout for these kinds, one for each block index.
    pub(super) fn new<'a>(kinds: impl Iterator<Item = &'a Kind>, with_flags: bool) -> BlockLayout {
        let mut end = 0_u32;
        let flags = with_flags.then(|| place(&mut end, 16, 16));
        let calls = kinds
            .map(|kind| {
                let params = (kind.params_size > 0).then(|| place(&mut end, kind.params_size, STRUCT_ALIGN));
                CallLayout {
                    params,
                    knobs: knob_offsets(kind, &mut end),
                }
            })
            .collect();
        BlockLayout {
            size: end.next_multiple_of(16).max(16),
            flags,
            calls,
        }
    }
}

/// Lists the members of the knob struct of a kind: input name and WGSL type.
pub(super) fn knob_members(kind: &Kind) -> Vec<(&str, &'static str)> {
    let knobs = kind
        .inputs
        .iter()
        .filter(|input| matches!(input.default, InputDefault::Knob(_)));
    knobs
        .map(|input| {
            (
                input.name.as_str(),
                if input.ty == PortType::Mask { "f32" } else { "vec3f" },
            )
        })
        .collect()
}

fn knob_offsets(kind: &Kind, end: &mut u32) -> Vec<Option<u32>> {
    let is_knob = |default: &InputDefault| matches!(default, InputDefault::Knob(_));
    if knob_members(kind).is_empty() {
        return vec![None; kind.inputs.len()];
    }
    *end = end.next_multiple_of(STRUCT_ALIGN);
    kind.inputs
        .iter()
        .map(|input| {
            is_knob(&input.default).then(|| match input.ty {
                PortType::Mask => place(end, 4, 4),
                _ => place(end, 12, 16),
            })
        })
        .collect()
}

fn place(end: &mut u32, size: u32, align: u32) -> u32 {
    let start = end.next_multiple_of(align);
    *end = start + size;
    start
}
