//! Traces the members of a material back to their origins.

use std::collections::BTreeSet;

use naga::{BinaryOperator, Expression, Function, Handle, LocalVariable, MathFunction, Type, UnaryOperator};

use super::frame::WriteFrame;
use super::members::Members;
use super::needs::Needs;
use super::writes::{Write, Writes, always, both, either, join};
use crate::analysis::walk::{Store, calls, is_zero, returns, stores};

/// Maximum number of expressions visited.
const VISITS: u32 = 1 << 16;
/// Maximum number of expressions and assignments that are searched.
const SCANS: u64 = 1 << 22;

/// Work that is left.
pub(super) struct TraceFuel {
    visits: u32,
    scans: u64,
}

impl TraceFuel {
    pub(super) fn new() -> TraceFuel {
        TraceFuel {
            visits: VISITS,
            scans: SCANS,
        }
    }

    /// Takes fuel for searching this many parts of a function. Returns false if not enough is left.
    fn scan(&mut self, parts: usize) -> bool {
        self.scans = self.scans.saturating_sub(parts as u64);
        self.scans > 0
    }

    /// Takes fuel for visiting an expression. Returns false if not enough is left.
    fn visit(&mut self) -> bool {
        self.visits = self.visits.saturating_sub(1);
        self.visits > 0 && self.scans > 0
    }
}

/// Traces the members of a material back to their origins, through calls and local variables.
pub(super) struct Tracer<'m> {
    pub(super) needs: Needs<'m>,
    pub(super) members: Members,
    /// The type `Material`.
    pub(super) material: Handle<Type>,
    /// The function that returns the plain material.
    pub(super) plain: Option<Handle<Function>>,
    pub(super) fuel: TraceFuel,
}

impl<'m> Tracer<'m> {
    /// Returns the conditions under which a call of a function that returns a material sets each member.
    pub(super) fn function(&mut self, handle: Handle<Function>, arguments: Vec<Writes>, depth: u32) -> Writes {
        if Some(handle) == self.plain {
            return self.members.none_set();
        }
        let Some(depth) = depth.checked_sub(1) else {
            return self.members.all_set();
        };
        let function = &self.needs.module.functions[handle];
        if !self.fuel.scan(function.expressions.len()) {
            return self.members.all_set();
        }
        let mut frame = WriteFrame {
            function,
            arguments,
            stores: stores(function, &function.body),
            calls: calls(&function.body),
            open: Vec::new(),
        };
        let mut writes = self.members.none_set();
        for (value, conditions) in returns(&function.body) {
            let of = self.material(&mut frame, value, depth);
            let toggles = self.needs.toggles(&frame, &conditions);
            join(&mut writes, of, &toggles);
        }
        writes
    }

    /// Returns the conditions under which an expression of type material sets each member.
    fn material(&mut self, frame: &mut WriteFrame<'m>, expression: Handle<Expression>, depth: u32) -> Writes {
        let (Some(depth), true) = (depth.checked_sub(1), self.fuel.visit()) else {
            return self.members.all_set();
        };
        match &frame.function.expressions[expression] {
            Expression::FunctionArgument(index) => {
                let is_material = |argument: &naga::FunctionArgument| argument.ty == self.material;
                match (
                    frame.function.arguments.get(*index as usize),
                    frame.arguments.get(*index as usize),
                ) {
                    (Some(argument), Some(writes)) if is_material(argument) => writes.clone(),
                    _ => self.members.all_set(),
                }
            }
            Expression::Load { pointer } => match frame.function.expressions[*pointer] {
                Expression::LocalVariable(local) if frame.function.local_variables[local].ty == self.material => {
                    self.material_local(frame, local, depth)
                }
                _ => self.members.all_set(),
            },
            Expression::CallResult(callee) => {
                let Some((_, arguments)) = frame.calls.get(&expression.index()).cloned() else {
                    return self.members.all_set();
                };
                let of_callee = &self.needs.module.functions[*callee].arguments;
                let of_arguments = arguments.iter().zip(of_callee).map(|(argument, declared)| {
                    if declared.ty == self.material {
                        self.material(frame, *argument, depth)
                    } else {
                        self.members.all_set()
                    }
                });
                let of_arguments = of_arguments.collect();
                self.function(*callee, of_arguments, depth)
            }
            Expression::Compose { ty, components } if *ty == self.material => {
                let parts = components.iter().enumerate();
                parts
                    .map(|(member, part)| self.value(frame, *part, member, depth))
                    .collect()
            }
            Expression::ZeroValue(ty) if *ty == self.material => self.members.zero(),
            _ => self.members.all_set(),
        }
    }

    /// Returns the assignments to a variable.
    fn stores_of(&mut self, frame: &WriteFrame<'m>, local: Handle<LocalVariable>) -> Vec<Store> {
        self.fuel.scan(frame.stores.len());
        let own = frame.stores.iter().filter(|store| store.local == local);
        own.cloned().collect()
    }

    fn material_local(&mut self, frame: &mut WriteFrame<'m>, local: Handle<LocalVariable>, depth: u32) -> Writes {
        let mut writes = self.members.none_set();
        if frame.open.contains(&local) {
            return writes;
        }
        frame.open.push(local);
        let own = self.stores_of(frame, local);
        match frame.function.local_variables[local].init {
            Some(init) => join(&mut writes, self.material(frame, init, depth), &BTreeSet::new()),
            None if own.iter().any(|store| store.path.is_empty() && store.value.is_some()) => {}
            None => join(&mut writes, self.members.zero(), &BTreeSet::new()),
        }
        for store in own {
            let toggles = self.needs.toggles(frame, &store.conditions);
            let of = match (store.value, store.path.as_slice()) {
                (Some(value), []) => self.material(frame, value, depth),
                (value, [Some(member), rest @ ..]) => {
                    let member = *member as usize;
                    let mut of = self.members.none_set();
                    if let Some(write) = of.get_mut(member) {
                        *write = match value {
                            Some(value) if rest.is_empty() => self.value(frame, value, member, depth),
                            _ => always(),
                        };
                    }
                    of
                }
                _ => self.members.all_set(),
            };
            join(&mut writes, of, &toggles);
        }
        frame.open.pop();
        writes
    }

    /// Returns the conditions under which storing `expression` in `member` sets it; `None` if it never does.
    fn value(
        &mut self,
        frame: &mut WriteFrame<'m>,
        expression: Handle<Expression>,
        member: usize,
        depth: u32,
    ) -> Write {
        let (Some(depth), true) = (depth.checked_sub(1), self.fuel.visit()) else {
            return always();
        };
        let zero_is_plain = self.members.is_zero_when_plain(member);
        if zero_is_plain && is_zero(self.needs.module, frame.function, expression, depth) {
            return None;
        }
        if zero_is_plain && let Some(need) = self.needs.need(frame, expression) {
            return Some(BTreeSet::from([need]));
        }
        match frame.function.expressions[expression] {
            Expression::AccessIndex { base, index } if index as usize == member => self
                .material(frame, base, depth)
                .into_iter()
                .nth(member)
                .unwrap_or(always()),
            Expression::Load { pointer } => self.value_behind(frame, pointer, member, depth),
            Expression::Select {
                condition,
                accept,
                reject,
            } => {
                let on = self.needs.toggles(frame, &[(condition, true)]);
                let off = self.needs.toggles(frame, &[(condition, false)]);
                let accept = self.value(frame, accept, member, depth).map(|toggles| &toggles | &on);
                let reject = self.value(frame, reject, member, depth).map(|toggles| &toggles | &off);
                either(accept, reject)
            }
            Expression::Math { fun, arg, arg1, .. } => self.math(fun, arg, arg1, frame, member, depth),
            Expression::Binary { op, left, right } if zero_is_plain => {
                let mut of = |side| self.value(frame, side, member, depth);
                match op {
                    BinaryOperator::Add | BinaryOperator::Subtract => either(of(left), of(right)),
                    BinaryOperator::Multiply => both(of(left), of(right)),
                    BinaryOperator::Divide => of(left),
                    _ => always(),
                }
            }
            Expression::Unary {
                op: UnaryOperator::Negate,
                expr,
            } if zero_is_plain => self.value(frame, expr, member, depth),
            _ => always(),
        }
    }

    /// Returns the conditions under which storing the value behind `pointer` in `member` sets it.
    fn value_behind(
        &mut self,
        frame: &mut WriteFrame<'m>,
        pointer: Handle<Expression>,
        member: usize,
        depth: u32,
    ) -> Write {
        let function = frame.function;
        match function.expressions[pointer] {
            Expression::LocalVariable(local) => self.value_local(frame, local, member, depth),
            Expression::AccessIndex { base, index } if index as usize == member => match function.expressions[base] {
                Expression::LocalVariable(local) if function.local_variables[local].ty == self.material => {
                    let writes = self.material_local(frame, local, depth);
                    writes.into_iter().nth(member).unwrap_or(always())
                }
                _ => always(),
            },
            _ => always(),
        }
    }

    /// Returns the conditions under which storing a local variable in `member` sets it.
    fn value_local(
        &mut self,
        frame: &mut WriteFrame<'m>,
        local: Handle<LocalVariable>,
        member: usize,
        depth: u32,
    ) -> Write {
        if frame.open.contains(&local) {
            return None;
        }
        frame.open.push(local);
        let own = self.stores_of(frame, local);
        let mut write = match frame.function.local_variables[local].init {
            Some(init) => self.value(frame, init, member, depth),
            None if self.members.is_zero_when_plain(member) || !own.is_empty() => None,
            None => always(),
        };
        for store in own {
            let toggles = self.needs.toggles(frame, &store.conditions);
            let of = match store.value {
                Some(value) if store.path.is_empty() => self.value(frame, value, member, depth),
                _ => always(),
            };
            write = either(write, of.map(|of| &of | &toggles));
        }
        frame.open.pop();
        write
    }

    /// Returns the conditions for the result of a function with one or two arguments.
    fn math(
        &mut self,
        fun: MathFunction,
        arg: Handle<Expression>,
        other: Option<Handle<Expression>>,
        frame: &mut WriteFrame<'m>,
        member: usize,
        depth: u32,
    ) -> Write {
        let zero_is_plain = self.members.is_zero_when_plain(member);
        let is_zero = |expression| is_zero(self.needs.module, frame.function, expression, depth);
        match (fun, other) {
            // The upper bound of a clamp is above the lower bound, so only the lower one can be zero.
            (MathFunction::Clamp, Some(low)) if zero_is_plain && is_zero(low) => self.value(frame, arg, member, depth),
            (MathFunction::Sign, _) if zero_is_plain => self.value(frame, arg, member, depth),
            (MathFunction::Dot, Some(other)) if zero_is_plain => both(
                self.value(frame, arg, member, depth),
                self.value(frame, other, member, depth),
            ),
            (_, Some(other)) if fun == MathFunction::Mix || (zero_is_plain && is_one_of_two(fun)) => either(
                self.value(frame, arg, member, depth),
                self.value(frame, other, member, depth),
            ),
            _ => always(),
        }
    }
}

/// Returns true if the result of the function is always one of its two arguments.
fn is_one_of_two(fun: MathFunction) -> bool {
    matches!(fun, MathFunction::Max | MathFunction::Min)
}
