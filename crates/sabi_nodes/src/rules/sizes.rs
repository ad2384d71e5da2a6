//! Limits on the memory of values: every texel that is evaluated at the same time has a copy of each value.

use naga::{Expression, Function, Handle, Module, Span, Type, TypeInner};

use crate::analysis::walk::expressions_with_spans;
use crate::fault::Fault;
use crate::link::LinkedModule;

/// Maximum number of bytes of a value, and of all variables of a function. More is far beyond what registers hold.
const LIMIT_BYTES: u32 = 16 * 1024;

const ADVICE: &str = "Compute less at a time; every texel has a copy of it.";

/// Checks the size of every value: of constants, arguments, results, variables and expressions.
pub(super) fn check(linked: &LinkedModule, module: &Module, faults: &mut Vec<Fault>) {
    let mut large: Vec<(Span, String)> = Vec::new();
    for (handle, constant) in module.constants.iter() {
        if size(module, constant.ty) > LIMIT_BYTES {
            let span = module.constants.get_span(handle);
            large.push((span, format!("The constant {}", quoted(constant.name.as_deref()))));
        }
    }
    for (handle, function) in module.functions.iter() {
        large_in_function(module, module.functions.get_span(handle), function, &mut large);
    }
    for (span, what) in large {
        let message = format!("{what} is larger than {} KiB.", LIMIT_BYTES / 1024);
        faults.push(linked.fault(span, message, ADVICE));
    }
}

fn large_in_function(module: &Module, span: Span, function: &Function, large: &mut Vec<(Span, String)>) {
    let name = quoted(function.name.as_deref());
    for argument in &function.arguments {
        if size(module, argument.ty) > LIMIT_BYTES {
            let argument = quoted(argument.name.as_deref());
            large.push((span, format!("The argument {argument} of {name}")));
        }
    }
    if let Some(result) = &function.result
        && size(module, result.ty) > LIMIT_BYTES
    {
        large.push((span, format!("The result of {name}")));
    }
    let before = large.len();
    let mut all: u64 = 0;
    for (handle, local) in function.local_variables.iter() {
        let bytes = size(module, local.ty);
        all += u64::from(bytes);
        if bytes > LIMIT_BYTES {
            let span = function.local_variables.get_span(handle);
            large.push((span, format!("The variable {}", quoted(local.name.as_deref()))));
        }
    }
    // All other expressions select a part of a value that is created here, or that is checked above.
    let is_large = |expression: &Expression| match expression {
        Expression::Compose { ty, .. } | Expression::ZeroValue(ty) => size(module, *ty) > LIMIT_BYTES,
        _ => false,
    };
    let made = expressions_with_spans(function).find(|(expression, _)| is_large(expression));
    large.extend(made.map(|(_, span)| (span, "This value".to_owned())));
    if large.len() == before && all > u64::from(LIMIT_BYTES) {
        large.push((span, format!("The memory of all variables of {name} together")));
    }
}

/// Returns the size in bytes of a value of a type, or of the value that a pointer points to.
fn size(module: &Module, ty: Handle<Type>) -> u32 {
    let inner = match &module.types[ty].inner {
        TypeInner::Pointer { base, .. } => &module.types[*base].inner,
        inner => inner,
    };
    inner.size(module.to_ctx())
}

fn quoted(name: Option<&str>) -> String {
    name.map_or_else(|| "here".to_owned(), |name| format!("`{name}`"))
}
