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
    /// Hash of the content that all nodes of the kind read (such as the model's textures). It is part of every key that
    /// depends on such a node.
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
    /// For an input that need not be connected, a description of what happens if it is not.
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

    /// Makes an input optional. `unconnected` describes what happens if it is not connected.
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

/// How a graph is divided into passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// One pass for each node. Pipelines stay valid when links change, and every result has its own slot.
    Interactive,
    /// Slots of results are reused after their last reader has run. With `fuse`, regions of point nodes share a pass.
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
    /// Maximum cost of a fused kernel. The total is that of about sixteen noises with eight octaves. The cost outside of
    /// loops is that of 125 *Levels* nodes, since llvmpipe compiles 400 of these in 2.9 s in kernels of this cost, and in 5
    /// s in kernels that are a fifth larger, while the example graphs compile and run equally fast in both cases.
    pub cost: Cost,
    /// Maximum number of operations of a fused kernel for a texel, counting the rounds of loops: half of the maximum of a
    /// single node, since the work for a tile cannot be interrupted.
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

/// For each node that refers to a file, the hash of the file or its fault. Other nodes refer to no file.
pub type FileContents = BTreeMap<usize, Result<[u8; 32], FileFault>>;

/// Fault of a file to which a node refers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileFault {
    /// The parameter with the path of the file.
    pub param: String,
    /// The file, its fault and advice, as a sentence without a full stop.
    pub why: String,
    /// Kind of the fault.
    pub kind: FileFaultKind,
}

/// Kind of a fault of a file that a node names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFaultKind {
    /// The file does not exist, or cannot be read.
    Missing,
    /// The graph may not open the file unless the user trusts it.
    Refused,
    /// No graph may open the file, whatever is trusted: it is on another computer, a URL or a device.
    NeverOpened,
    /// The content of the file cannot be used.
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
