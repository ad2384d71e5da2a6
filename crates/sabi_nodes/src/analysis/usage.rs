//! Checks that the outputs depend on all parameters and inputs.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Expression, Function, Handle, LocalVariable, Module, Span, Statement, TypeInner};

use super::Root;
use super::walk::{Calls, Store, calls, children, stores, visit};
use crate::fault::Fault;
use crate::link::LinkedModule;
use crate::params::params_type;
use crate::scan::Scan;

/// Use of an argument by a function.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Use {
    /// Only these members; may be empty.
    Members(BTreeSet<u32>),
    /// The whole argument, or a use that the analysis cannot follow.
    Whole,
}

impl Use {
    fn is_none(&self) -> bool {
        matches!(self, Use::Members(members) if members.is_empty())
    }

    fn merge(&mut self, other: &Use) {
        match (&mut *self, other) {
            (Use::Members(own), Use::Members(others)) => own.extend(others),
            _ => *self = Use::Whole,
        }
    }
}

/// Checks that every member of `Params` is read by a root, and every input by its function.
///
/// `planned`: parameters that decide the number of runs, the width of texels or the number of rays; these count as read.
pub(super) fn check(
    linked: &LinkedModule,
    scan: &Scan,
    module: &Module,
    roots: &[Root<'_>],
    planned: &BTreeSet<u32>,
) -> Vec<Fault> {
    let uses = all_uses(module);
    let mut faults = Vec::new();
    let params = params_type(module).map(|(handle, _)| handle);
    let mut of_params = Use::Members(planned.clone());
    for root in roots {
        let arguments = module.functions[root.handle].arguments.iter().zip(&root.item.members);
        for ((argument, member), used) in arguments.zip(&uses[root.handle.index()]) {
            if Some(argument.ty) == params {
                of_params.merge(used);
            } else if used.is_none() && member.name != "at" {
                faults.push(linked.fault(
                    Span::from(member.name_range.clone()),
                    format!("The input `{}` has no effect on `{}`.", member.name, root.item.name),
                    "Use it, or remove the argument.",
                ));
            }
        }
    }
    if let (Use::Members(read), Some(item)) = (of_params, scan.params()) {
        for (index, member) in item.members.iter().enumerate() {
            if !read.contains(&(index as u32)) {
                faults.push(linked.fault(
                    Span::from(member.name_range.clone()),
                    format!("The parameter `{}` has no effect on any output.", member.name),
                    "Use it, or remove it.",
                ));
            }
        }
    }
    faults
}

/// Returns the indices of the parameters that a function reads. `count` is the total number of parameters.
pub(super) fn params_of(module: &Module, root: Handle<Function>, count: usize) -> Vec<usize> {
    let params = params_type(module).map(|(handle, _)| handle);
    let function = &module.functions[root];
    let mut of_params = Use::Members(BTreeSet::new());
    for (argument, used) in function.arguments.iter().zip(&all_uses(module)[root.index()]) {
        if Some(argument.ty) == params {
            of_params.merge(used);
        }
    }
    match of_params {
        Use::Members(members) => members.into_iter().map(|member| member as usize).collect(),
        Use::Whole => (0..count).collect(),
    }
}

/// Returns how each function uses its arguments.
fn all_uses(module: &Module) -> Vec<Vec<Use>> {
    // naga lists callees before their callers.
    let mut uses: Vec<Vec<Use>> = Vec::with_capacity(module.functions.len());
    for (_, function) in module.functions.iter() {
        let of = argument_uses(module, function, &uses);
        uses.push(of);
    }
    uses
}

/// Returns how a function uses its arguments, given how its callees use theirs.
fn argument_uses(module: &Module, function: &Function, callees: &[Vec<Use>]) -> Vec<Use> {
    let mut stores_of: BTreeMap<usize, Vec<Store>> = BTreeMap::new();
    for store in stores(function, &function.body) {
        stores_of.entry(store.local.index()).or_default().push(store);
    }
    let mut marker = LiveMarker {
        function,
        stores: stores_of,
        calls: calls(&function.body),
        callees,
        passed_on: BTreeSet::new(),
        live: vec![false; function.expressions.len()],
        uses: vec![Use::Members(BTreeSet::new()); function.arguments.len()],
        open: Vec::new(),
    };
    visit(&function.body, &mut |statement, _| match statement {
        Statement::Return { value: Some(value) } => marker.mark(*value),
        Statement::If { condition, .. } => marker.mark(*condition),
        Statement::Switch { selector, .. } => marker.mark(*selector),
        Statement::Loop {
            break_if: Some(condition),
            ..
        } => marker.mark(*condition),
        Statement::Store { pointer, value } if super::walk::target(function, *pointer).is_none() => {
            marker.mark(*pointer);
            marker.mark(*value);
        }
        // Writes through a pointer cannot be traced.
        Statement::Call { arguments, .. } => {
            let is_pointer = |argument: &Handle<Expression>| is_pointer(module, function, *argument);
            if arguments.iter().any(is_pointer) {
                arguments.iter().for_each(|argument| marker.mark(*argument));
            }
        }
        _ => {}
    });
    marker.propagate();
    marker.uses
}

fn is_pointer(module: &Module, function: &Function, expression: Handle<Expression>) -> bool {
    match function.expressions[expression] {
        Expression::LocalVariable(_) => true,
        Expression::FunctionArgument(index) => function.arguments.get(index as usize).is_some_and(|argument| {
            matches!(
                module.types[argument.ty].inner,
                TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. }
            )
        }),
        Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => is_pointer(module, function, base),
        _ => false,
    }
}

/// Marks the expressions that a result depends on.
struct LiveMarker<'m> {
    function: &'m Function,
    /// Assignments by variable. The assignments of a variable are removed when it is read.
    stores: BTreeMap<usize, Vec<Store>>,
    calls: Calls,
    callees: &'m [Vec<Use>],
    /// Arguments that are passed on to a callee: the callee, the callee's argument, and this function's argument.
    passed_on: BTreeSet<(usize, usize, u32)>,
    live: Vec<bool>,
    uses: Vec<Use>,
    open: Vec<Handle<Expression>>,
}

impl LiveMarker<'_> {
    fn mark(&mut self, expression: Handle<Expression>) {
        if !std::mem::replace(&mut self.live[expression.index()], true) {
            self.open.push(expression);
        }
    }

    /// Marks all operands of marked expressions.
    fn propagate(&mut self) {
        while let Some(handle) = self.open.pop() {
            let expression = &self.function.expressions[handle];
            match expression {
                Expression::FunctionArgument(index) => self.use_argument(*index, &Use::Whole),
                Expression::AccessIndex { base, index } => match self.function.expressions[*base] {
                    Expression::FunctionArgument(argument) => {
                        self.use_argument(argument, &Use::Members(BTreeSet::from([*index])));
                    }
                    _ => self.mark(*base),
                },
                Expression::LocalVariable(local) => self.read_local(*local),
                Expression::CallResult(callee) => self.read_call(handle, *callee),
                _ => {
                    let mut parts = Vec::new();
                    children(expression, &mut |part| parts.push(part));
                    parts.into_iter().for_each(|part| self.mark(part));
                }
            }
        }
    }

    fn use_argument(&mut self, index: u32, used: &Use) {
        if let Some(known) = self.uses.get_mut(index as usize) {
            known.merge(used);
        }
    }

    /// Marks the values that were stored in a variable that is read.
    fn read_local(&mut self, local: Handle<LocalVariable>) {
        // The entry is removed, so that its values are marked only once.
        for store in self.stores.remove(&local.index()).unwrap_or_default() {
            self.mark(store.pointer);
            if let Some(value) = store.value {
                self.mark(value);
            }
        }
        if let Some(init) = self.function.local_variables[local].init {
            self.mark(init);
        }
    }

    /// Marks arguments of a call whose result is read, as far as the callee uses them.
    fn read_call(&mut self, result: Handle<Expression>, callee: Handle<Function>) {
        let Some((_, arguments)) = self.calls.remove(&result.index()) else {
            return;
        };
        let callees = self.callees;
        let uses = callees[callee.index()].iter().enumerate();
        for (argument, (position, used)) in arguments.iter().zip(uses).filter(|(_, (_, used))| !used.is_none()) {
            match (&self.function.expressions[*argument], used) {
                (Expression::FunctionArgument(index), Use::Members(_)) => {
                    if self.passed_on.insert((callee.index(), position, *index)) {
                        self.use_argument(*index, used);
                    }
                }
                _ => self.mark(*argument),
            }
        }
    }
}
