//! Random graphs of all kinds: however a plan is divided, each result is computed from what the graph defines, on the
//! levels that each function requests.

use std::collections::BTreeMap;

use proptest::prelude::*;
use sabi_graph::{FlatGraph, PortType};
use sabi_nodes::Library;
use sabi_nodes::formula::{Formula, Variables};
use sabi_nodes::kind::{Argument, Cost, InputDefault, Kind, Memory, Output, ParamValue, Reads, Role, Shape};
use sabi_nodes::link::Convert;

use super::symbols::{CallArguments, OPEN, call_symbol, converted, from_plan, moved, source_symbol, surveyed};
use super::{FUSED, TestPlanner, UNFUSED, WIDTHS, graph};
use crate::resolved_graph::{Behavior, ResolvedNode};
use crate::{Level, Limits, Mode, Planner};

/// Lengths that are within, between and beyond the ranges of the levels.
const LENGTHS: [f64; 6] = [0.0005, 0.007, 0.016, 0.04, 0.13, 0.9];

/// Random numbers for a node of a graph: they select its kind, the results that its inputs read, and its lengths.
type Numbers = (usize, [usize; 4], usize);

/// Returns a line of a graph: a node of this kind that reads earlier results or nothing; `None` if a required input cannot be connected.
fn line(id: &str, kind: &Kind, (_, picks, length): Numbers, made: &[(String, PortType)]) -> Option<String> {
    let is_solid = |ty: PortType| ty == PortType::Material || ty == PortType::Vector;
    let fits = |from: PortType, to: PortType| from == to || !(is_solid(from) || is_solid(to));
    let mut line = format!("{id} {}", kind.id);
    for (at, input) in kind.inputs.iter().enumerate() {
        let pick = picks[at % picks.len()].wrapping_add(at / picks.len());
        let fitting: Vec<&str> = made
            .iter()
            .filter(|(_, ty)| fits(*ty, input.ty))
            .map(|(name, _)| name.as_str())
            .collect();
        let must = input.default == InputDefault::Required;
        if fitting.is_empty() && must {
            return None;
        }
        // An optional input is sometimes left unconnected.
        if !fitting.is_empty() && (must || !pick.is_multiple_of(5)) {
            line += &format!(" {}={}", input.name, fitting[pick % fitting.len()]);
        }
    }
    let lengths = kind
        .params
        .iter()
        .filter(|param| param.ty.role == Role::Length && param.ty.memory == Memory::F32);
    for (at, param) in lengths.enumerate() {
        let [low, high] = param.ty.range.unwrap_or([0.0, 1.0]);
        let value = LENGTHS[length / LENGTHS.len().pow(at as u32) % LENGTHS.len()] as f32;
        line += &format!(" {}={}", param.name, value.clamp(low as f32, high as f32));
    }
    Some(line)
}

/// Lines of a graph from random numbers, and the last results of it as outputs.
fn lines(library: &Library, numbers: &[Numbers]) -> String {
    let kinds: Vec<&Kind> = library.kinds().collect();
    // Half of the nodes are fields, rays or surveys, so that these get connected to each other.
    let others: Vec<&Kind> = kinds
        .iter()
        .copied()
        .filter(|kind| kind.shape != Shape::Point)
        .collect();
    let simplest = library.kind("noise/simplex").unwrap();
    let mut made: Vec<(String, PortType)> = Vec::new();
    let mut text = String::new();
    for (at, numbers) in numbers.iter().enumerate() {
        let id = format!("n{at}");
        let from = if numbers.0.is_multiple_of(2) { &kinds } else { &others };
        let kind = from[numbers.0 / 2 % from.len()];
        if numbers.0 % 11 == 0 {
            text += &format!("{id} source/model\n");
            made.push((format!("{id}.material"), PortType::Material));
            continue;
        }
        let (kind, line) = match line(&id, kind, *numbers, &made) {
            Some(line) => (kind, line),
            None => (simplest, format!("{id} noise/simplex")),
        };
        made.extend(
            kind.outputs
                .iter()
                .map(|output| (format!("{id}.{}", output.name), output.ty)),
        );
        text += &(line + "\n");
    }
    let results = made.iter().rev().filter(|(_, ty)| *ty != PortType::Vector);
    for (at, (name, ty)) in results.take(3).enumerate() {
        let (kind, port) = match ty {
            PortType::Material => ("output/material", "material"),
            _ => ("output/mask", "source"),
        };
        text += &format!("out{at} {kind} {port}={name}\n");
    }
    text
}

/// A node of the graph with what it reads, as symbols.
struct ReaderNode<'n> {
    kind: &'n Kind,
    ready: &'n ResolvedNode<'n>,
    /// The result to which each input is connected.
    inputs: Vec<(u64, Convert)>,
    /// For each pass, its result and its level.
    passes: Vec<(u64, Level)>,
}

impl ReaderNode<'_> {
    fn value(&self, formula: &Formula, texel: f64) -> f64 {
        let stored = |param: usize| match &self.ready.values[param] {
            ParamValue::Unsigned(value) => f64::from(*value),
            ParamValue::Signed(value) => f64::from(*value),
            ParamValue::Floats(values) => f64::from(values[0]),
            ParamValue::Text(_) => 0.0,
        };
        // Angles are in degrees in graphs, and in radians in formulas.
        let param = |param: usize| match &self.kind.params[param].ty.role {
            Role::Angle => stored(param).to_radians(),
            _ => stored(param),
        };
        formula.value(&Variables {
            param: &param,
            texel,
            finest: WIDTHS.finest,
        })
    }

    /// Returns the widest points that are not farther apart than a formula gives; if there are none, the coarsest level
    /// whose texels are not wider.
    fn level(&self, texel: Option<&Formula>, points: Option<&Formula>) -> Level {
        let fits = |formula: Option<&Formula>| {
            let widest = formula.map_or(0.0, |formula| self.value(formula, WIDTHS.finest));
            move |level: &Level| WIDTHS.of(*level) <= widest
        };
        let points = (0..WIDTHS.point_levels).map(Level::Points).filter(fits(points)).min();
        let texels = (0..=WIDTHS.coarsest).map(Level::Texels).filter(fits(texel)).max();
        points.or(texels).unwrap_or(Level::FINEST)
    }

    /// Returns the symbol and the level of the result of a function that reads textures.
    fn field(&self, function: &Output) -> (u64, Level) {
        let level = self.level(function.texel.as_ref(), function.points.as_ref());
        let repeat = function
            .repeat
            .as_ref()
            .map_or(1.0, |repeat| self.value(repeat, WIDTHS.of(level)));
        let times = repeat.ceil().clamp(1.0, 4096.0) as u32;
        let (mut given, first) = self.given(function, level);
        let mut symbol = 0;
        for _ in 0..times {
            symbol = call_symbol(&self.kind.id, &function.name, &self.ready.params, &given);
            // From the second run on, it reads its previous result as the first texture.
            match first {
                Some(Argument::Input(input)) => given.inputs[*input].0 = symbol,
                Some(Argument::Pass(pass)) => given.passes[*pass] = symbol,
                _ => {}
            }
        }
        (symbol, level)
    }

    /// Returns what a function reads on a level, and its first texture.
    fn given<'f>(&self, function: &'f Output, level: Level) -> (CallArguments, Option<&'f Argument>) {
        let mut given = CallArguments {
            inputs: vec![OPEN; self.inputs.len()],
            passes: vec![0; self.kind.passes.len()],
            survey: None,
        };
        let mut first = None;
        let is_left_out = |argument: &&Argument| match argument {
            Argument::Pass(pass) => self.kind.passes[*pass]
                .with
                .is_some_and(|input| self.inputs[input].0 == 0),
            _ => false,
        };
        for argument in function.arguments.iter().filter(|argument| !is_left_out(argument)) {
            match argument {
                Argument::Input(input) if self.kind.inputs[*input].reads == Reads::Field => {
                    let (symbol, convert) = self.inputs[*input];
                    given.inputs[*input].0 = if symbol == 0 {
                        0
                    } else {
                        moved(converted(symbol, convert), Level::FINEST, level)
                    };
                    first = first.or(Some(argument));
                }
                Argument::Input(input) => {
                    let (symbol, convert) = self.inputs[*input];
                    let symbol = if symbol == 0 {
                        0
                    } else {
                        moved(symbol, Level::FINEST, level)
                    };
                    given.inputs[*input] = (symbol, convert);
                }
                Argument::Pass(pass) => {
                    let (symbol, from) = self.passes[*pass];
                    given.passes[*pass] = moved(symbol, from, level);
                    first = first.or(Some(argument));
                }
                _ => {}
            }
        }
        // The first texture replaces passes for inputs to which nothing is connected.
        let stand_in = match first {
            Some(Argument::Input(input)) => given.inputs[*input].0,
            Some(Argument::Pass(pass)) => given.passes[*pass],
            _ => 0,
        };
        for argument in function.arguments.iter().filter(is_left_out) {
            if let Argument::Pass(pass) = argument {
                given.passes[*pass] = stand_in;
            }
        }
        (given, first)
    }

    /// Returns the symbol and the level of the result of a pass that runs once, on the table of a survey.
    fn found(&self, function: &Output) -> (u64, Level) {
        let (symbol, convert) = self.inputs[self.kind.surveyed.unwrap()];
        let given = CallArguments {
            inputs: vec![OPEN; self.inputs.len()],
            passes: Vec::new(),
            survey: Some(surveyed(converted(symbol, convert))),
        };
        (
            call_symbol(&self.kind.id, &function.name, &self.ready.params, &given),
            Level::FINEST,
        )
    }

    /// A mean over rays, on the level that they start from.
    fn mean(&self, function: &Output) -> (u64, Level) {
        let level = self.level(self.kind.rays.as_ref().and_then(|rays| rays.texel.as_ref()), None);
        let given = CallArguments {
            inputs: self.inputs_on(level),
            passes: Vec::new(),
            survey: None,
        };
        (
            call_symbol(&self.kind.id, &function.name, &self.ready.params, &given),
            level,
        )
    }

    fn inputs_on(&self, level: Level) -> Vec<(u64, Convert)> {
        let there = |(symbol, convert): &(u64, Convert)| match symbol {
            0 => OPEN,
            _ => (moved(*symbol, Level::FINEST, level), *convert),
        };
        self.inputs.iter().map(there).collect()
    }

    fn result(&self, output: &Output) -> u64 {
        if self.kind.shape == Shape::Field {
            let (symbol, level) = self.field(output);
            assert_eq!(level, Level::FINEST, "results are on the finest level");
            return symbol;
        }
        let level = self.level(self.kind.rays.as_ref().and_then(|rays| rays.texel.as_ref()), None);
        let takes = |pass: usize| output.arguments.contains(&Argument::Pass(pass));
        // Means are stored if one of them is denoised; otherwise they are computed in the kernel that uses them.
        let is_stored = |pass: &sabi_nodes::kind::Pass| self.kind.shape != Shape::Ray || pass.denoise.is_some();
        let reads_means = (0..self.passes.len()).any(|pass| takes(pass) && is_stored(&self.kind.passes[pass]));
        let reads = |pass: usize| reads_means && (takes(pass) || self.kind.shape == Shape::Ray);
        let passes = self.passes.iter().enumerate();
        let given = CallArguments {
            inputs: self.inputs_on(level),
            passes: passes
                .map(|(pass, (symbol, _))| if reads(pass) { *symbol } else { 0 })
                .collect(),
            survey: None,
        };
        let made = call_symbol(&self.kind.id, &output.name, &self.ready.params, &given);
        moved(made, level, Level::FINEST)
    }
}

/// Computes the symbol of each result from the graph alone.
fn from_graph(planner: &Planner<'_>, graph: &FlatGraph) -> BTreeMap<(usize, usize), u64> {
    let targets: Vec<crate::Target> = (0..graph.nodes.len())
        .map(|node| crate::Target { node, port: None })
        .collect();
    let resolved = planner.resolve(&targets);
    assert_eq!(resolved.errors, []);
    let mut symbols = BTreeMap::new();
    for node in &resolved.order {
        let ready = resolved.nodes[*node].as_ref().unwrap();
        let input = |input: &Option<crate::resolved_graph::ResolvedInput>| {
            input.map_or(OPEN, |input| (symbols[&(input.node, input.output)], input.convert))
        };
        match ready.behavior {
            Behavior::Sink(_) => {}
            Behavior::Source(kind) => {
                for (output, port) in kind.outputs.iter().enumerate() {
                    symbols.insert((*node, output), source_symbol(&graph.nodes[*node].id, &port.name));
                }
            }
            Behavior::Shader(kind) => {
                let mut reader = ReaderNode {
                    kind,
                    ready,
                    inputs: ready.inputs.iter().map(input).collect(),
                    passes: Vec::new(),
                };
                for pass in &kind.passes {
                    let made = match kind.shape {
                        Shape::Field => reader.field(&pass.function),
                        Shape::Survey => reader.found(&pass.function),
                        Shape::Ray => reader.mean(&pass.function),
                        Shape::Point => (0, Level::FINEST),
                    };
                    reader.passes.push(made);
                }
                for (output, function) in kind.outputs.iter().enumerate() {
                    symbols.insert((*node, output), reader.result(function));
                }
            }
        }
    }
    symbols
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_way_of_cutting_gives_what_the_graph_says(
        numbers in prop::collection::vec((0..10_000_usize, prop::array::uniform4(0..1000_usize), 0..1000_usize), 1..24),
        narrow in any::<bool>(),
    ) {
        let mut bench = TestPlanner::new();
        let graph = graph(&lines(bench.library, &numbers));
        if narrow {
            bench.limits = Limits { sampled_textures: 10, storage_textures: 5, cost: Cost { all: 1_400, straight: 400 }, work: 1 << 16, block_bytes: 1 << 11 };
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
