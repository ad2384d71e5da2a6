//! Maximum effort of evaluating a piece of code once.

use naga::{Expression, Function, Handle, MathFunction};

/// Number of rounds and calls, and the total work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Effort {
    /// Rounds of loops and calls of functions.
    pub(super) rounds: u64,
    /// Simple operations.
    pub(super) work: u64,
}

impl Effort {
    /// Returns the effort of the expressions alone.
    pub(super) fn of_expressions(
        function: &Function,
        expressions: impl IntoIterator<Item = Handle<Expression>>,
    ) -> Effort {
        let works = expressions
            .into_iter()
            .map(|handle| work(&function.expressions[handle]));
        Effort {
            rounds: 0,
            work: works.sum(),
        }
    }

    /// Returns the effort of both, one after the other.
    pub(super) fn and(self, other: Effort) -> Effort {
        Effort {
            rounds: self.rounds.saturating_add(other.rounds),
            work: self.work.saturating_add(other.work),
        }
    }

    /// Returns the larger effort of two alternatives.
    pub(super) fn or(self, other: Effort) -> Effort {
        Effort {
            rounds: self.rounds.max(other.rounds),
            work: self.work.max(other.work),
        }
    }

    /// Returns the effort of this in each of some rounds. A round counts even if it is empty.
    pub(super) fn times(self, rounds: u64) -> Effort {
        Effort {
            rounds: self.rounds.max(1).saturating_mul(rounds),
            work: self.work.max(1).saturating_mul(rounds),
        }
    }
}

/// Returns the approximate number of simple operations for an expression: drivers compute transcendental functions from
/// several operations, and texture reads wait for memory.
fn work(expression: &Expression) -> u64 {
    match expression {
        Expression::ImageLoad { .. } | Expression::ImageSample { .. } => 8,
        Expression::Math { fun, .. } => match fun {
            MathFunction::Sin
            | MathFunction::Cos
            | MathFunction::Tan
            | MathFunction::Sinh
            | MathFunction::Cosh
            | MathFunction::Tanh
            | MathFunction::Asin
            | MathFunction::Acos
            | MathFunction::Atan
            | MathFunction::Atan2
            | MathFunction::Asinh
            | MathFunction::Acosh
            | MathFunction::Atanh
            | MathFunction::Exp
            | MathFunction::Exp2
            | MathFunction::Log
            | MathFunction::Log2
            | MathFunction::Pow => 8,
            _ => 2,
        },
        _ => 1,
    }
}
