//! Linking: several WGSL files become one module.
//!
//! The header of a file names the files that it uses (`uses.rs`). A [`LinkedModule`] maps its text to files and lines. Two kinds of
//! modules are linked: modules of Sabi's own files, by a [`ModuleSpec`], and kernels of nodes, by a [`KernelSpec`], which lists the calls
//! in order and the storage that is read and written. A prefix keeps the names of different nodes apart.

mod block;
mod error;
mod expressions;
mod files;
pub(crate) mod given_declarations;
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
pub use error::{LinkError, MissingPart};
pub use files::ModuleSpec;
pub use given_declarations::{Access, Given};
pub use kernel::{Kernel, link};
pub use mirror::{Mirror, MirrorMember, MirrorValue, MirrorsWgsl};
pub use module::LinkedModule;
pub use reflect::{MemberLayout, Reflection, StructLayout};

/// Names of the three flag words of a switched kernel that describe material channels, in order.
const CHANNEL_WORDS: [&str; 3] = ["y", "z", "w"];
/// Number of material inputs whose channels fit into one of these words.
const MATERIALS_A_WORD: usize = u32::BITS as usize / Channel::ALL.len();

// Each input has two bits in the first word, and each material input has a bit for each channel in one of the other words.
const _: () = assert!(INPUT_LIMIT <= 16 && MATERIAL_INPUT_LIMIT <= CHANNEL_WORDS.len() * MATERIALS_A_WORD);

/// Returns where the flags of a switched kernel hold the channel bits of a material input: the word, 1 to 3, and the shift.
/// `before` is the number of material inputs of the node before this one.
pub fn channel_bits(before: usize) -> (usize, usize) {
    (
        1 + before / MATERIALS_A_WORD,
        Channel::ALL.len() * (before % MATERIALS_A_WORD),
    )
}

/// Work of one kernel, as plain data. Equal specs give equal texts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelSpec {
    /// Calls in order. A call may read results of earlier calls.
    pub calls: Vec<Call>,
    /// Stored results that are read.
    pub loads: Vec<StoredLayout>,
    /// Results that are stored, with their formats.
    pub stores: Vec<KernelStore>,
    /// Texels for which the calls are evaluated.
    pub domain: Domain,
    /// True if these texels are points spread over the surface.
    pub on_points: bool,
}

/// Texels for which a kernel is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// All texels including ghosts: for point nodes.
    AllTexels,
    /// Owned texels. Ghosts are filled from them afterwards: for fields.
    OwnedTexels,
    /// Owned texels; the calls are means over rays. All calls belong to one node that shoots rays. The text then has two
    /// entry points, see [`Kernel::rays`].
    OwnedTexelsByRays,
    /// The texel at the origin, by one invocation: for values of the whole surface.
    Once,
    /// A texel for each of [`SURVEY_GROUPS`]: for values of a part, a piece or a chart.
    Groups,
}

/// Maximum number of groups of a survey. If a model has more parts, pieces or charts, those whose numbers differ by a
/// multiple of this are measured together.
pub const SURVEY_GROUPS: u32 = 1024;

/// Evaluation of one function of a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Call {
    /// Id of the kind.
    pub kind: String,
    /// Name of the function: an output or a pass.
    pub function: String,
    /// Source of each input of the kind, in the order of its inputs.
    pub inputs: Vec<Binding>,
    /// For each pass of the kind, the load that holds its result, if the function reads it.
    pub passes: Vec<Option<usize>>,
    /// Load that holds the table of a survey, if the function reads one.
    pub survey: Option<usize>,
    /// Load that holds the [`Operand::Normal`] of the kind, if the function reads denoised means over rays.
    pub normals: Option<usize>,
    /// Masks that multiply parameters at each place, by index of the parameter.
    pub param_masks: Vec<(usize, Operand)>,
    /// Number of the parameter block. Calls of the same node share a block.
    pub block: usize,
    /// True if lengths among the parameters are shares of the piece that contains the place.
    pub by_piece: bool,
}

/// Source of an input's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// Nothing is connected: the knob, the default expression or the plain material is used.
    Default,
    /// A value at this texel.
    Value(Operand),
    /// A stored result, passed on as a texture.
    Field(usize),
    /// Decided by the flags of the block when the kernel runs: default, load, or converted load.
    Switch(usize),
}

/// A value at a texel, with a conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    /// Result of an earlier call.
    Call(usize, Convert),
    /// A stored result.
    Load(usize, Convert),
    /// Normal at the texel, with which similar neighbors are found.
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
pub struct StoredLayout {
    /// Type of the value.
    pub ty: PortType,
    /// Channels of a material that are stored, in storage order; empty for other types.
    pub channels: Vec<Channel>,
}

impl StoredLayout {
    /// Returns the textures that hold the value, in binding order.
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
pub struct KernelStore {
    /// Result of a call, or a converted load.
    pub value: Operand,
    /// Layout of the value in storage.
    pub stored: StoredLayout,
    /// Texture formats, one for each plane.
    pub formats: Vec<Format>,
}

/// Part of a value that is stored in one texture.
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
    /// Returns the storage format. Masks take 32 bits: with half floats, thresholds would show steps, and fused and
    /// separate passes would give different results.
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
