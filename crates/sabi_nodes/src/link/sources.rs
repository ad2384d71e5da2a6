//! The part of a kernel that comes from node files: their texts with names kept apart, and the parameter block.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::block::knob_members;
use super::rename::with_prefix;
use crate::kind::{Kind, Memory};

/// Names that keep kinds apart in one module.
///
/// A kind's own names get a prefix that begins with its number, generated ones begin with `gen_`, so neither two kinds
/// nor a kind and the generated code can mean the same name.
pub(super) struct Names<'a> {
    ids: Vec<&'a str>,
}

impl<'a> Names<'a> {
    pub(super) fn of(kinds: &[&'a Kind]) -> Names<'a> {
        let ids: BTreeSet<&str> = kinds.iter().map(|kind| kind.id.as_str()).collect();
        Names {
            ids: ids.into_iter().collect(),
        }
    }

    fn number(&self, kind: &Kind) -> usize {
        self.ids.iter().position(|id| *id == kind.id).unwrap_or_default()
    }

    /// What stands before every name of the kind's own.
    pub(super) fn prefix(&self, kind: &Kind) -> String {
        let readable: String = kind
            .id
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .collect();
        format!("n{}_{readable}__", self.number(kind))
    }

    /// The generated function that keeps parameters inside their loops' ranges.
    pub(super) fn bounded(&self, kind: &Kind) -> String {
        format!("gen_bounded_{}", self.number(kind))
    }

    /// The generated struct of knobs.
    pub(super) fn knobs(&self, kind: &Kind) -> String {
        format!("gen_knobs_{}", self.number(kind))
    }
}

pub(super) fn write_sources(out: &mut String, blocks: &BTreeMap<usize, &Kind>, names: &Names<'_>) {
    let mut written = BTreeSet::new();
    for kind in blocks.values() {
        if !written.insert(&kind.id) {
            continue;
        }
        out.push_str(&with_prefix(&kind.source, &names.prefix(kind)));
        let knobs = knob_members(kind);
        if !knobs.is_empty() {
            let _ = writeln!(out, "struct {} {{", names.knobs(kind));
            for (name, ty) in knobs {
                let _ = writeln!(out, "    {name}: {ty},");
            }
            out.push_str("}\n");
        }
        write_bounded(out, kind, names);
    }
}

/// A function that keeps loop-bounding parameters inside their range, whatever the buffer holds.
fn write_bounded(out: &mut String, kind: &Kind, names: &Names<'_>) {
    if kind.params_size == 0 {
        return;
    }
    let (prefix, name) = (names.prefix(kind), names.bounded(kind));
    let _ = writeln!(
        out,
        "fn {name}(params: {prefix}Params) -> {prefix}Params {{\n    var bounded = params;"
    );
    for param in kind.params.iter().filter(|param| param.bounds_a_loop) {
        if let Some([low, high]) = param.ty.range {
            let suffix = if param.ty.memory == Memory::U32 { "u" } else { "i" };
            let (name, low, high) = (&param.name, low as i64, high as i64);
            let _ = writeln!(
                out,
                "    bounded.{name} = clamp(bounded.{name}, {low}{suffix}, {high}{suffix});"
            );
        }
    }
    out.push_str("    return bounded;\n}\n");
}

pub(super) fn write_block(out: &mut String, blocks: &BTreeMap<usize, &Kind>, names: &Names<'_>, switches: bool) {
    out.push_str("struct Block {\n");
    let empty = out.len();
    if switches {
        out.push_str("    flags: vec4u,\n");
    }
    for (index, kind) in blocks {
        if kind.params_size > 0 {
            let _ = writeln!(out, "    params_{index}: {}Params,", names.prefix(kind));
        }
        if !knob_members(kind).is_empty() {
            let _ = writeln!(out, "    knobs_{index}: {},", names.knobs(kind));
        }
    }
    if out.len() == empty {
        out.push_str("    unused: vec4u,\n");
    }
    out.push_str("}\n@group(1) @binding(0) var<storage, read> block: Block;\n");
}
