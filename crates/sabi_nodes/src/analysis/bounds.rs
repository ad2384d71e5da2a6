//! Upper bounds for the number of rounds of a loop, where they follow from the code.

use naga::{BinaryOperator, Block, Expression, Function, Handle, LocalVariable, ScalarKind, Statement};

use super::interval::{Interval, IntervalFrame, Intervals};
use super::walk::{conjuncts, stores};

/// A loop with a known bound.
pub(super) struct BoundedLoop {
    pub(super) counter: Handle<LocalVariable>,
    pub(super) values: Interval,
    pub(super) rounds: u64,
}

/// Returns the bound of a loop that has the form of a `for` loop, or the reason why it cannot be found.
pub(super) fn bound<'m>(
    intervals: &Intervals<'m>,
    frame: &IntervalFrame<'m>,
    body: &'m Block,
    continuing: &'m Block,
) -> Result<BoundedLoop, String> {
    let not_seen = "This loop has no known bound.";
    let condition = loop_condition(body).ok_or(not_seen)?;
    let mut reason = not_seen.to_owned();
    for condition in conjuncts(frame.function, &frame.stores, condition) {
        let Some((counter, bound, strict)) = comparison(frame.function, condition) else {
            continue;
        };
        let counted = CountedLoop {
            intervals,
            frame,
            body,
            continuing,
            counter,
        };
        match counted.bound(bound, strict) {
            Ok(bounded) => return Ok(bounded),
            Err(why) => reason = why,
        }
    }
    Err(reason)
}

/// Loop that continues while a variable is below a bound.
struct CountedLoop<'a, 'm> {
    intervals: &'a Intervals<'m>,
    frame: &'a IntervalFrame<'m>,
    body: &'m Block,
    continuing: &'m Block,
    counter: Handle<LocalVariable>,
}

impl CountedLoop<'_, '_> {
    /// Returns the rounds while the counter is below `bound`, or at most `bound` if the comparison is not strict.
    fn bound(&self, bound: Handle<Expression>, strict: bool) -> Result<BoundedLoop, String> {
        let (frame, counter) = (self.frame, self.counter);
        // All assignments are traced for each comparison.
        self.intervals.fuel.step(frame.function.expressions.len());
        let name = frame.function.local_variables[counter]
            .name
            .as_deref()
            .unwrap_or("counter");
        let step = self.step().ok_or_else(|| {
            format!("The bound of this loop is not known, because nothing adds to `{name}` after each round.")
        })?;
        if stores(frame.function, self.body)
            .iter()
            .any(|store| store.local == counter)
        {
            return Err(format!(
                "The bound of this loop is not known, because the loop itself changes `{name}`."
            ));
        }
        let bound = self
            .intervals
            .of(frame, bound)
            .ok_or_else(|| "The bound of this loop is not known; count with `u32` or `i32`.".to_owned())?;
        let start = self.start();
        let last = if strict { bound.high - 1 } else { bound.high };
        let kind_high = if bound.high > i64::from(i32::MAX) {
            u32::MAX.into()
        } else {
            i64::from(i32::MAX)
        };
        let is_unknown = [ScalarKind::Uint, ScalarKind::Sint]
            .iter()
            .any(|kind| bound.high == Interval::unknown(*kind).high || start.low == i64::from(i32::MIN));
        if is_unknown || last + step > kind_high {
            return Err(format!(
                "The number of rounds of this loop is not known: nothing limits what `{name}` is compared with."
            ));
        }
        let rounds = if last < start.low {
            0
        } else {
            (last - start.low) / step + 1
        };
        let mut values = Interval::exactly(start.low.min(last)).or(Interval::exactly(last.max(start.low)));
        values.params.extend(bound.params.iter().chain(&start.params));
        Ok(BoundedLoop {
            counter,
            values,
            rounds: rounds.unsigned_abs(),
        })
    }

    /// Returns the interval of the counter before the first round.
    fn start(&self) -> Interval {
        let (frame, counter) = (self.frame, self.counter);
        let own: Vec<_> = stores(frame.function, self.continuing)
            .iter()
            .map(|store| (store.pointer, store.value))
            .collect();
        let init = frame.function.local_variables[counter].init;
        let mut values = init.and_then(|init| self.intervals.of(frame, init));
        for store in frame.stores.iter().filter(|store| store.local == counter) {
            if own.contains(&(store.pointer, store.value)) {
                continue;
            }
            let value = store.value.and_then(|value| self.intervals.of(frame, value));
            let value = value.unwrap_or(Interval::unknown(ScalarKind::Sint));
            values = Some(match values {
                Some(known) => known.or(value),
                None => value,
            });
        }
        values.unwrap_or(Interval::exactly(0))
    }

    /// Returns the step of the counter after each round: at least 1, added by one statement.
    fn step(&self) -> Option<i64> {
        let (frame, counter) = (self.frame, self.counter);
        let all = stores(frame.function, self.continuing);
        let mut own = all.iter().filter(|store| store.local == counter);
        let (store, None) = (own.next()?, own.next()) else {
            return None;
        };
        let Expression::Binary {
            op: BinaryOperator::Add,
            left,
            right,
        } = frame.function.expressions[store.value?]
        else {
            return None;
        };
        let is_straight = store.path.is_empty() && store.conditions.is_empty();
        if !is_straight || loaded(frame.function, left) != Some(counter) {
            return None;
        }
        let step = self.intervals.of(frame, right)?;
        (step.low >= 1).then_some(step.low)
    }
}

/// Returns the condition under which the loop continues: the body starts with `if condition {} else { break; }`.
fn loop_condition(body: &Block) -> Option<Handle<Expression>> {
    for statement in body {
        match statement {
            Statement::If {
                condition,
                accept,
                reject,
            } => {
                let leaves = matches!(reject.iter().collect::<Vec<_>>()[..], [Statement::Break]);
                if leaves && accept.is_empty() {
                    return Some(*condition);
                }
                // naga translates `&&` to this form.
                let only_stores = |block: &Block| {
                    block.iter().all(|statement| {
                        matches!(
                            statement,
                            Statement::Emit(_) | Statement::Store { .. } | Statement::Call { .. }
                        )
                    })
                };
                if !only_stores(accept) || !only_stores(reject) {
                    return None;
                }
            }
            Statement::Emit(_) | Statement::Call { .. } => {}
            _ => return None,
        }
    }
    None
}

/// Returns the sides of `counter < bound` (strict) or `counter <= bound`, also when they are swapped.
fn comparison(
    function: &Function,
    condition: Handle<Expression>,
) -> Option<(Handle<LocalVariable>, Handle<Expression>, bool)> {
    let Expression::Binary { op, left, right } = function.expressions[condition] else {
        return None;
    };
    let (counter, bound, strict) = match op {
        BinaryOperator::Less => (left, right, true),
        BinaryOperator::LessEqual => (left, right, false),
        BinaryOperator::Greater => (right, left, true),
        BinaryOperator::GreaterEqual => (right, left, false),
        _ => return None,
    };
    Some((loaded(function, counter)?, bound, strict))
}

/// Returns the variable that an expression reads.
fn loaded(function: &Function, expression: Handle<Expression>) -> Option<Handle<LocalVariable>> {
    let Expression::Load { pointer } = function.expressions[expression] else {
        return None;
    };
    match function.expressions[pointer] {
        Expression::LocalVariable(local) => Some(local),
        _ => None,
    }
}
