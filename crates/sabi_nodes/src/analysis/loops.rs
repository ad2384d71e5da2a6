//! Checks that every loop has a bound that follows from the code, and limits the total rounds of all loops for a texel.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Block, Function, Handle, Module, Span, Statement};

use super::Root;
use super::bounds::bound;
use super::effort::Effort;
use super::fuel::Fuel;
use super::interval::{Interval, IntervalFrame, Intervals};
use super::walk::stores;
use crate::fault::{FAULTS_SHOWN, Fault};
use crate::kind::Param;
use crate::link::LinkedModule;
use crate::params::params_type;

/// Maximum number of rounds and calls of a function for a texel, with all its rays: the work for a texel can be neither
/// split nor interrupted.
const ROUNDS_LIMIT: u64 = 1 << 16;

/// Maximum number of operations of a function for a texel, with all its rays, as counted by [`Effort`].
const WORK_LIMIT: u64 = 1 << 24;

const LOOP_FORM: &str = "Write `for (var i = 0u; i < N; i++)`, where N is a constant, a `u32` or `i32` parameter with `@range`, \
                    or min() or clamp() with a constant; leave early with `break`.";

const NOT_COUNTED: &str = "The rounds and calls of this function cannot be counted: functions call each other with too many different whole numbers.";
const NOT_COUNTED_ADVICE: &str = "Call functions less often, or hand over as `f32` what bounds no loop.";

/// Checks all loops that `roots` reach. Returns the parameters that bound a loop, and the work of all roots for a texel.
pub(super) fn check(
    linked: &LinkedModule,
    module: &Module,
    params: &[Param],
    roots: &[Root<'_>],
    faults: &mut Vec<Fault>,
) -> (BTreeSet<usize>, u64) {
    let mut counter = Counter {
        linked,
        intervals: Intervals {
            module,
            params_type: params_type(module).map(|(handle, _)| handle),
            params,
            fuel: Fuel::new(),
        },
        known: BTreeMap::new(),
        bounding: BTreeSet::new(),
        call_site: None,
        faults: Vec::new(),
    };
    let mut work: u64 = 0;
    for root in roots {
        work = work.saturating_add(counter.root(root));
        if counter.intervals.fuel.is_empty() {
            break;
        }
    }
    for fault in counter.faults {
        if !faults.contains(&fault) {
            faults.push(fault);
        }
    }
    (counter.bounding, work)
}

/// Returns message and advice for a function with too many rounds.
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
    intervals: Intervals<'m>,
    /// Efforts that were computed already, by function and intervals of the arguments.
    known: BTreeMap<(usize, Vec<Option<Interval>>), Effort>,
    bounding: BTreeSet<usize>,
    /// The call in the node's text that leads into a library.
    call_site: Option<Span>,
    faults: Vec<Fault>,
}

impl<'m> Counter<'_, 'm> {
    /// Returns the work of a documented function for a texel. Reports a fault if it is too much or cannot be counted.
    fn root(&mut self, root: &Root<'_>) -> u64 {
        let arguments = vec![None; self.intervals.module.functions[root.handle].arguments.len()];
        let effort = self.function(root.handle, arguments);
        let work = effort.work.saturating_mul(root.calls);
        let fault = if self.intervals.fuel.is_empty() {
            self.faults.clear();
            (NOT_COUNTED.to_owned(), NOT_COUNTED_ADVICE)
        } else if effort.rounds.saturating_mul(root.calls) > ROUNDS_LIMIT {
            too_many(effort.rounds, root.calls)
        } else if work > WORK_LIMIT {
            let message =
                format!("This function takes up to {work} operations for each texel; {WORK_LIMIT} are allowed.");
            (message, "Make loops shorter, or do less in each round.")
        } else {
            return work;
        };
        if self.faults.is_empty() {
            let span = Span::from(root.item.name_range.clone());
            self.faults.push(self.linked.fault(span, fault.0, fault.1));
        }
        work
    }

    /// Returns the effort of a function, which is at least one call.
    fn function(&mut self, handle: Handle<Function>, arguments: Vec<Option<Interval>>) -> Effort {
        let key = (handle.index(), arguments);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let function = &self.intervals.module.functions[handle];
        // Counted twice, since the frame holds a copy.
        let bytes = 2 * key.1.iter().map(bytes_of).sum::<usize>();
        let fuel = &self.intervals.fuel;
        if !fuel.remember(size_of_val(&key) + bytes) || !fuel.step(function.expressions.len()) {
            return Effort::default();
        }
        let mut frame = IntervalFrame {
            function,
            arguments: key.1.clone(),
            stores: stores(function, &function.body),
            counters: BTreeMap::new(),
        };
        let mut effort = self.block(&mut frame, &function.body);
        effort.rounds = effort.rounds.max(1);
        self.known.insert(key, effort);
        effort
    }

    fn block(&mut self, frame: &mut IntervalFrame<'m>, block: &'m Block) -> Effort {
        let mut sum = Effort::default();
        for (statement, span) in block.span_iter() {
            if !self.intervals.fuel.step(1) {
                break;
            }
            sum = sum.and(self.statement(frame, statement, *span));
        }
        sum
    }

    fn statement(&mut self, frame: &mut IntervalFrame<'m>, statement: &'m Statement, span: Span) -> Effort {
        match statement {
            Statement::Emit(range) => Effort::of_expressions(frame.function, range.clone()),
            Statement::Block(block) => self.block(frame, block),
            Statement::If { accept, reject, .. } => {
                let accept = self.block(frame, accept);
                accept.or(self.block(frame, reject))
            }
            Statement::Switch { cases, .. } => {
                // Only one case is executed, together with the cases that it falls through to.
                let (mut taken, mut most) = (Effort::default(), Effort::default());
                for case in cases {
                    taken = self.block(frame, &case.body).and(taken);
                    most = most.or(taken);
                    if !case.fall_through {
                        taken = Effort::default();
                    }
                }
                most
            }
            Statement::Loop {
                body,
                continuing,
                break_if,
            } => self.whole_loop(frame, span, [body, continuing], break_if.is_some()),
            Statement::Call {
                function, arguments, ..
            } => {
                let arguments = arguments
                    .iter()
                    .map(|argument| self.intervals.of(frame, *argument))
                    .collect();
                let outer = self.call_site;
                if self.linked.is_in_node(span) {
                    self.call_site = Some(span);
                }
                let effort = self.function(*function, arguments);
                self.call_site = outer;
                effort
            }
            _ => Effort::default(),
        }
    }

    /// Returns the effort of all rounds of a loop. Reports a fault if their number is unknown or too large.
    fn whole_loop(
        &mut self,
        frame: &mut IntervalFrame<'m>,
        span: Span,
        [body, continuing]: [&'m Block; 2],
        breaks_if: bool,
    ) -> Effort {
        let bounded = if breaks_if {
            Err("This loop has no known bound.".to_owned())
        } else {
            bound(&self.intervals, frame, body, continuing)
        };
        let bounded = match bounded {
            Ok(bounded) => bounded,
            Err(message) => {
                self.refuse(frame, span, message, LOOP_FORM);
                return Effort::default().times(1);
            }
        };
        self.bounding.extend(&bounded.values.params);
        let index = bounded.counter.index();
        frame.counters.insert(index, bounded.values);
        let body = self.block(frame, body);
        // In the continuing block the counter may exceed the values that it has in the body.
        frame.counters.remove(&index);
        let round = body.and(self.block(frame, continuing));
        let all = round.times(bounded.rounds);
        let inner = round.rounds.max(1);
        if all.rounds > ROUNDS_LIMIT && inner <= ROUNDS_LIMIT {
            let rounds = all.rounds;
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
        all
    }

    /// Reports a fault at the loop, or, if the loop is in a library, at the call that leads to it.
    fn refuse(&mut self, frame: &IntervalFrame<'_>, span: Span, message: String, advice: &str) {
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
        if self.faults.len() < FAULTS_SHOWN {
            self.faults.push(fault);
        }
    }
}

/// Returns the memory taken by the interval of an argument.
fn bytes_of(argument: &Option<Interval>) -> usize {
    let params = argument.as_ref().map_or(0, |interval| interval.params.len());
    // A node of a tree map holds up to eleven values.
    size_of::<Option<Interval>>() + if params > 0 { 128 + 32 * params } else { 0 }
}
