//! Checks that every loop has a bound that follows from the code, and limits the rounds of all loops for a texel.

use std::collections::{BTreeMap, BTreeSet};

use naga::{BinaryOperator, Block, Expression, Function, Handle, LocalVariable, Module, ScalarKind, Span, Statement};

use super::Root;
use super::interval::{Frame, Interval, Reader};
use super::walk::{conjuncts, stores};
use crate::fault::Fault;
use crate::kind::Param;
use crate::link::LinkedModule;
use crate::params::params_type;

/// Most rounds and calls of a function for a texel, with all its rays: the work for a texel cannot be split or
/// interrupted.
const ROUNDS_LIMIT: u64 = 1 << 16;

const LOOP_FORM: &str = "Write `for (var i = 0u; i < N; i++)`, where N is a constant, a `u32` or `i32` parameter with `@range`, \
                    or min() or clamp() with a constant; leave early with `break`.";

/// Checks all loops that `roots` reach; gives the parameters that bound one.
pub(super) fn check(
    linked: &LinkedModule,
    module: &Module,
    params: &[Param],
    roots: &[Root<'_>],
    faults: &mut Vec<Fault>,
) -> BTreeSet<usize> {
    let mut counter = Counter {
        linked,
        reader: Reader {
            module,
            params_type: params_type(module).map(|(handle, _)| handle),
            params,
        },
        known: BTreeMap::new(),
        bounding: BTreeSet::new(),
        call_site: None,
        faults: Vec::new(),
    };
    for root in roots {
        let arguments = vec![None; module.functions[root.handle].arguments.len()];
        let rounds = counter.function(root.handle, arguments);
        if rounds.saturating_mul(root.calls) > ROUNDS_LIMIT && counter.faults.is_empty() {
            let span = Span::from(root.item.name_range.clone());
            let (message, advice) = too_many(rounds, root.calls);
            counter.faults.push(linked.fault(span, message, advice));
        }
    }
    for fault in counter.faults {
        if !faults.contains(&fault) {
            faults.push(fault);
        }
    }
    counter.bounding
}

/// Message and advice for a function with too many rounds.
fn too_many(rounds: u64, rays: u64) -> (String, &'static str) {
    if rays == 1 {
        let message =
            format!("This function takes up to {rounds} rounds and calls for each texel; {ROUNDS_LIMIT} are allowed.");
        return (message, "Make loops shorter, or call less.");
    }
    let all = rounds.saturating_mul(rays);
    let message = format!(
        "This function takes up to {rounds} rounds and calls for each of up to {rays} rays, {all} for each texel; \
         {ROUNDS_LIMIT} are allowed."
    );
    (
        message,
        "Make loops shorter, call less, or let the `@range` of the rays end earlier.",
    )
}

struct Counter<'a, 'm> {
    linked: &'a LinkedModule,
    reader: Reader<'m>,
    /// Rounds of a function by the intervals of its arguments.
    known: BTreeMap<(usize, Vec<Option<Interval>>), u64>,
    bounding: BTreeSet<usize>,
    /// The call in the node's text that leads into a library.
    call_site: Option<Span>,
    faults: Vec<Fault>,
}

/// A loop with a known bound.
struct BoundedLoop {
    counter: Handle<LocalVariable>,
    values: Interval,
    rounds: u64,
}

impl<'m> Counter<'_, 'm> {
    /// Rounds and calls of a function, at least 1.
    fn function(&mut self, handle: Handle<Function>, arguments: Vec<Option<Interval>>) -> u64 {
        let key = (handle.index(), arguments);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let function = &self.reader.module.functions[handle];
        let mut frame = Frame {
            function,
            arguments: key.1.clone(),
            stores: stores(function, &function.body),
            counters: BTreeMap::new(),
        };
        let rounds = self.block(&mut frame, &function.body).max(1);
        self.known.insert(key, rounds);
        rounds
    }

    fn block(&mut self, frame: &mut Frame<'m>, block: &'m Block) -> u64 {
        let mut rounds: u64 = 0;
        for (statement, span) in block.span_iter() {
            let more = match statement {
                Statement::Block(block) => self.block(frame, block),
                Statement::If { accept, reject, .. } => {
                    let accept = self.block(frame, accept);
                    accept.max(self.block(frame, reject))
                }
                Statement::Switch { cases, .. } => {
                    // Only one case is taken, with those that it falls through to.
                    let (mut taken, mut most) = (0, 0);
                    for case in cases {
                        taken = self.block(frame, &case.body).saturating_add(taken);
                        most = most.max(taken);
                        if !case.fall_through {
                            taken = 0;
                        }
                    }
                    most
                }
                Statement::Loop {
                    body,
                    continuing,
                    break_if,
                } => self.loop_rounds(frame, *span, body, continuing, break_if.is_some()),
                Statement::Call {
                    function, arguments, ..
                } => {
                    let arguments = arguments
                        .iter()
                        .map(|argument| self.reader.interval(frame, *argument))
                        .collect();
                    let outer = self.call_site;
                    if self.linked.is_in_node(*span) {
                        self.call_site = Some(*span);
                    }
                    let rounds = self.function(*function, arguments);
                    self.call_site = outer;
                    rounds
                }
                _ => 0,
            };
            rounds = rounds.saturating_add(more);
        }
        rounds
    }

    fn loop_rounds(
        &mut self,
        frame: &mut Frame<'m>,
        span: Span,
        body: &'m Block,
        continuing: &'m Block,
        breaks_if: bool,
    ) -> u64 {
        let bounded = if breaks_if {
            Err("This loop has no known bound.".to_owned())
        } else {
            self.bound(frame, body, continuing)
        };
        let bounded = match bounded {
            Ok(bounded) => bounded,
            Err(message) => {
                self.refuse(frame, span, message, LOOP_FORM);
                return 1;
            }
        };
        self.bounding.extend(&bounded.values.params);
        let index = bounded.counter.index();
        frame.counters.insert(index, bounded.values);
        let inner = self.block(frame, body).max(1);
        frame.counters.remove(&index);
        let rounds = bounded.rounds.saturating_mul(inner);
        if rounds > ROUNDS_LIMIT && inner <= ROUNDS_LIMIT {
            let message = if inner > 1 {
                format!(
                    "This loop takes up to {} × {inner} = {rounds} rounds for each texel; {ROUNDS_LIMIT} are allowed.",
                    bounded.rounds
                )
            } else {
                format!("This loop takes up to {rounds} rounds for each texel; {ROUNDS_LIMIT} are allowed.")
            };
            self.refuse(frame, span, message, "Make it, or what it does each round, shorter.");
        }
        rounds
    }

    /// Reports a fault at the loop, or at the call that leads to it where it is in a library.
    fn refuse(&mut self, frame: &Frame<'_>, span: Span, message: String, advice: &str) {
        let fault = match (self.call_site, self.linked.library_at(span), &frame.function.name) {
            (Some(call_site), Some(library), Some(name)) => {
                let message = format!("In `{name}` of lib/{library}.wgsl, which this calls: {message}");
                self.linked.fault(
                    call_site,
                    message,
                    "Pass arguments whose range is known, such as a parameter with `@range`.",
                )
            }
            _ => self.linked.fault(span, message, advice),
        };
        self.faults.push(fault);
    }

    /// Bound of a loop of the form of `for`, or why it cannot be found.
    fn bound(&self, frame: &Frame<'m>, body: &'m Block, continuing: &'m Block) -> Result<BoundedLoop, String> {
        let not_seen = "This loop has no known bound.";
        let condition = loop_condition(body).ok_or(not_seen)?;
        let mut reason = not_seen.to_owned();
        for condition in conjuncts(frame.function, &frame.stores, condition) {
            let Some((counter, bound, strict)) = comparison(frame.function, condition) else {
                continue;
            };
            match self.bound_by_counter(frame, body, continuing, counter, bound, strict) {
                Ok(bounded) => return Ok(bounded),
                Err(why) => reason = why,
            }
        }
        Err(reason)
    }

    fn bound_by_counter(
        &self,
        frame: &Frame<'m>,
        body: &'m Block,
        continuing: &'m Block,
        counter: Handle<LocalVariable>,
        bound: Handle<Expression>,
        strict: bool,
    ) -> Result<BoundedLoop, String> {
        let name = frame.function.local_variables[counter]
            .name
            .as_deref()
            .unwrap_or("counter");
        let step = self.step(frame, continuing, counter).ok_or_else(|| {
            format!("The bound of this loop is not known, because nothing adds to `{name}` after each round.")
        })?;
        if stores(frame.function, body).iter().any(|store| store.local == counter) {
            return Err(format!(
                "The bound of this loop is not known, because the loop itself changes `{name}`."
            ));
        }
        let bound = self
            .reader
            .interval(frame, bound)
            .ok_or_else(|| "The bound of this loop is not known; count with `u32` or `i32`.".to_owned())?;
        let start = self.start(frame, continuing, counter);
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

    /// Interval of the counter before the first round.
    fn start(&self, frame: &Frame<'m>, continuing: &'m Block, counter: Handle<LocalVariable>) -> Interval {
        let own: Vec<_> = stores(frame.function, continuing)
            .iter()
            .map(|store| (store.pointer, store.value))
            .collect();
        let init = frame.function.local_variables[counter].init;
        let mut values = init.and_then(|init| self.reader.interval(frame, init));
        for store in frame.stores.iter().filter(|store| store.local == counter) {
            if own.contains(&(store.pointer, store.value)) {
                continue;
            }
            let value = store.value.and_then(|value| self.reader.interval(frame, value));
            let value = value.unwrap_or(Interval::unknown(ScalarKind::Sint));
            values = Some(match values {
                Some(known) => known.or(value),
                None => value,
            });
        }
        values.unwrap_or(Interval::exactly(0))
    }

    /// Step of the counter after each round: at least 1, added by one statement.
    fn step(&self, frame: &Frame<'m>, continuing: &'m Block, counter: Handle<LocalVariable>) -> Option<i64> {
        let all = stores(frame.function, continuing);
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
        let step = self.reader.interval(frame, right)?;
        (step.low >= 1).then_some(step.low)
    }
}

/// Condition under which the loop continues: the body starts with `if condition {} else { break; }`.
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
                // The form that naga gives to `&&`.
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

/// `counter < bound` (strict), `counter <= bound`, and the same the other way around.
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

/// The variable that an expression reads.
fn loaded(function: &Function, expression: Handle<Expression>) -> Option<Handle<LocalVariable>> {
    let Expression::Load { pointer } = function.expressions[expression] else {
        return None;
    };
    match function.expressions[pointer] {
        Expression::LocalVariable(local) => Some(local),
        _ => None,
    }
}
