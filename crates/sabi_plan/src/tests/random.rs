//! Random graphs: whatever way a plan is cut, each result is made of what the graph says.
//!
//! A plan is carried out with symbols in place of pixels: a slot holds a hash of the call that filled it and of all that
//! went into it. A slot given away too early, or read before it is filled, changes the hash of the result.

use std::collections::BTreeMap;

use proptest::prelude::*;
use sabi_graph::FlatGraph;
use sabi_nodes::formula::Formula;
use sabi_nodes::kind::ParamValue;
use sabi_nodes::link::{Binding, Call, Convert, INPUTS_A_WORD, Plane};

use super::{Bench, FUSED, UNFUSED, graph};
use crate::resolve::Behavior;
use crate::{KernelStep, Limits, Mode, Plan, Planner, Step};

/// Ports by name and type.
type Ports = &'static [(&'static str, char)];

/// Kinds with their inputs (name, accepts) and their results (name, type): m mask, c color, M material.
const KINDS: &[(&str, Ports, Ports)] = &[
    ("noise/simplex", &[], &[("mask", 'm')]),
    ("noise/cells", &[], &[("mask", 'm'), ("id", 'm')]),
    ("adjust/invert", &[("source", 'm')], &[("mask", 'm')]),
    (
        "blend/mask",
        &[("below", 'm'), ("above", 'm'), ("mask", 'm')],
        &[("mask", 'm')],
    ),
    ("color/gradient", &[("source", 'm')], &[("color", 'c')]),
    ("filter/smooth", &[("source", 'm')], &[("mask", 'm')]),
    ("source/material", &[], &[("material", 'M')]),
    ("source/model", &[], &[("material", 'M')]),
    (
        "effect/layer",
        &[("base", 'M'), ("mask", 'm'), ("color_map", 'c'), ("height_map", 'm')],
        &[("material", 'M')],
    ),
    (
        "material/blend",
        &[("below", 'M'), ("above", 'M'), ("mask", 'm')],
        &[("material", 'M')],
    ),
];

/// Lines of a graph from random numbers: each node takes a kind, and for each input a result before it, or nothing.
fn lines(numbers: &[(usize, [usize; 4])]) -> String {
    let mut made: Vec<(String, char)> = Vec::new();
    let mut text = String::new();
    for (at, (kind, picks)) in numbers.iter().enumerate() {
        let (id, inputs, outputs) = KINDS[kind % KINDS.len()];
        let mut line = format!("n{at} {id}");
        for ((input, takes), pick) in inputs.iter().zip(picks) {
            let fits = |ty: char| ty == *takes || (ty != 'M' && *takes != 'M');
            let field = id == "filter/smooth";
            let fitting: Vec<&(String, char)> = made.iter().filter(|(_, ty)| fits(*ty)).collect();
            // A field's source must be connected; other inputs stay open now and then.
            let open = !field && pick % 5 == 0;
            match fitting.get(pick % fitting.len().max(1)) {
                Some((name, _)) if !open => line += &format!(" {input}={name}"),
                None if field => line = format!("n{at} noise/simplex seed={pick}"),
                _ => {}
            }
        }
        if id == "filter/smooth" && line.contains("source=") {
            line += &format!(" steps={}", 1 + picks[1] % 4);
        }
        let results = if line.contains("noise/simplex") {
            KINDS[0].2
        } else {
            outputs
        };
        made.extend(results.iter().map(|(name, ty)| (format!("n{at}.{name}"), *ty)));
        text += &(line + "\n");
    }
    for (at, (name, ty)) in made.iter().rev().take(3).enumerate() {
        let (kind, port) = if *ty == 'M' {
            ("output/material", "material")
        } else {
            ("output/mask", "source")
        };
        text += &format!("out{at} {kind} {port}={name}\n");
    }
    text
}

fn hash(parts: &[&[u8]]) -> u64 {
    let mut hash = blake3::Hasher::new();
    for part in parts {
        hash.update(&(part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    let bytes = hash.finalize();
    u64::from_le_bytes(bytes.as_bytes()[..8].try_into().unwrap())
}

fn call_symbol(kind: &str, function: &str, params: &[u8], inputs: &[(u64, Convert)]) -> u64 {
    let inputs: Vec<u8> = inputs
        .iter()
        .flat_map(|(symbol, convert)| [symbol.to_le_bytes().as_slice(), &[*convert as u8]].concat())
        .collect();
    hash(&[kind.as_bytes(), function.as_bytes(), params, &inputs])
}

fn source_symbol(id: &str, output: &str) -> u64 {
    hash(&[b"source", id.as_bytes(), output.as_bytes()])
}

const OPEN: (u64, Convert) = (0, Convert::None);

/// What each result is made of, by the graph alone.
fn from_graph(planner: &Planner<'_>, graph: &FlatGraph) -> BTreeMap<(usize, usize), u64> {
    let targets: Vec<crate::Target> = (0..graph.nodes.len())
        .map(|node| crate::Target { node, port: None })
        .collect();
    let resolved = planner.resolve(&targets);
    assert_eq!(resolved.errors, []);
    let mut symbols = BTreeMap::new();
    for node in &resolved.order {
        let ready = resolved.nodes[*node].as_ref().unwrap();
        let mut inputs: Vec<(u64, Convert)> = ready
            .inputs
            .iter()
            .map(|input| {
                let Some(input) = input else { return OPEN };
                let symbol = symbols[&(input.node, input.output)];
                match input.reads {
                    sabi_nodes::kind::Reads::Value => (symbol, input.convert),
                    sabi_nodes::kind::Reads::Field => (converted(symbol, input.convert), Convert::None),
                }
            })
            .collect();
        match ready.behavior {
            Behavior::Sink(_) => {}
            Behavior::Source(kind) => {
                for (output, port) in kind.outputs.iter().enumerate() {
                    symbols.insert((*node, output), source_symbol(&graph.nodes[*node].id, &port.name));
                }
            }
            Behavior::Shader(kind) => {
                for (output, function) in kind.outputs.iter().enumerate() {
                    let times = match &function.repeat {
                        Some(Formula::Param(param)) => match ready.values[*param] {
                            ParamValue::Unsigned(times) => times,
                            _ => 1,
                        },
                        _ => 1,
                    };
                    let mut symbol = 0;
                    for _ in 0..times {
                        symbol = call_symbol(&kind.id, &function.name, &ready.params, &inputs);
                        if times > 1 {
                            inputs[0] = (symbol, Convert::None);
                        }
                    }
                    symbols.insert((*node, output), symbol);
                }
            }
        }
    }
    symbols
}

type Slots = Vec<Option<(u64, Plane)>>;

/// Carries a plan out with symbols; answers what its results are.
fn from_plan(plan: &Plan) -> Vec<u64> {
    let mut slots: Slots = vec![None; plan.slots.len()];
    for step in &plan.steps {
        match step {
            Step::Source(source) => {
                for (output, planes) in &source.writes {
                    for (plane, slot) in planes {
                        slots[*slot] = Some((source_symbol(&source.id, output), *plane));
                    }
                }
            }
            Step::Survey(_) => panic!("no kind here asks a survey"),
            Step::Move(step) => slots[step.to] = slots[step.from],
            Step::Kernel(kernel) => run(kernel, &mut slots),
        }
    }
    let results = plan.results.iter().map(|result| {
        let planes = result.stored.planes();
        let held: Vec<(u64, Plane)> = result.slots.iter().map(|slot| slots[*slot].unwrap()).collect();
        assert!(held.iter().zip(&planes).all(|((_, held), plane)| held == plane));
        held[0].0
    });
    results.collect()
}

fn run(kernel: &KernelStep, slots: &mut Slots) {
    let times = kernel.feedback.as_ref().map_or(1, |feedback| feedback.times);
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
        let mut symbols: Vec<u64> = Vec::new();
        for call in &kernel.spec.calls {
            let inputs: Vec<(u64, Convert)> = (0..call.inputs.len())
                .map(|input| input_symbol(kernel, call, input, &symbols, &reads, slots))
                .collect();
            symbols.push(call_symbol(
                &call.kind,
                &call.function,
                &kernel.blocks[call.block].params,
                &inputs,
            ));
        }
        let mut at = 0;
        for store in &kernel.spec.stores {
            for plane in store.stored.planes() {
                if let Some(slot) = writes[at] {
                    assert!(!reads.contains(&Some(slot)), "a kernel reads what it writes");
                    slots[slot] = Some((stored_symbol(kernel, store.value, &symbols, &reads, slots), plane));
                }
                at += 1;
            }
        }
    }
}

/// What a store holds: a call's result, or a load that is converted.
fn stored_symbol(kernel: &KernelStep, value: Binding, symbols: &[u64], reads: &[Option<usize>], slots: &Slots) -> u64 {
    match value {
        Binding::Call(call, Convert::None) => symbols[call],
        Binding::Load(load, convert) => converted(held(kernel, load, reads, slots), convert),
        other => panic!("{other:?} is never stored"),
    }
}

fn converted(symbol: u64, convert: Convert) -> u64 {
    match convert {
        Convert::None => symbol,
        _ => hash(&[b"converted", &symbol.to_le_bytes(), &[convert as u8]]),
    }
}

/// What all planes of a load hold.
fn held(kernel: &KernelStep, load: usize, reads: &[Option<usize>], slots: &Slots) -> u64 {
    let first: usize = kernel.spec.loads[..load]
        .iter()
        .map(|stored| stored.planes().len())
        .sum();
    let planes = kernel.spec.loads[load].planes().len();
    let symbols = reads[first..first + planes]
        .iter()
        .flatten()
        .map(|slot| slots[*slot].unwrap().0);
    let symbols: Vec<u64> = symbols.collect();
    assert!(
        symbols.windows(2).all(|pair| pair[0] == pair[1]),
        "planes of different results"
    );
    symbols.first().copied().unwrap_or(0)
}

fn input_symbol(
    kernel: &KernelStep,
    call: &Call,
    input: usize,
    symbols: &[u64],
    reads: &[Option<usize>],
    slots: &Slots,
) -> (u64, Convert) {
    let held = |load| held(kernel, load, reads, slots);
    match call.inputs[input] {
        Binding::Default => OPEN,
        Binding::Call(from, convert) => (symbols[from], convert),
        Binding::Load(load, convert) => (held(load), convert),
        Binding::Field(load) => (held(load), Convert::None),
        Binding::Switch(load) => match (kernel.flags[0] >> (2 * input)) & 3 {
            0 => OPEN,
            2 => (held(load), Convert::Gray),
            3 => (held(load), Convert::Luminance),
            _ => {
                let shift = 5 * (input % INPUTS_A_WORD);
                let present = (kernel.flags[1 + input / INPUTS_A_WORD] >> shift) & 31;
                let is_material = kernel.spec.loads[load].planes().len() > 1;
                assert!(
                    !is_material || present & 3 == 3,
                    "a material has at least color and surface"
                );
                (held(load), Convert::None)
            }
        },
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_way_of_cutting_gives_what_the_graph_says(
        numbers in prop::collection::vec((0..1000_usize, prop::array::uniform4(0..1000_usize)), 1..24),
        narrow in any::<bool>(),
    ) {
        let graph = graph(&lines(&numbers));
        let mut bench = Bench::new();
        if narrow {
            bench.limits = Limits { sampled_textures: 10, storage_textures: 5, cost: 900 };
        }
        for mode in [FUSED, UNFUSED, Mode::Interactive] {
            let (plan, errors) = bench.plan(&graph, mode);
            prop_assert_eq!(errors, []);
            let expected = bench.with_planner(&graph, mode, |planner| from_graph(planner, &graph));
            let wanted: Vec<u64> = plan
                .results
                .iter()
                .map(|result| {
                    let from = &graph.nodes[result.target.node].inputs.values().next().unwrap();
                    let output = bench.output_index(&graph, from);
                    expected[&(from.node, output)]
                })
                .collect();
            prop_assert_eq!(from_plan(&plan), wanted, "{}", plan);
        }
    }
}
