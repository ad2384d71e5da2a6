//! Parameters and inputs that the conditions and values of a function read.

use std::collections::BTreeSet;

use naga::{BinaryOperator, Expression, Function, Handle, Literal, Module, ScalarKind, Type, UnaryOperator};

use super::frame::WriteFrame;
use super::writes::Need;
use crate::analysis::walk::conjuncts;
use crate::kind::{Argument, Memory, Param, Role};

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
    pub(super) fn toggles(&self, frame: &WriteFrame<'m>, conditions: &[(Handle<Expression>, bool)]) -> BTreeSet<Need> {
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
    fn toggle(&self, frame: &WriteFrame<'m>, condition: Handle<Expression>, taken: bool) -> Option<Need> {
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

    fn toggle_param(&self, frame: &WriteFrame<'m>, expression: Handle<Expression>) -> Option<Need> {
        let index = self.param(frame, expression)?;
        (self.params.get(index)?.ty.role == Role::Toggle).then_some(Need::Param(index))
    }

    /// Returns the parameter that an expression reads.
    fn param(&self, frame: &WriteFrame<'m>, expression: Handle<Expression>) -> Option<usize> {
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
    pub(super) fn need(&self, frame: &WriteFrame<'m>, expression: Handle<Expression>) -> Option<Need> {
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
