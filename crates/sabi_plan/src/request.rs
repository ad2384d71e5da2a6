//! What the planner is told.

use std::collections::BTreeMap;
use std::fmt;

use sabi_graph::{Fit, FlatGraph, PortType};
use sabi_nodes::Library;
use sabi_nodes::kind::{Channel, Param};

/// A node kind whose results the engine makes without a kernel, given to the planner as data.
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
    /// Parameters; what fills the source receives them as [`crate::SourceValues`].
    pub params: Vec<Param>,
    /// What may be connected; only sinks have inputs.
    pub inputs: Vec<SourcePort>,
    /// What it gives.
    pub outputs: Vec<SourcePort>,
    /// Hash of the content behind all nodes of the kind (the model's textures), which every key below them contains.
    pub content: [u8; 32],
}

/// A port of a source kind.
#[derive(Clone, Debug, PartialEq)]
pub struct SourcePort {
    /// Name of the port.
    pub name: String,
    /// What it carries.
    pub ty: PortType,
    /// What it is for.
    pub doc: String,
    /// For a material result: the channels that it sets.
    pub channels: Vec<Channel>,
}

impl SourcePort {
    /// A port that carries no material.
    pub fn new(name: &str, ty: PortType, doc: &str) -> SourcePort {
        SourcePort::material(name, ty, doc, &[])
    }

    /// A port of a material result that sets these channels.
    pub fn material(name: &str, ty: PortType, doc: &str, channels: &[Channel]) -> SourcePort {
        SourcePort {
            name: name.to_owned(),
            ty,
            doc: doc.to_owned(),
            channels: channels.to_vec(),
        }
    }
}

/// A result that is wanted.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Target {
    /// Index into [`FlatGraph::nodes`].
    pub node: usize,
    /// Name of the result; the first one if none. For a sink it names the input whose value is wanted.
    pub port: Option<String>,
}

/// How passes are cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// One pass a node and pipelines that survive rewiring; every result keeps a slot of its own.
    Interactive,
    /// Results live only until their last reader has run; with `fuse`, regions of point nodes are one pass.
    Bake {
        /// Whether to fuse.
        fuse: bool,
    },
}

/// What the adapter can bind, and how much goes into one kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Textures a pass may read, those of the surface not counted.
    pub sampled_textures: usize,
    /// Textures a pass may write.
    pub storage_textures: usize,
    /// naga expressions a fused kernel may hold: about sixteen noises of eight octaves, since compile time grows
    /// faster than the kernel.
    pub cost: u32,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            sampled_textures: 11,
            storage_textures: 4,
            cost: 16 * 700,
        }
    }
}

/// What the model decides about lengths: plain functions, so that the planner needs no model.
#[derive(Clone, Copy)]
pub struct Lengths<'a> {
    /// Factor from lengths written under a fit to working units, in which the fitted model lives.
    pub working_from: &'a dyn Fn(&Fit) -> f64,
    /// Lowest and highest `dot(vertex, direction)` over the fitted model's vertices, for a unit direction.
    pub extent: &'a dyn Fn([f32; 3]) -> [f32; 2],
}

/// Kinds that only take: `output/material` and `output/mask`.
pub type Sinks = BTreeMap<String, SourceKind>;

/// What is in the files that nodes name, by node: a hash of it, or why it cannot be had. A node that is not here has no
/// file that matters.
pub type FileContents = BTreeMap<usize, Result<[u8; 32], FileFault>>;

/// Why what a node's file holds cannot be had.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileFault {
    /// The parameter that names the file.
    pub param: String,
    /// The file, what is wrong with it and what to do, as a sentence without its point.
    pub why: String,
    /// Whether it is not there at all.
    pub is_missing: bool,
}

impl fmt::Display for FileFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.why)
    }
}

/// Everything a plan depends on besides the targets.
pub struct Planner<'a> {
    /// The flat graph.
    pub graph: &'a FlatGraph,
    /// Kinds from WGSL files.
    pub library: &'a Library,
    /// Kinds made by the engine, by id.
    pub sources: &'a BTreeMap<String, SourceKind>,
    /// Kinds that only take, by id.
    pub sinks: &'a Sinks,
    /// What is in the files that nodes name.
    pub files: &'a FileContents,
    /// Lengths of the model.
    pub lengths: Lengths<'a>,
    /// Texel width of each level of the atlas that may be used, working units, finest first; at least one.
    pub levels: &'a [f64],
    /// Names the surface (model, size, fit): part of every key.
    pub surface_key: [u8; 32],
    /// How to cut.
    pub mode: Mode,
    /// For a first picture, which is grainy and quick: no place shoots more rays than this. None for all of them.
    pub most_rays: Option<u32>,
    /// What the adapter allows.
    pub limits: Limits,
}
