//! Size of a node's code with all calls expanded.

use naga::{Expression, Function, Handle, Module, Span, Statement, Type};

use super::walk::visit;
use crate::fault::Fault;
use crate::link::LinkedModule;

/// Most expressions of a node: a driver writes all calls out, and compiles about five thousand expressions a second.
const COST_LIMIT: u32 = 1 << 15;

/// Bytes of a value that a driver still keeps in registers; larger ones count by their fours of numbers.
const LARGE_BYTES: u32 = 1024;

/// Expressions of one evaluation of `roots`, calls expanded, loops counted once.
pub(super) fn cost(linked: &LinkedModule, module: &Module, roots: &[Handle<Function>]) -> Result<u32, Fault> {
    // naga lists callees before their callers.
    let mut costs: Vec<u32> = Vec::with_capacity(module.functions.len());
    for (_, function) in module.functions.iter() {
        let sizes = function
            .expressions
            .iter()
            .map(|(_, expression)| size(module, function, expression));
        let mut cost = sizes.fold(0, u32::saturating_add);
        visit(&function.body, &mut |statement, _| {
            if let Statement::Call { function, .. } = statement {
                cost = cost.saturating_add(costs[function.index()]);
            }
        });
        costs.push(cost);
    }
    let of_root = |root: &Handle<Function>| costs[root.index()];
    let all = roots.iter().map(of_root).fold(0, u32::saturating_add);
    if all <= COST_LIMIT {
        return Ok(all);
    }
    let largest = roots.iter().max_by_key(|root| of_root(root));
    let span = largest.map_or(Span::UNDEFINED, |root| module.functions.get_span(*root));
    Err(linked.fault(
        span,
        format!("The code is too long: with all calls written out it has {all} expressions; {COST_LIMIT} are allowed."),
        "Call long functions in a loop, or at fewer places.",
    ))
}

fn size(module: &Module, function: &Function, expression: &Expression) -> u32 {
    let ty: Option<Handle<Type>> = match expression {
        Expression::ZeroValue(ty) | Expression::Compose { ty, .. } => Some(*ty),
        Expression::CallResult(callee) => module.functions[*callee].result.as_ref().map(|result| result.ty),
        Expression::FunctionArgument(index) => function.arguments.get(*index as usize).map(|argument| argument.ty),
        Expression::Load { pointer } => match function.expressions[*pointer] {
            Expression::LocalVariable(local) => Some(function.local_variables[local].ty),
            _ => None,
        },
        _ => None,
    };
    let bytes = ty.map_or(0, |ty| module.types[ty].inner.size(module.to_ctx()));
    if bytes > LARGE_BYTES { bytes / 16 } else { 1 }
}
