//! Size of a node's code with all calls expanded.

use naga::{Function, Handle, Module, Statement};

use super::walk::visit;

/// Expressions of one evaluation of `roots`, calls expanded, loops counted once.
pub(super) fn cost(module: &Module, roots: &[Handle<Function>]) -> u32 {
    // naga lists callees before their callers, so that none of the defaults below is taken.
    let mut costs: Vec<u32> = Vec::with_capacity(module.functions.len());
    for (_, function) in module.functions.iter() {
        let mut cost = function.expressions.len() as u32;
        visit(&function.body, &mut |statement, _| {
            if let Statement::Call { function, .. } = statement {
                cost = cost.saturating_add(costs.get(function.index()).copied().unwrap_or(0));
            }
        });
        costs.push(cost);
    }
    roots.iter().fold(0, |sum: u32, root| {
        sum.saturating_add(costs.get(root.index()).copied().unwrap_or(0))
    })
}
