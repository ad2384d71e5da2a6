//! The most that one evaluation of a piece of code takes.

use naga::{Expression, Function, Handle, MathFunction};

/// Rounds and calls, and the work of all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Effort {
    /// Rounds of loops and calls of functions.
    pub(super) rounds: u64,
    /// Simple operations.
    pub(super) work: u64,
}

impl Effort {
    /// Effort of expressions alone.
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

    /// Both, one after the other.
    pub(super) fn and(self, other: Effort) -> Effort {
        Effort {
            rounds: self.rounds.saturating_add(other.rounds),
            work: self.work.saturating_add(other.work),
        }
    }

    /// The larger of both, where only one is done.
    pub(super) fn or(self, other: Effort) -> Effort {
        Effort {
            rounds: self.rounds.max(other.rounds),
            work: self.work.max(other.work),
        }
    }

    /// This effort in each of some rounds; a round counts although nothing is in it.
    pub(super) fn times(self, rounds: u64) -> Effort {
        Effort {
            rounds: self.rounds.max(1).saturating_mul(rounds),
            work: self.work.max(1).saturating_mul(rounds),
        }
    }
}

/// Simple operations that an expression takes, about: drivers compute transcendental functions from a few others, and wait for
/// textures.
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
