//! Executes plans with symbols instead of pixels: a slot holds a hash of the call that filled it and of all its arguments.
//! This detects a slot that is reused too early, read before it is filled, or read on the wrong level.

use std::collections::BTreeSet;

use sabi_nodes::link::{Binding, Call, Convert, Domain, Operand, Plane, channel_bits};

use super::WIDTHS;
use crate::{Grouping, KernelStep, Level, Plan, Slot, SlotExtent, Step};

pub(super) fn hash(parts: &[&[u8]]) -> u64 {
    let mut hash = blake3::Hasher::new();
    for part in parts {
        hash.update(&(part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    let bytes = hash.finalize();
    u64::from_le_bytes(bytes.as_bytes()[..8].try_into().unwrap())
}

/// Arguments of a function call, as symbols.
#[derive(Default)]
pub(super) struct CallArguments {
    pub(super) inputs: Vec<(u64, Convert)>,
    /// For each pass of the kind its symbol; 0 if the function does not read the pass.
    pub(super) passes: Vec<u64>,
    pub(super) survey: Option<u64>,
}

pub(super) const OPEN: (u64, Convert) = (0, Convert::None);
/// Symbol of the normals of all texels.
const NORMALS: u64 = 1;

pub(super) fn call_symbol(kind: &str, function: &str, params: &[u8], given: &CallArguments) -> u64 {
    let inputs: Vec<u8> = given
        .inputs
        .iter()
        .flat_map(|(symbol, convert)| [symbol.to_le_bytes().as_slice(), &[*convert as u8]].concat())
        .collect();
    let taken = given.passes.iter().any(|pass| *pass != 0);
    let passes: Vec<u8> = given
        .passes
        .iter()
        .filter(|_| taken)
        .flat_map(|pass| pass.to_le_bytes())
        .collect();
    let survey: Vec<u8> = given.survey.iter().flat_map(|survey| survey.to_le_bytes()).collect();
    hash(&[kind.as_bytes(), function.as_bytes(), params, &inputs, &passes, &survey])
}

pub(super) fn source_symbol(id: &str, output: &str) -> u64 {
    hash(&[b"source", id.as_bytes(), output.as_bytes()])
}

pub(super) fn converted(symbol: u64, convert: Convert) -> u64 {
    match convert {
        Convert::None => symbol,
        _ => hash(&[b"converted", &symbol.to_le_bytes(), &[convert as u8]]),
    }
}

pub(super) fn surveyed(symbol: u64) -> u64 {
    hash(&[b"surveyed", &symbol.to_le_bytes()])
}

/// Returns the symbol of a plane moved to another level: by way of the finest level, and to points by way of the texels of their cells.
pub(super) fn moved(symbol: u64, from: Level, to: Level) -> u64 {
    if from == to {
        return symbol;
    }
    if let Level::Points(number) = to {
        let cells = WIDTHS.cells_of_points(number);
        return moved_once(moved(symbol, from, cells), cells, to);
    }
    if from == Level::FINEST || to == Level::FINEST {
        return moved_once(symbol, from, to);
    }
    moved(moved(symbol, from, Level::FINEST), Level::FINEST, to)
}

/// Symbol of a plane that one step moves.
fn moved_once(symbol: u64, from: Level, to: Level) -> u64 {
    hash(&[b"moved", &symbol.to_le_bytes(), &from.bytes(), &to.bytes()])
}

/// Content of a slot.
#[derive(Clone, Copy)]
struct SlotContent {
    symbol: u64,
    plane: Plane,
    /// The step that filled it.
    step: usize,
}

/// Execution of a plan.
struct Execution<'p> {
    plan: &'p Plan,
    slots: Vec<Option<SlotContent>>,
    /// Moves that were executed: the step that produced the plane, its slot, and the target level.
    moves: BTreeSet<(usize, usize, Level)>,
    step: usize,
}

/// Executes a plan and returns the symbols of its results.
pub(super) fn from_plan(plan: &Plan) -> Vec<u64> {
    let mut execution = Execution {
        plan,
        slots: vec![None; plan.slots.len()],
        moves: BTreeSet::new(),
        step: 0,
    };
    for (at, step) in plan.steps.iter().enumerate() {
        execution.step = at;
        execution.carry_out(step);
    }
    let results = plan.results.iter().map(|result| {
        let planes = result.stored.planes();
        let held: Vec<SlotContent> = result
            .slots
            .iter()
            .map(|slot| execution.read(*slot, SlotExtent::Level(Level::FINEST)))
            .collect();
        assert!(held.iter().zip(&planes).all(|(held, plane)| held.plane == *plane));
        held[0].symbol
    });
    results.collect()
}

impl Execution<'_> {
    fn carry_out(&mut self, step: &Step) {
        match step {
            Step::Source(source) => {
                for (output, planes) in &source.writes {
                    for (plane, slot) in planes {
                        self.write(
                            *slot,
                            SlotExtent::Level(Level::FINEST),
                            source_symbol(&source.id, output),
                            *plane,
                        );
                    }
                }
            }
            Step::Survey(step) => {
                let table = surveyed(self.read(step.from, SlotExtent::Level(Level::FINEST)).symbol);
                let extent = match step.each {
                    Grouping::Whole => SlotExtent::Survey,
                    Grouping::Part | Grouping::Piece | Grouping::Chart => SlotExtent::GroupSurvey,
                };
                self.write(step.to, extent, table, Plane::Vector);
            }
            Step::Move(step) => {
                let [from, to] = step.levels;
                let is_step = from == Level::FINEST || to == Level::FINEST || matches!(to, Level::Points(_));
                assert!(from != to && is_step, "from {from} to {to}");
                let held = self.read(step.from, SlotExtent::Level(from));
                assert!(self.moves.insert((held.step, step.from, to)), "moved to {to} twice");
                assert_eq!(step.format, held.plane.format());
                self.write(
                    step.to,
                    SlotExtent::Level(to),
                    moved_once(held.symbol, from, to),
                    held.plane,
                );
            }
            Step::Kernel(kernel) => self.run(kernel),
        }
    }

    fn read(&self, slot: usize, extent: SlotExtent) -> SlotContent {
        assert_eq!(
            self.plan.slots[slot].extent, extent,
            "the extent that step {} reads",
            self.step
        );
        self.slots[slot].unwrap()
    }

    fn write(&mut self, slot: usize, extent: SlotExtent, symbol: u64, plane: Plane) {
        let format = plane.format();
        assert_eq!(
            self.plan.slots[slot],
            Slot { format, extent },
            "what step {} writes",
            self.step
        );
        let step = self.step;
        self.slots[slot] = Some(SlotContent { symbol, plane, step });
    }

    fn run(&mut self, kernel: &KernelStep) {
        let times = kernel.feedback.as_ref().map_or(1, |feedback| feedback.run_count);
        let extent = match kernel.spec.domain {
            Domain::Once => SlotExtent::Single,
            Domain::Groups => SlotExtent::Groups,
            Domain::AllTexels | Domain::OwnedTexels | Domain::OwnedTexelsByRays => SlotExtent::Level(kernel.level),
        };
        let mut last = None;
        for round in 0..times {
            let mut reads = kernel.reads.clone();
            let mut writes = kernel.writes.clone();
            if let Some(feedback) = &kernel.feedback {
                if last.is_some() {
                    reads[feedback.read] = last;
                }
                if (times - 1 - round) % 2 == 1 {
                    writes[0] = Some(feedback.scratch);
                }
                last = writes[0];
            }
            let symbols = self.calls(kernel, &reads);
            let mut at = 0;
            for store in &kernel.spec.stores {
                for plane in store.stored.planes() {
                    if let Some(slot) = writes[at] {
                        assert!(!reads.contains(&Some(slot)), "a kernel reads what it writes");
                        let symbol = self.stored_symbol(kernel, store.value, &symbols, &reads);
                        self.write(slot, extent, symbol, plane);
                    }
                    at += 1;
                }
            }
        }
    }

    fn calls(&self, kernel: &KernelStep, reads: &[Option<usize>]) -> Vec<u64> {
        let mut symbols: Vec<u64> = Vec::new();
        for call in &kernel.spec.calls {
            let inputs = (0..call.inputs.len()).map(|input| self.input_symbol(kernel, call, input, &symbols, reads));
            let pass = |load: &Option<usize>| load.map_or(0, |load| self.held(kernel, load, reads));
            let given = CallArguments {
                inputs: inputs.collect(),
                passes: call.passes.iter().map(pass).collect(),
                survey: call.survey.map(|load| self.held(kernel, load, reads)),
            };
            let params = &kernel.blocks[call.block].params;
            symbols.push(call_symbol(&call.kind, &call.function, params, &given));
        }
        symbols
    }

    /// Symbol of a stored value: a call's result, or a load that is converted.
    fn stored_symbol(&self, kernel: &KernelStep, value: Operand, symbols: &[u64], reads: &[Option<usize>]) -> u64 {
        match value {
            Operand::Call(call, Convert::None) => symbols[call],
            Operand::Load(load, convert) => converted(self.held(kernel, load, reads), convert),
            Operand::Normal(_) => NORMALS,
            other => panic!("{other:?} is never stored"),
        }
    }

    /// Symbol that all planes of a load hold.
    fn held(&self, kernel: &KernelStep, load: usize, reads: &[Option<usize>]) -> u64 {
        let first: usize = kernel.spec.loads[..load]
            .iter()
            .map(|stored| stored.planes().len())
            .sum();
        let planes = kernel.spec.loads[load].planes().len();
        let symbols = reads[first..first + planes].iter().flatten().map(|slot| {
            let takes = |call: &Call| call.passes.contains(&Some(load));
            let extent = match self.plan.slots[*slot].extent {
                // A pass reads the whole table, and other functions read the value that was found in it.
                SlotExtent::Survey if kernel.spec.domain == Domain::Once => SlotExtent::Survey,
                SlotExtent::GroupSurvey if kernel.spec.domain == Domain::Groups => SlotExtent::GroupSurvey,
                SlotExtent::Groups if kernel.level == Level::FINEST && kernel.spec.calls.iter().any(takes) => {
                    SlotExtent::Groups
                }
                SlotExtent::Single if kernel.level == Level::FINEST && kernel.spec.calls.iter().any(takes) => {
                    SlotExtent::Single
                }
                _ => SlotExtent::Level(kernel.level),
            };
            self.read(*slot, extent).symbol
        });
        let symbols: Vec<u64> = symbols.collect();
        assert!(
            symbols.windows(2).all(|pair| pair[0] == pair[1]),
            "planes of different results"
        );
        symbols.first().copied().unwrap_or(0)
    }

    fn input_symbol(
        &self,
        kernel: &KernelStep,
        call: &Call,
        input: usize,
        symbols: &[u64],
        reads: &[Option<usize>],
    ) -> (u64, Convert) {
        let held = |load| self.held(kernel, load, reads);
        match call.inputs[input] {
            Binding::Default => OPEN,
            Binding::Value(Operand::Call(from, convert)) => (symbols[from], convert),
            Binding::Value(Operand::Load(load, convert)) => (held(load), convert),
            Binding::Value(Operand::Normal(_)) => panic!("no node is given the normals"),
            Binding::Field(load) => (held(load), Convert::None),
            Binding::Switch(load) => match (kernel.flags[0] >> (2 * input)) & 3 {
                0 => OPEN,
                2 => (held(load), Convert::Gray),
                3 => (held(load), Convert::Luminance),
                _ => {
                    let is_material = |load: usize| kernel.spec.loads[load].planes().len() > 1;
                    let before = call.inputs[..input].iter();
                    let before = before.filter(|input| matches!(input, Binding::Switch(load) if is_material(*load)));
                    let (word, shift) = channel_bits(before.count());
                    let present = kernel.flags[word] >> shift;
                    assert!(
                        !is_material(load) || present & 3 == 3,
                        "a material has at least color and surface"
                    );
                    (held(load), Convert::None)
                }
            },
        }
    }
}
