//! Conditions for setting a channel: toggles that must be on, and values that must not be zero.

use std::collections::BTreeSet;

use naga::{BinaryOperator, Expression, Function, Handle, Literal, Module, ScalarKind, Type, UnaryOperator};

use super::tracer::Frame;
use crate::analysis::walk::conjuncts;
use crate::kind::{Argument, Channel, ChannelWrite, Memory, Param, Role};

/// A parameter or input that must be on, or other than zero, for a channel to be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Need {
    /// A parameter, by index.
    Param(usize),
    /// An input, by index.
    Input(usize),
}

/// Condition for setting a member. `None`: it is never set. `Some(needs)`: it may be set if all of these are on.
pub(super) type Write = Option<BTreeSet<Need>>;

/// Returns the condition of a member that is always set.
pub(super) fn always() -> Write {
    Some(BTreeSet::new())
}

/// Returns the condition of a member that is set if one of two conditions holds.
pub(super) fn either(a: Write, b: Write) -> Write {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.intersection(&b).copied().collect()),
        (a, b) => a.or(b),
    }
}

/// Returns the minimal sets of needs, each once: a set that contains another one is left out.
pub(super) fn without_stronger(all: &[BTreeSet<Need>]) -> impl Iterator<Item = BTreeSet<Need>> {
    let weakest = move |(at, needs): (usize, &BTreeSet<Need>)| {
        let mut others = all.iter().enumerate().filter(|(other, _)| *other != at);
        let follows = others.any(|(other, weaker)| weaker.is_subset(needs) && (weaker != needs || other < at));
        (!follows).then(|| needs.clone())
    };
    all.iter().enumerate().filter_map(weakest)
}

/// Returns the condition of a member that is set only if both conditions hold, such as a product.
pub(super) fn both(a: Write, b: Write) -> Write {
    a.zip(b).map(|(a, b)| a.union(&b).copied().collect())
}

/// Conditions for the members of `Material` that a function sets.
pub(super) type Writes = Vec<Write>;

/// Adds the conditions of other writes, which additionally need some toggles.
pub(super) fn join(writes: &mut Writes, others: Writes, toggles: &BTreeSet<Need>) {
    for (write, other) in writes.iter_mut().zip(others) {
        *write = either(write.take(), other.map(|other| &other | toggles));
    }
}

/// Returns the [`ChannelWrite`] of a channel with its conditions.
pub(super) fn channel_write(channel: Channel, needs: BTreeSet<Need>) -> ChannelWrite {
    let param = |need: &Need| match need {
        Need::Param(index) => Some(*index),
        Need::Input(_) => None,
    };
    let input = |need: &Need| match need {
        Need::Input(index) => Some(*index),
        Need::Param(_) => None,
    };
    ChannelWrite {
        channel,
        unless_off: needs.iter().filter_map(param).collect(),
        unless_open: needs.iter().filter_map(input).collect(),
    }
}

/// Parameters and inputs that conditions and values read.
pub(super) struct Needs<'m> {
    pub(super) module: &'m Module,
    pub(super) params: &'m [Param],
    /// The type `Params`.
    pub(super) params_type: Option<Handle<Type>>,
    /// The function whose writes are found.
    pub(super) root: Handle<Function>,
    /// Bindings of the arguments of `root`, in order.
    pub(super) inputs: &'m [Argument],
}

impl<'m> Needs<'m> {
    /// Returns the toggles that must be on for the conditions to have these values.
    pub(super) fn toggles(&self, frame: &Frame<'m>, conditions: &[(Handle<Expression>, bool)]) -> BTreeSet<Need> {
        let mut found = BTreeSet::new();
        for &(condition, taken) in conditions {
            let parts = if taken {
                conjuncts(frame.function, &frame.stores, condition)
            } else {
                vec![condition]
            };
            found.extend(parts.into_iter().filter_map(|part| self.toggle(frame, part, taken)));
        }
        found
    }

    /// Returns the toggle that must be on for `condition` to have the value `taken`.
    fn toggle(&self, frame: &Frame<'m>, condition: Handle<Expression>, taken: bool) -> Option<Need> {
        let (op, left, right) = match frame.function.expressions[condition] {
            Expression::Unary {
                op: UnaryOperator::LogicalNot,
                expr,
            } => {
                // Only one level of nesting is followed: deeper nesting is unusual, and its depth is not limited.
                return match frame.function.expressions[expr] {
                    Expression::Unary { .. } => None,
                    _ => self.toggle(frame, expr, !taken),
                };
            }
            Expression::As {
                expr,
                kind: ScalarKind::Bool,
                ..
            } if taken => return self.toggle_param(frame, expr),
            Expression::Binary { op, left, right } => (op, left, right),
            _ => return None,
        };
        let number = |side| match frame.function.expressions[side] {
            Expression::Literal(Literal::U32(number)) => Some(number),
            _ => None,
        };
        let (param, number, swapped) = match (number(left), number(right)) {
            (None, Some(number)) => (left, number, false),
            (Some(number), None) => (right, number, true),
            _ => return None,
        };
        let is_on = match (op, number, taken) {
            (BinaryOperator::NotEqual, 0, true) | (BinaryOperator::Equal, 1, true) => true,
            (BinaryOperator::Equal, 0, false) | (BinaryOperator::NotEqual, 1, false) => true,
            (BinaryOperator::Greater, 0, true) | (BinaryOperator::LessEqual, 0, false) => !swapped,
            (BinaryOperator::GreaterEqual, 1, true) | (BinaryOperator::Less, 1, false) => !swapped,
            (BinaryOperator::Less, 0, true) | (BinaryOperator::LessEqual, 1, true) => swapped,
            _ => false,
        };
        if is_on { self.toggle_param(frame, param) } else { None }
    }

    fn toggle_param(&self, frame: &Frame<'m>, expression: Handle<Expression>) -> Option<Need> {
        let index = self.param(frame, expression)?;
        (self.params.get(index)?.ty.role == Role::Toggle).then_some(Need::Param(index))
    }

    /// Returns the parameter that an expression reads.
    fn param(&self, frame: &Frame<'m>, expression: Handle<Expression>) -> Option<usize> {
        let Expression::AccessIndex { base, index } = frame.function.expressions[expression] else {
            return None;
        };
        let Expression::FunctionArgument(argument) = frame.function.expressions[base] else {
            return None;
        };
        let ty = frame.function.arguments.get(argument as usize)?.ty;
        (Some(ty) == self.params_type).then_some(index as usize)
    }

    /// Returns the parameter or input that an expression reads as a number.
    pub(super) fn need(&self, frame: &Frame<'m>, expression: Handle<Expression>) -> Option<Need> {
        if let Some(index) = self.param(frame, expression) {
            let is_number = matches!(self.params.get(index)?.ty.memory, Memory::F32 | Memory::Vec3);
            return is_number.then_some(Need::Param(index));
        }
        let Expression::FunctionArgument(argument) = frame.function.expressions[expression] else {
            return None;
        };
        let is_root = std::ptr::eq(frame.function, &self.module.functions[self.root]);
        match self.inputs.get(argument as usize) {
            Some(Argument::Input(index)) if is_root => Some(Need::Input(*index)),
            _ => None,
        }
    }
}
