//! Size of a node's code with all calls expanded.

use naga::{Function, Handle, Module, Statement};

use super::walk::visit;

/// Expressions of one evaluation of `roots`, calls expanded, loops counted once.
pub(super) fn cost(module: &Module, roots: &[Handle<Function>]) -> u32 {
    // naga lists callees before their callers.
    let mut costs: Vec<u32> = Vec::with_capacity(module.functions.len());
    for (_, function) in module.functions.iter() {
        let mut cost = function.expressions.len() as u32;
        visit(&function.body, &mut |statement, _| {
            if let Statement::Call { function, .. } = statement {
                cost = cost.saturating_add(costs[function.index()]);
            }
        });
        costs.push(cost);
    }
    roots
        .iter()
        .fold(0, |sum: u32, root| sum.saturating_add(costs[root.index()]))
}
