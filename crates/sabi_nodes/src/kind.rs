//! Kinds of nodes as read from their WGSL files: plain data for the planner, the catalog and the reference.

mod cost;
mod denoise;
mod memory;
mod param;
mod param_type;
mod role;
mod source_param;
mod written_value;

use std::path::PathBuf;
use std::sync::Arc;

use sabi_graph::{PortType, Value};

use crate::formula::Formula;

pub use cost::Cost;
pub use denoise::Denoise;
pub use memory::{Memory, ParamValue};
pub use param::Param;
pub use param_type::ParamType;
pub(crate) use param_type::shortest_decimal;
pub use role::Role;
pub(crate) use written_value::UNUSED_STOP;
pub use written_value::{WrittenStop, WrittenValue};

/// A kind of node, read from its file and checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    /// Identifier as written in graph files, `category/name`.
    pub id: String,
    /// Version of the algorithm, 1 unless the header says `@version N`.
    pub version: u32,
    /// Name shown to artists: the first header line.
    pub label: String,
    /// One sentence: the second header line.
    pub summary: String,
    /// The remaining header text, Markdown; may be empty.
    pub description: String,
    /// Additional words that an artist may search for (`@alias clouds perlin`).
    pub aliases: Vec<String>,
    /// Earlier ids of this kind (`@was`), under which old files refer to it.
    pub formerly: Vec<String>,
    /// Path of the file, for messages only.
    pub path: PathBuf,
    /// Text of the file.
    pub source: Arc<str>,
    /// Libraries that the node uses directly or indirectly, in the order of first use.
    pub libraries: Vec<String>,
    /// Way in which the node reads its inputs.
    pub shape: Shape,
    /// Members of `struct Params` in order; empty when there is none.
    pub params: Vec<Param>,
    /// Size of `struct Params` in bytes, 0 when there is none.
    pub params_size: u32,
    /// Inputs of all functions, in order of first appearance. Each name occurs once.
    pub inputs: Vec<Input>,
    /// Documented functions whose results are output ports.
    pub outputs: Vec<Output>,
    /// Functions marked `@shared`. Outputs that have an argument with the name of such a function receive its result.
    pub shared: Vec<SharedFunction>,
    /// Functions marked `@pass`, in order of the pass number. Later functions read the stored result through an argument
    /// with the name of the pass.
    pub passes: Vec<Pass>,
    /// The rays over which the outputs are averaged, if the node shoots rays.
    pub rays: Option<Rays>,
    /// Index in [`Kind::inputs`] of the surveyed input. If there is one, the passes run once for the whole surface instead
    /// of for each texel, and outputs receive their values.
    pub surveyed: Option<usize>,
    /// Index in [`Kind::params`] of the choice that decides which groups are surveyed separately: [`SURVEY_GROUPINGS`].
    pub survey_groups: Option<usize>,
    /// Cost of compiling one evaluation of all outputs.
    pub cost: Cost,
    /// Maximum number of operations of all functions for a texel, with as many rounds of loops and rays as the ranges of
    /// the parameters allow.
    pub work: u64,
}

/// Words of the choice of groups that a survey measures separately. A word's index is its number in shaders.
pub const SURVEY_GROUPINGS: [&str; 4] = ["whole", "part", "piece", "chart"];

/// Maximum number of inputs of a node, which the bits of the flags of a switched kernel limit.
pub(crate) const INPUT_LIMIT: usize = 16;
/// Maximum number of material inputs of a node, limited for the same reason.
pub(crate) const MATERIAL_INPUT_LIMIT: usize = 9;

/// Way in which a node reads its inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Inputs are values at the same place. Such a node is fused with its neighbors.
    Point,
    /// At least one input is a stored texture.
    Field,
    /// Results are averages over rays that are shot from each place.
    Ray,
    /// Inputs are values at the same place, and one of them is also surveyed over the whole surface.
    Survey,
}

impl Shape {
    /// Returns the name of the shape, as shown by `sabi nodes`.
    pub fn name(self) -> &'static str {
        match self {
            Shape::Point => "point",
            Shape::Field => "field",
            Shape::Ray => "ray",
            Shape::Survey => "survey",
        }
    }
}

/// One input port.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Name of the argument in WGSL, and of the port.
    pub name: String,
    /// Name shown to artists.
    pub label: String,
    /// Description: the text after `@input NAME`.
    pub doc: String,
    /// Port type.
    pub ty: PortType,
    /// Form in which the function receives the input: the value at this place or the stored texture.
    pub reads: Reads,
    /// Value of the input while nothing is connected.
    pub default: InputDefault,
    /// Parameter that multiplies the input, with the value that it is set to when a user connects a wire, so that the
    /// connected values are used unchanged.
    pub starts: Option<(String, Value)>,
}

impl Input {
    /// Returns the type of the knob that is used while nothing is connected; `None` for an input without a knob.
    pub fn knob(&self) -> Option<ParamType> {
        let InputDefault::Knob(numbers) = &self.default else {
            return None;
        };
        let (memory, role, soft) = match self.ty {
            // A mask may have any value, but usually lies between 0 and 1.
            PortType::Mask => (Memory::F32, Role::Plain, Some([0.0, 1.0])),
            PortType::Color => (Memory::Vec3, Role::Color, None),
            PortType::Vector | PortType::Material => (Memory::Vec3, Role::Plain, None),
        };
        Some(ParamType {
            soft,
            ..ParamType::new(role, memory, &ParamValue::Floats(numbers.clone()))
        })
    }
}

/// Form in which a function receives an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reads {
    /// The value at this place.
    Value,
    /// The whole stored result, as `texture_2d_array<f32>`.
    Field,
}

/// Value of an unconnected input.
#[derive(Clone, Debug, PartialEq)]
pub enum InputDefault {
    /// The input has no default and must be connected, such as the source of a field.
    Required,
    /// A knob on the node with this initial value: 1 component for a mask, 3 for a color (linear) or vector.
    Knob(Vec<f32>),
    /// A WGSL expression over `at`, such as `at.position`.
    Expression(String),
    /// The plain gray material, for a material input.
    PlainMaterial,
}

/// A result of a node.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Name of the function and of the port.
    pub name: String,
    /// Port type.
    pub ty: PortType,
    /// The doc comment without its annotations.
    pub doc: String,
    /// Arguments of the function in order.
    pub arguments: Vec<Argument>,
    /// Number of runs (`@repeat`), rounded up to a whole number from 1 to 4096; `None` for a single run. The function's
    /// first field argument is the result of the previous run.
    pub repeat: Option<Formula>,
    /// Maximum width of the texels of a pass (`@texel`), in working units. The pass runs on the coarsest level whose texels
    /// are not wider; `None` means the finest level.
    pub texel: Option<Formula>,
    /// Maximum spacing of points spread over the surface (`@points`), in working units. The pass runs on the widest points
    /// that are not farther apart; if there are none, on the level given by `texel`. `None` means texels only.
    pub points: Option<Formula>,
    /// Channels that a material result can set.
    pub channels: Vec<ChannelWrite>,
}

impl Output {
    /// Returns the formulas in the annotations of the function, which the planner evaluates.
    pub fn formulas(&self) -> impl Iterator<Item = &Formula> {
        self.repeat.iter().chain(&self.texel).chain(&self.points)
    }
}

/// A function marked `@pass N`. Its result is stored, and later functions read it under the function's name.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// The number after `@pass`; passes run in ascending order.
    pub number: u32,
    /// The function: its arguments and the type that it stores.
    pub function: Output,
    /// Index in [`Kind::inputs`] of the input that the pass exists for (`@with`). While nothing is connected there and the
    /// parameter of the input has its default, the pass does not run; its readers then read another texture in its place,
    /// or 0 if they read no other texture.
    pub with: Option<usize>,
    /// Method that removes noise from a mean over rays before results read it (`@denoise`).
    pub denoise: Option<Denoise>,
}

/// A function marked `@shared`: evaluated once for each place, for all outputs that receive its result.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedFunction {
    /// Name of the function.
    pub name: String,
    /// Arguments of the function in order.
    pub arguments: Vec<Argument>,
}

/// The function `ray` of a node that shoots rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Rays {
    /// Arguments of the function in order.
    pub arguments: Vec<Argument>,
    /// Index in [`Kind::params`] of the `u32` parameter with the number of rays that are shot from each place.
    pub count: usize,
    /// Which hit is searched for along each ray.
    pub finds: Finds,
    /// Index in [`Kind::params`] of the length that limits the rays. No other property of the rays depends on it, so the
    /// hits of shorter rays follow from the hits of longer ones.
    pub reach: Option<usize>,
    /// Index in [`Kind::params`] of an angle. A hit is ignored if its triangle is turned by less than half of this angle
    /// against the triangle on which the ray starts.
    pub turn: Option<usize>,
    /// Maximum width of the texels from which rays are cast (`@texel`), in working units. Rays are cast on the coarsest
    /// level whose texels are not wider, and results are interpolated; `None` means the finest level.
    pub texel: Option<Formula>,
    /// Indices in [`Kind::params`] of the parameters that rays depend on.
    pub reads: Vec<usize>,
}

/// Which hit is searched for along a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Finds {
    /// Any hit, which is found faster. The distance is that of the hit that was found.
    Any,
    /// The first hit.
    #[default]
    Nearest,
}

/// Binding of a function's argument.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Argument {
    /// `at: Surface`
    At,
    /// `params: Params`
    Params,
    /// An input port, by index in [`Kind::inputs`].
    Input(usize),
    /// The result of a shared function at this place, by index in [`Kind::shared`].
    Shared(usize),
    /// The stored result of a pass, by index in [`Kind::passes`].
    Pass(usize),
    /// `index: u32` of the function `ray`: the number of the ray, from 0.
    Index,
    /// `ray: Ray`
    Ray,
    /// `hit: Hit`
    Hit,
    /// `round: Round`: number of the repetition, and texel width.
    Round,
    /// `survey: texture_2d_array<f32>`: the table of the surveyed input.
    Survey,
    /// `group: u32` of a pass that reads a survey: the number of the group; 0 if the whole surface is one group.
    Group,
}

impl Argument {
    /// Returns true if the argument has another value for each ray.
    pub(crate) fn is_of_ray(&self) -> bool {
        matches!(self, Argument::Ray | Argument::Hit)
    }
}

/// Channels of a material, each of which is stored in a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Channel {
    /// Base color and alpha.
    Color,
    /// Roughness, metallic and occlusion.
    Surface,
    /// Height.
    Height,
    /// Slope.
    Slope,
    /// Emission.
    Emission,
    /// Share and roughness of a clear coat.
    Coat,
    /// Direction and strength of fine scratches or fibers.
    Anisotropy,
    /// Color and roughness of a sheen.
    Sheen,
    /// Color of the light that spreads below the surface, and transmission.
    Subsurface,
}

impl Channel {
    /// All channels, in storage order.
    pub const ALL: [Channel; 9] = [
        Channel::Color,
        Channel::Surface,
        Channel::Height,
        Channel::Slope,
        Channel::Emission,
        Channel::Coat,
        Channel::Anisotropy,
        Channel::Sheen,
        Channel::Subsurface,
    ];

    /// Channels that most materials have.
    pub const COMMON: [Channel; 5] = [
        Channel::Color,
        Channel::Surface,
        Channel::Height,
        Channel::Slope,
        Channel::Emission,
    ];

    /// Returns the channels that a kernel that can be reused for different links reads and writes: the common ones, or all
    /// of them if a result sets a rare channel. So a node has at most two such kernels.
    pub fn switched(set: impl IntoIterator<Item = Channel>) -> &'static [Channel] {
        if set.into_iter().all(|channel| Channel::COMMON.contains(&channel)) {
            &Channel::COMMON
        } else {
            &Channel::ALL
        }
    }
}

/// A channel that a material function can set, with the conditions under which it does.
///
/// The conditions are read from the code: a store to a member of the returned material inside `if params.x != 0u`, or
/// multiplied by `params.y`. Material inputs that a result copies pass their channels on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelWrite {
    /// The channel that may be set.
    pub channel: Channel,
    /// Parameters (indices in [`Kind::params`]) that must all be on, or not zero, for the channel to be set.
    pub unless_off: Vec<usize>,
    /// Inputs (indices in [`Kind::inputs`]) that must all be connected, or not zero, for the channel to be set.
    pub unless_open: Vec<usize>,
}

impl Kind {
    /// Returns the method by which the means over rays of this node are denoised. All denoised passes of a node use the same one.
    pub fn denoise(&self) -> Option<Denoise> {
        self.passes.iter().find_map(|pass| pass.denoise)
    }

    /// Returns the parameter with this current or earlier name.
    pub fn param(&self, name: &str) -> Option<&Param> {
        self.params
            .iter()
            .find(|param| param.name == name || param.formerly.iter().any(|old| old == name))
    }

    /// Returns the index of the parameter with this name if a mask can multiply it at each place.
    pub fn masked_param(&self, name: &str) -> Option<usize> {
        let is_named = |param: &Param| param.name == name && param.takes_mask;
        self.params.iter().position(is_named)
    }

    /// The input of that name.
    pub fn input(&self, name: &str) -> Option<&Input> {
        self.inputs.iter().find(|input| input.name == name)
    }

    /// Returns the result with this name, or the first result for `None`.
    pub fn output(&self, name: Option<&str>) -> Option<&Output> {
        match name {
            Some(name) => self.outputs.iter().find(|output| output.name == name),
            None => self.outputs.first(),
        }
    }
}
