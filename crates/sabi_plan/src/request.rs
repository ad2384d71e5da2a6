//! Input of the planner.

use std::collections::BTreeMap;
use std::fmt;

use sabi_graph::{Fit, FlatGraph, PortType};
use sabi_nodes::Library;
use sabi_nodes::kind::{Channel, Cost, Param};

use crate::level::LevelWidths;

/// A kind whose results are made by the engine instead of a kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceKind {
    /// Identifier as in graph files.
    pub id: String,
    /// Name shown to artists.
    pub label: String,
    /// One sentence.
    pub summary: String,
    /// Other words an artist may search for.
    pub aliases: Vec<String>,
    /// Parameters, which the engine receives as [`crate::SourceValues`].
    pub params: Vec<Param>,
    /// Inputs.
    pub inputs: Vec<SourcePort>,
    /// Outputs.
    pub outputs: Vec<SourcePort>,
    /// Hash of the content behind all nodes of the kind (the model's textures), which every key below them contains.
    pub content: [u8; 32],
}

/// A port of a source kind.
#[derive(Clone, Debug, PartialEq)]
pub struct SourcePort {
    /// Name of the port.
    pub name: String,
    /// Its port type.
    pub ty: PortType,
    /// Description for artists.
    pub doc: String,
    /// For an input that need not be connected: what holds then, in words.
    pub unconnected: Option<String>,
    /// For a material result: the channels that it sets.
    pub channels: Vec<Channel>,
}

impl SourcePort {
    /// A port of any type but material.
    pub fn new(name: &str, ty: PortType, doc: &str) -> SourcePort {
        SourcePort::material(name, ty, doc, &[])
    }

    /// A port of a material result that sets these channels.
    pub fn material(name: &str, ty: PortType, doc: &str, channels: &[Channel]) -> SourcePort {
        SourcePort {
            name: name.to_owned(),
            ty,
            doc: doc.to_owned(),
            unconnected: None,
            channels: channels.to_vec(),
        }
    }

    /// Makes an input one that need not be connected; `unconnected` says in words what holds then.
    pub fn optional(mut self, unconnected: &str) -> SourcePort {
        self.unconnected = Some(unconnected.to_owned());
        self
    }
}

/// A wanted result.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Target {
    /// Index into [`FlatGraph::nodes`].
    pub node: usize,
    /// Name of the result; `None` for the first one. For a sink, the name of the input whose value is wanted.
    pub port: Option<String>,
}

/// Way to cut a graph into passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// One pass for each node, with pipelines that survive rewiring; every result has its own slot.
    Interactive,
    /// Results live until their last reader has run; with `fuse`, regions of point nodes share a pass.
    Bake {
        /// True if regions of point nodes are fused.
        fuse: bool,
    },
}

/// Limits of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Textures that a pass may read, without those of the surface.
    pub sampled_textures: usize,
    /// Textures that a pass may write.
    pub storage_textures: usize,
    /// Cost of a fused kernel. In all, that of about sixteen noises of eight octaves. Outside of loops, that of 125 *Levels*, since
    /// llvmpipe compiles 400 of them in 2.9 s in kernels of this cost, and in 5 s in kernels of a fifth more, while the graphs of
    /// the examples compile and run as fast in either.
    pub cost: Cost,
    /// Operations of a fused kernel for a texel at most, loops counted by their rounds: half of what one node may take, since a
    /// tile is done as a whole.
    pub work: u64,
    /// Bytes of the parameter block of a fused kernel.
    pub block_bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            sampled_textures: 11,
            storage_textures: 4,
            cost: Cost {
                all: 20_000,
                straight: 5_000,
            },
            work: 1 << 23,
            block_bytes: 16 << 10,
        }
    }
}

/// Lengths of the model as functions, so that the planner needs no model.
#[derive(Clone, Copy)]
pub struct Lengths<'a> {
    /// Factor from lengths written under a fit to working units, in which the fitted model lives.
    pub working_from: &'a dyn Fn(&Fit) -> f64,
    /// Size of the largest piece, working units.
    pub largest_piece: f64,
    /// Lowest and highest `dot(vertex, direction)` over the fitted model's vertices, for a unit direction.
    pub extent: &'a dyn Fn([f32; 3]) -> [f32; 2],
}

/// Kinds without outputs: `output/material` and `output/mask`.
pub type Sinks = BTreeMap<String, SourceKind>;

/// Hashes of the files that nodes name, or their faults, by node. Other nodes name no file.
pub type FileContents = BTreeMap<usize, Result<[u8; 32], FileFault>>;

/// Fault of a file that a node names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileFault {
    /// The parameter that names the file.
    pub param: String,
    /// The file, its fault and advice, as a sentence without a full stop.
    pub why: String,
    /// Kind of the fault.
    pub kind: FileFaultKind,
}

/// Kind of a fault of a file that a node names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFaultKind {
    /// It does not exist, or cannot be read.
    Missing,
    /// The graph may not open it, unless the user trusts it.
    Refused,
    /// No graph opens it, whatever is trusted: it is on another computer, an address or a device.
    NeverOpened,
    /// Its content cannot be used.
    Unusable,
    /// It takes more memory than there is for it.
    TooLarge,
}

impl fmt::Display for FileFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.why)
    }
}

/// Everything that a plan depends on besides the targets.
pub struct Planner<'a> {
    /// The flat graph.
    pub graph: &'a FlatGraph,
    /// Kinds from WGSL files.
    pub library: &'a Library,
    /// Kinds made by the engine, by id.
    pub sources: &'a BTreeMap<String, SourceKind>,
    /// Kinds without outputs, by id.
    pub sinks: &'a Sinks,
    /// Hashes of the files that nodes name.
    pub files: &'a FileContents,
    /// Lengths of the model.
    pub lengths: Lengths<'a>,
    /// Widths of the levels of the surface that may be used.
    pub level_widths: LevelWidths,
    /// Key of the surface (model, size, fit), which is part of every key.
    pub surface_key: [u8; 32],
    /// Way to cut the graph into passes.
    pub mode: Mode,
    /// Most rays of a texel, for a quick and noisy first picture; `None` for no limit.
    pub most_rays: Option<u32>,
    /// Limits of the adapter.
    pub limits: Limits,
}
