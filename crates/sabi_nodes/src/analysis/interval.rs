//! Intervals of whole numbers, where they follow from the code.

use std::collections::{BTreeMap, BTreeSet};

use naga::{
    BinaryOperator, Expression, Function, Handle, Literal, LocalVariable, MathFunction, Module, Scalar, ScalarKind,
    Type, TypeInner, UnaryOperator,
};

use super::fuel::Fuel;
use super::walk::Store;
use crate::kind::{Memory, Param, Role};

/// Maximum length of a path through expressions.
const DEPTH_LIMIT: u32 = 64;

/// Maximum number of expressions visited for one interval.
const FUEL: u32 = 4096;

/// Interval of whole numbers, both ends included.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Interval {
    pub(super) low: i64,
    pub(super) high: i64,
    /// Indices of the parameters whose ranges the interval depends on.
    pub(super) params: BTreeSet<usize>,
}

impl Interval {
    /// Returns the interval of all values of an `i32` or a `u32`.
    pub(super) fn unknown(kind: ScalarKind) -> Interval {
        let (low, high) = limits(kind);
        Interval {
            low,
            high,
            params: BTreeSet::new(),
        }
    }

    pub(super) fn exactly(value: i64) -> Interval {
        Interval {
            low: value,
            high: value,
            params: BTreeSet::new(),
        }
    }

    /// Returns the smallest interval that contains both.
    pub(super) fn or(self, other: Interval) -> Interval {
        self.with(&other, |a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    fn with(mut self, other: &Interval, make: impl Fn((i64, i64), (i64, i64)) -> (i64, i64)) -> Interval {
        (self.low, self.high) = make((self.low, self.high), (other.low, other.high));
        self.params.extend(&other.params);
        self
    }

    /// Returns this interval if the type can hold it, otherwise all values of the type, since the computation could wrap around.
    fn within(self, kind: ScalarKind) -> Interval {
        let (low, high) = limits(kind);
        if self.low >= low && self.high <= high {
            self
        } else {
            Interval::unknown(kind)
        }
    }
}

fn limits(kind: ScalarKind) -> (i64, i64) {
    match kind {
        ScalarKind::Uint => (0, i64::from(u32::MAX)),
        _ => (i64::from(i32::MIN), i64::from(i32::MAX)),
    }
}

/// State of a function during one call of it.
pub(super) struct IntervalFrame<'m> {
    pub(super) function: &'m Function,
    /// Intervals of the arguments; `None` for arguments that are not whole numbers.
    pub(super) arguments: Vec<Option<Interval>>,
    /// All assignments in the function.
    pub(super) stores: Vec<Store>,
    /// Counters of the loops around the analyzed place.
    pub(super) counters: BTreeMap<usize, Interval>,
}

/// Intervals of the expressions of a module, as far as they follow from the code and the ranges of the parameters.
pub(super) struct Intervals<'m> {
    pub(super) module: &'m Module,
    pub(super) params_type: Option<Handle<Type>>,
    pub(super) params: &'m [Param],
    pub(super) fuel: Fuel,
}

impl<'m> Intervals<'m> {
    /// Returns the interval of an expression in a frame; `None` for types other than `i32` and `u32`.
    pub(super) fn of(&self, frame: &IntervalFrame<'m>, expression: Handle<Expression>) -> Option<Interval> {
        let kind = self.kind(frame, expression, DEPTH_LIMIT)?;
        let mut query = Query {
            intervals: self,
            frame,
            fuel: FUEL,
            open: Vec::new(),
        };
        Some(query.get(expression, kind, DEPTH_LIMIT))
    }

    /// Returns whether an expression is signed or unsigned; `None` for other types.
    fn kind(&self, frame: &IntervalFrame<'m>, expression: Handle<Expression>, depth: u32) -> Option<ScalarKind> {
        let next = depth.checked_sub(1)?;
        let of_type = |ty: Handle<Type>| match self.module.types[ty].inner {
            TypeInner::Scalar(Scalar {
                kind: kind @ (ScalarKind::Sint | ScalarKind::Uint),
                width: 4,
            }) => Some(kind),
            _ => None,
        };
        match &frame.function.expressions[expression] {
            Expression::Literal(Literal::U32(_)) => Some(ScalarKind::Uint),
            Expression::Literal(Literal::I32(_)) => Some(ScalarKind::Sint),
            Expression::Constant(constant) => of_type(self.module.constants[*constant].ty),
            Expression::ZeroValue(ty) => of_type(*ty),
            Expression::FunctionArgument(index) => of_type(frame.function.arguments.get(*index as usize)?.ty),
            Expression::AccessIndex { base, index } => of_type(self.member_type(frame, *base, *index)?),
            Expression::Load { pointer } => match frame.function.expressions[*pointer] {
                Expression::LocalVariable(local) => of_type(frame.function.local_variables[local].ty),
                _ => None,
            },
            Expression::CallResult(function) => of_type(self.module.functions[*function].result.as_ref()?.ty),
            Expression::Unary { expr, .. } => self.kind(frame, *expr, next),
            Expression::Binary { op, left, .. } => {
                let compares = matches!(
                    op,
                    BinaryOperator::Equal
                        | BinaryOperator::NotEqual
                        | BinaryOperator::Less
                        | BinaryOperator::LessEqual
                        | BinaryOperator::Greater
                        | BinaryOperator::GreaterEqual
                );
                if compares { None } else { self.kind(frame, *left, next) }
            }
            Expression::Select { accept, .. } => self.kind(frame, *accept, next),
            Expression::Math { arg, .. } => self.kind(frame, *arg, next),
            Expression::As {
                kind: kind @ (ScalarKind::Sint | ScalarKind::Uint),
                convert: Some(4),
                expr,
            } => self.is_scalar(frame, *expr).then_some(*kind),
            _ => None,
        }
    }

    fn is_scalar(&self, frame: &IntervalFrame<'m>, expression: Handle<Expression>) -> bool {
        // A conversion of a vector gives a vector, which cannot bound a loop.
        !matches!(
            frame.function.expressions[expression],
            Expression::Compose { .. } | Expression::Splat { .. } | Expression::Swizzle { .. }
        )
    }

    /// Returns the type of a member of `base` if `base` is of type `Params`.
    fn member_type(&self, frame: &IntervalFrame<'m>, base: Handle<Expression>, index: u32) -> Option<Handle<Type>> {
        let Expression::FunctionArgument(argument) = frame.function.expressions[base] else {
            return None;
        };
        let ty = frame.function.arguments.get(argument as usize)?.ty;
        match &self.module.types[ty].inner {
            TypeInner::Struct { members, .. } if Some(ty) == self.params_type => {
                members.get(index as usize).map(|member| member.ty)
            }
            _ => None,
        }
    }

    /// Returns the interval of a parameter, which the linked kernel clamps to its range.
    fn param(&self, index: usize) -> Option<Interval> {
        let ty = &self.params.get(index)?.ty;
        let [low, high] = ty.range?;
        let is_number = matches!(ty.memory, Memory::U32 | Memory::I32) && ty.role == Role::Plain;
        is_number.then(|| Interval {
            low: low as i64,
            high: high as i64,
            params: BTreeSet::from([index]),
        })
    }
}

/// Search for one interval, with a limit on the work.
struct Query<'q, 'm> {
    intervals: &'q Intervals<'m>,
    frame: &'q IntervalFrame<'m>,
    fuel: u32,
    /// Variables that are being analyzed.
    open: Vec<Handle<LocalVariable>>,
}

impl Query<'_, '_> {
    fn get(&mut self, expression: Handle<Expression>, kind: ScalarKind, depth: u32) -> Interval {
        let unknown = Interval::unknown(kind);
        if depth == 0 || self.fuel == 0 || !self.intervals.fuel.step(1) {
            return unknown;
        }
        self.fuel -= 1;
        self.known(expression, kind, depth - 1).unwrap_or(unknown).within(kind)
    }

    fn known(&mut self, expression: Handle<Expression>, kind: ScalarKind, depth: u32) -> Option<Interval> {
        match self.frame.function.expressions[expression] {
            Expression::Literal(literal) => whole(literal).map(Interval::exactly),
            Expression::ZeroValue(_) => Some(Interval::exactly(0)),
            Expression::Constant(constant) => {
                let init = self.intervals.module.constants[constant].init;
                match self.intervals.module.global_expressions[init] {
                    Expression::Literal(literal) => whole(literal).map(Interval::exactly),
                    Expression::ZeroValue(_) => Some(Interval::exactly(0)),
                    _ => None,
                }
            }
            Expression::FunctionArgument(index) => self.frame.arguments.get(index as usize)?.clone(),
            Expression::AccessIndex { base, index } => {
                self.intervals.member_type(self.frame, base, index)?;
                self.intervals.param(index as usize)
            }
            Expression::Load { pointer } => match self.frame.function.expressions[pointer] {
                Expression::LocalVariable(local) => self.local(local, kind, depth),
                _ => None,
            },
            Expression::Select { accept, reject, .. } => {
                Some(self.get(accept, kind, depth).or(self.get(reject, kind, depth)))
            }
            Expression::Unary {
                op: UnaryOperator::Negate,
                expr,
            } => {
                let value = self.get(expr, kind, depth);
                Some(Interval {
                    low: -value.high,
                    high: -value.low,
                    params: value.params,
                })
            }
            Expression::As { expr, .. } => {
                let from = self.intervals.kind(self.frame, expr, depth)?;
                Some(self.get(expr, from, depth))
            }
            Expression::Math {
                fun, arg, arg1, arg2, ..
            } => {
                let arg = self.get(arg, kind, depth);
                let mut other = |handle: Option<Handle<Expression>>| handle.map(|handle| self.get(handle, kind, depth));
                match fun {
                    MathFunction::Min => Some(min(arg, &other(arg1)?)),
                    MathFunction::Max => Some(max(arg, &other(arg1)?)),
                    MathFunction::Clamp => Some(min(max(arg, &other(arg1)?), &other(arg2)?)),
                    _ => None,
                }
            }
            Expression::Binary { op, left, right } => {
                let left = self.get(left, kind, depth);
                let shift = matches!(op, BinaryOperator::ShiftLeft | BinaryOperator::ShiftRight);
                let right = self.get(right, if shift { ScalarKind::Uint } else { kind }, depth);
                binary(op, left, &right)
            }
            _ => None,
        }
    }

    /// Returns the interval of a variable: it contains all values that are ever stored in it.
    fn local(&mut self, local: Handle<LocalVariable>, kind: ScalarKind, depth: u32) -> Option<Interval> {
        if let Some(counter) = self.frame.counters.get(&local.index()) {
            return Some(counter.clone());
        }
        if self.open.contains(&local) {
            return None;
        }
        self.open.push(local);
        self.intervals.fuel.step(self.frame.stores.len());
        let mut values = Some(match self.frame.function.local_variables[local].init {
            Some(init) => self.get(init, kind, depth),
            None => Interval::exactly(0),
        });
        for store in self.frame.stores.iter().filter(|store| store.local == local) {
            let value = match store.value {
                Some(value) if store.path.is_empty() => Some(self.get(value, kind, depth)),
                _ => None,
            };
            values = values.zip(value).map(|(known, value)| known.or(value));
        }
        self.open.pop();
        values
    }
}

fn whole(literal: Literal) -> Option<i64> {
    match literal {
        Literal::U32(value) => Some(i64::from(value)),
        Literal::I32(value) => Some(i64::from(value)),
        _ => None,
    }
}

fn min(a: Interval, b: &Interval) -> Interval {
    a.with(b, |a, b| (a.0.min(b.0), a.1.min(b.1)))
}

fn max(a: Interval, b: &Interval) -> Interval {
    a.with(b, |a, b| (a.0.max(b.0), a.1.max(b.1)))
}

/// Exact interval arithmetic; operands are 32-bit, so that nothing here overflows 64 bits.
fn binary(op: BinaryOperator, left: Interval, right: &Interval) -> Option<Interval> {
    let corners = |a: (i64, i64), b: (i64, i64), of: fn(i64, i64) -> i64| {
        let all = [of(a.0, b.0), of(a.0, b.1), of(a.1, b.0), of(a.1, b.1)];
        all.iter().fold((i64::MAX, i64::MIN), |(low, high), value| {
            (low.min(*value), high.max(*value))
        })
    };
    let non_negative = left.low >= 0 && right.low >= 0;
    match op {
        BinaryOperator::Add => Some(left.with(right, |a, b| (a.0 + b.0, a.1 + b.1))),
        BinaryOperator::Subtract => Some(left.with(right, |a, b| (a.0 - b.1, a.1 - b.0))),
        BinaryOperator::Multiply => Some(left.with(right, |a, b| corners(a, b, i64::saturating_mul))),
        BinaryOperator::Divide if right.low > 0 => Some(left.with(right, |a, b| corners(a, b, |a, b| a / b))),
        BinaryOperator::Modulo if non_negative && right.low > 0 => Some(left.with(right, |a, b| (0, a.1.min(b.1 - 1)))),
        BinaryOperator::And if non_negative => Some(left.with(right, |a, b| (0, a.1.min(b.1)))),
        BinaryOperator::ShiftLeft if non_negative && right.high < 32 => {
            Some(left.with(right, |a, b| (a.0 << b.0, a.1 << b.1)))
        }
        BinaryOperator::ShiftRight if non_negative && right.high < 32 => {
            Some(left.with(right, |a, b| (a.0 >> b.1, a.1 >> b.0)))
        }
        _ => None,
    }
}
