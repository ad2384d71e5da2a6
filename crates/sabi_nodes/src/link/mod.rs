//! Linking: several WGSL files become one module.
//!
//! Files say in their headers what they use (`uses.rs`); a [`LinkedModule`] maps its text to files and lines. Two kinds
//! of modules are linked: those of Sabi's own files, by a [`ModuleSpec`], and kernels of nodes, by a [`KernelSpec`] that
//! says what is called in which order and what is read from and written to storage. Names of different nodes are kept
//! apart by a prefix.

mod block;
mod error;
mod expressions;
mod files;
pub(crate) mod given;
mod kernel;
mod mirror;
mod module;
pub(crate) mod parse;
mod rays;
mod reflect;
mod rename;
mod sources;
pub(crate) mod uses;

use sabi_graph::PortType;

use crate::kind::{Channel, Denoise, INPUT_LIMIT, MATERIAL_INPUT_LIMIT};

pub use block::{BlockLayout, CallLayout};
pub use error::{LinkError, Missing};
pub use files::ModuleSpec;
pub use given::{Access, Given};
pub use kernel::{Kernel, link};
pub use mirror::{Mirror, MirrorMember, MirrorValue, MirrorsWgsl};
pub use module::LinkedModule;
pub use reflect::{MemberLayout, Reflection, StructLayout};

/// Names of the three flag words of a switched kernel that describe channels, in order.
const CHANNEL_WORDS: [&str; 3] = ["y", "z", "w"];
/// Material inputs whose channels one of these words describes.
const MATERIALS_A_WORD: usize = u32::BITS as usize / Channel::ALL.len();

// Every input has two bits in the first word, and a material input one for each channel in one of the others.
const _: () = assert!(INPUT_LIMIT <= 16 && MATERIAL_INPUT_LIMIT <= CHANNEL_WORDS.len() * MATERIALS_A_WORD);

/// Place of the channel bits of a material input in the flags of a switched kernel: the word, 1 to 3, and the shift. `before` is
/// the number of material inputs of the node before this one.
pub fn channel_bits(before: usize) -> (usize, usize) {
    (
        1 + before / MATERIALS_A_WORD,
        Channel::ALL.len() * (before % MATERIALS_A_WORD),
    )
}

/// Work of one kernel, as plain data. Two equal specs give the same text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelSpec {
    /// Calls in order; a call may read results of earlier ones.
    pub calls: Vec<Call>,
    /// Stored results that are read.
    pub loads: Vec<Stored>,
    /// Results that are stored, with their formats.
    pub stores: Vec<Store>,
    /// Texels that the calls are evaluated at.
    pub domain: Domain,
    /// True if these texels are points spread over the surface.
    pub on_points: bool,
}

/// Texels that a kernel is evaluated at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// All texels, ghosts included: point nodes.
    AllTexels,
    /// Owned texels; ghosts are filled from them afterwards: fields.
    OwnedTexels,
    /// Owned texels, where the calls are means over rays. All calls are of one node that shoots rays. The text then has
    /// two entry points, see [`Kernel::rays`].
    OwnedTexelsByRays,
    /// The texel at the origin, by one invocation: what holds for the whole surface.
    Once,
    /// A texel for each of [`SURVEY_GROUPS`]: what holds for a part, a piece or a chart.
    Groups,
}

/// Most groups of a survey. Where a model has more parts, pieces or charts, those whose numbers differ by a multiple of it
/// are measured together.
pub const SURVEY_GROUPS: u32 = 1024;

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
    /// Load that holds the table of a survey, where the function reads one.
    pub survey: Option<usize>,
    /// Load that holds the [`Operand::Normal`] of its kind, where the function reads means over rays that are denoised.
    pub normals: Option<usize>,
    /// Masks that multiply parameters at each place, by index in the parameters of the kind.
    pub param_masks: Vec<(usize, Operand)>,
    /// Parameter block of this call: calls of the same node share one.
    pub block: usize,
    /// True if lengths among its parameters are shares of the piece that a place belongs to.
    pub by_piece: bool,
}

/// Source of an input's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// Nothing is connected: the knob, the default expression or the plain material.
    Default,
    /// A value at this texel.
    Value(Operand),
    /// A stored result, passed on as a texture.
    Field(usize),
    /// Decided when the kernel runs, by the flags of the block: default, load, or load with conversion.
    Switch(usize),
}

/// A value at a texel, converted on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    /// Result of an earlier call.
    Call(usize, Convert),
    /// A stored result.
    Load(usize, Convert),
    /// Normal at the texel by which neighbors are told alike.
    Normal(Denoise),
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

/// Layout of a value in storage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stored {
    /// Type of the value.
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
    /// Result of a call, or a load that is converted.
    pub value: Operand,
    /// Layout of the value in storage.
    pub stored: Stored,
    /// Texture formats, one for each plane.
    pub formats: Vec<Format>,
}

/// Part of a value that one texture holds.
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
    /// Storage format. Masks take 32 bits: a threshold would show the steps of a half float, and fused and single passes
    /// would no longer agree.
    pub fn format(self) -> Format {
        match self {
            Plane::Mask | Plane::Material(Channel::Height) => Format::R32Float,
            Plane::Color
            | Plane::Material(
                Channel::Color
                | Channel::Surface
                | Channel::Emission
                | Channel::Coat
                | Channel::Anisotropy
                | Channel::Sheen
                | Channel::Subsurface,
            ) => Format::Rgba16Float,
            Plane::Vector | Plane::Material(Channel::Slope) => Format::Rgba32Float,
        }
    }
}

#[cfg(test)]
mod tests;
