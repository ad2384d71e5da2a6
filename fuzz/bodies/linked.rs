//! Any node that is accepted compiles in every kernel of a graph that has it, alone and with others.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sabi_graph::{Fit, FlatGraph, FlatNode, FlatRef, PortType};
use sabi_nodes::kind::{InputDefault, Kind, Shape};
use sabi_nodes::link::link;
use sabi_nodes::{Library, SourceFile};
use sabi_plan::{Mode, Step, Target};

use crate::planning::planned;

/// Id of the node.
const OWN: &str = "noise/own";

thread_local! {
    /// The kinds that come with the program, and the one of the input.
    static LIBRARY: RefCell<Library> = RefCell::new(Library::builtin());
}

pub fn survives(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let file = SourceFile {
        path: PathBuf::from("noise/own.wgsl"),
        id: OWN.to_owned(),
        text: text.to_owned(),
    };
    LIBRARY.with_borrow_mut(|library| match library.replace(file) {
        Ok(()) => {
            compiles_everywhere(library);
            library.remove_folder(Path::new("noise"));
        }
        Err(faults) => assert!(!faults.is_empty(), "a refusal has a reason"),
    });
}

fn compiles_everywhere(library: &Library) {
    let own = library.kind(OWN).expect("it was read");
    let mut known = BTreeSet::new();
    for connects_all in [false, true] {
        let graph = graph(library, own, connects_all);
        for mode in [Mode::Interactive, Mode::Bake { fuse: true }, Mode::Bake { fuse: false }] {
            for step in steps(library, &graph, mode) {
                let Step::Kernel(kernel) = step else { continue };
                let linked = link(&kernel.spec, |id| library.kind(id), library.libraries());
                let module = linked.expect("all kinds are known").module;
                if known.insert(module.wgsl().to_owned())
                    && let Err(fault) = module.check()
                {
                    panic!("a node that was accepted does not compile in a kernel: {fault}");
                }
            }
        }
    }
}

/// The node, with a node of the program before each input: before all, or before those that need one.
fn graph(library: &Library, own: &Kind, connects_all: bool) -> FlatGraph {
    let mut graph = FlatGraph::default();
    let mut inputs = BTreeMap::new();
    for input in &own.inputs {
        if !connects_all && !matches!(input.default, InputDefault::Required) {
            continue;
        }
        let Some(before) = maker_of(library, input.ty) else {
            continue;
        };
        let link = FlatRef {
            node: graph.nodes.len(),
            port: None,
        };
        graph
            .nodes
            .push(node(&format!("before_{}", input.name), before, BTreeMap::new()));
        inputs.insert(input.name.clone(), link);
    }
    graph.nodes.push(node("own", own, inputs));
    graph
}

/// A kind of the program whose first output has this type, and which needs no input.
fn maker_of(library: &Library, ty: PortType) -> Option<&Kind> {
    library.kinds().find(|kind| {
        kind.id != OWN
            && kind.shape == Shape::Point
            && kind.outputs.first().is_some_and(|output| output.ty == ty)
            && !kind
                .inputs
                .iter()
                .any(|input| matches!(input.default, InputDefault::Required))
    })
}

fn node(id: &str, kind: &Kind, inputs: BTreeMap<String, FlatRef>) -> FlatNode {
    FlatNode {
        id: id.to_owned(),
        kind: kind.id.clone(),
        version: kind.version,
        params: BTreeMap::new(),
        inputs,
        muted: false,
        seeds: vec![0],
        length_scale: 1.0,
        fit: Fit::default(),
        file: None,
    }
}

/// The steps for all results of the last node.
fn steps(library: &Library, graph: &FlatGraph, mode: Mode) -> Vec<Step> {
    let own = library.kind(OWN).expect("it was read");
    let targets: Vec<Target> = own
        .outputs
        .iter()
        .map(|output| Target {
            node: graph.nodes.len() - 1,
            port: Some(output.name.clone()),
        })
        .collect();
    planned(graph, library, &targets, mode).steps
}
