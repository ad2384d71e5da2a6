//! The part of a kernel that comes from node files: their texts with prefixed names, and the parameter block.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::Call;
use super::block::knob_members;
use super::error::LinkError;
use super::module::LinkedModule;
use super::rename::with_prefix;
use crate::kind::{Kind, Memory, Output, Param, Role};

/// A kind that a kernel calls, with its number among all kinds of the kernel.
///
/// Names of a kind get a prefix that starts with this number, and generated names start with `gen_`. So two kinds, or a
/// kind and generated code, never have the same name.
#[derive(Clone, Copy)]
pub(super) struct Callee<'a> {
    pub(super) kind: &'a Kind,
    number: usize,
}

/// Returns the expression of a parameter multiplied by a mask between 0 and 1, clamped to the range of the parameter.
fn masked(param: &Param, value: &str, mask: &str) -> String {
    let Some(range) = param.ty.range else {
        return format!("{value} * clamp({mask}, 0.0, 1.0)");
    };
    match param.ty.role {
        // The range is not known in working units here. A length whose minimum is above 0 keeps at least a thousandth of its value.
        Role::Length => {
            let least = if range[0] > 0.0 { 1e-3 } else { 0.0 };
            format!("{value} * clamp({mask}, {least:?}, 1.0)")
        }
        _ => {
            let is_angle = param.ty.role == Role::Angle;
            let [low, high] = range.map(|end| if is_angle { end.to_radians() } else { end } as f32);
            format!("clamp({value} * clamp({mask}, 0.0, 1.0), {low:?}, {high:?})")
        }
    }
}

/// Numbers the kinds by the order of their ids.
pub(super) fn callees<'a>(kinds: &[&'a Kind]) -> Vec<Callee<'a>> {
    let ids: BTreeSet<&str> = kinds.iter().map(|kind| kind.id.as_str()).collect();
    let numbered = |kind: &&'a Kind| Callee {
        kind,
        number: ids.range(..kind.id.as_str()).count(),
    };
    kinds.iter().map(numbered).collect()
}

impl<'a> Callee<'a> {
    /// Returns the output or pass with this name.
    pub(super) fn function(&self, name: &str) -> Result<&'a Output, LinkError> {
        let passes = self.kind.passes.iter().map(|pass| &pass.function);
        let found = self
            .kind
            .outputs
            .iter()
            .chain(passes)
            .find(|function| function.name == name);
        found.ok_or_else(|| LinkError::UnknownFunction(self.kind.id.clone(), name.to_owned()))
    }

    /// Prefix of every name that the kind declares.
    pub(super) fn prefix(&self) -> String {
        let readable: String = self
            .kind
            .id
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .collect();
        format!("n{}_{readable}__", self.number)
    }

    /// Returns the name of the generated function that clamps parameters that bound loops to their ranges.
    fn bounded(&self) -> String {
        format!("gen_bounded_{}", self.number)
    }

    /// Writes the parameters of a call's block to a variable. Parameters that bound loops are clamped to their ranges,
    /// lengths are converted to working units, and parameters with a mask are multiplied by it. `at` is the name of the
    /// surface point; `masks` are expressions by index of the parameter.
    pub(super) fn write_bounded_params(&self, out: &mut String, call: &Call, at: &str, masks: &[(usize, String)]) {
        if self.kind.params_size == 0 {
            return;
        }
        let (name, block) = (self.bounded(), call.block);
        let unit = if call.by_piece {
            format!("{at}.piece_size")
        } else {
            "1.0".to_owned()
        };
        let keyword = if masks.is_empty() { "let" } else { "var" };
        let _ = writeln!(
            out,
            "    {keyword} bounded_{block} = {name}(block.params_{block}, {unit});"
        );
        for (param, mask) in masks {
            let param = &self.kind.params[*param];
            let masked = masked(param, &format!("bounded_{block}.{}", param.name), mask);
            let _ = writeln!(out, "    bounded_{block}.{} = {masked};", param.name);
        }
    }

    /// Returns the expression of a parameter of a block, clamped to its range. It does not depend on a surface point.
    pub(super) fn bounded_param(&self, block: usize, param: usize) -> String {
        format!(
            "{}(block.params_{block}, 1.0).{}",
            self.bounded(),
            self.kind.params[param].name
        )
    }

    /// Name of the generated struct of knobs.
    fn knobs(&self) -> String {
        format!("gen_knobs_{}", self.number)
    }
}

/// Appends the texts of the nodes to the module, and writes generated code for each to `out`.
pub(super) fn write_sources(module: &mut LinkedModule, out: &mut String, blocks: &BTreeMap<usize, Callee<'_>>) {
    let mut written = BTreeSet::new();
    for callee in blocks.values() {
        if !written.insert(&callee.kind.id) {
            continue;
        }
        module.push_node(&callee.kind.path, &with_prefix(&callee.kind.source, &callee.prefix()));
        let knobs = knob_members(callee.kind);
        if !knobs.is_empty() {
            let _ = writeln!(out, "struct {} {{", callee.knobs());
            for (name, ty) in knobs {
                let _ = writeln!(out, "    {name}: {ty},");
            }
            out.push_str("}\n");
        }
        write_bounding_function(out, *callee);
    }
}

/// Writes a function that clamps parameters that bound loops to their ranges, whatever values the buffer holds, and
/// multiplies lengths by their unit.
fn write_bounding_function(out: &mut String, callee: Callee<'_>) {
    if callee.kind.params_size == 0 {
        return;
    }
    let (prefix, name) = (callee.prefix(), callee.bounded());
    let _ = writeln!(
        out,
        "fn {name}(params: {prefix}Params, unit: f32) -> {prefix}Params {{\n    var bounded = params;"
    );
    let is_by_piece = |param: &&Param| param.ty.role == Role::Length && !param.is_absolute;
    for param in callee.kind.params.iter().filter(is_by_piece) {
        let _ = writeln!(out, "    bounded.{} *= unit;", param.name);
    }
    for param in callee.kind.params.iter().filter(|param| param.bounds_a_loop) {
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

/// Writes the struct with the values of all blocks, and its binding.
pub(super) fn write_block(out: &mut String, blocks: &BTreeMap<usize, Callee<'_>>, switches: bool) {
    out.push_str("struct Block {\n");
    let empty = out.len();
    if switches {
        out.push_str("    flags: vec4u,\n");
    }
    for (index, callee) in blocks {
        if callee.kind.params_size > 0 {
            let _ = writeln!(out, "    @align(16) params_{index}: {}Params,", callee.prefix());
        }
        if !knob_members(callee.kind).is_empty() {
            let _ = writeln!(out, "    @align(16) knobs_{index}: {},", callee.knobs());
        }
    }
    if out.len() == empty {
        out.push_str("    unused: vec4u,\n");
    }
    out.push_str("}\n@group(1) @binding(0) var<uniform> block: Block;\n");
}
