//! Linking: several node files become one compute kernel.
//!
//! A [`KernelSpec`] says what is called in which order and what is read from and written to storage; [`link`] turns
//! it into WGSL. Names of different files are kept apart by a prefix, libraries are appended after the nodes.

mod block;
mod kernel;
mod rays;
mod rename;
mod sources;

use sabi_graph::PortType;

use crate::kind::Channel;

pub use block::{BlockLayout, CallLayout};
pub use kernel::{Kernel, LinkError, link};

/// Inputs whose material channels one flag word of a switched kernel describes.
pub const INPUTS_A_WORD: usize = 6;

/// What a kernel does, as plain data. Two equal specs give the same text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelSpec {
    /// Calls in order; a call may read results of earlier ones.
    pub calls: Vec<Call>,
    /// Stored results that are read.
    pub loads: Vec<Stored>,
    /// Results that are stored: which, and how.
    pub stores: Vec<Store>,
    /// Whether ghost texels are evaluated too: true for point nodes, false for fields.
    pub on_ghosts: bool,
    /// Whether the calls are means over rays: all of them of one node that shoots some. The text then has two entry points,
    /// see [`Kernel::rays`].
    pub rays: bool,
    /// Whether it runs once for the whole surface: one invocation, which writes the texel at the origin.
    pub once: bool,
}

/// Evaluation of one function of a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Call {
    /// Id of the kind.
    pub kind: String,
    /// Name of the function: an output or a pass.
    pub function: String,
    /// One for each input of the kind, in its order.
    pub inputs: Vec<Binding>,
    /// One for each pass of the kind: the load that holds its result, where the function reads it.
    pub passes: Vec<Option<usize>>,
    /// The load that holds the table of a survey, where the function asks one.
    pub survey: Option<usize>,
    /// The parameter block of this call: calls of the same node share one.
    pub block: usize,
}

/// Where an input comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// Nothing is connected: the knob, the default expression or the plain material.
    Default,
    /// The result of an earlier call.
    Call(usize, Convert),
    /// A stored result, read at this place.
    Load(usize, Convert),
    /// A stored result, handed over as a texture.
    Field(usize),
    /// Decided when the kernel runs, by the flags of the block: default, load, or load with conversion.
    Switch(usize),
}

/// Conversion on a wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convert {
    /// The types agree.
    None,
    /// Mask to color.
    Gray,
    /// Color to mask.
    Luminance,
}

impl Convert {
    /// The conversion from one port type to another that it accepts.
    pub fn between(from: PortType, to: PortType) -> Convert {
        match (from, to) {
            (PortType::Mask, PortType::Color) => Convert::Gray,
            (PortType::Color, PortType::Mask) => Convert::Luminance,
            _ => Convert::None,
        }
    }
}

/// How a value lies in storage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stored {
    /// What it is.
    pub ty: PortType,
    /// Channels of a material that take storage, in storage order; empty for other types.
    pub channels: Vec<Channel>,
}

impl Stored {
    /// Textures that hold it, in binding order.
    pub fn planes(&self) -> Vec<Plane> {
        match self.ty {
            PortType::Mask => vec![Plane::Mask],
            PortType::Color => vec![Plane::Color],
            PortType::Vector => vec![Plane::Vector],
            PortType::Material => self.channels.iter().map(|channel| Plane::Material(*channel)).collect(),
        }
    }
}

/// One stored result of a kernel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Store {
    /// What is stored: the result of a call, or a load on its way to another type.
    pub value: Binding,
    /// How it is stored.
    pub stored: Stored,
    /// Texture formats, one for each plane.
    pub formats: Vec<Format>,
}

/// One texture's worth of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Plane {
    /// One number.
    Mask,
    /// Linear RGB.
    Color,
    /// Three numbers.
    Vector,
    /// A channel of a material.
    Material(Channel),
}

/// Storage format of a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Format {
    /// One float.
    R32Float,
    /// Four half floats.
    Rgba16Float,
    /// Four floats.
    Rgba32Float,
}

impl Format {
    /// Bytes of one texel.
    pub fn texel_bytes(self) -> u64 {
        match self {
            Format::R32Float => 4,
            Format::Rgba16Float => 8,
            Format::Rgba32Float => 16,
        }
    }

    /// Name in WGSL.
    pub fn wgsl(self) -> &'static str {
        match self {
            Format::R32Float => "r32float",
            Format::Rgba16Float => "rgba16float",
            Format::Rgba32Float => "rgba32float",
        }
    }
}

impl Plane {
    /// The format it is stored in. Masks are whole floats: a threshold above a half float would show its steps, and
    /// fused and single passes would no longer agree.
    pub fn format(self) -> Format {
        match self {
            Plane::Mask | Plane::Material(Channel::Height) => Format::R32Float,
            Plane::Color | Plane::Material(Channel::Color | Channel::Surface | Channel::Emission) => {
                Format::Rgba16Float
            }
            Plane::Vector | Plane::Material(Channel::Slope) => Format::Rgba32Float,
        }
    }
}

#[cfg(test)]
mod tests;
