//! Kinds of nodes as read from their WGSL files: plain data for the planner, the catalog and the reference.

mod cost;
mod denoise;
mod memory;
mod param;
mod param_type;
mod role;
mod source_param;
mod written;

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
pub(crate) use written::UNUSED_STOP;
pub use written::{Written, WrittenStop};

/// A kind of node, reflected from its file and checked.
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
    /// Other words an artist may search for (`@alias clouds perlin`).
    pub aliases: Vec<String>,
    /// Earlier ids of this kind (`@was`), so that old files find it.
    pub formerly: Vec<String>,
    /// Path of the file, for messages only.
    pub path: PathBuf,
    /// Text of the file.
    pub source: Arc<str>,
    /// Libraries to append, directly used or not, in the order of first use.
    pub libraries: Vec<String>,
    /// Way in which the node reads its inputs.
    pub shape: Shape,
    /// Members of `struct Params` in order; empty when there is none.
    pub params: Vec<Param>,
    /// Size of `struct Params` in bytes, 0 when there is none.
    pub params_size: u32,
    /// Inputs over all functions, in order of first appearance, each name once.
    pub inputs: Vec<Input>,
    /// Documented functions that are results.
    pub outputs: Vec<Output>,
    /// Functions marked `@shared`, whose results outputs take as arguments of their names.
    pub shared: Vec<Shared>,
    /// Functions marked `@pass`, by pass number; their results are read by later functions under the pass's name.
    pub passes: Vec<Pass>,
    /// The rays over which the outputs are averaged, where the node shoots any.
    pub rays: Option<Rays>,
    /// Index in [`Kind::inputs`] of the surveyed input; the passes then run once for the whole surface, and outputs take
    /// their values.
    pub surveyed: Option<usize>,
    /// Index in [`Kind::params`] of the choice of the groups that are surveyed apart: [`SURVEY_GROUPINGS`].
    pub survey_groups: Option<usize>,
    /// Cost of compiling one evaluation of all outputs.
    pub cost: Cost,
    /// Most operations that all functions take for a texel, with the rounds of loops and rays that the ranges of parameters allow.
    pub work: u64,
}

/// Words of the choice of the groups that a survey measures apart, in the order of their numbers in a shader.
pub const SURVEY_GROUPINGS: [&str; 4] = ["whole", "part", "piece", "chart"];

/// Most inputs of a node: those that the flags of a switched kernel have bits for.
pub(crate) const INPUT_LIMIT: usize = 16;
/// Most material inputs of a node, for the same reason.
pub(crate) const MATERIAL_INPUT_LIMIT: usize = 9;

/// Way in which a node reads its inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Inputs are values at the same place; fused with its neighbors.
    Point,
    /// At least one input is a stored texture.
    Field,
    /// Results are means over rays that are shot from each place.
    Ray,
    /// Inputs are values at the same place, and a survey of one of them over the whole surface.
    Survey,
}

impl Shape {
    /// Word for it, as `sabi nodes` shows it.
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
    /// Value while nothing is connected.
    pub default: InputDefault,
    /// Parameter that multiplies the input, with the value that it gets once a wire is connected by hand, so that the wire shows
    /// as it is.
    pub starts: Option<(String, Value)>,
}

impl Input {
    /// Values of the knob that stands in while nothing is connected; `None` for an input that has no knob.
    pub fn knob(&self) -> Option<ParamType> {
        let InputDefault::Knob(numbers) = &self.default else {
            return None;
        };
        let (memory, role, soft) = match self.ty {
            // A mask is not limited, but usually lies there.
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
    /// None: the input must be connected (a field's source).
    Required,
    /// A knob on the node with this start value: 1 component for a mask, 3 for a color or vector (color linear).
    Knob(Vec<f32>),
    /// A WGSL expression over `at`, such as `at.position`.
    Expression(String),
    /// The plain gray material, for a material input.
    PlainMaterial,
}

/// A result.
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
    /// first field argument is the result of the run before.
    pub repeat: Option<Formula>,
    /// Widest texels of a pass (`@texel`), working units: it runs on the coarsest level without wider ones; `None` for the
    /// finest level.
    pub texel: Option<Formula>,
    /// Widest spacing of points spread over the surface (`@points`), working units: it runs on the widest ones with no more,
    /// and on the level by `texel` where there are none; `None` for texels alone.
    pub points: Option<Formula>,
    /// Channels that a material result can set.
    pub channels: Vec<ChannelWrite>,
}

impl Output {
    /// Formulas of its annotations, which the planner evaluates.
    pub fn formulas(&self) -> impl Iterator<Item = &Formula> {
        self.repeat.iter().chain(&self.texel).chain(&self.points)
    }
}

/// A function marked `@pass N`, stored before later functions read it under its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// The number after `@pass`; passes run in ascending order.
    pub number: u32,
    /// The function: its arguments and the type it stores.
    pub function: Output,
    /// Index in [`Kind::inputs`] of the input that the pass is for (`@with`): it does not run, and its readers read another
    /// texture in its place, or 0 where they read no other, while nothing is connected there and the parameter of the input
    /// has its default.
    pub with: Option<usize>,
    /// Way to average away the grain of a mean over rays before results read it (`@denoise`).
    pub denoise: Option<Denoise>,
}

/// A function marked `@shared`: evaluated once at a place for all outputs that take its result.
#[derive(Clone, Debug, PartialEq)]
pub struct Shared {
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
    /// Index in [`Kind::params`] of the `u32` parameter with the number of rays of each place.
    pub count: usize,
    /// Hit that is searched for along each ray.
    pub finds: Finds,
    /// Index in [`Kind::params`] of the length that limits rays and that nothing else of them depends on, so that the hits of
    /// shorter rays follow from those of longer ones.
    pub reach: Option<usize>,
    /// Index in [`Kind::params`] of an angle: hits count for nothing on triangles that turn by less than half of it against the
    /// one that the ray starts on.
    pub turn: Option<usize>,
    /// Widest texels that rays are cast from (`@texel`), working units: they are cast on the coarsest level without wider ones,
    /// and results are interpolated; `None` for the finest level.
    pub texel: Option<Formula>,
    /// Indices in [`Kind::params`] of the parameters that rays depend on.
    pub reads: Vec<usize>,
}

/// Hit that is searched for along a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Finds {
    /// Any hit, which is quicker to find; the distance is that of the hit found.
    Any,
    /// Its first hit.
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
    /// The result of a shared function at the same place, by index in [`Kind::shared`].
    Shared(usize),
    /// The stored result of a pass, by index in [`Kind::passes`].
    Pass(usize),
    /// `index: u32` of the function `ray`: the number of the ray, from 0.
    Index,
    /// `ray: Ray`
    Ray,
    /// `hit: Hit`
    Hit,
    /// `round: Round`: number of the repetition, and width of texels.
    Round,
    /// `survey: texture_2d_array<f32>`: the table of the surveyed input.
    Survey,
    /// `group: u32` of a pass that reads a survey: the number of the group, 0 for the whole surface.
    Group,
}

impl Argument {
    /// Returns true if the argument belongs to a single ray.
    pub(crate) fn is_of_ray(&self) -> bool {
        matches!(self, Argument::Ray | Argument::Hit)
    }
}

/// Channels of a material with their own storage.
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

    /// Channels that most materials have; the others are rare.
    pub const COMMON: [Channel; 5] = [
        Channel::Color,
        Channel::Surface,
        Channel::Height,
        Channel::Slope,
        Channel::Emission,
    ];

    /// The channels that kernels read and write which do not depend on links: all of them as soon as a result sets a rare
    /// one, so that there are two such kernels for a node and no more.
    pub fn switched(set: impl IntoIterator<Item = Channel>) -> &'static [Channel] {
        if set.into_iter().all(|channel| Channel::COMMON.contains(&channel)) {
            &Channel::COMMON
        } else {
            &Channel::ALL
        }
    }
}

/// A channel that a material function can set, with the conditions for it.
///
/// Read from the code: a store to a member of the returned material, under `if params.x != 0u`, or times `params.y`.
/// Material inputs that a result copies pass their channels on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelWrite {
    /// The channel that may be set.
    pub channel: Channel,
    /// Parameters (indices in [`Kind::params`]) that must all be on, or other than zero, for it to be set.
    pub unless_off: Vec<usize>,
    /// Inputs (indices in [`Kind::inputs`]) that must all be connected, or other than zero, for it to be set.
    pub unless_open: Vec<usize>,
}

impl Kind {
    /// The way in which its means over rays are denoised, the same for all that are.
    pub fn denoise(&self) -> Option<Denoise> {
        self.passes.iter().find_map(|pass| pass.denoise)
    }

    /// The parameter with that name, present or earlier.
    pub fn param(&self, name: &str) -> Option<&Param> {
        self.params
            .iter()
            .find(|param| param.name == name || param.formerly.iter().any(|old| old == name))
    }

    /// Index of the parameter of that name, if a mask can multiply it at each place.
    pub fn masked_param(&self, name: &str) -> Option<usize> {
        let is_named = |param: &Param| param.name == name && param.takes_mask;
        self.params.iter().position(is_named)
    }

    /// The input of that name.
    pub fn input(&self, name: &str) -> Option<&Input> {
        self.inputs.iter().find(|input| input.name == name)
    }

    /// The result of that name, or the first one.
    pub fn output(&self, name: Option<&str>) -> Option<&Output> {
        match name {
            Some(name) => self.outputs.iter().find(|output| output.name == name),
            None => self.outputs.first(),
        }
    }
}
