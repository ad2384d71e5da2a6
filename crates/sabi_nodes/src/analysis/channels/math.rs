//! Conditions for results of mathematical functions.

use naga::{Expression, Handle, MathFunction};

use super::needs::{Write, always, both, either};
use super::{Frame, Reader};
use crate::analysis::walk::is_zero;

impl<'m> Reader<'m> {
    /// Returns the conditions for the result of a function with one or two arguments.
    pub(super) fn math(
        &mut self,
        fun: MathFunction,
        arg: Handle<Expression>,
        other: Option<Handle<Expression>>,
        frame: &mut Frame<'m>,
        member: usize,
        depth: u32,
    ) -> Write {
        let zero_is_plain = self.is_zero_when_plain(member);
        let is_zero = |expression| is_zero(self.module, frame.function, expression, depth);
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
