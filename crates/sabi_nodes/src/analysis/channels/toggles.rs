//! Which toggle a condition asks for.

use std::collections::BTreeSet;

use naga::{BinaryOperator, Expression, Handle, Literal, ScalarKind, UnaryOperator};

use super::{Frame, Reader};
use crate::analysis::walk::conjuncts;
use crate::kind::Role;

impl<'m> Reader<'m> {
    /// Toggles that are on when the conditions come out as told.
    pub(super) fn toggles(&self, frame: &Frame<'m>, conditions: &[(Handle<Expression>, bool)]) -> BTreeSet<usize> {
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

    /// The toggle that is on when `condition` comes out as `taken`.
    fn toggle(&self, frame: &Frame<'m>, condition: Handle<Expression>, taken: bool) -> Option<usize> {
        let (op, left, right) = match frame.function.expressions[condition] {
            Expression::Unary {
                op: UnaryOperator::LogicalNot,
                expr,
            } => {
                // One level: nobody writes more, and a text can nest deep.
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

    fn toggle_param(&self, frame: &Frame<'m>, expression: Handle<Expression>) -> Option<usize> {
        let Expression::AccessIndex { base, index } = frame.function.expressions[expression] else {
            return None;
        };
        let Expression::FunctionArgument(argument) = frame.function.expressions[base] else {
            return None;
        };
        let ty = frame.function.arguments.get(argument as usize)?.ty;
        let index = index as usize;
        let is_toggle = self.params.get(index)?.role == Role::Toggle;
        (Some(ty) == self.params_type && is_toggle).then_some(index)
    }
}
